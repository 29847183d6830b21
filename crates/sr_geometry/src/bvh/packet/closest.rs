//! The closest hits of a packet.

use super::super::pieces::{HALF, Kind, Piece, Pieces};
use super::super::simd::Lanes;
use super::{Met, Packet, SeenBall, first_lanes, meet_all, see};
use crate::{Hits, NO_INSTANCE, Rays};

/// Writes the closest hits of the rays from `first` on, of `count` in all, as many as there are lanes. Returns the bits of
/// the lanes whose hits are not certain.
#[inline(always)]
pub(in crate::bvh) fn closest<L: Lanes>(
    lanes: L,
    pieces: &Pieces,
    rays: &Rays,
    (first, count): (usize, usize),
    hits: &mut Hits,
) -> u32 {
    let packet = Packet::new(lanes, rays, (first, count), pieces);
    let zero = lanes.splat(0.0);
    let mut closest = Closest {
        t: packet.t_max,
        u: zero,
        v: zero,
        denominator: lanes.splat(1.0),
        halves: lanes.splat(-1.0),
        doubtful: zero,
    };
    meet_all(lanes, &mut closest, &packet, pieces);
    closest.write(lanes, pieces, first, hits);
    closest.uncertain(lanes, &packet, pieces.first_ball) & first_lanes((count - first).min(L::COUNT))
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

impl<L: Lanes> Met<L> for Closest<L> {
    #[inline(always)]
    fn meet<const KIND: Kind>(&mut self, lanes: L, packet: &Packet<L>, piece: &Piece) {
        let seen = see::<_, KIND>(lanes, packet, piece);
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

    #[inline(always)]
    fn meet_ball(&mut self, lanes: L, seen: &SeenBall<L>) {
        let closer = lanes.lt(lanes.mul(seen.t, self.denominator), lanes.mul(self.t, seen.denominator));
        let hit = lanes.and(seen.hit, closer);
        let zero = lanes.splat(0.0);
        self.t = lanes.select(hit, seen.t, self.t);
        self.u = lanes.select(hit, zero, self.u);
        self.v = lanes.select(hit, zero, self.v);
        self.denominator = lanes.select(hit, seen.denominator, self.denominator);
        self.halves = lanes.select(hit, lanes.splat(seen.halves), self.halves);
        self.doubtful = seen.mark_doubtful(lanes, self.doubtful);
    }
}

impl<L: Lanes> Closest<L> {
    /// The bits of the lanes whose hits are not certain.
    #[inline(always)]
    fn uncertain(&self, lanes: L, packet: &Packet<L>, first_ball: f32) -> u32 {
        let zero = lanes.splat(0.0);
        let flat = lanes.and(lanes.le(zero, self.halves), lanes.lt(self.halves, lanes.splat(first_ball)));
        let near = lanes.and(flat, lanes.le(self.t, packet.near));
        lanes.bits(lanes.or(near, lanes.lt(zero, self.doubtful))) | !lanes.bits(packet.ordinary)
    }

    /// Writes the hits from `first` on.
    #[inline(always)]
    fn write(&self, lanes: L, pieces: &Pieces, first: usize, hits: &mut Hits) {
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let scale = lanes.div(one, self.denominator);
        let hit = lanes.le(zero, self.halves);
        let t = lanes.select(hit, lanes.mul(self.t, scale), lanes.splat(f32::INFINITY));
        lanes.store_at(t, &mut hits.t, first);
        if lanes.bits(hit) == 0 {
            return;
        }
        let halves = &pieces.halves;
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
        // Rounding must not bring their sum above 1.
        let b2 = lanes.min(b2, lanes.sub(one, b1));
        let round = lanes.le(lanes.splat(pieces.first_disk), self.halves);
        lanes.store_at(lanes.select(round, u, b1), &mut hits.b1, first);
        lanes.store_at(lanes.select(round, v, b2), &mut hits.b2, first);
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
