//! Bilinear patches: Reshetov 2019, "Cool patches", in `f64`.

use glam::{DVec3, Vec2, Vec3};

use crate::offset::ROUNDING;
use crate::surface::Located;
use crate::{Bounds3, Ray, Tangents};

/// The surface between four points, p(u, v) = bilinear in u and v. Its (u, v) are these.
///
/// The front is where ∂p/∂u × ∂p/∂v points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BilinearPatch {
    /// p(0, 0), p(1, 0), p(0, 1), p(1, 1).
    pub corners: [Vec3; 4],
    /// Does the normal point against ∂p/∂u × ∂p/∂v?
    pub flip_normals: bool,
}

impl BilinearPatch {
    /// The smallest t in (0, `t_max`) at which the ray meets the patch, and the (u, v) there.
    ///
    /// A line u = const of the patch meets the ray where their distance is 0: a quadratic in u. Watertight up to the
    /// rounding of `f64` where patches share the corners of an edge.
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<(f32, Vec2)> {
        let origin = ray.origin.as_dvec3();
        let d = ray.direction.as_dvec3();
        let [p00, p10, p01, p11] = self.corners.map(|p| p.as_dvec3() - origin);
        // The edges u = 0 and u = 1, and those of v = 0 and v = 1, from the ray's origin.
        let (e00, e11) = (p01 - p00, p11 - p10);
        let along_u = [p10 - p00, p11 - p01];
        let a = p00.cross(d).dot(e00);
        let c = (p01 - p00 + p10 - p11).cross(d).dot(along_u[0]);
        let b = p10.cross(d).dot(e11) - a - c;
        let mut nearest: Option<(f64, f64, f64)> = None;
        for u in quadratic(a, b, c).into_iter().flatten() {
            if !(0.0..=1.0).contains(&u) {
                continue;
            }
            let on_edge: DVec3 = p00.lerp(p10, u);
            let line = e00.lerp(e11, u);
            // where the ray and the line are closest
            let n = d.cross(line);
            let squared = n.length_squared();
            let across = n.cross(on_edge);
            let (t, v) = (across.dot(line) / squared, across.dot(d) / squared);
            let is_nearer = nearest.is_none_or(|(best, _, _)| t < best);
            if (0.0..=1.0).contains(&v) && t as f32 > 0.0 && (t as f32) < ray.t_max && is_nearer {
                nearest = Some((t, u, v));
            }
        }
        nearest.map(|(t, u, v)| (t as f32, Vec2::new(u as f32, v as f32)))
    }

    pub(crate) fn bounds(&self) -> Bounds3 {
        self.corners.into_iter().fold(Bounds3::EMPTY, Bounds3::with).padded()
    }

    /// The surface at (u, v).
    pub(crate) fn located(&self, uv: Vec2) -> Located {
        let [p00, p10, p01, p11] = self.corners.map(Vec3::as_dvec3);
        let (u, v) = (f64::from(uv.x), f64::from(uv.y));
        let p = p00.lerp(p10, u).lerp(p01.lerp(p11, u), v).as_vec3();
        let Tangents { dpdu, dpdv } = self.tangents(uv);
        let n = dpdu.as_dvec3().cross(dpdv.as_dvec3());
        // At a corner where two are the same, the patch's middle tells the front.
        let middle = (p10 - p00 + p11 - p01).cross(p01 - p00 + p11 - p10);
        let n = n.try_normalize().or(middle.try_normalize()).unwrap_or(DVec3::Z).as_vec3();
        let ng = if self.flip_normals { -n } else { n };
        let size = self.corners.iter().map(|c| (*c - p).abs().max_element()).fold(0.0, f32::max);
        // (u, v) are rounded, and so is the next ray's test of a patch of this size.
        let p_error = ROUNDING * (4.0 * p.abs() + Vec3::splat(16.0 * size));
        Located { p, p_error, ng, ns: ng, uv }
    }

    pub(crate) fn tangents(&self, uv: Vec2) -> Tangents {
        let [p00, p10, p01, p11] = self.corners;
        Tangents { dpdu: (p10 - p00).lerp(p11 - p01, uv.y), dpdv: (p01 - p00).lerp(p11 - p10, uv.x) }
    }
}

/// The real roots of a + b x + c x² = 0.
fn quadratic(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    if c == 0.0 {
        let root = -a / b;
        return [root.is_finite().then_some(root), None];
    }
    let discriminant = b * b - 4.0 * a * c;
    if !(discriminant >= 0.0) {
        return [None, None];
    }
    // the root without cancellation, and the other by their product
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let other = a / q;
    [Some(q / c), other.is_finite().then_some(other)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_solve_the_equation() {
        for (a, b, c) in [(6.0, -5.0, 1.0), (0.0, 2.0, -1.0), (1.0, -2.0, 0.0), (1e-12, -1.0, 1.0)] {
            let roots: Vec<f64> = quadratic(a, b, c).into_iter().flatten().collect();
            assert_eq!(roots.len(), if c == 0.0 { 1 } else { 2 });
            for x in roots {
                assert!((a + b * x + c * x * x).abs() < 1e-15, "{a}, {b}, {c}: {x}");
            }
        }
        assert_eq!(quadratic(1.0, 0.0, 1.0), [None, None]);
        assert_eq!(quadratic(1.0, 0.0, 0.0), [None, None]);
    }
}
