//! Meeting few triangles with many rays: a ray in each lane, one piece after another.
//!
//! In: [`Rays`] and the [`Pieces`] of a tree. Out: what each ray hits, or whether it hits anything, for those rays whose
//! answer is certain; the others, about one in a thousand, are for [`super::scan`]. So no ray is lost between
//! neighbours: a ray that a packet decides is clear of all edges, by more than rounding errors.
//!
//! The test is Möller & Trumbore's (1997, "Fast, minimum storage ray/triangle intersection"), as triple products. With
//! s = o − p0 and r = −d, the ray o + t d meets the plane p0 + u e1 + v e2 at
//!
//! > t = n·s / n·r, u = −e2·(s × r) / n·r, v = e1·(s × r) / n·r, with n = e1 × e2,
//!
//! where it is in the triangle if all of U, V, D − U − V have the sign of D = n·r (U, V: the numerators), and in the
//! parallelogram if all of U, V, D − U, D − V have. With that sign made positive, let `least` be the smallest of them.
//!
//! # How wrong it may be
//!
//! ε is half the distance from 1 to the next number, |x|₁ the sum of components' sizes, R the largest component of d, S
//! a bound of the components of s for all corners, hence at least half the longest side of their box, `extent`.
//! Products of ε are left out: the bounds are rounded up generously.
//!
//! - s: ε S. s × r: 2 ε S R from s, 2 ε S R in two products, 2 ε S R in their difference; its components are at most
//!   2 S R.
//! - U: with e2 rounded, 2 ε S R |e2|₁, products as much, two sums twice as much, and 6 ε S R |e2|₁ from the cross product:
//!   14 ε S R |e2|₁. V likewise with e1.
//! - D: 4 ε |n|₁ R: n is rounded, products are, and two sums. So is t's numerator, with S, and another ε for s: 5 ε |n|₁ S.
//! - least: D − U − V adds up to 18 ε S R (|e1|₁ + |e2|₁) + 5 ε |n|₁ R; D − U and D − V are better. Where the sign of D is
//!   wrong, a hit has U, V and the rest within the error of D, another 4 ε |n|₁ R.
//! - The parallelogram's fourth corner is off by δ: its edges are turned by 2 |δ|₁ S R at most, U and V at the corner by
//!   2 |e|∞ |δ|₁ R ≤ 4 |δ|₁ S R.
//!
//! R ≤ 2 S R / `extent` turns all into `slack` S R, with `slack` = 24 ε (|e1|₁ + |e2|₁) + 24 ε |n|₁ / `extent` + 4 |δ|₁. Where
//! least is larger, the ray surely meets the piece, which of its halves does not matter; where it is less than minus
//! that, it surely does not. A piece is surely ahead where the numerator of t is larger than `near` S, with `near` =
//! 8 ε |n|₁ + 2 |n·δ| / `extent`. Where it is not positive, the piece is taken to be behind: a hit that is ahead by less
//! than rounding errors may be lost, here as in [`super::sheared`].

use super::pieces::{HALF, Piece, Pieces};
use super::simd::Lanes;
use crate::{BATCH, Bounds3, Hits, NO_INSTANCE, Rays};

const _: () = assert!(BATCH.is_multiple_of(super::WIDE), "packets divide batches");

/// Between these, sizes of rays leave room for products: neither overflows, and what vanishes is less than any slack.
const SMALL: f32 = 1e-30;
const LARGE: f32 = 1e30;
/// [`SMALL`] for products of two sizes, which are multiplied by slacks.
const SMALL_AREA: f32 = 1e-24;

/// A ray in each lane.
struct Packet<L: Lanes> {
    origin: [L::F; 3],
    /// The direction, reversed.
    back: [L::F; 3],
    t_max: L::F,
    /// Heights that are larger are surely positive.
    near: L::F,
    /// S R.
    size: L::F,
    /// Lanes for which the bounds hold.
    ordinary: L::Mask,
}

