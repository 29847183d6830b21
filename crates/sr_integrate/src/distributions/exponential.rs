//! Waiting times.

use super::line::OnLine;
use super::parameter::{ParameterError, positive};
use crate::density::Cumulative;

/// Exponential: pdf = rate · exp(−rate · x) for x ≥ 0; mean 1 / rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    rate: f64,
}

impl Exponential {
    /// # Errors
    /// If the rate is not positive and finite, or so small that not all samples are finite (below 10⁻³⁰⁶).
    pub fn new(rate: f64) -> Result<Self, ParameterError> {
        positive("rate", rate)?;
        positive("rate", rate * 1e-2)?;
        Ok(Self { rate })
    }
}

impl OnLine for Exponential {
    #[inline]
    fn density(&self, x: f64) -> f64 {
        if x >= 0.0 { self.rate * (-self.rate * x).exp() } else { 0.0 }
    }

    fn ends(&self) -> [f64; 2] {
        [0.0, f64::INFINITY]
    }

    fn expected(&self) -> Option<f64> {
        Some(1.0 / self.rate)
    }
}

impl Cumulative for Exponential {
    #[inline]
    fn cdf(&self, x: f64) -> f64 {
        -(-self.rate * x.max(0.0)).exp_m1()
    }

    #[inline]
    fn icdf(&self, u: f64) -> f64 {
        -(-u).ln_1p() / self.rate
    }

    fn above(&self, x: f64) -> f64 {
        (-self.rate * x.max(0.0)).exp()
    }

    fn inverse_above(&self, q: f64) -> f64 {
        -q.ln() / self.rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_rate() {
        for rate in [1e-300, 1.0, 1e300] {
            let p = Exponential::new(rate).unwrap();
            for u in [1e-6, 0.01, 0.5, 1.0 - f64::EPSILON / 2.0] {
                let x = p.icdf(u);
                assert!(
                    x.is_finite() && p.density(x) > 0.0 && (p.cdf(x) / u - 1.0).abs() < 1e-14,
                    "{rate}, {u}"
                );
                assert!((p.inverse_above(p.above(x)) / x - 1.0).abs() < 1e-6);
            }
        }
        for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-310] {
            assert!(Exponential::new(rate).unwrap_err().to_string().starts_with("rate is "), "{rate}");
        }
    }
}
