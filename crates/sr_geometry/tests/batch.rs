//! Rays of a batch against single rays.

mod common;

use common::{OwnedMesh, Random, closed_box, meet_batch, soup};
use glam::{Mat3, Quat, Vec3};
use sr_geometry::{BATCH, Disk, Geometry, GeometryInput, Hit, Ray, Shape, ShapeRef, Sphere};

/// Boxes in any pose within the unit cube, which parallelograms make, triangles that make none, spheres and disks.
fn mixed(random: &mut Random, boxes: usize, triangles: usize, rounds: usize) -> Geometry {
    let mut meshes = vec![soup(random, triangles, 0.7)];
    for _ in 0..boxes {
        let turn = Quat::from_axis_angle(random.direction(), 6.3 * random.unit());
        let (at, size) = (0.5 * random.cube(), 0.1 + 0.5 * random.cube().abs());
        meshes.push(closed_box(1).transformed(|p| turn * (p * size) + at));
    }
    let mut shapes: Vec<_> = meshes.iter().map(OwnedMesh::shape).collect();
    for i in 0..rounds {
        let (center, size) = (0.7 * random.cube(), 10f32.powf(-2.0 * random.unit()));
        let (u, v) = random.direction().any_orthonormal_pair();
        let (u_axis, v_axis) = (size * u, random.unit() * v);
        shapes.push(match i % 2 {
            0 => Shape::Sphere(Sphere { center, radius: size, frame: Mat3::IDENTITY, flip_normals: false }),
            _ => Shape::Disk(Disk { center, u_axis, v_axis, flip_normals: false }),
        });
    }
    Geometry::build(GeometryInput { shapes, ..Default::default() }).unwrap()
}

fn rays(random: &mut Random, count: usize) -> Vec<Ray> {
    let ray = |random: &mut Random| {
        let (origin, length) = (1.5 * random.cube(), 10f32.powf(2.0 * random.unit() - 1.0));
        let t_max = [1.0, f32::INFINITY][random.below(2)];
        Ray { t_max, ..Ray::new(origin, length * (0.7 * random.cube() - origin)) }
    };
    (0..count).map(|_| ray(random)).collect()
}

/// The same triangle at the same place, to within rounding.
fn same(a: &Hit, b: &Hit, ray: &Ray) -> bool {
    let far = 2e-5 * (1.0 + ray.origin.length() / ray.direction.length()) * a.t.max(1.0);
    (a.shape, a.primitive, a.instance) == (b.shape, b.primitive, b.instance)
        && (a.t - b.t).abs() <= far
        && (a.b1 - b.b1).abs().max((a.b2 - b.b2).abs()) <= 1e-3
}

#[test]
fn rays_meet_the_same_in_batches() {
    let mut random = Random(51);
    let (mut met, mut ties, mut all) = (0, 0, 0);
    for i in 0..300 {
        let boxes = i % 5;
        let geometry = mixed(&mut random, boxes, [0, 1, 4, 16][i % 4], [0, 3, 10][i % 3]);
        let rays = rays(&mut random, BATCH);
        for (ray, (hit, occluded)) in rays.iter().zip(meet_batch(&geometry, &rays)) {
            let single = geometry.intersect(ray);
            all += 1;
            assert_eq!((hit.is_some(), occluded), (single.is_some(), geometry.occluded(ray)), "{ray:?}");
            let (Some(hit), Some(single)) = (hit, single) else { continue };
            met += 1;
            let fits = match geometry.shape_of(hit.shape) {
                ShapeRef::Mesh => hit.b1 >= 0.0 && hit.b2 >= 0.0 && hit.b1 + hit.b2 <= 1.0,
                ShapeRef::Disk(_) => hit.b1.hypot(hit.b2) <= 1.0,
                _ => hit.b1 == 0.0 && hit.b2 == 0.0,
            };
            assert!(fits, "{hit:?}");
            if !same(&hit, &single, ray) {
                // At an edge, or where two triangles meet.
                let (a, b) = (geometry.surface(ray, &hit), geometry.surface(ray, &single));
                assert!((a.p - b.p).length() < 1e-4, "{ray:?}: {hit:?}, {single:?}");
                ties += 1;
            }
        }
    }
    assert!(met > all / 4 && ties < met / 500, "{ties} ties, {met} hits, {all} rays");
}

#[test]
fn a_ray_does_not_depend_on_its_neighbours() {
    let mut random = Random(52);
    for count in [0, 1, 40, 500] {
        let geometry = mixed(&mut random, 2, count, 8);
        let rays = rays(&mut random, BATCH);
        let all = meet_batch(&geometry, &rays);
        for _ in 0..100 {
            let first = random.below(BATCH);
            let count = random.below(BATCH - first + 1);
            let some = first..first + count;
            assert_eq!(meet_batch(&geometry, &rays[some.clone()]), all[some]);
        }
        let reversed: Vec<_> = rays.iter().rev().copied().collect();
        assert!(meet_batch(&geometry, &reversed).iter().eq(all.iter().rev()));
    }
}

/// Every point of a box is on a triangle with the barycentric coordinates that are told, whichever corner comes first.
#[test]
fn coordinates_are_those_of_the_triangle() {
    let mut random = Random(53);
    for turns in 0..36 {
        // Any vertex may come first in either half of a side, and either half may be turned over.
        let mut mesh = closed_box(1);
        for (i, triangle) in mesh.triangles.iter_mut().enumerate() {
            triangle.rotate_left((turns / [1, 3][i % 2]) % 3);
            if turns / [9, 18][i % 2] % 2 == 1 {
                triangle.swap(0, 1);
            }
        }
        let geometry = mesh.build();
        let rays: Vec<_> = (0..BATCH).map(|_| Ray::new(0.9 * random.cube(), random.direction())).collect();
        for (ray, (hit, _)) in rays.iter().zip(meet_batch(&geometry, &rays)) {
            let hit = hit.expect("the box is closed");
            let p = geometry.surface(ray, &hit).p;
            assert!((p - ray.at(hit.t)).abs().max_element() < 2e-6, "{ray:?}: {hit:?} at {p}");
            assert!(p.abs().max_element() <= 1.0 + 1e-6);
        }
    }
}

/// Triangles that are too small, large or thin for a packet are met as single rays meet them, or better.
#[test]
fn extreme_sizes() {
    let mut random = Random(54);
    for exponent in [-30, -25, -18, 12, 15, 18, 25, 30] {
        let size = 10f32.powi(exponent);
        let mesh = closed_box(1).transformed(|p| size * p);
        let geometry = mesh.build();
        let rays: Vec<_> =
            (0..BATCH).map(|_| Ray::new(0.5 * size * random.cube(), random.direction())).collect();
        for (ray, (hit, occluded)) in rays.iter().zip(meet_batch(&geometry, &rays)) {
            let single = geometry.intersect(ray);
            assert!(hit.is_some() || single.is_none(), "{size}: {ray:?}");
            assert!(occluded || !geometry.occluded(ray), "{size}: {ray:?}");
            if let (Some(hit), Some(single)) = (hit, single) {
                assert!((hit.t / single.t - 1.0).abs() < 1e-3);
            }
        }
    }
    let mut mesh = OwnedMesh::default();
    mesh.push([Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1e-38, 0.0)]);
    mesh.push([Vec3::Z, Vec3::X, Vec3::Y]);
    let geometry = mesh.build();
    let ray = Ray::new(Vec3::ONE, -Vec3::ONE);
    assert_eq!(meet_batch(&geometry, &[ray])[0].0.map(|hit| hit.primitive), Some(1));
}
