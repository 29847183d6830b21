//! A cone of directions about +Z: what a sphere looks like from outside.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};
use thiserror::Error;

use super::{RIM, concentric_disk, invert_concentric_disk};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::SolidAngle;

/// Why there is no such cone.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ConeError {
    /// A squared sine outside (0, 1].
    #[error("the squared sine of a cone's half-angle is {sin2}; it must be in (0, 1]")]
    BadSine {
        /// The value given.
        sin2: f32,
    },
    /// A cosine outside [−1, 1).
    #[error("the cosine of a cone's half-angle is {cos}; it must be in [-1, 1)")]
    BadCosine {
        /// The value given.
        cos: f32,
    },
}

/// Directions within θ_max of +Z, all equally likely; pdf = 1 / 2π(1 − cos θ_max) in sr⁻¹.
///
/// Also for cones so narrow that cos θ_max rounds to 1: see [`from_sin2`](Self::from_sin2).
#[derive(Clone, Copy, Debug)]
pub struct UniformCone {
    /// 1 − cos θ_max.
    height: f32,
}

impl UniformCone {
    /// The cone of a half-angle below 90°, from its squared sine: (radius / distance)² of a sphere.
    ///
    /// # Errors
    /// If `sin2` is not in (0, 1].
    #[inline]
    pub fn from_sin2(sin2: f32) -> Result<Self, ConeError> {
        if !(f32::MIN_POSITIVE..=1.0).contains(&sin2) {
            return Err(ConeError::BadSine { sin2 });
        }
        Ok(Self { height: sin2 / (1.0 + (1.0 - sin2).sqrt()) })
    }

    /// The cone of any half-angle, from its cosine.
    ///
    /// # Errors
    /// If `cos` is not in [−1, 1).
    #[inline]
    pub fn from_cos(cos: f32) -> Result<Self, ConeError> {
        if !(-1.0..1.0).contains(&cos) {
            return Err(ConeError::BadCosine { cos });
        }
        Ok(Self { height: 1.0 - cos })
    }

    /// The solid angle, in sr.
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        2.0 * PI * self.height
    }
}

/// 1 − z of a unit vector, accurate also near the pole, where z is nearly 1.
fn depth_below_pole(w: Vec3) -> f32 {
    if w.z > 0.0 { w.truncate().length_squared() / (1.0 + w.z) } else { 1.0 - w.z }
}

impl Distribution for UniformCone {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    #[inline]
    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let d = concentric_disk(u);
        let depth = d.length_squared().min(1.0) * self.height;
        let xy = d * (self.height * (2.0 - depth)).max(0.0).sqrt();
        Some(Sample { value: xy.extend(1.0 - depth), pdf: 1.0 / self.solid_angle() })
    }

    #[inline]
    fn pdf(&self, w: Vec3) -> f32 {
        if depth_below_pole(w) <= self.height * RIM { 1.0 / self.solid_angle() } else { 0.0 }
    }
}

impl Invert for UniformCone {
    fn invert(&self, w: Vec3) -> Option<Vec2> {
        if self.pdf(w) == 0.0 {
            return None;
        }
        let r = (depth_below_pole(w) / self.height).sqrt();
        Some(invert_concentric_disk(w.truncate().normalize_or(Vec2::X) * r))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    #[test]
    fn samples_lie_in_the_cone_however_narrow() {
        for sin2 in [1e-30_f32, 1e-12, 1e-6, 0.5, 1.0] {
            let cone = UniformCone::from_sin2(sin2).unwrap();
            for u in uniforms() {
                let s = cone.sample(u).unwrap();
                assert!((s.value.length() - 1.0).abs() < 1e-6);
                assert!(s.value.truncate().length_squared() <= sin2 * (1.0 + 1e-5), "{sin2}: {}", s.value);
                assert_eq!(cone.pdf(s.value), s.pdf, "sin² = {sin2}, u = {u}");
            }
            // Not a point: the samples spread as wide as the cone does.
            let rim = cone.sample(Vec2::new(0.0, 0.5)).unwrap().value;
            assert!((rim.truncate().length() / sin2.sqrt() - 1.0).abs() < 1e-3, "{sin2}: {rim}");
        }
    }

    #[test]
    fn the_solid_angle_of_a_narrow_cone_is_that_of_a_disk() {
        let cone = UniformCone::from_sin2(1e-10).unwrap();
        assert!((cone.solid_angle() / (PI * 1e-10) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn wide_cones_reach_below_the_horizon() {
        let cone = UniformCone::from_cos(-1.0).unwrap();
        assert!((cone.solid_angle() - 4.0 * PI).abs() < 1e-5);
        assert!(cone.pdf(-Vec3::Z) > 0.0);
        let cone = UniformCone::from_cos(-0.5).unwrap();
        assert_eq!(cone.pdf(Vec3::new(0.8, 0.0, -0.6)), 0.0);
        assert!(cone.pdf(Vec3::new(0.96, 0.0, -0.28)) > 0.0);
    }

    #[test]
    fn errors_name_the_value() {
        for sin2 in [0.0, -0.1, 1.1, f32::INFINITY] {
            assert_eq!(UniformCone::from_sin2(sin2).unwrap_err(), ConeError::BadSine { sin2 });
        }
        assert!(UniformCone::from_sin2(f32::NAN).is_err());
        for cos in [1.0, -1.1] {
            assert_eq!(UniformCone::from_cos(cos).unwrap_err(), ConeError::BadCosine { cos });
        }
    }
}
