//! Curves against dense tubes of triangles, against formulas, and against what Mitsuba says.

mod common;

use std::f32::consts::{PI, TAU};

use common::{OwnedMesh, Random, meet_both};
use glam::{Affine3A, Quat, Vec2, Vec3, Vec4};
use sr_geometry::{
    CurveBasis, CurveUv, Curves, CurvesError, Geometry, GeometryError, GeometryInput, Instance, Ray, Shape,
    ShapeId,
};

const BASES: [CurveBasis; 3] = [CurveBasis::Linear, CurveBasis::BSpline, CurveBasis::Bezier];

fn curves<'a>(basis: CurveBasis, points: &'a [Vec4], firsts: &'a [u32]) -> Shape<'a> {
    Shape::Curves(Curves { basis, uv: CurveUv::AroundAlong, points, firsts })
}

fn build(shapes: Vec<Shape<'_>>) -> Geometry {
    Geometry::build(GeometryInput { shapes, ..Default::default() }).unwrap()
}

/// Position, radius and direction at `u` of a curve's segment.
fn at(basis: CurveBasis, points: &[Vec4], segment: usize, u: f32) -> (Vec4, Vec3) {
    let p = &points[segment * basis.stride()..];
    let v = 1.0 - u;
    let (at, along) = match basis {
        CurveBasis::Linear => (p[0].lerp(p[1], u), p[1] - p[0]),
        CurveBasis::Bezier => (
            p[0] * v * v * v + p[1] * 3.0 * u * v * v + p[2] * 3.0 * u * u * v + p[3] * u * u * u,
            (p[1] - p[0]) * v * v + (p[2] - p[1]) * 2.0 * u * v + (p[3] - p[2]) * u * u,
        ),
        CurveBasis::BSpline => (
            (p[0] * v * v * v
                + p[1] * (3.0 * u * u * u - 6.0 * u * u + 4.0)
                + p[2] * (3.0 * v * v * v - 6.0 * v * v + 4.0)
                + p[3] * u * u * u)
                / 6.0,
            p[0] * (-v * v)
                + p[1] * (3.0 * u * u - 4.0 * u)
                + p[2] * (1.0 + 2.0 * u - 3.0 * u * u)
                + p[3] * u * u,
        ),
    };
    (at, along.truncate().normalize())
}

/// The surface of a curve that is no chain of cones, as triangles.
fn tube(basis: CurveBasis, points: &[Vec4], (rows, columns): (usize, usize)) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    let segments = basis.segments(points.len()).unwrap();
    let corner = |row: usize, column: usize| {
        let segment = (row / rows).min(segments - 1);
        let (at, along) = at(basis, points, segment, (row - segment * rows) as f32 / rows as f32);
        // Any direction that does not jump along these curves.
        let across = along.cross(Vec3::new(0.36, -0.48, 0.8)).normalize();
        let (sin, cos) = (TAU * column as f32 / columns as f32).sin_cos();
        at.truncate() + at.w * (cos * across + sin * along.cross(across))
    };
    for row in 0..segments * rows {
        for column in 0..columns {
            let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| corner(row + i, column + j));
            mesh.push([a, b, d]);
            mesh.push([a, d, c]);
        }
    }
    mesh
}

/// A wavy curve whose tangents stay away from the plane in which [`tube`]'s directions would jump.
fn wavy(random: &mut Random, is_bezier: bool, count: usize, radius: f32) -> Vec<Vec4> {
    let mut points: Vec<Vec4> = (0..count)
        .map(|i| {
            let along = Vec3::new(0.8, 0.6, 0.0) * (i as f32 * 0.4 - 0.8);
            (along + 0.25 * random.cube()).extend(radius * (0.3 + random.unit()))
        })
        .collect();
    // Bézier splines without corners, which a tube of triangles has no gaps at.
    for k in (4..count).step_by(3) {
        if is_bezier {
            points[k] = 2.0 * points[k - 1] - points[k - 2];
            points[k].w = points[k - 1].w;
        }
    }
    if random.below(4) == 0 {
        points[count - 1].w = 0.0;
    }
    points
}

/// A ray from outside to a place near the curve.
fn towards(random: &mut Random, points: &[Vec4], basis: CurveBasis) -> Ray {
    let segment = random.below(basis.segments(points.len()).unwrap());
    let (center, _) = at(basis, points, segment, random.unit());
    let target = center.truncate() + 1.3 * center.w * random.cube();
    let origin = 4.0 * random.direction();
    Ray::new(origin, (target - origin) * (0.2 + random.unit()))
}

