//! No ray leaves a closed mesh from within, wherever it is aimed and wherever the mesh is.

mod common;

use common::{OwnedMesh, Random, closed_box, meet_both};
use glam::{Quat, Vec3};
use sr_geometry::Ray;

/// For convex meshes that are symmetric about their centre. Rays from within at the vertices, at points of the edges, and at points of the triangles.
fn assert_closed(mesh: &OwnedMesh, random: &mut Random, what: &str) {
    let geometry = mesh.build();
    let center = geometry.bounds().center();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        let s = random.unit();
        let (u, v) = (random.unit(), random.unit());
        for target in
            [a, b, 0.5 * (a + b), a + s * (b - a), c + s * (a - c), a + 0.5 * u * (b - a) + 0.5 * v * (c - a)]
        {
            let towards = mesh.positions[random.below(mesh.positions.len())];
            let origin = center + 0.5 * random.unit() * (towards - center);
            let ray = Ray::new(origin, target - origin);
            for (hit, occluded) in meet_both(&geometry, &ray) {
                let hit = hit.unwrap_or_else(|| panic!("{what}: {ray:?} escaped at {target}"));
                assert!((hit.t - 1.0).abs() < 1e-2, "{what}: {ray:?} met the wall at t = {}", hit.t);
                assert!(occluded, "{what}: {ray:?} is occluded");
            }
        }
    }
}

#[test]
fn boxes_in_any_pose() {
    let mut random = Random(11);
    for n in [1, 2, 3, 10] {
        let mesh = closed_box(n);
        assert_closed(&mesh, &mut random, "axis-aligned");
        for i in 0..50 {
            let (axis, angle) = (random.direction(), 6.3 * random.unit());
            let size = 10f32.powi(i % 13 - 6);
            let at = 100.0 * size * random.cube();
            let scale = size * (0.05 + random.cube().abs());
            let posed = mesh.transformed(|p| Quat::from_axis_angle(axis, angle) * (p * scale) + at);
            assert_closed(&posed, &mut random, &format!("n = {n}, size {size}"));
        }
    }
}

#[test]
fn far_from_the_origin() {
    let mut random = Random(12);
    for _ in 0..20 {
        let at = 1e6 * random.cube();
        for n in [1, 4] {
            assert_closed(&closed_box(n).transformed(|p| 1e3 * p + at), &mut random, "far");
        }
    }
}

#[test]
fn along_axes_at_vertices() {
    for n in [1, 2, 8] {
        along_axes(&closed_box(n));
    }
}

fn along_axes(mesh: &OwnedMesh) {
    let geometry = mesh.build();
    for p in &mesh.positions {
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                for zero in [0.0, -0.0] {
                    let mut direction = Vec3::splat(zero);
                    direction[axis] = sign;
                    let mut origin = *p;
                    origin[axis] = 0.0;
                    for (hit, occluded) in meet_both(&geometry, &Ray::new(origin, direction)) {
                        assert!(hit.is_some() && occluded, "{origin} {direction}");
                    }
                }
            }
        }
    }
}
