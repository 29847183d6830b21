//! Rendering: samples of all pixels, in passes, into a film.
//!
//! In: a scene, settings and a range of samples. Out: a fuller [`Film`]. A pass is one block of the film
//! (see [`crate::film`]); between passes the caller is told how far it is and may stop.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use glam::Vec2;
use rayon::prelude::*;
use sr_geometry::{BATCH, Vec2s};
use sr_sampling::{Independent, OwenSobol, Sequence, SequenceKind};
use sr_scene::Settings;

use crate::camera::Camera;
use crate::film::{AUX, Film, FilmError, PixelSums, REPLICATES, SUMS, next_block};
use crate::filter::PixelFilter;
use crate::integrator::{CameraRays, Integrator, PathLimits, PathSample, PathTracer, StrategyTracer};
use crate::isa::{Isa, Work};
use crate::scene::Scene;
use crate::strategy::Strategy;

/// How to render.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Longest path in edges: 1 emitters only, 2 direct light; `None` is unbounded.
    pub max_depth: Option<u32>,
    /// Edges before Russian roulette may end a path; `None` never plays it.
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
        let film = &scene.camera().film;
        Self {
            width: film.width,
            height: film.height,
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

/// Pixels that one task renders.
const PIXELS_PER_TASK: usize = 64;

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

/// Everything that a sample needs.
struct Sampler<'a, I, Q> {
    scene: &'a Scene,
    integrator: &'a I,
    camera: Camera,
    filter: PixelFilter,
    sample_border: bool,
    width: u32,
    height: u32,
    /// One independent sequence per replicate.
    sequences: [Q; REPLICATES],
    isa: Isa,
}

impl<'a, I: Integrator, Q: Sequence> Sampler<'a, I, Q> {
    fn new(scene: &'a Scene, settings: &RenderSettings, integrator: &'a I, sequence: &Q) -> Self {
        Self {
            scene,
            integrator,
            camera: Camera::new(&scene.camera, settings.width, settings.height),
            filter: PixelFilter::new(scene.camera.film.filter),
            sample_border: scene.camera.film.sample_border,
            width: settings.width,
            height: settings.height,
            sequences: std::array::from_fn(|r| sequence.replicate(r as u32)),
            isa: Isa::detect(),
        }
    }

    /// Samples `first .. first + len` of every pixel. Returns how many were not finite; `None` if cancelled.
    fn pass(&self, first: u32, len: u32, sums: &mut [PixelSums], cancel: &AtomicBool) -> Option<u64> {
        let rejected = AtomicU64::new(0);
        let pixels_per_task = PIXELS_PER_TASK.max(BATCH / len as usize);
        sums.par_chunks_mut(pixels_per_task).enumerate().for_each_init(
            || Desk::new(self),
            |desk, (task, sums)| {
                let first_pixel = (task * pixels_per_task) as u32;
                let tile = Tile { sampler: self, desk, first_pixel, first, len, sums, cancel };
                rejected.fetch_add(self.isa.run(tile), Ordering::Relaxed);
            },
        );
        (!cancel.load(Ordering::Relaxed)).then(|| rejected.into_inner())
    }

    /// Makes the camera rays of samples `start .. start + per_pixel` of `pixels`.
    #[inline(always)]
    fn camera_rays(&self, rays: &mut CameraRays<Q>, pixels: Range<u32>, start: u32, per_pixel: u32) {
        let mut film = Vec2s::splat(Vec2::ZERO);
        let mut i = 0;
        for pixel in pixels {
            for sample in start..start + per_pixel {
                rays.pixel[i] = pixel;
                rays.index[i] = sample / REPLICATES as u32;
                rays.sequence[i] = self.sequences[sample as usize % REPLICATES];
                i += 1;
            }
        }
        rays.count = i;
        let count = i.min(BATCH);
        for i in 0..count {
            film.set(i, rays.cursor(i).next_2d());
        }
        let mut i = 0;
        while i < count {
            let window = self.window(rays.pixel[i]);
            for _ in 0..per_pixel {
                film.set(i, window.place(&self.filter, film.get(i)));
                i += 1;
            }
        }
        let size = Vec2::new(self.width as f32, self.height as f32);
        if self.camera.has_lens() {
            for i in 0..count {
                let u_lens = rays.cursor(i).at(2).next_2d();
                rays.rays.set(i, &self.camera.ray(film.get(i) / size, u_lens));
            }
        } else {
            for i in 0..count {
                rays.rays.set(i, &self.camera.ray(film.get(i) / size, Vec2::ZERO));
            }
        }
    }

    fn window(&self, pixel: u32) -> FilterWindow {
        let (x, y) = (pixel % self.width, pixel / self.width);
        let inside = |index, count| match self.sample_border {
            true => (0.0, 1.0),
            false => self.filter.inside(index, count),
        };
        let ((x0, x1), (y0, y1)) = (inside(x, self.width), inside(y, self.height));
        FilterWindow {
            centre: Vec2::new(x as f32 + 0.5, y as f32 + 0.5),
            low: Vec2::new(x0, y0),
            span: Vec2::new(x1 - x0, y1 - y0),
        }
    }
}

/// Memory for a batch of samples, which one task after the other uses.
struct Desk<I: Integrator, Q: Sequence> {
    rays: Box<CameraRays<Q>>,
    workspace: I::Workspace<Q>,
    samples: Box<[PathSample; BATCH]>,
    tree: PairwiseSum,
}