#[test]
fn cubics_are_dense_tubes() {
    let mut random = Random(91);
    let (mut hits, mut wrong) = (0, 0);
    for basis in [CurveBasis::BSpline, CurveBasis::Bezier] {
        for (k, radius) in [0.1, 0.03, 0.004].into_iter().cycle().take(18).enumerate() {
            let points = wavy(&mut random, basis == CurveBasis::Bezier, 4 + 3 * (k % 3), radius);
            let geometry = build(vec![curves(basis, &points, &[0])]);
            let triangles = tube(basis, &points, (200, 80)).build();
            for _ in 0..1500 {
                let ray = towards(&mut random, &points, basis);
                let expected = triangles.intersect(&ray).filter(|hit| {
                    let flat = triangles.surface(&ray, hit);
                    flat.ng.dot(ray.direction) < 0.0
                });
                let [(hit, occluded), (batched, _)] = meet_both(&geometry, &ray);
                assert_eq!(hit, batched);
                assert_eq!(hit.is_some(), occluded);
                hits += u32::from(expected.is_some());
                wrong += match (hit, expected) {
                    (None, None) => 0,
                    (Some(hit), Some(expected)) => {
                        let surface = geometry.surface(&ray, &hit);
                        assert!(surface.p.distance(ray.at(hit.t)) < 1e-5, "{surface:?} {}", ray.at(hit.t));
                        assert!(surface.ng.dot(ray.direction) < 0.0);
                        let facing = -surface.ng.dot(ray.direction.normalize());
                        let off = (hit.t - expected.t).abs() * ray.direction.length();
                        let flat = triangles.surface(&ray, &expected);
                        u32::from(
                            off > 0.02 * radius / facing || (facing > 0.3 && flat.ng.dot(surface.ng) < 0.99),
                        )
                    }
                    // At an outline, or inside a tube that is seen through its end.
                    (None, Some(expected)) => {
                        let flat = triangles.surface(&ray, &expected);
                        u32::from(-flat.ng.dot(ray.direction.normalize()) > 0.15)
                    }
                    (Some(hit), None) => {
                        let surface = geometry.surface(&ray, &hit);
                        let is_first = triangles.intersect(&ray).is_none_or(|first| first.t > hit.t);
                        u32::from(-surface.ng.dot(ray.direction.normalize()) > 0.15 && is_first)
                    }
                };
            }
        }
    }
    assert!(hits > 20_000, "{hits}");
    // Where a tube ends in a point, 80 triangles around it are not round.
    assert!(wrong <= 5, "{wrong} of {hits} differ from triangles");
}

/// The first of many spheres along a chain, met from outside of all of them.
fn meet_spheres(points: &[Vec4], ray: &Ray) -> Option<f64> {
    const STEPS: usize = 4000;
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3().normalize());
    let spheres = points.windows(2).flat_map(|p| {
        let [a, b] = [p[0], p[1]].map(|p| p.as_dvec4());
        (0..=STEPS).map(move |i| a.lerp(b, i as f64 / STEPS as f64))
    });
    let met = spheres.filter_map(|sphere| {
        let to_center = sphere.truncate() - o;
        let along = to_center.dot(d);
        let root = sphere.w * sphere.w - (to_center - along * d).length_squared();
        (root > 0.0).then(|| along - root.sqrt())
    });
    met.min_by(f64::total_cmp).map(|t| t / ray.direction.as_dvec3().length())
}

#[test]
fn chains_are_made_of_spheres() {
    let mut random = Random(92);
    let (mut hits, mut missed) = (0, 0);
    for (k, radius) in [0.3_f32, 0.1, 0.02].into_iter().cycle().take(12).enumerate() {
        let points = wavy(&mut random, false, 2 + k % 4, radius);
        let geometry = build(vec![curves(CurveBasis::Linear, &points, &[0])]);
        for _ in 0..200 {
            let ray = towards(&mut random, &points, CurveBasis::Linear);
            let [(hit, occluded), (batched, _)] = meet_both(&geometry, &ray);
            assert_eq!((hit, hit.is_some()), (batched, occluded));
            match (hit, meet_spheres(&points, &ray)) {
                (Some(hit), Some(t)) => {
                    hits += 1;
                    let surface = geometry.surface(&ray, &hit);
                    let facing = -surface.ng.dot(ray.direction.normalize());
                    let off = (f64::from(hit.t) - t).abs() as f32 * ray.direction.length();
                    assert!(facing > 0.0 && off * facing < 1e-3 * radius, "{ray:?} {hit:?} {t}");
                    assert!(surface.p.distance(ray.at(hit.t)) < 1e-5);
                }
                (None, None) => {}
                (hit, t) => {
                    missed += 1;
                    assert!(hit.is_some() && t.is_none(), "{ray:?} {hit:?} {t:?}");
                }
            }
        }
    }
    assert!(hits > 1000 && missed < 10, "{hits} {missed}");
}

