//! Burley's principled model with transmission, as Mitsuba 3's `principled`.

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::disney::{self, Base, ClearcoatNormals, r0, schlick, tint};
use crate::interface::{DielectricSplit, dielectric, reflect_about, refract_about};
use crate::microfacet::Facet;
use crate::rough_dielectric::{flip, refracting_facet};
use crate::{Bsdf, BsdfSample, Ggx, Lobes, Microfacet, Rgb};

/// What a [`Principled`] is made from. All but colours, `eta` and rates are brought into [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledInputs {
    /// Of the diffuse base, of metals, of tints; its square root tints transmission.
    pub base_color: Rgb,
    /// Of the main reflection and transmission; α is its square.
    pub roughness: f32,
    /// Stretches highlights along the tangent.
    pub anisotropic: f32,
    /// From dielectric to metal.
    pub metallic: f32,
    /// From a diffuse base to a refracting interface.
    pub spec_trans: f32,
    /// Index inside over that outside, positive.
    pub eta: f32,
    /// Tints the dielectric reflection with the base colour.
    pub spec_tint: f32,
    /// A soft brightening at grazing angles.
    pub sheen: f32,
    /// Tints the sheen with the base colour.
    pub sheen_tint: f32,
    /// From the diffuse base to a stand-in for scattering below the surface.
    pub flatness: f32,
    /// A second, colourless reflection.
    pub clearcoat: f32,
    /// Of that reflection: from α = 0.1 to α = 0.001.
    pub clearcoat_gloss: f32,
    /// How often the diffuse base, the main reflection and the clear coat are sampled, relatively.
    pub rates: [f32; 3],
}

impl Default for PrincipledInputs {
    fn default() -> Self {
        Self {
            base_color: Rgb::splat(0.5),
            roughness: 0.5,
            anisotropic: 0.0,
            metallic: 0.0,
            spec_trans: 0.0,
            eta: 1.5,
            spec_tint: 0.0,
            sheen: 0.0,
            sheen_tint: 0.0,
            flatness: 0.0,
            clearcoat: 0.0,
            clearcoat_gloss: 0.0,
            rates: [1.0; 3],
        }
    }
}

/// Metals, plastics, cloth and rough glass in one model (Burley 2012 and 2015); see [`PrincipledInputs`].
///
/// From behind only transmission and its reflection are there. Sheen and clear coat are added to what is below, so
/// that some parameters reflect a little more than they receive, as Burley's and Mitsuba's do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    distribution: Microfacet<Ggx>,
    base_color: Rgb,
    eta: f32,
    metallic: f32,
    spec_tint: f32,
    /// The share of the diffuse base, and that of the refracting interface.
    brdf: f32,
    bsdf: f32,
    base: Base,
    clearcoat: f32,
    coat: ClearcoatNormals,
    /// From the front: probabilities of the base, the main lobe and the clear coat.
    choice: [f32; 3],
}

/// A pair of directions, turned so that `wo` is above.
struct Pair {
    wo: Vec3,
    wi: Vec3,
    /// Index on the far side over that on the side of `wo`.
    eta: f32,
    is_front: bool,
}

impl Principled {
    /// An interface between media more alike than this does not refract (as in Mitsuba).
    const MIN_CONTRAST: f32 = 1e-3;

