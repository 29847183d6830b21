//! Surfaces of each kind of shape, instances against transformed copies, and trees against thread counts.

mod common;

use std::f32::consts::{FRAC_1_SQRT_2, TAU};

use common::{OwnedMesh, Random, soup};
use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};
use sr_geometry::{
    BilinearPatch, Cylinder, Disk, Geometry, GeometryInput, Instance, NO_INSTANCE, Ray, Shape, ShapeId,
    ShapeRef, Sphere, TriangleMesh,
};

fn build(shapes: Vec<Shape<'_>>) -> Geometry {
    Geometry::build(GeometryInput { shapes, ..Default::default() }).unwrap()
}

#[test]
fn a_triangle_interpolates_what_its_vertices_have() {
    let positions = [Vec3::ZERO, 2.0 * Vec3::X, 2.0 * Vec3::Y];
    let normals = [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.6, 0.8)];
    let uvs = [Vec2::new(0.5, 0.0), Vec2::new(1.0, 0.0), Vec2::new(0.5, 2.0)];
    let mesh = TriangleMesh { positions: &positions, triangles: &[[0, 1, 2]], ..Default::default() };
    let ray = Ray::new(Vec3::new(0.5, 1.0, -3.0), Vec3::Z);

    let flat = build(vec![Shape::Mesh(mesh)]);
    let hit = flat.intersect(&ray).unwrap();
    let surface = flat.surface(&ray, &hit);
    assert_eq!((hit.t, hit.b1, hit.b2, hit.instance), (3.0, 0.25, 0.5, NO_INSTANCE));
    assert_eq!((surface.ng, surface.ns, surface.uv), (Vec3::Z, Vec3::Z, Vec2::new(0.25, 0.5)));
    assert_eq!(surface.p, Vec3::new(0.5, 1.0, 0.0));
    let tangents = flat.tangents(&surface, &hit);
    assert_eq!((tangents.dpdu, tangents.dpdv), (2.0 * Vec3::X, 2.0 * Vec3::Y));

    let smooth = build(vec![Shape::Mesh(TriangleMesh { normals: &normals, uvs: &uvs, ..mesh })]);
    let surface = smooth.surface(&ray, &hit);
    assert!(surface.ns.distance(Vec3::new(0.15, 0.3, 0.85).normalize()) < 1e-6);
    assert_eq!((surface.ng, surface.uv), (Vec3::Z, Vec2::new(0.625, 1.0)));
    let tangents = smooth.tangents(&surface, &hit);
    assert!(tangents.dpdu.distance(4.0 * Vec3::X) < 1e-6 && tangents.dpdv.distance(Vec3::Y) < 1e-6);
}

#[test]
fn a_sphere_seen_from_both_sides() {
    let frame = Mat3::from_quat(Quat::from_rotation_x(1.0) * Quat::from_rotation_z(0.5));
    let center = Vec3::new(1.0, 2.0, 3.0);
    for flip_normals in [false, true] {
        let geometry = build(vec![Shape::Sphere(Sphere { center, radius: 2.0, frame, flip_normals })]);
        let sign = if flip_normals { -1.0 } else { 1.0 };
        let mut random = Random(41);
        for _ in 0..1000 {
            let out = random.direction();
            let outside = Ray::new(center + 5.0 * out, -out);
            let inside = Ray::new(center + 0.5 * out, 2.0 * out);
            for (ray, t) in [(outside, 3.0), (inside, 0.75)] {
                let hit = geometry.intersect(&ray).unwrap();
                assert!((hit.t - t).abs() < 1e-5);
                let surface = geometry.surface(&ray, &hit);
                assert!(surface.ng.distance(sign * out) < 1e-5 && surface.ns == surface.ng);
                assert!(surface.p.distance(center + 2.0 * out) < 1e-5);
                let local = frame.transpose() * out;
                let (phi, theta) = (TAU * surface.uv.x, TAU * 0.5 * surface.uv.y);
                let back = Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
                assert!(back.distance(local) < 1e-5 && surface.uv.min_element() >= 0.0, "{}", surface.uv);
                let tangents = geometry.tangents(&surface, &hit);
                // South × east points outwards.
                let normal = tangents.dpdv.cross(tangents.dpdu);
                assert!(normal.normalize_or(out).dot(out) > 0.999, "{normal}");
            }
        }
        assert_eq!(geometry.intersect(&Ray::new(center + 5.0 * Vec3::X, Vec3::X)), None);
        assert_eq!(geometry.intersect(&Ray::new(center + 2.01 * Vec3::X, Vec3::Y)), None);
    }
}

