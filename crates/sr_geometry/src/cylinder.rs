//! Open cylinders, intersected in `f64`, as spheres are.

use std::f32::consts::TAU;

use glam::{DVec2, DVec3, Mat3, Vec2, Vec3};

use crate::offset::ROUNDING;
use crate::surface::Located;
use crate::{Bounds3, Ray, Tangents};

/// An open cylinder. Its (u, v) are (φ / 2π, z / `length`) in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Centre of the circle at z = 0.
    pub base: Vec3,
    /// Orthonormal: +X, +Y, +Z of the cylinder's own frame, +Z along the axis. May be mirrored.
    pub frame: Mat3,
    /// Radius, positive.
    pub radius: f32,
    /// From one end to the other, positive.
    pub length: f32,
    /// Do normals point to the axis?
    pub flip_normals: bool,
}

impl Cylinder {
    /// The smallest t in (0, `t_max`) at which the ray meets the cylinder, from outside or inside.
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<f32> {
        let frame = self.frame.as_dmat3().transpose();
        let (radius, length) = (f64::from(self.radius), f64::from(self.length));
        let origin = frame * (ray.origin.as_dvec3() - self.base.as_dvec3());
        let direction = frame * ray.direction.as_dvec3();
        let (to_origin, across) = (origin.truncate(), direction.truncate());
        let a = across.length_squared();
        let half_b = to_origin.dot(across);
        // The discriminant from the ray's distance to the axis does not cancel (Hearn & Baker 2004).
        let closest: DVec2 = to_origin - half_b / a * across;
        let root = a * (radius * radius - closest.length_squared());
        if root.is_nan() || root < 0.0 {
            return None;
        }
        let q = -half_b - root.sqrt().copysign(half_b);
        let c = (to_origin.length() - radius) * (to_origin.length() + radius);
        let (t0, t1) = (q / a, c / q);
        let within = |t: f64| {
            let z = origin.z + t * direction.z;
            t as f32 > 0.0 && (t as f32) < ray.t_max && z >= 0.0 && z <= length
        };
        [t0.min(t1), t0.max(t1)].into_iter().find(|&t| within(t)).map(|t| t as f32)
    }

    pub(crate) fn bounds(&self) -> Bounds3 {
        let (x, y, z) = (self.frame.x_axis, self.frame.y_axis, self.frame.z_axis);
        let half = self.radius * (x * x + y * y).map(f32::sqrt);
        let ends = [self.base, self.base + self.length * z];
        Bounds3 { min: ends[0].min(ends[1]) - half, max: ends[0].max(ends[1]) + half }.padded()
    }

    /// The surface at the point closest to `near`, which lies close to it.
    pub(crate) fn located(&self, near: Vec3) -> Located {
        let local = self.frame.as_dmat3().transpose() * (near.as_dvec3() - self.base.as_dvec3());
        let around = local.truncate().try_normalize().unwrap_or(DVec2::X);
        let along = local.z.clamp(0.0, f64::from(self.length));
        let out = (self.frame.as_dmat3() * around.extend(0.0)).as_vec3();
        let on_axis: DVec3 = along * self.frame.z_axis.as_dvec3();
        let p = (self.base.as_dvec3() + on_axis + f64::from(self.radius) * out.as_dvec3()).as_vec3();
        let ng = if self.flip_normals { -out } else { out };
        let phi = around.y.atan2(around.x) as f32;
        Located {
            p,
            p_error: 2.0 * ROUNDING * p.abs() + Vec3::splat(8.0 * ROUNDING * (self.radius + self.length)),
            ng,
            ns: ng,
            uv: Vec2::new(if phi < 0.0 { phi + TAU } else { phi } / TAU, along as f32 / self.length),
        }
    }

    /// ∂p/∂u runs around, ∂p/∂v along the axis.
    pub(crate) fn tangents(&self, p: Vec3) -> Tangents {
        let local = self.frame.transpose() * (p - self.base);
        Tangents {
            dpdu: self.frame * (TAU * Vec3::new(-local.y, local.x, 0.0)),
            dpdv: self.length * self.frame.z_axis,
        }
    }
}
