//! The unit disk.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4};

use glam::Vec2;

use super::{RIM, clamp_unit};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::Plane;

/// The concentric map of the unit square onto the unit disk (Shirley & Chiu 1997).
///
/// Squares about the centre become circles; areas keep their proportion.
#[inline]
pub fn concentric_disk(u: Vec2) -> Vec2 {
    let d = 2.0 * u - Vec2::ONE;
    // Selections rather than branches: which octant it is cannot be guessed.
    let is_wide = d.x.abs() > d.y.abs();
    let (long, short) = if is_wide { (d.x, d.y) } else { (d.y, d.x) };
    let slope = if long == 0.0 { 0.0 } else { short / long };
    let (sin, cos) = sin_cos_eighth(FRAC_PI_4 * slope);
    let (along, across) = (long * cos, long * sin);
    if is_wide { Vec2::new(along, across) } else { Vec2::new(across, along) }
}

/// The point of the unit circle at an angle of `u` turns from +X, for |u| up to 10⁶. No library call, and no branch.
#[inline(always)]
pub fn unit_circle(u: f32) -> Vec2 {
    // Quarters of a turn, and what is left or missing; exact.
    let quarters = (4.0 * u + 0.5f32.copysign(u)) as i32;
    let (sin, cos) = sin_cos_eighth(FRAC_PI_2 * (4.0 * u - quarters as f32));
    let (x, y) = if quarters & 1 == 0 { (cos, sin) } else { (-sin, cos) };
    if quarters & 2 == 0 { Vec2::new(x, y) } else { Vec2::new(-x, -y) }
}

/// Sine and cosine of an angle in [−π/4, π/4], by their series up to the ninth power: to 3·10⁻⁸.
#[inline(always)]
fn sin_cos_eighth(a: f32) -> (f32, f32) {
    let a2 = a * a;
    let sin = a * (1.0 + a2 * (-1.0 / 6.0 + a2 * (1.0 / 120.0 + a2 * (-1.0 / 5040.0 + a2 / 362_880.0))));
    let cos = 1.0 + a2 * (-0.5 + a2 * (1.0 / 24.0 + a2 * (-1.0 / 720.0 + a2 / 40_320.0)));
    (sin, cos)
}

/// The point of the unit square that [`concentric_disk`] maps to `x`.
pub fn invert_concentric_disk(x: Vec2) -> Vec2 {
    let r = x.length();
    if r == 0.0 {
        return Vec2::splat(0.5);
    }
    let d = if x.x.abs() > x.y.abs() {
        let d_x = r.copysign(x.x);
        Vec2::new(d_x, d_x * (x.y / x.x).atan() / FRAC_PI_4)
    } else {
        let d_y = r.copysign(x.y);
        Vec2::new(d_y * (x.x / x.y).atan() / FRAC_PI_4, d_y)
    };
    Vec2::new(clamp_unit(0.5 * (d.x + 1.0)), clamp_unit(0.5 * (d.y + 1.0)))
}

/// Uniform over the unit disk; pdf = 1 / π.
#[derive(Clone, Copy, Debug)]
pub struct UniformDisk;

impl Distribution for UniformDisk {
    type Measure = Plane;
    type Uniform = Vec2;

    #[inline]
    fn sample(&self, u: Vec2) -> Option<Sample<Plane>> {
        Some(Sample { value: concentric_disk(u), pdf: FRAC_1_PI })
    }

    #[inline]
    fn pdf(&self, x: Vec2) -> f32 {
        if x.length_squared() <= RIM { FRAC_1_PI } else { 0.0 }
    }
}

impl Invert for UniformDisk {
    fn invert(&self, x: Vec2) -> Option<Vec2> {
        (self.pdf(x) > 0.0).then(|| invert_concentric_disk(x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    #[test]
    fn the_series_are_as_good_as_f32() {
        for i in -1000..=1000 {
            let a = FRAC_PI_4 * i as f32 / 1000.0;
            let (sin, cos) = sin_cos_eighth(a);
            let (exact_sin, exact_cos) = f64::from(a).sin_cos();
            assert!(
                (f64::from(sin) - exact_sin).abs() < 1e-7 && (f64::from(cos) - exact_cos).abs() < 1e-7,
                "{a}"
            );
        }
    }

    #[test]
    fn a_turn_is_a_circle() {
        for i in -3000..=3000 {
            let u = i as f32 / 1000.0;
            let (sin, cos) = (std::f64::consts::TAU * f64::from(u)).sin_cos();
            let at = unit_circle(u).as_dvec2();
            assert!((at - glam::DVec2::new(cos, sin)).abs().max_element() < 1.5e-7, "{u}: {at}");
        }
        for (u, at) in [(0.0, Vec2::X), (0.25, Vec2::Y), (0.5, -Vec2::X), (0.75, -Vec2::Y), (1.0, Vec2::X)] {
            assert_eq!(unit_circle(u), at);
        }
    }

    #[test]
    fn squares_become_circles() {
        for u in uniforms() {
            let square_radius = (2.0 * u - Vec2::ONE).abs().max_element();
            assert!((concentric_disk(u).length() - square_radius).abs() < 1e-6, "{u}");
        }
        assert_eq!(concentric_disk(Vec2::splat(0.5)), Vec2::ZERO);
        assert_eq!(invert_concentric_disk(Vec2::ZERO), Vec2::splat(0.5));
    }

    #[test]
    fn every_sample_is_in_the_support() {
        for u in uniforms() {
            let s = UniformDisk.sample(u).unwrap();
            assert_eq!(UniformDisk.pdf(s.value), s.pdf, "{u}");
        }
        assert_eq!(UniformDisk.pdf(Vec2::new(0.8, 0.8)), 0.0);
    }
}
