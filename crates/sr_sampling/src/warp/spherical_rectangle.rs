//! A rectangle as it is seen from a point: uniform by solid angle.

use glam::{DVec3, Vec2, Vec3};

use super::{DegenerateRectangle, clamp_unit};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::SolidAngle;

/// Directions to a rectangle, all equally likely; pdf = 1 / solid angle, in sr⁻¹.
///
/// Carlos Ureña, Marcos Fajardo & Alan King, "An Area-Preserving Parametrization for Spherical
/// Rectangles", EGSR 2013: the first uniform picks a column of the rectangle by its share of the
/// solid angle, the second a height in it.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    /// Unit vectors along the edges, and from the rectangle's plane towards the viewer.
    frame: [DVec3; 3],
    /// The rectangle in that frame, seen from the origin: [x0, x1] × [y0, y1] at −`distance`.
    x: [f64; 2],
    y: [f64; 2],
    distance: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// The rectangle of a corner and the two perpendicular edges that leave it, as seen from `at`.
    ///
    /// # Errors
    /// If the edges are not perpendicular, `at` lies in the rectangle's plane, or the solid angle is
    /// too small for directions in single precision to resolve (below 10⁻¹⁰ sr).
    pub fn new(corner: Vec3, edges: [Vec3; 2], at: Vec3) -> Result<Self, DegenerateRectangle> {
        let degenerate = DegenerateRectangle { corner, edges };
        let [e0, e1] = edges.map(|e| e.as_dvec3());
        let (Some(x_axis), Some(y_axis)) = (e0.try_normalize(), e1.try_normalize()) else {
            return Err(degenerate);
        };
        let d = corner.as_dvec3() - at.as_dvec3();
        let mut z_axis = x_axis.cross(y_axis);
        if d.dot(z_axis) > 0.0 {
            z_axis = -z_axis;
        }
        let [x0, y0, distance] = [d.dot(x_axis), d.dot(y_axis), -d.dot(z_axis)];
        let (x, y) = ([x0, x0 + e0.length()], [y0, y0 + e1.length()]);
        let solid_angle = solid_angle(x, y, distance);
        // Not `> 10⁻⁵`, so that NaN fails too.
        if !(x_axis.dot(y_axis).abs() <= 1e-5 && distance > 0.0 && solid_angle >= 1e-10) {
            return Err(degenerate);
        }
        Ok(Self { frame: [x_axis, y_axis, z_axis], x, y, distance, solid_angle })
    }

    /// The solid angle, in sr.
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// The x up to which the columns have this solid angle together.
    ///
    /// With b = y / hypot(y, distance) and s = x / hypot(x, distance), [`solid_angle`]'s primitive is
    /// asin(b s). So asin(b₁ s) − asin(b₀ s) = φ is to be solved for s: the law of cosines in a
    /// triangle with sides b₀ and b₁ and the angle φ between them. Of φ, which is the area and the same difference at
    /// the left edge, only sine and cosine are needed: by the addition theorems, without an inverse function.
    fn column(&self, area: f64) -> f64 {
        let [b0, b1] = self.y.map(|y| y / length(y, self.distance));
        let left = self.x[0] / length(self.x[0], self.distance);
        let (sin0, sin1) = (b0 * left, b1 * left);
        let (cos0, cos1) = ((1.0 - sin0 * sin0).max(0.0).sqrt(), (1.0 - sin1 * sin1).max(0.0).sqrt());
        let (sin_left, cos_left) = (sin1 * cos0 - cos1 * sin0, cos1 * cos0 + sin1 * sin0);
        let (sin_area, cos_area) = area.sin_cos();
        let sin = sin_area * cos_left + cos_area * sin_left;
        let cos = cos_area * cos_left - sin_area * sin_left;
        let s = sin / (b0 * b0 + b1 * b1 - 2.0 * b0 * b1 * cos).max(f64::MIN_POSITIVE).sqrt();
        let x = self.distance * s / (1.0 - s * s).max(f64::MIN_POSITIVE).sqrt();
        x.clamp(self.x[0], self.x[1])
    }

    /// Heights of the rectangle's lower and upper edge in the column at x, as sines of elevation.
    fn heights(&self, x: f64) -> [f64; 2] {
        let r = length(x, self.distance);
        self.y.map(|y| y / length(y, r))
    }
}

/// The hypotenuse. (`hypot` guards against sizes that nothing here has, at several times the price.)
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// The solid angle of [x0, x1] × [y0, y1] at a distance.
fn solid_angle(x: [f64; 2], y: [f64; 2], distance: f64) -> f64 {
    // ∫∫ d dx dy / (x² + y² + d²)^(3/2) has the primitive atan(x y / (d √(x² + y² + d²))). The four angles are added
    // as complex numbers, for one inverse function in place of four: a product has the sum of its factors' angles.
    let corner = |x: f64, y: f64| {
        let (re, im) = (distance * (x * x + y * y + distance * distance).sqrt(), x * y);
        let scale = 1.0 / length(re, im);
        (re * scale, im * scale)
    };
    let product = |(a, b): (f64, f64), (c, d): (f64, f64)| (a * c - b * d, a * d + b * c);
    let conjugate = |(a, b): (f64, f64)| (a, -b);
    let outer = product(corner(x[1], y[1]), corner(x[0], y[0]));
    let inner = product(corner(x[0], y[1]), corner(x[1], y[0]));
    let (re, im) = product(outer, conjugate(inner));
    let angle = im.atan2(re);
    // between 0 and 2π, but for rounding about 0
    if angle < -1e-9 { angle + std::f64::consts::TAU } else { angle }
}

