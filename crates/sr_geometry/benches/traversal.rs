//! Rays per second: incoherent rays that leave surfaces, closest and any hit, by the number of triangles.
//!
//! `cargo bench -p sr_geometry`. "cornell" is a closed box with two blocks and a light, 38 triangles; the others are
//! as many triangles scattered in a cube, their edges a few times shorter than their distances.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{OwnedMesh, Random, closed_box, soup};
use divan::{Bencher, counter::ItemsCount};
use glam::{Quat, Vec3};
use sr_geometry::{BATCH, Geometry, Hit, Hits, Ray, Rays};

const RAYS: usize = 1 << 16;

fn main() {
    divan::main();
}

/// Walls, two blocks and a light as separate meshes, as a scene file has them.
fn cornell() -> Geometry {
    let block = |at: Vec3, half: Vec3, angle: f32| {
        closed_box(1).transformed(|p| Quat::from_rotation_y(angle) * (p * half) + at)
    };
    let walls = closed_box(1);
    let blocks = [
        block(Vec3::new(-0.33, -0.4, -0.3), Vec3::new(0.3, 0.6, 0.3), 0.3),
        block(Vec3::new(0.33, -0.7, 0.3), Vec3::new(0.3, 0.3, 0.3), -0.3),
    ];
    let mut light = OwnedMesh::default();
    let [a, b, c, d] =
        [(-0.25, -0.2), (0.25, -0.2), (0.25, 0.2), (-0.25, 0.2)].map(|(x, z)| Vec3::new(x, 0.98, z));
    light.push([a, b, c]);
    light.push([a, c, d]);
    let shapes = vec![walls.shape(), blocks[0].shape(), blocks[1].shape(), light.shape()];
    Geometry::build(sr_geometry::GeometryInput { shapes, ..Default::default() }).unwrap()
}

/// `scattered(10^k)`: edges shrink with the distances between triangles.
fn scattered(count: usize) -> Geometry {
    scattered_mesh(count).build()
}

fn scattered_mesh(count: usize) -> OwnedMesh {
    soup(&mut Random(7), count, 1.5 * (count as f32).cbrt().recip())
}

fn scene(triangles: usize) -> Geometry {
    if triangles == 38 { cornell() } else { scattered(triangles) }
}

/// Rays that leave surfaces in random directions, as the paths of a path tracer do.
fn leaving_rays(geometry: &Geometry) -> Vec<Ray> {
    let mut random = Random(3);
    let mut rays = Vec::with_capacity(RAYS);
    while rays.len() < RAYS {
        let ray = Ray::new(0.9 * random.cube(), random.direction());
        if let Some(hit) = geometry.intersect(&ray) {
            let surface = geometry.surface(&ray, &hit);
            let side = -surface.ng.dot(ray.direction).signum();
            let direction = side * (surface.ng + 0.999 * random.direction() * side).normalize();
            rays.push(surface.spawn_ray(if direction.dot(surface.ng) * side > 0.0 {
                direction
            } else {
                -direction
            }));
        }
    }
    rays
}

#[divan::bench(args = [38, 1_000, 100_000, 1_000_000])]
fn closest(bencher: Bencher<'_, '_>, triangles: usize) {
    let geometry = scene(triangles);
    let rays = leaving_rays(&geometry);
    bencher
        .counter(ItemsCount::new(RAYS))
        .bench(|| rays.iter().filter_map(|ray| geometry.intersect(ray)).map(|hit| hit.t).sum::<f32>());
}

/// The same in batches.
#[divan::bench(args = [38, 1_000, 100_000, 1_000_000])]
fn closest_batch(bencher: Bencher<'_, '_>, triangles: usize) {
    let geometry = scene(triangles);
    let batches = batches(&leaving_rays(&geometry));
    let mut hits = Hits::NONE;
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        let sum = |rays: &Rays| {
            geometry.intersect_batch(rays, BATCH, &mut hits);
            hits.t.iter().filter(|t| t.is_finite()).sum::<f32>()
        };
        batches.iter().map(sum).sum::<f32>()
    });
}

fn batches(rays: &[Ray]) -> Vec<Rays> {
    let batch = |rays: &[Ray]| {
        let mut batch = Rays::NONE;
        rays.iter().enumerate().for_each(|(i, ray)| batch.set(i, ray));
        batch
    };
    rays.chunks(BATCH).map(batch).collect()
}

/// Shadow rays: towards points of a square below the top of the cube.
fn shadow_rays(geometry: &Geometry) -> Vec<Ray> {
    let mut random = Random(5);
    let mut aim = |ray: Ray| {
        let target = Vec3::new(random.unit() * 0.5 - 0.25, 0.979, random.unit() * 0.4 - 0.2);
        Ray { direction: target - ray.origin, t_max: 0.9999, ..ray }
    };
    leaving_rays(geometry).into_iter().map(&mut aim).collect()
}

#[divan::bench(args = [38, 1_000, 100_000, 1_000_000])]
fn any(bencher: Bencher<'_, '_>, triangles: usize) {
    let geometry = scene(triangles);
    let rays = shadow_rays(&geometry);
    bencher.counter(ItemsCount::new(RAYS)).bench(|| rays.iter().filter(|ray| geometry.occluded(ray)).count());
}

/// The same in batches.
#[divan::bench(args = [38, 1_000, 100_000, 1_000_000])]
fn any_batch(bencher: Bencher<'_, '_>, triangles: usize) {
    let geometry = scene(triangles);
    let batches = batches(&shadow_rays(&geometry));
    let mut occluded = [false; BATCH];
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        let count = |rays: &Rays| {
            geometry.occluded_batch(rays, BATCH, &mut occluded);
            occluded.iter().filter(|&&occluded| occluded).count()
        };
        batches.iter().map(count).sum::<usize>()
    });
}

/// From hit to position, normals, texture coordinates.
#[divan::bench(args = [38, 1_000_000])]
fn surface(bencher: Bencher<'_, '_>, triangles: usize) {
    let geometry = scene(triangles);
    let rays = leaving_rays(&geometry);
    let hits: Vec<(Ray, Hit)> =
        rays.iter().filter_map(|ray| Some((*ray, geometry.intersect(ray)?))).collect();
    bencher
        .counter(ItemsCount::new(hits.len()))
        .bench(|| hits.iter().map(|(ray, hit)| geometry.surface(ray, hit).ns.x).sum::<f32>());
}

#[divan::bench(args = [38, 1_000, 100_000, 1_000_000], sample_count = 10)]
fn build(bencher: Bencher<'_, '_>, triangles: usize) {
    let mesh = scattered_mesh(triangles);
    bencher.counter(ItemsCount::new(triangles)).bench(|| mesh.build());
}