impl<L: Lanes> Packet<L> {
    /// The rays from `first` on; those from `count` on end where they start.
    #[inline(always)]
    fn new(
        lanes: L,
        rays: &Rays,
        (first, count): (usize, usize),
        (pieces, bounds): (&Pieces, &Bounds3),
    ) -> Self {
        let zero = lanes.splat(0.0);
        let (o, d) = (&rays.origin, &rays.direction);
        let origin = [lanes.load_at(&o.x, first), lanes.load_at(&o.y, first), lanes.load_at(&o.z, first)];
        let along = [lanes.load_at(&d.x, first), lanes.load_at(&d.y, first), lanes.load_at(&d.z, first)];
        let (mut reach, mut longest, mut back) = (zero, zero, along);
        for axis in 0..3 {
            let below = lanes.sub(origin[axis], lanes.splat(bounds.min[axis]));
            let above = lanes.sub(lanes.splat(bounds.max[axis]), origin[axis]);
            reach = lanes.max(reach, lanes.max(below, above));
            longest = lanes.max(longest, lanes.abs(along[axis]));
            back[axis] = lanes.sub(zero, along[axis]);
        }
        let size = lanes.mul(reach, longest);
        let [large, small] = [lanes.splat(LARGE), lanes.splat(SMALL)];
        let fits = lanes.le(lanes.mul(size, lanes.splat(pieces.slack)), large);
        let fits = lanes.and(fits, lanes.le(lanes.max(reach, longest), large));
        let fits = lanes.and(fits, lanes.le(small, lanes.min(reach, longest)));
        let present = lanes.mask(first_lanes(count - first));
        Self {
            origin,
            back,
            t_max: lanes.select(present, lanes.load_at(&rays.t_max, first), zero),
            near: lanes.mul(reach, lanes.splat(pieces.near)),
            size,
            ordinary: lanes.and(fits, lanes.le(lanes.splat(SMALL_AREA), size)),
        }
    }
}

/// The bits of the first lanes, one at least.
#[inline(always)]
fn first_lanes(count: usize) -> u32 {
    u32::MAX >> (32 - count.clamp(1, 32))
}

/// What a packet sees of a piece. Numerators and the denominator of t, u and v, which is made positive.
struct Seen<L: Lanes> {
    t: L::F,
    u: L::F,
    v: L::F,
    denominator: L::F,
    /// The smallest of the areas that are positive inside.
    least: L::F,
}

#[inline(always)]
fn see<L: Lanes, const PARALLELOGRAM: bool>(lanes: L, packet: &Packet<L>, piece: &Piece) -> Seen<L> {
    let s = [
        lanes.sub(packet.origin[0], lanes.splat(piece.corner[0])),
        lanes.sub(packet.origin[1], lanes.splat(piece.corner[1])),
        lanes.sub(packet.origin[2], lanes.splat(piece.corner[2])),
    ];
    let r = &packet.back;
    let q = [
        lanes.sub(lanes.mul(s[1], r[2]), lanes.mul(s[2], r[1])),
        lanes.sub(lanes.mul(s[2], r[0]), lanes.mul(s[0], r[2])),
        lanes.sub(lanes.mul(s[0], r[1]), lanes.mul(s[1], r[0])),
    ];
    let sign = dot(lanes, &piece.normal, r);
    let denominator = lanes.abs(sign);
    let t = lanes.flip(dot(lanes, &piece.normal, &s), sign);
    let u = lanes.flip(dot(lanes, &piece.across[0], &q), sign);
    let v = lanes.flip(dot(lanes, &piece.across[1], &q), sign);
    let most = if PARALLELOGRAM { lanes.max(u, v) } else { lanes.add(u, v) };
    let least = lanes.min(lanes.min(u, v), lanes.sub(denominator, most));
    Seen { t, u, v, denominator, least }
}

