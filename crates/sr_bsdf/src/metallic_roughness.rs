//! The metallic-roughness material of glTF 2.0 (specification, appendix B), with the extensions KHR_materials_specular,
//! _ior, _clearcoat, _sheen, _transmission, _diffuse_transmission and _anisotropy.

use std::f32::consts::{FRAC_1_PI, TAU};
use std::sync::LazyLock;

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::disney::{r0, schlick_weight};
use crate::interface::{dielectric, reflect_about, refract_about};
use crate::microfacet::Facet;
use crate::rough_dielectric::{flip, refracting_facet};
use crate::{AlbedoTable, Bsdf, BsdfSample, Ggx, Lobes, Microfacet, Rgb};

/// What a [`MetallicRoughness`] is made from: names, ranges and defaults are glTF's. Factors are brought into [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetallicRoughnessInputs {
    /// Of the base, of metals, of what is transmitted.
    pub base_color: Rgb,
    /// From dielectric to metal.
    pub metallic: f32,
    /// α is its square.
    pub roughness: f32,
    /// Strength of the dielectric reflection.
    pub specular: f32,
    /// Its colour at normal incidence.
    pub specular_color: Rgb,
    /// Index of refraction, at least 1.
    pub ior: f32,
    /// Strength of a coat.
    pub clearcoat: f32,
    /// Its roughness.
    pub clearcoat_roughness: f32,
    /// Colour of a layer of fibres.
    pub sheen_color: Rgb,
    /// Its roughness.
    pub sheen_roughness: f32,
    /// Of the dielectric's base, how much transmits instead of being diffuse.
    pub transmission: f32,
    /// Is the surface a thin sheet, as without KHR_materials_volume? Else light is bent.
    pub is_thin: bool,
    /// Of a thin sheet's diffuse light, how much comes out on the other side.
    pub diffuse_transmission: f32,
    /// Its colour there.
    pub diffuse_transmission_color: Rgb,
    /// Stretches highlights.
    pub anisotropy: f32,
    /// Along which direction, from the tangent, counter-clockwise, in radians.
    pub anisotropy_rotation: f32,
}

impl Default for MetallicRoughnessInputs {
    fn default() -> Self {
        Self {
            base_color: Rgb::ONE,
            metallic: 1.0,
            roughness: 1.0,
            specular: 1.0,
            specular_color: Rgb::ONE,
            ior: 1.5,
            clearcoat: 0.0,
            clearcoat_roughness: 0.0,
            sheen_color: Rgb::ZERO,
            sheen_roughness: 0.0,
            transmission: 0.0,
            is_thin: true,
            diffuse_transmission: 0.0,
            diffuse_transmission_color: Rgb::ONE,
            anisotropy: 0.0,
            anisotropy_rotation: 0.0,
        }
    }
}

/// glTF's material. Where the specification's mixing depends on the viewer alone, both directions count here, so that
/// light may travel either way: the coat dims what is below by (1 − c F(μₒ)) (1 − c F(μᵢ)).
///
/// A thin sheet is the same from both sides. Otherwise only transmission and its reflection are seen from behind.
#[derive(Clone, Copy, Debug)]
pub struct MetallicRoughness {
    i: MetallicRoughnessInputs,
    /// cos and sin of the rotation.
    turn: Vec2,
    gloss: Microfacet<Ggx>,
    coat: Microfacet<Ggx>,
    sheen: Sheen,
    /// The dielectric's reflectance at normal incidence.
    f0: Rgb,
}

/// A layer of fibres (Estevez & Kulla 2017, "Production Friendly Microfacet Sheen BRDF"), with Neubelt & Pettineo's
/// visibility (2013).
#[derive(Clone, Copy, Debug)]
struct Sheen {
    color: Rgb,
    alpha: f32,
}

