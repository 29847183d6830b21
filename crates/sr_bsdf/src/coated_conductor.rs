//! A metal under a dielectric coating: lacquered brass, wet foil.

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::albedo_table::{AlbedoTable, mean_of_diffuse};
use crate::conductor::Metal;
use crate::interface::{dielectric, reflect, reflect_about};
use crate::microfacet::Facet;
use crate::rough_coat::mean_where_it_jumps;
use crate::{Bsdf, BsdfSample, Lobes, Microfacet, MicrofacetKind, Rgb, RoughConductor};

/// What is the same at every point of a coated metal; made once per material.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedConductorTables {
    /// `None`: smooth.
    coat: Option<Microfacet>,
    eta: f32,
    base: Microfacet,
    /// What the coat reflects.
    reflected: AlbedoTable,
    /// What coat and base reflect with one bounce each, if the base reflects all that it receives.
    single: AlbedoTable,
}

impl CoatedConductorTables {
    /// - `coat_alpha`: roughness of the coat; 0 is smooth
    /// - `eta`: index of the coat over that of its surroundings, at least 1
    /// - `base_alpha`: roughness of the metal
    pub fn new(kind: MicrofacetKind, coat_alpha: f32, eta: f32, base_alpha: f32) -> Self {
        let eta = eta.max(1.0);
        let coat = (coat_alpha > 0.0).then(|| Microfacet::isotropic(kind, coat_alpha));
        let base = Microfacet::isotropic(kind, base_alpha);
        let reflected = match &coat {
            Some(coat) => AlbedoTable::of_reflection(coat, |cos| dielectric(cos, eta).reflectance),
            None => AlbedoTable::new(|cos| dielectric(cos, eta).reflectance),
        };
        let single = AlbedoTable::new(|cos| {
            let inside = dielectric(cos, eta).cos_t;
            // Where light that leaves grazes a rough coat, some passes; beyond that, reflection is total.
            let through = mean_where_it_jumps(&base, inside, |wo, m| {
                let wi = reflect_about(wo, m);
                match leave(wi, eta) {
                    Some(out) if wi.z > 0.0 => base.g1(wi) * reflected.left(out.z),
                    _ => 0.0,
                }
            });
            reflected.at(cos) + reflected.left(cos) * through
        });
        Self { coat, eta, base, reflected, single }
    }
}

/// A direction outside, bent as it enters a coat, pointing away from the base.
#[inline(always)]
fn enter(w: Vec3, eta: f32) -> Vec3 {
    let z = (1.0 - (1.0 - w.z * w.z).max(0.0) / (eta * eta)).max(0.0).sqrt();
    Vec3::new(w.x / eta, w.y / eta, z).normalize_or(Vec3::Z)
}

/// The inverse of [`enter`]; `None` where reflection is total.
#[inline(always)]
fn leave(w: Vec3, eta: f32) -> Option<Vec3> {
    let z2 = 1.0 - (1.0 - w.z * w.z).max(0.0) * (eta * eta);
    (z2 > 0.0).then(|| Vec3::new(w.x * eta, w.y * eta, z2.sqrt()).normalize())
}

/// A dielectric coat, smooth or rough, over a rough metal, seen from the side of +Z.
///
/// Three lobes. The coat reflects. What it lets in, T(μₒ), is bent as by a smooth interface, reflected once by the metal,
/// and bent back: f = T(μₒ) T(μᵢ) f_metal(wo′, wi′) / η² (Weidlich & Wilkie 2007, "Arbitrarily Layered Micro-Facet
/// Surfaces"). All further bounces between coat and metal are one wide lobe that holds exactly what is missing
/// ([`AlbedoTable`]). So it is reciprocal, a metal that reflects everything stays white, and the density is exact.
#[derive(Clone, Copy, Debug)]
pub struct CoatedConductor<'a> {
    tables: &'a CoatedConductorTables,
    metal: RoughConductor,
    reflectance: Rgb,
    color: Rgb,
}

