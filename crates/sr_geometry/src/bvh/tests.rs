//! The tree's invariants, and the kernels against one another.

use glam::{Mat3, Vec2, Vec3};

use super::sheared::Triangles;
use super::simd::{Kernel, Portable};
use super::{Bvh, FEW, FEW_ROUNDS, Few, Form, MAX_DEPTH, Met, NodeRef, PrimRef, Round, Tree, WIDE};
use crate::{BATCH, Bounds3, Disk, Hit, Hits, NO_INSTANCE, Ray, Rays, ShapeId, Sphere};

/// A triangle at `at` with edges of about `size`.
fn triangle(at: Vec3, size: f32, i: u32) -> [Vec3; 3] {
    let turn =
        |k: u32| Vec3::new((i * 3 + k) as f32, (i * 5 + k * 2) as f32, (i * 7 + k * 3) as f32).map(f32::sin);
    [at, at + size * turn(1), at + size * turn(2)]
}

fn build(triangles: &[[Vec3; 3]], rounds: &[Round<'_>]) -> (Bvh, Tree) {
    let prim = |(i, vertices): (usize, &[Vec3; 3])| {
        let bounds = vertices.iter().fold(Bounds3::EMPTY, |bounds, &v| bounds.with(v));
        PrimRef::new(bounds, 0, i as u32)
    };
    let other = |(i, round): (usize, &Round<'_>)| {
        let bounds = match round {
            Round::Sphere(_, sphere) => sphere.bounds(),
            Round::Disk(_, disk) => disk.bounds(),
        };
        PrimRef::new(bounds, PrimRef::OTHER, i as u32)
    };
    let mut prims: Vec<PrimRef> = triangles.iter().enumerate().map(prim).collect();
    prims.extend(rounds.iter().enumerate().map(other));
    let mut bvh = Bvh::new();
    let vertices_of = |ShapeId(_), i: u32| triangles[i as usize];
    let mut tree = bvh.add_tree(&mut prims, vertices_of);
    bvh.add_pieces(&mut tree, &prims, vertices_of, |i| Some(rounds[i as usize]));
    (bvh, tree)
}

fn meet_round(round: Round<'_>, ray: &Ray) -> Option<Hit> {
    let (shape, t, at) = match round {
        Round::Sphere(shape, sphere) => (shape, sphere.intersect(ray)?, Vec2::ZERO),
        Round::Disk(shape, disk) => disk.intersect(ray).map(|(t, at)| (shape, t, at))?,
    };
    Some(Hit { t, b1: at.x, b2: at.y, shape, primitive: 0, instance: NO_INSTANCE })
}

/// Checks that children lie in their boxes; returns the depth and every triangle found.
fn visit(bvh: &Bvh, child: NodeRef, bounds: &Bounds3, found: &mut Vec<u32>) -> usize {
    if child.is_leaf() {
        let leaf = bvh.leaves.leaf(child);
        for lane in 0..child.count() {
            let vertices = Triangles::<Portable>::vertices(&leaf, lane);
            assert!(vertices.iter().all(|&vertex| bounds.with(vertex) == *bounds));
            found.push(bvh.leaves.id(child.first() + lane)[1]);
        }
        return 0;
    }
    assert!(child.is_node());
    let node = &bvh.nodes[child.index()];
    let mut depth = 0;
    for slot in (0..WIDE).filter(|&slot| node.children[slot] != NodeRef::NONE) {
        let end = |end: usize| Vec3::from_array([0, 1, 2].map(|axis| node.bounds[axis][end][slot]));
        let inner = Bounds3 { min: end(0), max: end(1) };
        assert_eq!(bounds.union(inner), *bounds);
        depth = depth.max(visit(bvh, node.children[slot], &inner, found));
    }
    depth + 1
}

fn check_tree(triangles: &[[Vec3; 3]]) -> usize {
    let (bvh, tree) = build(triangles, &[]);
    let mut found = Vec::new();
    let depth = match tree.form {
        Form::Nodes(root) => visit(&bvh, root, &tree.bounds, &mut found),
        Form::Few(Few { first, count, .. }) => {
            let triangle = |i: usize| bvh.few[first as usize + i / WIDE].primitive[i % WIDE];
            found.extend((0..count as usize).map(triangle));
            0
        }
    };
    found.sort_unstable();
    assert!(found.into_iter().eq(0..triangles.len() as u32), "each triangle is in exactly one block");
    assert!(depth <= MAX_DEPTH, "{depth}");
    depth
}

#[test]
fn every_triangle_is_in_one_block_within_its_boxes() {
    for count in [1, 8, 17, FEW as u32, FEW as u32 + 1, 10_000] {
        let at = |i: u32| Vec3::new((i % 17) as f32, (i % 31) as f32, (i % 101) as f32);
        let triangles: Vec<_> = (0..count).map(|i| triangle(at(i), 0.5, i)).collect();
        check_tree(&triangles);
    }
}

#[test]
fn the_depth_is_bounded_where_the_heuristic_peels_off_one_at_a_time() {
    // Sizes and distances double: the best cut always takes the largest alone.
    let many =
        |i: u32| triangle(Vec3::X * 2f32.powi((i % 120) as i32 - 60), 2f32.powi((i % 120) as i32 - 62), i);
    let triangles: Vec<_> = (0..20_000).map(many).collect();
    assert!(check_tree(&triangles) >= 6);
    // All in one place.
    check_tree(&[triangle(Vec3::ONE, 1.0, 3); 5000]);
}

/// Meets rays in batches of `count`.
fn meet_batches(
    bvh: &Bvh,
    tree: &Tree,
    rounds: &[Round<'_>],
    rays: &[Ray],
    count: usize,
) -> Vec<(Option<Hit>, bool)> {
    let mut met = Vec::new();
    let meet_other = |i: u32, ray: &Ray| Met::Hit(meet_round(rounds[i as usize], ray));
    for rays in rays.chunks(count) {
        let (mut batch, mut hits, mut occluded) = (Rays::NONE, Hits::NONE, [false; BATCH]);
        for (i, ray) in rays.iter().enumerate() {
            batch.set(i, ray);
        }
        bvh.intersect_batch(tree, (&batch, rays.len()), meet_other, &mut hits);
        bvh.occluded_batch(tree, (&batch, rays.len()), meet_other, &mut occluded);
        met.extend((0..rays.len()).map(|i| (hits.get(i), occluded[i])));
    }
    met
}

/// Holds all kernels against one another.
fn check_kernels(triangles: &[[Vec3; 3]], rounds: &[Round<'_>], rays: &[Ray]) -> usize {
    let (mut bvh, tree) = build(triangles, rounds);
    let other = |i: u32, ray: &Ray| Met::Hit(meet_round(rounds[i as usize], ray));
    let hits = |bvh: &Bvh| -> Vec<_> {
        rays.iter().map(|ray| (bvh.intersect(&tree, ray, other), bvh.occluded(&tree, ray, other))).collect()
    };
    let (detected, in_batches) = (hits(&bvh), meet_batches(&bvh, &tree, rounds, rays, BATCH));
    let settings = Kernel::available().flat_map(|kernel| [(kernel, false), (kernel, true)]);
    for (kernel, prefetches) in settings {
        (bvh.kernel, bvh.prefetches) = (kernel, prefetches);
        let name = format!("{kernel:?}, prefetches: {prefetches}");
        assert_eq!(detected, hits(&bvh), "{name}");
        for count in [BATCH, 21] {
            assert_eq!(
                in_batches,
                meet_batches(&bvh, &tree, rounds, rays, count),
                "{name}, {count} at a time"
            );
        }
    }
    if tree.pieces.is_none() {
        assert_eq!(detected, in_batches);
    }
    detected.iter().filter(|(hit, _)| hit.is_some()).count()
}

/// Points scattered in [-3, 3]³.
fn scattered(i: u32) -> Vec3 {
    3.0 * Vec3::new(i as f32, 1.7 * i as f32, 2.9 * i as f32).map(f32::sin)
}

/// Rays everywhere, and some that are none.
fn all_kinds_of_rays() -> Vec<Ray> {
    let ray = |i: u32| {
        // Some along planes and axes.
        let direction = scattered(i * 7 + 3) * Vec3::new((i % 5) as f32, (i % 3) as f32, 1.0);
        let t_max = if i.is_multiple_of(4) { 0.5 } else { f32::INFINITY };
        Ray { t_max, ..Ray::new(scattered(i * 3 + 1), direction) }
    };
    let mut rays: Vec<Ray> = (0..5000).map(ray).collect();
    for bad in [f32::NAN, f32::INFINITY, 0.0] {
        rays.push(Ray::new(Vec3::ONE, Vec3::splat(bad)));
        rays.push(Ray::new(Vec3::splat(bad), Vec3::X));
        rays.push(Ray { t_max: bad, ..Ray::new(Vec3::ZERO, scattered(1)) });
    }
    rays
}

#[test]
fn kernels_agree_to_the_bit() {
    let rays = all_kinds_of_rays();
    for (count, size) in [(5, 2.0), (37, 1.5), (300, 1.0), (5000, 0.3)] {
        let mut triangles: Vec<_> = (0..count).map(|i| triangle(scattered(i), size, i)).collect();
        assert!(check_kernels(&triangles, &[], &rays) > 100);
        // Each twice: which of two at the same distance is met must not depend on the number of lanes.
        if count == 5 {
            triangles.extend_from_within(..);
            triangles.extend_from_within(..);
            check_kernels(&triangles, &[], &rays);
        }
    }
}

#[test]
fn kernels_agree_on_spheres_and_disks() {
    let rays = all_kinds_of_rays();
    for (count, triangles) in [(1, 0), (3, 12), (8, 0), (8, 64), (33, 12)] {
        let triangles: Vec<_> = (0..triangles).map(|i| triangle(scattered(i), 1.0, i)).collect();
        let sphere = |i: u32| {
            let radius = 10f32.powi(i as i32 % 4 - 2);
            Sphere { center: scattered(i + 40), radius, frame: Mat3::IDENTITY, flip_normals: false }
        };
        let disk = |i: u32| {
            let (u_axis, v_axis) = scattered(i + 60).normalize().any_orthonormal_pair();
            Disk { center: scattered(i + 80), u_axis, v_axis: 2.0 * v_axis, flip_normals: false }
        };
        let spheres: Vec<_> = (0..count).map(sphere).collect();
        let disks: Vec<_> = (0..count).map(disk).collect();
        let mut rounds: Vec<_> = spheres.iter().map(|s| Round::Sphere(ShapeId(1), s)).collect();
        rounds.extend(disks.iter().map(|d| Round::Disk(ShapeId(2), d)));
        let (_, tree) = build(&triangles, &rounds);
        assert_eq!(tree.pieces.is_some(), rounds.len() <= FEW_ROUNDS);
        assert!(check_kernels(&triangles, &rounds, &rays) > 100);
    }
}

/// Long strips side by side, and rays that leave them: hits that have to be looked at twice.
#[test]
fn kernels_agree_on_slivers() {
    for strips in [8_u32, 100] {
        let turn = glam::Quat::from_axis_angle(Vec3::new(0.36, 0.48, 0.8), 1.0);
        let corner = |i: u32, y: f32| turn * Vec3::new(i as f32 * 0.02, 4.0 * y, 1.0);
        let strip = |i: u32| {
            let [a, b, c, d] = [corner(i, 0.0), corner(i + 1, 0.0), corner(i + 1, 1.0), corner(i, 1.0)];
            [[a, b, c], [a, c, d]]
        };
        let triangles: Vec<_> = (0..strips).flat_map(strip).collect();
        let rays: Vec<_> = (0..4000_u32)
            .map(|i| {
                let [a, b, c] = triangles[i as usize % triangles.len()];
                let u = (i % 97) as f32 / 97.0;
                let origin = a + 0.4 * u * (b - a) + 0.5 * (1.0 - u) * (c - a);
                let normal = (b - a).cross(c - a).normalize();
                // From a little below to a little above the plane.
                let along = Vec3::new(i as f32, 1.3 * i as f32, 2.1 * i as f32).map(f32::sin);
                Ray::new(origin + normal * ((i % 7) as f32 - 3.0) * 1e-6, along)
            })
            .collect();
        assert!(check_kernels(&triangles, &[], &rays) > 100);
    }
}
