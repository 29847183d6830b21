//! A metal under a dielectric coating: lacquered brass, wet foil.

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::albedo_table::{AlbedoTable, mean_of_diffuse};
use crate::conductor::Metal;
use crate::interface::{dielectric, reflect, reflect_about};
use crate::layer_walk::{BOUNCES, leaves_after};
use crate::microfacet::Facet;
use crate::rough_coat::{lattice_of_normals, mean_where_it_jumps, seen_from};
use crate::{Bsdf, BsdfSample, Lobes, Microfacet, MicrofacetKind, Rgb, RoughConductor};

/// What is the same at every point of a coated metal; made once per material.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedConductorTables {
    /// `None`: smooth.
    coat: Option<Microfacet>,
    eta: f32,
    /// The metal's facets, as they are seen through the coat.
    base: Microfacet,
    /// What the coat reflects.
    reflected: AlbedoTable,
    /// What the coat lets through, in either direction.
    passes: AlbedoTable,
    /// What coat and base reflect with one bounce each, if the base reflects all that it receives.
    single: AlbedoTable,
    /// All but what bounces off the base more than once, if it reflects all that it receives.
    wide: AlbedoTable,
    colors: Colors,
}

/// The colors of light that bounces off the metal more than once.
#[derive(Clone, Debug, PartialEq)]
enum Colors {
    /// Of a coat that loses nothing: [`AlbedoTable::color_of_bounces`].
    Lossless,
    /// Shares of two, three, … bounces.
    Shares([f32; BOUNCES - 1]),
}

impl CoatedConductorTables {
    /// Of a coat that loses nothing.
    ///
    /// - `coat_alpha`: roughness of the coat; 0 is smooth
    /// - `eta`: index of the coat over that of its surroundings, at least 1
    /// - `base_alpha`: roughness of the metal
    pub fn lossless(kind: MicrofacetKind, coat_alpha: f32, eta: f32, base_alpha: f32) -> Self {
        let eta = eta.max(1.0);
        let coat = (coat_alpha > 0.0).then(|| Microfacet::isotropic(kind, coat_alpha));
        let base = Microfacet::isotropic(kind, alpha_through_coat(base_alpha, coat_alpha, eta));
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
                    Some(out) if wi.z > 0.0 => base.g2_over_g1(wo, wi) * reflected.left(out.z),
                    _ => 0.0,
                }
            });
            reflected.at(cos) + reflected.left(cos) * through
        });
        let passes = AlbedoTable::new(|cos| reflected.left(cos));
        let wide = single.clone();
        Self { coat, eta, base, reflected, passes, single, wide, colors: Colors::Lossless }
    }

    /// Of layers that scatter by one bounce between facets each, and lose what bounces more often: as much as light that
    /// walks between them, and off the metal at most so many times.
    ///
    /// The other parameters are those of [`Self::lossless`].
    pub fn walked(kind: MicrofacetKind, coat_alpha: f32, eta: f32, base_alpha: f32, times: u32) -> Self {
        let eta = eta.max(1.0);
        let coat = (coat_alpha > 0.0).then(|| Microfacet::isotropic(kind, coat_alpha));
        let metal = Microfacet::isotropic(kind, base_alpha);
        let base = Microfacet::isotropic(kind, alpha_through_coat(base_alpha, coat_alpha, eta));
        let reflected = match &coat {
            Some(coat) => AlbedoTable::of_reflection(coat, |cos| dielectric(cos, eta).reflectance),
            None => AlbedoTable::new(|cos| dielectric(cos, eta).reflectance),
        };
        let times = (times as usize).clamp(1, BOUNCES);
        let bounces = |cos: f32| {
            let mut leaves = leaves_after(coat.as_ref(), eta, &metal, cos);
            leaves[times..].fill(0.0);
            leaves
        };
        // Both tables from the same walks.
        let mut more = Vec::new();
        let once = AlbedoTable::new(|cos| {
            let leaves = bounces(cos);
            more.push(leaves[1..].iter().sum::<f32>());
            leaves[0]
        });
        let mut more = more.into_iter();
        let wide = AlbedoTable::new(|_| 1.0 - more.next().unwrap_or(0.0));
        // Of diffuse light, by the midpoint rule in cos².
        let mut shares = [0.0; BOUNCES - 1];
        for i in 0..16 {
            let more = bounces(((i as f32 + 0.5) / 16.0).sqrt());
            shares.iter_mut().zip(&more[1..]).for_each(|(share, fraction)| *share += fraction);
        }
        let sum = shares.iter().sum::<f32>().max(f32::MIN_POSITIVE);
        let colors = Colors::Shares(shares.map(|share| share / sum));
        // Symmetric factors for which the metal's lobe, seen through the coat, holds what the walks found: p(μ) ∫ f p = once(μ).
        let seen = AlbedoTable::cosines().map(|cos| seen_through(&base, eta, cos));
        let seen = |passes: &AlbedoTable, node: usize| -> f32 {
            seen[node].iter().map(|&(fraction, cos)| fraction * passes.at(cos)).sum()
        };
        let mut passes = AlbedoTable::new(|cos| once.at(cos).sqrt());
        for _ in 0..2 {
            let mut node = 0..;
            passes = AlbedoTable::new(|cos| {
                let p = passes.at(cos);
                let now = p * node.next().map_or(0.0, |node| seen(&passes, node));
                p * (once.at(cos) / now.max(f32::MIN_POSITIVE)).sqrt()
            });
        }
        let mut node = 0..;
        let single = AlbedoTable::new(|cos| {
            reflected.at(cos) + passes.at(cos) * node.next().map_or(0.0, |node| seen(&passes, node))
        });
        Self { coat, eta, base, reflected, passes, single, wide, colors }
    }

    fn color_of_bounces(&self, f: Rgb) -> Rgb {
        match &self.colors {
            Colors::Lossless => self.single.color_of_bounces(f),
            // Horner's rule: f² (s₂ + f (s₃ + …)).
            Colors::Shares(shares) => {
                f * f * shares.iter().rev().fold(Rgb::ZERO, |sum, &share| sum * f + Rgb::splat(share))
            }
        }
    }
}

