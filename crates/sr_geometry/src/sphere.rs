//! Analytic spheres, intersected in `f64`: an origin that lies outside in `f32` stays outside.

use std::f32::consts::{PI, TAU};

use glam::{DVec3, Vec2, Vec3};

use crate::offset::ROUNDING;
use crate::surface::Located;
use crate::{Ray, Sphere, Tangents};

impl Sphere {
    /// The smallest t in (0, `t_max`) at which the ray meets the sphere, from outside or inside.
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<f32> {
        let (direction, radius) = (ray.direction.as_dvec3(), f64::from(self.radius));
        let to_origin = ray.origin.as_dvec3() - self.center.as_dvec3();
        let a = direction.length_squared();
        let half_b = to_origin.dot(direction);
        // The discriminant from the ray's distance to the centre does not cancel (Hearn & Baker 2004).
        let closest = to_origin - half_b / a * direction;
        let root = a * (radius * radius - closest.length_squared());
        if root.is_nan() || root < 0.0 {
            return None;
        }
        let q = -half_b - root.sqrt().copysign(half_b);
        let c = (to_origin.length() - radius) * (to_origin.length() + radius);
        let (t0, t1) = (q / a, c / q);
        let within = |t: f64| t as f32 > 0.0 && (t as f32) < ray.t_max;
        [t0.min(t1), t0.max(t1)].into_iter().find(|&t| within(t)).map(|t| t as f32)
    }

    /// The surface at the point closest to `near`, which lies close to it.
    pub(crate) fn located(&self, near: Vec3) -> Located {
        let out = (near.as_dvec3() - self.center.as_dvec3()).try_normalize().unwrap_or(DVec3::Z).as_vec3();
        let p = self.center + self.radius * out;
        let ng = if self.flip_normals { -out } else { out };
        let local = self.frame.transpose() * out;
        let phi = local.y.atan2(local.x);
        let theta = local.x.hypot(local.y).atan2(local.z);
        Located {
            p,
            p_error: 2.0 * ROUNDING * p.abs() + Vec3::splat(8.0 * ROUNDING * self.radius),
            ng,
            ns: ng,
            uv: Vec2::new(if phi < 0.0 { phi + TAU } else { phi } / TAU, theta / PI),
        }
    }

    /// ∂p/∂u runs east, ∂p/∂v south. Degenerate at the poles, where ∂p/∂u = 0.
    pub(crate) fn tangents(&self, p: Vec3) -> Tangents {
        let local = self.frame.transpose() * (p - self.center);
        let from_axis = local.x.hypot(local.y);
        let (sin_phi, cos_phi) =
            if from_axis > 0.0 { (local.y / from_axis, local.x / from_axis) } else { (0.0, 1.0) };
        Tangents {
            dpdu: self.frame * (TAU * Vec3::new(-local.y, local.x, 0.0)),
            dpdv: self.frame * (PI * Vec3::new(local.z * cos_phi, local.z * sin_phi, -from_axis)),
        }
    }
}