/// How much sheen reflects, at `SHEEN_ALPHAS` values of √α.
static SHEEN_ALBEDOS: LazyLock<Vec<AlbedoTable>> = LazyLock::new(|| {
    let table = |i: usize| {
        let root = (i as f32 / (SHEEN_ALPHAS - 1) as f32).max(Sheen::MIN_ROUGHNESS);
        let sheen = Sheen { color: Rgb::ONE, alpha: root * root };
        AlbedoTable::new(|mu| sheen.integrated(mu))
    };
    (0..SHEEN_ALPHAS).map(table).collect()
});
const SHEEN_ALPHAS: usize = 17;

impl Sheen {
    const MIN_ROUGHNESS: f32 = 0.05;

    fn eval(&self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize_or_zero();
        let inverse = 1.0 / self.alpha;
        let sin = (1.0 - h.z * h.z).max(0.0).sqrt();
        let d = (2.0 + inverse) * sin.powf(inverse) / TAU;
        d / (4.0 * (wo.z + wi.z - wo.z * wi.z)).max(1e-6)
    }

    /// ∫ f cos θᵢ dωᵢ, by the midpoint rule.
    fn integrated(&self, mu: f32) -> f32 {
        const N: usize = 32;
        let at = |i: usize| (i as f32 + 0.5) / N as f32;
        let wo = Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu);
        let value = |i: usize, j: usize| {
            let z = at(i);
            let (sin, cos) = (0.5 * TAU * at(j)).sin_cos();
            let wi = (Vec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt()).with_z(z);
            self.eval(wo, wi) * z
        };
        let sum: f32 = (0..N * N).map(|k| value(k / N, k % N)).sum();
        sum * TAU / (N * N) as f32
    }

    /// What is left for the layers below, of light that comes and goes at these cosines.
    #[inline(always)]
    fn passes(&self, cos_o: f32, cos_i: f32) -> f32 {
        let most = self.color.max_element();
        if most <= 0.0 {
            return 1.0;
        }
        let x = self.alpha.sqrt() * (SHEEN_ALPHAS - 1) as f32;
        let k = (x as usize).min(SHEEN_ALPHAS - 2);
        let albedo = |mu: f32| {
            let (a, b) = (SHEEN_ALBEDOS[k].at(mu), SHEEN_ALBEDOS[k + 1].at(mu));
            a + (x - k as f32) * (b - a)
        };
        (1.0 - most * albedo(cos_o).max(albedo(cos_i))).max(0.0)
    }
}

/// Probabilities of the coat, the gloss, the cosine lobe, transmission, and the cosine lobe on the other side.
type Choice = [f32; 5];

impl MetallicRoughness {
    /// From inputs at a point.
    pub fn new(inputs: MetallicRoughnessInputs) -> Self {
        let unit = |x: f32| x.clamp(0.0, 1.0);
        let color = |c: Rgb| c.clamp(Rgb::ZERO, Rgb::ONE);
        let (roughness, anisotropy) = (unit(inputs.roughness), unit(inputs.anisotropy));
        let bends = inputs.transmission > 0.0 && !inputs.is_thin;
        let i = MetallicRoughnessInputs {
            base_color: color(inputs.base_color),
            metallic: unit(inputs.metallic),
            specular: unit(inputs.specular),
            specular_color: inputs.specular_color.max(Rgb::ZERO),
            // An interface between media that are alike does not refract.
            ior: inputs.ior.max(if bends { 1.001 } else { 1.0 }),
            clearcoat: unit(inputs.clearcoat),
            sheen_color: color(inputs.sheen_color),
            transmission: unit(inputs.transmission),
            diffuse_transmission: if inputs.is_thin { unit(inputs.diffuse_transmission) } else { 0.0 },
            diffuse_transmission_color: color(inputs.diffuse_transmission_color),
            ..inputs
        };
        let alpha = roughness * roughness;
        let along = alpha + (1.0 - alpha) * anisotropy * anisotropy;
        let coat_alpha = unit(inputs.clearcoat_roughness).powi(2);
        let sheen_alpha = unit(inputs.sheen_roughness).max(Sheen::MIN_ROUGHNESS).powi(2);
        Self {
            turn: Vec2::from_angle(-inputs.anisotropy_rotation),
            gloss: Microfacet::new(Ggx, along.max(1e-3), alpha.max(1e-3)),
            coat: Microfacet::isotropic(Ggx, coat_alpha.max(1e-3)),
            sheen: Sheen { color: i.sheen_color, alpha: sheen_alpha },
            f0: (r0(i.ior) * i.specular_color).min(Rgb::ONE) * i.specular,
            i,
        }
    }

