//! A rectangle (or parallelogram) in space, by area.

use glam::{Vec2, Vec3};
use thiserror::Error;

use super::clamp_unit;
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::Area;

/// A rectangle without an area, or whose area is not a finite number.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("the rectangle at {corner} with edges {edges:?} has no area that can be sampled")]
pub struct DegenerateRectangle {
    /// The corner given.
    pub corner: Vec3,
    /// The edges given.
    pub edges: [Vec3; 2],
}

/// Uniform over a parallelogram; pdf = 1 / area.
#[derive(Clone, Copy, Debug)]
pub struct UniformRectangle {
    corner: Vec3,
    edges: [Vec3; 2],
    cross: Vec3,
    area: f32,
}

impl UniformRectangle {
    /// The parallelogram of a corner and the two edges that leave it.
    ///
    /// # Errors
    /// If the edges are parallel, or the area is not a positive finite number with a finite inverse.
    pub fn new(corner: Vec3, edges: [Vec3; 2]) -> Result<Self, DegenerateRectangle> {
        let cross = edges[0].cross(edges[1]);
        let area = cross.length();
        if !(area.is_normal() && area.recip().is_normal() && corner.is_finite()) {
            return Err(DegenerateRectangle { corner, edges });
        }
        Ok(Self { corner, edges, cross, area })
    }

    /// The area.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// Coordinates along the edges, if the point lies in the parallelogram up to rounding.
    fn locate(&self, x: Vec3) -> Option<Vec2> {
        let [e0, e1] = self.edges;
        let normal = self.cross / self.area;
        let d = x - self.corner;
        let at = Vec2::new(d.cross(e1).dot(normal), e0.cross(d).dot(normal)) / self.area;
        let slack = 16.0 * f32::EPSILON * (self.corner.abs() + e0.abs() + e1.abs()).max_element();
        let rim = slack * e0.length().max(e1.length()) / self.area + 16.0 * f32::EPSILON;
        let inside = at.min_element() >= -rim && at.max_element() <= 1.0 + rim;
        (inside && d.dot(normal).abs() <= slack).then_some(at)
    }
}

impl Distribution for UniformRectangle {
    type Measure = Area;
    type Uniform = Vec2;

    #[inline]
    fn sample(&self, u: Vec2) -> Option<Sample<Area>> {
        Some(Sample { value: self.corner + u.x * self.edges[0] + u.y * self.edges[1], pdf: 1.0 / self.area })
    }

    fn pdf(&self, x: Vec3) -> f32 {
        if self.locate(x).is_some() { 1.0 / self.area } else { 0.0 }
    }
}

impl Invert for UniformRectangle {
    fn invert(&self, x: Vec3) -> Option<Vec2> {
        self.locate(x).map(|at| Vec2::new(clamp_unit(at.x), clamp_unit(at.y)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    #[test]
    fn samples_are_in_the_support_and_neighbours_are_not() {
        let corner = Vec3::new(-5.0, 40.0, 7.0);
        let edges = [Vec3::new(2.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 3.0)];
        let rectangle = UniformRectangle::new(corner, edges).unwrap();
        assert_eq!(rectangle.area(), 6.0);
        for u in uniforms() {
            let s = rectangle.sample(u).unwrap();
            assert_eq!(rectangle.pdf(s.value), s.pdf, "{u}");
            assert!((rectangle.invert(s.value).unwrap() - u).length() < 1e-5);
        }
        for (x, y) in [(-0.1, 0.5), (1.1, 0.5), (0.5, -0.1), (0.5, 1.1)] {
            assert_eq!(rectangle.pdf(corner + x * edges[0] + y * edges[1]), 0.0);
        }
    }

    #[test]
    fn no_area_no_rectangle() {
        let error = UniformRectangle::new(Vec3::ZERO, [Vec3::X, -Vec3::X]).unwrap_err();
        assert_eq!(error.edges, [Vec3::X, -Vec3::X]);
    }
}