impl<'a> CoatedConductor<'a> {
    /// - `eta_k`: complex index of the metal over that of the coat's surroundings; `None` reflects everything
    /// - `reflectance`: scales what the metal reflects; physically 1
    pub fn new(tables: &'a CoatedConductorTables, eta_k: Option<(Rgb, Rgb)>, reflectance: Rgb) -> Self {
        let below = eta_k.map(|(eta, k)| (eta / tables.eta, k / tables.eta));
        let metal = Metal::new(below, reflectance);
        let mean = mean_of_diffuse(|mu| metal.reflectance(mu)).min(Rgb::ONE);
        Self {
            tables,
            metal: RoughConductor::new(tables.base, below, reflectance),
            reflectance: mean,
            color: tables.single.color_of_bounces(mean),
        }
    }

    /// Probabilities of coat, metal and wide lobe.
    #[inline(always)]
    fn choice(&self, cos: f32) -> [f32; 3] {
        let t = self.tables;
        let coat = t.reflected.at(cos);
        let metal = (t.single.at(cos) - coat).max(0.0) * self.reflectance.max_element();
        let wide = t.single.left(cos).max(0.0) * self.color.max_element();
        let sum = coat + metal + wide;
        if sum > 0.0 { [coat, metal, wide].map(|p| p / sum) } else { [0.0; 3] }
    }

    /// f and the density of all that is not a delta.
    #[inline(always)]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return (Rgb::ZERO, 0.0);
        }
        let CoatedConductorTables { coat, eta, reflected, single, .. } = self.tables;
        let [p_coat, p_metal, p_wide] = self.choice(wo.z);
        let (wo_in, wi_in) = (enter(wo, *eta), enter(wi, *eta));
        let passes = reflected.left(wo.z) * reflected.left(wi.z) / (eta * eta);
        let mut f = self.metal.eval(wo_in, wi_in) * passes + self.color * single.lobe(wo, single, wi);
        // cos θ′ dω′ = cos θ dω / η².
        let bent = wi.z / (eta * eta * wi_in.z);
        let mut pdf = p_metal * self.metal.pdf(wo_in, wi_in) * bent + p_wide * CosineHemisphere.pdf(wi);
        if let Some(coat) = coat {
            let mirror = Facet::between(wo, wi);
            f += dielectric(mirror.half_cos(), *eta).reflectance * coat.reflection(wo, wi, &mirror);
            pdf += p_coat * coat.reflection_pdf(wo, &mirror);
        }
        (f, pdf)
    }
}

impl Bsdf for CoatedConductor<'_> {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let CoatedConductorTables { coat, eta, reflected, .. } = self.tables;
        let [p_coat, p_metal, _] = self.choice(wo.z);
        let wi = if u_lobe < p_coat {
            let Some(coat) = coat else {
                let weight = Rgb::splat(reflected.at(wo.z) / p_coat);
                return Some(BsdfSample { wi: reflect(wo), weight, pdf: p_coat, delta: true, eta: 1.0 });
            };
            reflect_about(wo, coat.sample_visible(wo, u))
        } else if u_lobe < p_coat + p_metal {
            leave(self.metal.sample(enter(wo, *eta), 0.0, u)?.wi, *eta)?
        } else {
            CosineHemisphere.sample(u)?.value
        };
        let (f, pdf) = self.eval_pdf(wo, wi);
        (wi.z > 0.0 && pdf > f32::MIN_POSITIVE && pdf.is_finite()).then(|| BsdfSample {
            wi,
            weight: f * (wi.z / pdf),
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
        Lobes { reflection: true, transmission: false, delta: self.tables.coat.is_none() }
    }

    fn albedo(&self) -> Rgb {
        let CoatedConductorTables { reflected, single, .. } = self.tables;
        let coat = reflected.at(1.0);
        Rgb::splat(coat) + (single.at(1.0) - coat) * self.reflectance + single.left(1.0) * self.color
    }
}