/// Of light from outside that a clear coat bends as a smooth interface does, where a white metal reflects it out again:
/// fractions, and the cosines outside at which they leave.
fn seen_through(base: &Microfacet, eta: f32, cos: f32) -> Vec<(f32, f32)> {
    let wo = seen_from(dielectric(cos, eta).cos_t);
    lattice_of_normals(base, wo, [1597, 2584])
        .filter_map(|(weight, m)| {
            let wi = reflect_about(wo, m);
            let out = leave(wi, eta).filter(|_| wi.z > 0.0)?;
            Some((weight as f32 * base.g2_over_g1(wo, wi), out.z))
        })
        .collect()
}

/// The roughness of a metal seen through a rough coat of index `eta`: slopes add up. Light that passes a facet tilted by θ is
/// turned by (η − 1) θ outside, and by 2 η θ off the metal (after Belcour 2018, "Efficient Rendering of Layered Materials
/// using an Atomic Decomposition with Statistical Operators", section 4).
fn alpha_through_coat(base_alpha: f32, coat_alpha: f32, eta: f32) -> f32 {
    let blur = (eta - 1.0) / (2.0 * eta) * coat_alpha;
    (base_alpha * base_alpha + 2.0 * blur * blur).sqrt()
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
/// Surfaces"); a rough coat makes the metal rougher. All further bounces between coat and metal are one wide lobe. It holds
/// exactly what is missing ([`AlbedoTable`]), so that a metal that reflects everything stays white, or what light that walks
/// between the layers has. So it is reciprocal, and the density is exact.
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
            color: tables.color_of_bounces(mean),
        }
    }

    /// Probabilities of coat, metal and wide lobe.
    #[inline(always)]
    fn choice(&self, cos: f32) -> [f32; 3] {
        let t = self.tables;
        let coat = t.reflected.at(cos);
        let metal = (t.single.at(cos) - coat).max(0.0) * self.reflectance.max_element();
        let wide = t.wide.left(cos).max(0.0) * self.color.max_element();
        let sum = coat + metal + wide;
        if sum > 0.0 { [coat, metal, wide].map(|p| p / sum) } else { [0.0; 3] }
    }

    /// f and the density of all that is not a delta.
    #[inline(always)]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return (Rgb::ZERO, 0.0);
        }
        let CoatedConductorTables { coat, eta, passes, wide, .. } = self.tables;
        let [p_coat, p_metal, p_wide] = self.choice(wo.z);
        let (wo_in, wi_in) = (enter(wo, *eta), enter(wi, *eta));
        let passes = passes.at(wo.z) * passes.at(wi.z) / (eta * eta);
        let mut f = self.metal.eval(wo_in, wi_in) * passes + self.color * wide.lobe(wo, wide, wi);
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
        let CoatedConductorTables { reflected, single, wide, .. } = self.tables;
        let coat = reflected.at(1.0);
        Rgb::splat(coat) + (single.at(1.0) - coat) * self.reflectance + wide.left(1.0) * self.color
    }
}