#[test]
fn a_disk_has_a_rim_and_two_sides() {
    let disk = Disk { center: Vec3::Z, u_axis: 2.0 * Vec3::X, v_axis: Vec3::Y, flip_normals: false };
    let geometry = build(vec![Shape::Disk(disk)]);
    for z in [-2.0, 4.0] {
        let at = |x: f32, y: f32| Ray::new(Vec3::new(x, y, z), Vec3::Z * (1.0 - z));
        assert!(
            geometry.intersect(&at(1.99, 0.0)).is_some() && geometry.intersect(&at(0.0, -0.99)).is_some()
        );
        assert!(geometry.intersect(&at(2.01, 0.0)).is_none() && geometry.intersect(&at(1.5, 0.7)).is_none());
        let ray = at(0.0, -0.5);
        let surface = geometry.surface(&ray, &geometry.intersect(&ray).unwrap());
        assert_eq!((surface.p, surface.ng), (Vec3::new(0.0, -0.5, 1.0), Vec3::Z));
        assert!(surface.uv.distance(Vec2::new(0.5, 0.75)) < 1e-6);
    }
    let flipped = build(vec![Shape::Disk(Disk { flip_normals: true, ..disk })]);
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    assert_eq!(flipped.surface(&ray, &flipped.intersect(&ray).unwrap()).ng, Vec3::NEG_Z);
}

/// Figures printed by Mitsuba 3.9.1 (`Scene.ray_intersect`, `scalar_rgb`) for the same shapes and rays.
#[test]
fn conventions_agree_with_mitsuba() {
    let near = |a: Vec3, b: [f32; 3]| assert!(a.distance(b.into()) < 1e-4, "{a} {b:?}");
    let sphere =
        Sphere { center: Vec3::new(1.0, 2.0, 3.0), radius: 2.0, frame: Mat3::IDENTITY, flip_normals: false };
    let inside = Ray::new(Vec3::new(1.3, 1.1, 3.0), Vec3::new(0.0, 0.1, -1.0));
    let disk = Disk { center: Vec3::ZERO, u_axis: 2.0 * Vec3::X, v_axis: Vec3::Y, flip_normals: false };
    let down = Ray::new(Vec3::new(0.6, -0.4, 3.0), Vec3::NEG_Z);

    let geometry = build(vec![Shape::Sphere(sphere)]);
    let hit = geometry.intersect(&inside).unwrap();
    let surface = geometry.surface(&inside, &hit);
    let tangents = geometry.tangents(&surface, &hit);
    assert!((hit.t - 1.843_317_4).abs() < 1e-5);
    near(surface.p, [1.3, 1.28433, 1.15668]);
    near(surface.ng, [0.15, -0.357834, -0.921659]);
    near(surface.uv.extend(0.0), [0.813175, 0.873165, 0.0]);
    near(tangents.dpdu, [4.49668, 1.88496, 0.0]);
    near(tangents.dpdv, [-2.23876, 5.3407, -2.43789]);

    let geometry = build(vec![Shape::Disk(disk)]);
    let hit = geometry.intersect(&down).unwrap();
    let surface = geometry.surface(&down, &hit);
    let tangents = geometry.tangents(&surface, &hit);
    near(surface.ng, [0.0, 0.0, 1.0]);
    near(surface.uv.extend(0.0), [0.5, 0.852416, 0.0]);
    near(tangents.dpdu, [1.2, -0.8, 0.0]);
    near(tangents.dpdv, [5.02655, 1.88496, 0.0]);
}

