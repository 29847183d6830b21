//! Whether the rays of a packet hit anything.

use super::super::pieces::{Kind, Piece, Pieces};
use super::super::simd::Lanes;
use super::{Met, Packet, SeenBall, first_lanes, meet_all, see};
use crate::Rays;

/// The bits of the lanes of rays that surely hit something, and of those that may.
#[inline(always)]
pub(in crate::bvh) fn any<L: Lanes>(
    lanes: L,
    pieces: &Pieces,
    rays: &Rays,
    (first, count): (usize, usize),
) -> (u32, u32) {
    let packet = Packet::new(lanes, rays, (first, count), pieces);
    let present = first_lanes((count - first).min(L::COUNT));
    let mut found = Any { t_max: packet.t_max, hit: lanes.splat(0.0), doubtful: lanes.splat(0.0) };
    meet_all(lanes, &mut found, &packet, pieces);
    let bits = |x: L::F| lanes.bits(lanes.lt(lanes.splat(0.0), x));
    let ordinary = lanes.bits(packet.ordinary);
    let hit = bits(found.hit) & ordinary;
    (hit, (bits(found.doubtful) | !ordinary) & !hit & present)
}

/// Whether rays hit anything, so far: 1 where they do.
struct Any<L: Lanes> {
    t_max: L::F,
    hit: L::F,
    /// 1 where they may, or do.
    doubtful: L::F,
}

impl<L: Lanes> Met<L> for Any<L> {
    #[inline(always)]
    fn meet<const KIND: Kind>(&mut self, lanes: L, packet: &Packet<L>, piece: &Piece) {
        let seen = see::<_, KIND>(lanes, packet, piece);
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let slack = lanes.mul(packet.size, lanes.splat(piece.slack));
        let within = lanes.lt(seen.t, lanes.mul(packet.t_max, seen.denominator));
        let hit = lanes.and(lanes.and(within, lanes.lt(packet.near, seen.t)), lanes.lt(slack, seen.least));
        let ahead = lanes.and(within, lanes.lt(zero, seen.t));
        let doubtful = lanes.and(ahead, lanes.lt(zero, lanes.add(seen.least, slack)));
        self.hit = lanes.select(hit, one, self.hit);
        self.doubtful = lanes.select(doubtful, one, self.doubtful);
    }

    #[inline(always)]
    fn meet_ball(&mut self, lanes: L, seen: &SeenBall<L>) {
        let one = lanes.splat(1.0);
        let within = lanes.lt(seen.t, lanes.mul(self.t_max, seen.denominator));
        self.hit = lanes.select(lanes.and(seen.hit, within), one, self.hit);
        self.doubtful = seen.mark_doubtful(lanes, self.doubtful);
    }
}
