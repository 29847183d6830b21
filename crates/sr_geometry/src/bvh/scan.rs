//! Meeting a few triangles with a ray without a tree: all of them, without a branch.
//!
//! A tree of a node or two costs more than it saves: whether a ray meets a block, and in which order, is a coin toss
//! that a processor guesses wrongly several times a ray.

use super::sheared::{Sheared, Triangles};
use super::simd::Lanes;
use super::{TriangleBlock, WIDE};
use crate::{Hit, Ray};

/// As many of a block's triangles as there are lanes.
struct Part<'a> {
    block: &'a TriangleBlock<WIDE>,
    part: usize,
}

impl<L: Lanes> Triangles<L> for Part<'_> {
    #[inline(always)]
    unsafe fn coordinate(&self, lanes: L, vertex: usize, axis: usize) -> L::F {
        // SAFETY: the caller's promise.
        lanes.load_part(unsafe { self.block.vertices.get_unchecked(vertex).get_unchecked(axis) }, self.part)
    }
}

/// Meets the first `count` triangles of `blocks`; was any hit? Unless `ANY`, writes the closest hit to `closest`.
#[inline(always)]
pub(super) fn scan<L: Lanes, const ANY: bool>(
    lanes: L,
    blocks: &[TriangleBlock<WIDE>],
    count: usize,
    ray: &Ray,
    closest: &mut Hit,
) -> bool {
    let sheared = Sheared::new(lanes, ray);
    let mut t = lanes.splat(ray.t_max);
    let [mut b1, mut b2] = [lanes.splat(0.0); 2];
    // The bits of a lane's number tell the part that the lane's hit is in.
    let mut part_of_lane = lanes.splat(0.0);
    let mut any = lanes.lt(t, t);
    let mut first = 0;
    for block in blocks {
        for part in 0..WIDE / L::COUNT {
            if first >= count {
                break;
            }
            let seen = sheared.project(lanes, &Part { block, part });
            let meets = sheared.meet(lanes, &seen, t);
            if ANY {
                any = lanes.or(any, meets.hit);
            } else {
                t = lanes.select(meets.hit, meets.t, t);
                b1 = lanes.select(meets.hit, meets.b[0], b1);
                b2 = lanes.select(meets.hit, meets.b[1], b2);
                let this = lanes.splat(f32::from_bits(first as u32));
                part_of_lane = lanes.select(meets.hit, this, part_of_lane);
            }
            first += L::COUNT;
        }
    }
    if ANY {
        return lanes.bits(any) != 0;
    }
    let least = lanes.least(t);
    if !(least < ray.t_max) {
        return false;
    }
    // Of triangles at the same distance the first, whatever the number of lanes.
    let number = |lane: usize| lanes.extract(part_of_lane, lane).to_bits() as usize + lane;
    let mut ties = lanes.bits(lanes.le(t, lanes.splat(least)));
    let mut lane = ties.trailing_zeros() as usize % L::COUNT;
    ties &= ties.wrapping_sub(1);
    while ties != 0 {
        let other = ties.trailing_zeros() as usize % L::COUNT;
        if number(other) < number(lane) {
            lane = other;
        }
        ties &= ties - 1;
    }
    let number = number(lane);
    let b = [lanes.extract(b1, lane), lanes.extract(b2, lane)];
    *closest = blocks[number / WIDE].hit(number % WIDE, least, b);
    true
}
