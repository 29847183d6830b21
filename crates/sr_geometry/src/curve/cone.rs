//! A segment of a linear curve: the spheres between two spheres, whose surface is a cone and two caps.

use glam::{DVec3, DVec4, Vec4};

use super::CurvePoint;
use crate::Ray;

/// All spheres whose centre and radius are between those of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoundCone {
    /// The centres.
    centers: [DVec3; 2],
    radii: [f64; 2],
}

/// How far inside another cone a point must be to be hidden, of the radius.
const INSIDE: f64 = 1e-6;

impl RoundCone {
    pub fn new(a: Vec4, b: Vec4) -> Self {
        let ends = [a, b].map(|p| p.as_dvec4());
        Self { centers: ends.map(DVec4::truncate), radii: ends.map(|p| p.w) }
    }

    /// Centre and radius of a sphere between the ends.
    pub fn at(&self, u: f64) -> DVec4 {
        let [a, b] = [0, 1].map(|i| self.centers[i].extend(self.radii[i]));
        a.lerp(b, u)
    }

    /// The smallest t in (0, `t_max`) at which the ray meets the surface from outside where nothing `hides` it, and
    /// which sphere touches the surface there.
    pub fn meet(&self, ray: &Ray, hides: impl Fn(DVec3) -> bool) -> Option<(f64, f64)> {
        let [a, b] = self.centers;
        let [ra, rb] = self.radii;
        let direction = ray.direction.as_dvec3();
        let speed = direction.length();
        let d = direction / speed;
        // Distances count from where the ray is next to the middle, so that nothing cancels.
        let shift = (0.5 * (a + b) - ray.origin.as_dvec3()).dot(d);
        let origin = ray.origin.as_dvec3() + shift * d;
        let (axis, narrowing) = (b - a, ra - rb);
        let (from_a, from_b) = (origin - a, origin - b);
        let (length2, along, across) = (axis.length_squared(), axis.dot(from_a), axis.dot(d));
        // Where one end is inside the other, there is no cone.
        let slant2 = length2 - narrowing * narrowing;
        let mut best: Option<(f64, f64)> = None;
        let mut consider = |t: f64, u: f64| {
            let met = (t + shift) / speed;
            let within = met as f32 > 0.0 && (met as f32) < ray.t_max;
            let is_first = best.is_none_or(|(best, _)| met < best);
            if within && is_first && !hides(origin + t * d) {
                best = Some((met, u));
            }
        };
        if slant2 > 0.0 {
            // Inigo Quilez, "Rounded cone - intersection": the cone that touches all spheres.
            let k2 = slant2 - across * across;
            let k1 = slant2 * from_a.dot(d) - along * across + across * narrowing * ra;
            let k0 = slant2 * from_a.length_squared() - along * along + 2.0 * along * narrowing * ra
                - length2 * ra * ra;
            let root = (k1 * k1 - k0 * k2).sqrt();
            for t in [(-k1 - root) / k2, (-k1 + root) / k2] {
                let y = along - ra * narrowing + t * across;
                let is_outside = (slant2 * (from_a + t * d) - axis * y).dot(d) < 0.0;
                if y >= 0.0 && y <= slant2 && is_outside && ra + (rb - ra) * y / slant2 >= 0.0 {
                    consider(t, y / slant2);
                }
            }
        }
        for (u, center, radius) in [(0.0, from_a, ra), (1.0, from_b, rb)] {
            let half_b = center.dot(d);
            let root = (radius * radius - (center - half_b * d).length_squared()).sqrt();
            let t = -half_b - root;
            // A cap is beyond the circle in which its sphere touches the cone.
            let beyond = (center + t * d).dot(axis) - radius * narrowing;
            let is_cap = if slant2 > 0.0 {
                if u == 0.0 { beyond <= 0.0 } else { beyond >= 0.0 }
            } else {
                radius == ra.max(rb)
            };
            if is_cap && root >= 0.0 {
                consider(t, u);
            }
        }
        best
    }

    /// Is a point inside, and not just by rounding?
    pub fn holds(&self, p: DVec3) -> bool {
        let [a, b] = self.centers;
        let [ra, rb] = self.radii;
        let (axis, narrowing) = (b - a, ra - rb);
        let slant2 = axis.length_squared() - narrowing * narrowing;
        let deeper = |u: f64| {
            let sphere = self.at(u);
            sphere.w - (p - sphere.truncate()).length() > INSIDE * ra.max(rb)
        };
        if slant2 <= 0.0 {
            return deeper(if ra > rb { 0.0 } else { 1.0 });
        }
        // The sphere that comes closest: from the foot on the axis, along the slant.
        let y = (p - a).dot(axis);
        let length = axis.length();
        let off = ((p - a).length_squared() - (y / length).powi(2)).max(0.0).sqrt();
        let u = (y / length - off * narrowing / slant2.sqrt()) / length;
        deeper(u.clamp(0.0, 1.0))
    }

    /// The point of the surface that the sphere at `u` touches closest to `near`.
    pub fn point(&self, u: f64, near: DVec3) -> CurvePoint {
        let sphere = self.at(u);
        let (center, radius) = (sphere.truncate(), sphere.w);
        let chord = self.centers[1] - self.centers[0];
        let axis = chord.normalize_or(DVec3::Z);
        let out = (near - center).try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        let along = chord + (self.radii[1] - self.radii[0]) * out;
        CurvePoint { p: center + radius * out, radius, out, axis, normal: out, along }
    }
}
