//! A rough dielectric coating over a diffuse base.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::interface::{dielectric, reflect_about};
use crate::plastic::{LobeChoice, LobeProbabilities, base_below};
use crate::rough_coat::RoughPlasticTables;
use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// A rough coating that reflects, over a base that scatters in all directions.
///
/// As [`crate::Plastic`], but with what a rough interface lets through (one bounce) from a table. On the
/// side of +Z only.
#[derive(Clone, Copy, Debug)]
pub struct RoughPlastic<'a> {
    coat: &'a RoughPlasticTables,
    specular: Rgb,
    base: Rgb,
    choice: LobeChoice,
}

impl<'a> RoughPlastic<'a> {
    /// - `coat`: made once per material
    /// - `diffuse`: albedo of the base, per channel in [0, 1]
    /// - `specular`: scales the coating's reflection; physically 1
    /// - `nonlinear`: does the base's colour saturate by interreflection below the coating?
    #[inline]
    pub fn new(coat: &'a RoughPlasticTables, diffuse: Rgb, specular: Rgb, nonlinear: bool) -> Self {
        Self {
            coat,
            specular,
            base: base_below(diffuse, coat.internal_reflectance(), coat.eta(), nonlinear),
            choice: LobeChoice::new(diffuse, specular),
        }
    }

    /// f and the density for two directions above the surface whose halfway vector is `m`.
    #[inline]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3, m: Vec3, p: LobeProbabilities, t_o: f32) -> (Rgb, f32) {
        let distribution = self.coat.distribution();
        let mirrored = distribution.reflection_pdf(wo, m);
        let f = dielectric(wo.dot(m), self.coat.eta()).reflectance;
        let specular = self.specular * (f * mirrored / distribution.projected_area(wi));
        let diffuse = self.base * (t_o * self.coat.transmittance(wi.z) * FRAC_1_PI);
        (specular + diffuse, p.specular * mirrored + p.diffuse * CosineHemisphere.pdf(wi))
    }

    #[inline]
    fn lobe_probabilities(&self, t_o: f32) -> LobeProbabilities {
        self.choice.given_transmittance(t_o)
    }
}

impl Bsdf for RoughPlastic<'_> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        let m = (wo + wi).normalize_or_zero();
        let t_o = self.coat.transmittance(wo.z);
        self.eval_pdf(wo, wi, m, self.lobe_probabilities(t_o), t_o).0
    }

    #[inline]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let t_o = self.coat.transmittance(wo.z);
        let p = self.lobe_probabilities(t_o);
        let (wi, m) = if u_lobe < p.specular {
            let m = self.coat.distribution().sample_visible(wo, u);
            (reflect_about(wo, m), m)
        } else if p.diffuse > 0.0 {
            let wi = CosineHemisphere.sample(u)?.value;
            (wi, (wo + wi).normalize_or_zero())
        } else {
            return None;
        };
        if wi.z <= 0.0 {
            return None;
        }
        let (f, pdf) = self.eval_pdf(wo, wi, m, p, t_o);
        (pdf > f32::MIN_POSITIVE).then(|| BsdfSample {
            wi,
            weight: f * (wi.z / pdf),
            pdf,
            delta: false,
            eta: 1.0,
        })
    }

    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let p = self.lobe_probabilities(self.coat.transmittance(wo.z));
        let m = (wo + wi).normalize_or_zero();
        p.specular * self.coat.distribution().reflection_pdf(wo, m) + p.diffuse * CosineHemisphere.pdf(wi)
    }

    #[inline]
    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false, delta: false }
    }

    #[inline]
    fn albedo(&self) -> Rgb {
        let t = self.coat.transmittance(1.0);
        (1.0 - t) * self.specular + t * t * self.base
    }
}