/// Mitsuba 3.9.1 gives these figures for the same rays (`ray_intersect` in `scalar_rgb`).
#[test]
fn curves_are_mitsuba_s() {
    let points = [(-1.0, 0.3), (0.0, 0.3), (1.0, 0.2), (2.0, 0.1)].map(|(x, r)| Vec4::new(x, 0.0, 0.0, r));
    let down = |x: f32, y: f32| Ray::new(Vec3::new(x, y, 3.0), Vec3::NEG_Z);
    let up = |x: f32, y: f32| Ray::new(Vec3::new(x, y, -3.0), Vec3::Z);
    let left = Ray::new(Vec3::new(5.0, 0.0, 0.02), Vec3::NEG_X);
    for (basis, ray, t, n, uv) in [
        (CurveBasis::Linear, down(0.5, 0.0), 2.748_740_7, (0.100_000, 0.0, 0.994_987), (0.25, 0.491_582_5)),
        (CurveBasis::Linear, down(0.5, 0.1), 2.769_497_6, (0.1, 0.396, 0.912_789), (0.184_853, 0.491_582)),
        (CurveBasis::Linear, left, 2.902_020_5, (0.979_796, 0.0, 0.2), (0.25, 1.0)),
        (CurveBasis::Linear, down(-1.2, 0.0), 2.776_393_2, (-0.666_667, 0.0, 0.745_356), (0.25, 0.0)),
        (CurveBasis::Linear, down(0.02, 0.0), 2.700_667_4, (0.066_666_7, 0.0, 0.997_775), (0.25, 1.0 / 3.0)),
        (CurveBasis::Linear, up(0.3, 0.2), 2.816_598, (0.1, 0.733_333, -0.672_474), (0.881_886, 0.424_242)),
        (CurveBasis::BSpline, down(0.5, 0.0), 2.752_083_3, (0.087_166_9, 0.0, 0.996_194), (0.25, 0.5)),
        (
            CurveBasis::BSpline,
            down(0.5, 0.1),
            2.773_146_2,
            (0.087_167, 0.401_826, 0.911_558),
            (0.183_921, 0.5),
        ),
        (CurveBasis::BSpline, up(0.3, 0.2), 2.827_241, (0.075_286, 0.754_616, -0.651_834), (0.886_610, 0.3)),
        (CurveBasis::BSpline, down(0.9, 0.0), 2.790_016_7, (0.099_011, 0.0, 0.995_086), (0.25, 0.9)),
    ] {
        let geometry = build(vec![curves(basis, &points, &[0])]);
        let hit = geometry.intersect(&ray).unwrap();
        let surface = geometry.surface(&ray, &hit);
        assert!((hit.t - t).abs() < 1e-5, "{basis:?} {ray:?}: {}", hit.t);
        assert!((surface.ng - Vec3::from(n)).length() < 1e-5, "{basis:?} {ray:?}: {}", surface.ng);
        assert!((surface.uv - Vec2::from(uv)).length() < 1e-5, "{basis:?} {ray:?}: {}", surface.uv);
        assert_eq!(surface.uv, geometry.uv(&ray, &hit));
    }
    let geometry = build(vec![curves(CurveBasis::BSpline, &points, &[0])]);
    let ray = down(0.5, 0.1);
    let hit = geometry.intersect(&ray).unwrap();
    let tangents = geometry.tangents(&geometry.surface(&ray, &hit), &hit);
    assert!((tangents.dpdu - Vec3::new(0.0, -1.425_365, 0.628_318)).length() < 1e-4, "{}", tangents.dpdu);
    assert!((tangents.dpdv - Vec3::new(1.0, -0.035_294, -0.080_066)).length() < 1e-4, "{}", tangents.dpdv);
    // open at its ends
    assert_eq!(geometry.intersect(&left), None);
    assert_eq!(geometry.intersect(&down(-0.001, 0.1)), None);
    assert_eq!(geometry.intersect(&down(1.02, 0.0)), None);
}

