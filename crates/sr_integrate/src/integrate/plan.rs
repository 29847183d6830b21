//! Which points an integral takes, and when it has enough of them.

use thiserror::Error;

use crate::points::{Points, Sequence};

/// The most replicates.
pub const MAX_REPLICATES: u32 = 1 << 16;

/// Which points, and when to stop: at whichever limit is met first.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The kind of points.
    pub sequence: Sequence,
    /// Independent randomisations, from whose spread the error is known. At least 2.
    pub replicates: u32,
    /// Different seeds give unrelated points.
    pub seed: u64,
    /// At most so many evaluations; rounded up to a whole number for each replicate and technique, and to at least two
    /// independent points for each technique. [`Plan::CAP`] if only tolerances are given.
    pub n: Option<u64>,
    /// Enough if the standard error is at most this times the mean, without its sign …
    pub rtol: f64,
    /// … or at most this, for every output. Both 0: tolerances stop nothing.
    pub atol: f64,
    /// No new round begins after so many seconds.
    pub seconds: Option<f64>,
    /// About how many points are evaluated at a time.
    pub batch: usize,
    /// What to do where f is infinite or not a number: count it as 0, or fail.
    pub nan_as_zero: bool,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            sequence: Sequence::Sobol,
            replicates: 32,
            seed: 0,
            n: None,
            rtol: 0.0,
            atol: 0.0,
            seconds: None,
            batch: 1 << 14,
            nan_as_zero: false,
        }
    }
}

/// Why a plan is none.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlanError {
    /// No evaluation, or more than there are points.
    #[error("n is {n}; it must be from 2 to {limit}")]
    N {
        /// The number given.
        n: u64,
        /// The most possible.
        limit: u64,
    },
    /// Fewer than two replicates have no spread.
    #[error("replicates is {replicates}; it must be from 2 to {MAX_REPLICATES}")]
    Replicates {
        /// The number given.
        replicates: u32,
    },
    /// A tolerance that is negative, infinite or NaN.
    #[error("{name} is {value}; it must be finite and not negative")]
    Tolerance {
        /// `rtol` or `atol`.
        name: &'static str,
        /// The number given.
        value: f64,
    },
    /// A time that is not positive, or has no end.
    #[error("seconds is {0}; it must be positive and finite")]
    Seconds(f64),
    /// A batch of no points, or too many.
    #[error("batch is {0}; it must be from 1 to 2^26")]
    Batch(usize),
    /// Nothing would end it.
    #[error("one of n, rtol, atol and seconds must say when to stop")]
    Endless,
}

impl Plan {
    /// How many evaluations there are if nobody says.
    pub const DEFAULT_N: u64 = 1 << 16;

    /// At most so many evaluations if tolerances alone say when to stop: an integral of 0 never meets a relative one.
    pub const CAP: u64 = 1 << 26;

    /// Evaluations before a tolerance is looked at for the first time.
    pub(crate) const FIRST_LOOK: u64 = 1 << 13;

    /// Is there a tolerance?
    pub(crate) fn has_tolerance(&self) -> bool {
        self.rtol > 0.0 || self.atol > 0.0
    }

    /// The most evaluations, if anything says so.
    pub(crate) fn most(&self) -> Option<u64> {
        self.n.or(self.seconds.is_none().then_some(Self::CAP))
    }

    /// The most evaluations that replicates of `shares` points each can have.
    pub(crate) fn limit(&self) -> u64 {
        Points::MAX_LEN.saturating_mul(u64::from(self.replicates))
    }

    /// # Errors
    /// If a number makes no sense, or nothing would end the integration.
    pub fn check(&self) -> Result<(), PlanError> {
        if !(2..=MAX_REPLICATES).contains(&self.replicates) {
            return Err(PlanError::Replicates { replicates: self.replicates });
        }
        if let Some(n) = self.n.filter(|n| !(2..=self.limit()).contains(n)) {
            return Err(PlanError::N { n, limit: self.limit() });
        }
        for (name, value) in [("rtol", self.rtol), ("atol", self.atol)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(PlanError::Tolerance { name, value });
            }
        }
        if let Some(seconds) = self.seconds.filter(|seconds| !(*seconds > 0.0 && seconds.is_finite())) {
            return Err(PlanError::Seconds(seconds));
        }
        if !(1..=1 << 26).contains(&self.batch) {
            return Err(PlanError::Batch(self.batch));
        }
        if self.n.is_none() && self.seconds.is_none() && !self.has_tolerance() {
            return Err(PlanError::Endless);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_argument_and_the_value() {
        let plan = || Plan { n: Some(100), ..Plan::default() };
        assert_eq!(plan().check(), Ok(()));
        let says = |plan: Plan| plan.check().unwrap_err().to_string();
        assert!(says(Plan { n: Some(1), ..plan() }).starts_with("n is 1;"));
        assert!(says(Plan { replicates: 1, ..plan() }).starts_with("replicates is 1;"));
        assert!(says(Plan { rtol: -0.1, ..plan() }).starts_with("rtol is -0.1;"));
        assert!(says(Plan { atol: f64::NAN, ..plan() }).starts_with("atol is NaN;"));
        assert!(says(Plan { seconds: Some(0.0), ..plan() }).starts_with("seconds is 0;"));
        assert!(says(Plan { seconds: Some(f64::INFINITY), ..plan() }).starts_with("seconds is inf;"));
        assert!(says(Plan { batch: 0, ..plan() }).starts_with("batch is 0;"));
        assert_eq!(Plan::default().check(), Err(PlanError::Endless));
    }
}
