//! What a packet says of a piece against `f64`.

use glam::{DVec3, Mat3, Quat, Vec3};

use super::super::simd::{Lanes, Portable};
use super::*;
use crate::bvh::{PrimRef, Round, WIDTH};
use crate::{Bounds3, Disk, Ray, ShapeId, Sphere};

/// Numbers in [-1, 1) by SplitMix64 (Steele, Lea & Flood 2014).
struct Random(u64);

impl Random {
    fn number(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u32 << 23) as f32 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number())
    }

    fn rotation(&mut self) -> Quat {
        Quat::from_axis_angle((self.vector() + 1e-3).normalize(), 3.2 * self.number())
    }
}

/// How far within a triangle a ray's line passes, in parts of its own size: negative outside.
fn depth(ray: &Ray, triangle: &[Vec3; 3]) -> f64 {
    let [a, b, c] = triangle.map(|v| v.as_dvec3() - ray.origin.as_dvec3());
    let of = |p: DVec3, q: DVec3| p.cross(q).dot(ray.direction.as_dvec3());
    let areas = [of(b, c), of(c, a), of(a, b)];
    let least = areas.into_iter().fold(f64::MAX, f64::min);
    let most = areas.into_iter().fold(f64::MIN, f64::max);
    let size = a.length().max(b.length()).max(c.length());
    least.max(-most) / (size * size * f64::from(ray.direction.length()))
}

/// What packets say surely.
#[derive(Default)]
struct Tally {
    hits: u32,
    misses: u32,
    doubtful: u32,
    /// How often they would have been wrong without slack.
    saved: u32,
}

/// Checks what is said of the piece that triangles make, which is of kind `KIND`.
fn check<const KIND: Kind>(triangles: &[[Vec3; 3]], rays: &[Ray], tally: &mut Tally) {
    let bounds = |t: &[Vec3; 3]| t.iter().fold(Bounds3::EMPTY, |bounds, &v| bounds.with(v));
    let prim = |(i, t)| PrimRef::new(bounds(t), 0, i as u32);
    let prims: Vec<_> = triangles.iter().enumerate().map(prim).collect();
    // Rounding may have left a line.
    let Some(pieces) = Pieces::new(&prims, |ShapeId(_), i| triangles[i as usize], |_| None) else { return };
    let [piece] = &pieces.kinds[KIND][..] else { return };
    let mut batch = Rays::NONE;
    rays.iter().enumerate().for_each(|(i, ray)| batch.set(i, ray));
    let packet = Packet::new(Portable, &batch, (0, WIDTH), &pieces);
    assert_eq!(Portable.bits(packet.ordinary), 0xff);
    let seen = see::<_, KIND>(Portable, &packet, piece);
    for (lane, ray) in rays.iter().enumerate() {
        let (least, slack) = (seen.least[lane], packet.size[lane] * piece.slack);
        let depth = triangles.iter().map(|t| depth(ray, t)).fold(f64::MIN, f64::max);
        let (inside, outside) = (depth > -1e-13, depth < 1e-13);
        let fine = if least > slack {
            tally.hits += 1;
            inside
        } else if least < -slack {
            tally.misses += 1;
            outside
        } else {
            tally.doubtful += 1;
            tally.saved += u32::from(if least > 0.0 { !inside } else { !outside });
            true
        };
        assert!(fine, "{triangles:?}, {ray:?}: {least} ± {slack}, but {depth}");
    }
}

