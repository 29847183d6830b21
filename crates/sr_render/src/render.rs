//! Rendering: samples of all pixels, in passes, into a film.
//!
//! In: a scene, settings and a range of samples. Out: a fuller [`Film`]. A pass is one block of the film
//! (see [`crate::film`]); between passes the caller is told how far it is and may stop.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use sr_sampling::{Independent, OwenSobol, Sequence, SequenceKind};
use sr_scene::Settings;

use crate::film::{Film, FilmError, REPLICATES, next_block};
use crate::integrator::{Integrator, PathLimits, PathTracer, StrategyTracer};
use crate::pass::Sampler;
use crate::scene::Scene;
use crate::strategy::Strategy;

/// How to render.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// Pixels across the image: the film, or its crop.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Longest path in edges: 1 emitters only, 2 direct light; `None` is unbounded.
    pub max_depth: Option<u32>,
    /// Edges before Russian roulette may end a path; `None` does not play it before the 1024th
    /// ([`crate::integrator::LATEST_ROULETTE`]).
    pub roulette_depth: Option<u32>,
    /// Are lights black where the camera sees them directly?
    pub hide_emitters: bool,
    /// How directions are chosen.
    pub strategy: Strategy,
    /// Where the uniforms come from.
    pub sampler: SequenceKind,
    /// Another seed is another, independent image.
    pub seed: u64,
}

impl RenderSettings {
    /// What the scene file asks for, with the default strategy and sampler.
    pub fn from_scene(scene: &Scene) -> Self {
        let Settings { max_depth, roulette_depth, hide_emitters, .. } = *scene.settings();
        let (width, height) = scene.camera().film.image_size();
        Self {
            width,
            height,
            max_depth,
            roulette_depth,
            hide_emitters,
            strategy: Strategy::default(),
            sampler: SequenceKind::Sobol,
            seed: 0,
        }
    }
}

/// The caller's hold on a running render.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Set it to stop soon; the pass under way, a few seconds at most, is then dropped.
    pub cancel: &'a AtomicBool,
    /// No pass is begun that is not expected to end by then, except the first.
    pub deadline: Option<Instant>,
    /// Called after each pass, with the film so far.
    pub on_pass: &'a (dyn Fn(&PassReport, &Film) + Sync),
}

/// How far a render is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassReport {
    /// Samples per pixel taken by this call.
    pub samples_done: u32,
    /// Samples per pixel asked of this call.
    pub samples_total: u32,
    /// Time spent on them.
    pub elapsed: Duration,
}

/// Why a render ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// All samples are in.
    Complete,
    /// The caller cancelled.
    Cancelled,
    /// The deadline came.
    Deadline,
}

/// A pass should take about this long: short enough to stop between, long enough to keep all threads busy.
const PASS: Duration = Duration::from_millis(400);

/// A pass may take up to this long to give each replicate a sample: shorter ones sum mostly zeros.
const LONG_PASS: Duration = Duration::from_secs(4);

/// Takes the samples `samples` of every pixel into `film`, on rayon's current pool.
///
/// The result depends on the scene, the settings and the samples in the film alone: not on threads, passes,
/// or the order of calls.
///
/// # Errors
/// If the film has another size than the settings, has some of the samples already, or memory is short.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    samples: Range<u32>,
    film: &mut Film,
    control: &Control<'_>,
) -> Result<Stop, FilmError> {
    let size = (settings.width, settings.height);
    if film.size() != size {
        return Err(FilmError::SizesDiffer(film.size(), size));
    }
    let limits = PathLimits {
        max_depth: settings.max_depth.unwrap_or(u32::MAX),
        roulette_depth: settings.roulette_depth.unwrap_or(u32::MAX),
        hide_emitters: settings.hide_emitters,
    };
    if settings.strategy == Strategy::default() {
        with_sequence(scene, settings, &PathTracer { limits }, samples, film, control)
    } else {
        let tracer = StrategyTracer { limits, strategy: settings.strategy.clone() };
        with_sequence(scene, settings, &tracer, samples, film, control)
    }
}

fn with_sequence<I: Integrator>(
    scene: &Scene,
    settings: &RenderSettings,
    integrator: &I,
    samples: Range<u32>,
    film: &mut Film,
    control: &Control<'_>,
) -> Result<Stop, FilmError> {
    match settings.sampler {
        SequenceKind::Independent => {
            let sampler = Sampler::new(scene, settings, integrator, &Independent::new(settings.seed));
            passes(&sampler, samples, film, control)
        }
        SequenceKind::Sobol => {
            let sampler = Sampler::new(scene, settings, integrator, &OwenSobol::new(settings.seed));
            passes(&sampler, samples, film, control)
        }
    }
}

fn passes<I: Integrator, Q: Sequence>(
    sampler: &Sampler<'_, I, Q>,
    samples: Range<u32>,
    film: &mut Film,
    control: &Control<'_>,
) -> Result<Stop, FilmError> {
    let start = Instant::now();
    let (mut left, mut cap) = (samples.clone(), 1);
    // seconds per sample, from the last pass
    let mut cost: Option<f64> = None;
    while !left.is_empty() {
        if control.cancel.load(Ordering::Relaxed) {
            return Ok(Stop::Cancelled);
        }
        if let (Some(deadline), Some(cost)) = (control.deadline, cost) {
            let affordable = deadline.saturating_duration_since(Instant::now()).as_secs_f64() / cost;
            if affordable < 1.0 {
                return Ok(Stop::Deadline);
            }
            cap = cap.min(affordable.min(f64::from(u32::MAX)) as u32);
        }
        let len = next_block(&left, cap);
        let began = Instant::now();
        let mut sums = film.new_sums()?;
        let Some(rejected) = sampler.pass(left.start, len, &mut sums, control.cancel) else {
            return Ok(Stop::Cancelled);
        };
        film.push(left.start, sums, len, rejected)?;
        let seconds = began.elapsed().as_secs_f64().max(1e-9) / f64::from(len);
        cost = Some(seconds);
        let samples_in =
            |time: Duration| (time.as_secs_f64() / seconds).clamp(1.0, f64::from(1 << 30)) as u32;
        cap = samples_in(PASS).max(samples_in(LONG_PASS).min(REPLICATES as u32));
        left.start += len;
        let report = PassReport {
            samples_done: left.start - samples.start,
            samples_total: samples.end - samples.start,
            elapsed: start.elapsed(),
        };
        (control.on_pass)(&report, film);
    }
    Ok(Stop::Complete)
}
