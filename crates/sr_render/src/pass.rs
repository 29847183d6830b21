//! A pass: some samples of every pixel.
//!
//! In: a scene, an integrator, a range of samples. Out: their sums for each pixel, one block of the film. Tasks take a
//! few neighbouring pixels each, and hand their samples to the integrator in batches.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use glam::Vec2;
use rayon::prelude::*;
use sr_geometry::{BATCH, Vec2s};
use sr_sampling::Sequence;
use sr_sampling::isa::{Isa, Work};

use crate::camera::Camera;
use crate::film::{AUX, PixelSums, REPLICATES, SUMS};
use crate::filter::PixelFilter;
use crate::integrator::{CameraRays, Integrator, PathSample};
use crate::pairwise::{PairwiseSum, pairwise};
use crate::render::RenderSettings;
use crate::scene::Scene;

/// Pixels that one task renders, unless they are fewer than a batch has room for.
const PIXELS_PER_TASK: usize = 64;

/// Everything that a sample needs.
pub(crate) struct Sampler<'a, I, Q> {
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
    pub fn new(scene: &'a Scene, settings: &RenderSettings, integrator: &'a I, sequence: &Q) -> Self {
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
    pub fn pass(&self, first: u32, len: u32, sums: &mut [PixelSums], cancel: &AtomicBool) -> Option<u64> {
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
        let zero = Vec2s::splat(Vec2::ZERO);
        let (mut film, mut centre, mut low, mut span) = (zero.clone(), zero.clone(), zero.clone(), zero);
        let mut i = 0;
        for pixel in pixels {
            let window = self.window(pixel);
            for sample in start..start + per_pixel {
                rays.pixel[i] = pixel;
                rays.index[i] = sample / REPLICATES as u32;
                rays.sequence[i] = self.sequences[sample as usize % REPLICATES];
                centre.set(i, window.centre);
                low.set(i, window.low);
                span.set(i, window.span);
                i += 1;
            }
        }
        rays.count = i;
        let count = i.min(BATCH);
        for i in 0..count {
            film.set(i, low.get(i) + rays.cursor(i).next_2d() * span.get(i));
        }
        self.filter.place(&mut film.x[..count]);
        self.filter.place(&mut film.y[..count]);
        for i in 0..count {
            film.set(i, centre.get(i) + film.get(i));
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
                sampler.integrator.trace(sampler.scene, rays, workspace, samples, cancel);
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
