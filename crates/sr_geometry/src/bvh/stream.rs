//! Walking a tree with several rays in turn: while one of them waits, for memory or for what it has just computed, the
//! others move.
//!
//! In: rays and the root of a tree. Out: what [`super::traverse`] would find for each of them, in any order. The rays
//! that are at a node make a step, one after another, then those at a leaf: a processor meets no branch that it could
//! guess wrongly but for the ends of these loops.

use std::mem::MaybeUninit;
use std::ops::Range;

use super::node::kind;
use super::prepare::{CHUNK, Prepared};
use super::sheared::Sheared;
use super::simd::Walk;
use super::slabs::Line;
use super::walker::Walker;
use super::{Bvh, Met, NodeRef};
use crate::{Bounds3, Hit, Ray, Rays};

/// Walks at a time: fewer wait, more do not fit the first-level cache.
const AT_A_TIME: usize = 16;

/// Walks the tree of node `root` with the first `count` rays; `answer(i, hit)` gets what ray i hits. `ANY`: it gets
/// some hit or other.
#[inline(always)]
pub(super) fn walk_many<S: Walk, const ANY: bool>(
    simd: S,
    bvh: &Bvh,
    (root, bounds): (NodeRef, &Bounds3),
    (rays, count): (&Rays, usize),
    meet_other: &impl Fn(u32, &Ray) -> Met,
    mut answer: impl FnMut(usize, Option<&Hit>),
) {
    let mut prepared = Prepared::NONE;
    let mut places = Places { walkers: [const { MaybeUninit::<Walker<S, ANY>>::uninit() }; AT_A_TIME] };
    let mut ray_of = [0; AT_A_TIME];
    let mut lists = Lists::EMPTY;
    let mut queued = 0;
    // Those who wait for a ray.
    let mut idle = AT_A_TIME;
    let mut free: [u32; AT_A_TIME] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
    loop {
        while idle > 0 && queued < count {
            if queued % CHUNK == 0 {
                prepared.prepare(rays, queued, bounds);
            }
            if prepared.meets_nothing(queued) {
                answer(queued, None);
            } else {
                idle -= 1;
                let walker = free[idle % AT_A_TIME];
                let (sheared, line) = (prepared.sheared(queued), prepared.line(queued));
                places.start(simd, walker, root, (&rays.get(queued), &sheared, &line));
                ray_of[walker as usize % AT_A_TIME] = queued;
                lists.put(walker, root);
            }
            queued += 1;
        }
        if idle == AT_A_TIME {
            return;
        }
        for i in lists.take(kind::NODE) {
            let Entry { walker, child } = lists.entries[kind::NODE][i % RING];
            let at = places.at(walker);
            at.visit_node(simd, bvh.node(child));
            lists.put(walker, at.next_of_many(simd, bvh));
        }
        for i in lists.take(kind::NARROW) {
            let Entry { walker, child } = lists.entries[kind::NARROW][i % RING];
            let at = places.at(walker);
            at.visit_leaf::<true, false>(simd, &bvh.leaves.leaf(child));
            at.forget_beyond(simd);
            lists.put(walker, at.next_of_many(simd, bvh));
        }
        for i in lists.take(kind::FULL) {
            let Entry { walker, child } = lists.entries[kind::FULL][i % RING];
            let at = places.at(walker);
            at.visit_leaf::<false, false>(simd, &bvh.leaves.leaf(child));
            at.forget_beyond(simd);
            lists.put(walker, at.next_of_many(simd, bvh));
        }
        for i in lists.take(kind::OTHER) {
            let Entry { walker, child } = lists.entries[kind::OTHER][i % RING];
            let at = places.at(walker);
            let ray = ray_of[walker as usize % AT_A_TIME];
            if child == NodeRef::DONE {
                answer(ray, at.hit(bvh).as_ref());
                free[idle % AT_A_TIME] = walker;
                idle += 1;
                continue;
            }
            if child == NodeRef::BACK {
                at.go_back(&rays.get(ray));
            } else {
                at.visit_other(simd, bvh, child.index() as u32, meet_other);
                at.forget_beyond(simd);
            }
            let next = at.next_after_other(simd, bounds);
            if bvh.prefetches {
                bvh.prefetch(simd, next);
            }
            lists.put(walker, next);
        }
    }
}

/// The walkers.
struct Places<S: Walk, const ANY: bool> {
    walkers: [MaybeUninit<Walker<S, ANY>>; AT_A_TIME],
}

impl<S: Walk, const ANY: bool> Places<S, ANY> {
    #[inline(always)]
    fn start(&mut self, simd: S, walker: u32, root: NodeRef, ray: (&Ray, &Sheared, &Line)) {
        Walker::start(&mut self.walkers[walker as usize % AT_A_TIME], simd, root, ray).next();
    }

    /// A walker that was started.
    #[inline(always)]
    fn at(&mut self, walker: u32) -> &mut Walker<S, ANY> {
        debug_assert!((walker as usize) < AT_A_TIME);
        // SAFETY: only those who were started are in a list.
        unsafe { self.walkers.get_unchecked_mut(walker as usize).assume_init_mut() }
    }
}

/// Walkers by the kind of what they visit next, in the order in which they came.
struct Lists {
    entries: [[Entry; RING]; kind::COUNT],
    /// How many were taken of each kind, and how many were put there.
    taken: [usize; kind::COUNT],
    put: [usize; kind::COUNT],
}

/// Entries that fit a list, which goes round.
const RING: usize = 2 * AT_A_TIME;

#[derive(Clone, Copy)]
struct Entry {
    walker: u32,
    child: NodeRef,
}

impl Lists {
    const EMPTY: Self = Self {
        entries: [[Entry { walker: 0, child: NodeRef::DONE }; RING]; kind::COUNT],
        taken: [0; kind::COUNT],
        put: [0; kind::COUNT],
    };

    #[inline(always)]
    fn put(&mut self, walker: u32, child: NodeRef) {
        let kind = child.kind() % kind::COUNT;
        let at = self.put[kind];
        self.entries[kind][at % RING] = Entry { walker, child };
        self.put[kind] = at + 1;
    }

    /// The places of those who are in a list now.
    #[inline(always)]
    fn take(&mut self, kind: usize) -> Range<usize> {
        let all = self.taken[kind]..self.put[kind];
        self.taken[kind] = all.end;
        all
    }
}
