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
mod direct;
mod go_on;
mod scatter;
mod state;

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
            roulette: depth + 1 >= self.limits.roulette_depth,
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
    ) {
        samples[..rays.count].fill(PathSample::default());
        let Workspace { paths, at } = workspace;
        paths.start(rays);
        let mut depth = 0;
        while paths.count > 0 {
            let step = self.step(depth);
            scene.geometry.intersect_batch(&paths.rays, paths.count, &mut at.hits);
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
            go_on::go_on(&step, paths, at, samples);
            depth += 1;
        }
    }
}
