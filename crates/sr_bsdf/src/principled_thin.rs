//! Burley's principled model of a thin surface, as Mitsuba 3's `principledthin`.

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;
use std::f32::consts::FRAC_1_PI;

use crate::disney::{self, Base, r0, schlick, tint};
use crate::interface::{dielectric, reflect_about};
use crate::microfacet::Facet;
use crate::rough_dielectric::flip;
use crate::{Bsdf, BsdfSample, Ggx, Lobes, Microfacet, Rgb};

/// What a [`PrincipledThin`] is made from. All but the colour, `eta`, `diff_trans` and rates are brought into [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledThinInputs {
    /// Of the diffuse base, of what is transmitted, of tints.
    pub base_color: Rgb,
    /// Of reflection and, after scaling with the index, of transmission; α is its square.
    pub roughness: f32,
    /// Stretches highlights along the tangent.
    pub anisotropic: f32,
    /// From a diffuse surface to a pane.
    pub spec_trans: f32,
    /// Index inside over that outside, positive.
    pub eta: f32,
    /// Tints reflection with the base colour.
    pub spec_tint: f32,
    /// A soft brightening at grazing angles.
    pub sheen: f32,
    /// Tints the sheen with the base colour.
    pub sheen_tint: f32,
    /// From the diffuse base to a stand-in for scattering below the surface.
    pub flatness: f32,
    /// Of the diffuse light, how much passes: in [0, 2], 2 being all.
    pub diff_trans: f32,
    /// How often specular reflection and transmission, diffuse reflection and transmission are sampled, relatively.
    pub rates: [f32; 4],
}

impl Default for PrincipledThinInputs {
    fn default() -> Self {
        Self {
            base_color: Rgb::splat(0.5),
            roughness: 0.5,
            anisotropic: 0.0,
            spec_trans: 0.0,
            eta: 1.5,
            spec_tint: 0.0,
            sheen: 0.0,
            sheen_tint: 0.0,
            flatness: 0.0,
            diff_trans: 0.0,
            rates: [1.0; 4],
        }
    }
}

/// Leaves, paper, frosted panes (Burley 2015, §5.3); see [`PrincipledThinInputs`]. Both sides are alike.
///
/// Transmitted light is not bent, but spread as if it had been reflected to the other side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledThin {
    reflecting: Microfacet<Ggx>,
    transmitting: Microfacet<Ggx>,
    base_color: Rgb,
    eta: f32,
    spec_trans: f32,
    spec_tint: f32,
    /// In [0, 1].
    diff_trans: f32,
    base: Base,
    /// Probabilities of specular reflection and transmission, diffuse reflection and transmission.
    choice: [f32; 4],
}

impl PrincipledThin {
    /// From inputs at a point.
    pub fn new(inputs: PrincipledThinInputs) -> Self {
        let unit = |x: f32| x.clamp(0.0, 1.0);
        let (roughness, anisotropic) = (unit(inputs.roughness), unit(inputs.anisotropic));
        let (spec_trans, diff_trans) = (unit(inputs.spec_trans), unit(0.5 * inputs.diff_trans));
        let base_color = inputs.base_color.max(Rgb::ZERO);
        let diffuse = 1.0 - spec_trans;
        let shares = [0.5 * spec_trans, 0.5 * spec_trans, diffuse * (1.0 - diff_trans), diffuse * diff_trans];
        let rates: [f32; 4] = std::array::from_fn(|i| shares[i] * inputs.rates[i].max(0.0));
        let sum: f32 = rates.iter().sum();
        Self {
            reflecting: disney::distribution(roughness, anisotropic),
            transmitting: disney::distribution((0.65 * inputs.eta - 0.35) * roughness, anisotropic),
            base_color,
            eta: inputs.eta,
            spec_trans,
            spec_tint: unit(inputs.spec_tint),
            diff_trans,
            base: Base::new(
                base_color,
                roughness,
                unit(inputs.flatness),
                unit(inputs.sheen),
                unit(inputs.sheen_tint),
            ),
            choice: if sum > 0.0 { rates.map(|rate| rate / sum) } else { [0.0; 4] },
        }
    }

