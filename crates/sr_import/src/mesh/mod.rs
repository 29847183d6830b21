//! Meshes: files and built-in shapes to [`MeshDesc`] in world space.

pub mod normals;
pub mod obj;
mod place;
mod ply;
pub mod primitives;
mod serialized;
pub mod stl;
mod subdivide;

pub use place::{Convention, Placement, Report, place};
pub use subdivide::{Scheme, Subdivision};

use std::path::Path;
use std::sync::Arc;

use sr_scene::MeshDesc;

use crate::files;
use crate::limits::Limits;

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
pub fn load(path: &Path, format: Format, flip_v: bool, limits: &Limits) -> Result<RawMesh, String> {
    let Limits { file_bytes, unpacked_bytes, mesh_elements: limit, .. } = *limits;
    let whole = || files::unpacked(files::read(path, file_bytes)?, unpacked_bytes);
    let mut fans = Fans::default();
    let mut textures = Vec::new();
    let mut mesh = match format {
        Format::Obj => obj::parse(&whole()?, &mut fans, limit)?,
        Format::Ply => {
            let content = files::open(path, file_bytes, unpacked_bytes)?;
            let file = ply::parse(content, &mut fans, limit)?;
            textures = file.textures;
            file.mesh
        }
        Format::Serialized { index } => serialized::parse(&whole()?, index, limit)?,
    };
    mesh.name = path.display().to_string();
    if flip_v {
        mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
    }
    Ok(RawMesh { mesh: Arc::new(mesh), fans: fans.0.into(), textures: textures.into() })
}

/// A mesh as it was read.
#[derive(Clone, Debug)]
pub struct RawMesh {
    /// The mesh.
    pub mesh: Arc<MeshDesc>,
    /// How many of its triangles each polygon was made into, one after another; empty if every polygon is a triangle.
    pub fans: Arc<[u32]>,
    /// Images that it names for itself.
    pub textures: Arc<[String]>,
}

/// [`RawMesh::fans`] as they grow: nothing is kept as long as there are triangles only.
#[derive(Debug, Default)]
struct Fans(Vec<u32>);

impl Fans {
    /// A polygon's triangles, as a fan about its first corner.
    fn add(&mut self, corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
        let before = triangles.len();
        fan(corners, triangles);
        let count = triangles.len() - before;
        if self.0.is_empty() && count != 1 {
            self.0 = vec![1; before];
        }
        if !self.0.is_empty() || count != 1 {
            self.0.push(count as u32);
        }
    }

    /// So many triangles.
    fn add_triangles(&mut self, count: usize) {
        if !self.0.is_empty() {
            self.0.resize(self.0.len() + count, 1);
        }
    }
}

/// A polygon's triangles, as a fan about its first corner.
fn fan(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    for pair in corners.windows(2).skip(1) {
        triangles.push([corners[0], pair[0], pair[1]]);
    }
}
