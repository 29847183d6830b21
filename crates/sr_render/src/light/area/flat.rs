//! Flat pieces of lights: triangles, and pairs of them that are one parallelogram.

use glam::{DVec2, DVec3, Vec2, Vec3};
use sr_sampling::to_solid_angle;
use sr_sampling::warp::barycentrics;

use super::near::Reach;

/// The product of two edges, whose length is an area: in double precision, as the square of it is not in the range of
/// single precision for edges of 10¹⁰ units.
pub(super) fn cross(a: Vec3, b: Vec3) -> DVec3 {
    a.as_dvec3().cross(b.as_dvec3())
}

/// One triangle of an emitting mesh: what sampling needs, in one place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    positions: [Vec3; 3],
    uvs: [Vec2; 3],
    /// Unit normal of the emitting side; zero if there is no area.
    pub(super) normal: Vec3,
    /// From where it is sampled by solid angle.
    pub(super) reach: Reach,
    /// The density with which a point of it is drawn by area, in the inverse of a square unit of length.
    pub(super) pdf_area: f32,
}

impl Triangle {
    /// A triangle that shines to the side it is anticlockwise from; `uvs` are texture coordinates at its corners.
    pub(crate) fn new(positions: [Vec3; 3], uvs: [Vec2; 3]) -> Self {
        let [a, b, c] = positions;
        let normal = cross(b - a, c - a).normalize_or_zero().as_vec3();
        Self { positions, uvs, normal, reach: Reach::of(&positions), pdf_area: 0.0 }
    }

    #[inline(always)]
    pub(super) fn patch(&self) -> Patch {
        let [corner, b, c] = self.positions;
        Patch { corner, edges: [b - corner, c - corner], normal: self.normal, is_triangle: true }
    }

    /// Texture coordinates at coordinates along the edges.
    #[inline(always)]
    pub(super) fn uv(&self, at: Vec2) -> Vec2 {
        let [uv0, uv1, uv2] = self.uvs;
        uv0 + at.x * (uv1 - uv0) + at.y * (uv2 - uv0)
    }

    fn vertex(&self, i: usize) -> (Vec3, Vec2) {
        (self.positions[i], self.uvs[i])
    }
}

/// Two triangles that are one: sampled as a whole, so that strata survive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parallelogram {
    corner: Vec3,
    edges: [Vec3; 2],
    pub normal: Vec3,
    corner_uv: Vec2,
    edge_uvs: [Vec2; 2],
    /// From where it is sampled by solid angle: from nowhere if it is no rectangle.
    pub reach: Reach,
}

impl Parallelogram {
    /// The parallelogram that two triangles make, if they share a diagonal and its texture coordinates.
    pub fn from_triangles(triangles: &[Triangle]) -> Option<Self> {
        let [t, other] = triangles else { return None };
        let shared = |i: usize| (0..3).find(|&j| t.vertex(i) == other.vertex(j));
        // the corner of `t` that `other` lacks is the one between the edges
        let apex = (0..3).find(|&i| shared(i).is_none())?;
        let (next, last) = ((apex + 1) % 3, (apex + 2) % 3);
        let (j, k) = (shared(next)?, shared(last)?);
        let far = 3_usize.checked_sub(j + k).filter(|_| j != k)?;
        let (corner, corner_uv) = t.vertex(apex);
        let edges = [next, last].map(|i| t.vertex(i).0 - corner);
        let edge_uvs = [next, last].map(|i| t.vertex(i).1 - corner_uv);
        let (far, far_uv) = other.vertex(far);
        let size = edges[0].length() + edges[1].length();
        let is_flat = (corner + edges[0] + edges[1] - far).length() <= 1e-6 * size;
        let maps_flat = (corner_uv + edge_uvs[0] + edge_uvs[1] - far_uv).length() <= 1e-6;
        let is_rectangle = edges[0].dot(edges[1]).abs() <= 1e-5 * edges[0].length() * edges[1].length();
        let corners = [corner, corner + edges[0], corner + edges[1], corner + edges[0] + edges[1]];
        let reach = if is_rectangle { Reach::of(&corners) } else { Reach::NONE };
        let normal = t.normal;
        (is_flat && maps_flat).then_some(Self { corner, edges, normal, corner_uv, edge_uvs, reach })
    }

