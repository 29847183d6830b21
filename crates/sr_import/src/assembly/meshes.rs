//! Meshes: read in parallel once all are known, each file once, then placed in parallel.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::*;
use sr_scene::{Diagnostic, Geometry, MeshDesc, ShapeDesc, Span, TextureDesc};

use super::Assembly;
use crate::files;
use crate::limits::{Limit, Limits};
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
        let files = read_files(&pending, &self.limits);
        let mut placed = place_all(&mut pending, files, self.limits.subdivided_faces);
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
fn read_files(pending: &[PendingMesh], limits: &Limits) -> HashMap<FileKey, Result<RawMesh, String>> {
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
            let mesh = mesh::load(&key.0, key.1, key.2, limits);
            (key, mesh)
        })
        .collect()
}

type Placed = Result<(Arc<MeshDesc>, Report), String>;

/// Every pending mesh in place; meshes that are placed alike share their memory. What was read is let go as soon as it is in
/// place, or becomes that which is in place.
fn place_all(
    pending: &mut [PendingMesh],
    files: HashMap<FileKey, Result<RawMesh, String>>,
    faces_limit: Limit,
) -> Vec<Placed> {
    let mut raw: Vec<Result<RawMesh, String>> = pending.iter_mut().map(|mesh| taken(mesh, &files)).collect();
    drop(files);
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
    let mut faces = 0;
    for (i, raw) in raw.iter_mut().enumerate() {
        if twin[i] != i {
            *raw = Err("it is placed elsewhere".into());
        } else if let Ok(found) = &raw
            && let Some(how) = pending[i].placement.subdivision
        {
            match how.faces(&found.mesh, &found.fans, faces_limit) {
                Ok(more) if faces + more <= faces_limit.most => faces += more,
                Ok(_) => {
                    let what = format!("all meshes subdivided would have more than {faces_limit} faces");
                    *raw = Err(faces_limit.refusal(what));
                }
                Err(reason) => *raw = Err(reason),
            }
        }
    }
    let placed: Vec<Placed> = raw
        .into_par_iter()
        .zip(&*pending)
        .map(|(raw, mesh)| mesh::place(raw?, &mesh.placement).map(|(desc, report)| (Arc::new(desc), report)))
        .collect();
    // What is wrong with a mesh is said once.
    let again = |twin: usize| placed[twin].clone().map(|(mesh, _)| (mesh, Report::default()));
    twin.iter()
        .enumerate()
        .map(|(i, &twin)| if twin == i { placed[i].clone() } else { again(twin) })
        .collect()
}

/// What was read for a mesh; of what lay in memory, the name is left.
fn taken(
    mesh: &mut PendingMesh,
    files: &HashMap<FileKey, Result<RawMesh, String>>,
) -> Result<RawMesh, String> {
    match &mut mesh.source {
        MeshSource::Memory(desc) => {
            let name = MeshDesc { name: desc.name.clone(), ..MeshDesc::default() };
            Ok(RawMesh {
                mesh: std::mem::replace(desc, Arc::new(name)),
                fans: [].into(),
                textures: [].into(),
            })
        }
        MeshSource::File { path, format, flip_v } => files
            .get(&(path.clone(), *format, *flip_v))
            .cloned()
            .unwrap_or_else(|| Err("it was not read".into())),
    }
}

fn source_name(source: &MeshSource) -> String {
    match source {
        MeshSource::Memory(mesh) => mesh.name.clone(),
        MeshSource::File { path, .. } => path.display().to_string(),
    }
}
