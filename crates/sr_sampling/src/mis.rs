//! Multiple importance sampling: several densities, one estimate (Veach & Guibas 1995).

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