    /// The dielectric's Fresnel factor at the cosine on the side of the lower index.
    #[inline(always)]
    fn dielectric_fresnel(&self, cos: f32) -> Rgb {
        self.f0.lerp(Rgb::splat(self.i.specular), schlick_weight(cos))
    }

    #[inline(always)]
    fn gloss_fresnel(&self, cos: f32) -> Rgb {
        let metal = self.i.base_color.lerp(Rgb::ONE, schlick_weight(cos));
        self.dielectric_fresnel(cos).lerp(metal, self.i.metallic)
    }

    #[inline(always)]
    fn coat_fresnel(&self, cos: f32) -> f32 {
        self.i.clearcoat * (0.04 + 0.96 * schlick_weight(cos))
    }

    /// What coat and sheen leave to what is below.
    #[inline(always)]
    fn passes(&self, cos_o: f32, cos_i: f32) -> f32 {
        let coat = (1.0 - self.coat_fresnel(cos_o)) * (1.0 - self.coat_fresnel(cos_i));
        coat * self.sheen.passes(cos_o, cos_i)
    }

    /// Weight of what the dielectric transmits, before its Fresnel factor.
    #[inline(always)]
    fn transmits(&self) -> f32 {
        (1.0 - self.i.metallic) * self.i.transmission
    }

    #[inline(always)]
    fn diffuses(&self) -> f32 {
        (1.0 - self.i.metallic) * (1.0 - self.i.transmission) * (1.0 - self.i.diffuse_transmission)
    }

    /// Of diffuse light that comes out on the other side.
    #[inline(always)]
    fn diffuses_through(&self) -> f32 {
        (1.0 - self.i.metallic) * (1.0 - self.i.transmission) * self.i.diffuse_transmission
    }

    #[inline(always)]
    fn choice(&self, cos: f32) -> Choice {
        let coat = self.coat_fresnel(cos);
        let gloss = self.gloss_fresnel(cos).max_element();
        let enters = 1.0 - self.dielectric_fresnel(cos).max_element();
        let base = self.i.base_color.max_element() * enters;
        let across = self.diffuses_through() * self.i.diffuse_transmission_color.max_element() * enters;
        let cosine = self.diffuses() * base + self.i.sheen_color.max_element();
        let through = self.transmits() * base;
        let all = [
            coat,
            (1.0 - coat) * gloss,
            (1.0 - coat) * cosine,
            (1.0 - coat) * through,
            (1.0 - coat) * across,
        ];
        let sum: f32 = all.iter().sum();
        if sum > 0.0 { all.map(|p| p / sum) } else { [0.0; 5] }
    }

    /// In the frame of the highlights, `wo` above; `None` if nothing is seen from there.
    #[inline(always)]
    fn seen(&self, wo: Vec3) -> Option<(Vec3, bool)> {
        let is_front = wo.z > 0.0;
        let up = if is_front { wo } else { flip(wo) };
        let is_seen = is_front || self.transmits() > 0.0 || self.diffuses_through() > 0.0;
        (up.z > 0.0 && is_seen).then(|| (self.turn.rotate(up.truncate()).extend(up.z), is_front))
    }

    /// Into the frame of the highlights, or back.
    #[inline(always)]
    fn local(&self, w: Vec3, is_front: bool) -> Vec3 {
        let w = if is_front { w } else { flip(w) };
        self.turn.rotate(w.truncate()).extend(w.z)
    }

