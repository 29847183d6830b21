//! What must hold of every distribution of directions.

use sr_sampling::{Distribution, Estimate, SolidAngle};
use sr_stats::chi2::{self, Chi2Settings, Mass};
use sr_stats::{TestReport, z_test};

use crate::subject::Verdict;

/// How much work the test of shapes does …
const SHAPE: Chi2Settings = Chi2Settings { samples: 1 << 16, bins: (16, 32), seed: 0 };

/// … and that of the mass, where quadrature knows the density's well enough from fewer.
const MASS: Chi2Settings = Chi2Settings { samples: 1 << 14, ..SHAPE };

/// Samples follow the density.
pub fn chi_square<D: Distribution<Measure = SolidAngle>>(distribution: &D, seed: u64) -> Verdict {
    Verdict::Chance(chi2::sphere(distribution, Chi2Settings { seed, ..SHAPE }))
}

/// ∫ pdf is the probability of a sample, to 0.1 %.
pub fn normalised<D: Distribution<Measure = SolidAngle>>(distribution: &D, seed: u64) -> Verdict {
    match chi2::mass_on_sphere(distribution, Chi2Settings { seed, ..MASS }) {
        Err(report) => Verdict::Chance(report),
        Ok(Mass { integral, error, drawn }) => {
            // Half of the bar is left to quadrature, and as much as chance explains to counting.
            let slack = 5e-4 + 3.0 * error;
            let off = ((integral - drawn.mean).abs() - slack).max(0.0);
            Verdict::Chance(TestReport {
                remark: format!("the density integrates to {integral:.5}, and {drawn} of samples are drawn"),
                ..z_test(Estimate { mean: off, ..drawn }, 0.0)
            })
        }
    }
}
