//! Means and covariances of vectors, without storing them and without cancellation.

use super::lanes::{self, Summary};

/// Of a stream of vectors: their number, mean, and sum of products of deviations from it.
///
/// Merged as by Chan, Golub & LeVeque 1979.
#[derive(Clone, Debug, Default)]
pub struct Moments {
    n: u64,
    mean: Vec<f64>,
    /// Row after row, m × m.
    products: Vec<f64>,
}

impl Moments {
    /// Of `n` vectors of m numbers: m columns, one after the other.
    pub fn of_columns(columns: &[f64], n: usize) -> Self {
        let m = columns.len().checked_div(n).unwrap_or(0);
        let column = |a: usize| &columns[a * n..(a + 1) * n];
        let mean: Vec<f64> = (0..m).map(|a| Summary::of(column(a)).sum / n as f64).collect();
        let mut products = vec![0.0; m * m];
        for a in 0..m {
            for b in a..m {
                let sum = lanes::products(column(a), mean[a], column(b), mean[b]);
                (products[a * m + b], products[b * m + a]) = (sum, sum);
            }
        }
        Self { n: n as u64, mean, products }
    }

    /// As if all of `other` had been here as well.
    pub fn merge(&mut self, other: &Self) {
        if other.n == 0 {
            return;
        }
        if self.n == 0 {
            *self = other.clone();
            return;
        }
        let n = self.n + other.n;
        let share = other.n as f64 / n as f64;
        let difference: Vec<f64> = other.mean.iter().zip(&self.mean).map(|(b, a)| b - a).collect();
        let weight = share * self.n as f64;
        let m = self.mean.len();
        for a in 0..m {
            self.mean[a] += difference[a] * share;
            for b in 0..m {
                self.products[a * m + b] +=
                    other.products[a * m + b] + difference[a] * difference[b] * weight;
            }
        }
        self.n = n;
    }

    /// As if number `a` of all vectors had been multiplied by a factor.
    pub fn scale(&mut self, a: usize, factor: f64) {
        let m = self.mean.len();
        if a >= m {
            return;
        }
        self.mean[a] *= factor;
        for b in 0..m {
            self.products[a * m + b] *= factor;
            self.products[b * m + a] *= factor;
        }
    }

    /// The number of vectors.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// Their mean; empty if there are none.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// The covariance of their mean, m × m; NaN for fewer than two.
    pub fn covariance_of_mean(&self) -> Vec<f64> {
        let n = self.n as f64;
        self.products.iter().map(|sum| if self.n < 2 { f64::NAN } else { sum / (n - 1.0) / n }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merging_is_adding() {
        let numbers: Vec<f64> = (0..60).map(|i| f64::from(i * i % 37) + 1e6).collect();
        let columns = |range: std::ops::Range<usize>| {
            [&numbers[range.start..range.end], &numbers[30 + range.start..30 + range.end]].concat()
        };
        let whole = Moments::of_columns(&columns(0..30), 30);
        for split in [0, 1, 13, 30] {
            let mut merged = Moments::of_columns(&columns(0..split), split);
            merged.merge(&Moments::of_columns(&columns(split..30), 30 - split));
            assert_eq!(merged.n(), 30);
            for (a, b) in merged.mean().iter().zip(whole.mean()) {
                assert!((a - b).abs() < 1e-9);
            }
            for (a, b) in merged.covariance_of_mean().iter().zip(whole.covariance_of_mean()) {
                assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
        }
    }

    #[test]
    fn known_numbers() {
        let moments = Moments::of_columns(&[1.0, 2.0, 3.0, 2.0, 4.0, 6.0], 3);
        assert_eq!(moments.mean(), [2.0, 4.0]);
        let third = |x: f64| x / 3.0;
        assert_eq!(moments.covariance_of_mean(), [third(1.0), third(2.0), third(2.0), third(4.0)]);
        assert!(Moments::of_columns(&[1.0], 1).covariance_of_mean()[0].is_nan());
    }
}
