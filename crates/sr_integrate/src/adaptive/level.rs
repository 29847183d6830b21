//! What f / p is about in each stratum, taken off the terms and added as its exact integral.
//!
//! Points dealt out to strata have weights that differ from stratum to stratum, and even of a constant f the terms would
//! vary. vegas+ knows how many points each stratum has, and adds up means of strata. The same comes from a control
//! variate that is constant in each stratum, for any points, any number of them, and without bias: what it is was learned
//! from other points.

use super::strata::Strata;
use crate::columns::{Columns, ColumnsMut};
use crate::integrate::Control;

/// A function that is constant in each stratum.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    strata: Strata,
    outputs: usize,
    /// For each stratum and output, the value over the density.
    terms: Vec<f64>,
    /// The integral of each output.
    integrals: Vec<f64>,
}

impl Level {
    /// `values`: of each output, for each stratum of `strata` in its order.
    ///
    /// # Panics
    /// If they are not as many.
    pub fn new(strata: Strata, outputs: usize, values: &[f64]) -> Self {
        let volumes = strata.volumes();
        assert_eq!(values.len(), outputs * volumes.len());
        let mut integrals = vec![0.0; outputs];
        let mut terms = values.to_vec();
        for ((terms, values), [volume, share]) in
            terms.chunks_mut(outputs.max(1)).zip(values.chunks(outputs.max(1))).zip(volumes)
        {
            for a in 0..outputs {
                integrals[a] += values[a] * volume;
                terms[a] = values[a] * volume / share;
            }
        }
        Self { strata, outputs, terms, integrals }
    }

    /// Where it is constant.
    pub fn strata(&self) -> &Strata {
        &self.strata
    }

    /// [`Control::fill`] for uniforms that are drawn from the strata: their strata are known.
    pub fn fill_drawn(&self, strata: &[u32], mut control: ColumnsMut<'_>) {
        for a in 0..self.outputs {
            for (control, &stratum) in control.column(a).iter_mut().zip(strata) {
                *control = self.terms[stratum as usize * self.outputs + a] - self.integrals[a];
            }
        }
    }
}

impl Control for Level {
    fn outputs(&self) -> usize {
        self.outputs
    }

    fn fill(&self, u: Columns<'_>, control: ColumnsMut<'_>) {
        let mut drawn = u.numbers().to_vec();
        let strata = self.strata.sample(ColumnsMut::new(&mut drawn, u.len()), &mut vec![1.0; u.len()]);
        self.fill_drawn(&strata, control);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Its mean over the cube is 0, to rounding: what is added is what was taken off.
    #[test]
    fn its_mean_is_zero() {
        let written = [Some((0, 0.75)), Some((1, 0.25)), None, None, None];
        let level =
            Level::new(Strata::from_written(2, &written).unwrap(), 2, &[1.0, 5.0, 2.0, -3.0, 10.0, 0.1]);
        let n = 64;
        let at = |i: usize| (i as f64 + 0.5) / n as f64;
        let u: Vec<f64> = (0..n * n).map(|i| at(i / n)).chain((0..n * n).map(|i| at(i % n))).collect();
        let mut control = vec![0.0; 2 * n * n];
        level.fill(Columns::new(&u, n * n), ColumnsMut::new(&mut control, n * n));
        for column in control.chunks(n * n) {
            assert!(
                column.iter().sum::<f64>().abs() < 1e-9 * (n * n) as f64,
                "{}",
                column.iter().sum::<f64>()
            );
            assert!(column.iter().any(|c| *c > 0.1));
        }
    }
}
