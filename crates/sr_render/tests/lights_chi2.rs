//! Does every light, seen from a point, sample the density that it says it does?

use glam::Vec3;
use sr_render::Scene;
use sr_render::light::LightId;
use sr_scene::{LightDesc, SceneDesc};
use sr_stats::chi2::{self, Chi2Settings};
use sr_stats::sidak;
use sr_testing::light_scenes;

/// The chance that this file raises a false alarm, had its seeds not been fixed.
const SUITE_FAILURE_RATE: f64 = 1e-3;

/// Within the furnaces, above the floors.
const POINTS: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.6, -0.4, 0.2), Vec3::new(0.8, 0.8, 0.4)];

/// Is there a light from a table? To integrate over its jumps takes long: fewer bins do for it.
fn has_table(desc: &SceneDesc) -> bool {
    desc.lights.iter().any(|light| matches!(light, LightDesc::Environment { .. } | LightDesc::Sky { .. }))
}

/// Is the density the same from all points?
fn is_far(desc: &SceneDesc) -> bool {
    let has_portal =
        |light: &LightDesc| matches!(light, LightDesc::Environment { portals, .. } if !portals.is_empty());
    desc.shapes.iter().all(|shape| shape.emission.is_none()) && !desc.lights.iter().any(has_portal)
}

/// All lights together, and if there are several, each of them.
fn choices(scene: &Scene) -> Vec<Option<LightId>> {
    let one_by_one: Vec<_> = scene.lights().extended_ids().map(Some).collect();
    match one_by_one.len() {
        0 => Vec::new(),
        1 => vec![None],
        _ => one_by_one.into_iter().chain([None]).collect(),
    }
}

#[test]
fn samples_follow_their_densities() {
    let scenes: Vec<_> = light_scenes()
        .into_iter()
        .map(|(name, desc)| {
            let points = if is_far(&desc) { 1 } else { POINTS.len() };
            let bins = if has_table(&desc) { (8, 16) } else { (16, 32) };
            (name, Scene::compile(&desc).unwrap(), points, bins)
        })
        .collect();
    let cases: Vec<_> = scenes
        .iter()
        .flat_map(|(name, scene, points, bins)| {
            let from = &POINTS[..*points];
            let choices = choices(scene).into_iter();
            choices.flat_map(move |only| from.iter().map(move |&p| (name, scene, bins, only, p)))
        })
        .collect();
    assert!(cases.len() > 90, "only {} cases", cases.len());
    let level = sidak(SUITE_FAILURE_RATE, cases.len());
    let failures: Vec<String> = cases
        .iter()
        .zip(1..)
        .filter_map(|((name, scene, bins, only, from), seed)| {
            let seen = scene.lights().seen_from(*from, *only);
            let report = chi2::sphere(&seen, Chi2Settings { samples: 1 << 16, bins: **bins, seed });
            (!report.passes(level)).then(|| format!("{name}, light {only:?} from {from}: {report}"))
        })
        .collect();
    assert!(failures.is_empty(), "{} of {} fail:\n{}", failures.len(), cases.len(), failures.join("\n"));
}
