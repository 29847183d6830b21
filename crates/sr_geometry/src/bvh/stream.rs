//! Walking a tree with several rays in turn: while one of them waits, for memory or for what it has just computed, the
//! others move.
//!
//! In: rays and the root of a tree. Out: what [`super::traverse`] would find for each of them, in any order. The rays
//! that are at a node make a step, one after another, then those at a leaf: a processor meets no branch that it could
//! guess wrongly but for the ends of these loops.

use std::mem::MaybeUninit;

use glam::Vec3;

use super::node::kind;
use super::prepare::{CHUNK, Prepared};
use super::simd::Walk;
use super::walker::{Turn, Walker};
use super::{Bvh, Met, NodeRef};
use crate::{BATCH, Bounds3, Hit, NO_INSTANCE, Ray, Rays};

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
    let mut prepared = Prepared::take_spare();
    let mut places = Places::<ANY>::EMPTY;
    // Rays in the space of an instance, by walker.
    let mut placed = [Ray::new(Vec3::ZERO, Vec3::ZERO); AT_A_TIME];
    let mut waiting = Waiting::NOBODY;
    let mut idle = Set::ALL;
    let mut queued = 0;
    loop {
        while idle != Set::NONE && queued < count {
            if queued % CHUNK == 0 {
                prepared.prepare(rays, queued, bounds);
            }
            if prepared.meets_nothing(queued) {
                answer(queued, None);
            } else if let Some(i) = idle.next() {
                places.start(i, queued, rays.t_max[queued % BATCH]);
                waiting.put(i, root);
            }
            queued += 1;
        }
        if idle == Set::ALL {
            break;
        }
        // Each makes one step.
        let (nodes, leaves, others) =
            (waiting.take(kind::NODE), waiting.take(kind::LEAF), waiting.take(kind::OTHER));
        for i in nodes {
            let walker = places.walker(i);
            let next = walker.visit_node(simd, &prepared.line(walker.ray), bvh, waiting.child(i));
            bvh.prefetch_if_large(simd, next);
            waiting.put(i, next);
        }
        for i in leaves {
            let walker = places.walker(i);
            let (sheared, leaf) = (prepared.sheared(walker.ray), bvh.leaves.leaf(waiting.child(i)));
            let (number, instance) = (walker.ray, walker.instance);
            let ray = || ray_in(instance, rays, number, &placed[i % AT_A_TIME]);
            if walker.visit_leaf::<_, false>(simd, &sheared, &leaf, ray) {
                walker.forget_beyond(simd);
            }
            let next = walker.stack.pop();
            bvh.prefetch_if_large(simd, next);
            waiting.put(i, next);
        }
        for i in others {
            let (walker, child) = (places.walker(i), waiting.child(i));
            let number = walker.ray % BATCH;
            if child == NodeRef::DONE {
                answer(number, walker.hit(bvh).as_ref());
                idle.insert(i);
                continue;
            }
            let mut turn = Turn::Stays;
            if child == NodeRef::BACK {
                walker.go_back();
            } else {
                let ray = ray_in(walker.instance, rays, number, &placed[i % AT_A_TIME]);
                turn = walker.visit_other(simd, bvh, &ray, child.index() as u32, meet_other);
                walker.forget_beyond(simd);
            }
            let next = walker.next();
            if let Turn::Enters(ray, bounds) = turn {
                placed[i % AT_A_TIME] = ray;
                prepared.set(number, &ray, &bounds);
            } else if walker.arrives(next) {
                prepared.set(number, &rays.get(number), bounds);
            }
            bvh.prefetch_if_large(simd, next);
            waiting.put(i, next);
        }
    }
    prepared.keep_spare();
}

/// A ray of a batch, or where it is placed in the space of an instance.
#[inline(always)]
fn ray_in(instance: u32, rays: &Rays, number: usize, placed: &Ray) -> Ray {
    if instance == NO_INSTANCE { rays.get(number % BATCH) } else { *placed }
}

/// The walkers.
struct Places<const ANY: bool>([MaybeUninit<Walker<ANY>>; AT_A_TIME]);

impl<const ANY: bool> Places<ANY> {
    const EMPTY: Self = Self([const { MaybeUninit::uninit() }; AT_A_TIME]);

    #[inline(always)]
    fn start(&mut self, i: usize, ray: usize, t_max: f32) {
        Walker::start(&mut self.0[i % AT_A_TIME], ray, t_max);
    }

    /// A walker that was started.
    #[inline(always)]
    fn walker(&mut self, i: usize) -> &mut Walker<ANY> {
        debug_assert!(i < AT_A_TIME);
        // SAFETY: only those who were started wait for anything.
        unsafe { self.0.get_unchecked_mut(i).assume_init_mut() }
    }
}

/// Walkers, a bit each, in ascending order.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Set(u64);

impl Set {
    const NONE: Self = Self(0);
    const ALL: Self = Self((1 << AT_A_TIME) - 1);

    #[inline(always)]
    fn insert(&mut self, i: usize) {
        self.0 |= 1 << i;
    }
}

impl Iterator for Set {
    type Item = usize;

    /// Takes the first.
    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let (first, any) = (self.0.trailing_zeros() as usize, self.0 != 0);
        self.0 &= self.0.wrapping_sub(1);
        any.then_some(first)
    }
}

/// Walkers who wait, by the kind of what they visit next.
///
/// The sets are kept in one number, and the places of the children do not depend on what they are: while a processor does
/// not know yet where something will be written, it does not read ahead.
struct Waiting {
    /// A [`Set`] for each kind.
    sets: u64,
    children: [NodeRef; AT_A_TIME],
}

impl Waiting {
    const NOBODY: Self = Self { sets: 0, children: [NodeRef::DONE; AT_A_TIME] };

    #[inline(always)]
    fn put(&mut self, i: usize, child: NodeRef) {
        self.children[i % AT_A_TIME] = child;
        self.sets |= 1 << (i + AT_A_TIME * child.kind());
    }

    /// What a walker visits next.
    #[inline(always)]
    fn child(&self, i: usize) -> NodeRef {
        self.children[i % AT_A_TIME]
    }

    /// Takes those who wait for a kind.
    #[inline(always)]
    fn take(&mut self, kind: usize) -> Set {
        let set = Set(self.sets >> (AT_A_TIME * kind) & Set::ALL.0);
        self.sets &= !(Set::ALL.0 << (AT_A_TIME * kind));
        set
    }
}
