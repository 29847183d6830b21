//! A rough metal with the light that bounces between its facets.

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::albedo_table::{AlbedoTable, mean_of_diffuse};
use crate::conductor::Metal;
use crate::{Bsdf, BsdfSample, Lobes, Microfacet, MicrofacetKind, Rgb, RoughConductor};

/// [`RoughConductor`], and a wide lobe that holds what its one bounce loses (Kulla & Conty 2017). A metal that reflects
/// everything is white from everywhere.
#[derive(Clone, Copy, Debug)]
pub struct CompensatedConductor<'a> {
    single: RoughConductor,
    table: &'a AlbedoTable,
    color: Rgb,
}

impl<'a> CompensatedConductor<'a> {
    /// What [`CompensatedConductor::new`] looks up: once for each shape and roughness.
    pub fn table(kind: MicrofacetKind, alpha: f32) -> AlbedoTable {
        AlbedoTable::of_reflection(&Microfacet::isotropic(kind, alpha), |_| 1.0)
    }

    /// - `table`: of the distribution, or of one like it; what the two do not have in common is lost or gained
    /// - others as for [`RoughConductor::new`]
    pub fn new(
        distribution: Microfacet,
        table: &'a AlbedoTable,
        eta_k: Option<(Rgb, Rgb)>,
        reflectance: Rgb,
    ) -> Self {
        let metal = Metal::new(eta_k, reflectance);
        let color = table.color_of_bounces(mean_of_diffuse(|mu| metal.reflectance(mu)).min(Rgb::ONE));
        Self { single: RoughConductor::new(distribution, eta_k, reflectance), table, color }
    }

    /// Probability of the wide lobe.
    #[inline(always)]
    fn p_wide(&self, wo: Vec3) -> f32 {
        self.table.left(wo.z).clamp(0.0, 1.0)
    }
}

impl Bsdf for CompensatedConductor<'_> {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        self.single.eval(wo, wi) + self.color * self.table.lobe(wo, self.table, wi)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let p_wide = self.p_wide(wo);
        if u_lobe >= p_wide {
            let s = self.single.sample(wo, u_lobe, u)?;
            let pdf = (1.0 - p_wide) * s.pdf + p_wide * CosineHemisphere.pdf(s.wi);
            let f_cos = s.weight * s.pdf + self.color * (self.table.lobe(wo, self.table, s.wi) * s.wi.z);
            return (pdf.is_finite()).then(|| BsdfSample { weight: f_cos / pdf, pdf, ..s });
        }
        let wi = CosineHemisphere.sample(u)?.value;
        let pdf = self.pdf(wo, wi);
        let weight = self.eval(wo, wi) * (wi.z / pdf);
        (pdf > 0.0 && pdf.is_finite()).then_some(BsdfSample { wi, weight, pdf, delta: false, eta: 1.0 })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let p_wide = self.p_wide(wo);
        (1.0 - p_wide) * self.single.pdf(wo, wi) + p_wide * CosineHemisphere.pdf(wi)
    }

    fn lobes(&self) -> Lobes {
        self.single.lobes()
    }

    fn albedo(&self) -> Rgb {
        self.single.albedo() * self.table.at(1.0) + self.color * self.table.left(1.0)
    }
}
