//! The whole sphere of directions.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

use super::{concentric_disk, invert_concentric_disk};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::SolidAngle;

/// Every direction equally likely; pdf = 1 / 4π in sr⁻¹.
///
/// The equal-area map of the disk onto the sphere: a circle of radius r becomes the circle of height
/// z = 1 − 2 r².
#[derive(Clone, Copy, Debug)]
pub struct UniformSphere;

impl Distribution for UniformSphere {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    #[inline]
    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let d = concentric_disk(u);
        let r2 = d.length_squared().min(1.0);
        let xy = d * (2.0 * (1.0 - r2).sqrt());
        Some(Sample { value: xy.extend(1.0 - 2.0 * r2), pdf: 0.25 * FRAC_1_PI })
    }

    #[inline]
    fn pdf(&self, _: Vec3) -> f32 {
        0.25 * FRAC_1_PI
    }
}

impl Invert for UniformSphere {
    fn invert(&self, w: Vec3) -> Option<Vec2> {
        let xy = w.truncate().normalize_or(Vec2::X);
        // r² = (1 − z)/2, from the side of the axis where it does not cancel.
        let r2 =
            if w.z > 0.0 { 0.5 * w.truncate().length_squared() / (1.0 + w.z) } else { 0.5 * (1.0 - w.z) };
        Some(invert_concentric_disk(xy * r2.sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    #[test]
    fn samples_are_unit_vectors() {
        for u in uniforms() {
            let w = UniformSphere.sample(u).unwrap().value;
            assert!((w.length() - 1.0).abs() < 1e-6, "{u} gives {w}");
        }
    }

    #[test]
    fn the_centre_is_the_pole() {
        assert_eq!(UniformSphere.sample(Vec2::splat(0.5)).unwrap().value, Vec3::Z);
        assert_eq!(UniformSphere.invert(Vec3::Z), Some(Vec2::splat(0.5)));
    }
}
