//! An index drawn with probability proportional to its weight.

use super::bins::Bins;
use super::parameter::ParameterError;
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Cumulative, Density, DensityError, Inverse};
use crate::space::Space;

/// Probabilities of the indices 0 to n − 1.
#[derive(Clone, Debug, PartialEq)]
struct Probabilities(Vec<f64>);

impl Probabilities {
    fn new(weights: &[f64], sum: f64) -> Self {
        Self(weights.iter().map(|weight| weight / sum).collect())
    }

    /// 0 of what is no index.
    #[inline]
    fn of(&self, x: f64) -> f64 {
        let index = x as usize;
        if index as f64 == x { self.0.get(index).copied().unwrap_or(0.0) } else { 0.0 }
    }

    fn all_of(&self, x: Columns<'_>, pdf: &mut [f64]) {
        for (&x, pdf) in x.column(0).iter().zip(pdf) {
            *pdf = self.of(x);
        }
    }

    fn support(&self) -> Vec<[f64; 2]> {
        let first = self.0.iter().position(|&p| p > 0.0).unwrap_or(0);
        let last = self.0.iter().rposition(|&p| p > 0.0).unwrap_or(0);
        vec![[first as f64, last as f64]]
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        self.0.contains(&0.0).then(|| vec![[0.0, (self.0.len() - 1) as f64]])
    }

    fn mean(&self) -> f64 {
        self.0.iter().enumerate().map(|(i, p)| i as f64 * p).sum()
    }
}

/// An index from 0 to n − 1, by search in the cumulative probabilities, in constant time on average.
///
/// A larger uniform never gives a smaller index, so that well distributed uniforms stay so. Points are
/// indices as floating-point numbers, densities their probabilities.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrete {
    probabilities: Probabilities,
    bins: Bins,
}

impl Discrete {
    /// # Errors
    /// If there is no weight, one is negative or not finite, or all are 0.
    pub fn new(weights: &[f64]) -> Result<Self, ParameterError> {
        let (bins, sum) = Bins::new("weights", weights)?;
        Ok(Self { probabilities: Probabilities::new(weights, sum), bins })
    }
}

impl Density for Discrete {
    fn space(&self) -> Space {
        Space::Counting
    }

    fn uniforms(&self) -> usize {
        1
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        for ((&u, x), pdf) in u.column(0).iter().zip(x.column(0)).zip(pdf) {
            let index = self.bins.pick(u).index;
            *x = index as f64;
            *pdf = self.probabilities.0[index];
        }
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        self.probabilities.all_of(x, pdf);
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.probabilities.support()
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        self.probabilities.domain()
    }

    fn mean(&self) -> Option<Vec<f64>> {
        Some(vec![self.probabilities.mean()])
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }

    fn cumulative(&self) -> Option<&dyn Cumulative> {
        Some(self)
    }
}

impl Inverse for Discrete {
    /// The middle of the index's share: many uniforms give the same index.
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        for (&x, u) in x.column(0).iter().zip(u.column(0)) {
            *u = if self.probabilities.of(x) > 0.0 { self.bins.unpick(x as usize, 0.5) } else { f64::NAN };
        }
        Ok(())
    }
}

impl Cumulative for Discrete {
    fn cdf(&self, x: f64) -> f64 {
        if x < 0.0 { 0.0 } else { self.bins.below((x as usize).saturating_add(1).min(self.bins.len())) }
    }

    /// The least index up to which the probabilities sum to `u` or more.
    fn icdf(&self, u: f64) -> f64 {
        self.bins.least(u) as f64
    }
}

/// An index from 0 to n − 1, by one look into a table of n columns of equal width, each shared by two
/// indices.
///
/// A. J. Walker 1977; built as by M. D. Vose, "A Linear Algorithm for Generating Random Numbers with a Given
/// Distribution", 1991. Faster than [`Discrete`] for long lists, but does not keep the order of the uniforms.
#[derive(Clone, Debug, PartialEq)]
pub struct Alias {
    probabilities: Probabilities,
    /// The share of each column that is its own, and whose the rest is.
    columns: Vec<(f64, u32)>,
}

