//! Empty scenes, rays that are none, shapes that are hardly any, and bad input.

mod common;

use common::{OwnedMesh, Random, check_against_brute_force, closed_box, meet_batch, meet_both, soup};
use glam::{Affine3A, Mat3, Vec2, Vec3};
use sr_geometry::{
    Geometry, GeometryError, GeometryInput, Instance, MeshError, Ray, Shape, Sphere, TriangleMesh,
};

#[test]
fn an_empty_scene_is_never_hit() {
    let geometry = Geometry::build(GeometryInput::default()).unwrap();
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    assert_eq!(meet_both(&geometry, &ray), [(None, false); 2]);
    assert!(geometry.bounds().is_empty());

    let empty_group = GeometryInput {
        groups: vec![vec![]],
        instances: vec![Instance { group: 0, world_from_group: Affine3A::IDENTITY }],
        ..Default::default()
    };
    assert_eq!(Geometry::build(empty_group).unwrap().intersect(&ray), None);
}

#[test]
fn rays_that_are_none_hit_nothing() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let soups = [1, 3, 100].map(|count| soup(&mut Random(31), count, 2.0));
    for mesh in soups.into_iter().chain([closed_box(1)]) {
        let geometry = mesh.build();
        let mut rays = vec![
            Ray::new(Vec3::ZERO, Vec3::ZERO),
            Ray::new(Vec3::ZERO, Vec3::new(0.0, -0.0, 0.0)),
            Ray { t_max: 0.0, ..Ray::new(Vec3::ZERO, Vec3::X) },
            Ray { t_max: -1.0, ..Ray::new(Vec3::ZERO, Vec3::X) },
            Ray { t_max: f32::NAN, ..Ray::new(Vec3::ZERO, Vec3::X) },
            Ray { t_max: -f32::NAN, ..Ray::new(Vec3::ZERO, Vec3::X) },
        ];
        for x in bad {
            for axis in 0..3 {
                let mut v = Vec3::ONE;
                v[axis] = x;
                rays.extend([Ray::new(v, Vec3::X), Ray::new(Vec3::ZERO, v), Ray::new(v, v)]);
            }
        }
        for ray in &rays {
            assert_eq!(meet_both(&geometry, ray), [(None, false); 2], "{ray:?}");
        }
        assert!(meet_batch(&geometry, &rays).into_iter().all(|met| met == (None, false)));
    }
}

#[test]
fn extreme_directions_neither_hang_nor_panic() {
    let geometries = [30, 1000].map(|count| soup(&mut Random(32), count, 0.5).build());
    for exponent in [-45, -40, -30, -20, 20, 30, 37] {
        for direction in [Vec3::X, Vec3::new(1.0, -1.0, 0.5), Vec3::new(1e-9, 0.0, 1.0)] {
            let ray = Ray::new(Vec3::ZERO, direction * 10f32.powi(exponent));
            for geometry in &geometries {
                let [single, in_batch] = meet_both(geometry, &ray);
                assert_eq!(single.0.map(|hit| hit.primitive), in_batch.0.map(|hit| hit.primitive));
            }
        }
    }
}

#[test]
fn triangles_without_area_are_never_hit() {
    let mut random = Random(33);
    let mut mesh = OwnedMesh::default();
    for _ in 0..100 {
        let (a, b) = (random.cube(), random.cube());
        mesh.push([a, a, b]);
        mesh.push([a, b, a]);
        mesh.push([a, a, a]);
        mesh.push([Vec3::ZERO, Vec3::X, 0.5 * Vec3::X]);
    }
    let geometry = mesh.build();
    for p in &mesh.positions {
        let origin = random.cube();
        assert_eq!(geometry.intersect(&Ray::new(origin, *p - origin)), None);
    }
}