    /// From inputs at a point.
    pub fn new(inputs: PrincipledInputs) -> Self {
        let unit = |x: f32| x.clamp(0.0, 1.0);
        let (metallic, spec_trans) = (unit(inputs.metallic), unit(inputs.spec_trans));
        let (brdf, bsdf) = ((1.0 - metallic) * (1.0 - spec_trans), (1.0 - metallic) * spec_trans);
        let contrast = inputs.eta - 1.0;
        let is_degenerate = bsdf > 0.0 && contrast.abs() < Self::MIN_CONTRAST;
        let eta = if is_degenerate { 1.0 + Self::MIN_CONTRAST.copysign(contrast) } else { inputs.eta };
        let clearcoat = unit(inputs.clearcoat);
        let [diffuse_rate, main_rate, coat_rate] = inputs.rates.map(|rate| rate.max(0.0));
        let rates = [diffuse_rate * brdf, main_rate, coat_rate * 0.25 * clearcoat];
        let sum: f32 = rates.iter().sum();
        let roughness = unit(inputs.roughness);
        let base_color = inputs.base_color.max(Rgb::ZERO);
        let sheen = (1.0 - metallic) * unit(inputs.sheen);
        Self {
            distribution: disney::distribution(roughness, unit(inputs.anisotropic)),
            base_color,
            eta,
            metallic,
            spec_tint: unit(inputs.spec_tint),
            brdf,
            bsdf,
            base: Base::new(base_color, roughness, unit(inputs.flatness), sheen, unit(inputs.sheen_tint)),
            clearcoat,
            coat: ClearcoatNormals::new(unit(inputs.clearcoat_gloss)),
            choice: if sum > 0.0 { rates.map(|rate| rate / sum) } else { [0.0; 3] },
        }
    }

    /// `None` if nothing can be seen from there.
    #[inline(always)]
    fn seen_from_above(&self, wo: Vec3, wi: Vec3) -> Option<Pair> {
        let is_front = wo.z > 0.0;
        let pair = match is_front {
            true => Pair { wo, wi, eta: self.eta, is_front },
            false => Pair { wo: flip(wo), wi: flip(wi), eta: 1.0 / self.eta, is_front },
        };
        (pair.wo.z > 0.0 && pair.wi.z != 0.0 && (is_front || self.bsdf > 0.0)).then_some(pair)
    }

    /// Fresnel's factor of the main reflection: a dielectric, its tinted share, and a metal.
    #[inline(always)]
    fn fresnel(&self, cos: f32, split: &DielectricSplit, is_front: bool) -> Rgb {
        if split.reflectance <= 0.0 {
            return Rgb::ZERO;
        }
        if !is_front {
            return Rgb::splat(self.bsdf * split.reflectance);
        }
        let mut f = Rgb::splat((1.0 - self.metallic) * (1.0 - self.spec_tint) * split.reflectance);
        if self.metallic > 0.0 {
            f += self.metallic * schlick(self.base_color, cos, self.eta);
        }
        if self.spec_tint > 0.0 {
            let tinted = schlick(tint(self.base_color) * r0(self.eta), cos, self.eta);
            f += (1.0 - self.metallic) * self.spec_tint * tinted;
        }
        f
    }

    /// Probability that a facet of the main lobe transmits, given that the main lobe was chosen.
    #[inline(always)]
    fn transmits(&self, split: &DielectricSplit, is_front: bool) -> f32 {
        if is_front { self.bsdf * split.transmittance } else { split.transmittance }
    }

    /// Probability of the main lobe.
    #[inline(always)]
    fn main(&self, is_front: bool) -> f32 {
        if is_front { self.choice[1] } else { 1.0 }
    }

    /// f and the density of two directions above the surface, m being their half vector.
    #[inline(always)]
    fn reflection(&self, pair: &Pair, m: Vec3) -> (Rgb, f32) {
        let &Pair { wo, wi, eta, is_front } = pair;
        let cos = wo.dot(m);
        let split = dielectric(cos, eta);
        let mirrored = self.distribution.reflection_pdf(wo, &Facet::of(m));
        let mut f = self.fresnel(cos, &split, is_front) * (mirrored / self.distribution.projected_area(wi));
        let mut pdf = self.main(is_front) * (1.0 - self.transmits(&split, is_front)) * mirrored;
        if !is_front {
            return (f, pdf);
        }
        if self.clearcoat > 0.0 {
            let fresnel = schlick(Rgb::splat(0.04), cos, self.eta).x;
            let g = ClearcoatNormals::g1(wo.z) * ClearcoatNormals::g1(wi.z);
            f += Rgb::splat(0.25 * self.clearcoat * fresnel * self.coat.d(m) * g);
            pdf += self.choice[2] * self.coat.pdf(m) / (4.0 * cos);
        }
        if self.brdf > 0.0 {
            let (base, sheen) = self.base.eval(wo.z, wi.z, cos);
            f += self.brdf * base + sheen;
            pdf += self.choice[0] * CosineHemisphere.pdf(wi);
        }
        (f, pdf)
    }

