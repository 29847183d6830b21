//! A mesh file as a scene of its own: one grey shape before the default camera, under the default sky.

use std::path::Path;

use glam::DMat4;
use sr_scene::{
    ColorInput, Diagnostic, Diagnostics, Geometry, MaterialDesc, MeshDesc, Rgb, SceneDesc, ShapeDesc, Span,
};

use crate::assembly::{Assembly, FRONT_ABOVE, MeshSource};
use crate::mesh::{Convention, Format, Placement};

/// What it reflects.
const GREY: Rgb = Rgb::splat(0.6);

/// The format of a mesh file, by its extension.
pub fn format(path: &Path) -> Option<Format> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "ply" => Some(Format::Ply),
        "obj" => Some(Format::Obj),
        _ => None,
    }
}

/// Loads the mesh file `path`.
pub fn load(path: &Path, format: Format, d: &mut Diagnostics) -> Option<SceneDesc> {
    let span = Span { source: d.sources.add(path.display().to_string(), ""), bytes: 0..0 };
    let mut out = Assembly::new(Vec::new(), d);
    let what = "a mesh file shows no materials and no colors";
    out.d.push(Diagnostic::warning("scene::no-materials", &span, what).consequence("all of it is grey"));
    let reflectance = ColorInput::Constant(GREY);
    let inner = out.add_material(MaterialDesc::Diffuse { reflectance }, &span);
    let material = out.add_material(MaterialDesc::TwoSided { front: inner, back: inner }, &span);
    let placement = Placement {
        to_world: DMat4::IDENTITY,
        face_normals: false,
        flip_normals: false,
        max_smooth_angle: None,
        flat: false,
        subdivision: None,
        convention: Convention::Mitsuba,
        colors: false,
    };
    let source = MeshSource::File { path: path.to_owned(), format, flip_v: false };
    let geometry = Geometry::Mesh(MeshDesc::default().into());
    let shape = ShapeDesc { geometry, material, emission: None, span: span.clone() };
    out.add_shape(shape, Some((source, placement)));
    out.view_from = FRONT_ABOVE;
    out.light_if_dark(false, &span);
    out.finish(&span)
}
