//! The normal distribution, and what is left of it between two bounds, however far out.

use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};
use std::sync::Arc;

use super::line::OnLine;
use super::parameter::{ParameterError, bad, finite, positive};
use super::quadrature::gauss;
use super::solve::increasing;
use crate::density::{Cumulative, Density};

/// Normal (Gaussian), of a mean and a standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    mean: f64,
    sd: f64,
}

impl Normal {
    /// # Errors
    /// If the mean is not finite, or the standard deviation not positive and finite.
    pub fn new(mean: f64, sd: f64) -> Result<Self, ParameterError> {
        finite("mean", mean)?;
        positive("sd", sd)?;
        finite("mean + 40 sd", mean.abs() + 40.0 * sd)?;
        Ok(Self { mean, sd })
    }

    fn standard(&self, x: f64) -> f64 {
        (x - self.mean) / self.sd
    }
}

/// φ(z) = exp(−z²/2) / √2π.
fn phi(z: f64) -> f64 {
    (-0.5 * z * z).exp() / (2.0 * PI).sqrt()
}

/// P(Z > z).
fn upper(z: f64) -> f64 {
    0.5 * libm::erfc(z * FRAC_1_SQRT_2)
}

/// The z with P(Z > z) = q.
fn inverse_upper(q: f64) -> f64 {
    SQRT_2 * statrs::function::erf::erfc_inv(2.0 * q)
}

impl OnLine for Normal {
    #[inline]
    fn density(&self, x: f64) -> f64 {
        let pdf = phi(self.standard(x)) / self.sd;
        if pdf.is_nan() { 0.0 } else { pdf }
    }

    fn ends(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    fn expected(&self) -> Option<f64> {
        Some(self.mean)
    }
}

impl Cumulative for Normal {
    fn cdf(&self, x: f64) -> f64 {
        upper(-self.standard(x))
    }

    fn icdf(&self, u: f64) -> f64 {
        self.mean - self.sd * inverse_upper(u)
    }

    fn above(&self, x: f64) -> f64 {
        upper(self.standard(x))
    }

    fn inverse_above(&self, q: f64) -> f64 {
        self.mean + self.sd * inverse_upper(q)
    }

    fn between(&self, low: f64, high: f64) -> Option<Result<Arc<dyn Density>, ParameterError>> {
        Some(TruncatedNormal::new(*self, low, high).map(|cut| Arc::new(cut) as Arc<dyn Density>))
    }
}

/// A normal distribution cut to [low, high], which may be infinite on either side, and may lie so far out
/// that its probability is no number: 40 standard deviations are e⁻⁸⁰⁵.
///
/// Everything is taken relative to the end that is nearer to the mean, by Mills' ratio P(Z > z) / φ(z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruncatedNormal {
    of: Normal,
    low: f64,
    high: f64,
    /// The ends in standard deviations, mirrored if need be so that the mean is below the middle.
    near: f64,
    far: f64,
    mirrored: bool,
    /// P(Z > near) / φ(near), if the mean lies outside.
    near_mills: f64,
    /// P(near < Z < far) / φ(near), or that without the division if the mean lies within.
    mass: f64,
}

impl TruncatedNormal {
    /// # Errors
    /// If `low` is not below `high`, or too near to it for the density to be a finite number, or 10¹⁵⁰ or
    /// more standard deviations out.
    pub fn new(of: Normal, low: f64, high: f64) -> Result<Self, ParameterError> {
        if !(low < high) {
            return Err(ParameterError::Interval { argument: "[low, high]".into(), low, high });
        }
        let (a, b) = (of.standard(low), of.standard(high));
        let mirrored = a + b < 0.0;
        let (near, far) = if mirrored { (-b, -a) } else { (a, b) };
        if !(near < 1e150) {
            let (name, value) = if mirrored { ("high", high) } else { ("low", low) };
            return Err(bad(name, value, "less than 1e150 standard deviations from the mean"));
        }
        let mut cut =
            Self { of, low, high, near, far, mirrored, near_mills: mills(near.max(0.0)), mass: 1.0 };
        cut.mass = cut.mass_to(far);
        positive("the probability within [low, high]", cut.mass)?;
        positive("the density within [low, high]", cut.mass * of.sd)?;
        Ok(cut)
    }

