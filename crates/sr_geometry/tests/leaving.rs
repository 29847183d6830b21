//! Rays that leave a surface do not meet it again, and do not pass through it.

mod common;

use common::{OwnedMesh, Random, closed_box, meet_both};
use glam::{Affine3A, Mat3, Quat, Vec3};
use sr_geometry::{
    BilinearPatch, Cylinder, Disk, Geometry, GeometryInput, Hit, Instance, NO_INSTANCE, Ray, Shape, ShapeId,
    Sphere, Surface,
};

/// Is `surface` so near an edge of the triangle that rounding may have put it outside a neighbouring side?
fn at_an_edge(surface: &Surface, vertices: [Vec3; 3]) -> bool {
    let distance = |i: usize| {
        let (a, b) = (vertices[i], vertices[(i + 1) % 3]);
        (surface.p - a).cross(b - a).length() / (b - a).length()
    };
    (0..3).any(|i| distance(i) <= 4.0 * surface.clearance)
}

/// Walks through the inside of a closed convex box. Every ray must hit, and never the flat side that it leaves
/// (`side` numbers them). Only from within rounding errors of an edge may it be lost.
/// Returns how often it was.
fn walk_inside(
    geometry: &Geometry,
    center: Vec3,
    steps: u32,
    world_from_mesh: Affine3A,
    side: impl Fn(u32) -> u32,
    random: &mut Random,
    what: &str,
) -> u32 {
    let mut ray = Ray::new(center, random.direction());
    let mut last: Option<(Surface, Hit)> = None;
    let mut lost = 0;
    for step in 0..steps {
        // Every other step by a ray that is one of a batch.
        let (hit, _) = meet_both(geometry, &ray)[step as usize % 2];
        let fine =
            hit.is_some_and(|hit| last.is_none_or(|(_, last)| side(last.primitive) != side(hit.primitive)));
        if !fine {
            let (surface, left) = last.expect("a ray from the centre hits");
            let vertices = geometry.triangle_vertices(left.shape, left.primitive);
            let excused = at_an_edge(&surface, vertices.map(|v| world_from_mesh.transform_point3(v)));
            assert!(excused, "{what}, step {step}: {ray:?} left {left:?} and met {hit:?}");
            lost += 1;
        }
        let Some(hit) = hit.filter(|_| fine) else {
            (ray, last) = (Ray::new(center, random.direction()), None);
            continue;
        };
        let surface = geometry.surface(&ray, &hit);
        let inwards = -surface.ng.dot(ray.direction).signum() * surface.ng;
        // Mostly diffuse, with every sixteenth direction grazing.
        let scatter = if random.below(16) == 0 { 1e3 } else { 0.99 };
        let direction = inwards + scatter * random.direction();
        let below = direction.dot(inwards);
        let direction = if below > 0.0 { direction } else { direction - 2.0 * below * inwards };
        ray = surface.spawn_ray(if direction.dot(inwards) > 1e-6 * direction.length() {
            direction
        } else {
            inwards
        });
        last = Some((surface, hit));
    }
    lost
}

#[test]
fn boxes_at_many_scales() {
    let mut random = Random(21);
    let mut lost = 0;
    for n in [1u32, 4] {
        for i in 0..120 {
            let size = 10f32.powi(i % 13 - 6);
            let at = 10f32.powi(i % 4 - 1) * size * random.cube();
            let turn =
                Quat::from_axis_angle(random.direction(), if i % 3 == 0 { 0.0 } else { random.unit() });
            let mesh = closed_box(n).transformed(|p| turn * (p * size * Vec3::new(1.0, 0.7, 1.3)) + at);
            let what = format!("n {n}, size {size}, at {at}");
            let side = |triangle| triangle / (2 * n * n);
            lost += walk_inside(&mesh.build(), at, 2000, Affine3A::IDENTITY, side, &mut random, &what);
        }
    }
    assert!(lost < 50, "{lost} of 480000");
}

#[test]
fn a_ray_starts_on_the_side_to_which_it_points() {
    let mut mesh = OwnedMesh::default();
    mesh.push([Vec3::new(1e3, 0.0, 0.0), Vec3::new(0.0, 1e3, 5.0), Vec3::new(0.0, -2.0, 1e3)]);
    let surface = mesh.build().surface_of_triangle(ShapeId(0), 0, 0.3, 0.3);
    for direction in [surface.ng, -surface.ng, surface.ng.any_orthogonal_vector() + 0.1 * surface.ng] {
        let moved = (surface.spawn_ray(direction).origin - surface.p).dot(surface.ng);
        assert!(moved * direction.dot(surface.ng) > 0.0, "{direction}: {moved}");
    }
}

