//! A pass: some samples of every pixel.
//!
//! In: a scene, an integrator, a range of samples. Out: their sums for each pixel, one block of the film. Tasks take a
//! few neighbouring pixels each, and hand their samples to the integrator in batches.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use glam::Vec2;
use sr_geometry::{BATCH, Rays, Vec2s};
use sr_sampling::Sequence;
use sr_sampling::isa::{Isa, Work};
use sr_scene::FilmWindow;

use crate::camera::{Camera, Project};
use crate::film::{AUX, PixelSums, REPLICATES, SUMS};
use crate::filter::PixelFilter;
use crate::integrator::{CameraRays, Integrator, PathSample};
use crate::pairwise::{PairwiseSum, pairwise};
use crate::render::RenderSettings;
use crate::scene::Scene;
use crate::texture::RayCone;

/// Pixels that one task renders, unless they are fewer than a batch has room for.
const PIXELS_PER_TASK: usize = 64;

/// Everything that a sample needs.
pub(crate) struct Sampler<'a, I, Q> {
    scene: &'a Scene,
    integrator: &'a I,
    camera: Camera,
    /// How wide its rays are: a pixel.
    cone: RayCone,
    filter: PixelFilter,
    sample_border: bool,
    /// Pixels across the image.
    width: u32,
    /// Where the image is in the film.
    window: FilmWindow,
    /// One independent sequence per replicate.
    sequences: [Q; REPLICATES],
    isa: Isa,
}

impl<'a, I: Integrator, Q: Sequence> Sampler<'a, I, Q> {
    pub fn new(scene: &'a Scene, settings: &RenderSettings, integrator: &'a I, sequence: &Q) -> Self {
        let window = scene.camera.film.window(settings.width, settings.height);
        let (film_width, film_height) = window.film;
        let camera = Camera::new(&scene.camera, film_width, film_height);
        Self {
            scene,
            integrator,
            cone: camera.pixel_cone(film_height),
            camera,
            filter: PixelFilter::new(scene.camera.film.filter),
            sample_border: scene.camera.film.sample_border,
            width: settings.width,
            window,
            sequences: std::array::from_fn(|r| sequence.replicate(r as u32)),
            isa: Isa::detect(),
        }
    }

    /// Samples `first .. first + len` of every pixel. Returns how many were not finite; `None` if cancelled.
    pub fn pass(&self, first: u32, len: u32, sums: &mut [PixelSums], cancel: &AtomicBool) -> Option<u64> {
        let rejected = AtomicU64::new(0);
        let pixels_per_task = PIXELS_PER_TASK.max(BATCH / len as usize);
        // Whoever is done takes the next task, so that all threads end at about the same time.
        let tasks = Mutex::new(sums.chunks_mut(pixels_per_task).enumerate());
        let next = || tasks.lock().unwrap_or_else(PoisonError::into_inner).next();
        rayon::broadcast(|_| {
            let mut desk = None;
            while let Some((task, sums)) = next() {
                let desk = desk.get_or_insert_with(|| Desk::new(self));
                let first_pixel = (task * pixels_per_task) as u32;
                let tile = Tile { sampler: self, desk, first_pixel, first, len, sums, cancel };
                rejected.fetch_add(self.isa.run(tile), Ordering::Relaxed);
            }
        });
        (!cancel.load(Ordering::Relaxed)).then(|| rejected.into_inner())
    }

    /// Makes the camera rays of samples `start .. start + per_pixel` of `pixels`, and the samples' weights if the
    /// filter is negative somewhere.
    #[inline(always)]
    fn camera_rays(
        &self,
        rays: &mut CameraRays<Q>,
        weights: &mut [f32; BATCH],
        pixels: Range<u32>,
        start: u32,
        per_pixel: u32,
    ) {
        let zero = Vec2s::splat(Vec2::ZERO);
        let (mut film, mut centre, mut low, mut span) = (zero.clone(), zero.clone(), zero.clone(), zero);
        let mut i = 0;
        for pixel in pixels {
            let window = self.filter_window(pixel);
            for sample in start..start + per_pixel {
                rays.pixel[i] = window.pixel;
                rays.index[i] = sample / REPLICATES as u32;
                rays.sequence[i] = self.sequences[sample as usize % REPLICATES];
                centre.set(i, window.centre);
                low.set(i, window.low);
                span.set(i, window.span);
                weights[i] = window.gain;
                i += 1;
            }
        }
        (rays.count, rays.cone) = (i, self.cone);
        let count = i.min(BATCH);
        for i in 0..count {
            film.set(i, low.get(i) + rays.cursor(i).next_2d() * span.get(i));
        }
        if self.filter.is_signed() {
            for i in 0..count {
                weights[i] *= self.filter.sign(film.x[i]) * self.filter.sign(film.y[i]);
            }
        }
        self.filter.place(&mut film.x[..count]);
        self.filter.place(&mut film.y[..count]);
        for i in 0..count {
            film.set(i, centre.get(i) + film.get(i));
        }
        let size = Vec2::new(self.window.film.0 as f32, self.window.film.1 as f32);
        match &self.camera {
            Camera::Perspective(camera) if self.camera.has_lens() => {
                for i in 0..count {
                    let u_lens = rays.cursor(i).at(2).next_2d();
                    rays.rays.set(i, &camera.ray(film.get(i) / size, u_lens));
                }
            }
            Camera::Perspective(camera) => project(camera, &film, size, &mut rays.rays, count),
            Camera::Orthographic(camera) => project(camera, &film, size, &mut rays.rays, count),
            Camera::Spherical(camera) => project(camera, &film, size, &mut rays.rays, count),
        }
    }

