//! Meeting few primitives with many rays: a ray in each lane, one piece after another.
//!
//! In: [`Rays`] and the [`Pieces`] of a tree. Out: what each ray hits, or whether it hits anything, for those rays whose
//! answer is certain; the others, in a room one of twenty thousand, are met again as single rays. So no ray is lost between
//! neighbours: a ray that a packet decides is clear of all edges, by more than rounding errors.
//!
//! The test is Möller & Trumbore's (1997, "Fast, minimum storage ray/triangle intersection"), as triple products. With
//! s = o − p0 and r = −d, the ray o + t d meets the plane p0 + u e1 + v e2 at
//!
//! > t = n·s / n·r, u = −e2·(s × r) / n·r, v = e1·(s × r) / n·r, with n = e1 × e2,
//!
//! where it is in the triangle if all of U, V, D − U − V have the sign of D = n·r (U, V: the numerators), and in the
//! parallelogram if all of U, V, D − U, D − V have. With that sign made positive, let `least` be the smallest of them. In
//! a disk, whose edges are its half-axes, it is D − √(U² + V²). `ball` meets spheres.
//!
//! # How wrong it may be
//!
//! ε is half the distance from 1 to the next number, |x|₁ the sum of components' sizes, R the largest component of d, S
//! a bound of the components of s for all corners, hence at least half the longest side of their box, `extent`.
//! Products of ε are left out: the bounds are rounded up generously.
//!
//! - s: ε S. s × r: 2 ε S R from s, 2 ε S R in two products, 2 ε S R in their difference; its components are at most
//!   2 S R.
//! - U: with e2 rounded, 2 ε S R |e2|₁, products as much, two sums twice as much, and 6 ε S R |e2|₁ from the cross
//!   product: 14 ε S R |e2|₁. V likewise with e1.
//! - D: 4 ε |n|₁ R: n is rounded, products are, and two sums. So is t's numerator, with S, and another ε for s: 5 ε |n|₁ S.
//! - least: D − U − V adds up to 18 ε S R (|e1|₁ + |e2|₁) + 5 ε |n|₁ R; D − U and D − V are better. Where the sign of D is
//!   wrong, a hit has U, V and the rest within the error of D, another 4 ε |n|₁ R.
//! - A disk's least: the errors of U, V and D as above, and 3 ε |n|₁ R from squares, sum and root near the rim.
//! - The parallelogram's fourth corner is off by δ: its edges are turned by 2 |δ|₁ S R at most, U and V at the corner by
//!   2 |e|∞ |δ|₁ R ≤ 4 |δ|₁ S R; the second half's normal by δ × (e2 − e1), hence its D by 4 |δ|₁ S R.
//!
//! R ≤ 2 S R / `extent` turns all into `slack` S R, with `slack` = 24 ε (|e1|₁ + |e2|₁) + 24 ε |n|₁ / `extent` + 8 |δ|₁.
//! Where least is larger, the ray surely meets the piece, which of its halves does not matter; where it is less than minus
//! that, it surely does not. A piece is surely ahead where the numerator of t is larger than `near` S, with `near` =
//! 8 ε |n|₁ + 2 |n·δ| / `extent`: a ray that is sure to meet the piece meets either half, if crooked, within the half's
//! own outline, where heights over the two planes differ by no more than n·δ. Where the numerator is not positive, the
//! piece is taken to be behind: a hit that is ahead by less than rounding errors may be lost, here as in
//! [`super::sheared`].

mod any;
mod ball;
mod closest;
#[cfg(test)]
mod tests;

use super::pieces::{DISK, Kind, PARALLELOGRAM, Piece, Pieces, TRIANGLE};
use super::simd::Lanes;
use crate::{BATCH, Rays};

pub(super) use any::any;
pub(super) use ball::Ball;
pub(super) use closest::closest;

use ball::{SeenBall, Speed};

const _: () = assert!(BATCH.is_multiple_of(super::WIDE), "packets divide batches");

/// Between these, products of two sizes may be multiplied by slacks.
const SMALL_AREA: f32 = 1e-24;
const LARGE_AREA: f32 = 1e30;

