//! An index drawn with probability proportional to its weight, in constant time.

use super::{TableError, checked_sum};
use crate::distribution::{Distribution, Sample};
use crate::measure::Counting;

/// An index, by one look into a table of n columns of equal width, each shared by two indices: O(1).
///
/// A. J. Walker 1977; built as by M. D. Vose, "A Linear Algorithm for Generating Random Numbers with a
/// Given Distribution", 1991.
///
/// A uniform has 24 bits, of which the column takes log₂ n and the choice in it the rest: beyond some
/// 10⁵ weights, [`Discrete`](super::Discrete) follows small differences of weight more closely.
#[derive(Clone, Debug)]
pub struct AliasTable {
    columns: Vec<Column>,
}

#[derive(Clone, Copy, Debug)]
struct Column {
    /// The share of the column that is its own.
    own: f32,
    /// Whose the rest is.
    alias: u32,
    /// Probability of the column's own index, from all columns together.
    pmf: f32,
}

impl AliasTable {
    /// The most weights of a table.
    pub const MAX_LEN: usize = 1 << 24;

    /// An index for each weight.
    ///
    /// # Errors
    /// If there is no weight, too many (2²⁴), one is negative or not finite, or all are 0.
    pub fn new(weights: &[f32]) -> Result<Self, TableError> {
        let len = weights.len();
        if len > Self::MAX_LEN {
            return Err(TableError::TooLarge { len, limit: Self::MAX_LEN });
        }
        let sum = checked_sum(weights)?;
        let mut columns: Vec<Column> = weights
            .iter()
            .zip(0..)
            .map(|(&w, alias)| Column { own: 1.0, alias, pmf: (f64::from(w) / sum) as f32 })
            .collect();
        // What is still to be placed of each weight, in columns. Those below one take the rest of
        // their column from those above.
        let mut left: Vec<f64> = weights.iter().map(|&w| f64::from(w) / sum * len as f64).collect();
        let (mut below, mut above): (Vec<usize>, Vec<usize>) = (0..len).partition(|&i| left[i] < 1.0);
        while let (Some(small), Some(&large)) = (below.pop(), above.last()) {
            columns[small].own = left[small] as f32;
            columns[small].alias = large as u32;
            left[large] -= 1.0 - left[small];
            if left[large] < 1.0 {
                above.pop();
                below.push(large);
            }
        }
        // What rounding leaves over has a whole column, unless it has no weight at all.
        let heaviest = (0..len).max_by(|&i, &j| weights[i].total_cmp(&weights[j])).expect("not empty");
        for i in (0..len).filter(|&i| weights[i] == 0.0) {
            let alias = columns[i].alias as usize;
            let alias = if weights[alias] > 0.0 { alias } else { heaviest };
            columns[i] = Column { own: 0.0, alias: alias as u32, pmf: 0.0 };
        }
        Ok(Self { columns })
    }

    /// The number of indices.
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// A sample, and what is left of the uniform: a uniform that may be used again, if coarser.
    #[inline]
    pub fn sample_and_reuse(&self, u: f32) -> (Sample<Counting>, f32) {
        let scaled = f64::from(u) * self.columns.len() as f64;
        let at = (scaled as usize).min(self.columns.len() - 1);
        let within = (scaled - at as f64) as f32;
        let column = self.columns[at];
        let (value, rest) = if within < column.own {
            (at, within / column.own)
        } else {
            (column.alias as usize, (within - column.own) / (1.0 - column.own))
        };
        (Sample { value, pdf: self.columns[value].pmf }, rest.min(1.0 - f32::EPSILON / 2.0))
    }
}

impl Distribution for AliasTable {
    type Measure = Counting;
    type Uniform = f32;

    #[inline]
    fn sample(&self, u: f32) -> Option<Sample<Counting>> {
        Some(self.sample_and_reuse(u).0)
    }

    #[inline]
    fn pdf(&self, index: usize) -> f32 {
        self.columns.get(index).map_or(0.0, |column| column.pmf)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The probability with which `sample` draws each index, from the columns.
    fn drawn(table: &AliasTable) -> Vec<f64> {
        let mut shares = vec![0.0; table.len()];
        for (i, column) in table.columns.iter().enumerate() {
            shares[i] += f64::from(column.own) / table.len() as f64;
            shares[column.alias as usize] += (1.0 - f64::from(column.own)) / table.len() as f64;
        }
        shares
    }

    #[test]
    fn what_is_drawn_is_what_is_claimed() {
        let tables: [&[f32]; 6] = [
            &[1.0],
            &[1.0, 1.0, 1.0],
            &[0.0, 5.0, 0.0],
            &[1e-6, 1.0, 1e6, 0.0],
            &[0.1, 0.2, 0.3, 0.4, 0.7, 0.01, 0.0, 3.0],
            &[3.0; 1000],
        ];
        for weights in tables {
            let table = AliasTable::new(weights).unwrap();
            for (i, share) in drawn(&table).into_iter().enumerate() {
                let pmf = f64::from(table.pdf(i));
                assert!((share - pmf).abs() < 1e-7, "{weights:?}: {i} has {share}, not {pmf}");
                assert_eq!(share > 0.0, weights[i] > 0.0);
            }
        }
    }

    #[test]
    fn reused_uniforms_stay_in_range() {
        let table = AliasTable::new(&[0.1, 0.2, 0.3, 0.4]).unwrap();
        for i in 0..4096 {
            let (s, rest) = table.sample_and_reuse(i as f32 / 4096.0);
            assert!((0.0..1.0).contains(&rest) && s.pdf > 0.0);
        }
        assert_eq!(table.pdf(4), 0.0);
    }

    #[test]
    fn errors_name_the_weight() {
        assert_eq!(AliasTable::new(&[]).unwrap_err(), TableError::Empty);
        assert_eq!(AliasTable::new(&[0.0]).unwrap_err(), TableError::AllZero { len: 1 });
        let error = AliasTable::new(&[1.0, -1.0]).unwrap_err();
        assert_eq!(error, TableError::BadWeight { index: 1, weight: -1.0 });
    }
}