#[test]
fn instances_are_transformed_copies() {
    let mut random = Random(42);
    let mesh = soup(&mut random, 200, 0.5);
    let sphere = Sphere { center: Vec3::splat(0.2), radius: 0.3, frame: Mat3::IDENTITY, flip_normals: false };
    let world_from_group = Affine3A::from_scale_rotation_translation(
        Vec3::new(2.0, -0.5, 1.5),
        Quat::from_rotation_y(0.7),
        Vec3::new(3.0, 1.0, -2.0),
    );
    let instanced = Geometry::build(GeometryInput {
        shapes: vec![Shape::Sphere(Sphere { center: 1e3 * Vec3::ONE, ..sphere })],
        groups: vec![vec![], vec![mesh.shape(), Shape::Sphere(sphere)]],
        instances: vec![Instance { group: 1, world_from_group }],
    })
    .unwrap();
    let copy = mesh.transformed(|p| world_from_group.transform_point3(p)).build();
    let (mut on_mesh, mut on_sphere) = (0, 0);
    for _ in 0..5000 {
        let origin = world_from_group.transform_point3(2.0 * random.cube());
        let ray = Ray::new(origin, world_from_group.transform_point3(random.cube()) - origin);
        let Some(hit) = instanced.intersect(&ray) else {
            assert_eq!(copy.intersect(&ray), None);
            continue;
        };
        assert_eq!(hit.instance, 0);
        let surface = instanced.surface(&ray, &hit);
        assert!(surface.p.distance(ray.at(hit.t)) < 1e-4);
        assert!((surface.ng.length() - 1.0).abs() < 1e-6);
        if hit.shape == ShapeId(2) {
            on_sphere += 1;
            let local = world_from_group.inverse().transform_point3(surface.p);
            assert!((local.distance(sphere.center) / sphere.radius - 1.0).abs() < 1e-4);
            assert!(surface.ng.dot(surface.p - world_from_group.transform_point3(sphere.center)) > 0.0);
            continue;
        }
        on_mesh += 1;
        assert_eq!(hit.shape, ShapeId(1));
        let of_copy = copy.intersect(&ray).expect("the copy is hit too");
        if of_copy.primitive == hit.primitive {
            let copied = copy.surface(&ray, &of_copy);
            assert!((of_copy.t - hit.t).abs() < 1e-4 && copied.p.distance(surface.p) < 1e-4);
            // The placement mirrors, so the copy's winding is reversed: normals stay with the side instead.
            assert!(copied.ng.dot(surface.ng) < -0.999);
        }
    }
    assert!(on_mesh > 500 && on_sphere > 100, "{on_mesh} {on_sphere}");
}

#[test]
fn shapes_are_counted_in_the_order_of_the_input() {
    let mesh = soup(&mut Random(43), 3, 0.5);
    let sphere = Sphere { center: Vec3::ONE, radius: 0.5, frame: Mat3::IDENTITY, flip_normals: false };
    let geometry = Geometry::build(GeometryInput {
        shapes: vec![mesh.shape(), Shape::Sphere(sphere)],
        groups: vec![vec![Shape::Sphere(sphere)], vec![mesh.shape()]],
        instances: vec![],
    })
    .unwrap();
    assert_eq!(geometry.shape_count(), 4);
    let counts: Vec<u32> = (0..4).map(|i| geometry.primitive_count(ShapeId(i))).collect();
    assert_eq!(counts, [3, 1, 1, 3]);
    assert!(matches!(geometry.shape_of(ShapeId(2)), ShapeRef::Sphere(s) if *s == sphere));
    let last = geometry.triangle_vertices(ShapeId(3), 2);
    assert_eq!(last.to_vec(), mesh.positions[6..9]);
    assert!(geometry.memory_bytes() > 6 * size_of::<[Vec3; 3]>());
}

#[test]
fn any_number_of_threads_gives_the_same_hits() {
    let mut random = Random(44);
    let mut mesh: OwnedMesh = soup(&mut random, 150_000, 0.03);
    // Ties everywhere: whatever order the tree has, it must not depend on the threads.
    mesh.triangles.extend(mesh.triangles.clone());
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| mesh.build())
    };
    let (one, two, five) = (build(1), build(2), build(5));
    let mut hits = 0;
    for _ in 0..20_000 {
        let ray = Ray::new(random.cube(), random.direction() * FRAC_1_SQRT_2);
        let hit = one.intersect(&ray);
        hits += u32::from(hit.is_some());
        assert_eq!(hit, two.intersect(&ray));
        assert_eq!(hit, five.intersect(&ray));
    }
    assert!(hits > 10_000);
}