/// From inside nothing is met: neither the tube nor the caps within a chain.
#[test]
fn the_inside_is_never_seen() {
    let mut random = Random(93);
    for basis in BASES {
        let points: Vec<Vec4> = wavy(&mut random, basis == CurveBasis::Bezier, 7, 0.1);
        let geometry = build(vec![curves(basis, &points, &[0])]);
        let count = basis.segments(points.len()).unwrap();
        let mut met = 0;
        for _ in 0..3000 {
            let (center, along) = at(basis, &points, random.below(count), random.unit());
            let from = center.truncate() + 0.9 * center.w * random.unit() * along.cross(random.direction());
            let ray = Ray::new(from, random.direction());
            // Another part of the curve may be in front.
            met += u32::from(geometry.intersect(&ray).is_some_and(|hit| hit.t < 0.1));
        }
        assert!(met < 30, "{basis:?}: {met}");
    }
}

/// A ray that leaves the surface to its outside does not meet it again there, at any size and place.
#[test]
fn rays_leave() {
    let mut random = Random(94);
    let (mut left, mut near) = (0, 0);
    for basis in BASES {
        for (scale, shift) in [(1.0, 0.0), (1e-3, 1.0), (1e3, 1e4), (1e-6, 0.0)] {
            let points: Vec<Vec4> = wavy(&mut random, basis == CurveBasis::Bezier, 7, 0.02)
                .into_iter()
                .map(|p| (p.truncate() * scale + shift * Vec3::ONE).extend(p.w * scale))
                .collect();
            let geometry = build(vec![curves(basis, &points, &[0])]);
            for _ in 0..2000 {
                let (center, _) = at(basis, &points, random.below(basis.segments(7).unwrap()), random.unit());
                let from = center.truncate() + 3.0 * scale * random.direction();
                let ray = Ray::new(from, center.truncate() - from);
                let Some(hit) = geometry.intersect(&ray) else { continue };
                let surface = geometry.surface(&ray, &hit);
                let to = random.direction();
                let to = to * to.dot(surface.ng).signum();
                left += 1;
                if let Some(again) = geometry.intersect(&surface.spawn_ray(to)) {
                    // Where the curve bends inwards, its next part may be close.
                    let is_next = again.primitive != hit.primitive;
                    near += u32::from(again.t < 0.02 * scale);
                    assert!(is_next || again.t > 1e-4 * scale, "{basis:?} at {scale}: {hit:?} {again:?}");
                }
            }
        }
    }
    assert!(left > 10_000 && near < left / 100, "{near} of {left}");
}

#[test]
fn placed_curves_are_where_they_are_put() {
    let mut random = Random(95);
    let world_from_group = Affine3A::from_scale_rotation_translation(
        Vec3::splat(2.0),
        Quat::from_rotation_y(0.7),
        Vec3::new(3.0, 1.0, -2.0),
    );
    for basis in BASES {
        let points = wavy(&mut random, basis == CurveBasis::Bezier, 7, 0.1);
        let moved: Vec<Vec4> = points
            .iter()
            .map(|p| world_from_group.transform_point3(p.truncate()).extend(2.0 * p.w))
            .collect();
        let placed = Geometry::build(GeometryInput {
            shapes: vec![],
            groups: vec![vec![curves(basis, &points, &[0])]],
            instances: vec![Instance { group: 0, world_from_group }],
        })
        .unwrap();
        let copy = build(vec![curves(basis, &moved, &[0])]);
        let mut hits = 0;
        for _ in 0..500 {
            let ray = towards(&mut random, &points, basis);
            let ray = Ray::new(
                world_from_group.transform_point3(ray.origin),
                world_from_group.transform_vector3(ray.direction),
            );
            let (Some(a), Some(b)) = (placed.intersect(&ray), copy.intersect(&ray)) else { continue };
            let (s, expected) = (placed.surface(&ray, &a), copy.surface(&ray, &b));
            let facing = -expected.ng.dot(ray.direction.normalize());
            if facing > 0.2 {
                hits += 1;
                assert!(
                    s.p.distance(expected.p) < 1e-4 && s.ng.dot(expected.ng) > 0.999,
                    "{s:?} {expected:?}"
                );
                // Both links of a chain show the sphere between them.
                if a.primitive == b.primitive {
                    let around = placed.tangents(&s, &a).dpdu.normalize();
                    assert!(around.dot(copy.tangents(&expected, &b).dpdu.normalize()) > 0.999);
                }
            }
        }
        assert!(hits > 200, "{hits}");
    }
}

