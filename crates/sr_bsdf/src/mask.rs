//! A surface with holes: partly straight through, partly a model.

use glam::{Vec2, Vec3};

use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// Lets light straight through with probability 1 − opacity, and scatters it by a model otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mask<B> {
    opacity: f32,
    inner: B,
}

impl<B: Bsdf> Mask<B> {
    /// `opacity` is brought into [0, 1]; 1 leaves `inner` as it is.
    #[inline(always)]
    pub fn new(opacity: f32, inner: B) -> Self {
        Self { opacity: opacity.clamp(0.0, 1.0), inner }
    }

    /// The same holes in another model.
    #[inline(always)]
    pub fn map<C: Bsdf>(self, change: impl FnOnce(B) -> C) -> Mask<C> {
        Mask { opacity: self.opacity, inner: change(self.inner) }
    }
}

impl<B: Bsdf> Bsdf for Mask<B> {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.opacity * self.inner.eval(wo, wi)
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        // Asked in any case: loops that serve many points at a time should not branch.
        let inner = self.inner.sample(wo, (u_lobe / self.opacity).min(1.0 - f32::EPSILON / 2.0), u);
        if u_lobe < self.opacity {
            return inner.map(|s| BsdfSample { pdf: s.pdf * self.opacity, ..s });
        }
        Some(BsdfSample { wi: -wo, weight: Rgb::ONE, pdf: 1.0 - self.opacity, delta: true, eta: 1.0 })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.opacity * self.inner.pdf(wo, wi)
    }

    #[inline(always)]
    fn lobes(&self) -> Lobes {
        let inner = self.inner.lobes();
        Lobes { delta: inner.delta || self.opacity < 1.0, ..inner }
    }

    #[inline(always)]
    fn albedo(&self) -> Rgb {
        Rgb::ONE.lerp(self.inner.albedo(), self.opacity)
    }
}
