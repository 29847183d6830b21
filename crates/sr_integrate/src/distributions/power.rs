//! Powers of x.

use super::line::OnLine;
use super::parameter::{ParameterError, bad, finite, width};
use crate::density::Cumulative;

/// A density proportional to xᵏ on [low, high], 0 ≤ low.
///
/// Everything is measured from the end where the density per ln x is largest, so that no exponent overflows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    exponent: f64,
    low: f64,
    high: f64,
    /// k + 1: the density per ln x is proportional to xᵐ.
    m: f64,
    /// (low / high)^|m|.
    rest: f64,
    /// 1 − `rest`; ln(high / low) if m = 0.
    whole: f64,
}

/// More than this share of a density must not lie closer to 0 than numbers do.
const LOST: f64 = f64::EPSILON / 4.0;

impl Power {
    /// # Errors
    /// If [low, high] is no interval or begins below 0, or k is not finite. If it begins at 0, k must be
    /// above −1, and by so much (0.05 for high = 1) that the samples can be told from 0.
    pub fn new(exponent: f64, low: f64, high: f64) -> Result<Self, ParameterError> {
        finite("exponent", exponent)?;
        width("[low, high]", low, high)?;
        if low < 0.0 {
            return Err(bad("low", low, "at least 0"));
        }
        let m = exponent + 1.0;
        if low == 0.0 && !(m > 0.0 && m * (f64::MIN_POSITIVE.ln() - high.ln()) < LOST.ln()) {
            return Err(bad("exponent", exponent, "above -1 by 0.05 or more if low is 0"));
        }
        let span = if low == 0.0 { f64::INFINITY } else { log_ratio(high, low) };
        let whole = if m == 0.0 { span } else { -(-m.abs() * span).exp_m1() };
        Ok(Self { exponent, low, high, m, rest: (-m.abs() * span).exp(), whole })
    }
}

/// ln(x / y), also for x near y.
fn log_ratio(x: f64, y: f64) -> f64 {
    let step = (x - y) / y;
    if step.abs() < 0.5 { step.ln_1p() } else { x.ln() - y.ln() }
}

/// x · exp(t), where exp(t) alone may be no number.
fn scaled(x: f64, t: f64) -> f64 {
    let half = (0.5 * t).exp();
    x * half * half
}

impl OnLine for Power {
    fn density(&self, x: f64) -> f64 {
        if !(x >= self.low && x <= self.high) {
            return 0.0;
        }
        let Self { exponent, low, high, m, whole, .. } = *self;
        if m == 0.0 {
            1.0 / (x * whole)
        } else if m > 0.0 {
            scaled(m / high, exponent * log_ratio(x, high)) / whole
        } else {
            scaled(-m / low, exponent * log_ratio(x, low)) / whole
        }
    }

    fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// (m / (m + 1)) (high^(m + 1) − low^(m + 1)) / (highᵐ − lowᵐ), each difference as a growth of its end.
    fn expected(&self) -> Option<f64> {
        let Self { low, high, m, .. } = *self;
        if low == 0.0 {
            return Some(m / (m + 1.0) * high);
        }
        let span = log_ratio(high, low);
        // ∫ exp(k t) dt over [0, span], times exp(−k span) if k > 0.
        let growth = |k: f64| if k == 0.0 { span } else { -(-k.abs() * span).exp_m1() / k.abs() };
        Some(match m {
            m if m > 0.0 => high * growth(m + 1.0) / growth(m),
            m if m + 1.0 <= 0.0 => low * growth(m + 1.0) / growth(m),
            m => scaled(high, m * span) * growth(m + 1.0) / growth(m),
        })
    }
}

impl Cumulative for Power {
    fn cdf(&self, x: f64) -> f64 {
        let Self { low, high, m, rest, whole, .. } = *self;
        if x <= low {
            0.0
        } else if x >= high {
            1.0
        } else if m > 0.0 && rest < 0.5 {
            ((m * log_ratio(x, high)).exp() - rest) / whole
        } else if m > 0.0 {
            rest * (m * log_ratio(x, low)).exp_m1() / whole
        } else if m == 0.0 {
            log_ratio(x, low) / whole
        } else {
            -(m * log_ratio(x, low)).exp_m1() / whole
        }
        .min(1.0)
    }

    fn icdf(&self, u: f64) -> f64 {
        let Self { low, high, m, rest, whole, .. } = *self;
        let x = if u >= 1.0 {
            high
        } else if m == 0.0 {
            scaled(low, u * whole)
        } else if m > 0.0 && u < 0.5 && rest < 0.5 {
            scaled(high, (rest + u * whole).ln() / m)
        } else if m > 0.0 {
            scaled(high, (-(1.0 - u) * whole).ln_1p() / m)
        } else {
            scaled(low, (-u * whole).ln_1p() / m)
        };
        x.clamp(low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distribution_function_is_inverted_for_any_exponent() {
        for (low, high) in [(1.0, 2.0), (1e-6, 3.0), (5.0, 5.0 + 1e-9), (1e-200, 1e200)] {
            for exponent in [-300.0, -2.0, -1.5, -1.0, -1.0 + 1e-9, -0.5, 0.0, 2.0, 700.0] {
                let p = Power::new(exponent, low, high).unwrap();
                for u in [0.0, 1e-9, 0.2, 0.5, 0.8, 1.0] {
                    let x = p.icdf(u);
                    let digits = 1e-13 + f64::EPSILON * x / (high - low) * (1.0 + exponent.abs());
                    assert!(
                        (p.cdf(x) - u).abs() < 4.0 * digits,
                        "{exponent} on [{low}, {high}]: {u} {x} {}",
                        p.cdf(x)
                    );
                    assert!(p.density(x).is_finite(), "{exponent} on [{low}, {high}]: {u} {x}");
                }
                assert!((low..=high).contains(&p.expected().unwrap()), "{exponent} {low} {high}");
            }
        }
    }

    #[test]
    fn a_pole_at_0() {
        let p = Power::new(-0.5, 0.0, 4.0).unwrap();
        assert!((p.cdf(1.0) - 0.5).abs() < 1e-15);
        assert!((p.icdf(0.25) - 0.25).abs() < 1e-15);
        assert!((p.density(1.0) - 0.25).abs() < 1e-15);
        assert_eq!(p.expected(), Some(4.0 / 3.0));
    }

    #[test]
    fn means_of_three_kinds() {
        let mean = |k| OnLine::expected(&Power::new(k, 1.0, 2.0).unwrap()).unwrap();
        for (k, exact) in [
            (0.0, 1.5),
            (1.0, 14.0 / 9.0),
            (-1.0, 1.0 / 2.0_f64.ln()),
            (-2.0, 2.0 * 2.0_f64.ln()),
            (-3.0, 4.0 / 3.0),
            (-1.5, 2.0_f64.sqrt()),
        ] {
            assert!((mean(k) - exact).abs() < 1e-14, "{k}: {} is not {exact}", mean(k));
        }
    }

    #[test]
    fn errors_name_the_argument() {
        for exponent in [-1.0, -0.99, f64::NAN] {
            assert!(Power::new(exponent, 0.0, 1.0).unwrap_err().to_string().starts_with("exponent is"));
        }
        assert!(Power::new(1.0, -1.0, 1.0).unwrap_err().to_string().starts_with("low is -1"));
    }
}
