//! Meshes: read in parallel once all are known, each file once, then placed in parallel.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::*;
use sr_scene::{Diagnostic, Geometry, MeshDesc, ShapeDesc, Span, TextureDesc};

use super::Assembly;
use crate::files;
use crate::mesh::{self, Format, Placement, RawMesh, Report};

/// A mesh of the scene, to be read and placed.
pub(super) struct PendingMesh {
    /// Whose geometry it is.
    pub shape: ShapeSlot,
    pub source: MeshSource,
    pub placement: Placement,
    pub span: Span,
}

/// A place in the description.
#[derive(Clone, Copy)]
pub(super) enum ShapeSlot {
    Scene(usize),
    Group(usize, usize),
}

/// Where a mesh comes from.
#[derive(Clone)]
pub enum MeshSource {
    /// It is there.
    Memory(Arc<MeshDesc>),
    /// It is read at the end.
    File {
        /// As [`Assembly::find`] has it.
        path: PathBuf,
        /// How to read it.
        format: Format,
        /// Is v counted from the other end?
        flip_v: bool,
    },
}

type FileKey = (PathBuf, Format, bool);

impl Assembly<'_> {
    pub(super) fn load_meshes(&mut self, span: &Span) {
        let mut pending = std::mem::take(&mut self.meshes);
        let colors = self.textures.iter().any(|t| matches!(t, TextureDesc::MeshColor { .. }));
        pending.iter_mut().for_each(|mesh| mesh.placement.colors = colors);
        let files = read_files(&pending);
        let mut placed = place_all(&pending, &files);
        let mut degenerate = Vec::new();
        let mut bad_normals = Vec::new();
        let mut empty = Vec::new();
        for (mesh, result) in pending.iter().zip(placed.drain(..)) {
            match result {
                Ok((desc, report)) => {
                    if desc.triangles.is_empty() && report.degenerate == 0 {
                        empty.push((1, mesh));
                    }
                    degenerate.extend((report.degenerate > 0).then_some((report.degenerate, mesh)));
                    bad_normals.extend((report.bad_normals > 0).then_some((report.bad_normals, mesh)));
                    self.set_geometry(mesh.shape, Geometry::Mesh(desc));
                }
                Err(reason) => {
                    let error = match &mesh.source {
                        MeshSource::File { path, .. } => {
                            files::error("file::bad-mesh", &mesh.span, "mesh", path, &reason)
                        }
                        MeshSource::Memory(_) => {
                            let message = format!(
                                "the mesh \"{}\" cannot be used: {reason}",
                                source_name(&mesh.source)
                            );
                            Diagnostic::error("file::bad-mesh", &mesh.span, message)
                        }
                    };
                    self.d.push(error);
                }
            }
        }
        if let [(_, first), ..] = empty[..] {
            let name = source_name(&first.source);
            let message = match empty.len() {
                1 => format!("{name} has no triangles"),
                n => format!("{n} meshes have no triangles; the first is {name}"),
            };
            self.d.push(
                Diagnostic::warning("scene::empty-mesh", &first.span, message)
                    .consequence("nothing is seen of it"),
            );
        }
        self.report_meshes(
            "scene::degenerate-triangles",
            &degenerate,
            "triangles without area",
            "they are left out",
        );
        self.report_meshes(
            "scene::bad-normals",
            &bad_normals,
            "normals without a direction",
            "they are computed from the triangles",
        );
        self.drop_empty_shapes(span);
    }

    /// A shape all of whose triangles were dropped is nothing; an emitter of no area could not be sampled.
    ///
    /// Real scenes have such shapes among others, so that only a scene of nothing else is an error.
    fn drop_empty_shapes(&mut self, span: &Span) {
        let full =
            |shape: &ShapeDesc| !matches!(&shape.geometry, Geometry::Mesh(mesh) if mesh.triangles.is_empty());
        let before = self.shapes.len();
        self.shapes.retain(full);
        self.groups.iter_mut().for_each(|group| group.shapes.retain(full));
        if before > 0 && self.shapes.is_empty() && self.instances.is_empty() && !self.d.has_errors() {
            let message = "nothing is left of the scene: no triangle of its shapes has an area";
            self.d.push(Diagnostic::error("scene::nothing-left", span, message));
        }
    }

    fn set_geometry(&mut self, slot: ShapeSlot, geometry: Geometry) {
        match slot {
            ShapeSlot::Scene(shape) => self.shapes[shape].geometry = geometry,
            ShapeSlot::Group(group, shape) => self.groups[group].shapes[shape].geometry = geometry,
        }
    }

    /// One warning for all meshes together: exporters leave such triangles everywhere.
    fn report_meshes(
        &mut self,
        code: &'static str,
        noticed: &[(usize, &PendingMesh)],
        what: &str,
        consequence: &str,
    ) {
        let Some((first_count, first)) = noticed.first() else { return };
        let total: usize = noticed.iter().map(|(count, _)| count).sum();
        let name = source_name(&first.source);
        let message = match noticed.len() {
            1 => format!("{name} has {total} {what}"),
            n => format!("{n} meshes have {total} {what}; the first is {name} with {first_count}"),
        };
        self.d.push(Diagnostic::warning(code, &first.span, message).consequence(consequence));
    }
}

