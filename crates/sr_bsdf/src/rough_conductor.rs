//! A rough metal.

use glam::{Vec2, Vec3};

use crate::conductor::Metal;
use crate::interface::reflect_about;
use crate::microfacet::Facet;
use crate::{Bsdf, BsdfSample, Lobes, Microfacet, MicrofacetKind, MicrofacetShape, Rgb};

/// A surface of small metal mirrors, seen from the side of +Z only (Torrance & Sparrow 1967).
///
/// f = F D G / (4 cos θₒ cos θᵢ); one bounce only, so a rough surface loses some energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughConductor<S = MicrofacetKind> {
    distribution: Microfacet<S>,
    metal: Metal,
}

impl<S: MicrofacetShape> RoughConductor<S> {
    /// - `eta_k`: complex index over the exterior's, per channel; `None` reflects everything
    /// - `reflectance`: scales what Fresnel's equations give; physically 1
    #[inline(always)]
    pub fn new(distribution: Microfacet<S>, eta_k: Option<(Rgb, Rgb)>, reflectance: Rgb) -> Self {
        Self { distribution, metal: Metal::new(eta_k, reflectance) }
    }

    /// The same model, its shape known at run time.
    #[inline(always)]
    pub fn of_any_shape(self) -> RoughConductor {
        RoughConductor { distribution: self.distribution.of_any_shape(), metal: self.metal }
    }
}

impl<S: MicrofacetShape> Bsdf for RoughConductor<S> {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        let mirror = Facet::between(wo, wi);
        self.distribution.reflection(wo, wi, &mirror) * self.metal.reflectance(mirror.half_cos())
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, _u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let m = self.distribution.sample_visible(wo, u);
        let wi = reflect_about(wo, m);
        let pdf = self.distribution.reflection_pdf(wo, &Facet::of(m));
        let weight = self.metal.reflectance(wo.dot(m)) * self.distribution.g2_over_g1(wo, wi);
        (wi.z > 0.0 && pdf > 0.0).then_some(BsdfSample { wi, weight, pdf, delta: false, eta: 1.0 })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        self.distribution.reflection_pdf(wo, &Facet::between(wo, wi))
    }

    #[inline(always)]
    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false, delta: false }
    }

    #[inline(always)]
    fn albedo(&self) -> Rgb {
        self.metal.reflectance(1.0)
    }
}
