//! Does every light, seen from a point, sample the density that it says it does?

use glam::Vec3;
use sr_render::Scene;
use sr_stats::chi2::{self, Chi2Settings};
use sr_stats::sidak;
use sr_testing::known_scenes;

/// The chance that this file raises a false alarm, had its seeds not been fixed.
const SUITE_FAILURE_RATE: f64 = 1e-3;

#[test]
fn samples_follow_their_densities() {
    // within the furnaces, above the floors
    let points = [Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.6, -0.4, 0.2), Vec3::new(0.8, 0.8, 0.4)];
    let scenes: Vec<_> =
        known_scenes().into_iter().map(|known| (known.name, Scene::compile(&known.desc).unwrap())).collect();
    let cases: Vec<_> = scenes
        .iter()
        .flat_map(|(name, scene)| {
            let one_by_one = scene.lights().extended_ids().map(Some);
            one_by_one.chain([None]).map(move |only| (name, scene, only))
        })
        .filter(|(_, scene, _)| scene.lights().extended_ids().next().is_some())
        .flat_map(|(name, scene, only)| points.map(|from| (name, scene, only, from)))
        .collect();
    assert!(cases.len() > 60, "only {} cases", cases.len());
    let level = sidak(SUITE_FAILURE_RATE, cases.len());
    let failures: Vec<String> = cases
        .iter()
        .zip(1..)
        .filter_map(|((name, scene, only, from), seed)| {
            let seen = scene.lights().seen_from(*from, *only);
            let report = chi2::sphere(&seen, Chi2Settings { samples: 1 << 16, bins: (16, 32), seed });
            (!report.passes(level)).then(|| format!("{name}, light {only:?} from {from}: {report}"))
        })
        .collect();
    assert!(failures.is_empty(), "{} of {} fail:\n{}", failures.len(), cases.len(), failures.join("\n"));
}