#[test]
fn duplicates_are_hit_once_and_always_the_same() {
    let mut random = Random(34);
    let one = soup(&mut random, 1, 1.0);
    let mut mesh = OwnedMesh::default();
    for _ in 0..1000 {
        mesh.push([one.positions[0], one.positions[1], one.positions[2]]);
    }
    let (geometry, single) = (mesh.build(), one.build());
    for _ in 0..1000 {
        let ray = Ray::new(2.0 * random.cube(), random.cube());
        let hit = geometry.intersect(&ray);
        assert_eq!(hit.map(|hit| hit.t), single.intersect(&ray).map(|hit| hit.t));
    }
}

#[test]
fn scales_from_tiny_to_huge() {
    let mut random = Random(35);
    for exponent in [-9, -6, 6, 9] {
        let size = 10f32.powi(exponent);
        for count in [40, 300] {
            let mesh = soup(&mut random, count, 0.3);
            let unit = mesh.build();
            let scaled = mesh.transformed(|p| size * p).build();
            for _ in 0..500 {
                let ray = Ray::new(random.cube(), random.direction());
                let big = Ray { origin: size * ray.origin, ..ray };
                let met = meet_both(&unit, &ray).into_iter().zip(meet_both(&scaled, &big));
                for ((hit, _), (scaled_hit, _)) in met {
                    if let (Some(a), Some(b)) = (hit, scaled_hit) {
                        assert!(a.primitive != b.primitive || (b.t / a.t / size - 1.0).abs() < 1e-3);
                    }
                    check_against_brute_force(&unit, &ray, hit, 1e-3);
                    let back = scaled_hit.map(|hit| sr_geometry::Hit { t: hit.t / size, ..hit });
                    check_against_brute_force(&unit, &ray, back, 2e-3);
                }
            }
        }
    }
}

#[test]
fn bad_input_is_named() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh = TriangleMesh { positions: &positions, triangles: &[[0, 1, 2]], ..Default::default() };
    let error = |shape: Shape<'_>| {
        Geometry::build(GeometryInput { shapes: vec![shape], ..Default::default() }).expect_err("bad input")
    };
    let nan = [Vec3::ZERO, Vec3::NAN, Vec3::Y];
    let cases = [
        (TriangleMesh { positions: &nan, ..mesh }, MeshError::NotFinite { what: "vertex", vertex: 1 }),
        (TriangleMesh { normals: &nan, ..mesh }, MeshError::NotFinite { what: "normal", vertex: 1 }),
        (
            TriangleMesh { uvs: &[Vec2::NAN; 3], ..mesh },
            MeshError::NotFinite { what: "texture coordinate", vertex: 0 },
        ),
        (
            TriangleMesh { triangles: &[[0, 1, 2], [0, 1, 3]], ..mesh },
            MeshError::VertexOutOfRange { triangle: 1, index: 3, vertices: 3 },
        ),
        (
            TriangleMesh { normals: &nan[..2], ..mesh },
            MeshError::Count { what: "normal", count: 2, vertices: 3 },
        ),
    ];
    for (bad, expected) in cases {
        assert_eq!(error(Shape::Mesh(bad)), GeometryError::Mesh { shape: 0, error: expected });
    }
    for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let sphere = Sphere { center: Vec3::ZERO, radius, frame: Mat3::IDENTITY, flip_normals: false };
        assert!(matches!(error(Shape::Sphere(sphere)), GeometryError::Sphere { .. }));
    }
    let placed = |group, world_from_group| {
        Geometry::build(GeometryInput {
            groups: vec![vec![Shape::Mesh(mesh)]],
            instances: vec![Instance { group, world_from_group }],
            ..Default::default()
        })
    };
    assert_eq!(
        placed(1, Affine3A::IDENTITY).expect_err("no such group"),
        GeometryError::GroupOutOfRange { instance: 0, group: 1, groups: 1 }
    );
    assert_eq!(
        placed(0, Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))).expect_err("singular"),
        GeometryError::SingularInstance { instance: 0 }
    );
}
