//! A batch of rays in a tree that is walked with several rays in turn finds what each of them finds alone.

mod common;

use common::{Random, soup};
use glam::{Affine3A, Mat3, Quat, Vec3};
use sr_geometry::{BATCH, Geometry, GeometryInput, Hits, Instance, Ray, Rays, Shape, Sphere};

/// Triangles enough for a large tree, spheres and instances.
fn scene(random: &mut Random) -> Geometry {
    let (world, group) = (soup(random, 20_000, 0.1), soup(random, 300, 0.3));
    let mut shapes = vec![world.shape()];
    for _ in 0..50 {
        shapes.push(Shape::Sphere(Sphere {
            center: random.cube(),
            radius: 0.05,
            frame: Mat3::IDENTITY,
            flip_normals: false,
        }));
    }
    let mut place = || {
        let turn = Quat::from_scaled_axis(random.cube());
        Affine3A::from_scale_rotation_translation(Vec3::splat(0.2), turn, random.cube())
    };
    let instances = (0..30).map(|_| Instance { group: 0, world_from_group: place() }).collect();
    Geometry::build(GeometryInput { shapes, groups: vec![vec![group.shape()]], instances }).unwrap()
}

fn ray(random: &mut Random, i: usize) -> Ray {
    let ray = Ray::new(random.cube(), random.direction());
    match i % 16 {
        0 => Ray { direction: Vec3::splat(f32::NAN), ..ray },
        1 => Ray { direction: Vec3::ZERO, ..ray },
        2 => Ray { t_max: 0.0, ..ray },
        3 => Ray { t_max: f32::NAN, ..ray },
        // Away from everything.
        4 => Ray::new(Vec3::splat(9.0), Vec3::ONE),
        5 => Ray::new(ray.origin, Vec3::X),
        6..10 => Ray { t_max: 0.3, ..ray },
        _ => ray,
    }
}

#[test]
fn a_batch_finds_what_its_rays_find_alone() {
    let mut random = Random(5);
    let geometry = scene(&mut random);
    let (mut rays, mut hits, mut occluded) = (Rays::NONE, Hits::NONE, [false; BATCH]);
    let (mut found, mut missed) = (0, 0);
    for count in [0, 1, 2, 7, 8, 9, 100, BATCH, BATCH, BATCH, BATCH] {
        for i in 0..count {
            rays.set(i, &ray(&mut random, i));
        }
        geometry.intersect_batch(&rays, count, &mut hits);
        geometry.occluded_batch(&rays, count, &mut occluded);
        for (i, &occluded) in occluded[..count].iter().enumerate() {
            let ray = rays.get(i);
            assert_eq!(hits.get(i), geometry.intersect(&ray), "{ray:?}");
            assert_eq!(occluded, geometry.occluded(&ray), "{ray:?}");
            *(if occluded { &mut found } else { &mut missed }) += 1;
        }
    }
    assert!(found > 300 && missed > 300, "{found} hits, {missed} misses");
}