    fn filter_window(&self, pixel: u32) -> FilterWindow {
        let FilmWindow { film: (width, height), origin } = self.window;
        let (x, y) = (origin.0 + pixel % self.width, origin.1 + pixel / self.width);
        let inside = |index, count| match self.sample_border {
            true => (0.0, 1.0),
            false => self.filter.inside(index, count),
        };
        let (across, down) = (inside(x, width), inside(y, height));
        FilterWindow {
            // of the film, so that a crop takes the samples of the whole
            pixel: y.wrapping_mul(width).wrapping_add(x),
            centre: Vec2::new(x as f32 + 0.5, y as f32 + 0.5),
            low: Vec2::new(across.0, down.0),
            span: Vec2::new(across.1 - across.0, down.1 - down.0),
            gain: if self.filter.is_signed() {
                self.filter.gain(across) * self.filter.gain(down)
            } else {
                1.0
            },
        }
    }
}

/// The rays of a camera without a lens, through film positions in pixels.
#[inline(always)]
fn project(camera: &impl Project, film: &Vec2s, size: Vec2, rays: &mut Rays, count: usize) {
    for i in 0..count {
        rays.set(i, &camera.ray(film.get(i) / size, Vec2::ZERO));
    }
}

/// Memory for a batch of samples, which one task after the other uses.
struct Desk<I: Integrator, Q: Sequence> {
    rays: Box<CameraRays<Q>>,
    weights: Box<[f32; BATCH]>,
    workspace: I::Workspace<Q>,
    samples: Box<[PathSample; BATCH]>,
    tree: PairwiseSum,
}

impl<I: Integrator, Q: Sequence> Desk<I, Q> {
    fn new(sampler: &Sampler<'_, I, Q>) -> Self {
        let sequence = sampler.sequences[0];
        Self {
            rays: Box::new(CameraRays::none(sequence)),
            weights: Box::new([1.0; BATCH]),
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
        let Desk { rays, weights, workspace, samples, tree } = desk;
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
                sampler.camera_rays(rays, weights, at..at + sums.len() as u32, start, per_pixel);
                sampler.integrator.trace(sampler.scene, rays, workspace, samples, cancel);
                if sampler.filter.is_signed() {
                    for (sample, &weight) in samples[..rays.count].iter_mut().zip(weights.iter()) {
                        sample.li *= weight;
                    }
                }
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
    /// The pixel of the film.
    pixel: u32,
    centre: Vec2,
    low: Vec2,
    span: Vec2,
    /// What its samples weigh, but for their sign.
    gain: f32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::{PathLimits, PathTracer};
    use sr_sampling::{Independent, OwenSobol};
    use sr_testing::known_scenes;

    fn sums<Q: Sequence>(scene: &Scene, isa: Isa, sequence: &Q) -> Vec<PixelSums> {
        let limits = PathLimits { max_depth: 6, roulette_depth: 3, hide_emitters: false };
        let settings = RenderSettings { width: 5, height: 3, ..RenderSettings::from_scene(scene) };
        let tracer = PathTracer { limits };
        let sampler = Sampler { isa, ..Sampler::new(scene, &settings, &tracer, sequence) };
        let mut sums = vec![[0.0; SUMS]; 15];
        assert_eq!(sampler.pass(64, 64, &mut sums, &AtomicBool::new(false)), Some(0));
        sums
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        for known in known_scenes() {
            let scene = Scene::compile(&known.desc).unwrap();
            let baseline = sums(&scene, Isa::Baseline, &Independent::new(5));
            assert!(baseline.iter().flatten().any(|&x| x > 0.0), "{}: black", known.name);
            for isa in Isa::available() {
                assert_eq!(sums(&scene, isa, &Independent::new(5)), baseline, "{}, {isa:?}", known.name);
            }
            let baseline = sums(&scene, Isa::Baseline, &OwenSobol::new(5));
            for isa in Isa::available() {
                assert_eq!(sums(&scene, isa, &OwenSobol::new(5)), baseline, "{}, {isa:?}", known.name);
            }
        }
    }
}
