//! A smooth interface between two dielectrics: glass, water.

use glam::{Vec2, Vec3};

use crate::interface::{dielectric, reflect};
use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// Reflects and refracts, each in one direction only.
///
/// Radiance that crosses the interface is scaled by 1/η², as its solid angle shrinks or grows; that
/// makes the model unsymmetric (Veach 1997, §5.2). Light travelling the other way is not scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    eta: f32,
    reflectance: Rgb,
    transmittance: Rgb,
}

impl Dielectric {
    /// - `eta`: index inside (−Z) over that outside (+Z), positive
    /// - `reflectance`, `transmittance`: scale what Fresnel's equations give; physically 1
    #[inline(always)]
    pub fn new(eta: f32, reflectance: Rgb, transmittance: Rgb) -> Self {
        Self { eta, reflectance, transmittance }
    }
}

impl Bsdf for Dielectric {
    #[inline(always)]
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Rgb {
        Rgb::ZERO
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, _u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let split = dielectric(wo.z, self.eta);
        if u_lobe < split.reflectance {
            let pdf = split.reflectance;
            return Some(BsdfSample {
                wi: reflect(wo),
                weight: self.reflectance,
                pdf,
                delta: true,
                eta: 1.0,
            });
        }
        let wi = Vec3::new(-wo.x / split.eta, -wo.y / split.eta, -split.cos_t.copysign(wo.z));
        let weight = self.transmittance / (split.eta * split.eta);
        Some(BsdfSample { wi, weight, pdf: split.transmittance, delta: true, eta: split.eta })
    }

    #[inline(always)]
    fn pdf(&self, _wo: Vec3, _wi: Vec3) -> f32 {
        0.0
    }

    #[inline(always)]
    fn lobes(&self) -> Lobes {
        Lobes { reflection: false, transmission: false, delta: true }
    }

    #[inline(always)]
    fn albedo(&self) -> Rgb {
        self.transmittance.lerp(self.reflectance, dielectric(1.0, self.eta).reflectance)
    }
}