    #[inline(always)]
    fn back(&self, w: Vec3, is_front: bool) -> Vec3 {
        let w = (self.turn * Vec2::new(1.0, -1.0)).rotate(w.truncate()).extend(w.z);
        if is_front { w } else { flip(w) }
    }

    /// From behind, where light is bent.
    #[inline(always)]
    fn eval_pdf_inside(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let eta = 1.0 / self.i.ior;
        if wi.z > 0.0 {
            let m = (wo + wi).normalize_or_zero();
            let f = self.inside_fresnel(wo.dot(m));
            let mirrored = self.gloss.reflection_pdf(wo, &Facet::of(m));
            let value = f * (self.transmits() * mirrored / self.gloss.projected_area(wi));
            return (value, f.max_element() * mirrored);
        }
        let Some(facet) = refracting_facet(wo, wi, eta) else { return (Rgb::ZERO, 0.0) };
        let f = self.inside_fresnel(facet.cos_o).max_element();
        self.refracted(wo, wi, eta, facet.m, 1.0 - f, 1.0 - f)
    }

    #[inline(always)]
    fn inside_fresnel(&self, cos: f32) -> Rgb {
        let split = dielectric(cos, 1.0 / self.i.ior);
        if split.transmittance <= 0.0 { Rgb::ONE } else { self.dielectric_fresnel(split.cos_t) }
    }

    /// f and the density where facets with normal `m` refract between two directions.
    #[inline(always)]
    fn refracted(&self, wo: Vec3, wi: Vec3, eta: f32, m: Vec3, transmits: f32, p: f32) -> (Rgb, f32) {
        let cos_i = -wi.dot(m);
        let length2 = (wo.dot(m) - eta * cos_i).powi(2);
        let area = self.gloss.joint_area(wo, wi);
        let outside = if eta > 1.0 { wo.z } else { -wi.z };
        let scale = self.transmits() * transmits * self.passes(outside, 1.0) * wo.dot(m) * cos_i / length2;
        let pdf = p * self.gloss.visible_pdf(wo, m) * eta * eta * cos_i / length2;
        (self.i.base_color * (scale * self.gloss.d(m) / area), pdf)
    }