/// A ray in each lane.
struct Packet<L: Lanes> {
    origin: [L::F; 3],
    /// The direction, reversed.
    back: [L::F; 3],
    t_max: L::F,
    /// R.
    longest: L::F,
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
    fn new(lanes: L, rays: &Rays, (first, count): (usize, usize), pieces: &Pieces) -> Self {
        let bounds = &pieces.bounds;
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
        let [small, large] = [lanes.splat(pieces.lengths[0]), lanes.splat(pieces.lengths[1])];
        let fits = lanes.le(lanes.mul(size, lanes.splat(pieces.slack)), lanes.splat(LARGE_AREA));
        let fits = lanes.and(fits, lanes.le(lanes.max(reach, longest), large));
        let fits = lanes.and(fits, lanes.le(small, lanes.min(reach, longest)));
        let present = lanes.mask(first_lanes(count - first));
        Self {
            origin,
            back,
            t_max: lanes.select(present, lanes.load_at(&rays.t_max, first), zero),
            longest,
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
fn see<L: Lanes, const KIND: Kind>(lanes: L, packet: &Packet<L>, piece: &Piece) -> Seen<L> {
    let s = [
        lanes.sub(packet.origin[0], lanes.splat(piece.corner[0])),
        lanes.sub(packet.origin[1], lanes.splat(piece.corner[1])),
        lanes.sub(packet.origin[2], lanes.splat(piece.corner[2])),
    ];
    let r = &packet.back;
    let [back, along] = &piece.across;
    let (sign, t, u, v);
    if KIND < PARALLELOGRAM {
        // What is multiplied by 0 is left out.
        let [x, y, z] = [KIND % 3, (KIND + 1) % 3, (KIND + 2) % 3];
        let q = [cross(lanes, &s, r, y), cross(lanes, &s, r, z)];
        (sign, t) = (r[x], s[x]);
        u = dot_2(lanes, [back[y], back[z]], q);
        v = dot_2(lanes, [along[y], along[z]], q);
    } else {
        let q = [cross(lanes, &s, r, 0), cross(lanes, &s, r, 1), cross(lanes, &s, r, 2)];
        (sign, t) = (dot(lanes, &piece.normal, r), dot(lanes, &piece.normal, &s));
        (u, v) = (dot(lanes, back, &q), dot(lanes, along, &q));
    }
    let (t, u, v) = (lanes.flip(t, sign), lanes.flip(u, sign), lanes.flip(v, sign));
    let denominator = lanes.abs(sign);
    let least = if KIND == DISK {
        lanes.sub(denominator, lanes.sqrt(lanes.add(lanes.mul(u, u), lanes.mul(v, v))))
    } else {
        let most = if KIND == TRIANGLE { lanes.add(u, v) } else { lanes.max(u, v) };
        lanes.min(lanes.min(u, v), lanes.sub(denominator, most))
    };
    Seen { t, u, v, denominator, least }
}

/// One component of a × b.
#[inline(always)]
fn cross<L: Lanes>(lanes: L, a: &[L::F; 3], b: &[L::F; 3], axis: usize) -> L::F {
    let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
    lanes.sub(lanes.mul(a[y], b[z]), lanes.mul(a[z], b[y]))
}

#[inline(always)]
fn dot<L: Lanes>(lanes: L, a: &[f32; 3], b: &[L::F; 3]) -> L::F {
    lanes.add(dot_2(lanes, [a[0], a[1]], [b[0], b[1]]), lanes.mul(b[2], lanes.splat(a[2])))
}

#[inline(always)]
fn dot_2<L: Lanes>(lanes: L, a: [f32; 2], b: [L::F; 2]) -> L::F {
    lanes.add(lanes.mul(b[0], lanes.splat(a[0])), lanes.mul(b[1], lanes.splat(a[1])))
}

/// What is known of a packet's hits.
trait Met<L: Lanes> {
    fn meet<const KIND: Kind>(&mut self, lanes: L, packet: &Packet<L>, piece: &Piece);
    fn meet_ball(&mut self, lanes: L, seen: &SeenBall<L>);
}

#[inline(always)]
fn meet_all<L: Lanes>(lanes: L, met: &mut impl Met<L>, packet: &Packet<L>, pieces: &Pieces) {
    let [x, y, z, parallelograms, triangles, disks] = &pieces.kinds;
    for piece in x {
        met.meet::<0>(lanes, packet, piece);
    }
    for piece in y {
        met.meet::<1>(lanes, packet, piece);
    }
    for piece in z {
        met.meet::<2>(lanes, packet, piece);
    }
    for piece in parallelograms {
        met.meet::<PARALLELOGRAM>(lanes, packet, piece);
    }
    for piece in triangles {
        met.meet::<TRIANGLE>(lanes, packet, piece);
    }
    for piece in disks {
        met.meet::<DISK>(lanes, packet, piece);
    }
    if !pieces.balls.is_empty() {
        let speed = Speed::new(lanes, packet);
        for ball in &pieces.balls {
            if let Some(seen) = ball.see(lanes, packet, &speed) {
                met.meet_ball(lanes, &seen);
            }
        }
    }
}
