//! What a packet says of a piece against `f64`.

use glam::{DVec3, Quat, Vec3};

use super::super::simd::{Lanes, Portable};
use super::*;
use crate::bvh::{PrimRef, WIDTH};
use crate::{Ray, ShapeId};

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
    let prim = |(i, t)| PrimRef { bounds: bounds(t), shape: 0, primitive: i as u32 };
    let prims: Vec<_> = triangles.iter().enumerate().map(prim).collect();
    let around = prims.iter().fold(Bounds3::EMPTY, |all, p| all.union(p.bounds));
    let extent = around.extent().max_element();
    // Rounding may have left a line.
    let Some(pieces) = Pieces::new(&prims, extent, |ShapeId(_), i| triangles[i as usize]) else { return };
    let [piece] = &pieces.kinds[KIND][..] else { return };
    let mut batch = Rays::NONE;
    rays.iter().enumerate().for_each(|(i, ray)| batch.set(i, ray));
    let packet = Packet::new(Portable, &batch, (0, WIDTH), (&pieces, &around));
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