#[test]
fn what_has_no_surface_is_met_nowhere() {
    let mut random = Random(96);
    let p = Vec4::new(0.1, 0.2, 0.3, 0.1);
    let one_place = [p; 7];
    let thin: Vec<Vec4> = wavy(&mut random, false, 7, 0.0);
    // Double ends, and a cusp where the curve turns back.
    let odd = [(0.0, 0.0), (0.0, 0.0), (1.0, 0.2), (1.0, 0.2), (1.0, 0.2), (0.0, 0.0), (0.0, 0.3)];
    let odd = odd.map(|(x, y)| Vec4::new(x, y, 0.0, 0.05));
    for basis in BASES {
        for points in [&one_place[..], &thin, &odd] {
            let geometry = build(vec![curves(basis, points, &[0])]);
            let mut hits = 0;
            for _ in 0..2000 {
                let origin = 3.0 * random.direction();
                let ray = Ray::new(origin, 0.3 * random.cube() - origin);
                if let Some(hit) = geometry.intersect(&ray) {
                    hits += 1;
                    let surface = geometry.surface(&ray, &hit);
                    assert!(surface.p.is_finite() && surface.ng.is_normalized() && surface.uv.is_finite());
                    let tangents = geometry.tangents(&surface, &hit);
                    assert!(tangents.dpdu.is_finite() && tangents.dpdv.is_finite());
                }
            }
            // Spheres at one place are a sphere; discs at one place are nothing.
            let shows = points == &odd[..] || (points == &one_place[..] && basis == CurveBasis::Linear);
            assert_eq!(hits > 20, shows, "{basis:?} {points:?}: {hits}");
        }
    }
}

#[test]
fn curves_that_cannot_be_are_refused() {
    let p = Vec4::new(0.0, 0.0, 0.0, 0.1);
    let refused = |basis, points: &[Vec4], firsts: &[u32]| match Geometry::build(GeometryInput {
        shapes: vec![curves(basis, points, firsts)],
        ..Default::default()
    }) {
        Err(GeometryError::Curves { shape: 0, error }) => error,
        other => panic!("{other:?}"),
    };
    let bad = |w: f32| refused(CurveBasis::Linear, &[p, p.with_w(w)], &[0]);
    assert!(matches!(bad(f32::NAN), CurvesError::Point { point: 1, .. }));
    assert!(matches!(bad(-1.0), CurvesError::Point { point: 1, .. }));
    assert!(matches!(bad(f32::INFINITY), CurvesError::Point { point: 1, .. }));
    assert_eq!(refused(CurveBasis::Linear, &[p], &[0]), CurvesError::Count { curve: 0, points: 1 });
    assert_eq!(refused(CurveBasis::BSpline, &[p; 7], &[0, 4]), CurvesError::Count { curve: 1, points: 3 });
    assert_eq!(refused(CurveBasis::Bezier, &[p; 6], &[0]), CurvesError::Count { curve: 0, points: 6 });
    assert!(matches!(refused(CurveBasis::BSpline, &[p; 8], &[0, 9]), CurvesError::First { .. }));
    assert!(matches!(refused(CurveBasis::BSpline, &[p; 8], &[4, 0]), CurvesError::First { .. }));
    assert!(matches!(refused(CurveBasis::BSpline, &[p; 8], &[2]), CurvesError::First { .. }));
    let none = build(vec![curves(CurveBasis::BSpline, &[], &[])]);
    assert!(none.bounds().is_empty() && none.primitive_count(ShapeId(0)) == 0);
}

/// The (u, v) of pbrt: along each segment, and around.
#[test]
fn uv_along_and_around() {
    let points = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| Vec4::new(x, 0.0, 0.0, 0.1));
    let geometry = build(vec![Shape::Curves(Curves {
        basis: CurveBasis::BSpline,
        uv: CurveUv::AlongAround,
        points: &points,
        firsts: &[0],
    })]);
    let ray = Ray::new(Vec3::new(2.25, 0.0, 3.0), Vec3::NEG_Z);
    let hit = geometry.intersect(&ray).unwrap();
    let surface = geometry.surface(&ray, &hit);
    assert!((surface.uv - Vec2::new(0.25, 0.25)).length() < 1e-6, "{}", surface.uv);
    let tangents = geometry.tangents(&surface, &hit);
    assert!((tangents.dpdu - Vec3::X).length() < 1e-6);
    assert!((tangents.dpdv - Vec3::NEG_Y * (0.2 * PI)).length() < 1e-6);
    assert_eq!((hit.primitive, geometry.primitive_count(ShapeId(0))), (1, 2));
}
