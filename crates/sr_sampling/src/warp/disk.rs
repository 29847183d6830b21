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
    if d.x == 0.0 && d.y == 0.0 {
        return Vec2::ZERO;
    }
    let (r, phi) = if d.x.abs() > d.y.abs() {
        (d.x, FRAC_PI_4 * (d.y / d.x))
    } else {
        (d.y, FRAC_PI_2 - FRAC_PI_4 * (d.x / d.y))
    };
    let (sin_phi, cos_phi) = phi.sin_cos();
    r * Vec2::new(cos_phi, sin_phi)
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
