//! Integrals as the mean of f(X) / p(X), with an error that can be believed.
//!
//! - [`Technique`]: where points come from, and by what their f is multiplied: [`Single`] (one density), [`Combined`]
//!   (one of several, multiple importance sampling), [`Resampled`] (resampled importance sampling).
//! - [`Integrand`]: f, evaluated a block at a time.
//! - [`Plan`]: which points, and when to stop.
//! - [`integrate`]: rounds of points until the plan is fulfilled.
//! - [`Integral`]: mean, covariance and what was noticed on the way.
//!
//! Errors come from the samples if these are independent, and otherwise from independent replicates of the points,
//! never from the naive formula, which overstates (or, for some integrands, understates) them.

mod integral;
mod integrand;
mod lanes;
mod moments;
mod plan;
mod probe;
mod resampled;
mod rounds;
mod scale;
mod sums;
mod tail;
mod technique;

use thiserror::Error;

use crate::density::DensityError;

pub use integral::{ControlError, Integral};
pub use integrand::{Blocks, Integrand, Parallel};
pub use plan::{MAX_REPLICATES, Plan, PlanError};
pub use probe::{look_for_holes, look_past_target};
pub use resampled::{MAX_CANDIDATES, Resampled, Target};
pub(crate) use rounds::values_of;
pub use rounds::{OnRound, Progress, integrate};
pub(crate) use scale::{Exponent, exponent_of};
pub use tail::{Maxima, Tail};
pub use technique::{Combined, Control, Single, Technique, TechniqueError};

/// Why there is no integral.
#[derive(Debug, Error)]
pub enum IntegrateError {
    /// The plan asks for what cannot be.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A density failed.
    #[error(transparent)]
    Density(#[from] DensityError),
    /// The integrand failed, or progress was told to stop; the error is its owner's.
    #[error(transparent)]
    Foreign(Box<dyn std::error::Error + Send + Sync>),
    /// The integrand is infinite or not a number at a point.
    #[error("f returned {} at x = {}{}", number(*value), point(x), others(*count, *n))]
    NotFinite {
        /// The first such point.
        x: Vec<f64>,
        /// What f is there.
        value: f64,
        /// How many such points there are.
        count: u64,
        /// Among how many, which were evaluated so far.
        n: u64,
    },
    /// The density is 0 where the integrand is not.
    #[error(
        "over has density 0 at x = {}, where f is {}: samples never fall there, and the integral would miss it; \
         mix in a density that covers the domain",
        point(x),
        number(*value)
    )]
    Hole {
        /// The point.
        x: Vec<f64>,
        /// What f is there.
        value: f64,
    },
    /// The target of resampling is 0 where the integrand is not.
    #[error(
        "target is 0 at x = {}, where f is {}: such points are never chosen, and the integral would miss them; \
         add a constant to it",
        point(x),
        number(*value)
    )]
    TargetHole {
        /// The point.
        x: Vec<f64>,
        /// What f is there.
        value: f64,
    },
    /// A value that is finite only before it is divided by the density.
    #[error("f / p overflows at x = {}, where f is {} and the density {}", point(x), number(*value), number(*pdf))]
    Overflow {
        /// The point.
        x: Vec<f64>,
        /// What f is there.
        value: f64,
        /// The density there, or what takes its place.
        pdf: f64,
    },
    /// The integrand returned another number of values than before.
    #[error("f returned {found} values a point, and {expected} before")]
    Outputs {
        /// The number of values of earlier blocks.
        expected: usize,
        /// Those of this one.
        found: usize,
    },
}

/// A point as people write it: a number, or numbers in brackets.
pub(crate) fn point(x: &[f64]) -> String {
    match x {
        [x] => number(*x),
        x => format!("[{}]", x.iter().map(|x| number(*x)).collect::<Vec<_>>().join(", ")),
    }
}

/// A number as people write it: those with many zeros by their exponent.
pub(crate) fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() || (1e-5..1e16).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

fn others(count: u64, n: u64) -> String {
    if count > 1 { format!(", and at {} others of {n} points", count - 1) } else { String::new() }
}
