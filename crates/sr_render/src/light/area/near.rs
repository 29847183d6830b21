//! Flat pieces of lights seen from nearby: sampled by solid angle.
//!
//! By area, the density of a direction is r² / cos θ: from nearby it varies by orders of magnitude over one light, and
//! so does what is divided by it. By solid angle it is the same for all of the light, at the price of a few
//! transcendental functions in double precision, which far from the light buy nothing.

use glam::{Vec2, Vec3};
use sr_sampling::warp::{SphericalRectangle, SphericalTriangle};
use sr_sampling::{Distribution, Sample};

use super::flat::{Patch, Seen};

/// How far solid angles pay, in distances from a piece's middle to its farthest corner. See docs/performance.md.
const NEAR: f32 = 1.0;

/// The points from which a piece is sampled by solid angle: within a ball about it, on the side it shines to.
///
/// Sampling and its density ask [`Reach::holds`] about the same numbers, so they cannot disagree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    middle: Vec3,
    radius_squared: f32,
}

impl Reach {
    /// From nowhere.
    pub const NONE: Self = Self { middle: Vec3::ZERO, radius_squared: 0.0 };

    /// About the corners of a piece.
    pub fn of(corners: &[Vec3]) -> Self {
        let middle = corners.iter().sum::<Vec3>() / corners.len() as f32;
        let farthest = corners.iter().map(|c| c.distance_squared(middle)).fold(0.0, f32::max);
        Self { middle, radius_squared: NEAR * NEAR * farthest }
    }

    /// Is a piece with this normal sampled by solid angle from this point?
    #[inline(always)]
    pub fn holds(&self, from: Vec3, normal: Vec3) -> bool {
        let d = from - self.middle;
        (d.length_squared() < self.radius_squared) & (d.dot(normal) > 0.0)
    }
}

impl Patch {
    /// Draws a point uniformly by solid angle, with its coordinates along the edges. `None` where rounding leaves no
    /// solid angle to draw from; then [`Patch::solid_angle`] is `None` as well. The piece must be a triangle or a
    /// rectangle.
    #[inline(never)]
    pub fn sample_near(&self, from: Vec3, u: Vec2) -> Option<(Seen, Vec2)> {
        let (at, pdf) = if self.is_triangle {
            let triangle = self.triangle_from(from)?;
            let Sample { value, pdf } = triangle.sample(u)?;
            (self.met_by(from, value), pdf)
        } else {
            let rectangle = SphericalRectangle::new(self.corner, self.edges, from).ok()?;
            (rectangle.place(u), 1.0 / rectangle.solid_angle())
        };
        let p = self.point(at);
        let wi = (p - from).normalize_or_zero();
        let pdf = if wi.dot(self.normal) < 0.0 { pdf } else { 0.0 };
        Some((Seen { p, wi, pdf }, at))
    }

    /// The solid angle that [`Patch::sample_near`] draws from.
    #[inline(never)]
    pub fn solid_angle(&self, from: Vec3) -> Option<f32> {
        if self.is_triangle {
            Some(self.triangle_from(from)?.solid_angle())
        } else {
            Some(SphericalRectangle::new(self.corner, self.edges, from).ok()?.solid_angle())
        }
    }

    fn triangle_from(&self, from: Vec3) -> Option<SphericalTriangle> {
        let vertices = [self.corner, self.corner + self.edges[0], self.corner + self.edges[1]];
        SphericalTriangle::new(vertices, from).ok()
    }

    /// Where the triangle's plane is met in direction `w`: coordinates along the edges, within the triangle.
    fn met_by(&self, from: Vec3, w: Vec3) -> Vec2 {
        // Möller & Trumbore 1997, in double precision: grazing directions cancel.
        let [e0, e1] = self.edges.map(|e| e.as_dvec3());
        let (w, to_viewer) = (w.as_dvec3(), from.as_dvec3() - self.corner.as_dvec3());
        let across = w.cross(e1);
        let determinant = e0.dot(across);
        let x = to_viewer.dot(across) / determinant;
        let y = w.dot(to_viewer.cross(e0)) / determinant;
        let (x, y) = (x.clamp(0.0, 1.0), y.clamp(0.0, 1.0));
        let excess = (x + y).max(1.0);
        Vec2::new((x / excess) as f32, (y / excess) as f32)
    }
}
