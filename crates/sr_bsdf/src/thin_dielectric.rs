//! A thin plate of a dielectric: a window pane.

use glam::{Vec2, Vec3};

use crate::interface::{dielectric, reflect};
use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// Reflects, and transmits without bending; the plate's two faces are one surface.
///
/// Light bounces between the faces until it leaves. With R the reflectance of one face, the sum over
/// all bounces reflects R + (1 − R)² R + (1 − R)² R³ + … = 2R / (1 + R).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric {
    eta: f32,
    reflectance: Rgb,
    transmittance: Rgb,
}

impl ThinDielectric {
    /// - `eta`: index of the plate over that of its surroundings, positive
    /// - `reflectance`, `transmittance`: scale what Fresnel's equations give; physically 1
    #[inline(always)]
    pub fn new(eta: f32, reflectance: Rgb, transmittance: Rgb) -> Self {
        Self { eta, reflectance, transmittance }
    }

    /// The fraction that the plate reflects.
    #[inline(always)]
    fn plate_reflectance(&self, cos: f32) -> f32 {
        let r = dielectric(cos, self.eta).reflectance;
        2.0 * r / (1.0 + r)
    }
}

impl Bsdf for ThinDielectric {
    #[inline(always)]
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Rgb {
        Rgb::ZERO
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, _u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let r = self.plate_reflectance(wo.z.abs());
        let (wi, weight, pdf) =
            if u_lobe < r { (reflect(wo), self.reflectance, r) } else { (-wo, self.transmittance, 1.0 - r) };
        Some(BsdfSample { wi, weight, pdf, delta: true, eta: 1.0 })
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
        self.transmittance.lerp(self.reflectance, self.plate_reflectance(1.0))
    }
}