    /// φ(z), relative to φ(near) if the mean lies outside.
    fn relative_phi(&self, z: f64) -> f64 {
        if self.near > 0.0 { (-0.5 * (z - self.near) * (z + self.near)).exp() } else { phi(z) }
    }

    /// P(near < Z < z), relative to φ(near) if the mean lies outside.
    fn mass_to(&self, z: f64) -> f64 {
        let width = z - self.near;
        if width * self.near.abs().max(1.0) < 0.5 {
            // Narrow: differences would cancel, and the density is almost a parabola.
            gauss(|z| self.relative_phi(z), self.near, z)
        } else if self.near > 0.0 {
            self.near_mills - self.relative_phi(z) * mills(z)
        } else {
            1.0 - upper(-self.near) - upper(z)
        }
    }

    fn standard(&self, x: f64) -> f64 {
        let z = self.of.standard(x.clamp(self.low, self.high));
        if self.mirrored { -z } else { z }
    }

    /// The value below which, from the near end, a share `u` lies.
    fn within(&self, u: f64) -> f64 {
        if u <= 0.0 || u >= 1.0 {
            return if u <= 0.0 { self.near } else { self.far };
        }
        let target = u * self.mass;
        // Where the tail is as good as exponential, a guess that is good: Q(x) / Q(near) = v at √(near² − 2
        // ln v).
        let far_share = (1.0 - u) + u * (1.0 - self.mass / self.near_mills).max(0.0);
        let guess = if self.near > 0.0 {
            let drop = -2.0 * far_share.ln();
            self.near + drop / ((self.near * self.near + drop).sqrt() + self.near)
        } else {
            let below = upper(-self.near) + target;
            if below < 0.5 {
                -inverse_upper(below)
            } else {
                inverse_upper(upper(self.far) + (1.0 - u) * self.mass)
            }
        };
        increasing(|z| (self.mass_to(z), self.relative_phi(z)), target, [self.near, self.far], guess)
    }

    fn out(&self, z: f64) -> f64 {
        let z = if self.mirrored { -z } else { z };
        (self.of.mean + self.of.sd * z).clamp(self.low, self.high)
    }
}

impl OnLine for TruncatedNormal {
    fn density(&self, x: f64) -> f64 {
        if x >= self.low && x <= self.high {
            self.relative_phi(self.standard(x)) / (self.mass * self.of.sd)
        } else {
            0.0
        }
    }

    fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// From ∫ z φ(z) dz = −φ(z).
    fn expected(&self) -> Option<f64> {
        let narrow = (self.far - self.near) * self.near.abs().max(1.0) < 0.5;
        let z = if narrow {
            let moment = |z: f64| (z - self.near) * self.relative_phi(z);
            self.near + gauss(moment, self.near, self.far) / self.mass
        } else {
            (self.relative_phi(self.near) - self.relative_phi(self.far)) / self.mass
        };
        Some(self.out(z))
    }
}

impl Cumulative for TruncatedNormal {
    fn cdf(&self, x: f64) -> f64 {
        let share = (self.mass_to(self.standard(x)) / self.mass).clamp(0.0, 1.0);
        if self.mirrored { 1.0 - share } else { share }
    }

    fn icdf(&self, u: f64) -> f64 {
        self.out(self.within(if self.mirrored { 1.0 - u } else { u }))
    }
}

