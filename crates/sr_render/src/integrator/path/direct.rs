//! Next-event estimation: light that sampled lights send to vertices.

use glam::Vec3;
use sr_geometry::{BATCH, Rays, Vec2s, Vec3s};
use sr_sampling::{Sequence, power_weight};
use sr_scene::Rgb;

use super::super::PathSample;
use super::state::{List, Paths, Vertices};
use super::{Step, dimension};
use crate::light::{DeltaSamples, LightSamples};
use crate::scene::Scene;

/// Samples a light of each kind for every vertex.
#[inline(always)]
pub(super) fn sample_lights<Q: Sequence>(scene: &Scene, step: &Step, paths: &Paths<Q>, at: &mut Vertices) {
    let count = paths.count.min(BATCH);
    if scene.lights.has_extended() {
        let (mut u_pick, mut u) = ([0.0; BATCH], Vec2s::splat(glam::Vec2::ZERO));
        if scene.lights.must_pick() {
            paths.uniforms_1d(step.dimension + dimension::PICK, &mut u_pick);
        }
        paths.uniforms_2d(step.dimension + dimension::LIGHT, &mut u);
        scene.lights.sample_batch((&at.surfaces.p, count), &u_pick, &u, &mut at.lights);
    }
    if scene.lights.has_deltas() {
        for i in 0..count {
            let u = paths.cursor(i, step.dimension + dimension::DELTA).next_1d();
            at.deltas.set(i, scene.lights.sample_delta(at.surfaces.p.get(i), u, &scene.textures).as_ref());
        }
    }
}

/// Adds the light that arrives along the sampled directions if nothing is in between.
#[inline(always)]
pub(super) fn connect<Q: Sequence>(
    scene: &Scene,
    paths: &Paths<Q>,
    at: &mut Vertices,
    samples: &mut [PathSample; BATCH],
) {
    let count = paths.count.min(BATCH);
    let mut arriving = Vec3s::splat(Rgb::ZERO);
    let mut list = List::EMPTY;
    if scene.lights.has_extended() {
        for i in 0..count {
            let pdf = at.lights.pdf[i];
            let weight = power_weight(pdf, at.to_light.pdf[i]) / pdf;
            arriving.set(i, paths.beta.get(i) * at.to_light.f_cos.get(i) * weight);
        }
        for i in 0..count {
            list.push_if(arriving.get(i) != Rgb::ZERO && at.lights.pdf[i] > 0.0, i);
        }
        let LightSamples { wi, target, t_end, .. } = &at.lights;
        keep_visible(scene, at, (wi, target, t_end), &mut list);
        for i in list.iter() {
            let radiance = scene.lights.radiance(&at.lights.get(i), &scene.textures);
            samples[paths.slot[i] as usize % BATCH].li += arriving.get(i) * radiance;
        }
    }
    if scene.lights.has_deltas() {
        list.clear();
        for i in 0..count {
            arriving.set(i, paths.beta.get(i) * at.to_delta.f_cos.get(i) * at.deltas.radiance.get(i));
        }
        for i in 0..count {
            list.push_if(arriving.get(i) != Rgb::ZERO, i);
        }
        let DeltaSamples { wi, target, t_end, .. } = &at.deltas;
        keep_visible(scene, at, (wi, target, t_end), &mut list);
        for i in list.iter() {
            samples[paths.slot[i] as usize % BATCH].li += arriving.get(i);
        }
    }
}

/// Traces the shadow rays of the vertices in `list`, and keeps those that see their light.
#[inline(always)]
fn keep_visible(
    scene: &Scene,
    at: &Vertices,
    (wi, target, t_end): (&Vec3s, &Vec3s, &[f32; BATCH]),
    list: &mut List,
) {
    let mut rays = Rays::NONE;
    for k in 0..list.len().min(BATCH) {
        let i = list.get(k);
        let surface = at.surfaces.get(i, glam::Vec2::ZERO);
        let (wi, target): (Vec3, Vec3) = (wi.get(i), target.get(i));
        let ray =
            if t_end[i] == f32::INFINITY { surface.spawn_ray(wi) } else { surface.spawn_ray_to(target) };
        rays.set(k, &ray);
    }
    let mut occluded = [false; BATCH];
    scene.geometry.occluded_batch(&rays, list.len(), &mut occluded);
    list.keep(|k| !occluded[k % BATCH]);
}