/// A flat rectangle of strips, each as long as all of it: a ray that leaves one meets none.
#[test]
fn strips_do_not_hide_one_another() {
    let mut random = Random(25);
    for aspect in [10.0, 300.0, 5000.0] {
        for strips in [1_u32, 8, 100] {
            let turn = Quat::from_axis_angle(random.direction(), random.unit());
            let at = 5.0 * random.cube();
            let mut mesh = OwnedMesh::default();
            let corner = |i: u32, y: f32| Vec3::new(i as f32 * 4.0 / aspect, 4.0 * y, 0.0);
            for i in 0..strips {
                let [a, b, c, d] = [corner(i, 0.0), corner(i + 1, 0.0), corner(i + 1, 1.0), corner(i, 1.0)];
                mesh.push([a, b, c]);
                mesh.push([a, c, d]);
            }
            let geometry = mesh.transformed(|p| turn * p + at).build();
            for _ in 0..20_000 {
                let triangle = random.below(2 * strips as usize) as u32;
                let (u, v) = (random.unit(), random.unit());
                let (b1, b2) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let surface = geometry.surface_of_triangle(ShapeId(0), triangle, b1, b2);
                let up = surface.ng + 0.95 * random.direction();
                for direction in [up, -up] {
                    let ray = surface.spawn_ray(direction);
                    for (met, occluded) in meet_both(&geometry, &ray) {
                        assert!(
                            met.is_none() && !occluded,
                            "aspect {aspect}, {strips} strips: {ray:?} left {triangle}, met {met:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn instances_that_stretch_and_mirror() {
    let mut random = Random(22);
    let mut lost = 0;
    let mesh = closed_box(2);
    for i in 0..60 {
        let scale =
            10f32.powi(i % 5 - 2) * Vec3::new(1.0, if i % 2 == 0 { -0.5 } else { 3.0 }, 0.3 + random.unit());
        let at = 10.0 * random.cube();
        let turn = Quat::from_axis_angle(random.direction(), random.unit());
        let world_from_group = Affine3A::from_scale_rotation_translation(scale, turn, at);
        let geometry = Geometry::build(GeometryInput {
            groups: vec![vec![mesh.shape()]],
            instances: vec![Instance { group: 0, world_from_group }],
            ..Default::default()
        })
        .unwrap();
        let what = format!("scale {scale}, at {at}");
        lost +=
            walk_inside(&geometry, at, 2000, world_from_group, |triangle| triangle / 8, &mut random, &what);
    }
    assert!(lost < 200, "{lost} of 120000");
}

#[test]
fn spheres_from_inside_and_outside() {
    let mut random = Random(23);
    for i in 0..100 {
        let radius = 10f32.powi(i % 9 - 4);
        let center = radius * 10f32.powi(i % 4 - 1) * random.cube();
        let sphere = Sphere { center, radius, frame: Mat3::IDENTITY, flip_normals: i % 2 == 0 };
        let geometry =
            Geometry::build(GeometryInput { shapes: vec![Shape::Sphere(sphere)], ..Default::default() })
                .unwrap();
        let mut ray = Ray::new(center, random.direction());
        for step in 0..500 {
            // Every other step by a ray that is one of a batch.
            let (hit, occluded) = meet_both(&geometry, &ray)[step % 2];
            assert!(occluded, "radius {radius}, {ray:?}");
            let hit = hit.expect("a ray from inside hits");
            let surface = geometry.surface(&ray, &hit);
            let out = (surface.p - center).normalize();
            let direction = random.direction();
            let leaving = surface.spawn_ray(if direction.dot(out) > 0.0 { direction } else { -direction });
            assert_eq!(meet_both(&geometry, &leaving), [(None, false); 2], "radius {radius}, {leaving:?}");
            ray = surface.spawn_ray(if direction.dot(out) > 0.0 { -direction } else { direction });
        }
    }
}

#[test]
fn disks() {
    let mut random = Random(24);
    for i in 0..100 {
        let size = 10f32.powi(i % 9 - 4);
        let turn = Quat::from_axis_angle(random.direction(), random.unit());
        let disk = Disk {
            center: 10.0 * size * random.cube(),
            u_axis: size * (turn * Vec3::X),
            v_axis: 0.5 * size * (turn * Vec3::Y),
            flip_normals: i % 2 == 0,
        };
        let geometry =
            Geometry::build(GeometryInput { shapes: vec![Shape::Disk(disk)], ..Default::default() }).unwrap();
        for _ in 0..100 {
            let origin = disk.center + size * 3.0 * random.direction();
            let target =
                disk.center + disk.u_axis * (random.unit() - 0.5) + disk.v_axis * (random.unit() - 0.5);
            let ray = Ray::new(origin, target - origin);
            for (hit, occluded) in meet_both(&geometry, &ray) {
                assert!(occluded, "{ray:?}");
                let surface = geometry.surface(&ray, &hit.expect("aimed at the disk"));
                let leaving = surface.spawn_ray(random.direction());
                assert_eq!(meet_both(&geometry, &leaving), [(None, false); 2]);
            }
        }
    }
}

#[test]
fn a_ray_to_a_point_stops_before_it_but_sees_what_hides_it() {
    let mut random = Random(25);
    let mut mesh = OwnedMesh::default();
    for z in [0.0, 0.5, 1.0] {
        let corner = |x: f32, y: f32| Vec3::new(3.0 * x, 3.0 * y, z);
        mesh.push([corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.0, 1.0)]);
    }
    let geometry = mesh.build();
    for _ in 0..1000 {
        let from = |geometry: &Geometry, z: f32, random: &mut Random| {
            let ray = Ray::new(0.3 * random.cube().with_z(0.0) + Vec3::Z * (z + 0.1), Vec3::NEG_Z);
            let hit = geometry.intersect(&ray).unwrap();
            assert_eq!(hit.instance, NO_INSTANCE);
            geometry.surface(&ray, &hit)
        };
        let (low, middle, high) = (
            from(&geometry, 0.0, &mut random),
            from(&geometry, 0.5, &mut random),
            from(&geometry, 1.0, &mut random),
        );
        assert!(!geometry.occluded(&low.spawn_ray_to(middle.p)));
        assert!(!geometry.occluded(&high.spawn_ray_to(middle.p)));
        assert!(geometry.occluded(&low.spawn_ray_to(high.p)));
    }
}

#[test]
fn cylinders() {
    let mut random = Random(26);
    for i in 0..100 {
        let radius = 10f32.powi(i % 9 - 4);
        let base = radius * 10f32.powi(i % 4 - 1) * random.cube();
        let frame = Mat3::from_quat(Quat::from_axis_angle(random.direction(), random.unit()));
        let length = radius * 10f32.powi(i % 3 - 1);
        let cylinder = Cylinder { base, frame, radius, length, flip_normals: i % 2 == 0 };
        let geometry =
            Geometry::build(GeometryInput { shapes: vec![Shape::Cylinder(cylinder)], ..Default::default() })
                .unwrap();
        for _ in 0..300 {
            let on_axis = base + random.unit() * length * frame.z_axis;
            let ray = Ray::new(on_axis, frame * random.direction().with_z(0.0));
            let hit = geometry.intersect(&ray).expect("a ray from the axis hits");
            let surface = geometry.surface(&ray, &hit);
            let out = surface.p - on_axis;
            assert!((out.length() / radius - 1.0).abs() < 1e-3, "{}", out.length() / radius);
            // outside of a convex shape there is nothing to hit
            let direction = random.direction();
            let away = if direction.dot(out) > 0.0 { direction } else { -direction };
            let leaving = surface.spawn_ray(away);
            assert_eq!(meet_both(&geometry, &leaving), [(None, false); 2], "radius {radius}, {leaving:?}");
        }
    }
}

#[test]
fn bilinear_patches() {
    let mut random = Random(27);
    let mut hits = 0;
    for i in 0..200 {
        let size = 10f32.powi(i % 9 - 4);
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
            .map(|(x, y)| size * (Vec3::new(x, y, 0.0) + 0.3 * random.cube()));
        let patch = BilinearPatch { corners, flip_normals: i % 2 == 0 };
        let geometry =
            Geometry::build(GeometryInput { shapes: vec![Shape::Patch(patch)], ..Default::default() })
                .unwrap();
        for _ in 0..100 {
            let (u, v) = (random.unit(), random.unit());
            let target = corners[0].lerp(corners[1], u).lerp(corners[2].lerp(corners[3], u), v);
            let origin = target + size * 3.0 * random.direction();
            let ray = Ray::new(origin, target - origin);
            for (hit, occluded) in meet_both(&geometry, &ray) {
                assert!(occluded, "{ray:?}");
                let surface = geometry.surface(&ray, &hit.expect("aimed at the patch"));
                hits += 1;
                // on the ray, and leaving along the normal meets nothing close by
                let off = (surface.p - origin).reject_from(target - origin).length();
                assert!(off < 1e-5 * size, "{off}, size {size}");
                for side in [surface.ng, -surface.ng] {
                    let leaving = surface.spawn_ray(side);
                    if let Some(again) = geometry.intersect(&leaving) {
                        assert!(again.t > 1e-3 * size, "{} of {size}", again.t);
                    }
                }
            }
        }
    }
    assert_eq!(hits, 40_000);
}
