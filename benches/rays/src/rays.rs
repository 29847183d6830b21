//! The rays that are timed.

use glam::Vec3;
use sr_geometry::{Geometry, Ray};

use crate::arguments::SceneName;
use crate::common::Random;
use crate::scenes::Scene;

/// Rays for closest hits, and for any hit.
pub struct TimedRays {
    /// As cameras and scattering make them.
    pub closest: Vec<Ray>,
    /// From where the others start, to points of a lamp above the scene.
    pub any: Vec<Ray>,
}

impl TimedRays {
    /// `count` of each kind; a camera's rays fill a square, so that there may be fewer.
    pub fn new(name: &SceneName, scene: &Scene, geometry: &Geometry, count: usize) -> Self {
        let bounces = bounces(name, scene, geometry, count);
        let any = bounces.iter().map({
            let mut random = Random(5);
            move |ray| to_lamp(name, scene, &mut random, ray)
        });
        let any = any.collect();
        let closest = if matches!(name, SceneName::Primary(_)) { primary(count) } else { bounces };
        Self { closest, any }
    }
}

/// Rays that leave surfaces, cosine-distributed, as those of a path tracer do.
fn bounces(name: &SceneName, scene: &Scene, geometry: &Geometry, count: usize) -> Vec<Ray> {
    let mut random = Random(3);
    let mut rays = Vec::with_capacity(count);
    while rays.len() < count {
        let ray = match name {
            SceneName::Forest { .. } => {
                let from = random.cube() * Vec3::new(scene.extent, 0.0, scene.extent) + Vec3::Y * 6.0;
                Ray::new(from, (Vec3::NEG_Y + 0.7 * random.direction()).normalize())
            }
            _ => Ray::new(0.9 * random.cube(), random.direction()),
        };
        if let Some(hit) = geometry.intersect(&ray) {
            let surface = geometry.surface(&ray, &hit);
            let facing = -surface.ng.dot(ray.direction).signum() * surface.ng;
            rays.push(surface.spawn_ray((facing + 0.999 * random.direction()).normalize()));
        }
    }
    rays
}

/// From a ray's origin to a point of a lamp: inside the box, above everything else.
fn to_lamp(name: &SceneName, scene: &Scene, random: &mut Random, ray: &Ray) -> Ray {
    let height = match name {
        SceneName::Box | SceneName::Scattered(_) => 0.979,
        SceneName::Mesh(_) | SceneName::Primary(_) => 1.5,
        SceneName::Forest { .. } => 6.0,
    };
    let lamp = Vec3::new(random.unit() * 0.5 - 0.25, 0.0, random.unit() * 0.4 - 0.2) * scene.extent;
    Ray { direction: lamp + Vec3::Y * height - ray.origin, t_max: 0.9999, ..*ray }
}

/// A pinhole's view of the bumpy sphere, which fills it, row by row.
fn primary(count: usize) -> Vec<Ray> {
    let side = (count as f64).sqrt() as usize;
    let mut random = Random(11);
    let mut across = |i: usize| (i as f32 + random.unit()) / side as f32 * 2.0 - 1.0;
    let mut ray = |i: usize| {
        let (u, v) = (across(i % side), across(i / side));
        Ray::new(Vec3::new(0.3, 0.4, -3.0), Vec3::new(u * 0.45 - 0.1, v * 0.45 - 0.13, 1.0).normalize())
    };
    (0..side * side).map(&mut ray).collect()
}