impl<I: Integrator, Q: Sequence> Desk<I, Q> {
    fn new(sampler: &Sampler<'_, I, Q>) -> Self {
        let sequence = sampler.sequences[0];
        Self {
            rays: Box::new(CameraRays::none(sequence)),
            workspace: sampler.integrator.workspace(sequence),
            samples: Box::new([PathSample::default(); BATCH]),
            tree: PairwiseSum::new(),
        }
    }
}

/// A few neighbouring pixels of a pass.
struct Tile<'a, I: Integrator, Q: Sequence> {
    sampler: &'a Sampler<'a, I, Q>,
    desk: &'a mut Desk<I, Q>,
    first_pixel: u32,
    first: u32,
    len: u32,
    sums: &'a mut [PixelSums],
    cancel: &'a AtomicBool,
}

impl<I: Integrator, Q: Sequence> Work for Tile<'_, I, Q> {
    /// How many samples were not finite.
    type Out = u64;

    /// A batch holds all samples of some pixels, or some of one.
    #[inline(always)]
    fn run(self) -> u64 {
        let Self { sampler, desk, first_pixel, first, len, sums, cancel } = self;
        let Desk { rays, workspace, samples, tree } = desk;
        let per_pixel = len.min(BATCH as u32);
        let mut rejected = 0;
        let pixels_per_batch = BATCH / per_pixel as usize;
        for (chunk, sums) in sums.chunks_mut(pixels_per_batch).enumerate() {
            let at = first_pixel + (chunk * pixels_per_batch) as u32;
            for start in (first..first + len).step_by(per_pixel as usize) {
                if cancel.load(Ordering::Relaxed) {
                    // Half a sum may be left in the tree, but nothing more is added to it.
                    return rejected;
                }
                sampler.camera_rays(rays, at..at + sums.len() as u32, start, per_pixel);
                sampler.integrator.trace(sampler.scene, rays, workspace, samples);
                for (samples, sums) in samples[..rays.count].chunks(per_pixel as usize).zip(&mut *sums) {
                    rejected += add_samples(samples, start, tree);
                    if start + per_pixel == first + len {
                        *sums = tree.take_total();
                    }
                }
            }
        }
        rejected
    }
}

/// Adds samples of one pixel, from sample `start` on, to a sum: groups of one sample for each replicate.
/// Returns how many were not finite.
#[inline(always)]
fn add_samples(samples: &[PathSample], start: u32, tree: &mut PairwiseSum) -> u64 {
    let mut rejected = 0;
    for (group, samples) in samples.chunks(REPLICATES).enumerate() {
        let mut leaf = [0.0; SUMS];
        let mut aux = [[0.0; AUX]; REPLICATES];
        for (i, sample) in samples.iter().enumerate() {
            let replicate = (start as usize + group * REPLICATES + i) % REPLICATES;
            if sample.li.is_finite() {
                leaf[3 * replicate..3 * replicate + 3].copy_from_slice(&sample.li.to_array());
            } else {
                rejected += 1;
            }
            if let Some(hit) = sample.first {
                let [a, n] = [hit.albedo, hit.normal];
                aux[i] = [a.x, a.y, a.z, n.x, n.y, n.z, hit.depth, 1.0];
            }
        }
        leaf[3 * REPLICATES..].copy_from_slice(&pairwise(&mut aux[..samples.len()]));
        tree.add(leaf);
    }
    rejected
}

/// The part of the filter that a pixel draws its samples from.
struct FilterWindow {
    centre: Vec2,
    low: Vec2,
    span: Vec2,
}

impl FilterWindow {
    #[inline]
    fn place(&self, filter: &PixelFilter, u: Vec2) -> Vec2 {
        let u = self.low + u * self.span;
        self.centre + Vec2::new(filter.icdf(u.x), filter.icdf(u.y))
    }
}

/// Sums a power of two of rows over a balanced tree.
fn pairwise(rows: &mut [[f32; AUX]]) -> [f32; AUX] {
    let mut count = rows.len();
    while count > 1 {
        count /= 2;
        for i in 0..count {
            rows[i] = std::array::from_fn(|c| rows[2 * i][c] + rows[2 * i + 1][c]);
        }
    }
    rows[0]
}

/// A sum over a balanced binary tree, fed in order: one partial sum for each bit of the count.
struct PairwiseSum {
    partial: [PixelSums; 32],
    count: u32,
}

impl PairwiseSum {
    fn new() -> Self {
        Self { partial: [[0.0; SUMS]; 32], count: 0 }
    }

    fn add(&mut self, mut value: PixelSums) {
        let level = self.count.trailing_ones() as usize;
        for partial in &self.partial[..level] {
            value = std::array::from_fn(|i| partial[i] + value[i]);
        }
        self.partial[level] = value;
        self.count += 1;
    }

    /// The sum of a power of two of values; the next one begins.
    fn take_total(&mut self) -> PixelSums {
        debug_assert!(self.count.is_power_of_two());
        let level = self.count.trailing_zeros() as usize;
        self.count = 0;
        self.partial[level]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairwise_sums_do_not_lose_small_terms() {
        let mut tree = PairwiseSum::new();
        for _ in 0..1 << 20 {
            tree.add([0.1; SUMS]);
        }
        assert!((tree.take_total()[5] / (0.1 * (1 << 20) as f32) - 1.0).abs() < 1e-6);
    }
}
