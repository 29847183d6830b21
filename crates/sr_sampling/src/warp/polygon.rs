//! The regular polygon: an aperture of blades.

use std::f32::consts::TAU;

use glam::Vec2;

use super::{RIM, clamp_unit, unit_circle};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::Plane;

/// Uniform over the regular polygon whose corners lie on the unit circle, about the origin.
///
/// The first uniform goes around, the second outwards: strata of both survive within each of the triangles that
/// the polygon's sides make with its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegularPolygon {
    sides: u32,
    /// The angle of the first corner from +X, in turns.
    turn: f32,
}

impl RegularPolygon {
    /// - `sides`: at least 3; `None` for fewer
    /// - `rotation`: the angle of a corner from +X, in radians
    pub fn new(sides: u32, rotation: f32) -> Option<Self> {
        (sides >= 3 && rotation.is_finite()).then_some(Self { sides, turn: (rotation / TAU).rem_euclid(1.0) })
    }

    /// n / 2 sin(2π / n).
    pub fn area(&self) -> f32 {
        let n = self.sides as f32;
        0.5 * n * (TAU / n).sin()
    }

    fn corner(&self, i: u32) -> Vec2 {
        unit_circle(self.turn + i as f32 / self.sides as f32)
    }

    /// The point that two uniforms choose.
    pub fn point(&self, u: Vec2) -> Vec2 {
        let around = u.x * self.sides as f32;
        let side = (around as u32).min(self.sides - 1);
        let along = (around - side as f32).min(1.0);
        u.y.sqrt() * self.corner(side).lerp(self.corner(side + 1), along)
    }

    /// The triangle that a point is in, how far around it is there, and how far outwards: 1 on the rim.
    fn locate(&self, x: Vec2) -> (u32, f32, f32) {
        let n = self.sides as f32;
        let turns = (x.to_angle() / TAU - self.turn).rem_euclid(1.0);
        let side = ((turns * n) as u32).min(self.sides - 1);
        let (a, b) = (self.corner(side), self.corner(side + 1));
        let along_a = x.perp_dot(b) / a.perp_dot(b);
        let along_b = a.perp_dot(x) / a.perp_dot(b);
        let outwards = along_a + along_b;
        let around = if outwards > 0.0 { clamp_unit(along_b / outwards) } else { 0.5 };
        (side, around, outwards)
    }
}

impl Distribution for RegularPolygon {
    type Measure = Plane;
    type Uniform = Vec2;

    fn sample(&self, u: Vec2) -> Option<Sample<Plane>> {
        Some(Sample { value: self.point(u), pdf: 1.0 / self.area() })
    }

    fn pdf(&self, x: Vec2) -> f32 {
        if self.locate(x).2 <= RIM { 1.0 / self.area() } else { 0.0 }
    }
}

impl Invert for RegularPolygon {
    fn invert(&self, x: Vec2) -> Option<Vec2> {
        let (side, around, outwards) = self.locate(x);
        let u = Vec2::new((side as f32 + around) / self.sides as f32, outwards * outwards);
        (outwards <= RIM).then(|| Vec2::new(clamp_unit(u.x), clamp_unit(u.y)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PI: f32 = std::f32::consts::PI;

    #[test]
    fn two_sides_are_none() {
        assert_eq!(RegularPolygon::new(2, 0.0), None);
        assert_eq!(RegularPolygon::new(5, f32::NAN), None);
    }

    #[test]
    fn many_sides_are_a_disk() {
        assert!((RegularPolygon::new(1000, 0.0).unwrap().area() - PI).abs() < 1e-4);
    }

    #[test]
    fn corners_are_where_they_were_asked_for() {
        let square = RegularPolygon::new(4, PI / 4.0).unwrap();
        assert!((square.area() - 2.0).abs() < 1e-6);
        assert!((square.point(Vec2::new(0.0, 1.0)) - Vec2::splat(0.5f32.sqrt())).length() < 1e-6);
        assert!(square.pdf(Vec2::new(0.7, 0.7)) > 0.0);
        assert_eq!(square.pdf(Vec2::new(0.72, 0.0)), 0.0);
    }

    #[test]
    fn the_second_moment_is_the_polygon_s() {
        // ⟨r²⟩ = (2 + cos(2π / n)) / 6 for corners on the unit circle
        for n in [3, 5, 6, 9] {
            let polygon = RegularPolygon::new(n, 0.3).unwrap();
            let steps = 64 * n;
            let mut sum = 0.0;
            for i in 0..steps {
                for j in 0..64 {
                    let u = Vec2::new((i as f32 + 0.5) / steps as f32, (j as f32 + 0.5) / 64.0);
                    sum += f64::from(polygon.point(u).length_squared());
                }
            }
            let expected = (2.0 + (TAU / n as f32).cos()) / 6.0;
            assert!((sum / f64::from(steps * 64) - f64::from(expected)).abs() < 1e-4, "{n} sides");
        }
    }
}
