//! Does every scattering model sample the density that it says it does?

use glam::{Vec2, Vec3};
use sr_bsdf::{AnyBsdf, Bsdf};
use sr_sampling::{Independent, SampleId, Sequence};
use sr_stats::chi2::{self, Chi2Settings};
use sr_stats::sidak;
use sr_testing::bsdf_cases;

/// The chance that this file raises a false alarm, had its seeds not been fixed.
const SUITE_FAILURE_RATE: f64 = 1e-3;

#[test]
fn samples_follow_their_densities() {
    let cases: Vec<_> = bsdf_cases().into_iter().filter(|(_, bsdf, wo)| scatters(bsdf, *wo)).collect();
    assert!(cases.len() > 250, "only {} cases", cases.len());
    let level = sidak(SUITE_FAILURE_RATE, cases.len());
    let failures: Vec<String> = cases
        .iter()
        .zip(1..)
        .filter_map(|((name, bsdf, wo), seed)| {
            let settings = Chi2Settings { samples: 1 << 16, bins: (16, 32), seed };
            let report = chi2::sphere(&bsdf.given(*wo), settings);
            (!report.passes(level)).then(|| format!("{name}: {report}"))
        })
        .collect();
    assert!(failures.is_empty(), "{} of {} fail:\n{}", failures.len(), cases.len(), failures.join("\n"));
}

/// Does anything but a delta lobe answer to this direction?
fn scatters(bsdf: &AnyBsdf, wo: Vec3) -> bool {
    let sequence = Independent::new(5);
    (0..100).map(|index| SampleId { pixel: 0, index }).any(|at| {
        let (u_lobe, u): (f32, Vec2) = (sequence.get_1d(at, 0), sequence.get_2d(at, 1));
        bsdf.sample(wo, u_lobe, u).is_some_and(|s| !s.delta)
    })
}
