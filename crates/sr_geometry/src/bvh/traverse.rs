//! Walking a tree with a ray, about front to back.
//!
//! In: a ray and the root of a tree that has nodes. Out: the closest hit, or whether there
//! is any.

use std::hint::select_unpredictable;
use std::mem::MaybeUninit;

use super::node::kind;
use super::sheared::Sheared;
use super::simd::Walk;
use super::slabs::Line;
use super::walker::{Turn, Walker};
use super::{Bvh, Met, Node, NodeRef};
use crate::{Bounds3, Hit, Ray};

/// Would the ray meet every box, and no triangle?
#[inline(always)]
pub(super) fn meets_nothing(ray: &Ray) -> bool {
    let sum = (ray.origin.abs() + ray.direction.abs()).element_sum();
    !(sum < f32::INFINITY && ray.t_max > 0.0)
}

/// Walks the tree of node `root`; was anything hit? `ANY`: stops at the first hit, else writes the closest to
/// `closest`.
#[inline(always)]
pub(super) fn walk<S: Walk, const ANY: bool>(
    simd: S,
    bvh: &Bvh,
    (root, bounds): (NodeRef, &Bounds3),
    ray: &Ray,
    meet_other: impl Fn(u32, &Ray) -> Met,
    closest: &mut Hit,
) -> bool {
    if meets_nothing(ray) {
        return false;
    }
    let mut walker = MaybeUninit::<Walker<ANY>>::uninit();
    let mut at = *ray;
    let mut sheared = Sheared::new(ray.origin, ray.direction);
    let mut line = Line::new(ray.origin, ray.direction, bounds);
    let walker = Walker::start(&mut walker, 0, ray.t_max);
    let mut child = root;
    while child != NodeRef::DONE {
        match child.kind() {
            kind::NODE => {
                let depth = walker.stack.depth();
                child = walker.visit_node(simd, &line, bvh, child);
                if bvh.prefetches {
                    walker.prefetch_since(simd, bvh, depth);
                }
                // A child of the node is within reach; what waited before it may not be.
                if !ANY && walker.stack.depth() < depth && walker.stack.entered() > walker.t {
                    child = walker.next();
                }
                continue;
            }
            kind::LEAF => {
                walker.visit_leaf::<_, true>(simd, &sheared, &bvh.leaves.leaf(child), || at);
            }
            _ => {
                let mut turn = Turn::Stays;
                match child {
                    NodeRef::BACK => {
                        walker.go_back();
                        at = *ray;
                    }
                    _ => turn = walker.visit_other(simd, bvh, &at, child.index() as u32, &meet_other),
                }
                child = walker.next();
                if let Turn::Enters(ray, bounds) = turn {
                    at = ray;
                    sheared = Sheared::new(at.origin, at.direction);
                    line = Line::new(at.origin, at.direction, &bounds);
                } else if walker.arrives(child) {
                    sheared = Sheared::new(at.origin, at.direction);
                    line = Line::new(at.origin, at.direction, bounds);
                }
                continue;
            }
        }
        child = walker.next();
    }
    let hit = walker.hit(bvh);
    *closest = hit.unwrap_or(*closest);
    hit.is_some()
}

impl Bvh {
    /// The node of a reference to a node.
    #[inline(always)]
    pub(super) fn node(&self, child: NodeRef) -> &Node {
        debug_assert!(child.is_node() && child.index() < self.nodes.len());
        // SAFETY: references to nodes are made by the builder, for nodes that it appends.
        unsafe { self.nodes.get_unchecked(child.index()) }
    }

    /// Asks for the cache lines of a child. Any reference will do.
    #[inline(always)]
    pub(super) fn prefetch<S: Walk>(&self, simd: S, child: NodeRef) {
        const LINE: usize = 64;
        /// Lines of most leaves.
        const OF_LEAF: usize = 4;
        let node = self.nodes.as_ptr().wrapping_add(child.index()).cast::<u8>();
        // Chosen without a branch, which would be guessed wrongly often.
        let at = select_unpredictable(child.is_node(), node, self.leaves.place(child));
        let rest = OF_LEAF * LINE * usize::from(child.is_node());
        for line in 0..OF_LEAF {
            simd.prefetch(at.wrapping_add(LINE * line));
        }
        // Of a leaf the first ones again.
        for line in 0..size_of::<Node>() / LINE - OF_LEAF {
            simd.prefetch(at.wrapping_add(rest + LINE * line));
        }
    }

    /// As `prefetch`, if the tree is so large that this pays.
    #[inline(always)]
    pub(super) fn prefetch_if_large<S: Walk>(&self, simd: S, child: NodeRef) {
        if self.prefetches {
            self.prefetch(simd, child);
        }
    }
}