#[inline(always)]
fn dot<L: Lanes>(lanes: L, a: &[f32; 3], b: &[L::F; 3]) -> L::F {
    let xy = lanes.add(lanes.mul(b[0], lanes.splat(a[0])), lanes.mul(b[1], lanes.splat(a[1])));
    lanes.add(xy, lanes.mul(b[2], lanes.splat(a[2])))
}

/// The closest hits so far.
struct Closest<L: Lanes> {
    t: L::F,
    u: L::F,
    v: L::F,
    denominator: L::F,
    /// [`Piece::halves`], or -1: none.
    halves: L::F,
    /// 1 where a piece that was closer at its time may have been hit, else 0. A number, because masks cannot be kept
    /// in registers of their kind.
    doubtful: L::F,
}

impl<L: Lanes> Closest<L> {
    #[inline(always)]
    fn meet<const PARALLELOGRAM: bool>(&mut self, lanes: L, packet: &Packet<L>, piece: &Piece) {
        let seen = see::<_, PARALLELOGRAM>(lanes, packet, piece);
        // Fractions are compared without a division. Whether the hit is surely ahead is asked of the last one only.
        let closer = lanes.lt(lanes.mul(seen.t, self.denominator), lanes.mul(self.t, seen.denominator));
        let matters = lanes.and(closer, lanes.lt(lanes.splat(0.0), seen.t));
        let slack = lanes.mul(packet.size, lanes.splat(piece.slack));
        let hit = lanes.and(matters, lanes.lt(slack, seen.least));
        let doubtful = lanes.and(matters, lanes.le(lanes.abs(seen.least), slack));
        self.t = lanes.select(hit, seen.t, self.t);
        self.u = lanes.select(hit, seen.u, self.u);
        self.v = lanes.select(hit, seen.v, self.v);
        self.denominator = lanes.select(hit, seen.denominator, self.denominator);
        self.halves = lanes.select(hit, lanes.splat(piece.halves), self.halves);
        self.doubtful = lanes.select(doubtful, lanes.splat(1.0), self.doubtful);
    }

    /// The bits of the lanes whose hits are not certain.
    #[inline(always)]
    fn uncertain(&self, lanes: L, packet: &Packet<L>) -> u32 {
        let zero = lanes.splat(0.0);
        let near = lanes.and(lanes.le(zero, self.halves), lanes.le(self.t, packet.near));
        lanes.bits(lanes.or(near, lanes.lt(zero, self.doubtful))) | !lanes.bits(packet.ordinary)
    }

    /// Writes the hits from `first` on.
    #[inline(always)]
    fn write(&self, lanes: L, halves: &[u32], first: usize, hits: &mut Hits) {
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let scale = lanes.div(one, self.denominator);
        let hit = lanes.le(zero, self.halves);
        let t = lanes.select(hit, lanes.mul(self.t, scale), lanes.splat(f32::INFINITY));
        lanes.store_at(t, &mut hits.t, first);
        if lanes.bits(hit) == 0 {
            return;
        }
        let (u, v) = (lanes.mul(self.u, scale), lanes.mul(self.v, scale));
        let rest = lanes.sub(one, lanes.add(u, v));
        let beyond = lanes.lt(rest, zero);
        let weights = [
            lanes.abs(rest),
            lanes.select(beyond, lanes.sub(one, u), u),
            lanes.select(beyond, lanes.sub(one, v), v),
        ];
        let half = lanes.add(self.halves, lanes.select(beyond, lanes.splat(HALF as f32), zero));
        let b1 = pick(lanes, lanes.gather(&halves[2..], half), &weights);
        let b2 = pick(lanes, lanes.gather(&halves[3..], half), &weights);
        lanes.store_at(b1, &mut hits.b1, first);
        // Rounding must not bring their sum above 1.
        lanes.store_at(lanes.min(b2, lanes.sub(one, b1)), &mut hits.b2, first);
        lanes.store_bits_at(lanes.gather(halves, half), &mut hits.shape, first);
        lanes.store_bits_at(lanes.gather(&halves[1..], half), &mut hits.primitive, first);
        lanes.store_bits_at(lanes.splat(f32::from_bits(NO_INSTANCE)), &mut hits.instance, first);
    }
}

