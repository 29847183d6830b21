//! Flat disks and ellipses.

use std::f32::consts::TAU;

use glam::{DVec3, Vec2, Vec3};

use crate::offset::ROUNDING;
use crate::surface::Located;
use crate::{Disk, Ray, Tangents};

impl Disk {
    /// t in (0, `t_max`) where the ray meets the disk, and the coordinates along the two half-axes.
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<(f32, Vec2)> {
        let (u_axis, v_axis) = (self.u_axis.as_dvec3(), self.v_axis.as_dvec3());
        let (origin, direction) = (ray.origin.as_dvec3() - self.center.as_dvec3(), ray.direction.as_dvec3());
        let normal = u_axis.cross(v_axis);
        let t = -origin.dot(normal) / direction.dot(normal);
        let within = t as f32 > 0.0 && (t as f32) < ray.t_max;
        let at: DVec3 = origin + t * direction;
        let (a, b) = (at.dot(u_axis) / u_axis.length_squared(), at.dot(v_axis) / v_axis.length_squared());
        (within && a * a + b * b <= 1.0).then_some((t as f32, Vec2::new(a as f32, b as f32)))
    }

    /// The surface at coordinates along the two half-axes.
    pub(crate) fn located(&self, at: Vec2) -> Located {
        let (a, b) = (at.x * self.u_axis, at.y * self.v_axis);
        let p = self.center + (a + b);
        let n = self.u_axis.as_dvec3().cross(self.v_axis.as_dvec3()).normalize().as_vec3();
        let ng = if self.flip_normals { -n } else { n };
        let phi = at.y.atan2(at.x);
        Located {
            p,
            p_error: ROUNDING * (2.0 * p.abs() + 6.0 * (a.abs() + b.abs())),
            ng,
            ns: ng,
            uv: Vec2::new(at.length(), if phi < 0.0 { phi + TAU } else { phi } / TAU),
        }
    }

    /// ∂p/∂u runs outwards, ∂p/∂v around. Degenerate at the centre, where ∂p/∂v = 0.
    pub(crate) fn tangents(&self, at: Vec2) -> Tangents {
        let out = at.try_normalize().unwrap_or(Vec2::X);
        let along = |v: Vec2| -> Vec3 { v.x * self.u_axis + v.y * self.v_axis };
        Tangents { dpdu: along(out), dpdv: TAU * along(at.perp()) }
    }
}
