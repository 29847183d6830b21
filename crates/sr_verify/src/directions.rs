//! What must hold of every distribution of directions.

use sr_sampling::{Cursor, Distribution, Estimate, Independent, SampleId, SolidAngle, Uniforms};
use sr_stats::chi2::{self, Chi2Settings, Mass};
use sr_stats::{TestReport, z_test};

use crate::subject::Verdict;

/// Cells in z and azimuth.
pub const BINS: (usize, usize) = (16, 32);

/// How many samples tell the shape …
const SHAPE: u32 = 1 << 16;

/// … how many quadrature needs to know where the density is …
const PLACES: u32 = 1 << 14;

/// … and how many tell the mass that is drawn.
const MASS: u32 = 1 << 18;

/// Samples follow the density.
pub fn chi_square<D: Distribution<Measure = SolidAngle>>(
    distribution: &D,
    bins: (usize, usize),
    seed: u64,
) -> Verdict {
    Verdict::Chance(chi2::sphere(distribution, Chi2Settings { samples: SHAPE, bins, seed }))
}

/// ∫ pdf is the probability of a sample, to 0.1 %.
pub fn normalised<D: Distribution<Measure = SolidAngle>>(
    distribution: &D,
    bins: (usize, usize),
    seed: u64,
) -> Verdict {
    match chi2::mass_on_sphere(distribution, Chi2Settings { samples: PLACES, bins, seed }) {
        Err(report) => Verdict::Chance(report),
        Ok(Mass { integral, error, .. }) => {
            let drawn = drawn(distribution, seed);
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

/// The share of samples that are not `None`.
fn drawn<D: Distribution<Measure = SolidAngle>>(distribution: &D, seed: u64) -> Estimate {
    let sequence = Independent::new(!seed);
    let is_drawn = |index: &u32| {
        let mut cursor = Cursor::new(&sequence, SampleId { pixel: 0, index: *index });
        distribution.sample(D::Uniform::draw(&mut cursor)).is_some()
    };
    let n = f64::from(MASS);
    let share = (0..MASS).filter(is_drawn).count() as f64 / n;
    Estimate { mean: share, stderr: (share * (1.0 - share) / n).sqrt(), n: u64::from(MASS) }
}
