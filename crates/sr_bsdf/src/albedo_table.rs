//! How much light one bounce returns, tabulated over the angle; and the lobe that makes up for the rest.
//!
//! In: a function of cos θ, asked at load. Out: its value at any cos θ, and its mean. What a single bounce loses is given
//! back in proportion to (1 − E(μₒ)) (1 − E(μᵢ)): exactly as much as is missing, and the same in either direction (Kelemen
//! & Szirmay-Kalos 2001; Kulla & Conty 2017, "Revisiting Physically Based Shading at Imageworks").

use std::array;
use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::rough_coat::mean_over_visible_normals;
use crate::{Microfacet, Rgb};

/// Entries, at cosines that are squares: directional albedos change fastest at grazing angles.
const NODES: usize = 64;

/// A fraction of light as a function of cos θ in [0, 1], linear in √cos θ between 64 entries.
#[derive(Clone, Debug, PartialEq)]
pub struct AlbedoTable {
    values: [f32; NODES],
    mean: f32,
}

impl AlbedoTable {
    /// The cosines that tables ask for, in this order.
    pub(crate) fn cosines() -> [f32; NODES] {
        let x = |i: usize| i as f32 / (NODES - 1) as f32;
        array::from_fn(|i| (x(i) * x(i)).max(1e-6))
    }

    /// From the fraction at a cosine, which is brought into [0, 1].
    pub fn new(at_cosine: impl FnMut(f32) -> f32) -> Self {
        let x = |i: usize| i as f32 / (NODES - 1) as f32;
        let values: [f32; NODES] = Self::cosines().map(at_cosine).map(|value| value.clamp(0.0, 1.0));
        // 2 ∫ E μ dμ = 4 ∫ E x³ dx with μ = x²; E = a + b x in each segment.
        let segment = |i: usize| {
            let (x0, x1) = (f64::from(x(i)), f64::from(x(i + 1)));
            let b = f64::from(values[i + 1] - values[i]) / (x1 - x0);
            let a = f64::from(values[i]) - b * x0;
            a * (x1.powi(4) - x0.powi(4)) + 0.8 * b * (x1.powi(5) - x0.powi(5))
        };
        let mean = (0..NODES - 1).map(segment).sum::<f64>() as f32;
        Self { values, mean }
    }

    /// Of what a rough surface reflects in one bounce, if `reflects(m · wo)` of what meets a facet is reflected; at 48 × 48
    /// visible normals for each entry.
    pub(crate) fn of_reflection(d: &Microfacet, reflects: impl Fn(f32) -> f32) -> Self {
        Self::new(|cos| {
            mean_over_visible_normals(d, cos, |wo, m| {
                let wi = crate::interface::reflect_about(wo, m);
                if wi.z > 0.0 { reflects(wo.dot(m)) * d.g2_over_g1(wo, wi) } else { 0.0 }
            })
        })
    }

    /// At a cosine.
    #[inline(always)]
    pub fn at(&self, cos: f32) -> f32 {
        let x = cos.clamp(0.0, 1.0).sqrt() * (NODES - 1) as f32;
        let i = (x as usize).min(NODES - 2);
        self.values[i] + (x - i as f32) * (self.values[i + 1] - self.values[i])
    }

    /// Of diffuse light: 2 ∫ E μ dμ.
    #[inline(always)]
    pub fn mean(&self) -> f32 {
        self.mean
    }

    /// What is missing at a cosine.
    #[inline(always)]
    pub(crate) fn left(&self, cos: f32) -> f32 {
        1.0 - self.at(cos)
    }

    /// What is missing of diffuse light.
    #[inline(always)]
    pub(crate) fn mean_left(&self) -> f32 {
        1.0 - self.mean
    }

    /// The lobe that gives back what is missing, for a lossless surface; the sides of `wo` and `wi` may have other tables.
    #[inline(always)]
    pub(crate) fn lobe(&self, wo: Vec3, of_wi: &Self, wi: Vec3) -> f32 {
        let mean_left = of_wi.mean_left();
        // Where nothing is missing there is nothing to give back.
        if mean_left < 1e-6 {
            return 0.0;
        }
        self.left(wo.z.abs()) * of_wi.left(wi.z.abs()) / mean_left * FRAC_1_PI
    }

    /// The colour of light that bounces more than once, off a surface whose facets reflect `f` of diffuse light (Kulla &
    /// Conty 2017; all colours there are powers of it).
    pub(crate) fn color_of_bounces(&self, f: Rgb) -> Rgb {
        f * f * self.mean / (Rgb::ONE - f * self.mean_left()).max(Rgb::splat(f32::MIN_POSITIVE))
    }
}

/// 2 ∫ f(μ) μ dμ, to about 10⁻³: colours only.
pub(crate) fn mean_of_diffuse(f: impl Fn(f32) -> Rgb) -> Rgb {
    const POINTS: usize = 8;
    (0..POINTS).map(|i| f(((i as f32 + 0.5) / POINTS as f32).sqrt())).sum::<Rgb>() / POINTS as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_means() {
        let table = AlbedoTable::new(|mu| 0.5 * mu.sqrt());
        assert!((table.at(0.3) - 0.5 * 0.3_f32.sqrt()).abs() < 1e-6);
        assert!((table.mean() - 0.4).abs() < 1e-6); // ∫ 2 · 0.5 μ^1.5 dμ
        assert_eq!(AlbedoTable::new(|_| 1.0).lobe(Vec3::Z, &AlbedoTable::new(|_| 1.0), Vec3::Z), 0.0);
    }
}
