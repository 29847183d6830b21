//! The Beckmann distribution at roughness 1: Gaussian slopes (Walter et al. 2007).

use std::f32::consts::FRAC_2_SQRT_PI;

use glam::{Vec2, Vec3};

use crate::elementary::{exp, horner, ln};
use crate::erf::{erf_exp, erf_inv, erfcx_positive};
use crate::{MicrofacetKind, MicrofacetShape};

const FRAC_1_SQRT_PI: f32 = 0.5 * FRAC_2_SQRT_PI;

/// [`MicrofacetKind::Beckmann`], known to compilers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beckmann;

impl MicrofacetShape for Beckmann {
    #[inline]
    fn kind(self) -> MicrofacetKind {
        MicrofacetKind::Beckmann
    }

    #[inline(always)]
    fn d(self, slope_squared: f32, cos_squared: f32, length_squared: f32) -> f32 {
        let per_cos_squared = 1.0 / cos_squared;
        let exponent = slope_squared * per_cos_squared;
        let ratio = length_squared * per_cos_squared;
        // Beyond, the exponential has lost to any cos⁻⁴ that `f32` and the largest roughness allow; where m has no length
        // it is not a number.
        if exponent < 80.0 { exp(-exponent) * (ratio * ratio) } else { 0.0 }
    }

    /// Λ = exp(−a²) / (2 a √π) − erfc(a) / 2 with a = |cos θ| / spread, multiplied out so that a = 0 is harmless.
    #[inline(always)]
    fn projected_area(self, cos: f32, spread_squared: f32) -> f32 {
        let spread = spread_squared.sqrt();
        // Λ < 10⁻⁹. Also where `spread` is 0.
        if cos >= 4.0 * spread {
            return cos;
        }
        let a = cos / spread;
        cos + 0.5 * exp(-a * a) * (spread * FRAC_1_SQRT_PI - cos * erfcx_positive(a))
    }

    /// Heitz & d'Eon 2014: with x the slope along `w`'s azimuth, x and y are independent; y is Gaussian, and
    /// x has the density (cos θ − x sin θ) exp(−x²), x < cot θ. Its integral is inverted in the variable
    /// erf(x) by Newton's method (Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann
    /// Distribution").
    #[inline(always)]
    fn sample_visible(self, w: Vec3, u: Vec2) -> Vec3 {
        let (cos, sin) = (w.z, Vec2::new(w.x, w.y).length());
        let along = visible_slope(cos, sin, u.x);
        let across = erf_inv((2.0 * u.y - 1.0).clamp(-MAX_ERF, MAX_ERF));
        let azimuth = if sin > 0.0 { Vec2::new(w.x, w.y) / sin } else { Vec2::X };
        (-(along * azimuth + across * azimuth.perp())).extend(1.0)
    }
}

/// The largest `f32` below 1: slopes beyond ± 3.8 have a probability below 10⁻⁷.
const MAX_ERF: f32 = 1.0 - f32::EPSILON / 2.0;

/// The slope x along the azimuth of a direction with this elevation, from a uniform number.
///
/// The distribution function is concave in e = erf(x), and Jakob's fit of its inverse is near, off by up to 0.05. Steps
/// of Newton's method bring that to 2 · 10⁻³, 3 · 10⁻⁶, and the limits of `f32`. Nothing here branches.
#[inline(always)]
fn visible_slope(cos: f32, sin: f32, u: f32) -> f32 {
    let (max_e, max_exp) = erf_exp(cos / sin);
    let of_slopes = VisibleSlopes { cos, sin, max_e: max_e.min(MAX_ERF) };
    let target = u * (cos * (1.0 + max_e) + sin * FRAC_1_SQRT_PI * max_exp);
    let theta = rough_acos(cos);
    let power = 1.0 + theta * (-0.876 + theta * (0.426_5 - 0.059_4 * theta));
    let fit = max_e - (1.0 + max_e) * exp(power * ln(1.0 - u));
    let e = of_slopes.newton(fit.max(-MAX_ERF).min(of_slopes.max_e), target);
    let e = of_slopes.newton(of_slopes.newton(e, target), target);
    erf_inv(e)
}

