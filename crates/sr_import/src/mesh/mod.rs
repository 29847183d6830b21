//! Meshes: files and built-in shapes to [`MeshDesc`] in world space.

mod normals;
mod obj;
mod place;
mod ply;
pub mod primitives;
mod serialized;

pub use place::{Placement, Report, place};

use std::path::Path;

use sr_scene::MeshDesc;

use crate::files;

/// More vertices or triangles than this are refused.
const MAX_ELEMENTS: usize = 1 << 28;

/// How to read a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY.
    Ply,
    /// One mesh of a Mitsuba serialized file.
    Serialized {
        /// Which one, from 0.
        index: u32,
    },
}

/// Reads a file; the error is half a sentence.
pub fn load(path: &Path, format: Format, flip_v: bool) -> Result<MeshDesc, String> {
    let bytes = files::read(path, files::MAX_FILE_BYTES)?;
    let mut mesh = match format {
        Format::Obj => obj::parse(&bytes)?,
        Format::Ply => ply::parse(&bytes)?,
        Format::Serialized { index } => serialized::parse(&bytes, index)?,
    };
    mesh.name = path.display().to_string();
    if flip_v {
        mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
    }
    Ok(mesh)
}

/// A polygon's triangles, as a fan about its first corner.
fn fan(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    for pair in corners.windows(2).skip(1) {
        triangles.push([corners[0], pair[0], pair[1]]);
    }
}
