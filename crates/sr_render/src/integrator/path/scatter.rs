//! Scattering models are asked: how much of a light they pass on, and where the path goes on.

use std::ops::Range;

use sr_bsdf::Diffuse;
use sr_geometry::BATCH;
use sr_sampling::Sequence;
use sr_scene::Rgb;

use super::super::{FirstHit, PathSample};
use super::bin::Serve;
use super::state::{Paths, Vertices};
use super::{Step, dimension};
use crate::material::{Queue, Room};
use crate::scene::Scene;
use crate::vertex::{Sight, Vertex};

/// Asks the models of all vertices.
#[inline(always)]
pub(super) fn scatter<Q: Sequence>(
    scene: &Scene,
    step: &Step,
    paths: &Paths<Q>,
    at: &mut Vertices,
    samples: &mut [PathSample; BATCH],
) {
    let count = paths.count.min(BATCH);
    if step.first {
        for i in 0..count {
            let (albedo, normal, depth) = (at.albedo.get(i), at.normal.get(i), at.hits.t[i]);
            samples[paths.slot[i] as usize % BATCH].first = Some(FirstHit { albedo, normal, depth });
        }
    }
    if !step.last {
        paths.uniforms_2d(step.dimension + dimension::DIRECTION, &mut at.scattered.u);
        for i in 0..count {
            lambert(paths, at, i);
        }
        if scene.lights.has_deltas() {
            for i in 0..count {
                let sight = Sight::towards_viewer(at.normal.get(i), -paths.rays.direction.get(i));
                let bsdf = Diffuse::new(at.albedo.get(i));
                at.to_delta.f_cos.set(i, sight.f_cos(&bsdf, at.deltas.wi.get(i)));
            }
        }
    }
    let single = at.queues.range(Queue::SINGLE);
    if single.end < count {
        if !step.last {
            paths.uniforms_1d(step.dimension + dimension::LOBE, &mut at.u_lobe);
        }
        for queue in (0..scene.materials.queue_count() as u32).map(Queue) {
            if let Some(kind) = queue.kind() {
                serve(scene, step, paths, at, samples, (kind, at.queues.range(queue)));
            }
        }
    }
    for k in single {
        visit(scene, step, paths, at, samples, at.queues.get(k));
    }
}

/// A Lambertian vertex.
#[inline(always)]
fn lambert<Q: Sequence>(paths: &Paths<Q>, at: &mut Vertices, i: usize) {
    let sight = Sight::towards_viewer(at.normal.get(i), -paths.rays.direction.get(i));
    let bsdf = Diffuse::new(at.albedo.get(i));
    at.to_light.set(i, sight.eval(&bsdf, at.lights.wi.get(i)));
    at.scattered.set(i, sight.sample(&bsdf, 0.0, at.scattered.u.get(i)));
}

/// The vertices of one kind.
#[inline(always)]
fn serve<Q: Sequence>(
    scene: &Scene,
    step: &Step,
    paths: &Paths<Q>,
    at: &mut Vertices,
    samples: &mut [PathSample; BATCH],
    (kind, range): (u32, Range<usize>),
) {
    let has_deltas = scene.lights.has_deltas() && !step.last;
    let (bin, queues, first) = (&mut at.bin, &at.queues, range.start);
    bin.count = range.len().min(BATCH);
    if bin.count == 0 {
        return;
    }
    at.lookups.clear();
    for k in 0..bin.count {
        let i = queues.get(first + k);
        let side = scene.materials.side(queues.side(i));
        bin.set_inputs(k, &side.constant);
        if !side.textured.is_empty() {
            let point = scene.texture_point(&paths.rays.get(i), &at.hits.at(i), paths.cone(i));
            at.lookups.push(k, queues.side(i), &point);
        }
        bin.normal.set(k, at.normal.get(i));
        bin.wo.set(k, -paths.rays.direction.get(i));
        bin.light.set(k, at.lights.wi.get(i));
        bin.u_lobe[k] = at.u_lobe[i];
        bin.u.set(k, at.scattered.u.get(i));
        if has_deltas {
            bin.delta.set(k, at.deltas.wi.get(i));
        }
    }
    at.lookups.carry_out(scene, |k, input, value| bin.set_input(k, input, value));
    scene.materials.with_recipe(kind, Serve { bin, step, has_deltas });
    for k in 0..bin.count {
        let i = queues.get(first + k);
        if step.first {
            let (albedo, normal, depth) = (bin.albedo.get(k), bin.normal.get(k), at.hits.t[i]);
            samples[paths.slot[i] as usize % BATCH].first = Some(FirstHit { albedo, normal, depth });
        }
        at.to_light.set(i, (bin.to_light.f_cos.get(k), bin.to_light.pdf[k]));
        if has_deltas {
            at.to_delta.f_cos.set(i, bin.to_delta.get(k));
        }
        at.scattered.copy(i, &bin.scattered, k);
    }
}

/// A vertex that no loop serves.
#[inline(never)]
fn visit<Q: Sequence>(
    scene: &Scene,
    step: &Step,
    paths: &Paths<Q>,
    at: &mut Vertices,
    samples: &mut [PathSample; BATCH],
    i: usize,
) {
    let (hit, ray) = (at.hits.at(i), paths.rays.get(i));
    let surface = at.surfaces.get(i, scene.geometry.uv(&ray, &hit));
    let point = scene.texture_point(&ray, &hit, paths.cone(i));
    let mut room = Room::None;
    let (sight, bsdf) = Sight::with_model(scene, &ray, &hit, &surface, point, &mut room);
    let vertex = Vertex { surface: &surface, sight: &sight, bsdf: &bsdf };
    if step.first {
        samples[paths.slot[i] as usize % BATCH].first = Some(FirstHit::new(&vertex, hit.t));
    }
    if step.last {
        return;
    }
    let nothing = (Rgb::ZERO, 0.0);
    let smooth = vertex.lobes().smooth();
    let is_lit = smooth && at.lights.pdf[i] > 0.0;
    at.to_light.set(i, if is_lit { vertex.eval(at.lights.wi.get(i)) } else { nothing });
    if scene.lights.has_deltas() {
        let f_cos = if smooth { vertex.f_cos(at.deltas.wi.get(i)) } else { Rgb::ZERO };
        at.to_delta.f_cos.set(i, f_cos);
    }
    let u_lobe = paths.cursor(i, step.dimension + dimension::LOBE).next_1d();
    at.scattered.set(i, vertex.sample(u_lobe, at.scattered.u.get(i)));
}
