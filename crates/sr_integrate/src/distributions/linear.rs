//! A density that is linear between two ends, and one that is made of two such: a tent.

use super::line::OnLine;
use super::parameter::{ParameterError, bad, checked_sum, finite, width};
use crate::density::Cumulative;

/// A density on [low, high] that changes linearly from one end to the other: P(x) ∝ x on [0, 5] is
/// `Linear::new(0.0, 5.0, 0.0, 1.0)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    low: f64,
    high: f64,
    width: f64,
    /// Twice the share of the values at the ends: they sum to 2, as does the mean of 1 of both ends.
    at: [f64; 2],
}

impl Linear {
    /// - `at_low`, `at_high`: what the density is proportional to at the two ends
    ///
    /// # Errors
    /// If [low, high] is no interval, a value is negative or not finite, or both are 0.
    pub fn new(low: f64, high: f64, at_low: f64, at_high: f64) -> Result<Self, ParameterError> {
        let width = width("[low, high]", low, high)?;
        for (name, value) in [("at_low", at_low), ("at_high", at_high)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(bad(name, value, "finite and not negative"));
            }
        }
        let largest = at_low.max(at_high);
        if largest == 0.0 {
            return Err(bad("at_high, with at_low,", at_high, "positive if the other is 0"));
        }
        let (a, b) = (at_low / largest, at_high / largest);
        Ok(Self { low, high, width, at: [2.0 * a / (a + b), 2.0 * b / (a + b)] })
    }
}

/// Where in [0, 1] a share `u` of a linear density with values `a`, `b` of mean 1 is reached.
#[inline]
pub(crate) fn icdf_of_unit(u: f64, [a, b]: [f64; 2]) -> f64 {
    // Of a t + (b − a) t² / 2 = u, in the form that does not cancel.
    let root = (a * a * (1.0 - u) + b * b * u).sqrt();
    if u > 0.0 { (2.0 * u / (a + root)).min(1.0) } else { 0.0 }
}

/// The share of such a density below `t` in [0, 1].
#[inline]
pub(crate) fn cdf_of_unit(t: f64, [a, b]: [f64; 2]) -> f64 {
    t * (a + 0.5 * (b - a) * t)
}

impl OnLine for Linear {
    #[inline]
    fn density(&self, x: f64) -> f64 {
        if x >= self.low && x <= self.high {
            let [a, b] = self.at;
            (a * ((self.high - x) / self.width) + b * ((x - self.low) / self.width)) / self.width
        } else {
            0.0
        }
    }

    fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    fn expected(&self) -> Option<f64> {
        let [a, b] = self.at;
        Some(self.low + self.width * (a + 2.0 * b) / 6.0)
    }
}

impl Cumulative for Linear {
    fn cdf(&self, x: f64) -> f64 {
        cdf_of_unit(((x - self.low) / self.width).clamp(0.0, 1.0), self.at).min(1.0)
    }

    #[inline]
    fn icdf(&self, u: f64) -> f64 {
        (self.low + self.width * icdf_of_unit(u, self.at)).min(self.high)
    }

    fn above(&self, x: f64) -> f64 {
        let [a, b] = self.at;
        cdf_of_unit(((self.high - x) / self.width).clamp(0.0, 1.0), [b, a]).min(1.0)
    }

    fn inverse_above(&self, q: f64) -> f64 {
        let [a, b] = self.at;
        (self.high - self.width * icdf_of_unit(q, [b, a])).max(self.low)
    }
}

/// A density that rises linearly from 0 at `low` to a peak, and falls to 0 at `high`: a triangular
/// distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tent {
    low: f64,
    peak: f64,
    high: f64,
    width: f64,
    /// The share below the peak.
    below: f64,
}

