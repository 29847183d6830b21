//! Diffuse reflection and transmission: paper, leaves, lampshades.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::CosineHemisphere;

use crate::rough_dielectric::flip;
use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// Scatters equally in all directions on either side, from either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    reflectance: Rgb,
    transmittance: Rgb,
    /// Probability of reflection, if there is anything.
    p_reflect: f32,
}

impl DiffuseTransmission {
    /// From the fractions of light that it reflects and that it transmits: together, at most 1 per channel, or both
    /// are scaled down.
    pub fn new(reflectance: Rgb, transmittance: Rgb) -> Self {
        let (r, t) = (reflectance.max(Rgb::ZERO), transmittance.max(Rgb::ZERO));
        let scale = 1.0 / (r + t).max_element().max(1.0);
        let (sum_r, sum_t) = (r.element_sum(), t.element_sum());
        let p_reflect = if sum_r > 0.0 { sum_r / (sum_r + sum_t) } else { 0.0 };
        Self { reflectance: r * scale, transmittance: t * scale, p_reflect }
    }
}

impl Bsdf for DiffuseTransmission {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let sides = wo.z * wi.z;
        if sides > 0.0 {
            self.reflectance * FRAC_1_PI
        } else if sides < 0.0 {
            self.transmittance * FRAC_1_PI
        } else {
            Rgb::ZERO
        }
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let s = CosineHemisphere.sample(u)?;
        let is_reflected = u_lobe < self.p_reflect;
        let (color, p) = match is_reflected {
            true => (self.reflectance, self.p_reflect),
            false => (self.transmittance, 1.0 - self.p_reflect),
        };
        let wi = if is_reflected == (wo.z > 0.0) { s.value } else { flip(s.value) };
        (color != Rgb::ZERO && wo.z != 0.0).then_some(BsdfSample {
            wi,
            weight: color / p,
            pdf: p * s.pdf,
            delta: false,
            eta: 1.0,
        })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let sides = wo.z * wi.z;
        if sides == 0.0 || self.reflectance + self.transmittance == Rgb::ZERO {
            return 0.0;
        }
        let p = if sides > 0.0 { self.p_reflect } else { 1.0 - self.p_reflect };
        p * wi.z.abs() * FRAC_1_PI
    }

    fn lobes(&self) -> Lobes {
        Lobes {
            reflection: self.reflectance != Rgb::ZERO,
            transmission: self.transmittance != Rgb::ZERO,
            delta: false,
        }
    }

    fn albedo(&self) -> Rgb {
        self.reflectance + self.transmittance
    }
}
