//! Meeting a few triangles with a ray without a tree: all of them, without a branch.
//!
//! A tree of a node or two costs more than it saves: whether a ray meets a block, and in which order, is a coin toss
//! that a processor guesses wrongly several times a ray.

use glam::Vec3;

use super::sheared::{Sheared, Triangles};
use super::simd::{Lanes, Portable};
use super::{TriangleBlock, WIDE};
use crate::{Hit, Ray};

/// As many of a block's triangles as there are lanes.
struct Part<'a> {
    block: &'a TriangleBlock,
    part: usize,
}

impl<L: Lanes> Triangles<L> for Part<'_> {
    #[inline(always)]
    unsafe fn coordinate(&self, lanes: L, vertex: usize, axis: usize) -> L::F {
        // SAFETY: the caller's promise.
        lanes.load_part(unsafe { self.block.vertices.get_unchecked(vertex).get_unchecked(axis) }, self.part)
    }

    fn vertices(&self, lane: usize) -> [Vec3; 3] {
        self.block.triangle(self.part * L::COUNT + lane)
    }
}

/// Meets the first `count` triangles of `blocks`, which together span `extent`; was any hit? Unless `ANY`, writes the
/// closest hit to `closest`.
#[inline(always)]
pub(super) fn scan<L: Lanes, const ANY: bool>(
    lanes: L,
    (blocks, count, extent): (&[TriangleBlock], usize, f32),
    ray: &Ray,
    closest: &mut Hit,
) -> bool {
    let sheared = Sheared::new(ray.origin, ray.direction);
    let beyond_doubt = lanes.splat(sheared.beyond_doubt(extent));
    let found = meet_all::<_, ANY, false>(lanes, (blocks, count), (ray, &sheared));
    if lanes.bits(lanes.lt(found.t, beyond_doubt)) == 0 {
        return conclude::<_, ANY>(lanes, blocks, (ray, &found), closest);
    }
    scan_exactly::<ANY>((blocks, count), ray, closest)
}

/// [`scan`], looking twice where rounding makes a hit doubtful. Rare, hence small rather than fast.
#[cold]
#[inline(never)]
fn scan_exactly<const ANY: bool>(
    (blocks, count): (&[TriangleBlock], usize),
    ray: &Ray,
    closest: &mut Hit,
) -> bool {
    let sheared = Sheared::new(ray.origin, ray.direction);
    let found = meet_all::<_, ANY, true>(Portable, (blocks, count), (ray, &sheared));
    conclude::<_, ANY>(Portable, blocks, (ray, &found), closest)
}

/// What a ray meets, per lane.
struct Found<L: Lanes> {
    /// Of the closest hit, or the ray's end.
    t: L::F,
    b: [L::F; 2],
    /// The bits of a lane's number tell the first triangle of the part that the lane's hit is in.
    part: L::F,
}

/// `EXACT`: looks twice where rounding makes a hit doubtful.
#[inline(always)]
fn meet_all<L: Lanes, const ANY: bool, const EXACT: bool>(
    lanes: L,
    (blocks, count): (&[TriangleBlock], usize),
    (ray, sheared): (&Ray, &Sheared),
) -> Found<L> {
    let (zero, t) = (lanes.splat(0.0), lanes.splat(ray.t_max));
    let mut found = Found { t, b: [zero; 2], part: zero };
    let mut first = 0;
    for block in blocks {
        for part in 0..WIDE / L::COUNT {
            if first >= count {
                break;
            }
            let triangles = Part { block, part };
            let seen = sheared.project(lanes, &triangles);
            let meets = match EXACT {
                true => sheared.meet(lanes, &triangles, &seen, found.t, || *ray),
                false => sheared.meet_roughly(lanes, &seen, found.t),
            };
            found.t = lanes.select(meets.hit, meets.t, found.t);
            if !ANY {
                found.b[0] = lanes.select(meets.hit, meets.b[0], found.b[0]);
                found.b[1] = lanes.select(meets.hit, meets.b[1], found.b[1]);
                found.part = lanes.select(meets.hit, lanes.splat(f32::from_bits(first as u32)), found.part);
            }
            first += L::COUNT;
        }
    }
    found
}

/// Was anything hit? Unless `ANY`, writes the closest hit to `closest`: of triangles at the same distance the first,
/// whatever the number of lanes.
#[inline(always)]
fn conclude<L: Lanes, const ANY: bool>(
    lanes: L,
    blocks: &[TriangleBlock],
    (ray, found): (&Ray, &Found<L>),
    closest: &mut Hit,
) -> bool {
    let hit = lanes.lt(found.t, lanes.splat(ray.t_max));
    if ANY || lanes.bits(hit) == 0 {
        return lanes.bits(hit) != 0;
    }
    let number = |lane: usize| lanes.extract(found.part, lane).to_bits() as usize + lane;
    let least = lanes.least(found.t);
    let mut ties = lanes.bits(lanes.le(found.t, lanes.splat(least)));
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
    let b = [lanes.extract(found.b[0], lane), lanes.extract(found.b[1], lane)];
    *closest = blocks[number / WIDE].hit(number % WIDE, least, b);
    true
}
