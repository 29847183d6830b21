//! Distributions from tables: counts, weights, the pixels of a picture.
//!
//! - [`Discrete`]: an index, by binary search; keeps the order of the uniforms.
//! - [`AliasTable`]: an index, in constant time; does not keep it.
//! - [`PiecewiseConstant1D`], [`PiecewiseConstant2D`]: histograms as densities.
//! - [`SummedArea`]: a histogram of which any window is a density.
//!
//! Invariant: `pdf` is the probability with which `sample` draws, not the weight it was built from;
//! where the two differ by rounding, the former is what makes an estimate unbiased.

mod alias;
mod cumulative;
mod discrete;
mod piecewise_1d;
mod piecewise_2d;
mod summed_area;

use thiserror::Error;

pub use alias::AliasTable;
pub use discrete::Discrete;
pub use piecewise_1d::PiecewiseConstant1D;
pub use piecewise_2d::{Draw2D, PiecewiseConstant2D};
pub use summed_area::{SummedArea, Window};

/// Why a table of weights is not a distribution.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TableError {
    /// No entry at all.
    #[error("a table needs at least one weight")]
    Empty,
    /// More entries than can be told apart.
    #[error("a table of {len} weights is too large; the limit is {limit}")]
    TooLarge {
        /// The number of weights given.
        len: usize,
        /// The largest number possible.
        limit: usize,
    },
    /// A weight that is negative, infinite or NaN.
    #[error("weight {index} is {weight}; weights must be finite and not negative")]
    BadWeight {
        /// Position in the table.
        index: usize,
        /// The weight given.
        weight: f32,
    },
    /// Nothing to draw.
    #[error("all {len} weights are 0")]
    AllZero {
        /// The number of weights given.
        len: usize,
    },
    /// An edge that is not finite, or not above the one before it.
    #[error("edge {index} is {edge}; edges must be finite, and each above the one before")]
    BadEdge {
        /// Position in the list of edges.
        index: usize,
        /// The edge given.
        edge: f32,
    },
    /// n bins have n + 1 edges.
    #[error("{counts} counts need {} edges, not {edges}", counts + 1)]
    EdgeCount {
        /// The number of edges given.
        edges: usize,
        /// The number of counts given.
        counts: usize,
    },
    /// A grid whose rows do not come out even.
    #[error("{len} values do not make rows of {width}")]
    BadShape {
        /// The number of values given.
        len: usize,
        /// The width given.
        width: usize,
    },
}

/// The sum of valid weights, in double precision.
fn checked_sum(weights: &[f32]) -> Result<f64, TableError> {
    if weights.is_empty() {
        return Err(TableError::Empty);
    }
    if let Some(index) = weights.iter().position(|w| !(*w >= 0.0 && w.is_finite())) {
        return Err(TableError::BadWeight { index, weight: weights[index] });
    }
    let sum: f64 = weights.iter().map(|&w| f64::from(w)).sum();
    if sum == 0.0 { Err(TableError::AllZero { len: weights.len() }) } else { Ok(sum) }
}
