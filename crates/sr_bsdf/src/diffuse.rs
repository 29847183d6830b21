//! Lambertian reflection.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// Reflects equally in all directions on the side of +Z; absorbs what comes from the other side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// The fraction of light reflected.
    pub albedo: Rgb,
}

impl Diffuse {
    /// From the fraction of light that it reflects, per channel in [0, 1].
    #[inline(always)]
    pub fn new(albedo: Rgb) -> Self {
        Self { albedo }
    }
}

impl Bsdf for Diffuse {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z > 0.0 && wi.z > 0.0 { self.albedo * FRAC_1_PI } else { Rgb::ZERO }
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, _u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let s = CosineHemisphere.sample(u)?;
        Some(BsdfSample { wi: s.value, weight: self.albedo, pdf: s.pdf, delta: false, eta: 1.0 })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z > 0.0 { CosineHemisphere.pdf(wi) } else { 0.0 }
    }

    #[inline(always)]
    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false, delta: false }
    }

    #[inline(always)]
    fn albedo(&self) -> Rgb {
        self.albedo
    }
}