/// Every distinct file, read.
fn read_files(pending: &[PendingMesh]) -> HashMap<FileKey, Result<RawMesh, String>> {
    let mut keys: Vec<FileKey> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for mesh in pending {
        if let MeshSource::File { path, format, flip_v } = &mesh.source {
            let key = (path.clone(), *format, *flip_v);
            if seen.insert(key.clone()) {
                keys.push(key);
            }
        }
    }
    keys.into_par_iter()
        .map(|key| {
            let mesh = mesh::load(&key.0, key.1, key.2);
            (key, mesh)
        })
        .collect()
}

type Placed = Result<(Arc<MeshDesc>, Report), String>;

/// Every pending mesh in place; meshes that are placed alike share their memory.
fn place_all(pending: &[PendingMesh], files: &HashMap<FileKey, Result<RawMesh, String>>) -> Vec<Placed> {
    let raw: Vec<Result<RawMesh, String>> = pending
        .iter()
        .map(|mesh| match &mesh.source {
            MeshSource::Memory(desc) => Ok(RawMesh { mesh: desc.clone(), fans: [].into() }),
            MeshSource::File { path, format, flip_v } => files
                .get(&(path.clone(), *format, *flip_v))
                .cloned()
                .unwrap_or_else(|| Err("it was not read".into())),
        })
        .collect();
    // The first mesh that is the same, for each.
    let mut first: HashMap<(usize, String), usize> = HashMap::new();
    let twin: Vec<usize> = pending
        .iter()
        .zip(&raw)
        .enumerate()
        .map(|(i, (mesh, raw))| match raw {
            Ok(raw) => {
                *first.entry((Arc::as_ptr(&raw.mesh).addr(), format!("{:?}", mesh.placement))).or_insert(i)
            }
            Err(_) => i,
        })
        .collect();
    let placed: Vec<Option<Placed>> = pending
        .par_iter()
        .zip(&raw)
        .zip(&twin)
        .enumerate()
        .map(|(i, ((mesh, raw), &twin))| {
            (twin == i).then(|| {
                let raw = raw.as_ref().map_err(Clone::clone)?;
                mesh::place(raw, &mesh.placement).map(|(desc, report)| (Arc::new(desc), report))
            })
        })
        .collect();
    twin.iter()
        .enumerate()
        .map(|(i, &twin)| {
            let result = placed[twin].clone().unwrap_or_else(|| Err("it was not placed".into()));
            // What is wrong with a mesh is said once.
            if twin == i { result } else { result.map(|(mesh, _)| (mesh, Report::default())) }
        })
        .collect()
}

fn source_name(source: &MeshSource) -> String {
    match source {
        MeshSource::Memory(mesh) => mesh.name.clone(),
        MeshSource::File { path, .. } => path.display().to_string(),
    }
}
