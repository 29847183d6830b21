//! Building trees and meeting rays.

use glam::Vec3;
use sr_geometry::{BATCH, Geometry, Hits, Ray, Rays};

use crate::Work;
use crate::common::{OwnedMesh, Random, closed_box, soup};

const TRIANGLES: usize = 50_000;
const RAYS: usize = 16 * BATCH;

/// Triangles whose edges are a few times shorter than their distances.
fn scattered() -> OwnedMesh {
    soup(&mut Random(7), TRIANGLES, 1.5 * (TRIANGLES as f32).cbrt().recip())
}

/// Building a tree over scattered triangles.
pub fn build() -> Work {
    let mesh = scattered();
    Box::new(move || mesh.build().memory_bytes() as f64)
}

/// Closest hits of single rays.
pub fn closest() -> Work {
    let geometry = scattered().build();
    let rays = rays(&geometry);
    Box::new(move || rays.iter().filter_map(|ray| geometry.intersect(ray)).map(|hit| f64::from(hit.t)).sum())
}

/// Any hits of single rays.
pub fn any() -> Work {
    let geometry = scattered().build();
    let rays = shadow_rays(&geometry);
    Box::new(move || rays.iter().filter(|ray| geometry.occluded(ray)).count() as f64)
}

/// Closest hits of batches in a tree.
pub fn closest_batch() -> Work {
    closest_of_batches(scattered().build())
}

/// Closest hits of batches among so few triangles that there is no tree.
pub fn closest_box_batch() -> Work {
    closest_of_batches(closed_box(2).build())
}

fn closest_of_batches(geometry: Geometry) -> Work {
    let batches = batches(&rays(&geometry));
    let mut hits = Box::new(Hits::NONE);
    Box::new(move || {
        let mut sum = 0.0;
        for rays in &batches {
            geometry.intersect_batch(rays, BATCH, &mut hits);
            sum += hits.t.iter().filter(|t| t.is_finite()).map(|&t| f64::from(t)).sum::<f64>();
        }
        sum
    })
}

/// Any hits of batches in a tree.
pub fn any_batch() -> Work {
    let geometry = scattered().build();
    let batches = batches(&shadow_rays(&geometry));
    let mut occluded = Box::new([false; BATCH]);
    Box::new(move || {
        let mut count = 0;
        for rays in &batches {
            geometry.occluded_batch(rays, BATCH, &mut occluded);
            count += occluded.iter().filter(|&&occluded| occluded).count();
        }
        count as f64
    })
}

/// Rays that leave surfaces in random directions.
fn rays(geometry: &Geometry) -> Vec<Ray> {
    let mut random = Random(3);
    let mut rays = Vec::with_capacity(RAYS);
    while rays.len() < RAYS {
        let ray = Ray::new(0.9 * random.cube(), random.direction());
        if let Some(hit) = geometry.intersect(&ray) {
            let surface = geometry.surface(&ray, &hit);
            let facing = -surface.ng.dot(ray.direction).signum() * surface.ng;
            rays.push(surface.spawn_ray((facing + 0.999 * random.direction()).normalize()));
        }
    }
    rays
}

/// The same to points of a lamp.
fn shadow_rays(geometry: &Geometry) -> Vec<Ray> {
    let mut random = Random(5);
    let mut aim = |ray: Ray| {
        let lamp = Vec3::new(random.unit() * 0.5 - 0.25, 0.979, random.unit() * 0.4 - 0.2);
        Ray { direction: lamp - ray.origin, t_max: 0.9999, ..ray }
    };
    rays(geometry).into_iter().map(&mut aim).collect()
}

fn batches(rays: &[Ray]) -> Vec<Rays> {
    let batch = |rays: &[Ray]| {
        let mut batch = Rays::NONE;
        rays.iter().enumerate().for_each(|(i, ray)| batch.set(i, ray));
        batch
    };
    rays.chunks(BATCH).map(batch).collect()
}
