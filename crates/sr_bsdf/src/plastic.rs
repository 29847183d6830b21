//! A smooth dielectric coating over a diffuse base.

use std::f32::consts::FRAC_1_PI;

use glam::{BVec3, Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::interface::{dielectric, diffuse_reflectance, reflect};
use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// What is the same at every point of a smooth coating; made once per material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothCoat {
    eta: f32,
    internal_reflectance: f32,
}

impl SmoothCoat {
    /// From the index of the coating over that of its surroundings, positive.
    pub fn new(eta: f32) -> Self {
        Self { eta, internal_reflectance: diffuse_reflectance(1.0 / eta) }
    }
}

/// A smooth coating that reflects in one direction, over a base that scatters in all.
///
/// Light that enters bounces between base and coating until it leaves; the sum of all bounces
/// multiplies the base's albedo a by 1 / (1 − a R) with R the coating's reflectance for diffuse light from
/// inside. Unless `nonlinear`, by 1 / (1 − R), which keeps the base's hue. On the side of +Z only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    eta: f32,
    specular: Rgb,
    /// Radiance that the base sends through the coating for each unit of irradiance, times π.
    base: Rgb,
    choice: LobeChoice,
}

impl Plastic {
    /// - `diffuse`: albedo of the base, per channel in [0, 1]
    /// - `specular`: scales the coating's reflection; physically 1
    /// - `nonlinear`: does the base's colour saturate by interreflection below the coating?
    #[inline(always)]
    pub fn new(coat: SmoothCoat, diffuse: Rgb, specular: Rgb, nonlinear: bool) -> Self {
        Self {
            eta: coat.eta,
            specular,
            base: base_below(diffuse, coat.internal_reflectance, coat.eta, nonlinear),
            choice: LobeChoice::new(diffuse, specular),
        }
    }
}

impl Bsdf for Plastic {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        let (split_o, split_i) = (dielectric(wo.z, self.eta), dielectric(wi.z, self.eta));
        self.base * (split_o.transmittance * split_i.transmittance * FRAC_1_PI)
    }

    /// Does not branch: loops serve many points at a time.
    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let split = dielectric(wo.z, self.eta);
        let p = self.choice.given_transmittance(split.transmittance);
        let delta = u_lobe < p.specular;
        let scattered = CosineHemisphere.sample(u).map_or(Vec3::ZERO, |s| s.value);
        let t_i = dielectric(scattered.z, self.eta).transmittance;
        let mirrored = self.specular * (split.reflectance / p.specular);
        let weight = self.base * (t_i * (split.transmittance / p.diffuse));
        let counts = (wo.z > 0.0) & (delta | ((p.diffuse > 0.0) & (scattered.z > 0.0)));
        counts.then_some(BsdfSample {
            wi: Vec3::select(BVec3::splat(delta), reflect(wo), scattered),
            weight: Rgb::select(BVec3::splat(delta), mirrored, weight),
            pdf: if delta { p.specular } else { p.diffuse * CosineHemisphere.pdf(scattered) },
            delta,
            eta: 1.0,
        })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let p = self.choice.given_transmittance(dielectric(wo.z, self.eta).transmittance);
        p.diffuse * CosineHemisphere.pdf(wi)
    }

    #[inline(always)]
    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false, delta: true }
    }

    #[inline(always)]
    fn albedo(&self) -> Rgb {
        let split = dielectric(1.0, self.eta);
        split.reflectance * self.specular + split.transmittance * split.transmittance * self.base
    }
}

/// Albedo of a base below a coating, for light that has passed the coating once, before it passes it again.
///
/// All bounces between base and coating are summed; the solid angle that widens on leaving takes 1/η².
#[inline(always)]
pub(crate) fn base_below(diffuse: Rgb, internal_reflectance: f32, eta: f32, nonlinear: bool) -> Rgb {
    let returned = if nonlinear { diffuse * internal_reflectance } else { Rgb::splat(internal_reflectance) };
    diffuse / ((Rgb::ONE - returned) * (eta * eta))
}

/// How often the coating is sampled and how often the base: in proportion to Fresnel's split times
/// the mean of the lobe's colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LobeChoice {
    specular: f32,
    diffuse: f32,
}

/// The probability of either lobe. They sum to 1, or are both 0 where nothing is reflected.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LobeProbabilities {
    pub specular: f32,
    pub diffuse: f32,
}

impl LobeChoice {
    #[inline(always)]
    pub fn new(diffuse: Rgb, specular: Rgb) -> Self {
        Self { specular: specular.element_sum(), diffuse: diffuse.element_sum() }
    }

    /// Given the fraction of light that the coating lets through.
    #[inline(always)]
    pub fn given_transmittance(&self, t: f32) -> LobeProbabilities {
        let (specular, diffuse) = ((1.0 - t) * self.specular, t * self.diffuse);
        let sum = specular + diffuse;
        if sum < f32::MIN_POSITIVE {
            return LobeProbabilities { specular: 0.0, diffuse: 0.0 };
        }
        LobeProbabilities { specular: specular / sum, diffuse: diffuse / sum }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lossless coating over a white base returns all light, from any direction: what the coating
    /// reflects, and what bounces below until it leaves.
    #[test]
    fn white_plastic_loses_nothing() {
        for eta in [1.3, 1.5, 2.0] {
            let plastic = Plastic::new(SmoothCoat::new(eta), Rgb::ONE, Rgb::ONE, true);
            for z in [1.0_f32, 0.5, 0.1] {
                let wo = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
                let n = 20_000;
                let base: f32 = (0..n)
                    .map(|i| (i as f32 + 0.5) / n as f32)
                    .map(|mu| plastic.eval(wo, Vec3::new(0.0, (1.0 - mu * mu).sqrt(), mu)).y * mu)
                    .sum::<f32>()
                    * std::f32::consts::TAU
                    / n as f32;
                let total = base + dielectric(z, eta).reflectance;
                assert!((total - 1.0).abs() < 2e-4, "{eta} {z}: {total}");
            }
        }
    }

    #[test]
    fn a_black_plastic_is_never_sampled() {
        let plastic = Plastic::new(SmoothCoat::new(1.5), Rgb::ZERO, Rgb::ZERO, false);
        assert_eq!(plastic.sample(Vec3::Z, 0.0, Vec2::splat(0.5)), None);
        assert_eq!(plastic.pdf(Vec3::Z, Vec3::Z), 0.0);
    }
}
