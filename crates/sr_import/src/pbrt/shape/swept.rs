//! Parts of spheres, disks and cylinders, and those that are stretched: profiles swept around the z-axis, as triangles with
//! the normals of the true surface.

use std::f32::consts::TAU;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use sr_scene::MeshDesc;

use super::{Form, Params, Reader};
use crate::assembly::MeshSource;

/// Columns of a whole turn.
const COLUMNS: f32 = 128.0;
/// Triangles of all such shapes of a file after which a quarter of the columns and rows has to do.
const MANY_TRIANGLES: usize = 1 << 20;
/// Triangles of all such shapes of a file: more are whole, and round.
const MOST_TRIANGLES: usize = 1 << 22;

/// A point of a profile: distance from the axis and height, their normal, and v.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProfilePoint {
    pub at: Vec2,
    pub normal: Vec2,
    pub v: f32,
}

impl Reader<'_> {
    /// The profile swept from φ = 0 to `phi_max`, u from 0 to 1; `None`: there are too many triangles.
    pub(super) fn swept(
        &mut self,
        params: &Params,
        profile: &[ProfilePoint],
        phi_max: f32,
    ) -> Option<Vec<Form>> {
        let coarser = if self.swept_triangles < MANY_TRIANGLES { 1 } else { 4 };
        let columns = (COLUMNS / coarser as f32 * phi_max / TAU).ceil().max(4.0) as usize;
        let profile = &thinned(profile, coarser);
        let count = 2 * columns * (profile.len() - 1);
        self.swept_triangles += count;
        if self.swept_triangles > MOST_TRIANGLES {
            let message = format!(
                "the file's parts of spheres, disks and cylinders are more than {MOST_TRIANGLES} triangles"
            );
            self.warn("pbrt::swept-shapes", &params.span, message, "from here on they are whole, and round");
            return None;
        }
        let source = MeshSource::Memory(Arc::new(mesh(profile, phi_max, columns)));
        Some(vec![Form::of_mesh(source, self.placement(), None)])
    }
}

/// Every so many of the points, and the last one.
fn thinned(profile: &[ProfilePoint], step: usize) -> Vec<ProfilePoint> {
    let last = profile.len() - 1;
    (0..last).step_by(step).chain([last]).map(|i| profile[i]).collect()
}

fn mesh(profile: &[ProfilePoint], phi_max: f32, columns: usize) -> MeshDesc {
    let mut mesh = MeshDesc { name: "swept shape".into(), ..MeshDesc::default() };
    for point in profile {
        for column in 0..=columns {
            let u = column as f32 / columns as f32;
            let (sin, cos) = (u * phi_max).sin_cos();
            let around = |p: Vec2| Vec3::new(p.x * cos, p.x * sin, p.y);
            mesh.positions.push(around(point.at));
            mesh.normals.push(around(point.normal));
            mesh.uvs.push(Vec2::new(u, point.v));
        }
    }
    let stride = columns as u32 + 1;
    for row in 0..profile.len() as u32 - 1 {
        for column in 0..columns as u32 {
            let a = row * stride + column;
            let (b, c, d) = (a + 1, a + stride, a + stride + 1);
            // At a pole, one of the two has no area.
            let has_width = |row: u32| profile[row as usize].at.x != 0.0;
            if has_width(row) {
                mesh.triangles.push([a, b, d]);
            }
            if has_width(row + 1) {
                mesh.triangles.push([a, d, c]);
            }
        }
    }
    mesh
}