    #[inline(always)]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let nothing = (Rgb::ZERO, 0.0);
        let Some(pair) = self.seen_from_above(wo, wi) else { return nothing };
        if pair.wi.z > 0.0 {
            let m = (pair.wo + pair.wi).normalize_or_zero();
            return if pair.wo.dot(m) > 0.0 { self.reflection(&pair, m) } else { nothing };
        }
        if self.bsdf <= 0.0 {
            return nothing;
        }
        let Pair { wo, wi, eta, is_front } = pair;
        let Some(facet) = refracting_facet(wo, wi, eta) else { return nothing };
        let d = &self.distribution;
        let area = d.joint_area(wo, wi);
        let scale = self.bsdf * facet.factor * facet.cos_o * d.d(facet.m) / area;
        let share = if is_front { self.bsdf } else { 1.0 };
        let pdf = self.main(is_front) * share * facet.factor * eta * eta * d.visible_pdf(wo, facet.m);
        (self.base_color.map(f32::sqrt) * scale, pdf)
    }

    /// A facet of the main lobe refracts.
    #[inline(always)]
    fn refracted(&self, pair: &Pair, m: Vec3, split: &DielectricSplit) -> Option<BsdfSample> {
        let &Pair { wo, eta, is_front, .. } = pair;
        let wi = refract_about(wo, m, *split);
        // wo · m + η wi · m = cos_o − η cos_t, without the cancellation for η near 1.
        let half_length = (1.0 - eta * eta) / (wo.dot(m) + eta * split.cos_t);
        let jacobian = eta * eta * split.cos_t / (half_length * half_length);
        let chosen = self.main(is_front) * self.transmits(split, is_front);
        let pdf = chosen * self.distribution.visible_pdf(wo, m) * jacobian;
        let scale =
            self.bsdf * split.transmittance / chosen * self.distribution.g2_over_g1(wo, wi) / (eta * eta);
        let weight = self.base_color.map(f32::sqrt) * scale;
        (wi.z < 0.0 && pdf > 0.0 && pdf.is_finite()).then_some(BsdfSample {
            wi,
            weight,
            pdf,
            delta: false,
            eta,
        })
    }
}

impl Bsdf for Principled {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let is_front = wo.z > 0.0;
        let mut pair = self.seen_from_above(wo, wo)?;
        let [base, main, _] = if is_front { self.choice } else { [0.0, 1.0, 0.0] };
        let m = if u_lobe < base {
            pair.wi = CosineHemisphere.sample(u)?.value;
            (pair.wo + pair.wi).normalize_or_zero()
        } else if u_lobe < base + main {
            let m = self.distribution.sample_visible(pair.wo, u);
            let split = dielectric(pair.wo.dot(m), pair.eta);
            if u_lobe - base < main * self.transmits(&split, is_front) {
                let s = self.refracted(&pair, m, &split)?;
                return Some(BsdfSample { wi: if is_front { s.wi } else { flip(s.wi) }, ..s });
            }
            pair.wi = reflect_about(pair.wo, m);
            m
        } else {
            let m = self.coat.sample(u);
            pair.wi = reflect_about(pair.wo, m);
            m
        };
        if pair.wi.z <= 0.0 || pair.wo.dot(m) <= 0.0 {
            return None;
        }
        let (f, pdf) = self.reflection(&pair, m);
        let weight = f * (pair.wi.z / pdf);
        let wi = if is_front { pair.wi } else { flip(pair.wi) };
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
        Lobes { reflection: true, transmission: self.bsdf > 0.0, delta: false }
    }

    fn albedo(&self) -> Rgb {
        let gloss = self.fresnel(1.0, &dielectric(1.0, self.eta), true);
        gloss + self.brdf * self.base_color + self.bsdf * self.base_color.map(f32::sqrt)
    }
}