/// The slopes along the azimuth of a direction, in the variable e = erf(x).
struct VisibleSlopes {
    cos: f32,
    sin: f32,
    max_e: f32,
}

impl VisibleSlopes {
    /// A step from `e` towards where ∫ over slopes below x, times 2 / √π, cos (1 + e) + sin exp(−x²) / √π, is `target`.
    #[inline(always)]
    fn newton(&self, e: f32, target: f32) -> f32 {
        let x = erf_inv(e);
        let excess = self.cos * (1.0 + e) + self.sin * FRAC_1_SQRT_PI * exp(-x * x) - target;
        let step = excess / (self.cos - x * self.sin).max(MIN_DENSITY);
        (e - step).max(-MAX_ERF).min(self.max_e)
    }
}

/// The density of e goes to 0 at the steepest slope that is seen; uniforms of 24 bits do not come nearer to it than this.
const MIN_DENSITY: f32 = 1e-4;

/// θ from cos θ in [0, 1], to 7 · 10⁻⁵ (Abramowitz & Stegun 1964, 4.4.45).
#[inline(always)]
fn rough_acos(cos: f32) -> f32 {
    (1.0 - cos).max(0.0).sqrt() * horner(cos, [-0.018_729_3, 0.074_261, -0.212_114_4, 1.570_728_8])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The distribution function of the visible slope, by the midpoint rule in double precision.
    fn slopes_below(x: f64, cos: f64, sin: f64) -> f64 {
        let integral = |to: f64| {
            let (from, n) = (-6.0, 20_000);
            let step = (to.min(6.0) - from) / f64::from(n);
            let at = |i| from + (f64::from(i) + 0.5) * step;
            (0..n).map(|i| (cos - at(i) * sin) * (-at(i) * at(i)).exp()).sum::<f64>() * step
        };
        integral(x) / integral(cos / sin)
    }

    #[test]
    fn visible_slopes_invert_their_distribution_function() {
        for cos in [0.999_f32, 0.9, 0.5, 0.1, 0.01, 1e-4] {
            let sin = (1.0 - cos * cos).sqrt();
            for u in [1e-4, 0.01, 0.2, 0.5, 0.8, 0.99, 0.9999] {
                let x = visible_slope(cos, sin, u);
                let back = slopes_below(f64::from(x), f64::from(cos), f64::from(sin));
                assert!((back - f64::from(u)).abs() < 2e-6, "cos = {cos}, u = {u}: x = {x}, {back}");
            }
        }
    }

    #[test]
    fn visible_slopes_increase_with_the_uniform() {
        for cos in [1.0_f32, 0.7, 0.2, 1e-3, 1e-10] {
            let sin = (1.0 - cos * cos).sqrt();
            let slopes: Vec<f32> = (0..1000).map(|i| visible_slope(cos, sin, i as f32 / 1000.0)).collect();
            assert!(slopes.iter().all(|x| x.is_finite()));
            assert!(slopes.windows(2).all(|pair| pair[0] <= pair[1] + 1e-4), "cos = {cos}");
        }
    }

    /// Heitz 2014, table 1: Λ(a) at a = 1 is (erf(1) − 1) / 2 + exp(−1) / (2 √π).
    #[test]
    fn projected_area_at_the_slope_of_the_surface() {
        let lambda = 0.5 * (0.842_700_8 - 1.0) + 0.367_879_44 * 0.5 * FRAC_1_SQRT_PI;
        assert!((Beckmann.projected_area(0.5, 0.25) - 0.5 * (1.0 + lambda)).abs() < 1e-6);
        assert_eq!(Beckmann.projected_area(1.0, 0.0), 1.0);
        assert!((Beckmann.projected_area(0.0, 0.09) - 0.15 * FRAC_1_SQRT_PI).abs() < 1e-7);
    }
}
