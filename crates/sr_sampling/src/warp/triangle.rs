//! A triangle in space, by area.

use glam::{Vec2, Vec3};
use thiserror::Error;

use super::clamp_unit;
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::Area;

/// A triangle without an area, or whose area is not a finite number.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("the triangle {vertices:?} has no area that can be sampled")]
pub struct DegenerateTriangle {
    /// The vertices given.
    pub vertices: [Vec3; 3],
}

/// Barycentric coordinates, uniform by area, of the vertices 0, 1 and 2.
///
/// Eric Heitz, "A Low-Distortion Map Between Triangle and Square", 2019: neighbours stay neighbours,
/// without the corner that the square-root map crowds.
#[inline]
pub fn barycentrics(u: Vec2) -> Vec3 {
    let (b0, b1) = if u.y > u.x { (0.5 * u.x, u.y - 0.5 * u.x) } else { (u.x - 0.5 * u.y, 0.5 * u.y) };
    Vec3::new(b0, b1, (1.0 - b0 - b1).max(0.0))
}

/// The uniforms that [`barycentrics`] maps to `b`.
pub fn invert_barycentrics(b: Vec3) -> Vec2 {
    let (x, y) = if b.y > b.x { (2.0 * b.x, b.x + b.y) } else { (b.x + b.y, 2.0 * b.y) };
    Vec2::new(clamp_unit(x), clamp_unit(y))
}

/// Uniform over a triangle; pdf = 1 / area, in the inverse of its square unit of length.
#[derive(Clone, Copy, Debug)]
pub struct UniformTriangle {
    vertices: [Vec3; 3],
    /// The cross product of two edges: along the normal, of length twice the area.
    cross: Vec3,
    area: f32,
}

impl UniformTriangle {
    /// The triangle of three vertices.
    ///
    /// # Errors
    /// If they lie on a line, or the area is not a positive finite number with a finite inverse.
    pub fn new(vertices: [Vec3; 3]) -> Result<Self, DegenerateTriangle> {
        let cross = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]);
        let area = 0.5 * cross.length();
        if !(area.is_normal() && area.recip().is_normal()) {
            return Err(DegenerateTriangle { vertices });
        }
        Ok(Self { vertices, cross, area })
    }

    /// The area.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// The barycentric coordinates of a point, if it lies in the triangle up to rounding.
    fn locate(&self, x: Vec3) -> Option<Vec3> {
        let [a, b, c] = self.vertices;
        let length = 2.0 * self.area;
        let normal = self.cross / length;
        let part = |from: Vec3, to: Vec3| (from - x).cross(to - x).dot(normal) / length;
        let at = Vec3::new(part(b, c), part(c, a), part(a, b));
        // A position is rounded relative to its distance from the origin, not to the triangle's size.
        let slack = 16.0 * f32::EPSILON * (a.abs() + b.abs() + c.abs()).max_element();
        let width = [b - a, c - b, a - c].map(Vec3::length).into_iter().fold(0.0, f32::max);
        let inside = at.min_element() >= -(slack * width / length + 16.0 * f32::EPSILON);
        (inside && (x - a).dot(normal).abs() <= slack).then_some(at)
    }
}

impl Distribution for UniformTriangle {
    type Measure = Area;
    type Uniform = Vec2;

    #[inline]
    fn sample(&self, u: Vec2) -> Option<Sample<Area>> {
        let at = barycentrics(u);
        let value = at.x * self.vertices[0] + at.y * self.vertices[1] + at.z * self.vertices[2];
        Some(Sample { value, pdf: 1.0 / self.area })
    }

    fn pdf(&self, x: Vec3) -> f32 {
        if self.locate(x).is_some() { 1.0 / self.area } else { 0.0 }
    }
}

impl Invert for UniformTriangle {
    fn invert(&self, x: Vec3) -> Option<Vec2> {
        self.locate(x).map(invert_barycentrics)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    #[test]
    fn barycentrics_sum_to_one_and_invert() {
        for u in uniforms() {
            let b = barycentrics(u);
            assert!(b.min_element() >= 0.0 && (b.element_sum() - 1.0).abs() < 1e-6, "{u}: {b}");
            assert!((invert_barycentrics(b) - u).length() < 1e-6, "{u}: {b}");
        }
    }

    #[test]
    fn the_mean_of_the_samples_is_the_centroid() {
        let sum: Vec3 = uniforms().skip(16).map(barycentrics).sum();
        assert!((sum / 4096.0 - 1.0 / 3.0).length() < 1e-4);
    }

    #[test]
    fn samples_are_in_the_support_and_neighbours_are_not() {
        let offset = Vec3::new(100.0, -20.0, 3.0);
        let corners = [Vec3::ZERO, Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.0, 3.0, -1.0)];
        let triangle = UniformTriangle::new(corners.map(|p| p + offset)).unwrap();
        assert!((triangle.area() - 3.5).abs() < 1e-3);
        for u in uniforms() {
            let s = triangle.sample(u).unwrap();
            assert_eq!(triangle.pdf(s.value), s.pdf, "{u}");
        }
        assert_eq!(triangle.pdf(offset + Vec3::new(-0.1, -0.1, 0.0)), 0.0);
        assert_eq!(triangle.pdf(offset + Vec3::new(0.2, 0.2, 1.0)), 0.0);
    }

    #[test]
    fn no_area_no_triangle() {
        let line = [Vec3::ZERO, Vec3::X, 2.0 * Vec3::X];
        assert_eq!(UniformTriangle::new(line).unwrap_err().vertices, line);
        assert!(UniformTriangle::new([Vec3::ZERO, Vec3::X, Vec3::NAN]).is_err());
        assert!(UniformTriangle::new([Vec3::ZERO, 1e30 * Vec3::X, 1e30 * Vec3::Y]).is_err());
    }
}
