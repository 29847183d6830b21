//! Coordinates on the measured spaces: what is cut into cells.

use std::f64::consts::TAU;

use glam::{DVec3, Vec2, Vec3};
use sr_sampling::{Area, Line, Measure, Plane, SolidAngle};

/// Two coordinates, each in [0, 1].
pub type Coordinates = [f64; 2];

/// Coordinates on a space, or on the part of it that holds a support.
pub trait Chart<M: Measure> {
    /// How many of the coordinates mean something.
    const AXES: usize;
    /// The coordinates of a point; `None` outside the chart.
    fn coordinates(&self, x: M::Point) -> Option<Coordinates>;
    /// The point at given coordinates.
    fn point(&self, at: Coordinates) -> M::Point;
    /// What the unit square of coordinates measures. Constant density: all charts preserve area.
    fn measure(&self) -> f64;
}

fn in_unit_square(at: Coordinates) -> Option<Coordinates> {
    at.iter().all(|c| (0.0..=1.0).contains(c)).then_some(at)
}

/// All directions, by Lambert's cylinder: (1 − z) / 2 and φ / 2π.
pub struct Sphere;

impl Chart<SolidAngle> for Sphere {
    const AXES: usize = 2;

    fn coordinates(&self, w: Vec3) -> Option<Coordinates> {
        let w = w.as_dvec3();
        // Near the upper pole 1 − z cancels, and narrow lobes live there.
        let depth = if w.z > 0.5 { w.truncate().length_squared() / (1.0 + w.z) } else { 1.0 - w.z };
        let turn = w.y.atan2(w.x) / TAU;
        in_unit_square([(0.5 * depth).clamp(0.0, 1.0), if turn < 0.0 { turn + 1.0 } else { turn }])
    }

    fn point(&self, [half_depth, turn]: Coordinates) -> Vec3 {
        let depth = 2.0 * half_depth;
        let r = (depth * (2.0 - depth)).max(0.0).sqrt();
        let (sin, cos) = (TAU * turn).sin_cos();
        DVec3::new(r * cos, r * sin, 1.0 - depth).as_vec3()
    }

    fn measure(&self) -> f64 {
        2.0 * TAU
    }
}

/// A piece of the line.
pub struct Interval {
    pub range: [f32; 2],
}

impl Chart<Line> for Interval {
    const AXES: usize = 1;

    fn coordinates(&self, x: f32) -> Option<Coordinates> {
        in_unit_square([(f64::from(x) - f64::from(self.range[0])) / self.measure(), 0.5])
    }

    fn point(&self, [u, _]: Coordinates) -> f32 {
        (f64::from(self.range[0]) + u * self.measure()) as f32
    }

    fn measure(&self) -> f64 {
        f64::from(self.range[1]) - f64::from(self.range[0])
    }
}

/// A piece of the plane.
pub struct Rectangle {
    pub corners: [Vec2; 2],
}

impl Chart<Plane> for Rectangle {
    const AXES: usize = 2;

    fn coordinates(&self, x: Vec2) -> Option<Coordinates> {
        let [low, high] = self.corners.map(|c| c.as_dvec2());
        in_unit_square(((x.as_dvec2() - low) / (high - low)).into())
    }

    fn point(&self, at: Coordinates) -> Vec2 {
        let [low, high] = self.corners.map(|c| c.as_dvec2());
        (low + glam::DVec2::from(at) * (high - low)).as_vec2()
    }

    fn measure(&self) -> f64 {
        let [low, high] = self.corners.map(|c| c.as_dvec2());
        (high - low).element_product()
    }
}

/// A piece of a plane in space.
pub struct Parallelogram {
    pub corner: Vec3,
    pub edges: [Vec3; 2],
}

impl Chart<Area> for Parallelogram {
    const AXES: usize = 2;

    fn coordinates(&self, x: Vec3) -> Option<Coordinates> {
        let [e0, e1] = self.edges.map(|e| e.as_dvec3());
        let d = x.as_dvec3() - self.corner.as_dvec3();
        let cross = e0.cross(e1);
        let at = [d.cross(e1).dot(cross), e0.cross(d).dot(cross)].map(|c| c / cross.length_squared());
        // Positions are rounded: those on the rim belong to it.
        let rim = 1e-5;
        at.iter().all(|&c| c > -rim && c < 1.0 + rim).then(|| at.map(|c| c.clamp(0.0, 1.0)))
    }

    fn point(&self, [u, v]: Coordinates) -> Vec3 {
        let [e0, e1] = self.edges.map(|e| e.as_dvec3());
        (self.corner.as_dvec3() + u * e0 + v * e1).as_vec3()
    }

    fn measure(&self) -> f64 {
        let [e0, e1] = self.edges.map(|e| e.as_dvec3());
        e0.cross(e1).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_have_the_coordinates_they_came_from() {
        fn check<M: Measure>(chart: &impl Chart<M>, axes: usize) {
            for at in [[0.1, 0.2], [0.5, 0.5], [0.9, 0.7], [0.3, 0.99]] {
                let back = chart.coordinates(chart.point(at)).unwrap();
                for i in 0..axes {
                    assert!((back[i] - at[i]).abs() < 1e-6, "{at:?} became {back:?}");
                }
            }
        }
        check(&Sphere, 2);
        check(&Interval { range: [-2.0, 5.0] }, 1);
        check(&Rectangle { corners: [Vec2::new(-1.0, 2.0), Vec2::new(3.0, 4.0)] }, 2);
        check(&Parallelogram { corner: Vec3::ONE, edges: [Vec3::X, Vec3::new(0.5, 2.0, 1.0)] }, 2);
    }

    #[test]
    fn the_sphere_is_resolved_near_the_pole() {
        let at = [1e-12, 0.3];
        let back = Sphere.coordinates(Sphere.point(at)).unwrap();
        assert!((back[0] / at[0] - 1.0).abs() < 1e-5 && (back[1] - at[1]).abs() < 1e-6);
    }
}
