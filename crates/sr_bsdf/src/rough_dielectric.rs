//! A rough interface between two dielectrics: frosted glass.

use glam::{Vec2, Vec3};

use crate::interface::{dielectric, reflect_about, refract_about, transmittance};
use crate::microfacet::Facet;
use crate::{Bsdf, BsdfSample, Lobes, Microfacet, MicrofacetKind, MicrofacetShape, Rgb};

/// A surface of small smooth interfaces (Walter et al. 2007).
///
/// Radiance that crosses the interface is scaled by 1/η², as for [`crate::Dielectric`]. One bounce
/// only, so a rough surface loses some energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric<S = MicrofacetKind> {
    distribution: Microfacet<S>,
    eta: f32,
    reflectance: Rgb,
    transmittance: Rgb,
}

impl<S: MicrofacetShape> RoughDielectric<S> {
    /// An interface between media more alike than this bends light less than `f32` can tell.
    const MIN_CONTRAST: f32 = 1e-4;

    /// - `eta`: index inside (−Z) over that outside (+Z), positive; moved away from 1 if it is nearer
    ///   than 10⁻⁴, for a rough interface that does not bend light is no longer a density
    /// - `reflectance`, `transmittance`: scale what Fresnel's equations give; physically 1
    #[inline(always)]
    pub fn new(distribution: Microfacet<S>, eta: f32, reflectance: Rgb, transmittance: Rgb) -> Self {
        Self { distribution, eta: Self::apart(eta), reflectance, transmittance }
    }

    /// The index, moved away from 1 if it is nearer than 10⁻⁴.
    #[inline(always)]
    pub(crate) fn apart(eta: f32) -> f32 {
        let contrast = eta - 1.0;
        if contrast.abs() < Self::MIN_CONTRAST { 1.0 + Self::MIN_CONTRAST.copysign(contrast) } else { eta }
    }

    /// The same model, its shape known at run time.
    #[inline(always)]
    pub fn of_any_shape(self) -> RoughDielectric {
        let Self { distribution, eta, reflectance, transmittance } = self;
        RoughDielectric { distribution: distribution.of_any_shape(), eta, reflectance, transmittance }
    }

    /// Turns the frame so that `wo` is on the side of +Z; gives the far index over the near one.
    #[inline(always)]
    fn seen_from_above(&self, wo: Vec3, wi: Vec3) -> (Vec3, Vec3, f32) {
        if wo.z > 0.0 { (wo, wi, self.eta) } else { (flip(wo), flip(wi), 1.0 / self.eta) }
    }
}

/// The facet that refracts between two directions.
pub(crate) struct RefractingFacet {
    pub m: Vec3,
    /// (1 − F) |wi · m| / (wo · m + η wi · m)²
    pub factor: f32,
    pub cos_o: f32,
}

/// `None` if no facet refracts between `wo` (above) and `wi` (below).
#[inline(always)]
pub(crate) fn refracting_facet(wo: Vec3, wi: Vec3, eta: f32) -> Option<RefractingFacet> {
    let h = wo + eta * wi;
    let length_squared = h.length_squared(); // is (wo · m + η wi · m)²
    let m = h * (1.0 / length_squared.sqrt()).copysign(h.z);
    let (cos_o, cos_i) = (wo.dot(m), -wi.dot(m));
    if cos_o <= 0.0 || cos_i <= 0.0 || length_squared == 0.0 {
        return None;
    }
    // From both cosines: one would have to be worked out from the other, which near the critical angle is all rounding.
    let factor = transmittance(cos_o, cos_i, eta) * cos_i / length_squared;
    Some(RefractingFacet { m, factor, cos_o })
}

#[inline(always)]
pub(crate) fn flip(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, -w.z)
}

impl<S: MicrofacetShape> Bsdf for RoughDielectric<S> {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let (wo, wi, eta) = self.seen_from_above(wo, wi);
        if wo.z == 0.0 || wi.z == 0.0 {
            return Rgb::ZERO;
        }
        if wi.z > 0.0 {
            let mirror = Facet::between(wo, wi);
            let f = dielectric(mirror.half_cos(), eta).reflectance;
            return self.reflectance * (f * self.distribution.reflection(wo, wi, &mirror));
        }
        let Some(facet) = refracting_facet(wo, wi, eta) else { return Rgb::ZERO };
        let area = self.distribution.joint_area(wo, wi);
        self.transmittance * (facet.factor * facet.cos_o * self.distribution.d(facet.m) / area)
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let above = wo.z > 0.0;
        let (wo, _, eta) = self.seen_from_above(wo, wo);
        let m = self.distribution.sample_visible(wo, u);
        let cos_o = wo.dot(m);
        if cos_o <= 0.0 {
            return None;
        }
        let split = dielectric(cos_o, eta);
        let sample = if u_lobe < split.reflectance {
            let wi = reflect_about(wo, m);
            if wi.z <= 0.0 {
                return None;
            }
            let pdf = split.reflectance * self.distribution.reflection_pdf(wo, &Facet::of(m));
            BsdfSample { wi, weight: self.reflectance, pdf, delta: false, eta: 1.0 }
        } else {
            let wi = refract_about(wo, m, split);
            if wi.z >= 0.0 {
                return None;
            }
            // wo · m + η wi · m = cos_o − η cos_t, without the cancellation for η near 1.
            let half_length = (1.0 - eta * eta) / (cos_o + eta * split.cos_t);
            let jacobian = eta * eta * split.cos_t / (half_length * half_length);
            let pdf = split.transmittance * self.distribution.visible_pdf(wo, m) * jacobian;
            BsdfSample { wi, weight: self.transmittance / (eta * eta), pdf, delta: false, eta }
        };
        let weight = sample.weight * self.distribution.g2_over_g1(wo, sample.wi);
        let wi = if above { sample.wi } else { flip(sample.wi) };
        (sample.pdf > 0.0).then_some(BsdfSample { wi, weight, ..sample })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (wo, wi, eta) = self.seen_from_above(wo, wi);
        if wo.z == 0.0 || wi.z == 0.0 {
            return 0.0;
        }
        if wi.z > 0.0 {
            let mirror = Facet::between(wo, wi);
            return dielectric(mirror.half_cos(), eta).reflectance
                * self.distribution.reflection_pdf(wo, &mirror);
        }
        refracting_facet(wo, wi, eta)
            .map_or(0.0, |facet| facet.factor * eta * eta * self.distribution.visible_pdf(wo, facet.m))
    }

    #[inline(always)]
    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: true, delta: false }
    }

    #[inline(always)]
    fn albedo(&self) -> Rgb {
        self.transmittance.lerp(self.reflectance, dielectric(1.0, self.eta).reflectance)
    }
}
