//! Multiple importance sampling: several densities, one estimate (Veach & Guibas 1995).

mod heuristic;

pub use heuristic::{Heuristic, UnknownHeuristic};

use crate::distribution::{Distribution, PointOf};
use crate::measure::Real;

/// The balance heuristic for one sample each: p / (p + q).
///
/// 0 where `p_this` is 0; 1 where `p_this` is infinite.
#[inline]
pub fn balance_weight(p_this: f32, p_other: f32) -> f32 {
    if p_this > 0.0 { 1.0 / (1.0 + p_other / p_this) } else { 0.0 }
}

/// The power heuristic with exponent 2 for one sample each: p² / (p² + q²).
///
/// Computed from the ratio, so that large densities do not overflow.
#[inline]
pub fn power_weight(p_this: f32, p_other: f32) -> f32 {
    if p_this > 0.0 {
        let ratio = p_other / p_this;
        1.0 / (1.0 + ratio * ratio)
    } else {
        0.0
    }
}

/// One sample each of `p` and `q`, weighted by the power heuristic: an unbiased estimate of ∫ f.
///
/// `p` and `q` must be densities of the same measure; the compiler checks it.
///
/// ```compile_fail
/// use sr_sampling::{mis_estimate, warp::{UniformHemisphere, UniformDisk}};
/// use glam::Vec2;
/// // A density per solid angle and a density per area do not mix.
/// mis_estimate(|_| 1.0, &UniformHemisphere, &UniformDisk, (Vec2::ZERO, Vec2::ZERO));
/// ```
pub fn mis_estimate<P, Q>(f: impl Fn(PointOf<P>) -> f64, p: &P, q: &Q, u: (P::Uniform, Q::Uniform)) -> f64
where
    P: Distribution,
    Q: Distribution<Measure = P::Measure>,
{
    let weigh = |p_this: f64, p_other: f64| 1.0 / (1.0 + (p_other / p_this) * (p_other / p_this));
    let from_p = p.sample(u.0).map_or(0.0, |s| {
        let p_p = s.pdf.to_f64();
        f(s.value) * weigh(p_p, q.pdf(s.value).to_f64()) / p_p
    });
    let from_q = q.sample(u.1).map_or(0.0, |s| {
        let p_q = s.pdf.to_f64();
        f(s.value) * weigh(p_q, p.pdf(s.value).to_f64()) / p_q
    });
    from_p + from_q
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::Vec2;

    use super::*;
    use crate::sequence::{OwenSobol, SampleId, Sequence};
    use crate::warp::{CosineHemisphere, UniformHemisphere};

    #[test]
    fn weights_at_the_limits() {
        for weight in [balance_weight, power_weight] {
            assert_eq!(weight(0.0, 1.0), 0.0);
            assert_eq!(weight(1.0, 0.0), 1.0);
            assert_eq!(weight(2.0, 2.0), 0.5);
            assert_eq!(weight(f32::INFINITY, 1.0), 1.0);
            assert_eq!(weight(1.0, f32::INFINITY), 0.0);
        }
        assert_eq!(balance_weight(1.0, 3.0), 0.25);
        assert_eq!(power_weight(1.0, 3.0), 0.1);
        assert_eq!(power_weight(3e30, 1e30), 0.9);
    }

    /// ∫ cos²θ dω over the hemisphere is 2π/3, from a technique above it and one below.
    #[test]
    fn the_estimate_converges_to_the_integral() {
        let sequence = OwenSobol::new(5);
        let n = 1 << 14;
        let mean = (0..n)
            .map(|index| {
                let at = SampleId { pixel: 0, index };
                let u: (Vec2, Vec2) = (sequence.get_2d(at, 0), sequence.get_2d(at, 2));
                mis_estimate(|w| f64::from(w.z * w.z), &UniformHemisphere, &CosineHemisphere, u)
            })
            .sum::<f64>()
            / f64::from(n);
        assert!((mean - 2.0 * PI / 3.0).abs() < 2e-4, "{mean}");
    }
}