impl Alias {
    /// # Errors
    /// As [`Discrete::new`].
    pub fn new(weights: &[f64]) -> Result<Self, ParameterError> {
        let sum = super::parameter::checked_sum("weights", weights)?;
        let len = weights.len();
        if len > u32::MAX as usize {
            let need = format!("at most {}", u32::MAX);
            return Err(ParameterError::Length { argument: "weights", len, need });
        }
        let mut columns: Vec<(f64, u32)> = (0..len as u32).map(|alias| (1.0, alias)).collect();
        // What is still to be placed of each weight, in columns. Those below one take the rest of their
        // column from those above.
        let mut left: Vec<f64> = weights.iter().map(|weight| weight / sum * len as f64).collect();
        let (mut below, mut above): (Vec<usize>, Vec<usize>) = (0..len).partition(|&i| left[i] < 1.0);
        while let (Some(small), Some(&large)) = (below.pop(), above.last()) {
            columns[small] = (left[small], large as u32);
            left[large] -= 1.0 - left[small];
            if left[large] < 1.0 {
                above.pop();
                below.push(large);
            }
        }
        // What rounding leaves over has a whole column, unless it has no weight at all.
        let heaviest = (0..len).max_by(|&i, &j| weights[i].total_cmp(&weights[j])).unwrap_or(0);
        for i in (0..len).filter(|&i| weights[i] == 0.0) {
            let alias = columns[i].1 as usize;
            columns[i] = (0.0, if weights[alias] > 0.0 { alias } else { heaviest } as u32);
        }
        Ok(Self { probabilities: Probabilities::new(weights, sum), columns })
    }
}

impl Density for Alias {
    fn space(&self) -> Space {
        Space::Counting
    }

    fn uniforms(&self) -> usize {
        1
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let len = self.columns.len();
        for ((&u, x), pdf) in u.column(0).iter().zip(x.column(0)).zip(pdf) {
            let scaled = u * len as f64;
            let at = (scaled as usize).min(len - 1);
            let (own, alias) = self.columns[at];
            let index = if scaled - (at as f64) < own { at } else { alias as usize };
            *x = index as f64;
            *pdf = self.probabilities.0[index];
        }
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        self.probabilities.all_of(x, pdf);
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.probabilities.support()
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        self.probabilities.domain()
    }

    fn mean(&self) -> Option<Vec<f64>> {
        Some(vec![self.probabilities.mean()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_for_each_share() {
        let p = Discrete::new(&[2.0, 0.0, 6.0]).unwrap();
        let (mut x, mut pdf) = ([0.0; 4], [0.0; 4]);
        p.sample(Columns::new(&[0.0, 0.2, 0.25, 0.9], 4), ColumnsMut::new(&mut x, 4), &mut pdf).unwrap();
        assert_eq!((x, pdf), ([0.0, 0.0, 2.0, 2.0], [0.25, 0.25, 0.75, 0.75]));
        p.pdf(Columns::new(&[1.0, 0.5, -1.0, f64::NAN], 4), &mut pdf).unwrap();
        assert_eq!(pdf, [0.0; 4]);
        assert_eq!([-0.5, 0.0, 1.7, 2.0, 1e300].map(|x| p.cdf(x)), [0.0, 0.25, 0.25, 1.0, 1.0]);
        for index in [0.0, 2.0] {
            assert_eq!(p.icdf(p.cdf(index)), index);
        }
        assert_eq!((p.mean(), p.domain()), (Some(vec![1.5]), Some(vec![[0.0, 2.0]])));
    }

    #[test]
    fn an_alias_table_draws_what_it_claims() {
        let tables: [&[f64]; 5] = [
            &[1.0],
            &[1.0, 1.0, 1.0],
            &[0.0, 5.0, 0.0],
            &[1e-6, 1.0, 1e6, 0.0],
            &[0.1, 0.2, 0.3, 0.4, 0.7, 0.01, 3.0],
        ];
        for weights in tables {
            let table = Alias::new(weights).unwrap();
            let mut shares = vec![0.0; weights.len()];
            for (i, &(own, alias)) in table.columns.iter().enumerate() {
                shares[i] += own / weights.len() as f64;
                shares[alias as usize] += (1.0 - own) / weights.len() as f64;
            }
            for (share, p) in shares.iter().zip(&table.probabilities.0) {
                assert!((share - p).abs() < 1e-15, "{weights:?}: {shares:?}");
            }
        }
        assert!(Alias::new(&[]).unwrap_err().to_string().starts_with("weights has 0"));
        assert!(
            Discrete::new(&[1.0, f64::INFINITY]).unwrap_err().to_string().starts_with("weights[1] is inf")
        );
        assert!(Alias::new(&[0.0, 0.0]).is_err());
    }
}
