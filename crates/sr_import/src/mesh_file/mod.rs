//! A mesh file as a scene of its own, before the default camera, under the default sky.
//!
//! - `obj`: OBJ: a shape for each material. `mtl`: the files that describe these, `cover`: what becomes of them here.
//! - `ply`, `stl`: one shape, with the mesh's own colors or grey.

mod cover;
mod mtl;
mod obj;
mod ply;
mod stl;

use std::path::Path;

use glam::DMat4;
use sr_scene::{
    ColorInput, Diagnostics, Emission, Geometry, MaterialDesc, MaterialId, MeshDesc, Rgb, SceneDesc,
    ShapeDesc, Span,
};

use crate::LoadOptions;
use crate::assembly::{Assembly, FRONT_ABOVE, MeshSource};
use crate::files;
use crate::mesh::{Convention, Placement};

/// What reflects where nothing is said.
const GREY: Rgb = Rgb::splat(0.6);

/// A kind of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY.
    Ply,
    /// STL, text or binary.
    Stl,
}

impl Kind {
    /// By the extension.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "ply" => Some(Self::Ply),
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            _ => None,
        }
    }
}

/// Loads the mesh file `path`.
pub fn load(path: &Path, kind: Kind, options: &LoadOptions, d: &mut Diagnostics) -> Option<SceneDesc> {
    let span = Span { source: d.sources.add(path.display().to_string(), ""), bytes: 0..0 };
    let directory = path.parent().unwrap_or(Path::new("")).to_owned();
    let directories = files::Directories::new(directory, &options.search_paths).into_list();
    let mut scene =
        MeshScene { out: Assembly::new(directories, options.limits, d), path, span, shines: false };
    scene.out.environment.clone_from(&options.environment);
    let read = match kind {
        Kind::Obj => scene.obj(),
        Kind::Ply => scene.ply(),
        Kind::Stl => scene.stl(),
    };
    let MeshScene { mut out, span, shines, .. } = scene;
    if let Err(reason) = read {
        out.d.push(files::error("file::bad-mesh", &span, "mesh", path, &reason));
        return None;
    }
    out.view_from = FRONT_ABOVE;
    out.light_if_dark(shines, &span);
    out.finish(&span)
}

/// The scene as it grows.
struct MeshScene<'a, 'd> {
    out: Assembly<'d>,
    path: &'a Path,
    span: Span,
    /// Does a shape emit light?
    shines: bool,
}

impl MeshScene<'_, '_> {
    /// A diffuse surface, seen from both sides.
    fn diffuse(&mut self, reflectance: ColorInput) -> MaterialId {
        let inner = self.out.add_material(MaterialDesc::Diffuse { reflectance }, &self.span);
        self.out.add_material(MaterialDesc::TwoSided { front: inner, back: inner }, &self.span)
    }

    fn add(
        &mut self,
        mut mesh: MeshDesc,
        material: MaterialId,
        emission: Option<Emission>,
        placement: Placement,
    ) {
        if mesh.name.is_empty() {
            mesh.name = self.path.display().to_string();
        }
        let geometry = Geometry::Mesh(MeshDesc::default().into());
        let shape = ShapeDesc { geometry, material, emission, span: self.span.clone() };
        self.out.add_shape(shape, Some((MeshSource::Memory(mesh.into()), placement)));
    }
}

/// Where it is, smooth where it has no normals.
fn as_it_is() -> Placement {
    Placement {
        to_world: DMat4::IDENTITY,
        face_normals: false,
        flip_normals: false,
        max_smooth_angle: None,
        flat: false,
        subdivision: None,
        convention: Convention::Mitsuba,
        colors: true,
    }
}
