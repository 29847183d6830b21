//! An index drawn with probability proportional to its weight.

use super::{TableError, checked_sum, cumulative};
use crate::distribution::{Distribution, Sample};
use crate::measure::Counting;

/// An index, by binary search in the cumulative probabilities: O(log n).
///
/// A larger uniform never gives a smaller index, so well distributed uniforms stay so.
#[derive(Clone, Debug)]
pub struct Discrete {
    cumulative: Vec<u32>,
}

impl Discrete {
    /// An index for each weight.
    ///
    /// # Errors
    /// If there is no weight, too many (2²⁶), one is negative or not finite, or all are 0.
    pub fn new(weights: &[f32]) -> Result<Self, TableError> {
        cumulative::check_len(weights.len())?;
        let sum = checked_sum(weights)?;
        let mut table = vec![0; weights.len() + 1];
        cumulative::fill(weights.iter().map(|&w| f64::from(w)), sum, &mut table);
        Ok(Self { cumulative: table })
    }

    /// The number of indices.
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.cumulative.len() - 1
    }

    /// A sample, and what is left of the uniform: a uniform that may be used again.
    #[inline]
    pub fn sample_and_reuse(&self, u: f32) -> (Sample<Counting>, f32) {
        let picked = cumulative::pick(&self.cumulative, u);
        let rest = (picked.rest as f32).min(1.0 - f32::EPSILON / 2.0);
        (Sample { value: picked.index, pdf: picked.pmf as f32 }, rest)
    }
}

impl Distribution for Discrete {
    type Measure = Counting;
    type Uniform = f32;

    #[inline]
    fn sample(&self, u: f32) -> Option<Sample<Counting>> {
        Some(self.sample_and_reuse(u).0)
    }

    #[inline]
    fn pdf(&self, index: usize) -> f32 {
        if index < self.len() { cumulative::pmf(&self.cumulative, index) as f32 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_are_proportional_and_sum_to_one() {
        let table = Discrete::new(&[2.0, 0.0, 6.0]).unwrap();
        let pmf: Vec<f32> = (0..4).map(|i| table.pdf(i)).collect();
        assert_eq!(pmf, [0.25, 0.0, 0.75, 0.0]);
        assert_eq!(table.sample(0.2).unwrap(), Sample { value: 0, pdf: 0.25 });
        let (s, rest) = table.sample_and_reuse(0.625);
        assert_eq!((s.value, rest), (2, 0.5));
    }

    #[test]
    fn errors_name_the_weight() {
        let error = |weights: &[f32]| Discrete::new(weights).unwrap_err();
        assert_eq!(error(&[]), TableError::Empty);
        assert_eq!(error(&[0.0, 0.0]), TableError::AllZero { len: 2 });
        assert_eq!(error(&[1.0, -2.0]), TableError::BadWeight { index: 1, weight: -2.0 });
        assert!(matches!(error(&[f32::NAN]), TableError::BadWeight { index: 0, .. }));
        assert!(matches!(error(&[1.0, f32::INFINITY]), TableError::BadWeight { index: 1, .. }));
    }
}