#[test]
fn what_is_sure_is_true() {
    let mut random = Random(61);
    let (mut flat, mut parallelograms, mut triangles) =
        (Tally::default(), Tally::default(), Tally::default());
    for i in 0..40_000 {
        let size = 10f32.powi(i % 9 - 4);
        let turn = if i % 3 == 0 { Quat::IDENTITY } else { random.rotation() };
        let at = size * [0.0, 1.0, 30.0][(i / 3 % 3) as usize] * random.vector();
        let (long, wide) = (size * random.number(), size * random.number() * 10f32.powi(-(i % 4)));
        let skew = if i % 2 == 0 { 0.0 } else { random.number() * long };
        let corner = |u: f32, v: f32| turn * Vec3::new(u * long + v * skew, 0.0, v * wide) + at;
        let [a, b, c, d] = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        let rays: [Ray; WIDTH] = std::array::from_fn(|_| {
            let edge = random.number().abs();
            let target = [a + edge * (b - a), b + edge * (c - b), c + edge * (a - c), a + edge * (d - a), c]
                [(random.number().abs() * 5.0) as usize];
            let origin = target + size * 10f32.powf(2.0 * random.number()) * random.vector();
            // Beside the edge, by about what rounding makes of it.
            let beside = (size + target.length()) * 10f32.powf(2.0 * random.number() - 6.5) * random.vector();
            Ray::new(origin, target + beside - origin)
        });
        check::<1>(&[[a, b, c], [c, d, a]], &rays, &mut flat);
        check::<PARALLELOGRAM>(&[[a, b, c], [c, d, a]], &rays, &mut parallelograms);
        check::<TRIANGLE>(&[[a, b, c]], &rays, &mut triangles);
    }
    for Tally { hits, misses, doubtful, saved } in [flat, parallelograms, triangles] {
        assert!(hits.min(misses).min(doubtful) > 10_000, "{hits} hits, {misses} misses, {doubtful} doubtful");
        assert!(saved > 100, "the test can fail: {saved}");
    }
}

/// The t at which a ray meets a sphere, in `f64`, and by how much it does, in parts of the sizes.
fn meet_sphere(ray: &Ray, sphere: &Sphere) -> (Option<f64>, f64) {
    let (s, d) = (ray.origin.as_dvec3() - sphere.center.as_dvec3(), ray.direction.as_dvec3());
    let (radius, b, a) = (f64::from(sphere.radius), s.dot(d), d.length_squared());
    let line = (radius * radius - (s - b / a * d).length_squared()) / radius.max(s.length()).powi(2);
    let c = (s.length() - radius) * (s.length() + radius);
    let q = -b - (a * (radius * radius - (s - b / a * d).length_squared())).sqrt().copysign(b);
    let t = [q / a, c / q].into_iter().filter(|&t| t > 0.0).reduce(f64::min);
    (t, line.abs().min(c.abs() / radius.max(s.length()).powi(2)))
}

#[test]
fn what_is_sure_of_spheres_is_true() {
    let mut random = Random(62);
    let (mut hits, mut misses, mut doubtful, mut worst) = (0, 0, 0, 0f64);
    for i in 0..100_000 {
        let radius = 10f32.powi(i % 9 - 5);
        let center = radius * [0.0, 1.0, 30.0, 1000.0][(i / 9 % 4) as usize] * random.vector();
        let sphere = Sphere { center, radius, frame: Mat3::IDENTITY, flip_normals: false };
        let prim = PrimRef::new(sphere.bounds(), PrimRef::OTHER, 0);
        let round_of = |_| Some(Round::Sphere(ShapeId(7), &sphere));
        let pieces = Pieces::new(&[prim], |_, _| [Vec3::ZERO; 3], round_of).expect("it fits");
        let mut batch = Rays::NONE;
        let rays: [Ray; WIDTH] = std::array::from_fn(|lane| {
            let out = random.vector().normalize();
            // Beside the surface or anywhere, along it, past its rim or anywhere.
            let away = if lane % 2 == 0 {
                10f32.powf(4.0 * random.number() - 4.0)
            } else {
                [30.0, 3e4][lane / 2 % 2]
            };
            let origin = center + out * radius * (1.0 + away * random.number());
            let rim = out.cross(random.vector()).normalize();
            let beside = 1.0 + random.number() * 10f32.powf(3.0 * random.number() - 4.0);
            let direction = match lane / 2 {
                0 => random.vector(),
                1 => rim + random.number() * 0.1 * out,
                _ => center + radius * beside * rim - origin,
            };
            Ray::new(origin, direction.normalize() * 10f32.powf(3.0 * random.number()))
        });
        rays.iter().enumerate().for_each(|(i, ray)| batch.set(i, ray));
        let packet = Packet::new(Portable, &batch, (0, WIDTH), &pieces);
        assert_eq!(Portable.bits(packet.ordinary), 0xff, "{rays:?}");
        let seen = pieces.balls[0].see(Portable, &packet, &Speed::new(Portable, &packet));
        for (lane, ray) in rays.iter().enumerate() {
            let (expected, margin) = meet_sphere(ray, &sphere);
            let what = || format!("{sphere:?}, {ray:?}: expected {expected:?}");
            let Some(seen) = seen.as_ref() else {
                misses += 1;
                assert!(expected.is_none() || margin < 1e-13, "{}", what());
                continue;
            };
            if seen.hit[lane] {
                hits += 1;
                let t = f64::from(seen.t[lane]) / f64::from(seen.denominator[lane]);
                let error = expected.map_or(f64::INFINITY, |expected| (t / expected - 1.0).abs());
                assert!(error < 6.5e-5, "{}, not {t}", what());
                worst = worst.max(error);
            } else if seen.mark_doubtful(Portable, [0.0; WIDTH])[lane] > 0.0 {
                doubtful += 1;
            } else {
                misses += 1;
                assert!(expected.is_none() || margin < 1e-13, "{}", what());
            }
        }
    }
    assert!(hits.min(misses).min(doubtful) > 100_000, "{hits} hits, {misses} misses, {doubtful} doubtful");
    assert!(worst > 5e-6, "the test can fail: {worst}");
}

