//! Bilinear patches: as they are, or as triangles where they emit or have normals or texture coordinates of their own.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use sr_scene::{Geometry, MeshDesc};

use super::super::syntax::Kind;
use super::{Form, Params, Reader};
use crate::assembly::MeshSource;

/// Rows and columns of squares that a curved patch is cut into.
const CUTS: usize = 16;

/// The corners of all patches.
struct Patches {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    corners: Vec<[usize; 4]>,
}

impl Reader<'_> {
    pub(super) fn bilinear_mesh(&mut self, params: &mut Params, emits: bool) -> Vec<Form> {
        params.unsupported(&["emissionfilename"], "the light is even", &mut self.notes());
        params.ignore(&["faceIndices"]);
        let Some(patches) = self.patches(params) else { return Vec::new() };
        if emits || !patches.normals.is_empty() || !patches.uvs.is_empty() {
            let source = MeshSource::Memory(Arc::new(patches.triangles()));
            return vec![Form::of_mesh(source, self.placement(), None)];
        }
        let (_, is_mirrored) = self.linear();
        let flip_normals = self.state.reverse_orientation ^ is_mirrored;
        let placed = |i: usize| self.state.ctm.transform_point3(patches.positions[i].as_dvec3()).as_vec3();
        let form = |corners: &[usize; 4]| {
            Form::ready(Geometry::Patch { corners: corners.map(placed), flip_normals }, 0.0)
        };
        patches.corners.iter().map(form).collect()
    }

    fn patches(&mut self, params: &mut Params) -> Option<Patches> {
        let vectors = |floats: Vec<f32>| floats.chunks_exact(3).map(Vec3::from_slice).collect::<Vec<_>>();
        let positions = params.take_floats("P", &[Kind::Point3]).map(|(_, v)| vectors(v)).unwrap_or_default();
        let normals = params.take_floats("N", &[Kind::Normal]).map(|(_, v)| vectors(v)).unwrap_or_default();
        let uvs = params.take_floats("uv", &[Kind::Point2, Kind::Float]);
        let uvs: Vec<Vec2> =
            uvs.map(|(_, v)| v.chunks_exact(2).map(Vec2::from_slice).collect()).unwrap_or_default();
        let indices = match params.take_integers("indices") {
            Some((_, indices)) => indices,
            None if positions.len() == 4 => vec![0, 1, 2, 3],
            None => Vec::new(),
        };
        let count = positions.len();
        let fits = |len: usize| len == 0 || len == count;
        let is_sound = indices.len() % 4 == 0
            && !indices.is_empty()
            && indices.iter().all(|&i| usize::try_from(i).is_ok_and(|i| i < count))
            && fits(normals.len())
            && fits(uvs.len());
        if !is_sound {
            let message = format!("{} needs four valid \"indices\" for each patch", params.title);
            self.warn("pbrt::bad-value", &params.span, message, "the shape is left out");
            return None;
        }
        let corners = indices.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]].map(|i| i as usize)).collect();
        Some(Patches { positions, normals, uvs, corners })
    }
}

impl Patches {
    /// Two triangles for a flat patch, many for a curved one.
    fn triangles(&self) -> MeshDesc {
        let mut mesh = MeshDesc { name: "bilinear mesh".into(), ..MeshDesc::default() };
        for &corners in &self.corners {
            let cuts = if self.is_parallelogram(corners) { 1 } else { CUTS };
            let first = mesh.positions.len() as u32;
            for row in 0..=cuts {
                for column in 0..=cuts {
                    let (u, v) = (column as f32 / cuts as f32, row as f32 / cuts as f32);
                    mesh.positions.push(bilinear(corners.map(|i| self.positions[i]), u, v));
                    if !self.normals.is_empty() {
                        let normal = bilinear(corners.map(|i| self.normals[i]), u, v);
                        mesh.normals.push(normal.normalize_or_zero());
                    }
                    let uv = match self.uvs.is_empty() {
                        true => Vec2::new(u, v),
                        false => bilinear(corners.map(|i| self.uvs[i].extend(0.0)), u, v).truncate(),
                    };
                    mesh.uvs.push(uv);
                }
            }
            let stride = cuts as u32 + 1;
            for row in 0..cuts as u32 {
                for column in 0..cuts as u32 {
                    let a = first + row * stride + column;
                    let (b, c, d) = (a + 1, a + stride, a + stride + 1);
                    mesh.triangles.extend([[a, b, d], [a, d, c]]);
                }
            }
        }
        mesh
    }

    fn is_parallelogram(&self, corners: [usize; 4]) -> bool {
        let [p00, p10, p01, p11] = corners.map(|i| self.positions[i]);
        (p00 + p11 - p10 - p01).length() <= 1e-4 * (p11 - p00).length()
    }
}

/// Between p(0, 0), p(1, 0), p(0, 1) and p(1, 1).
fn bilinear([p00, p10, p01, p11]: [Vec3; 4], u: f32, v: f32) -> Vec3 {
    p00.lerp(p10, u).lerp(p01.lerp(p11, u), v)
}
