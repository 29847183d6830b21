//! A rough metal.

use glam::{Vec2, Vec3};

use crate::conductor::Metal;
use crate::interface::reflect_about;
use crate::{Bsdf, BsdfSample, Lobes, Microfacet, Rgb};

/// A surface of small metal mirrors, seen from the side of +Z only (Torrance & Sparrow 1967).
///
/// f = F D G / (4 cos θₒ cos θᵢ); one bounce only, so a rough surface loses some energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughConductor {
    distribution: Microfacet,
    metal: Metal,
}

impl RoughConductor {
    /// - `eta_k`: complex index over the exterior's, per channel; `None` reflects everything
    /// - `reflectance`: scales what Fresnel's equations give; physically 1
    #[inline]
    pub fn new(distribution: Microfacet, eta_k: Option<(Rgb, Rgb)>, reflectance: Rgb) -> Self {
        Self { distribution, metal: Metal::new(eta_k, reflectance) }
    }
}

impl Bsdf for RoughConductor {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        let m = (wo + wi).normalize_or_zero();
        self.distribution.reflection(wo, wi, m) * self.metal.reflectance(wo.dot(m))
    }

    #[inline]
    fn sample(&self, wo: Vec3, _u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let m = self.distribution.sample_visible(wo, u);
        let wi = reflect_about(wo, m);
        let pdf = self.distribution.reflection_pdf(wo, m);
        let weight = self.metal.reflectance(wo.dot(m)) * self.distribution.g1(wi);
        (wi.z > 0.0 && pdf > 0.0).then_some(BsdfSample { wi, weight, pdf, delta: false, eta: 1.0 })
    }

    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        self.distribution.reflection_pdf(wo, (wo + wi).normalize_or_zero())
    }

    #[inline]
    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false, delta: false }
    }

    #[inline]
    fn albedo(&self) -> Rgb {
        self.metal.reflectance(1.0)
    }
}
