//! The one abstraction, at run time: a probability density that can be sampled and evaluated.

use std::error::Error;
use std::fmt;
use std::sync::Arc;

use thiserror::Error;

use crate::columns::{Columns, ColumnsMut};
use crate::distributions::ParameterError;
use crate::integrate::{number, point};
use crate::space::Space;

/// A density that could not do what it was asked for.
#[derive(Debug, Error)]
pub enum DensityError {
    /// A density that somebody else wrote failed; the error is theirs.
    #[error(transparent)]
    Foreign(Box<dyn Error + Send + Sync>),
    /// Something that must be 0 or more, and finite, is not.
    #[error("{what} is {} at x = {}; it must be finite and not negative", number(*value), point(x))]
    Improper {
        /// Whose value it is.
        what: String,
        /// The value.
        value: f64,
        /// Where.
        x: Vec<f64>,
    },
}

impl DensityError {
    /// Checks values that come from elsewhere: each must be 0, or positive and finite.
    ///
    /// - `counts`: of which points; others may have any value
    ///
    /// # Errors
    /// [`DensityError::Improper`] for the first that is not.
    pub fn check(
        what: &str,
        values: &[f64],
        x: Columns<'_>,
        counts: impl Fn(usize) -> bool,
    ) -> Result<(), Self> {
        let wrong = |&(i, value): &(usize, &f64)| !(*value >= 0.0 && value.is_finite()) && counts(i);
        match values.iter().enumerate().find(wrong) {
            Some((i, &value)) => Err(Self::Improper { what: what.into(), value, x: x.point(i) }),
            None => Ok(()),
        }
    }
}

/// A probability density over points of any number of coordinates, in double precision.
///
/// As with [`sr_sampling::Distribution`], uniforms are passed in, never drawn, and the density may integrate to less
/// than one: the rest is the probability that `sample` gives nothing. Blocks come in and go out, a column for each
/// coordinate. Densities are shared between threads, and are never changed.
pub trait Density: Send + Sync + fmt::Debug {
    /// What the density is a density of.
    fn space(&self) -> Space;

    /// How many uniforms in [0, 1) a sample consumes.
    fn uniforms(&self) -> usize;

    /// Draws a point from each row of `u`.
    ///
    /// - `u`: [`Density::uniforms`] columns of uniforms in [0, 1)
    /// - `x`: the points; as many columns as the space has coordinates
    /// - `pdf`: the density at each, positive and finite, or 0 where nothing is drawn, which contributes nothing; the
    ///   point may then be anything, also NaN. Whoever takes densities from elsewhere checks them
    ///   ([`DensityError::check`]), so that all others may rely on it
    ///
    /// # Errors
    /// Only those of densities that somebody else wrote.
    fn sample(&self, u: Columns<'_>, x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError>;

    /// The density at each point of `x`; 0 outside the support, also at infinity and at NaN.
    ///
    /// # Errors
    /// Only those of densities that somebody else wrote.
    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError>;

    /// The least box that holds the support, as (low, high) for each coordinate; infinite where it has no end.
    fn support(&self) -> Vec<[f64; 2]>;

    /// The box that an integrand over this density is expected to live on, if the density may be 0 within it:
    /// the range of a histogram, whose bins may be empty. An integral looks there for what the density misses.
    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        None
    }

    /// The expected point, if it is known and exists.
    fn mean(&self) -> Option<Vec<f64>> {
        None
    }

    /// `sample` run backwards, if that is possible.
    fn inverse(&self) -> Option<&dyn Inverse> {
        None
    }

    /// The distribution function, if the points are real numbers (or indices) and it is known.
    fn cumulative(&self) -> Option<&dyn Cumulative> {
        None
    }
}

/// A density whose `sample` can be run backwards.
pub trait Inverse {
    /// The uniforms that `sample` maps to each point; NaN outside the support.
    ///
    /// # Errors
    /// As [`Density::pdf`].
    fn invert(&self, x: Columns<'_>, u: ColumnsMut<'_>) -> Result<(), DensityError>;
}

/// The distribution function of a density on the line, and its inverse.
pub trait Cumulative {
    /// The probability of a value of at most `x`.
    fn cdf(&self, x: f64) -> f64;

    /// The value below which a share `u` in [0, 1] of the probability lies.
    fn icdf(&self, u: f64) -> f64;

    /// The probability of a value above `x`: 1 − cdf(x), with all its digits where that is small.
    fn above(&self, x: f64) -> f64 {
        1.0 - self.cdf(x)
    }

    /// The value above which a share `q` of the probability lies: icdf(1 − q), also for the smallest of q.
    fn inverse_above(&self, q: f64) -> f64 {
        self.icdf(1.0 - q)
    }

    /// This distribution cut to [low, high], if it has a form of its own for that, more exact than differences of
    /// probabilities. See [`truncate`](crate::distributions::truncate), which always has an answer.
    fn between(&self, low: f64, high: f64) -> Option<Result<Arc<dyn Density>, ParameterError>> {
        let _ = (low, high);
        None
    }
}
