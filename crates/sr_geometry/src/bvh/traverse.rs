//! Walking a tree with a ray, front to back.
//!
//! In: a ray and the root of a tree of more triangles than [`super::scan`] takes. Out: the closest hit, or whether there
//! is any. `sheared` meets triangles, `slabs` boxes.

use std::mem::MaybeUninit;

use glam::Vec3A;

use super::leaves::Leaf;
use super::sheared::{Meets, Sheared};
use super::simd::{LANE, Simd};
use super::slabs::Slabs;
use super::{Bvh, MAX_DEPTH, Node, NodeRef, WIDTH};
use crate::{Bounds3, Hit, Ray};

/// The children of a node that wait for their turn.
#[derive(Clone, Copy)]
pub(super) struct Waiting<'a, S: Simd> {
    pub keys: S::Keys,
    pub children: &'a [NodeRef; WIDTH],
}

impl<'a, S: Simd> Waiting<'a, S> {
    /// Those that the ray meets before `t_max`.
    #[inline(always)]
    pub fn at(simd: S, slabs: &Slabs<S>, node: &'a Node, t_max: S::F) -> Self {
        Self { keys: slabs.meet(simd, node, t_max), children: &node.children }
    }
}

/// Would the ray meet every box, and no triangle?
#[inline(always)]
pub(super) fn meets_nothing(ray: &Ray) -> bool {
    let sum = (Vec3A::from(ray.origin).abs() + Vec3A::from(ray.direction).abs()).element_sum();
    !(sum < f32::INFINITY && ray.t_max > 0.0)
}

/// Walks the tree of node `root`; was anything hit? `ANY`: stops at the first hit, else writes the closest to
/// `closest`.
#[inline(always)]
pub(super) fn walk<S: Simd, const ANY: bool>(
    simd: S,
    bvh: &Bvh,
    (root, bounds): (NodeRef, &Bounds3),
    ray: &Ray,
    meet_other: impl Fn(u32, &Ray) -> Option<Hit>,
    closest: &mut Hit,
) -> bool {
    if meets_nothing(ray) {
        return false;
    }
    let (sheared, slabs) = (Sheared::new(simd, ray), Slabs::new(simd, ray, bounds));
    let mut t_max = simd.splat(ray.t_max);
    let mut t_max_bits = ray.t_max.to_bits();
    let mut any = false;
    let mut stack = [const { MaybeUninit::<Waiting<'_, S>>::uninit() }; MAX_DEPTH];
    let mut depth = 0;
    let mut now = Waiting::at(simd, &slabs, bvh.node(root), t_max);
    loop {
        let key = simd.take_least(&mut now.keys);
        // Distances are not negative, so their bits are in the order of their values.
        if key & !LANE > t_max_bits {
            if depth == 0 {
                bvh.leaves.name(closest);
                return any;
            }
            depth -= 1;
            // SAFETY: every entry below `depth` was written when `depth` passed it.
            now = unsafe { stack.get_unchecked(depth).assume_init() };
            continue;
        }
        let child = now.children[(key & LANE) as usize];
        if child.is_node() {
            debug_assert!(depth < MAX_DEPTH);
            // SAFETY: the builder makes no tree that is deeper than the stack.
            unsafe { stack.get_unchecked_mut(depth).write(now) };
            depth += 1;
            now = Waiting::at(simd, &slabs, bvh.node(child), t_max);
            if bvh.prefetches {
                bvh.prefetch_all(simd, &now);
            }
            continue;
        }
        let hit = if child.is_leaf() {
            meet_leaf::<_, ANY>(simd, &sheared, (ray, &bvh.leaves.leaf(child)), t_max, closest)
        } else {
            let hit = meet_other(child.index() as u32, &Ray { t_max: f32::from_bits(t_max_bits), ..*ray });
            *closest = hit.unwrap_or(*closest);
            hit.is_some()
        };
        if hit {
            if ANY {
                return true;
            }
            t_max = simd.splat(closest.t);
            t_max_bits = closest.t.to_bits();
            bvh.leaves.prefetch_name(simd, closest);
            any = true;
        }
    }
}

/// Does the ray meet any triangle of a leaf before `t_max`? Unless `ANY`, `closest` becomes the closest such hit.
#[inline(always)]
pub(super) fn meet_leaf<S: Simd, const ANY: bool>(
    simd: S,
    sheared: &Sheared<S>,
    (ray, leaf): (&Ray, &Leaf<'_>),
    t_max: S::F,
    closest: &mut Hit,
) -> bool {
    let mut seen = sheared.project(simd, leaf);
    seen.inside = simd.and(seen.inside, simd.mask((1 << leaf.count) - 1));
    if simd.bits(seen.inside) == 0 {
        return false;
    }
    let meets = sheared.meet(simd, (ray, leaf), &seen, t_max);
    let hit = simd.bits(meets.hit);
    if !ANY && hit != 0 {
        write_closest(simd, leaf, hit, &meets, closest);
    }
    hit != 0
}

/// Writes the closest of a leaf's hits, those in `mask`, to `closest`.
#[inline(always)]
fn write_closest<S: Simd>(simd: S, leaf: &Leaf<'_>, mask: u32, meets: &Meets<S>, closest: &mut Hit) {
    let mut lane = mask.trailing_zeros() as usize % WIDTH;
    let mut t = simd.extract(meets.t, lane);
    let mut others = mask & (mask - 1);
    while others != 0 {
        let other = others.trailing_zeros() as usize % WIDTH;
        let other_t = simd.extract(meets.t, other);
        if other_t < t {
            (lane, t) = (other, other_t);
        }
        others &= others - 1;
    }
    *closest = leaf.hit(lane, t, [simd.extract(meets.b[0], lane), simd.extract(meets.b[1], lane)]);
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
    pub(super) fn prefetch<S: Simd>(&self, simd: S, child: NodeRef) {
        const LINE: usize = 64;
        if child.is_node() {
            let node = self.nodes.as_ptr().wrapping_add(child.index()).cast::<u8>();
            for line in 0..size_of::<Node>() / LINE {
                simd.prefetch(node.wrapping_add(LINE * line));
            }
            return;
        }
        // No line twice: that costs more than a branch. A leaf may start anywhere in its first line.
        let (start, bytes) = self.leaves.place(child);
        let mut at = 0;
        while at < bytes + LINE - 1 {
            simd.prefetch(start.wrapping_add(at));
            at += LINE;
        }
    }

    /// Asks for the cache lines of all children that are waiting.
    #[inline(always)]
    fn prefetch_all<S: Simd>(&self, simd: S, waiting: &Waiting<'_, S>) {
        let mut lanes = simd.keyed(waiting.keys);
        while lanes != 0 {
            self.prefetch(simd, waiting.children[lanes.trailing_zeros() as usize % WIDTH]);
            lanes &= lanes - 1;
        }
    }
}
