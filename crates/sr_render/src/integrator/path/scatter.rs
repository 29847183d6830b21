//! Scattering models are asked: how much of a light they pass on, and where the path goes on.

use sr_bsdf::{AnyModel, Bsdf, Diffuse, Mask};
use sr_geometry::BATCH;
use sr_sampling::Sequence;
use sr_scene::Rgb;

use super::super::{FirstHit, PathSample};
use super::state::{Paths, Scattered, Towards, Vertices};
use super::{Step, dimension};
use crate::material::BsdfUser;
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
                let (bsdf, surface) = (Diffuse::new(at.albedo.get(i)), at.surfaces.get(i, glam::Vec2::ZERO));
                let vertex = Vertex { surface: &surface, sight: &sight, bsdf: &bsdf };
                at.to_delta.f_cos.set(i, vertex.f_cos(at.deltas.wi.get(i)));
            }
        }
    }
    for k in 0..at.others.len() {
        let i = at.others.get(k);
        let hit = at.hits.at(i);
        let ray = paths.rays.get(i);
        let surface = at.surfaces.get(i, scene.geometry.uv(&ray, &hit));
        let (sight, side) = Sight::new(scene, &ray, &hit, &surface);
        let visit = Visit {
            has_deltas: scene.lights.has_deltas(),
            step,
            paths,
            i,
            vertex: (&surface, &sight),
            at,
            samples,
        };
        scene.materials.with_bsdf(side, surface.uv, &scene.textures, visit);
    }
}

/// A Lambertian vertex.
#[inline(always)]
fn lambert<Q: Sequence>(paths: &Paths<Q>, at: &mut Vertices, i: usize) {
    let sight = Sight::towards_viewer(at.normal.get(i), -paths.rays.direction.get(i));
    let (bsdf, surface) = (Diffuse::new(at.albedo.get(i)), at.surfaces.get(i, glam::Vec2::ZERO));
    let vertex = Vertex { surface: &surface, sight: &sight, bsdf: &bsdf };
    at.to_light.set(i, vertex.eval(at.lights.wi.get(i)));
    at.scattered.set(i, vertex.sample(0.0, at.scattered.u.get(i)));
}

/// What is done at a vertex of any other model.
struct Visit<'a, Q> {
    has_deltas: bool,
    step: &'a Step,
    paths: &'a Paths<Q>,
    i: usize,
    vertex: (&'a sr_geometry::Surface, &'a Sight),
    at: &'a mut Vertices,
    samples: &'a mut [PathSample; BATCH],
}

impl<'m, Q: Sequence> BsdfUser<'m> for Visit<'_, Q> {
    type Out = ();

    #[inline(always)]
    fn call<B: Bsdf + Into<AnyModel<'m>>>(self, bsdf: B) {
        self.visit(&bsdf);
    }

    #[inline(never)]
    fn call_masked<B: Bsdf + Into<AnyModel<'m>>>(self, bsdf: Mask<B>) {
        self.visit(&bsdf);
    }
}

impl<Q: Sequence> Visit<'_, Q> {
    #[inline(always)]
    fn visit<B: Bsdf>(self, bsdf: &B) {
        let Self { has_deltas, step, paths, i, vertex: (surface, sight), at, samples } = self;
        let vertex = Vertex { surface, sight, bsdf };
        if step.first {
            let first = FirstHit::new(&vertex, at.hits.t[i]);
            samples[paths.slot[i] as usize % BATCH].first = Some(first);
        }
        if step.last {
            return;
        }
        let nothing = (Rgb::ZERO, 0.0);
        let smooth = vertex.lobes().smooth();
        let is_lit = smooth && at.lights.pdf[i] > 0.0;
        at.to_light.set(i, if is_lit { vertex.eval(at.lights.wi.get(i)) } else { nothing });
        if has_deltas {
            let f_cos = if smooth { vertex.f_cos(at.deltas.wi.get(i)) } else { Rgb::ZERO };
            at.to_delta.f_cos.set(i, f_cos);
        }
        let u_lobe = paths.cursor(i, step.dimension + dimension::LOBE).next_1d();
        at.scattered.set(i, vertex.sample(u_lobe, at.scattered.u.get(i)));
    }
}

impl Towards {
    #[inline(always)]
    fn set(&mut self, i: usize, (f_cos, pdf): (Rgb, f32)) {
        self.f_cos.set(i, f_cos);
        self.pdf[i] = pdf;
    }
}

impl Scattered {
    #[inline(always)]
    fn set(&mut self, i: usize, sample: Option<sr_bsdf::BsdfSample>) {
        match sample {
            Some(s) => {
                self.wi.set(i, s.wi);
                self.weight.set(i, s.weight);
                self.pdf[i] = if s.delta { f32::INFINITY } else { s.pdf };
                self.eta[i] = s.eta;
            }
            None => {
                self.wi.set(i, glam::Vec3::Z);
                self.weight.set(i, Rgb::ZERO);
                self.pdf[i] = 0.0;
                self.eta[i] = 1.0;
            }
        }
    }
}
