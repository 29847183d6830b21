//! A rough dielectric coating over a diffuse base.

use std::f32::consts::FRAC_1_PI;

use glam::{BVec3, Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::interface::{dielectric, reflect_about};
use crate::microfacet::Facet;
use crate::plastic::{LobeChoice, LobeProbabilities, base_below};
use crate::rough_coat::{Curve, RoughCoat};
use crate::{Bsdf, BsdfSample, Lobes, Microfacet, MicrofacetKind, MicrofacetShape, Rgb};

/// A rough coating that reflects, over a base that scatters in all directions.
///
/// As [`crate::Plastic`], but with what a rough interface lets through (one bounce). On the side of +Z only.
#[derive(Clone, Copy, Debug)]
pub struct RoughPlastic<S = MicrofacetKind> {
    /// What the coating lets through.
    transmittance: Curve,
    distribution: Microfacet<S>,
    eta: f32,
    specular: Rgb,
    base: Rgb,
    choice: LobeChoice,
}

impl RoughPlastic {
    /// [`RoughPlastic::of_distribution`], with that of the coat.
    #[inline(always)]
    pub fn new(coat: &RoughCoat, diffuse: Rgb, specular: Rgb, nonlinear: bool) -> Self {
        Self::of_distribution(*coat.distribution(), coat, diffuse, specular, nonlinear)
    }
}

impl<S: MicrofacetShape> RoughPlastic<S> {
    /// - `distribution`: that of the coat
    /// - `coat`: made once per material
    /// - `diffuse`: albedo of the base, per channel in [0, 1]
    /// - `specular`: scales the coating's reflection; physically 1
    /// - `nonlinear`: does the base's colour saturate by interreflection below the coating?
    #[inline(always)]
    pub fn of_distribution(
        distribution: Microfacet<S>,
        coat: &RoughCoat,
        diffuse: Rgb,
        specular: Rgb,
        nonlinear: bool,
    ) -> Self {
        Self {
            transmittance: coat.transmittances(),
            distribution,
            eta: coat.eta(),
            specular,
            base: base_below(diffuse, coat.internal_reflectance(), coat.eta(), nonlinear),
            choice: LobeChoice::new(diffuse, specular),
        }
    }

    /// The same model, its shape known at run time.
    #[inline(always)]
    pub fn of_any_shape(self) -> RoughPlastic {
        let Self { transmittance, distribution, eta, specular, base, choice } = self;
        RoughPlastic { transmittance, distribution: distribution.of_any_shape(), eta, specular, base, choice }
    }

    /// f and the density for two directions above the surface, with the facet that mirrors one into the other.
    #[inline(always)]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3, mirror: &Facet, p: LobeProbabilities, t_o: f32) -> (Rgb, f32) {
        let distribution = &self.distribution;
        let mirrored = distribution.reflection_pdf(wo, mirror);
        let f = dielectric(mirror.half_cos(), self.eta).reflectance;
        let specular = self.specular * (f * mirrored * distribution.shadowing(wo, wi));
        let diffuse = self.base * (t_o * self.transmittance.at(wi.z) * FRAC_1_PI);
        (specular + diffuse, p.specular * mirrored + p.diffuse * CosineHemisphere.pdf(wi))
    }

    #[inline(always)]
    fn lobe_probabilities(&self, t_o: f32) -> LobeProbabilities {
        self.choice.given_transmittance(t_o)
    }
}

/// Nothing here branches, so that compilers can serve many points at a time: what does not count is computed as well.
impl<S: MicrofacetShape> Bsdf for RoughPlastic<S> {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let mirror = Facet::between(wo, wi);
        let t_o = self.transmittance.at(wo.z);
        let (f, _) = self.eval_pdf(wo, wi, &mirror, self.lobe_probabilities(t_o), t_o);
        Rgb::select(BVec3::splat(wo.z > 0.0 && wi.z > 0.0), f, Rgb::ZERO)
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let t_o = self.transmittance.at(wo.z);
        let p = self.lobe_probabilities(t_o);
        let mirrored = reflect_about(wo, self.distribution.sample_visible(wo, u));
        let scattered = CosineHemisphere.sample(u).map_or(Vec3::ZERO, |s| s.value);
        let wi = Vec3::select(BVec3::splat(u_lobe < p.specular), mirrored, scattered);
        let mirror = Facet::between(wo, wi);
        let (f, pdf) = self.eval_pdf(wo, wi, &mirror, p, t_o);
        let weight = f * (wi.z / pdf);
        let is_above = (wo.z > 0.0) & (wi.z > 0.0);
        (is_above & (pdf > f32::MIN_POSITIVE) & (weight != Rgb::ZERO)).then_some(BsdfSample {
            wi,
            weight,
            pdf,
            delta: false,
            eta: 1.0,
        })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let p = self.lobe_probabilities(self.transmittance.at(wo.z));
        let mirror = Facet::between(wo, wi);
        let pdf =
            p.specular * self.distribution.reflection_pdf(wo, &mirror) + p.diffuse * CosineHemisphere.pdf(wi);
        if wo.z > 0.0 && wi.z > 0.0 { pdf } else { 0.0 }
    }

    #[inline(always)]
    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false, delta: false }
    }

    #[inline(always)]
    fn albedo(&self) -> Rgb {
        let t = self.transmittance.at(1.0);
        (1.0 - t) * self.specular + t * t * self.base
    }
}
