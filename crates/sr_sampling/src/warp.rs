//! Closed-form distributions: the unit square bent into a hemisphere, a disk, a triangle.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4};

use glam::{Vec2, Vec3};

use crate::distribution::{Distribution, Sample};
use crate::measure::{Plane, SolidAngle};

/// The concentric map of the unit square onto the unit disk (Shirley & Chiu 1997).
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
    r * Vec2::new(phi.cos(), phi.sin())
}

/// Uniform over the unit disk; pdf = 1 / π.
#[derive(Clone, Copy, Debug)]
pub struct UniformDisk;

impl Distribution for UniformDisk {
    type Measure = Plane;
    type Uniform = Vec2;
    fn sample(&self, u: Vec2) -> Option<Sample<Plane>> {
        Some(Sample { value: concentric_disk(u), pdf: FRAC_1_PI })
    }
    fn pdf(&self, x: Vec2) -> f32 {
        if x.length_squared() <= 1.0 { FRAC_1_PI } else { 0.0 }
    }
}

/// Directions about +Z, all equally likely; pdf = 1 / 2π in sr⁻¹.
#[derive(Clone, Copy, Debug)]
pub struct UniformHemisphere;

impl Distribution for UniformHemisphere {
    type Measure = SolidAngle;
    type Uniform = Vec2;
    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let z = 1.0 - u.x;
        let (sin_phi, cos_phi) = (std::f32::consts::TAU * u.y).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        Some(Sample { value: Vec3::new(r * cos_phi, r * sin_phi, z), pdf: 0.5 * FRAC_1_PI })
    }
    fn pdf(&self, w: Vec3) -> f32 {
        if w.z > 0.0 { 0.5 * FRAC_1_PI } else { 0.0 }
    }
}

/// Directions about +Z with density proportional to cos θ; pdf = cos θ / π in sr⁻¹.
#[derive(Clone, Copy, Debug)]
pub struct CosineHemisphere;

impl Distribution for CosineHemisphere {
    type Measure = SolidAngle;
    type Uniform = Vec2;
    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let d = concentric_disk(u);
        let z = (1.0 - d.length_squared()).max(0.0).sqrt();
        (z > 0.0).then(|| Sample { value: d.extend(z), pdf: z * FRAC_1_PI })
    }
    fn pdf(&self, w: Vec3) -> f32 {
        w.z.max(0.0) * FRAC_1_PI
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
    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        match self {
            AnyHemisphere::Uniform(d) => d.sample(u),
            AnyHemisphere::Cosine(d) => d.sample(u),
        }
    }
    fn pdf(&self, w: Vec3) -> f32 {
        match self {
            AnyHemisphere::Uniform(d) => d.pdf(w),
            AnyHemisphere::Cosine(d) => d.pdf(w),
        }
    }
}