    /// f and the density, with `wo` above.
    ///
    /// Both sides' terms are found and one is picked: loops over many directions then need no branch.
    #[inline(always)]
    fn eval_pdf_above(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let passes = wi.z < 0.0;
        let above = wi.with_z(wi.z.abs());
        let mirror = Facet::between(wo, above);
        let cos = mirror.half_cos();
        let kept = self.reflecting.reflection_pdf(wo, &mirror);
        // A facet that the transmitted direction would have to cross again does not count.
        let passed = self.transmitting.reflection_pdf(wo, &mirror);
        let passed = if mirror.is_seen_from(wi) { 0.0 } else { passed };
        let split = dielectric(cos, self.eta);
        let diffuse = 1.0 - self.spec_trans;

        let scale = self.spec_trans * split.transmittance * passed / self.transmitting.projected_area(above)
            + diffuse * self.diff_trans * FRAC_1_PI;
        let transmitted = self.base_color * scale;

        let tinted = schlick(tint(self.base_color) * r0(self.eta), cos, self.eta);
        let fresnel = Rgb::splat(split.reflectance).lerp(tinted, self.spec_tint);
        let (base, sheen) = self.base.eval(wo.z, above.z, cos);
        let reflected = fresnel * (self.spec_trans * kept / self.reflecting.projected_area(above))
            + (base + sheen) * (diffuse * (1.0 - self.diff_trans));

        let cosine_pdf = CosineHemisphere.pdf(above);
        let [reflect, transmit, scatter, scatter_through] = self.choice;
        let pdf_passed = transmit * passed + scatter_through * cosine_pdf;
        let pdf_kept = reflect * kept + scatter * cosine_pdf;
        if passes { (transmitted, pdf_passed) } else { (reflected, pdf_kept) }
    }

    #[inline(always)]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (up, wi) = if wo.z < 0.0 { (flip(wo), flip(wi)) } else { (wo, wi) };
        let (f, pdf) = self.eval_pdf_above(up, wi);
        if up.z == 0.0 || wi.z == 0.0 { (Rgb::ZERO, 0.0) } else { (f, pdf) }
    }
}

impl Bsdf for PrincipledThin {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let is_below = wo.z < 0.0;
        let wo = if is_below { flip(wo) } else { wo };
        if wo.z <= 0.0 {
            return None;
        }
        let [reflect, transmit, scatter, _] = self.choice;
        let is_mirrored = u_lobe < reflect + transmit;
        let above = if is_mirrored {
            let distribution = if u_lobe < reflect { &self.reflecting } else { &self.transmitting };
            reflect_about(wo, distribution.sample_visible(wo, u))
        } else {
            CosineHemisphere.sample(u)?.value
        };
        let stays = if is_mirrored { u_lobe < reflect } else { u_lobe < reflect + transmit + scatter };
        let wi = if stays { above } else { flip(above) };
        if above.z <= 0.0 || (is_mirrored && !stays && Facet::between(wo, above).is_seen_from(wi)) {
            return None;
        }
        let (f, pdf) = self.eval_pdf_above(wo, wi);
        let weight = f * (above.z / pdf);
        let wi = if is_below { flip(wi) } else { wi };
        (pdf > f32::MIN_POSITIVE && pdf.is_finite() && weight != Rgb::ZERO).then_some(BsdfSample {
            wi,
            weight,
            pdf,
            delta: false,
            eta: 1.0,
        })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eval_pdf(wo, wi).1
    }

    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: self.spec_trans > 0.0 || self.diff_trans > 0.0, delta: false }
    }

    fn albedo(&self) -> Rgb {
        let r = Rgb::splat(dielectric(1.0, self.eta).reflectance);
        self.base_color.lerp(r + (Rgb::ONE - r) * self.base_color, self.spec_trans)
    }
}