#[test]
fn a_disk_is_where_its_coordinates_are() {
    let mut random = Random(63);
    let (mut hits, mut misses, mut doubtful) = (0, 0, 0);
    for i in 0..40_000 {
        let size = 10f32.powi(i % 9 - 4);
        let turn = random.rotation();
        let disk = Disk {
            center: size * [0.0, 1.0, 30.0][(i / 9 % 3) as usize] * random.vector(),
            u_axis: size * (turn * Vec3::X),
            // Not quite perpendicular.
            v_axis: size * 10f32.powi(-(i % 3)) * (turn * Vec3::new(5e-4 * random.number(), 1.0, 0.0)),
            flip_normals: false,
        };
        let prim = PrimRef::new(disk.bounds(), PrimRef::OTHER, 0);
        let round_of = |_| Some(Round::Disk(ShapeId(7), &disk));
        let pieces = Pieces::new(&[prim], |_, _| [Vec3::ZERO; 3], round_of).expect("it fits");
        let mut batch = Rays::NONE;
        let rays: [Ray; WIDTH] = std::array::from_fn(|lane| {
            let (y, x) = (4.0 * random.number()).sin_cos();
            let reach =
                1.0 + random.number() * if lane == 0 { 1.0 } else { 10f32.powf(3.0 * random.number() - 4.5) };
            let target = disk.center + reach * (x * disk.u_axis + y * disk.v_axis);
            let origin = target + size * 10f32.powf(2.0 * random.number()) * random.vector();
            Ray::new(origin, target - origin)
        });
        rays.iter().enumerate().for_each(|(i, ray)| batch.set(i, ray));
        let packet = Packet::new(Portable, &batch, (0, WIDTH), &pieces);
        let piece = &pieces.kinds[DISK][0];
        let seen = see::<_, DISK>(Portable, &packet, piece);
        for (lane, ray) in rays.iter().enumerate() {
            let (least, slack) = (seen.least[lane], packet.size[lane] * piece.slack);
            let met = disk.intersect(ray);
            if least > slack && seen.t[lane] > packet.near[lane] {
                hits += 1;
                let (t, at) = met.unwrap_or_else(|| panic!("{disk:?}, {ray:?}: not met"));
                let of = |x: f32| x / seen.denominator[lane];
                assert!(
                    (of(seen.t[lane]) / t - 1.0).abs() < 1e-2
                        && of(seen.u[lane]).hypot(of(seen.v[lane])) <= 1.0
                );
                let allowed = 1e-6 + slack / seen.denominator[lane];
                assert!((of(seen.u[lane]) - at.x).abs().max((of(seen.v[lane]) - at.y).abs()) < allowed);
            } else if least < -slack {
                misses += 1;
                assert_eq!(met, None, "{disk:?}, {ray:?}");
            } else {
                doubtful += 1;
            }
        }
    }
    assert!(hits.min(misses).min(doubtful) > 10_000, "{hits} hits, {misses} misses, {doubtful} doubtful");
}
