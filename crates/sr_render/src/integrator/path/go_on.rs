//! Paths go on along their new directions, or end.

use sr_geometry::BATCH;
use sr_sampling::Sequence;
use sr_scene::Rgb;

use super::super::PathSample;
use super::super::roulette::survive;
use super::state::{Paths, Vertices};
use super::{Step, dimension};

/// Moves all paths on along their new edges, and takes away those that end.
#[inline(always)]
pub(super) fn go_on<Q: Sequence>(
    step: &Step,
    paths: &mut Paths<Q>,
    at: &Vertices,
    samples: &mut [PathSample; BATCH],
) {
    let count = paths.count.min(BATCH);
    let scattered = &at.scattered;
    for i in 0..count {
        paths.beta.set(i, paths.beta.get(i) * scattered.weight.get(i));
        paths.eta[i] *= scattered.eta[i];
        let surface = at.surfaces.get(i, glam::Vec2::ZERO);
        paths.rays.set(i, &surface.spawn_ray(scattered.wi.get(i)));
        paths.from.set(i, surface.p);
        paths.pdf[i] = scattered.pdf[i];
    }
    if step.roulette {
        let mut u = [0.0; BATCH];
        paths.uniforms_1d(step.dimension + dimension::ROULETTE, &mut u);
        for i in 0..count {
            let share = survive(paths.beta.get(i), paths.eta[i], u[i]).unwrap_or(0.0);
            paths.beta.set(i, paths.beta.get(i) * share);
        }
    }
    for i in (0..count).rev() {
        let beta = paths.beta.get(i);
        if beta == Rgb::ZERO {
            paths.end(i);
        } else if !beta.is_finite() {
            // Whatever it would find is not a number: let the film reject it.
            samples[paths.slot[i] as usize % BATCH].li = Rgb::NAN;
            paths.end(i);
        }
    }
}
