//! Paths come to surfaces: what shines there is added, and the scattering models are found.

use sr_geometry::{BATCH, Hit, ShapeId};
use sr_sampling::{Sequence, power_weight};
use sr_scene::Rgb;

use super::super::PathSample;
use super::Step;
use super::state::{Paths, Vertices};
use crate::scene::Scene;

/// Ends the paths whose rays hit nothing, and adds the environment's light to them.
#[inline(always)]
pub(super) fn leave<Q: Sequence>(
    scene: &Scene,
    step: &Step,
    paths: &mut Paths<Q>,
    at: &mut Vertices,
    samples: &mut [PathSample; BATCH],
) {
    let sees_environment = step.sees_lights && scene.lights.has_environment();
    for i in (0..paths.count.min(BATCH)).rev() {
        if at.hits.t[i] < f32::INFINITY {
            continue;
        }
        if sees_environment {
            samples[paths.slot[i] as usize % BATCH].li += paths.beta.get(i) * environment(scene, paths, i);
        }
        paths.end(i);
        at.hits.set(i, at.hits.get(paths.count % BATCH).as_ref());
    }
}

/// Adds the light that surfaces emit, as far as the BSDF's part in finding it is worth.
#[inline(always)]
pub(super) fn gather_light<Q: Sequence>(
    scene: &Scene,
    step: &Step,
    paths: &Paths<Q>,
    at: &Vertices,
    samples: &mut [PathSample; BATCH],
) {
    if !step.sees_lights {
        return;
    }
    for i in 0..paths.count.min(BATCH) {
        let hit = at.hits.at(i);
        if scene.light_of(hit.shape).is_some() {
            let le = emitted(scene, paths, at, i, &hit);
            samples[paths.slot[i] as usize % BATCH].li += paths.beta.get(i) * le;
        }
    }
}

#[inline(never)]
fn environment<Q: Sequence>(scene: &Scene, paths: &Paths<Q>, i: usize) -> Rgb {
    let (from, direction, pdf) = (paths.from.get(i), paths.rays.direction.get(i), paths.pdf[i]);
    if pdf == f32::INFINITY {
        scene.lights.environment(from, direction, |_| 1.0)
    } else {
        scene.lights.environment_by_power(from, direction, pdf)
    }
}

#[inline(never)]
fn emitted<Q: Sequence>(scene: &Scene, paths: &Paths<Q>, at: &Vertices, i: usize, hit: &Hit) -> Rgb {
    let Some(light) = scene.light_of(hit.shape) else { return Rgb::ZERO };
    let ray = paths.rays.get(i);
    let surface = scene.emitter(at.surfaces.get(i, scene.geometry.uv(&ray, hit)), light, hit);
    let le = scene.lights.emitted(light, &surface, -ray.direction, &scene.textures);
    let pdf = paths.pdf[i];
    if le == Rgb::ZERO || pdf == f32::INFINITY {
        return le;
    }
    le * power_weight(pdf, scene.lights.pdf_of_point(light, paths.from.get(i), &surface, hit.primitive))
}

/// Finds out which side of which material is seen, and lets vertices wait for the loops that serve them. Lambertian
/// ones get their albedos.
#[inline(always)]
pub(super) fn find_models<Q: Sequence>(scene: &Scene, paths: &Paths<Q>, at: &mut Vertices) {
    let count = paths.count.min(BATCH);
    let mut facing = [0.0; BATCH];
    for i in 0..count {
        facing[i] = -at.surfaces.ns.get(i).dot(paths.rays.direction.get(i));
    }
    let mut turn = [1.0; BATCH];
    at.queues.clear();
    at.lookups.clear();
    for i in 0..count {
        let material = scene.material_of(ShapeId(at.hits.shape[i]));
        let face = scene.materials.face(material, facing[i] < 0.0);
        at.queues.push(i, &face);
        at.albedo.set(i, face.albedo);
        turn[i] = face.turn;
        if face.has_picture {
            let point = scene.texture_point(&paths.rays.get(i), &at.hits.at(i), paths.cone(i));
            at.lookups.push(i, face.side, &point);
        }
    }
    at.queues.sort(count, scene.materials.queue_count());
    for i in 0..count {
        at.normal.set(i, at.surfaces.ns.get(i) * turn[i]);
    }
    let albedo = &mut at.albedo;
    at.lookups.carry_out(scene, |i, _, value| albedo.set(i, value.max(Rgb::ZERO)));
}
