//! Walking a large tree with several rays in turn: the memory that one of them waits for arrives while the others move.
//!
//! In: rays and the root of a tree. Out: what [`super::traverse`] would find for each of them, in any order. Every walk
//! makes one visit, to a node or to a leaf, chooses and prefetches what it visits next, and gives way.

use std::mem::MaybeUninit;

use super::sheared::Sheared;
use super::simd::{LANE, Simd};
use super::slabs::Slabs;
use super::traverse::{Waiting, meet_leaf, meets_nothing};
use super::{Bvh, MAX_DEPTH, NodeRef};
use crate::{Bounds3, Hit, Ray, Rays};

/// Walks at a time: fewer wait for memory, more do not fit the first-level cache.
const AT_A_TIME: usize = 8;

/// What a walk comes back to.
type Stack<'a, S> = [MaybeUninit<Waiting<'a, S>>; MAX_DEPTH];

/// A ray under way.
#[derive(Clone, Copy)]
struct Walk<'a, S: Simd> {
    /// Which of the rays it is.
    index: usize,
    ray: Ray,
    sheared: Sheared<S>,
    slabs: Slabs<S>,
    t_max: S::F,
    closest: Hit,
    any: bool,
    next: NodeRef,
    now: Waiting<'a, S>,
    depth: usize,
}

impl<'a, S: Simd> Walk<'a, S> {
    /// At the root.
    #[inline(always)]
    fn new(simd: S, bvh: &'a Bvh, (root, bounds): (NodeRef, &Bounds3), (index, ray): (usize, Ray)) -> Self {
        let (slabs, t_max) = (Slabs::new(simd, &ray, bounds), simd.splat(ray.t_max));
        Self {
            index,
            ray,
            sheared: Sheared::new(simd, &ray),
            now: Waiting::at(simd, &slabs, bvh.node(root), t_max),
            slabs,
            t_max,
            closest: Hit::none_before(ray.t_max),
            any: false,
            next: NodeRef::NONE,
            depth: 0,
        }
    }

    /// Chooses what to visit next, if there is anything left.
    #[inline(always)]
    fn choose(&mut self, simd: S, bvh: &Bvh, stack: &Stack<'a, S>) -> bool {
        loop {
            let key = simd.take_least(&mut self.now.keys);
            if key & !LANE <= self.closest.t.to_bits() {
                self.next = self.now.children[(key & LANE) as usize];
                bvh.prefetch(simd, self.next);
                return true;
            }
            if self.depth == 0 {
                return false;
            }
            self.depth -= 1;
            // SAFETY: every entry below `depth` was written when `depth` passed it.
            self.now = unsafe { stack.get_unchecked(self.depth).assume_init() };
        }
    }

    /// Visits what was chosen, and chooses again. Is there more to visit?
    #[inline(always)]
    fn step<const ANY: bool>(
        &mut self,
        simd: S,
        bvh: &'a Bvh,
        stack: &mut Stack<'a, S>,
        meet_other: &impl Fn(u32, &Ray) -> Option<Hit>,
    ) -> bool {
        let child = self.next;
        let hit = if child.is_node() {
            debug_assert!(self.depth < MAX_DEPTH);
            // SAFETY: the builder makes no tree that is deeper than the stack.
            unsafe { stack.get_unchecked_mut(self.depth).write(self.now) };
            self.depth += 1;
            self.now = Waiting::at(simd, &self.slabs, bvh.node(child), self.t_max);
            false
        } else if child.is_leaf() {
            let at = (&self.ray, &bvh.leaves.leaf(child));
            meet_leaf::<_, ANY>(simd, &self.sheared, at, self.t_max, &mut self.closest)
        } else {
            let hit = meet_other(child.index() as u32, &Ray { t_max: self.closest.t, ..self.ray });
            self.closest = hit.unwrap_or(self.closest);
            hit.is_some()
        };
        if hit {
            self.any = true;
            if ANY {
                return false;
            }
            self.t_max = simd.splat(self.closest.t);
            bvh.leaves.prefetch_name(simd, &self.closest);
        }
        self.choose(simd, bvh, stack)
    }
}

/// Rays that wait for a walk to be free.
struct Queue<'r, 'b> {
    rays: &'r Rays,
    count: usize,
    next: usize,
    root: (NodeRef, &'b Bounds3),
}

impl Queue<'_, '_> {
    /// Starts a walk with the next ray that meets a child of the root, if there is any.
    #[inline(always)]
    fn start<'a, S: Simd>(
        &mut self,
        simd: S,
        bvh: &'a Bvh,
        (walk, stack): (&mut Walk<'a, S>, &Stack<'a, S>),
        answer: &mut impl FnMut(usize, Option<&Hit>),
    ) -> bool {
        while self.next < self.count {
            let (index, ray) = (self.next, self.rays.get(self.next));
            self.next += 1;
            if !meets_nothing(&ray) {
                *walk = Walk::new(simd, bvh, self.root, (index, ray));
                if walk.choose(simd, bvh, stack) {
                    return true;
                }
            }
            answer(index, None);
        }
        false
    }
}

/// Walks the tree of node `root` with the first `count` rays; `answer(i, hit)` gets what ray i hits. `ANY`: it gets
/// some hit or other.
#[inline(always)]
pub(super) fn walk_many<S: Simd, const ANY: bool>(
    simd: S,
    bvh: &Bvh,
    root: (NodeRef, &Bounds3),
    (rays, count): (&Rays, usize),
    meet_other: &impl Fn(u32, &Ray) -> Option<Hit>,
    mut answer: impl FnMut(usize, Option<&Hit>),
) {
    let mut queue = Queue { rays, count, next: 0, root };
    let mut walks = [Walk::new(simd, bvh, root, (0, rays.get(0))); AT_A_TIME];
    let mut stacks = [const { [const { MaybeUninit::uninit() }; MAX_DEPTH] }; AT_A_TIME];
    // The first `running` are the places of walks under way.
    let mut places = [0; AT_A_TIME];
    let mut running = 0;
    while running < AT_A_TIME && queue.start(simd, bvh, (&mut walks[running], &stacks[running]), &mut answer)
    {
        places[running] = running;
        running += 1;
    }
    while running > 0 {
        for turn in (0..running).rev() {
            let place = places[turn] % AT_A_TIME;
            let (walk, stack) = (&mut walks[place], &mut stacks[place]);
            if walk.step::<ANY>(simd, bvh, stack, meet_other) {
                continue;
            }
            bvh.leaves.name(&mut walk.closest);
            answer(walk.index, walk.any.then_some(&walk.closest));
            if !queue.start(simd, bvh, (walk, stack), &mut answer) {
                running -= 1;
                places.swap(turn, running);
            }
        }
    }
}
