//! Next-event estimation: light that sampled lights send to vertices.

use glam::{BVec3, Vec2, Vec3};
use sr_geometry::{BATCH, Surfaces, Vec2s, Vec3s};
use sr_sampling::{Sequence, power_weight};
use sr_scene::Rgb;

use super::super::PathSample;
use super::state::{Paths, Shadow, Vertices};
use super::{Step, dimension};
use crate::scene::Scene;

/// Samples a light of each kind for every vertex.
#[inline(always)]
pub(super) fn sample_lights<Q: Sequence>(scene: &Scene, step: &Step, paths: &Paths<Q>, at: &mut Vertices) {
    let count = paths.count.min(BATCH);
    if scene.lights.has_extended() {
        let (mut u_pick, mut u) = ([0.0; BATCH], Vec2s::splat(Vec2::ZERO));
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
    let Vertices { surfaces, lights, deltas, to_light, to_delta, shadow, .. } = at;
    if scene.lights.has_extended() {
        for i in 0..count {
            let pdf = lights.pdf[i];
            let share = power_weight(pdf, to_light.pdf[i]) / pdf;
            let arriving = paths.beta.get(i) * to_light.f_cos.get(i) * share;
            // Chosen, not multiplied by 0: without a sample the rest need not be a number.
            shadow.arriving.set(i, Vec3::select(BVec3::splat(pdf > 0.0), arriving, Rgb::ZERO));
        }
        shadow.keep_visible(scene, surfaces, (&lights.wi, &lights.target, &lights.is_far), count);
        for i in shadow.list.iter() {
            scene.lights.prefetch_radiance(lights, i);
        }
        for i in shadow.list.iter() {
            let radiance = scene.lights.radiance(&lights.get(i), &scene.textures);
            samples[paths.slot[i] as usize % BATCH].li += shadow.arriving.get(i) * radiance;
        }
    }
    if scene.lights.has_deltas() {
        for i in 0..count {
            let radiance = deltas.radiance.get(i);
            let arriving = paths.beta.get(i) * to_delta.f_cos.get(i) * radiance;
            // Chosen, as above.
            shadow.arriving.set(i, Vec3::select(BVec3::splat(radiance != Rgb::ZERO), arriving, Rgb::ZERO));
        }
        shadow.keep_visible(scene, surfaces, (&deltas.wi, &deltas.target, &deltas.is_far), count);
        for i in shadow.list.iter() {
            samples[paths.slot[i] as usize % BATCH].li += shadow.arriving.get(i);
        }
    }
}

impl Shadow {
    /// Lists the vertices at which light arrives: traces the shadow rays of those for which it matters.
    #[inline(always)]
    fn keep_visible(
        &mut self,
        scene: &Scene,
        surfaces: &Surfaces,
        (wi, target, is_far): (&Vec3s, &Vec3s, &[u32; BATCH]),
        count: usize,
    ) {
        self.list.clear();
        for i in 0..count {
            self.list.push_if(self.arriving.get(i) != Rgb::ZERO, i);
        }
        for k in 0..self.list.len().min(BATCH) {
            let i = self.list.get(k);
            let surface = surfaces.get(i, Vec2::ZERO);
            let ray = match is_far[i] {
                0 => surface.spawn_ray_to(target.get(i)),
                _ => surface.spawn_ray(wi.get(i)),
            };
            self.rays.set(k, &ray);
        }
        scene.geometry.occluded_batch(&self.rays, self.list.len(), &mut self.occluded);
        self.list.keep(|k| !self.occluded[k % BATCH]);
    }
}
