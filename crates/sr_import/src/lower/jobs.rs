//! Files, read in parallel once everything that names them is known; each file is read once.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::*;
use sr_scene::{Diagnostic, Geometry, Image, MeshDesc, Pixels, ShapeDesc, Span, TextureDesc};

use super::Lowering;
use crate::files;
use crate::images::{self, Decode};
use crate::mesh::{self, Format, Placement, RawMesh, Report};

/// An image of the scene, read or to be read.
pub(super) enum ImageSlot {
    Ready(Arc<Image>),
    File { path: PathBuf, decode: Decode, span: Span },
}

/// A mesh of the scene, to be read and placed.
pub(super) struct PendingMesh {
    /// Whose geometry it is.
    pub shape: ShapeSlot,
    pub source: MeshSource,
    pub placement: Placement,
    pub span: Span,
}

#[derive(Clone, Copy)]
pub(super) enum ShapeSlot {
    Scene(usize),
    Group(usize, usize),
}

#[derive(Clone)]
pub(super) enum MeshSource {
    Memory(Arc<MeshDesc>),
    File { path: PathBuf, format: Format, flip_v: bool },
}

type FileKey = (PathBuf, Format, bool);

impl Lowering<'_, '_> {
    pub(super) fn image_in_memory(&mut self, image: &Arc<Image>) -> u32 {
        self.images.push(ImageSlot::Ready(image.clone()));
        self.images.len() as u32 - 1
    }

    pub(super) fn image_file(&mut self, name: &str, decode: Decode, span: &Span) -> u32 {
        let path = files::find(name, &self.origin.directories);
        let known = self.images.iter().position(
            |slot| matches!(slot, ImageSlot::File { path: p, decode: d, .. } if *p == path && *d == decode),
        );
        known.unwrap_or_else(|| {
            self.images.push(ImageSlot::File { path, decode, span: span.clone() });
            self.images.len() - 1
        }) as u32
    }

    pub(super) fn load_images(&mut self) -> Vec<Arc<Image>> {
        let slots = std::mem::take(&mut self.images);
        let loaded: Vec<Result<Arc<Image>, String>> = slots
            .par_iter()
            .map(|slot| match slot {
                ImageSlot::Ready(image) => check_image(image).map(|()| image.clone()),
                ImageSlot::File { path, decode, .. } => images::load(path, *decode).map(Arc::new),
            })
            .collect();
        let mut out = Vec::with_capacity(loaded.len());
        for (slot, result) in slots.iter().zip(loaded) {
            match (result, slot) {
                (Ok(image), _) => out.push(image),
                (Err(reason), ImageSlot::File { path, span, .. }) => {
                    let error = self.file_error("mitsuba::bad-image", span, "image", path, &reason);
                    self.d.push(error);
                }
                (Err(reason), ImageSlot::Ready(image)) => {
                    let message = format!("the image \"{}\" cannot be used: {reason}", image.name);
                    self.d.push(Diagnostic::error("mitsuba::bad-image", &Span::default(), message));
                }
            }
        }
        out
    }

    pub(super) fn load_meshes(&mut self, span: &Span) {
        let mut pending = std::mem::take(&mut self.meshes);
        let colors = self.textures.iter().any(|t| matches!(t, TextureDesc::MeshColor { .. }));
        pending.iter_mut().for_each(|mesh| mesh.placement.colors = colors);
        let files = read_files(&pending);
        let mut placed = place_all(&pending, &files);
        let mut degenerate = Vec::new();
        let mut bad_normals = Vec::new();
        for (mesh, result) in pending.iter().zip(placed.drain(..)) {
            match result {
                Ok((desc, report)) => {
                    degenerate.extend((report.degenerate > 0).then_some((report.degenerate, mesh)));
                    bad_normals.extend((report.bad_normals > 0).then_some((report.bad_normals, mesh)));
                    self.set_geometry(mesh.shape, Geometry::Mesh(desc));
                }
                Err(reason) => {
                    let error = match &mesh.source {
                        MeshSource::File { path, .. } => {
                            self.file_error("mitsuba::bad-mesh", &mesh.span, "mesh", path, &reason)
                        }
                        MeshSource::Memory(_) => {
                            let message = format!(
                                "the mesh \"{}\" cannot be used: {reason}",
                                source_name(&mesh.source)
                            );
                            Diagnostic::error("mitsuba::bad-mesh", &mesh.span, message)
                        }
                    };
                    self.d.push(error);
                }
            }
        }
        self.report_meshes(
            "mitsuba::degenerate-triangles",
            &degenerate,
            "triangles without area",
            "they are left out",
        );
        self.report_meshes(
            "mitsuba::bad-normals",
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
            self.d.push(Diagnostic::error("mitsuba::nothing-left", span, message));
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

/// An image that was not made here may be anything.
fn check_image(image: &Image) -> Result<(), String> {
    let (channels, len) = match &image.pixels {
        Pixels::U8 { channels, data } => (*channels, data.len()),
        Pixels::F32 { channels, data } => (*channels, data.len()),
    };
    let texels = u64::from(image.width) * u64::from(image.height);
    if ![1, 3, 4].contains(&channels) || texels == 0 || texels * u64::from(channels) != len as u64 {
        return Err(format!(
            "{len} values are not {} × {} texels of {channels} channels",
            image.width, image.height
        ));
    }
    Ok(())
}
