//! The outcome of a test.

use std::fmt;

/// A statistic, how likely it is by chance, and what stands out.
#[derive(Clone, Debug, PartialEq)]
pub struct TestReport {
    /// The statistic: chi-square, t, z, or D of Kolmogorov and Smirnov.
    pub statistic: f64,
    /// Degrees of freedom; infinite for a z-test, the number of samples for Kolmogorov-Smirnov.
    pub dof: f64,
    /// The probability of a statistic at least this extreme if nothing is wrong. 0 if something is
    /// certainly wrong, such as a density that integrates to more than 1.
    pub p_value: f64,
    /// What a person should look at first: the worst cell, or what is certainly wrong.
    pub remark: String,
}

impl TestReport {
    /// A finding that no chance explains.
    pub(crate) fn impossible(remark: String) -> Self {
        Self { statistic: f64::INFINITY, dof: 0.0, p_value: 0.0, remark }
    }

    /// Is there no evidence against, at this level? A p-value that is not a number is not evidence for.
    pub fn passes(&self, level: f64) -> bool {
        self.p_value > level
    }
}

impl fmt::Display for TestReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { statistic, dof, p_value, remark } = self;
        write!(f, "p = {p_value:.3e} (statistic {statistic:.4}, {dof:.0} degrees of freedom)")?;
        if remark.is_empty() { Ok(()) } else { write!(f, "; {remark}") }
    }
}
