//! What is wrong with a parameter: the error of every constructor here.

use thiserror::Error;

use crate::density::DensityError;
use crate::integrate::number;
use crate::space::Space;

/// A parameter that no distribution has. The text names the argument and the value.
#[derive(Debug, Error)]
pub enum ParameterError {
    /// A number that will not do.
    #[error("{argument} is {}; it must be {need}", number(*value))]
    Value {
        /// The name of the argument, with its place if it is one of a list.
        argument: String,
        /// The number given.
        value: f64,
        /// What it must be.
        need: &'static str,
    },
    /// Two ends of an interval that has no width, or too much.
    #[error(
        "{argument} = [{}, {}] is no interval; its ends must be finite, and the second above the first",
        number(*low),
        number(*high)
    )]
    Interval {
        /// The name of the pair.
        argument: String,
        /// The lower end given.
        low: f64,
        /// The upper end given.
        high: f64,
    },
    /// Two ends between which there is nothing.
    #[error(
        "{argument} = [{}, {}] is no interval; the second end must be above the first, and either may be infinite",
        number(*low),
        number(*high)
    )]
    Cut {
        /// The name of the pair.
        argument: &'static str,
        /// The lower end given.
        low: f64,
        /// The upper end given.
        high: f64,
    },
    /// A list that is too short or too long.
    #[error("{argument} has {len} entries; it must have {need}")]
    Length {
        /// The name of the list.
        argument: &'static str,
        /// Its length.
        len: usize,
        /// The lengths that will do.
        need: String,
    },
    /// Weights, counts or values that leave nothing to draw.
    #[error("the {len} {argument} are all 0; at least one must be positive")]
    AllZero {
        /// The name of the list.
        argument: &'static str,
        /// Its length.
        len: usize,
    },
    /// Weights of a mixture that are not probabilities.
    #[error("weights sum to {sum}; they must sum to 1")]
    Sum {
        /// The sum found.
        sum: f64,
    },
    /// Densities that cannot be put together, or cannot be treated so.
    #[error("{argument} is a density of {space}; it must be one of {need}")]
    WrongSpace {
        /// The name of the argument, with its place if it is one of a list.
        argument: String,
        /// Its space.
        space: Space,
        /// The spaces that will do.
        need: String,
    },
    /// A density of which more must be known.
    #[error("{argument} has no {what}")]
    Missing {
        /// The name of the argument.
        argument: &'static str,
        /// What it lacks.
        what: &'static str,
    },
    /// A part of a distribution of which nothing is ever drawn.
    #[error(
        "{argument} = [{}, {}] holds nothing: the distribution lies elsewhere, or has a probability there that is too \
         small for a number",
        number(*low),
        number(*high)
    )]
    Nothing {
        /// The name of the pair.
        argument: &'static str,
        /// The lower end given.
        low: f64,
        /// The upper end given.
        high: f64,
    },
    /// A density that cannot be tabulated as closely as was asked for.
    #[error(
        "the density is not resolved near {}: its error is {error:.1e} of the whole, and the tolerance \
         {tolerance:.1e}",
        number(*near)
    )]
    Unresolved {
        /// Where most of the error is.
        near: f64,
        /// What was reached.
        error: f64,
        /// What was asked for.
        tolerance: f64,
    },
    /// A shape without the area or the volume that it should have.
    #[error("{argument} {what}")]
    Shape {
        /// The name of the argument.
        argument: &'static str,
        /// What is wrong with it, and the value.
        what: String,
    },
    /// A density that somebody else wrote failed.
    #[error(transparent)]
    Density(#[from] DensityError),
}

/// A number that will not do.
pub(crate) fn bad(argument: impl Into<String>, value: f64, need: &'static str) -> ParameterError {
    ParameterError::Value { argument: argument.into(), value, need }
}

/// `value`, if it is finite.
pub(crate) fn finite(argument: &str, value: f64) -> Result<f64, ParameterError> {
    if value.is_finite() { Ok(value) } else { Err(bad(argument, value, "finite")) }
}

/// `value`, if it is positive and so is its inverse, both in full precision.
pub(crate) fn positive(argument: &str, value: f64) -> Result<f64, ParameterError> {
    let fine = value > 0.0 && value.is_normal() && value.recip().is_normal();
    if fine {
        Ok(value)
    } else {
        Err(bad(argument, value, "positive and finite, and so must be its inverse"))
    }
}

/// The width of [low, high], if it and its inverse are positive and finite.
pub(crate) fn width(argument: &str, low: f64, high: f64) -> Result<f64, ParameterError> {
    let width = high - low;
    if low.is_finite() && high.is_finite() && width > 0.0 && width.is_finite() && width.recip().is_finite() {
        Ok(width)
    } else {
        Err(ParameterError::Interval { argument: argument.into(), low, high })
    }
}

/// The sum of a list of numbers, of which none may be negative and one must be positive.
pub(crate) fn checked_sum(argument: &'static str, values: &[f64]) -> Result<f64, ParameterError> {
    if values.is_empty() {
        return Err(ParameterError::Length { argument, len: 0, need: "at least 1".into() });
    }
    for (i, &value) in values.iter().enumerate() {
        if !(value >= 0.0 && value.is_finite()) {
            return Err(bad(format!("{argument}[{i}]"), value, "finite and not negative"));
        }
    }
    let sum: f64 = values.iter().sum();
    match sum {
        0.0 => Err(ParameterError::AllZero { argument, len: values.len() }),
        sum if sum.is_finite() && sum.is_normal() => Ok(sum),
        sum => Err(bad(format!("the sum of {argument}"), sum, "finite, and not below 2.2e-308")),
    }
}