impl Tent {
    /// # Errors
    /// If [low, high] is no interval, or the peak lies outside.
    pub fn new(low: f64, peak: f64, high: f64) -> Result<Self, ParameterError> {
        let width = width("[low, high]", low, high)?;
        finite("peak", peak)?;
        if !(peak >= low && peak <= high) {
            return Err(bad("peak", peak, "between low and high"));
        }
        checked_sum("sides", &[peak - low, high - peak])?;
        Ok(Self { low, peak, high, width, below: (peak - low) / width })
    }
}

impl OnLine for Tent {
    #[inline]
    fn density(&self, x: f64) -> f64 {
        let top = 2.0 / self.width;
        if x >= self.low && x < self.peak {
            top * ((x - self.low) / (self.peak - self.low))
        } else if x > self.peak && x <= self.high {
            top * ((self.high - x) / (self.high - self.peak))
        } else if x == self.peak {
            top
        } else {
            0.0
        }
    }

    fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    fn expected(&self) -> Option<f64> {
        Some(self.low / 3.0 + self.peak / 3.0 + self.high / 3.0)
    }
}

impl Cumulative for Tent {
    fn cdf(&self, x: f64) -> f64 {
        if x < self.peak {
            let t = ((x - self.low) / (self.peak - self.low)).max(0.0);
            self.below * t * t
        } else {
            1.0 - self.above(x)
        }
    }

    #[inline]
    fn icdf(&self, u: f64) -> f64 {
        if u < self.below {
            self.low + (self.peak - self.low) * (u / self.below).sqrt()
        } else {
            self.inverse_above(1.0 - u)
        }
    }

    fn above(&self, x: f64) -> f64 {
        if x < self.peak {
            1.0 - self.cdf(x)
        } else {
            let t = (self.high - x).max(0.0) / (self.high - self.peak).max(f64::MIN_POSITIVE);
            (self.high - self.peak) / self.width * t * t
        }
    }

    fn inverse_above(&self, q: f64) -> f64 {
        let above = (self.high - self.peak) / self.width;
        if q < above {
            self.high - (self.high - self.peak) * (q / above).sqrt()
        } else if self.below > 0.0 {
            self.low + (self.peak - self.low) * ((1.0 - q) / self.below).clamp(0.0, 1.0).sqrt()
        } else {
            self.low
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_of_the_article() {
        let p = Linear::new(0.0, 5.0, 0.0, 1.0).unwrap();
        for x in [0.1, 1.0, 4.0] {
            assert!((p.density(x) - 2.0 * x / 25.0).abs() < 1e-15);
            assert!((p.cdf(x) - x * x / 25.0).abs() < 1e-15);
            assert!((p.icdf(p.cdf(x)) - x).abs() < 1e-14);
        }
        assert_eq!(p.expected(), Some(10.0 / 3.0));
    }

    #[test]
    fn a_tent_may_lean() {
        for peak in [-1.0, -0.5, 0.0, 2.0] {
            let tent = Tent::new(-1.0, peak, 2.0).unwrap();
            assert!((tent.density(peak) - 2.0 / 3.0).abs() < 1e-15);
            for x in [-0.999, -0.7, -0.2, 0.1, 1.9] {
                assert!((tent.icdf(tent.cdf(x)) - x).abs() < 1e-14, "{peak}: {x}");
                assert!((tent.inverse_above(tent.above(x)) - x).abs() < 1e-12);
            }
            assert_eq!((tent.icdf(0.0), tent.icdf(1.0)), (-1.0, 2.0));
        }
    }

    #[test]
    fn errors_name_the_argument() {
        let text = |result: Result<Linear, ParameterError>| result.unwrap_err().to_string();
        assert!(text(Linear::new(0.0, 1.0, -1.0, 2.0)).starts_with("at_low is -1"));
        assert!(text(Linear::new(0.0, 1.0, 1.0, f64::INFINITY)).starts_with("at_high is inf"));
        assert!(text(Linear::new(0.0, 1.0, 0.0, 0.0)).contains("at_high"));
        assert!(Tent::new(0.0, 2.0, 1.0).unwrap_err().to_string().starts_with("peak is 2"));
    }
}
