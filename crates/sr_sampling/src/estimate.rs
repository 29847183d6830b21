//! A mean with its standard error.
//!
//! In: numbers, one at a time. Out: an [`Estimate`], which says how sure it is of itself.

use std::fmt;

/// What is known of a mean: `25.0013 ± 0.0046 (n = 100000)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// The standard deviation of the mean. NaN if `n` is below 2: then nobody knows.
    pub stderr: f64,
    /// The number of samples.
    pub n: u64,
}

impl Estimate {
    /// From the means of independent replicates of `samples_each` samples.
    ///
    /// Honest also where the samples of a replicate are correlated, as those of Sobol' points are:
    /// the error is that of the spread of the replicates, of which there should be several.
    pub fn from_replicates(means: &[f64], samples_each: u64) -> Self {
        let spread = means.iter().copied().collect::<Accumulator>().estimate();
        Self { n: spread.n * samples_each, ..spread }
    }

    /// The standard error relative to the mean, without its sign.
    pub fn relative_error(&self) -> f64 {
        self.stderr / self.mean.abs()
    }
}

impl fmt::Display for Estimate {
    /// The error with two digits, the mean with as many decimals.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (n = {})", format_uncertain(self.mean, self.stderr), self.n)
    }
}

/// `25.0013 ± 0.0046`: the error with two digits, the mean with as many decimals.
pub fn format_uncertain(mean: f64, stderr: f64) -> String {
    if !(stderr.is_finite() && stderr > 0.0) {
        let plain = |x: f64| {
            if x == 0.0 || !x.is_finite() || (1e-5..1e16).contains(&x.abs()) {
                format!("{x}")
            } else {
                format!("{x:e}")
            }
        };
        return format!("{} ± {}", plain(mean), plain(stderr));
    }
    // Rounding to two digits may carry: 0.0996 is 0.10, so the digits are counted after it.
    let rounded: f64 = format!("{stderr:.1e}").parse().unwrap_or(stderr);
    let exponent = rounded.log10().floor() as i32;
    if !(-12..=15).contains(&exponent) {
        if mean == 0.0 || (1e-5..1e15).contains(&mean.abs()) {
            return format!("{mean} ± {stderr:.1e}");
        }
        // As many digits as the error leaves, and as a double has.
        let digits = mean.abs().log10().floor() as i32 - exponent + 1;
        return format!("{mean:.*e} ± {stderr:.1e}", digits.clamp(0, 16) as usize);
    }
    let decimals = (1 - exponent).max(0) as usize;
    format!("{mean:.decimals$} ± {rounded:.decimals$}")
}

/// Mean and variance of a stream of numbers, without storing them and without cancellation.
///
/// B. P. Welford 1962; merged as by Chan, Golub & LeVeque 1979.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accumulator {
    n: u64,
    mean: f64,
    /// Sum of squared deviations from the mean.
    squares: f64,
}

impl Accumulator {
    /// Nothing seen yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// One more number.
    #[inline]
    pub fn add(&mut self, x: f64) {
        self.n += 1;
        let deviation = x - self.mean;
        self.mean += deviation / self.n as f64;
        self.squares += deviation * (x - self.mean);
    }

    /// As if all numbers of `other` had been added as well.
    pub fn merge(&mut self, other: &Self) {
        if other.n == 0 {
            return;
        }
        let n = self.n + other.n;
        let share = other.n as f64 / n as f64;
        let difference = other.mean - self.mean;
        self.mean += difference * share;
        self.squares += other.squares + difference * difference * share * self.n as f64;
        self.n = n;
    }

    /// The number of numbers.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// Their mean; 0 if there are none.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The unbiased variance; NaN for fewer than two.
    pub fn variance(&self) -> f64 {
        if self.n < 2 { f64::NAN } else { self.squares / (self.n - 1) as f64 }
    }

    /// The mean with its standard error.
    pub fn estimate(&self) -> Estimate {
        Estimate { mean: self.mean, stderr: (self.variance() / self.n as f64).sqrt(), n: self.n }
    }
}

impl FromIterator<f64> for Accumulator {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Self {
        let mut all = Self::new();
        all.extend(numbers);
        all
    }
}

impl Extend<f64> for Accumulator {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, numbers: I) {
        for x in numbers {
            self.add(x);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_error_of_known_numbers() {
        let estimate = [1.0, 2.0, 3.0, 4.0].into_iter().collect::<Accumulator>().estimate();
        assert_eq!((estimate.mean, estimate.n), (2.5, 4));
        assert!((estimate.stderr - (5.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn large_offsets_do_not_cancel() {
        let variance = (0..1000).map(|i| 1e9 + f64::from(i % 2)).collect::<Accumulator>().variance();
        assert!((variance - 0.25 * 1000.0 / 999.0).abs() < 1e-6, "{variance}");
    }

    #[test]
    fn merging_is_adding() {
        let numbers: Vec<f64> = (0..100).map(|i| f64::from(i * i % 37)).collect();
        let whole: Accumulator = numbers.iter().copied().collect();
        for split in [0, 1, 30, 100] {
            let mut merged: Accumulator = numbers[..split].iter().copied().collect();
            merged.merge(&numbers[split..].iter().copied().collect());
            assert_eq!(merged.n(), whole.n());
            assert!((merged.mean() - whole.mean()).abs() < 1e-12);
            assert!((merged.variance() - whole.variance()).abs() < 1e-11);
        }
    }

    #[test]
    fn replicates_count_all_their_samples() {
        let estimate = Estimate::from_replicates(&[1.0, 3.0], 50);
        assert_eq!(estimate, Estimate { mean: 2.0, stderr: 1.0, n: 100 });
    }

    #[test]
    fn the_digits_of_the_mean_follow_the_error() {
        let show = |mean, stderr| Estimate { mean, stderr, n: 100 }.to_string();
        assert_eq!(show(25.001_3, 0.004_6), "25.0013 ± 0.0046 (n = 100)");
        assert_eq!(show(25.001_3, 0.009_96), "25.001 ± 0.010 (n = 100)");
        assert_eq!(show(-3.0, 0.1), "-3.00 ± 0.10 (n = 100)");
        assert_eq!(show(1234.5, 12.0), "1234 ± 12 (n = 100)");
        assert_eq!(show(123_456.0, 1234.0), "123456 ± 1200 (n = 100)");
        assert_eq!(show(1.5, 0.0), "1.5 ± 0 (n = 100)");
        assert_eq!(show(1.5, f64::NAN), "1.5 ± NaN (n = 100)");
        assert_eq!(show(1.5e-20, 2e-22), "1.500e-20 ± 2.0e-22 (n = 100)");
        assert_eq!(show(-3.552_713_678_8e-18, 6.9e-19), "-3.55e-18 ± 6.9e-19 (n = 100)");
        assert_eq!(show(25.0, 2.8e-17), "25 ± 2.8e-17 (n = 100)");
        assert_eq!(show(0.0, 2.8e-17), "0 ± 2.8e-17 (n = 100)");
    }
}
