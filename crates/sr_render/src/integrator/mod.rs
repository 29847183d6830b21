//! Integrators: from camera rays to estimates of the radiance along them.
//!
//! In: a batch of [`CameraRays`]. Out: a [`PathSample`] for each.
//!
//! - [`PathTracer`]: `mis(bsdf, light)`, the default and the fast one: many paths at a time.
//! - [`StrategyTracer`]: any [`crate::Strategy`], written for clarity: one path at a time. Tests hold the two against each other.
//!
//! Invariant: every integrator's expectation is the same image. What only one technique can find is found
//! by that technique: delta lights by light sampling, delta lobes by the BSDF.

mod path;
mod roulette;
mod strategies;

use std::sync::atomic::AtomicBool;

use glam::Vec3;
use sr_geometry::{BATCH, Rays, Surface};
use sr_sampling::{Cursor, SampleId, Sequence};
use sr_scene::Rgb;

use crate::light::Target;
use crate::scene::Scene;
use crate::texture::RayCone;
use crate::vertex::Vertex;
use sr_bsdf::{AnyBsdf, Bsdf};

pub use path::PathTracer;
pub use strategies::StrategyTracer;

/// Estimates the radiance along camera rays.
pub trait Integrator: Sync {
    /// Memory that batches use one after the other.
    type Workspace<Q: Sequence>;

    /// Memory for one thread; `sequence` may be any of the kind.
    fn workspace<Q: Sequence>(&self, sequence: Q) -> Self::Workspace<Q>;

    /// Writes a sample for each ray of a batch. Each depends on its ray and its uniforms alone, which it takes at
    /// dimensions from [`FIRST_DIMENSION`] on. Stops soon after `cancel` is set, leaving samples unfinished.
    fn trace<Q: Sequence>(
        &self,
        scene: &Scene,
        rays: &CameraRays<Q>,
        workspace: &mut Self::Workspace<Q>,
        samples: &mut [PathSample; BATCH],
        cancel: &AtomicBool,
    );
}

/// Camera rays, and where their paths get uniforms from.
#[derive(Clone, Debug)]
pub struct CameraRays<Q> {
    /// How many there are.
    pub count: usize,
    /// The rays.
    pub rays: Rays,
    /// Pixels that the samples belong to.
    pub pixel: [u32; BATCH],
    /// Indices of the samples in their sequences.
    pub index: [u32; BATCH],
    /// How wide they all are.
    pub cone: RayCone,
    /// Sequences.
    pub sequence: [Q; BATCH],
}

impl<Q: Sequence> CameraRays<Q> {
    /// No rays; `sequence` may be any of the kind.
    pub fn none(sequence: Q) -> Self {
        let (pixel, index, sequence) = ([0; BATCH], [0; BATCH], [sequence; BATCH]);
        Self { count: 0, rays: Rays::NONE, pixel, index, cone: RayCone::LINE, sequence }
    }

    /// The uniforms of one ray, from dimension 0 on.
    #[inline(always)]
    pub fn cursor(&self, i: usize) -> Cursor<'_, Q> {
        Cursor::new(&self.sequence[i], SampleId { pixel: self.pixel[i], index: self.index[i] })
    }
}

/// Dimensions below this one belong to the camera: two for the film, two for the lens.
pub const FIRST_DIMENSION: u32 = 4;

/// From this many edges on, Russian roulette is always played, so that every path ends. That changes no expectation.
pub const LATEST_ROULETTE: u32 = 1024;

/// How long paths are, and what the camera sees of the lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathLimits {
    /// Longest path in edges; `u32::MAX` is unbounded.
    pub max_depth: u32,
    /// Edges before Russian roulette; it is played from [`LATEST_ROULETTE`] on in any case.
    pub roulette_depth: u32,
    /// Are lights black where the camera sees them directly?
    pub hide_emitters: bool,
}

impl PathLimits {
    /// Is Russian roulette played at this depth?
    #[inline]
    fn plays_roulette(&self, depth: u32) -> bool {
        depth >= self.roulette_depth.min(LATEST_ROULETTE)
    }
}

/// What one path brought home.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathSample {
    /// Estimate of the radiance.
    pub li: Rgb,
    /// The first surface, if there was one.
    pub first: Option<FirstHit>,
}

/// Features of the first surface that a path meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// Approximate albedo.
    pub albedo: Rgb,
    /// Shading normal, in world space.
    pub normal: Vec3,
    /// Distance from the ray's origin.
    pub depth: f32,
}

impl FirstHit {
    #[inline]
    fn new(vertex: &Vertex<'_, AnyBsdf>, distance: f32) -> Self {
        Self { albedo: vertex.bsdf.albedo(), normal: vertex.normal(), depth: distance }
    }
}

/// Is nothing between a surface and the light that was sampled from it?
#[inline(always)]
fn visible(scene: &Scene, from: &Surface, wi: Vec3, target: Target) -> bool {
    let ray = match target {
        Target::Point(p) => from.spawn_ray_to(p),
        Target::Infinity => from.spawn_ray(wi),
    };
    !scene.geometry.occluded(&ray)
}

/// Light from one of the lights that only light sampling can find.
fn from_deltas<B: Bsdf>(scene: &Scene, vertex: &Vertex<'_, B>, u_pick: f32) -> Rgb {
    let Some(s) = scene.lights.sample_delta(vertex.surface.p, u_pick, &scene.textures) else {
        return Rgb::ZERO;
    };
    let f_cos = vertex.f_cos(s.wi);
    if f_cos == Rgb::ZERO || !visible(scene, vertex.surface, s.wi, s.target) {
        return Rgb::ZERO;
    }
    f_cos * s.radiance
}