    #[inline(always)]
    pub fn patch(&self) -> Patch {
        Patch { corner: self.corner, edges: self.edges, normal: self.normal, is_triangle: false }
    }

    /// Texture coordinates at coordinates along the edges.
    #[inline(always)]
    pub fn uv(&self, at: Vec2) -> Vec2 {
        self.corner_uv + at.x * self.edge_uvs[0] + at.y * self.edge_uvs[1]
    }

    /// The coordinates along the edges of a point in the plane, in [0, 1).
    pub fn coordinates_of(&self, p: Vec3) -> Vec2 {
        let [e0, e1] = self.edges;
        let across = cross(e0, e1);
        let d = p - self.corner;
        let at = DVec2::new(cross(d, e1).dot(across), cross(e0, d).dot(across)) / across.length_squared();
        at.as_vec2().clamp(Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON / 2.0))
    }
}

/// A flat piece of a light: a parallelogram, or the half of one.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Patch {
    pub corner: Vec3,
    /// From the corner.
    pub edges: [Vec3; 2],
    /// Unit normal of the emitting side.
    pub normal: Vec3,
    pub is_triangle: bool,
}

/// A point of a light, seen from another point.
pub(in super::super) struct Seen {
    pub p: Vec3,
    /// Direction to it.
    pub wi: Vec3,
    /// Density in sr⁻¹; 0 if nothing is seen.
    pub pdf: f32,
}

impl Patch {
    /// Coordinates along the edges, uniform over the piece.
    #[inline(always)]
    pub fn coordinates(is_triangle: bool, u: Vec2) -> Vec2 {
        let b = barycentrics(u);
        if is_triangle { Vec2::new(b.y, b.z) } else { u }
    }

    /// Draws a point, with density `pdf_area` per square unit of length. Does not branch.
    #[inline(always)]
    pub fn sample(&self, pdf_area: f32, from: Vec3, u: Vec2) -> Seen {
        self.seen(Self::coordinates(self.is_triangle, u), pdf_area, from)
    }

    /// The point at coordinates along the edges that were drawn with density `pdf_area`. Does not branch.
    #[inline(always)]
    pub fn seen(&self, at: Vec2, pdf_area: f32, from: Vec3) -> Seen {
        let p = self.point(at);
        let to_light = p - from;
        let distance_squared = to_light.length_squared();
        let wi = to_light / distance_squared.sqrt();
        let cos_light = -self.normal.dot(wi);
        let pdf = to_solid_angle(pdf_area, distance_squared, cos_light);
        // The cosine is no number where the points coincide.
        let pdf = if cos_light > 0.0 && pdf < f32::INFINITY { pdf } else { 0.0 };
        Seen { p, wi, pdf }
    }

    /// The point at coordinates along the edges.
    #[inline(always)]
    pub fn point(&self, at: Vec2) -> Vec3 {
        self.corner + at.x * self.edges[0] + at.y * self.edges[1]
    }

    /// Surface area.
    pub fn area(&self) -> f32 {
        let parallelogram = cross(self.edges[0], self.edges[1]).length() as f32;
        if self.is_triangle { 0.5 * parallelogram } else { parallelogram }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_halves_of_a_square_are_one_parallelogram() {
        let at = |x: f32, y: f32| (Vec3::new(2.0 * x, y, 0.0), Vec2::new(x, y));
        let of = |corners: [(Vec3, Vec2); 3]| Triangle::new(corners.map(|c| c.0), corners.map(|c| c.1));
        let (a, b, c, d) = (at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0));
        for second in [[a, c, d], [c, d, a], [d, a, c]] {
            let q = Parallelogram::from_triangles(&[of([a, b, c]), of(second)]).unwrap();
            assert_eq!(q.corner, b.0);
            assert_eq!(q.corner + q.edges[0] + q.edges[1], d.0);
            let at = Vec2::new(0.25, 0.75);
            assert!((q.coordinates_of(q.patch().point(at)) - at).length() < 1e-6);
        }
        let bent = at(0.0, 1.1);
        assert!(Parallelogram::from_triangles(&[of([a, b, c]), of([a, c, bent])]).is_none());
        assert!(Parallelogram::from_triangles(&[of([a, b, c]), of([a, b, c])]).is_none());
        assert!(Parallelogram::from_triangles(&[of([a, b, c])]).is_none());
    }
}
