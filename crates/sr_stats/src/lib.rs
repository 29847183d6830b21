//! Is this sampler right, is this mean right, are these two the same?
//!
//! In: a distribution, or numbers. Out: a [`TestReport`] with a p-value, and words for a person. The
//! p-value is the probability of data at least this odd if nothing is wrong, so a test that fails
//! below `level` raises a false alarm with probability `level`; over many tests, see [`sidak`].
//!
//! - [`chi2`]: do the samples of a distribution follow its density? On the sphere, the line, the
//!   plane, a parallelogram, or a list; in any number of dimensions: [`chi2::blocks`].
//! - [`t_test`], [`welch`], [`z_test`], [`z_test_pair`]: means.
//! - [`ks`]: one-dimensional samples against a cumulative distribution.

pub mod chi2;
mod ks;
mod means;
mod report;
mod tails;

pub use chi2::Chi2Settings;
pub use ks::ks;
pub use means::{t_test, welch, z_test, z_test_pair};
pub use report::TestReport;
pub use tails::{normal_beyond, student_beyond, student_t_quantile};

/// The level for each of `tests` independent tests, such that the chance of any false alarm is `level`.
///
/// 1 − (1 − level)^(1/n) (Šidák 1967). Safe as well if the tests are positively correlated.
pub fn sidak(level: f64, tests: usize) -> f64 {
    -((-level).ln_1p() / tests as f64).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sidak_restores_the_level_of_the_family() {
        assert_eq!(sidak(0.01, 1), 0.01);
        for tests in [2, 100, 1_000_000] {
            let family = 1.0 - (1.0 - sidak(0.01, tests)).powi(tests as i32);
            assert!((family - 0.01).abs() < 1e-9, "{tests}: {family}");
        }
    }
}
