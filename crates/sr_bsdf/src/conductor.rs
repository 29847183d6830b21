//! A smooth metal.

use glam::{Vec2, Vec3};

use crate::interface::{conductor, reflect};
use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// Reflects in one direction, on the side of +Z only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    metal: Metal,
}

impl Conductor {
    /// - `eta_k`: complex index over the exterior's, per channel; `None` reflects everything
    /// - `reflectance`: scales what Fresnel's equations give; physically 1
    #[inline(always)]
    pub fn new(eta_k: Option<(Rgb, Rgb)>, reflectance: Rgb) -> Self {
        Self { metal: Metal::new(eta_k, reflectance) }
    }
}

impl Bsdf for Conductor {
    #[inline(always)]
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Rgb {
        Rgb::ZERO
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, _u_lobe: f32, _u: Vec2) -> Option<BsdfSample> {
        let weight = self.metal.reflectance(wo.z);
        (wo.z > 0.0).then_some(BsdfSample { wi: reflect(wo), weight, pdf: 1.0, delta: true, eta: 1.0 })
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
        self.metal.reflectance(1.0)
    }
}

/// How much a metal reflects, whatever the shape of its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Metal {
    eta_k: Option<(Rgb, Rgb)>,
    scale: Rgb,
}

impl Metal {
    /// Indices above this overflow Fresnel's equations in `f32`, and reflect all but 10⁻³ anyway.
    const MAX_INDEX: f32 = 4096.0;

    #[inline(always)]
    pub fn new(eta_k: Option<(Rgb, Rgb)>, scale: Rgb) -> Self {
        let bounded = |x: Rgb| x.clamp(Rgb::ZERO, Rgb::splat(Self::MAX_INDEX));
        Self { eta_k: eta_k.map(|(eta, k)| (bounded(eta), bounded(k))), scale }
    }

    /// The fraction reflected at the cosine between a direction and the (microfacet) normal.
    #[inline(always)]
    pub fn reflectance(&self, cos: f32) -> Rgb {
        match self.eta_k {
            Some((eta, k)) => self.scale * conductor(cos, eta, k),
            None => self.scale,
        }
    }
}
