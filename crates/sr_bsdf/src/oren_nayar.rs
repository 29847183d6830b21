//! Rough diffuse reflection as many files ask for it: Oren and Nayar's qualitative model.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// Lambertian V-shaped grooves with slopes of a Gaussian distribution, on the side of +Z (Oren & Nayar 1994,
/// "Generalization of Lambert's Reflectance Model", eq. 30). One bounce: rough surfaces lose energy, unlike [`crate::Eon`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayar {
    albedo: Rgb,
    a: f32,
    b: f32,
}

impl OrenNayar {
    /// - `albedo`: of the facets, per channel in [0, 1]
    /// - `sigma`: standard deviation of the facets' angle, in radians, brought into [0, π/2]
    pub fn new(albedo: Rgb, sigma: f32) -> Self {
        let sigma2 = sigma.clamp(0.0, FRAC_PI_2).powi(2);
        Self { albedo, a: 1.0 - 0.5 * sigma2 / (sigma2 + 0.33), b: 0.45 * sigma2 / (sigma2 + 0.09) }
    }
}

impl Bsdf for OrenNayar {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        // cos(φₒ − φᵢ) sin α tan β
        let azimuths = wo.truncate().dot(wi.truncate()).max(0.0) / wo.z.max(wi.z);
        self.albedo * ((self.a + self.b * azimuths) * FRAC_1_PI)
    }

    fn sample(&self, wo: Vec3, _u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let s = CosineHemisphere.sample(u)?;
        let weight = self.eval(wo, s.value) * std::f32::consts::PI;
        Some(BsdfSample { wi: s.value, weight, pdf: s.pdf, delta: false, eta: 1.0 })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z > 0.0 { CosineHemisphere.pdf(wi) } else { 0.0 }
    }

    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false, delta: false }
    }

    fn albedo(&self) -> Rgb {
        self.albedo * self.a
    }
}
