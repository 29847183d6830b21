//! The path tracer: `mis(bsdf, light)` under the power heuristic at every vertex.
//!
//! Kajiya (1986); multiple importance sampling after Veach & Guibas (1995).
//!
//! A batch of paths takes each step together: all rays are traced, then all surfaces made, all lights sampled, all
//! scattering models asked, all shadow rays traced. The steps are plain loops over arrays, which compilers turn into
//! vector instructions as long as their bodies do not branch; what must branch is a loop of its own. No path's result
//! depends on the others of its batch.
//!
//! Reading order: this file, `state`, then the steps in the order of a vertex: `arrive`, `direct`, `scatter`, `go_on`.

mod arrive;
mod bin;
mod direct;
mod go_on;
mod lookups;
mod queues;
mod scatter;
mod state;

use std::sync::atomic::{AtomicBool, Ordering};

use sr_geometry::BATCH;
use sr_sampling::Sequence;

use super::{CameraRays, FIRST_DIMENSION, Integrator, PathLimits, PathSample};
use crate::scene::Scene;
use state::{Paths, Vertices};

/// Dimensions that a vertex uses: light choice, light (2), lobe, direction (2), roulette, delta light.
const DIMENSIONS_PER_VERTEX: u32 = 8;

/// Where in a vertex's dimensions each purpose has its own.
mod dimension {
    pub const PICK: u32 = 0;
    pub const LIGHT: u32 = 1;
    pub const LOBE: u32 = 3;
    pub const DIRECTION: u32 = 4;
    pub const ROULETTE: u32 = 6;
    pub const DELTA: u32 = 7;
}

/// Unidirectional path tracing with next-event estimation.
#[derive(Clone, Copy, Debug)]
pub struct PathTracer {
    /// How long paths are.
    pub limits: PathLimits,
}

/// Memory for a batch of paths.
pub struct Workspace<Q> {
    paths: Box<Paths<Q>>,
    at: Box<Vertices>,
}

/// A vertex of all paths of a batch, as numbers: the steps' common ground.
#[derive(Clone, Copy)]
struct Step {
    /// Is this the first vertex?
    first: bool,
    /// Is it the last one?
    last: bool,
    /// The first of its dimensions.
    dimension: u32,
    /// Is Russian roulette played?
    roulette: bool,
    /// Do lights count that the ray hits?
    sees_lights: bool,
}

impl PathTracer {
    fn step(&self, depth: u32) -> Step {
        Step {
            first: depth == 0,
            last: depth + 1 >= self.limits.max_depth,
            dimension: FIRST_DIMENSION.wrapping_add(depth.wrapping_mul(DIMENSIONS_PER_VERTEX)),
            roulette: self.limits.plays_roulette(depth + 1),
            sees_lights: depth > 0 || !self.limits.hide_emitters,
        }
    }
}

impl Integrator for PathTracer {
    type Workspace<Q: Sequence> = Workspace<Q>;

    fn workspace<Q: Sequence>(&self, sequence: Q) -> Workspace<Q> {
        Workspace { paths: Box::new(Paths::none(sequence)), at: Box::new(Vertices::NONE) }
    }

    #[inline(always)]
    fn trace<Q: Sequence>(
        &self,
        scene: &Scene,
        rays: &CameraRays<Q>,
        workspace: &mut Workspace<Q>,
        samples: &mut [PathSample; BATCH],
        cancel: &AtomicBool,
    ) {
        samples[..rays.count].fill(PathSample::default());
        let Workspace { paths, at } = workspace;
        paths.start(rays);
        let mut depth = 0;
        while paths.count > 0 && !cancel.load(Ordering::Relaxed) {
            let step = self.step(depth);
            scene.geometry.intersect_batch(&paths.rays, paths.count, &mut at.hits);
            arrive::leave(scene, &step, paths, at, samples);
            scene.geometry.surfaces(&paths.rays, &at.hits, paths.count, &mut at.surfaces);
            arrive::gather_light(scene, &step, paths, at, samples);
            if step.last && !step.first {
                break;
            }
            arrive::find_models(scene, paths, at);
            if !step.last {
                direct::sample_lights(scene, &step, paths, at);
            }
            scatter::scatter(scene, &step, paths, at, samples);
            if step.last {
                break;
            }
            direct::connect(scene, paths, at, samples);
            if scene.textures.has_mipmaps() {
                paths.widen(&at.hits.t, &at.scattered.pdf);
            }
            go_on::go_on(&step, paths, at, samples);
            depth += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};
    use sr_geometry::Vec3s;
    use sr_sampling::Independent;
    use sr_testing::known_scenes;

    use super::*;
    use crate::camera::{Camera, Project};
    use crate::render::RenderSettings;

    fn camera_rays(scene: &Scene, count: usize) -> CameraRays<Independent> {
        let RenderSettings { width, height, .. } = RenderSettings::from_scene(scene);
        let camera = Camera::new(scene.camera(), width, height);
        let mut rays = CameraRays { count, ..CameraRays::none(Independent::new(1)) };
        for i in 0..count {
            rays.index[i] = i as u32;
            rays.rays.set(i, &camera.ray(rays.cursor(i).next_2d(), Vec2::ZERO));
        }
        rays
    }

    /// What nobody may count on.
    fn spoil(at: &mut Vertices) {
        let nothing = Vec3s::splat(Vec3::NAN);
        at.hits.shape.fill(u32::MAX);
        at.hits.primitive.fill(u32::MAX);
        for t in [&mut at.hits.b1, &mut at.hits.b2, &mut at.lights.pdf, &mut at.scattered.pdf] {
            t.fill(f32::NAN);
        }
        for v in
            [&mut at.surfaces.p, &mut at.surfaces.ng, &mut at.surfaces.ns, &mut at.normal, &mut at.albedo]
        {
            v.clone_from(&nothing);
        }
        for v in [&mut at.lights.wi, &mut at.deltas.wi, &mut at.scattered.wi, &mut at.shadow.arriving] {
            v.clone_from(&nothing);
        }
    }

    #[test]
    fn leftovers_make_no_difference() {
        let tracer =
            PathTracer { limits: PathLimits { max_depth: 6, roulette_depth: 3, hide_emitters: false } };
        let (unset, cancel) = (PathSample::default(), AtomicBool::new(false));
        let mut used = tracer.workspace(Independent::new(1));
        for known in known_scenes() {
            let scene = Scene::compile(&known.desc).unwrap();
            let rays = camera_rays(&scene, 100);
            let (mut fresh, mut spoilt) = ([unset; BATCH], [unset; BATCH]);
            tracer.trace(&scene, &rays, &mut tracer.workspace(Independent::new(1)), &mut fresh, &cancel);
            spoil(&mut used.at);
            tracer.trace(&scene, &rays, &mut used, &mut spoilt, &cancel);
            assert_eq!(fresh, spoilt, "{}", known.name);
            // and a batch of one gives what a batch of many gives
            let alone = camera_rays(&scene, 1);
            tracer.trace(&scene, &alone, &mut used, &mut spoilt, &cancel);
            assert_eq!(fresh[0], spoilt[0], "{}", known.name);
        }
    }
}
