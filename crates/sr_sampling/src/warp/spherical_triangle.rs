//! A triangle as it is seen from a point: uniform by solid angle.

use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec3};

use super::{DegenerateTriangle, clamp_unit};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::SolidAngle;

/// Directions to a triangle, all equally likely; pdf = 1 / solid angle, in sr⁻¹.
///
/// James Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995: the first uniform cuts
/// off a sub-triangle `a b c'` of that share of the area, `c'` on the edge `a c`; the second picks a
/// point on the arc `b c'`. Worked in double precision and in half-angles, so that small triangles
/// keep their digits.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    a: DVec3,
    b: DVec3,
    /// Unit tangent at `a` along the arc towards `c`.
    towards_c: DVec3,
    /// Inward unit normals of the planes of the edges `a b`, `b c`, `c a`.
    inward: [DVec3; 3],
    /// Angle at `a`.
    alpha: f64,
    /// Tangent of half the arc `a b`.
    tan_half_ab: f64,
    solid_angle: f64,
}

/// How far, in radians, rounding to `f32` may push a direction over an edge.
const EDGE: f64 = 2e-7;

impl SphericalTriangle {
    /// The triangle of three vertices, as seen from `at`.
    ///
    /// # Errors
    /// If `at` lies in the plane of the triangle or on a vertex, or the solid angle is too small for
    /// directions in single precision to resolve (below 10⁻¹⁰ sr).
    pub fn new(vertices: [Vec3; 3], at: Vec3) -> Result<Self, DegenerateTriangle> {
        let degenerate = || DegenerateTriangle { vertices };
        let towards = |p: Vec3| (p.as_dvec3() - at.as_dvec3()).try_normalize();
        let [a, b, c] = vertices.map(towards);
        let (a, mut b, mut c) =
            (a.ok_or_else(degenerate)?, b.ok_or_else(degenerate)?, c.ok_or_else(degenerate)?);
        if a.dot(b.cross(c)) < 0.0 {
            (b, c) = (c, b);
        }
        let solid_angle = solid_angle(a, b, c);
        let normal = |from: DVec3, to: DVec3| from.cross(to - from).try_normalize();
        let (Some(ab), Some(bc), Some(ca)) = (normal(a, b), normal(b, c), normal(c, a)) else {
            return Err(degenerate());
        };
        if !(1e-10..2.0 * PI).contains(&solid_angle) {
            return Err(degenerate());
        }
        let alpha = ab.cross(-ca).length().atan2(ab.dot(-ca));
        let tan_half_ab = (b - a).length() / (b + a).length();
        Ok(Self { a, b, towards_c: a.cross(ca), inward: [ab, bc, ca], alpha, tan_half_ab, solid_angle })
    }

    /// The solid angle, in sr.
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// The point `c'` on the arc `a c` whose triangle `a b c'` has this area.
    ///
    /// From tan(E/2) = tan(b/2) tan(c/2) sin A / (1 + tan(b/2) tan(c/2) cos A) (Todhunter, *Spherical
    /// Trigonometry*, §103), solved for the arc b = a c'.
    fn cut(&self, area: f64) -> DVec3 {
        let opposite = (0.5 * area).sin();
        let adjacent = self.tan_half_ab * (self.alpha - 0.5 * area).sin();
        let square = opposite * opposite + adjacent * adjacent;
        let cos = (adjacent * adjacent - opposite * opposite) / square;
        let sin = 2.0 * opposite * adjacent / square;
        cos * self.a + sin * self.towards_c
    }
}

/// The solid angle of three unit vectors, counted positive anticlockwise (Van Oosterom & Strackee 1983).
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    // The triple product from the edges: from the vertices it would cancel for small triangles.
    let triple = a.dot((b - a).cross(c - a));
    2.0 * triple.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

impl Distribution for SphericalTriangle {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let c = self.cut(f64::from(u.x) * self.solid_angle);
        let chord = c - self.b;
        // 1 − cos of the arc b c', and of the part of it that u.y selects.
        let full = 0.5 * chord.length_squared();
        let part = f64::from(u.y) * full;
        let tangent = (chord + full * self.b).normalize_or_zero();
        let w = (1.0 - part) * self.b + (part * (2.0 - part)).max(0.0).sqrt() * tangent;
        Some(Sample { value: w.as_vec3(), pdf: 1.0 / self.solid_angle() })
    }

    fn pdf(&self, w: Vec3) -> f32 {
        let w = w.as_dvec3();
        if self.inward.iter().all(|n| n.dot(w) >= -EDGE) { 1.0 / self.solid_angle() } else { 0.0 }
    }
}

