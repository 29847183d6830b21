//! Where the uniforms of an integral come from: pure functions of (replicate, index, dimension, seed).
//!
//! In: which points. Out: a column of numbers in [0, 1) for each dimension. As in [`sr_sampling::sequence`] nothing here
//! keeps state, so points are made in any order and by any number of threads; unlike there, points have as many
//! dimensions as are asked for, all of them jointly well distributed, and numbers have 52 bits.
//!
//! - [`Sequence::Independent`]: every number is unrelated to every other.
//! - [`Sequence::Stratified`]: every aligned block of 2ᵏ points has one in each cell of a grid of 2ᵏ cells.
//! - [`Sequence::Sobol`]: Owen-scrambled Sobol' points. The default.
//! - [`Sequence::Lattice`]: an embedded rank-1 lattice, randomly shifted and folded.
//!
//! Replicates are the same points, randomised anew and independently of one another: the spread of their means is
//! an honest error, also where the points of each are correlated by design.

mod independent;
mod lattice;
mod sobol;
mod stratified;
mod unit;

use std::str::FromStr;

use sr_sampling::isa::{Isa, Work};
use sr_sampling::sequence::mix::{derive_key, mix64};
use thiserror::Error;

use crate::columns::ColumnsMut;
use lattice::Lattice;
use sobol::Sobol;

/// A kind of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sequence {
    /// Unrelated numbers.
    Independent,
    /// One point in each cell of a grid. Pays in few dimensions.
    Stratified,
    /// Sobol' points (Sobol' 1967; Joe & Kuo 2008), Owen-scrambled (Owen 1995).
    #[default]
    Sobol,
    /// A rank-1 lattice (Cools, Kuo & Nuyens 2006).
    Lattice,
}

impl Sequence {
    /// All kinds, in the order of this page.
    pub const ALL: [Self; 4] = [Self::Independent, Self::Stratified, Self::Sobol, Self::Lattice];

    /// Its name, as [`Sequence::from_str`] reads it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Stratified => "stratified",
            Self::Sobol => "sobol",
            Self::Lattice => "lattice",
        }
    }
}

/// There is no sequence of this name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no sequence {0:?}; there are independent, stratified, sobol and lattice")]
pub struct UnknownSequence(pub String);

impl FromStr for Sequence {
    type Err = UnknownSequence;
    fn from_str(name: &str) -> Result<Self, UnknownSequence> {
        let found = Self::ALL.into_iter().find(|kind| kind.name() == name);
        found.ok_or_else(|| UnknownSequence(name.into()))
    }
}

/// The points of a sequence in some number of dimensions.
///
/// ```
/// use sr_integrate::{ColumnsMut, Points, Sequence};
/// let points = Points::new(Sequence::Sobol, 2, 1);
/// let mut numbers = [0.0; 8];
/// points.fill(0, 0, ColumnsMut::new(&mut numbers, 4)); // four points
/// // One in each quarter of each axis.
/// for column in numbers.chunks(4) {
///     let mut quarters: Vec<u8> = column.iter().map(|u| (4.0 * u) as u8).collect();
///     quarters.sort();
///     assert_eq!(quarters, [0, 1, 2, 3]);
/// }
/// ```
#[derive(Clone, Debug)]
pub struct Points {
    kind: Kind,
    dim: usize,
    key: u64,
}

#[derive(Clone, Debug)]
enum Kind {
    Independent,
    Stratified,
    Sobol(Sobol),
    Lattice(Lattice),
}

impl Points {
    /// The most points of a replicate; more repeat those from the beginning.
    pub const MAX_LEN: u64 = 1 << 32;

    /// The points of a seed; different seeds give unrelated points.
    pub fn new(sequence: Sequence, dim: usize, seed: u64) -> Self {
        let (kind, number) = match sequence {
            Sequence::Independent => (Kind::Independent, 0),
            Sequence::Stratified => (Kind::Stratified, 1),
            Sequence::Sobol => (Kind::Sobol(Sobol::new(dim)), 2),
            Sequence::Lattice => (Kind::Lattice(Lattice::new(dim)), 3),
        };
        Self { kind, dim, key: derive_key(mix64(seed), number) }
    }

    /// The number of dimensions.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Writes the points of a replicate from index `first` on, a column for each dimension.
    ///
    /// # Panics
    /// If `u` does not have [`Points::dim`] columns.
    pub fn fill(&self, replicate: u32, first: u64, mut u: ColumnsMut<'_>) {
        assert!(u.is_empty() || u.dim() == self.dim, "{} columns for {} dimensions", u.dim(), self.dim);
        for j in 0..if u.is_empty() { 0 } else { self.dim } {
            self.fill_column(replicate, first, j, u.column(j));
        }
    }

    /// Writes dimension `j` of the points of a replicate from index `first` on.
    ///
    /// # Panics
    /// If there is no such dimension.
    pub fn fill_column(&self, replicate: u32, first: u64, j: usize, u: &mut [f64]) {
        assert!(j < self.dim, "dimension {j} of {}", self.dim);
        let key = derive_key(self.key, replicate);
        let key_j = derive_key(key, j as u32);
        Isa::detect().run(Fill { points: self, key, key_j, first, j, u });
    }
}

