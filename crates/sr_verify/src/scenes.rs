//! Whole renders whose answer is known in closed form: furnaces, Lambert's formula, spheres.
//!
//! Samples are taken until the 99 % confidence interval is within ± 0.1 %; then a t-test against the answer must not
//! reject.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sr_render::{Control, Film, RenderSettings, Scene, render};
use sr_stats::{TestReport, student_beyond};
use sr_testing::known_scenes;

use crate::subject::{Group, Subject, Verdict};

const BIAS: f64 = 1e-3;
/// Eight replicates may agree better than they are right: where a density fits perfectly, rounding to `f32` is left. What
/// is below a fiftieth of the bar is not told apart.
const RESOLUTION: f64 = BIAS / 50.0;
/// Where n points pick among lights, all replicates may be off by the same 1 / n: so many samples make that small.
const MANY: u32 = 1 << 20;
/// 99 % of Student's t with 7 degrees of freedom (8 replicates) lies within ± this.
const T_99: f64 = 3.499;

const STRATEGIES: [&str; 4] = ["mis(bsdf, light)", "bsdf", "light", "0.5 cosine + 0.5 light"];

pub fn subjects() -> Vec<Subject> {
    let mut all = Vec::new();
    for known in known_scenes() {
        let scene = Arc::new(Scene::compile(&known.desc).expect("scenes with known answers compile"));
        let answer = f64::from(known.radiance.y);
        for strategy in STRATEGIES {
            let converges = known.light_alone_converges || strategy != "light";
            if !converges || !known.found_by_chance && !strategy.contains("light") {
                continue;
            }
            let scene = Arc::clone(&scene);
            let subject = Subject::new(Group::Scene, format!("{}: {strategy}", known.name));
            all.push(subject.check("known answer", move |seed| answers(&scene, strategy, answer, seed)));
        }
    }
    all
}

fn answers(scene: &Scene, strategy: &str, answer: f64, seed: u64) -> Verdict {
    let strategy = strategy.parse().expect("a strategy");
    let settings = RenderSettings { strategy, seed, ..RenderSettings::from_scene(scene) };
    let mut spp = if scene.lights().count() > 1 { MANY } else { 1 << 14 };
    loop {
        let mut film = match Film::new(1, 1) {
            Ok(film) => film,
            Err(error) => return Verdict::Fails(error.to_string()),
        };
        let cancel = AtomicBool::new(false);
        let control = Control { cancel: &cancel, deadline: None, on_pass: &|_, _| () };
        if let Err(error) = render(scene, &settings, 0..spp, &mut film, &control) {
            return Verdict::Fails(error.to_string());
        }
        if film.rejected_samples() > 0 {
            return Verdict::Fails(format!("{} samples are NaN or infinite", film.rejected_samples()));
        }
        let image = film.image();
        let (mean, stderr) = (f64::from(image.rgb[1]), f64::from(image.stderr[1]));
        let remark = format!("{mean} ± {stderr} after {spp} samples, expected {answer}");
        if T_99 * stderr < BIAS * answer {
            let t = (mean - answer).abs() / stderr.max(RESOLUTION * answer);
            return Verdict::Chance(TestReport {
                statistic: t,
                dof: 7.0,
                p_value: student_beyond(t, 7.0),
                remark,
            });
        }
        if spp >= 1 << 24 {
            return Verdict::Fails(format!("too noisy to tell: {remark}"));
        }
        spp *= 4;
    }
}