    #[inline(always)]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let nothing = (Rgb::ZERO, 0.0);
        let Some((wo, is_front)) = self.seen(wo) else { return nothing };
        let wi = self.local(wi, is_front);
        if wi.z == 0.0 {
            return nothing;
        }
        if !is_front && !self.i.is_thin {
            return self.eval_pdf_inside(wo, wi);
        }
        let [p_coat, p_gloss, p_cosine, p_through, p_across] = self.choice(wo.z);
        if wi.z < 0.0 {
            if self.i.is_thin {
                let mirrored = flip(wi);
                let m = (wo + mirrored).normalize_or_zero();
                let transmits = 1.0 - self.dielectric_fresnel(wo.dot(m)).max_element();
                let pdf = self.gloss.reflection_pdf(wo, &Facet::of(m));
                let passes = transmits * self.passes(wo.z, mirrored.z);
                let scale = self.transmits() * passes;
                let f = self.i.base_color * (scale * pdf / self.gloss.projected_area(mirrored));
                let diffuse = self.diffuses_through() * passes * FRAC_1_PI;
                let f = f + self.i.diffuse_transmission_color * diffuse;
                return (f, p_through * pdf + p_across * CosineHemisphere.pdf(mirrored));
            }
            let Some(facet) = refracting_facet(wo, wi, self.i.ior) else { return nothing };
            let transmits = 1.0 - self.dielectric_fresnel(facet.cos_o).max_element();
            return self.refracted(wo, wi, self.i.ior, facet.m, transmits, p_through);
        }
        let m = (wo + wi).normalize_or_zero();
        let cos = wo.dot(m);
        let gloss_pdf = self.gloss.reflection_pdf(wo, &Facet::of(m));
        let gloss = self.gloss_fresnel(cos) * (gloss_pdf / self.gloss.projected_area(wi));
        let transmits = 1.0 - self.dielectric_fresnel(cos).max_element();
        let base = self.i.base_color * (self.diffuses() * transmits * FRAC_1_PI);
        let coat_pdf = self.coat.reflection_pdf(wo, &Facet::of(m));
        let coat = self.coat_fresnel(cos) * coat_pdf / self.coat.projected_area(wi);
        let uncoated = (1.0 - self.coat_fresnel(wo.z)) * (1.0 - self.coat_fresnel(wi.z));
        let mut f = (gloss + base) * self.passes(wo.z, wi.z) + Rgb::splat(coat);
        if self.i.sheen_color != Rgb::ZERO {
            f += self.i.sheen_color * (uncoated * self.sheen.eval(wo, wi));
        }
        let pdf = p_coat * coat_pdf + p_gloss * gloss_pdf + p_cosine * CosineHemisphere.pdf(wi);
        (f, pdf)
    }

    /// A direction in the frame of the highlights, and the index there over that of `wo`.
    #[inline(always)]
    fn draw(&self, wo: Vec3, is_front: bool, u_lobe: f32, u: Vec2) -> Option<(Vec3, f32)> {
        if !is_front && !self.i.is_thin {
            let m = self.gloss.sample_visible(wo, u);
            if u_lobe < self.inside_fresnel(wo.dot(m)).max_element() {
                return Some((reflect_about(wo, m), 1.0)).filter(|(wi, _)| wi.z > 0.0);
            }
            let eta = 1.0 / self.i.ior;
            let wi = refract_about(wo, m, dielectric(wo.dot(m), eta));
            return Some((wi, eta)).filter(|(wi, _)| wi.z < 0.0);
        }
        let [p_coat, p_gloss, p_cosine, p_through, _] = self.choice(wo.z);
        if u_lobe < p_coat {
            let wi = reflect_about(wo, self.coat.sample_visible(wo, u));
            return Some((wi, 1.0)).filter(|(wi, _)| wi.z > 0.0);
        }
        if u_lobe >= p_coat + p_gloss && u_lobe < p_coat + p_gloss + p_cosine {
            return Some((CosineHemisphere.sample(u)?.value, 1.0));
        }
        if self.i.diffuse_transmission > 0.0 && u_lobe >= p_coat + p_gloss + p_cosine + p_through {
            return Some((flip(CosineHemisphere.sample(u)?.value), 1.0));
        }
        let m = self.gloss.sample_visible(wo, u);
        let mirrored = reflect_about(wo, m);
        if u_lobe < p_coat + p_gloss {
            return Some((mirrored, 1.0)).filter(|(wi, _)| wi.z > 0.0);
        }
        if self.i.is_thin {
            return Some((flip(mirrored), 1.0)).filter(|(wi, _)| wi.z < 0.0);
        }
        let wi = refract_about(wo, m, dielectric(wo.dot(m), self.i.ior));
        Some((wi, self.i.ior)).filter(|(wi, _)| wi.z < 0.0)
    }
}

impl Bsdf for MetallicRoughness {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let (up, is_front) = self.seen(wo)?;
        let (wi, eta) = self.draw(up, is_front, u_lobe, u)?;
        let wi = self.back(wi, is_front).normalize();
        let (f, pdf) = self.eval_pdf(wo, wi);
        let weight = f * (wi.z.abs() / pdf);
        (pdf > f32::MIN_POSITIVE && pdf.is_finite() && weight != Rgb::ZERO).then_some(BsdfSample {
            wi,
            weight,
            pdf,
            delta: false,
            eta,
        })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eval_pdf(wo, wi).1
    }

    fn lobes(&self) -> Lobes {
        Lobes {
            reflection: true,
            transmission: self.transmits() + self.diffuses_through() > 0.0,
            delta: false,
        }
    }

    fn albedo(&self) -> Rgb {
        let f = self.dielectric_fresnel(1.0);
        f.lerp(self.i.base_color, self.i.metallic)
            + (1.0 - self.i.metallic) * (1.0 - f.max_element()) * self.i.base_color
    }
}