/// Mills' ratio P(Z > z) / φ(z), z ≥ 0; 0 at infinity.
fn mills(z: f64) -> f64 {
    if z < 8.0 {
        return upper(z) / phi(z);
    }
    // Laplace's continued fraction 1 / (z + 1 / (z + 2 / (z + 3 / …))): 16 terms leave less than rounding
    // does.
    let mut tail = z;
    for k in (1..16).rev() {
        tail = z + f64::from(k) / tail;
    }
    1.0 / tail
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From tables with 20 digits.
    #[test]
    fn tails_are_known() {
        let normal = Normal::new(0.0, 1.0).unwrap();
        for (z, q) in [
            (1.0, 0.158_655_253_931_457_05),
            (8.0, 6.220_960_574_271_785e-16),
            (20.0, 2.753_624_118_606_233_7e-89),
            (37.0, 5.725_571_222_524_577e-300),
        ] {
            assert!((normal.above(z) / q - 1.0).abs() < 1e-13, "{z}: {:e}", normal.above(z));
            assert!((normal.cdf(-z) / q - 1.0).abs() < 1e-13);
            assert!((normal.inverse_above(q) / z - 1.0).abs() < 1e-14, "{z}");
        }
        assert_eq!(normal.icdf(0.5), 0.0);
        assert_eq!(normal.icdf(0.0), f64::NEG_INFINITY);
        assert_eq!(normal.density(f64::NAN), 0.0);
    }

    #[test]
    fn both_ways_to_mills_ratio_agree() {
        for z in [8.0_f64, 12.0, 20.0, 26.0] {
            assert!((upper(z) / phi(z) / mills(z) - 1.0).abs() < 2e-13, "{z}");
        }
    }

    fn cases() -> Vec<TruncatedNormal> {
        let of = Normal::new(0.0, 1.0).unwrap();
        let inf = f64::INFINITY;
        [
            [8.0, 9.0],
            [-9.0, -8.0],
            [40.0, 41.0],
            [-1e5, -1e4],
            [0.0, inf],
            [-1.0, 2.0],
            [-inf, 0.3],
            [-inf, -38.0],
            [3.0, inf],
            [0.4, 0.4 + 1e-9],
            [-0.1, 0.1],
            [-5.0, 1.0],
            [10.0, 10.0_f64.next_up()],
        ]
        .map(|[low, high]| TruncatedNormal::new(of, low, high).unwrap())
        .to_vec()
    }

    #[test]
    fn what_is_cut_is_inverted() {
        for cut in cases() {
            let mut last = f64::NEG_INFINITY;
            for i in 0..=1000 {
                let u = f64::from(i) / 1000.0;
                let x = cut.icdf(u);
                assert!(x >= last && x >= cut.low && x <= cut.high, "{u} of {cut:?}: {x}");
                last = x;
                let back = cut.cdf(x);
                let steps = cut.density(x) * (x.abs() * f64::EPSILON);
                assert!(
                    (back - u).abs() < 1e-13 + 2.0 * steps || !x.is_finite(),
                    "{u} of {cut:?}: {x} {back}"
                );
            }
        }
    }

    /// Simpson's rule; and the mean by it.
    #[test]
    fn the_density_integrates_to_one() {
        for cut in cases() {
            let n = 200_000;
            let low = cut.low.max(-50.0_f64.max(-cut.low.abs()));
            let (low, high) = (
                if cut.low.is_finite() { cut.low } else { low.min(cut.high - 12.0) },
                cut.high.min(12.0_f64.max(cut.high.min(1e9))),
            );
            let high = if cut.high.is_finite() { high } else { 12.0 };
            if (high - low) < 1e-12 {
                continue;
            }
            // Far out, all lies within a few 1 / near of the near end.
            let (low, high) =
                if cut.near > 1e3 { (cut.high - 50.0 / cut.near, cut.high) } else { (low, high) };
            let h = (high - low) / f64::from(n);
            let at = |i: i32| low + f64::from(i) * h;
            let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
            let sum: f64 = (0..=n).map(|i| weight(i) * cut.density(at(i))).sum::<f64>() * h / 3.0;
            assert!((sum - 1.0).abs() < 1e-6, "{cut:?}: {sum}");
            let mean: f64 =
                (0..=n).map(|i| weight(i) * (at(i) - low) * cut.density(at(i))).sum::<f64>() * h / 3.0;
            let known = cut.expected().unwrap();
            assert!(
                (low + mean - known).abs() < 1e-6 * (1.0 + (high - low)),
                "{cut:?}: {} {known}",
                low + mean
            );
        }
    }

    #[test]
    fn errors_name_the_argument() {
        assert!(Normal::new(f64::NAN, 1.0).unwrap_err().to_string().starts_with("mean is NaN"));
        for sd in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert!(Normal::new(0.0, sd).unwrap_err().to_string().starts_with("sd is"));
        }
        let of = Normal::new(0.0, 1.0).unwrap();
        assert!(TruncatedNormal::new(of, 2.0, 2.0).is_err());
        assert!(TruncatedNormal::new(of, f64::NAN, 2.0).is_err());
    }
}
