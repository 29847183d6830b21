//! Hemispheres about +Z.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

use super::{concentric_disk, invert_concentric_disk};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::SolidAngle;

/// Directions about +Z, all equally likely; pdf = 1 / 2π in sr⁻¹.
///
/// The equal-area map of the disk onto the hemisphere (Shirley & Chiu 1997).
#[derive(Clone, Copy, Debug)]
pub struct UniformHemisphere;

impl Distribution for UniformHemisphere {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    /// `None` if `u` lands on the horizon.
    #[inline]
    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let d = concentric_disk(u);
        let r2 = d.length_squared();
        let z = 1.0 - r2;
        (z > 0.0).then(|| Sample { value: (d * (2.0 - r2).sqrt()).extend(z), pdf: 0.5 * FRAC_1_PI })
    }

    #[inline]
    fn pdf(&self, w: Vec3) -> f32 {
        if w.z > 0.0 { 0.5 * FRAC_1_PI } else { 0.0 }
    }
}

impl Invert for UniformHemisphere {
    fn invert(&self, w: Vec3) -> Option<Vec2> {
        (w.z > 0.0).then(|| invert_concentric_disk(w.truncate() / (1.0 + w.z).sqrt()))
    }
}

/// Directions about +Z with density proportional to cos θ; pdf = cos θ / π in sr⁻¹.
///
/// Malley's method over the concentric disk map (Shirley & Chiu 1997), so strata survive.
#[derive(Clone, Copy, Debug)]
pub struct CosineHemisphere;

impl Distribution for CosineHemisphere {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    /// `None` if `u` lands on the horizon, where the density is 0.
    #[inline]
    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let d = concentric_disk(u);
        let z = (1.0 - d.length_squared()).max(0.0).sqrt();
        (z > 0.0).then(|| Sample { value: d.extend(z), pdf: z * FRAC_1_PI })
    }

    #[inline]
    fn pdf(&self, w: Vec3) -> f32 {
        w.z.max(0.0) * FRAC_1_PI
    }
}

impl Invert for CosineHemisphere {
    fn invert(&self, w: Vec3) -> Option<Vec2> {
        (w.z > 0.0).then(|| invert_concentric_disk(w.truncate()))
    }
}

/// One of the hemisphere distributions.
#[derive(Clone, Copy, Debug)]
pub enum AnyHemisphere {
    /// All directions equally likely.
    Uniform(UniformHemisphere),
    /// Proportional to the cosine.
    Cosine(CosineHemisphere),
}

impl Distribution for AnyHemisphere {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    #[inline]
    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        match self {
            AnyHemisphere::Uniform(d) => d.sample(u),
            AnyHemisphere::Cosine(d) => d.sample(u),
        }
    }

    #[inline]
    fn pdf(&self, w: Vec3) -> f32 {
        match self {
            AnyHemisphere::Uniform(d) => d.pdf(w),
            AnyHemisphere::Cosine(d) => d.pdf(w),
        }
    }
}

impl Invert for AnyHemisphere {
    fn invert(&self, w: Vec3) -> Option<Vec2> {
        match self {
            AnyHemisphere::Uniform(d) => d.invert(w),
            AnyHemisphere::Cosine(d) => d.invert(w),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    #[test]
    fn samples_are_unit_vectors_above_the_horizon() {
        for d in [AnyHemisphere::Uniform(UniformHemisphere), AnyHemisphere::Cosine(CosineHemisphere)] {
            let samples: Vec<_> = uniforms().filter_map(|u| d.sample(u)).collect();
            assert!(samples.len() > 4000);
            for s in samples {
                assert!(s.value.z > 0.0 && (s.value.length() - 1.0).abs() < 1e-6, "{d:?}: {}", s.value);
                assert!((d.pdf(s.value) - s.pdf).abs() <= 1e-6 * s.pdf, "{d:?}: {}", s.value);
            }
        }
    }

    #[test]
    fn nothing_lies_below_the_horizon() {
        for w in [-Vec3::Z, Vec3::X, Vec3::new(0.6, 0.0, -0.8)] {
            assert_eq!(UniformHemisphere.pdf(w), 0.0);
            assert_eq!(CosineHemisphere.pdf(w), 0.0);
            assert_eq!(UniformHemisphere.invert(w), None);
            assert_eq!(CosineHemisphere.invert(w), None);
        }
    }
}
