//! The Beckmann distribution at roughness 1: Gaussian slopes (Walter et al. 2007).

use std::f32::consts::FRAC_2_SQRT_PI;

use glam::{Vec2, Vec3};

use crate::erf::{erf_exp, erf_inv, erfcx_positive};

const FRAC_1_SQRT_PI: f32 = 0.5 * FRAC_2_SQRT_PI;

/// π αₓ α_y D, from the squared length of (mₓ/αₓ, m_y/α_y) and m_z.
#[inline]
pub(crate) fn d(slope_squared: f32, cos: f32) -> f32 {
    let cos_squared = cos * cos;
    let exponent = slope_squared / cos_squared;
    // Beyond, the exponential has lost to any cos⁻⁴ that `f32` and the largest roughness allow.
    if exponent < 80.0 { (-exponent).exp() / (cos_squared * cos_squared) } else { 0.0 }
}

/// |cos θ| (1 + Λ), from |cos θ| and the length of (αₓ wₓ, α_y w_y).
///
/// Λ = exp(−a²) / (2 a √π) − erfc(a) / 2 with a = |cos θ| / spread, multiplied out so that a = 0 is harmless.
#[inline]
pub(crate) fn projected_area(cos: f32, spread: f32) -> f32 {
    // Λ < 10⁻⁹. Also where `spread` is 0.
    if cos >= 4.0 * spread {
        return cos;
    }
    let a = cos / spread;
    cos + 0.5 * (-a * a).exp() * (spread * FRAC_1_SQRT_PI - cos * erfcx_positive(a))
}

/// Draws a normal (not of unit length) of those that the unit vector `w` sees, w.z > 0.
///
/// Heitz & d'Eon 2014: with x the slope along `w`'s azimuth, x and y are independent; y is Gaussian, and
/// x has the density (cos θ − x sin θ) exp(−x²), x < cot θ. Its integral is inverted in the variable
/// erf(x) (Jakob 2014) by Newton's method, with bisection wherever that would leave the bracket.
pub(crate) fn sample_visible(w: Vec3, u: Vec2) -> Vec3 {
    let (cos, sin) = (w.z, Vec2::new(w.x, w.y).length());
    let along = visible_slope(cos, sin, u.x);
    let across = erf_inv((2.0 * u.y - 1.0).clamp(-MAX_ERF, MAX_ERF));
    let azimuth = if sin > 0.0 { Vec2::new(w.x, w.y) / sin } else { Vec2::X };
    (-(along * azimuth + across * azimuth.perp())).extend(1.0)
}

/// The largest `f32` below 1: slopes beyond ± 3.8 have a probability below 10⁻⁷.
const MAX_ERF: f32 = 1.0 - f32::EPSILON / 2.0;

/// The slope x along the azimuth of a direction with this elevation, from a uniform number.
fn visible_slope(cos: f32, sin: f32, u: f32) -> f32 {
    // ∫ over slopes below x, times 2 / √π: cos (1 + e) + sin exp(−x²) / √π, with e = erf(x).
    let (max_e, max_exp) = erf_exp(cos / sin);
    let total = cos * (1.0 + max_e) + sin * FRAC_1_SQRT_PI * max_exp;
    let target = u * total;
    let (mut low, mut high) = (-MAX_ERF, max_e.min(MAX_ERF));
    // At normal incidence e is uniform.
    let mut e = low + u * (high - low);
    let mut x = erf_inv(e);
    for _ in 0..MAX_ITERATIONS {
        let excess = cos * (1.0 + e) + sin * FRAC_1_SQRT_PI * (-x * x).exp() - target;
        if excess.abs() < TOLERANCE * total {
            break;
        }
        if excess > 0.0 {
            high = e
        } else {
            low = e
        }
        let newton = e - excess / (cos - x * sin);
        e = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        x = erf_inv(e);
    }
    x
}

/// Accepted error of the inverted distribution function.
const TOLERANCE: f32 = 2e-7;
/// Newton needs about five; bisection alone would end at `f32`'s precision after this many.
const MAX_ITERATIONS: usize = 24;

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
        assert!((projected_area(0.5, 0.5) - 0.5 * (1.0 + lambda)).abs() < 1e-6);
        assert_eq!(projected_area(1.0, 0.0), 1.0);
        assert!((projected_area(0.0, 0.3) - 0.15 * FRAC_1_SQRT_PI).abs() < 1e-7);
    }
}