/// Mitsuba 3.9.1 gives these figures for the same rays (`ray_intersect` in `scalar_rgb`).
#[test]
fn a_cylinder_is_mitsuba_s() {
    let upright =
        Cylinder { base: Vec3::ZERO, frame: Mat3::IDENTITY, radius: 1.0, length: 1.0, flip_normals: false };
    let mirrored = Cylinder { frame: Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0)), ..upright };
    let scaled = Cylinder { radius: 2.0, length: 3.0, ..upright };
    let inwards = Cylinder { flip_normals: true, ..upright };
    let (x, y) = (0.953_939, 0.3);
    let outside = Ray::new(Vec3::new(3.0, 0.3, 0.25), Vec3::NEG_X);
    let inside = Ray::new(Vec3::new(0.0, 0.3, 0.25), Vec3::NEG_X);
    for (cylinder, ray, t, n, uv, dpdu) in [
        (upright, outside, 2.046_060_6, (x, y), (0.048_493_3, 0.25), (-1.884_96, 5.993_78)),
        (mirrored, outside, 2.046_060_6, (x, y), (0.451_507, 0.25), (1.884_96, -5.993_78)),
        (inwards, outside, 2.046_060_6, (-x, -y), (0.048_493_3, 0.25), (-1.884_96, 5.993_78)),
        (scaled, outside, 1.022_627_6, (0.988_686, 0.15), (0.023_963_7, 0.083_333_3), (-1.884_96, 12.424_2)),
        (upright, inside, 0.953_939_3, (-x, y), (0.451_507, 0.25), (-1.884_96, -5.993_78)),
    ] {
        let geometry = build(vec![Shape::Cylinder(cylinder)]);
        let hit = geometry.intersect(&ray).unwrap();
        let surface = geometry.surface(&ray, &hit);
        let tangents = geometry.tangents(&surface, &hit);
        assert!((hit.t - t).abs() < 1e-5, "{}", hit.t);
        assert!((surface.ng - Vec3::new(n.0, n.1, 0.0)).length() < 1e-5, "{}", surface.ng);
        assert!((surface.uv - Vec2::new(uv.0, uv.1)).length() < 1e-5, "{}", surface.uv);
        assert_eq!(surface.uv, geometry.uv(&ray, &hit));
        assert!((tangents.dpdu - Vec3::new(dpdu.0, dpdu.1, 0.0)).length() < 1e-4, "{}", tangents.dpdu);
        assert_eq!(tangents.dpdv, cylinder.length * Vec3::Z);
        assert!(geometry.bounds().min.cmple(surface.p).all() && geometry.bounds().max.cmpge(surface.p).all());
    }
    // open at its ends, and nowhere else
    let geometry = build(vec![Shape::Cylinder(upright)]);
    assert_eq!(geometry.intersect(&Ray::new(Vec3::new(0.2, 0.3, -5.0), Vec3::Z)), None);
    assert_eq!(geometry.intersect(&Ray::new(Vec3::new(-3.0, 0.3, 1.01), Vec3::X)), None);
    let slanted = Ray::new(Vec3::new(-1.5, 0.0, 1.25), Vec3::new(1.0, 0.0, -0.5));
    let hit = geometry.intersect(&slanted).unwrap();
    assert!((slanted.at(hit.t) - Vec3::new(-1.0, 0.0, 1.0)).length() < 1e-6);
}

#[test]
fn a_flat_patch_is_a_rectangle() {
    let corners = [(0.0, 0.0), (2.0, 0.0), (0.0, 1.0), (2.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
    let geometry = build(vec![Shape::Patch(BilinearPatch { corners, flip_normals: false })]);
    let ray = Ray::new(Vec3::new(0.5, 0.75, 3.0), Vec3::NEG_Z);
    let hit = geometry.intersect(&ray).unwrap();
    let surface = geometry.surface(&ray, &hit);
    assert_eq!((hit.t, surface.uv, surface.ng), (3.0, Vec2::new(0.25, 0.75), Vec3::Z));
    assert_eq!(geometry.intersect(&Ray::new(Vec3::new(2.1, 0.5, 3.0), Vec3::NEG_Z)), None);
}

/// A hyperbolic paraboloid z = x y, cut into patches: rays from above hit it once, where it is.
#[test]
fn patches_that_share_edges_have_no_gaps() {
    let mut random = Random(45);
    let n = 7;
    let at = |i: usize, j: usize| {
        let (x, y) = (0.3 * i as f32 - 1.0, 0.3 * j as f32 - 1.0);
        Vec3::new(x, y, x * y)
    };
    let patches: Vec<_> = (0..n * n)
        .map(|k| {
            let (i, j) = (k % n, k / n);
            let corners = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
            Shape::Patch(BilinearPatch { corners, flip_normals: false })
        })
        .collect();
    let geometry = build(patches);
    for step in 0..40_000 {
        // every other ray through an edge
        let mut x = -0.99 + 2.07 * random.unit();
        if step % 2 == 0 {
            x = at(1 + random.below(n - 1), 0).x;
        }
        let y = -0.99 + 2.07 * random.unit();
        let target = Vec3::new(x, y, x * y);
        let ray = Ray::new(target + Vec3::new(0.02, 0.01, 3.0), Vec3::new(-0.02, -0.01, -3.0));
        let hit = geometry.intersect(&ray).unwrap_or_else(|| panic!("a gap at {target}"));
        let surface = geometry.surface(&ray, &hit);
        assert!((surface.p - target).length() < 2e-6, "{} is not {target}", surface.p);
        let normal = Vec3::new(-y, -x, 1.0).normalize();
        assert!((surface.ng - normal).length() < 1e-5, "{} is not {normal}", surface.ng);
        let tangents = geometry.tangents(&surface, &hit);
        assert!(tangents.dpdu.normalize().dot(surface.ng).abs() < 1e-5);
    }
}
