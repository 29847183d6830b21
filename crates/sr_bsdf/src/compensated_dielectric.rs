//! A rough interface between dielectrics with the light that bounces between its facets.

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::albedo_table::AlbedoTable;
use crate::interface::{dielectric, diffuse_reflectance, reflect_about, refract_about};
use crate::rough_coat::mean_over_visible_normals;
use crate::rough_dielectric::flip;
use crate::{Bsdf, BsdfSample, Lobes, Microfacet, MicrofacetKind, Rgb, RoughDielectric};

/// What one bounce off a rough interface leaves, from either side; made once for each shape, roughness and index.
#[derive(Clone, Debug, PartialEq)]
pub struct DielectricTables {
    distribution: Microfacet,
    eta: f32,
    /// Fractions reflected or transmitted, seen from outside and from inside.
    sides: [AlbedoTable; 2],
    /// Of what is missing, the fraction that crosses the interface, from outside and from inside.
    crossing: [f32; 2],
}

impl DielectricTables {
    /// - `eta`: index inside over that outside, positive
    pub fn new(kind: MicrofacetKind, alpha: f32, eta: f32) -> Self {
        let distribution = Microfacet::isotropic(kind, alpha);
        let eta = RoughDielectric::<MicrofacetKind>::apart(eta);
        let side = |eta: f32| {
            AlbedoTable::new(|cos| {
                mean_over_visible_normals(&distribution, cos, |wo, m| {
                    let split = dielectric(wo.dot(m), eta);
                    let (mirrored, refracted) = (reflect_about(wo, m), refract_about(wo, m, split));
                    let seen = |wi: Vec3, is_there: bool| {
                        if is_there { distribution.g2_over_g1(wo, wi) } else { 0.0 }
                    };
                    split.reflectance * seen(mirrored, mirrored.z > 0.0)
                        + split.transmittance * seen(refracted, refracted.z < 0.0)
                })
            })
        };
        let sides = [side(eta), side(1.0 / eta)];
        // Light may travel either way: what crosses from outside, times what is missing there, is η² times that from
        // inside. Within that, as of diffuse light at a smooth interface.
        let left = [sides[0].mean_left(), eta * eta * sides[1].mean_left()];
        let crosses = (1.0 - diffuse_reflectance(eta)) * left[0].min(left[1]);
        let crossing = left.map(|left| if left > 0.0 { crosses / left } else { 0.0 });
        Self { distribution, eta, sides, crossing }
    }

    /// The distribution of the interface's normals.
    pub fn distribution(&self) -> &Microfacet {
        &self.distribution
    }

    /// The index inside over that outside.
    pub fn eta(&self) -> f32 {
        self.eta
    }
}

/// [`RoughDielectric`], and wide lobes on either side that hold what its one bounce loses (Kulla & Conty 2017). Nothing
/// is lost if reflectance and transmittance are 1.
#[derive(Clone, Copy, Debug)]
pub struct CompensatedDielectric<'a> {
    single: RoughDielectric,
    tables: &'a DielectricTables,
    reflectance: Rgb,
    transmittance: Rgb,
}

/// What is known of a direction: the tables of its side and of the other, and the index there over that here.
struct Side<'a> {
    near: &'a AlbedoTable,
    far: &'a AlbedoTable,
    crossing: f32,
    eta: f32,
}

impl<'a> CompensatedDielectric<'a> {
    /// - `reflectance`, `transmittance`: scale what Fresnel's equations give; physically 1
    pub fn new(tables: &'a DielectricTables, reflectance: Rgb, transmittance: Rgb) -> Self {
        let single = RoughDielectric::new(tables.distribution, tables.eta, reflectance, transmittance);
        Self { single, tables, reflectance, transmittance }
    }

    #[inline(always)]
    fn side(&self, wo: Vec3) -> Side<'a> {
        let DielectricTables { sides: [outside, inside], crossing, eta, .. } = self.tables;
        if wo.z > 0.0 {
            Side { near: outside, far: inside, crossing: crossing[0], eta: *eta }
        } else {
            Side { near: inside, far: outside, crossing: crossing[1], eta: 1.0 / eta }
        }
    }

    /// The wide lobes: f and the density, given that they are sampled.
    #[inline(always)]
    fn wide(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let side = self.side(wo);
        let cosine = CosineHemisphere.pdf(wi.with_z(wi.z.abs()));
        if wo.z * wi.z > 0.0 {
            let f = (1.0 - side.crossing) * side.near.lobe(wo, side.near, wi);
            (self.reflectance * f, (1.0 - side.crossing) * cosine)
        } else {
            let f = side.crossing * side.near.lobe(wo, side.far, wi) / (side.eta * side.eta);
            (self.transmittance * f, side.crossing * cosine)
        }
    }

    /// Probability of the wide lobes.
    #[inline(always)]
    fn p_wide(&self, wo: Vec3) -> f32 {
        self.side(wo).near.left(wo.z.abs())
    }
}

impl Bsdf for CompensatedDielectric<'_> {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Rgb::ZERO;
        }
        self.single.eval(wo, wi) + self.wide(wo, wi).0
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let p_wide = self.p_wide(wo);
        let s = if u_lobe < p_wide {
            let side = self.side(wo);
            let crosses = u_lobe < p_wide * side.crossing;
            let above = CosineHemisphere.sample(u)?.value;
            let wi = if crosses == (wo.z > 0.0) { flip(above) } else { above };
            let pdf = self.single.pdf(wo, wi);
            let f_cos = self.single.eval(wo, wi) * above.z;
            let weight = if pdf > 0.0 { f_cos / pdf } else { Rgb::ZERO };
            BsdfSample { wi, weight, pdf, delta: false, eta: if crosses { side.eta } else { 1.0 } }
        } else {
            let rest = ((u_lobe - p_wide) / (1.0 - p_wide)).clamp(0.0, 1.0 - f32::EPSILON / 2.0);
            self.single.sample(wo, rest, u)?
        };
        let (wide, wide_pdf) = self.wide(wo, s.wi);
        let pdf = (1.0 - p_wide) * s.pdf + p_wide * wide_pdf;
        let f_cos = s.weight * s.pdf + wide * s.wi.z.abs();
        (pdf > 0.0 && pdf.is_finite()).then(|| BsdfSample { weight: f_cos / pdf, pdf, ..s })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z == 0.0 || wi.z == 0.0 {
            return 0.0;
        }
        let p_wide = self.p_wide(wo);
        (1.0 - p_wide) * self.single.pdf(wo, wi) + p_wide * self.wide(wo, wi).1
    }

    fn lobes(&self) -> Lobes {
        self.single.lobes()
    }

    fn albedo(&self) -> Rgb {
        self.single.albedo()
    }
}
