//! Strategies that `steradian verify` leaves out (it runs the default, `bsdf`, `light`, and a mixture), on every scene
//! whose answer is known.
//!
//! The bar: bias below 0.1 % at 99 % confidence. Samples are taken until the 99 % confidence interval of the
//! mean is within ± 0.1 %; then a t-test against the answer must not reject. All t-tests together fail by
//! chance with probability 1 % (Šidák), were the seeds not fixed.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use sr_render::{Control, Film, RenderSettings, Scene, Strategy, render};
use sr_sampling::SequenceKind;
use sr_testing::known_scenes;

const STRATEGIES: [&str; 5] = [
    "mis(light, bsdf)", // the default in another order: the general tracer
    "uniform",
    "cosine",
    "mis(cosine, light, heuristic=balance)",
    "mis(0.5 uniform + 0.5 light, bsdf, light)",
];

const BIAS: f64 = 1e-3;
/// Eight replicates may agree better than they are right: where a density fits perfectly, rounding to `f32`
/// is left, and where a point set of n points picks among two lights, all may be off by the same 1 / n.
/// What is below a fiftieth of the bar is not told apart.
const RESOLUTION: f64 = BIAS / 50.0;
/// 99 % of Student's t with 7 degrees of freedom (8 replicates) lies within ± this.
const T_99: f64 = 3.499;

/// Mean and standard error of the one pixel.
fn estimate(scene: &Scene, strategy: &str, sampler: SequenceKind, spp: u32) -> (f64, f64) {
    let strategy: Strategy = strategy.parse().unwrap();
    let settings = RenderSettings { strategy, sampler, seed: 11, ..RenderSettings::from_scene(scene) };
    let mut film = Film::new(1, 1).unwrap();
    let cancel = AtomicBool::new(false);
    let control = Control { cancel: &cancel, deadline: None, on_pass: &|_, _| () };
    render(scene, &settings, 0..spp, &mut film, &control).unwrap();
    assert_eq!(film.rejected_samples(), 0, "NaN or infinity");
    let image = film.image();
    (f64::from(image.rgb[1]), f64::from(image.stderr[1]))
}

fn check(sampler: SequenceKind, first_spp: u32, most_spp: u32) {
    let scenes = known_scenes();
    assert!(scenes.len() >= 12, "no scenes, no evidence");
    let pairs: Vec<_> = scenes
        .iter()
        .flat_map(|known| STRATEGIES.map(|strategy| (known, strategy)))
        .filter(|(known, strategy)| known.found_by_chance || strategy.contains("light"))
        .collect();
    let level = sr_stats::sidak(0.01, pairs.len());
    // a film of one pixel is one task: the pairs run side by side
    pairs.into_par_iter().for_each(|(known, strategy)| {
        let scene = Scene::compile(&known.desc).unwrap();
        let answer = f64::from(known.radiance.y);
        // as many samples as it takes for an interval narrow enough to tell
        let mut spp = first_spp;
        let (mean, stderr) = loop {
            let (mean, stderr) = estimate(&scene, strategy, sampler, spp);
            if T_99 * stderr < BIAS * answer || spp >= most_spp {
                break (mean, stderr);
            }
            spp *= 4;
        };
        let report = format!(
            "{}, {strategy}, {sampler}: {mean} ± {stderr} after {spp} samples, expected {answer}",
            known.name
        );
        assert!(T_99 * stderr < BIAS * answer, "too noisy to tell: {report}");
        let t = (mean - answer).abs() / stderr.max(RESOLUTION * answer);
        assert!(sr_stats::student_beyond(t, 7.0) > level, "{report}");
    });
}

#[test]
fn sobol_points_find_every_known_answer() {
    check(SequenceKind::Sobol, 1 << 14, 1 << 24);
}

#[test]
fn a_wrong_answer_is_rejected() {
    let known = known_scenes().into_iter().find(|k| k.name.contains("triangle")).unwrap();
    let scene = Scene::compile(&known.desc).unwrap();
    let (mean, stderr) = estimate(&scene, "mis(bsdf, light)", SequenceKind::Sobol, 1 << 16);
    let wrong = 1.002 * f64::from(known.radiance.y);
    assert!((mean - wrong).abs() > 5.4 * stderr, "{mean} ± {stderr} cannot be told from {wrong}");
}