/// One dimension of some points.
struct Fill<'a> {
    points: &'a Points,
    key: u64,
    key_j: u64,
    first: u64,
    j: usize,
    u: &'a mut [f64],
}

impl Work for Fill<'_> {
    type Out = ();

    #[inline(always)]
    fn run(self) {
        let Self { points, key, key_j, first, j, u } = self;
        match &points.kind {
            Kind::Independent => independent::fill(key_j, first, u),
            Kind::Stratified => stratified::fill(key, key_j, first as u32, [j, points.dim], u),
            Kind::Sobol(sobol) => sobol.fill(key_j, first as u32, j, u),
            Kind::Lattice(lattice) => lattice.fill(key_j, first as u32, j, u),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(sequence: Sequence, dim: usize, replicate: u32, first: u64, len: usize) -> Vec<Vec<f64>> {
        let mut numbers = vec![0.0; dim * len];
        Points::new(sequence, dim, 7).fill(replicate, first, ColumnsMut::new(&mut numbers, len));
        numbers.chunks(len).map(<[f64]>::to_vec).collect()
    }

    #[test]
    fn points_are_pure_functions_of_their_index() {
        for sequence in Sequence::ALL {
            let whole = columns(sequence, 5, 3, 0, 1000);
            for (first, len) in [(0, 1), (1, 300), (255, 2), (517, 483)] {
                let part = columns(sequence, 5, 3, first, len);
                for (a, b) in whole.iter().zip(&part) {
                    assert_eq!(a[first as usize..][..len], b[..], "{sequence:?} from {first}");
                }
            }
        }
    }

    #[test]
    fn points_are_in_the_unit_cube_and_unlike_one_another() {
        for sequence in Sequence::ALL {
            for dim in [1, 2, 7, 33, 200, 1100] {
                let all = columns(sequence, dim, 0, 0, 64);
                assert!(all.iter().flatten().all(|u| (0.0..1.0).contains(u)), "{sequence:?}");
                for (j, column) in all.iter().enumerate() {
                    let mut sorted = column.clone();
                    sorted.sort_by(f64::total_cmp);
                    sorted.dedup();
                    assert_eq!(sorted.len(), 64, "{sequence:?}, dimension {j} of {dim}");
                    let next = &all[(j + 1) % dim];
                    assert!(dim == 1 || column != next, "{sequence:?}, dimensions {j} and the next of {dim}");
                }
            }
        }
    }

    /// Means of u and of products of two dimensions over 256 replicates of 64 points, each within five standard
    /// errors: fails by chance with probability below 10⁻⁴ in all.
    #[test]
    fn replicates_are_unbiased_and_independent() {
        for sequence in Sequence::ALL {
            for (dim, pairs) in
                [(3, [[0, 1], [1, 2]]), (200, [[0, 190], [184, 199]]), (1100, [[0, 1024], [5, 1029]])]
            {
                let mut sums = [[0.0_f64; 2]; 4];
                for replicate in 0..256 {
                    let all = columns(sequence, dim, replicate, 0, 64);
                    for (k, [a, b]) in pairs.into_iter().enumerate() {
                        let single = all[b].iter().map(|u| u - 0.5).sum::<f64>() / 64.0;
                        let product =
                            all[a].iter().zip(&all[b]).map(|(u, v)| (u - 0.5) * (v - 0.5)).sum::<f64>()
                                / 64.0;
                        for (sum, x) in [(2 * k, single), (2 * k + 1, product)] {
                            sums[sum][0] += x;
                            sums[sum][1] += x * x;
                        }
                    }
                }
                for [sum, squares] in sums {
                    let mean = sum / 256.0;
                    let error = ((squares / 256.0 - mean * mean) / 255.0).sqrt();
                    // Folded lattices integrate linear functions exactly.
                    assert!(
                        mean.abs() < 5.0 * error + 1e-14,
                        "{sequence:?}, {dim} dimensions: {mean} ± {error}"
                    );
                }
            }
        }
    }

    /// The variance of a mean over 64 replicates of 1024 points, in three dimensions, over that of independent points: well
    /// below 1 for all others. (64 replicates know a variance to 18 %, so that 2 is never reached by chance.)
    #[test]
    fn correlated_points_do_better() {
        let variance = |sequence| {
            let means: Vec<f64> = (0..64)
                .map(|replicate| {
                    let all = columns(sequence, 3, replicate, 0, 1024);
                    let f = |i: usize| (all[0][i] + 2.0 * all[1][i] * all[2][i]).exp();
                    (0..1024).map(f).sum::<f64>() / 1024.0
                })
                .collect();
            means.into_iter().collect::<sr_sampling::Accumulator>().variance()
        };
        let independent = variance(Sequence::Independent);
        for (sequence, most) in
            [(Sequence::Stratified, 0.1), (Sequence::Sobol, 1e-3), (Sequence::Lattice, 1e-3)]
        {
            let ratio = variance(sequence) / independent;
            assert!(ratio < most, "{sequence:?}: {ratio}");
        }
    }

    #[test]
    fn names_are_read_back() {
        for sequence in Sequence::ALL {
            assert_eq!(sequence.name().parse(), Ok(sequence));
        }
        let error = "halton".parse::<Sequence>().unwrap_err();
        assert!(error.to_string().contains("\"halton\""), "{error}");
    }
}