impl Invert for SphericalTriangle {
    /// The first uniform is arbitrary at `b`, where all arcs meet.
    fn invert(&self, w: Vec3) -> Option<Vec2> {
        if self.pdf(w) == 0.0 {
            return None;
        }
        let w = w.as_dvec3();
        let plane = self.b.cross(w - self.b);
        let Some(mut c) = plane.cross(self.inward[2]).try_normalize() else {
            return Some(Vec2::ZERO);
        };
        if plane.cross(self.b).dot(c) < 0.0 {
            c = -c;
        }
        let x = solid_angle(self.a, self.b, c) / self.solid_angle;
        let y = (w - self.b).length_squared() / (c - self.b).length_squared();
        Some(Vec2::new(clamp_unit(x as f32), clamp_unit(y as f32)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    /// Vertices as seen from the origin: an octant, slivers, both orientations, small and vast.
    fn cases() -> Vec<SphericalTriangle> {
        let small = Vec3::new(0.3, -0.2, 1.0);
        [
            [Vec3::X, Vec3::Y, Vec3::Z],
            [Vec3::X, Vec3::Z, Vec3::Y],
            [Vec3::new(1.0, 0.0, 0.1), Vec3::new(-1.0, 0.1, 0.1), Vec3::new(0.0, 2.0, 0.3)],
            [small, small + Vec3::new(1e-3, 0.0, 0.0), small + Vec3::new(0.0, 2e-3, 0.0)],
            [small, small + Vec3::new(0.01, 0.0, 0.0), small + Vec3::new(0.5, 0.01, 0.0)],
            [Vec3::new(9.0, -8.0, -0.1), Vec3::new(-9.0, -8.0, -0.1), Vec3::new(0.0, 9.0, -0.1)],
        ]
        .map(|vertices| SphericalTriangle::new(vertices, Vec3::ZERO).unwrap())
        .to_vec()
    }

    #[test]
    fn known_solid_angles() {
        let octant = SphericalTriangle::new([Vec3::X, Vec3::Y, Vec3::Z], Vec3::ZERO).unwrap();
        assert!((octant.solid_angle - PI / 2.0).abs() < 1e-14);
        // A facet of the cube [−1, 1]³, halved: 4π / 12.
        let corners = [Vec3::new(-1.0, -1.0, 1.0), Vec3::new(1.0, -1.0, 1.0), Vec3::ONE];
        let facet = SphericalTriangle::new(corners, Vec3::ZERO).unwrap();
        assert!((facet.solid_angle - PI / 3.0).abs() < 1e-14);
    }

    #[test]
    fn samples_are_unit_vectors_in_the_triangle_and_invert() {
        for triangle in cases() {
            for u in uniforms() {
                let s = triangle.sample(u).unwrap();
                assert!((s.value.length() - 1.0).abs() < 1e-6);
                assert_eq!(triangle.pdf(s.value), s.pdf, "{u} of {triangle:?}");
                // Rounding a direction to f32 moves it by 6·10⁻⁸: by that over the width, in the square.
                let tolerance = 4e-7 / f64::from(triangle.solid_angle()) / f64::from(u.y).sqrt().max(1e-9);
                let error = (triangle.invert(s.value).unwrap() - u).length();
                assert!(f64::from(error) < tolerance.max(1e-5), "{u}: {error} of {triangle:?}");
            }
            assert_eq!(triangle.pdf(-triangle.a.as_vec3()), 0.0);
        }
    }

    /// Each half of the first uniform holds half the area.
    #[test]
    fn the_cut_has_the_area_asked_for() {
        for triangle in cases() {
            for share in [1e-6, 0.01, 0.3, 0.5, 0.99, 1.0] {
                let area = solid_angle(triangle.a, triangle.b, triangle.cut(share * triangle.solid_angle));
                let relative = area / (share * triangle.solid_angle) - 1.0;
                assert!(relative.abs() < 1e-7, "{share}: {relative} of {triangle:?}");
            }
        }
    }

    #[test]
    fn seen_edge_on_it_is_nothing() {
        let vertices = [Vec3::X, Vec3::Y, Vec3::X + Vec3::Y];
        assert!(SphericalTriangle::new(vertices, Vec3::ZERO).is_err());
        assert!(SphericalTriangle::new(vertices, Vec3::X).is_err());
        assert!(SphericalTriangle::new([Vec3::NAN; 3], Vec3::ZERO).is_err());
    }
}