impl SphericalRectangle {
    /// The point of the rectangle that `sample` draws the direction to: where along each edge, in [0, 1].
    pub fn place(&self, u: Vec2) -> Vec2 {
        let [x, y] = self.point(u);
        let along = |v: f64, [low, high]: [f64; 2]| ((v - low) / (high - low)) as f32;
        Vec2::new(along(x, self.x), along(y, self.y))
    }

    fn point(&self, u: Vec2) -> [f64; 2] {
        let x = self.column(f64::from(u.x) * self.solid_angle);
        let [low, high] = self.heights(x);
        let h = low + f64::from(u.y) * (high - low);
        let r = length(x, self.distance);
        [x, (h * r / (1.0 - h * h).max(f64::MIN_POSITIVE).sqrt()).clamp(self.y[0], self.y[1])]
    }
}

impl Distribution for SphericalRectangle {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let [x, y] = self.point(u);
        let [x_axis, y_axis, z_axis] = self.frame;
        let w = (x * x_axis + y * y_axis - self.distance * z_axis).normalize();
        Some(Sample { value: w.as_vec3(), pdf: 1.0 / self.solid_angle() })
    }

    fn pdf(&self, w: Vec3) -> f32 {
        if self.invert(w).is_some() { 1.0 / self.solid_angle() } else { 0.0 }
    }
}

impl Invert for SphericalRectangle {
    fn invert(&self, w: Vec3) -> Option<Vec2> {
        let w = w.as_dvec3();
        let [x_axis, y_axis, z_axis] = self.frame;
        let down = -w.dot(z_axis);
        if down <= 0.0 {
            return None;
        }
        let t = self.distance / down;
        let (x, y) = (w.dot(x_axis) * t, w.dot(y_axis) * t);
        // A direction rounded to f32 is off by 10⁻⁷; on the plane that is t / cos as much.
        let slack = 2e-7 * t * t / self.distance;
        let inside = |v: f64, [low, high]: [f64; 2]| v >= low - slack && v <= high + slack;
        if !(inside(x, self.x) && inside(y, self.y)) {
            return None;
        }
        let x = x.clamp(self.x[0], self.x[1]);
        let share = solid_angle([self.x[0], x], self.y, self.distance) / self.solid_angle;
        let [low, high] = self.heights(x);
        let h = y / length(y, length(x, self.distance));
        Some(Vec2::new(clamp_unit(share as f32), clamp_unit(((h - low) / (high - low)) as f32)))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::warp::testing::uniforms;

    fn cases() -> Vec<SphericalRectangle> {
        let square = [2.0 * Vec3::X, 2.0 * Vec3::Y];
        let rotated = [Vec3::new(0.6, 0.0, 0.8), 0.2 * Vec3::Y];
        [
            (Vec3::new(-1.0, -1.0, 1.0), square),
            (Vec3::new(-1.0, -1.0, -1.0), square),
            (Vec3::new(3.0, 1.0, 0.3), square),
            (Vec3::new(-3.0, -1.0, 0.01), square),
            (Vec3::new(1.0, -0.1, 0.0), rotated),
            (Vec3::new(0.0, 0.0, 100.0), square),
        ]
        .map(|(corner, edges)| SphericalRectangle::new(corner, edges, Vec3::ZERO).unwrap())
        .to_vec()
    }

    #[test]
    fn a_face_of_a_cube_is_a_sixth_of_the_sphere() {
        let face =
            SphericalRectangle::new(Vec3::new(-1.0, -1.0, 1.0), [2.0 * Vec3::X, 2.0 * Vec3::Y], Vec3::ZERO);
        assert!((face.unwrap().solid_angle - 4.0 * PI / 6.0).abs() < 1e-14);
    }

    #[test]
    fn a_column_has_the_solid_angle_asked_for() {
        for rectangle in cases() {
            for share in [1e-4, 0.1, 0.5, 0.9, 1.0] {
                let x = rectangle.column(share * rectangle.solid_angle);
                let area = solid_angle([rectangle.x[0], x], rectangle.y, rectangle.distance);
                let error = area / rectangle.solid_angle - share;
                assert!(error.abs() < 5e-8, "{share}: {error} of {rectangle:?}");
            }
        }
    }

    #[test]
    fn samples_are_unit_vectors_in_the_rectangle_and_invert() {
        for rectangle in cases() {
            for u in uniforms() {
                let s = rectangle.sample(u).unwrap();
                assert!((s.value.length() - 1.0).abs() < 1e-6);
                assert_eq!(rectangle.pdf(s.value), s.pdf, "{u} of {rectangle:?}");
                let place = rectangle.place(u);
                assert!(place.min_element() >= 0.0 && place.max_element() <= 1.0, "{place}");
                let error = (rectangle.invert(s.value).unwrap() - u).length();
                assert!(
                    error < 1e-5_f32.max(1e-6 / rectangle.solid_angle()),
                    "{u}: {error} of {rectangle:?}"
                );
            }
            let centre = rectangle.sample(Vec2::splat(0.5)).unwrap().value;
            assert_eq!(rectangle.pdf(-centre), 0.0);
        }
    }

    #[test]
    fn no_rectangle_no_samples() {
        for edges in [[Vec3::X, Vec3::X + Vec3::Y], [Vec3::X, Vec3::ZERO], [Vec3::X, Vec3::NAN]] {
            assert!(SphericalRectangle::new(Vec3::Z, edges, Vec3::ZERO).is_err(), "{edges:?}");
        }
        assert!(SphericalRectangle::new(Vec3::X, [Vec3::X, Vec3::Y], Vec3::ZERO).is_err(), "edge-on");
    }
}