/// `weights[which[i]]`
#[inline(always)]
fn pick<L: Lanes>(lanes: L, which: L::F, weights: &[L::F; 3]) -> L::F {
    let rest = lanes.select(lanes.lt(which, lanes.splat(1.5)), weights[1], weights[2]);
    lanes.select(lanes.lt(which, lanes.splat(0.5)), weights[0], rest)
}

/// Writes the closest hits of the rays from `first` on, of `count` in all, as many as there are lanes. Returns the bits of
/// the lanes whose hits are not certain.
#[inline(always)]
pub(super) fn closest<L: Lanes>(
    lanes: L,
    (pieces, bounds): (&Pieces, &Bounds3),
    rays: &Rays,
    (first, count): (usize, usize),
    hits: &mut Hits,
) -> u32 {
    let packet = Packet::new(lanes, rays, (first, count), (pieces, bounds));
    let zero = lanes.splat(0.0);
    let mut closest = Closest {
        t: packet.t_max,
        u: zero,
        v: zero,
        denominator: lanes.splat(1.0),
        halves: lanes.splat(-1.0),
        doubtful: zero,
    };
    for piece in &pieces.parallelograms {
        closest.meet::<true>(lanes, &packet, piece);
    }
    for piece in &pieces.triangles {
        closest.meet::<false>(lanes, &packet, piece);
    }
    closest.write(lanes, &pieces.halves, first, hits);
    closest.uncertain(lanes, &packet) & first_lanes((count - first).min(L::COUNT))
}

/// The bits of the lanes of rays that surely hit something, and of those that may.
#[inline(always)]
pub(super) fn any<L: Lanes>(
    lanes: L,
    (pieces, bounds): (&Pieces, &Bounds3),
    rays: &Rays,
    (first, count): (usize, usize),
) -> (u32, u32) {
    let packet = Packet::new(lanes, rays, (first, count), (pieces, bounds));
    let present = first_lanes((count - first).min(L::COUNT));
    let mut found = Any { hit: lanes.splat(0.0), doubtful: lanes.splat(0.0) };
    for piece in &pieces.parallelograms {
        found.meet::<true>(lanes, &packet, piece);
    }
    for piece in &pieces.triangles {
        found.meet::<false>(lanes, &packet, piece);
    }
    let bits = |x: L::F| lanes.bits(lanes.lt(lanes.splat(0.0), x));
    let ordinary = lanes.bits(packet.ordinary);
    let hit = bits(found.hit) & ordinary;
    (hit, (bits(found.doubtful) | !ordinary) & !hit & present)
}

/// Whether rays hit anything, so far: 1 where they do.
struct Any<L: Lanes> {
    hit: L::F,
    /// 1 where they may, or do.
    doubtful: L::F,
}

impl<L: Lanes> Any<L> {
    #[inline(always)]
    fn meet<const PARALLELOGRAM: bool>(&mut self, lanes: L, packet: &Packet<L>, piece: &Piece) {
        let seen = see::<_, PARALLELOGRAM>(lanes, packet, piece);
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let slack = lanes.mul(packet.size, lanes.splat(piece.slack));
        let within = lanes.lt(seen.t, lanes.mul(packet.t_max, seen.denominator));
        let hit = lanes.and(lanes.and(within, lanes.lt(packet.near, seen.t)), lanes.lt(slack, seen.least));
        let ahead = lanes.and(within, lanes.lt(zero, seen.t));
        let doubtful = lanes.and(ahead, lanes.lt(zero, lanes.add(seen.least, slack)));
        self.hit = lanes.select(hit, one, self.hit);
        self.doubtful = lanes.select(doubtful, one, self.doubtful);
    }
}
