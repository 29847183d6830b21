//! What a walk comes back to.

use std::hint::select_unpredictable;
use std::mem::MaybeUninit;

use super::simd::Walk;
use super::{MAX_DEPTH, Node, NodeRef, WIDE, WIDTH};

/// [`NodeRef::DONE`] and [`NodeRef::BACK`], what every node on the way to a leaf leaves, in a tree and in one that is
/// placed in it (in which none is placed), and what is written at a time.
const CAPACITY: usize = 2 + 2 * (WIDE - 1) * MAX_DEPTH + 2 * WIDE;

/// Children that wait for their turn, the next one last, and where the ray enters them. The first is [`NodeRef::DONE`].
///
/// A hit puts children out of reach. Either all of them are removed at once, or each is looked at when its turn comes.
pub(super) struct Stack {
    depth: usize,
    children: [MaybeUninit<NodeRef>; CAPACITY],
    enters: [MaybeUninit<f32>; CAPACITY],
}

impl Stack {
    /// Holds nothing but [`NodeRef::DONE`].
    #[inline(always)]
    pub fn reset(&mut self) {
        self.children[0].write(NodeRef::DONE);
        self.enters[0].write(0.0);
        self.depth = 1;
    }

    /// Adds a child that is always within reach.
    #[inline(always)]
    pub fn push(&mut self, child: NodeRef) {
        debug_assert!(self.depth + WIDE <= CAPACITY);
        self.children[self.depth].write(child);
        self.enters[self.depth].write(0.0);
        self.depth += 1;
    }

    /// Takes the last child. Never to be called after it was [`NodeRef::DONE`].
    #[inline(always)]
    pub fn pop(&mut self) -> NodeRef {
        debug_assert!(self.depth > 0);
        self.depth -= 1;
        // SAFETY: every entry below `depth` was written.
        unsafe { self.children.get_unchecked(self.depth).assume_init() }
    }

    /// As `pop`, but for children that are entered beyond `t_max`.
    #[inline(always)]
    pub fn pop_within(&mut self, t_max: f32) -> NodeRef {
        loop {
            let child = self.pop();
            // SAFETY: the entry was written.
            if unsafe { self.enters.get_unchecked(self.depth).assume_init() } <= t_max {
                return child;
            }
        }
    }

    /// Where the child is entered that was popped last.
    #[inline(always)]
    pub fn entered(&self) -> f32 {
        // SAFETY: it was written with the child, and not overwritten since.
        unsafe { self.enters.get_unchecked(self.depth).assume_init() }
    }

    /// The last children, from `depth` on.
    #[inline(always)]
    pub fn since(&self, depth: usize) -> &[NodeRef] {
        let count = self.depth.saturating_sub(depth);
        // SAFETY: every entry below `depth` was written.
        unsafe { std::slice::from_raw_parts(self.children.as_ptr().add(self.depth - count).cast(), count) }
    }

    #[inline(always)]
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Where the next [`WIDE`] children and the places where they are entered may be written.
    #[inline(always)]
    pub fn top(&mut self) -> [*mut u32; 2] {
        self.at(self.depth)
    }

    /// Keeps the first `count` of those that were written to the top.
    ///
    /// # Safety
    /// They were written, and a node has as many children.
    #[inline(always)]
    pub unsafe fn keep(&mut self, count: u32) {
        self.depth += count as usize;
    }

    /// Keeps what was written to the top, and takes the last of it, which is one of a node's children; or if nothing was, what
    /// lay there. `met`: which of the node's slots, flipped by `flip`, were written.
    ///
    /// # Safety
    /// As many were written as `met` has bits, of which there are at most [`WIDE`].
    #[inline(always)]
    pub unsafe fn keep_and_pop(&mut self, met: u32, flip: u32, node: &Node) -> NodeRef {
        // Not from the stack, which was just written: the processor would wait for it.
        let nearest = (31 - (met | 1).leading_zeros()) ^ flip;
        let new = node.children[nearest as usize % WIDE];
        // SAFETY: there is at least [`NodeRef::DONE`], as long as it was not popped.
        let old = unsafe { self.children.get_unchecked(self.depth - 1).assume_init() };
        self.depth = self.depth + met.count_ones() as usize - 1;
        select_unpredictable(met != 0, new, old)
    }

    /// Forgets all children if `met`.
    #[inline(always)]
    pub fn clear_if(&mut self, met: bool) {
        self.depth = select_unpredictable(met, 1, self.depth);
    }

    /// Forgets the children that are entered beyond `t_max`.
    #[inline(always)]
    pub fn forget_beyond<S: Walk>(&mut self, simd: S, t_max: f32) {
        let (mut kept, mut first) = (0, 0);
        while first < self.depth {
            let within = (1_u32 << (self.depth - first).min(WIDTH)) - 1;
            // SAFETY: those below `depth` were written; `kept` is not beyond `first`, which is below `depth`, and that
            // leaves room for WIDTH more.
            kept += unsafe { simd.forget_beyond(t_max, within, self.at(first), self.at(kept)) } as usize;
            first += WIDTH;
        }
        self.depth = kept;
    }

    #[inline(always)]
    fn at(&mut self, depth: usize) -> [*mut u32; 2] {
        debug_assert!(depth + WIDE <= CAPACITY);
        let (children, enters) = (self.children.as_mut_ptr(), self.enters.as_mut_ptr());
        // A `NodeRef` is a `u32`.
        [children.wrapping_add(depth).cast(), enters.wrapping_add(depth).cast()]
    }
}
