//! Walking a tree with a ray, front to back.
//!
//! - Triangles: Woop, Benthin & Wald 2013, "Watertight ray/triangle intersection": vertices are moved to the ray's
//!   origin and sheared so that the ray becomes the +Z axis; a vertex lands on the same point for every triangle
//!   that shares it, and the sign of an edge function is never wrong, so no ray slips between neighbours.
//! - Boxes: slabs that are widened by the rounding errors of their own test (Ize 2013) and of the shear (Woop et
//!   al.), so no box is missed whose triangles would be hit.

use std::mem::MaybeUninit;

use glam::Vec3;

use super::simd::{Kernel, Portable, Simd};
use super::{Bvh, MAX_DEPTH, Node, NodeRef, Tree, TriangleBlock, WIDTH};
use crate::{Bounds3, Hit, NO_INSTANCE, Ray, ShapeId};

/// Each node leaves at most seven children waiting.
const STACK_SIZE: usize = MAX_DEPTH * (WIDTH - 1);

/// How an interval's end grows to cover the three roundings of (bound − origin) · (1 / direction).
const FAR_SLACK: f32 = 1.0 + 4.0 * f32::EPSILON;

/// Rounding error of a sheared vertex, per unit of its distance from the ray's origin (largest component).
const SHEAR_SLACK: f32 = 5.0 * f32::EPSILON;

/// A ray, ready to meet boxes and triangles.
struct Prepared<S: Simd> {
    /// Per axis: which end of a slab is nearer, 0 for the smaller coordinate.
    near: [usize; 3],
    /// Origins, moved apart by the rounding errors of sheared vertices.
    origin_near: [S::F; 3],
    origin_far: [S::F; 3],
    inv_near: [S::F; 3],
    inv_far: [S::F; 3],
    /// Axes: the two that are sheared, and last the one along which the direction is longest.
    axes: [usize; 3],
    /// Origin, in the order of `axes`.
    origin: [S::F; 3],
    /// What z is multiplied by: shears of the first two axes, and the scale of the last.
    shear: [S::F; 3],
}

impl<S: Simd> Prepared<S> {
    /// `None` for rays that cannot hit anything: not finite, or without a direction.
    #[inline(always)]
    fn new(simd: S, ray: &Ray, bounds: &Bounds3) -> Option<Self> {
        let (origin, direction) = (ray.origin, ray.direction);
        let length = direction.abs();
        let sum = (origin.abs() + length).element_sum();
        if !(sum < f32::INFINITY && length.max_element() > 0.0) {
            return None;
        }
        let last = match () {
            () if length.x > length.y && length.x > length.z => 0,
            () if length.y > length.z => 1,
            () => 2,
        };
        let axes = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][last];
        let scale = 1.0 / direction[axes[2]];
        let inverse = direction.recip();
        let reach = (bounds.min - origin).abs().max((bounds.max - origin).abs()).max_element();
        let error = Vec3::splat(SHEAR_SLACK * reach).copysign(inverse);
        let splat = |v: Vec3| [simd.splat(v.x), simd.splat(v.y), simd.splat(v.z)];
        Some(Self {
            near: [0, 1, 2].map(|axis| usize::from(inverse[axis] < 0.0)),
            origin_near: splat(origin + error),
            origin_far: splat(origin - error),
            inv_near: splat(inverse),
            inv_far: splat(inverse * FAR_SLACK),
            axes,
            origin: axes.map(|axis| simd.splat(origin[axis])),
            shear: [
                simd.splat(direction[axes[0]] * scale),
                simd.splat(direction[axes[1]] * scale),
                simd.splat(scale),
            ],
        })
    }

    /// Which children of a node the ray meets before `t_max` (bit i: child i), and where it enters them.
    #[inline(always)]
    fn meet_node(&self, simd: S, node: &Node, t_max: S::F) -> (u32, S::F) {
        let mut enter = simd.splat(0.0);
        let mut leave = t_max;
        for axis in 0..3 {
            let slab = &node.bounds[axis];
            let near = simd.load(&slab[self.near[axis] & 1]);
            let far = simd.load(&slab[self.near[axis] & 1 ^ 1]);
            // A ray within the plane of a slab gives NaN, which `max` and `min` then ignore.
            enter = simd.max(simd.mul(simd.sub(near, self.origin_near[axis]), self.inv_near[axis]), enter);
            leave = simd.min(simd.mul(simd.sub(far, self.origin_far[axis]), self.inv_far[axis]), leave);
        }
        (simd.le(enter, leave), enter)
    }

    /// Which triangles of a block the ray meets in (0, `t_max`), with their t and barycentric coordinates.
    #[inline(always)]
    fn meet_block(&self, simd: S, block: &TriangleBlock, t_max: f32) -> Option<(u32, [S::F; 3])> {
        let [a, b, c] = [0, 1, 2].map(|i| self.sheared(simd, &block.vertices[i]));
        let edge = |p: [S::F; 3], q: [S::F; 3]| simd.sub(simd.mul(p[0], q[1]), simd.mul(p[1], q[0]));
        let (of_a, of_b, of_c) = (edge(c, b), edge(a, c), edge(b, a));
        let zero = simd.splat(0.0);
        let least = simd.min(simd.min(of_a, of_b), of_c);
        let most = simd.max(simd.max(of_a, of_b), of_c);
        let inside = simd.le(zero, least) | simd.le(most, zero);
        if inside == 0 {
            return None;
        }
        // An edge-on triangle has a zero determinant, hence t = NaN, which fails both comparisons.
        let inv_det = simd.div(simd.splat(1.0), simd.add(simd.add(of_a, of_b), of_c));
        let (b0, b1, b2) = (simd.mul(of_a, inv_det), simd.mul(of_b, inv_det), simd.mul(of_c, inv_det));
        let z = simd.add(simd.add(simd.mul(b0, a[2]), simd.mul(b1, b[2])), simd.mul(b2, c[2]));
        let t = simd.mul(z, self.shear[2]);
        let hit = inside & simd.lt(zero, t) & simd.lt(t, simd.splat(t_max));
        (hit != 0).then_some((hit, [t, b1, b2]))
    }

    /// A vertex relative to the ray: sheared x and y, and unscaled z.
    #[inline(always)]
    fn sheared(&self, simd: S, vertex: &[[f32; WIDTH]; 3]) -> [S::F; 3] {
        let relative = |i: usize| simd.sub(simd.load(&vertex[self.axes[i]]), self.origin[i]);
        let z = relative(2);
        let shear = |i: usize| simd.sub(relative(i), simd.mul(self.shear[i], z));
        [shear(0), shear(1), z]
    }
}

/// Children that wait, nearest on top.
struct Stack {
    entries: [MaybeUninit<(f32, NodeRef)>; STACK_SIZE],
    len: usize,
}

impl Stack {
    #[inline(always)]
    fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; STACK_SIZE], len: 0 }
    }

    #[inline(always)]
    fn push(&mut self, entry: (f32, NodeRef)) {
        self.entries[self.len].write(entry);
        self.len += 1;
    }

    #[inline(always)]
    fn get(&self, i: usize) -> (f32, NodeRef) {
        debug_assert!(i < self.len);
        // SAFETY: entries below `len` are always written, and `(f32, NodeRef)` is `Copy`.
        unsafe { self.entries[i].assume_init() }
    }

    /// The entry on top. There must be one.
    #[inline(always)]
    fn take(&mut self) -> (f32, NodeRef) {
        let entry = self.get(self.len - 1);
        self.len -= 1;
        entry
    }

    /// The nearest child that the ray enters before `t_max`.
    #[inline(always)]
    fn pop(&mut self, t_max: f32) -> Option<NodeRef> {
        while self.len > 0 {
            let (enter, child) = self.take();
            if enter < t_max {
                return Some(child);
            }
        }
        None
    }

    /// Pushes the children in `mask`, farthest first.
    #[inline(always)]
    fn push_sorted(&mut self, mut mask: u32, enter: &[f32; WIDTH], children: &[NodeRef; WIDTH]) {
        let first = self.len;
        while mask != 0 {
            let child = mask.trailing_zeros() as usize % WIDTH;
            mask &= mask - 1;
            let entry = (enter[child], children[child]);
            let mut at = self.len;
            while at > first && self.get(at - 1).0 < entry.0 {
                self.entries[at] = self.entries[at - 1];
                at -= 1;
            }
            self.entries[at].write(entry);
            self.len += 1;
        }
    }
}

/// Walks `tree`. `ANY`: stops at the first hit, which need not be the closest.
#[inline(always)]
fn walk<S: Simd, const ANY: bool>(
    simd: S,
    bvh: &Bvh,
    tree: &Tree,
    ray: &Ray,
    meet_other: impl Fn(u32, &Ray) -> Option<Hit>,
) -> Option<Hit> {
    let prepared = Prepared::new(simd, ray, &tree.bounds)?;
    let mut ray = *ray;
    let mut closest = None;
    let mut stack = Stack::new();
    if tree.root != NodeRef::NONE {
        stack.push((0.0, tree.root));
    }
    while let Some(mut child) = stack.pop(ray.t_max) {
        while child.is_node() {
            let node = &bvh.nodes[child.index()];
            let (mask, enter) = prepared.meet_node(simd, node, simd.splat(ray.t_max));
            if mask == 0 {
                child = NodeRef::NONE;
                break;
            }
            if mask & (mask - 1) == 0 {
                child = node.children[mask.trailing_zeros() as usize % WIDTH];
                continue;
            }
            stack.push_sorted(mask, &simd.to_array(enter), &node.children);
            child = stack.take().1;
        }
        let hit = if child.is_block() {
            meet_block(simd, &prepared, &bvh.blocks[child.index()], ray.t_max)
        } else if child != NodeRef::NONE {
            meet_other(child.index() as u32, &ray)
        } else {
            None
        };
        if let Some(hit) = hit {
            if ANY {
                return Some(hit);
            }
            ray.t_max = hit.t;
            closest = Some(hit);
        }
    }
    closest
}

/// The closest hit within a block.
#[inline(always)]
fn meet_block<S: Simd>(simd: S, ray: &Prepared<S>, block: &TriangleBlock, t_max: f32) -> Option<Hit> {
    let (mut mask, [t, b1, b2]) = ray.meet_block(simd, block, t_max)?;
    let t = simd.to_array(t);
    let mut lane = mask.trailing_zeros() as usize % WIDTH;
    mask &= mask - 1;
    while mask != 0 {
        let other = mask.trailing_zeros() as usize % WIDTH;
        mask &= mask - 1;
        if t[other] < t[lane] {
            lane = other;
        }
    }
    Some(Hit {
        t: t[lane],
        b1: simd.to_array(b1)[lane],
        b2: simd.to_array(b2)[lane],
        shape: ShapeId(block.shape[lane]),
        primitive: block.primitive[lane],
        instance: NO_INSTANCE,
    })
}

impl Bvh {
    /// The closest hit. `meet_other(i, ray)` answers for the primitives that are not triangles.
    pub fn intersect(
        &self,
        tree: &Tree,
        ray: &Ray,
        meet_other: impl Fn(u32, &Ray) -> Option<Hit>,
    ) -> Option<Hit> {
        self.dispatch::<false>(tree, ray, meet_other)
    }

    /// Is there any hit?
    pub fn occluded(&self, tree: &Tree, ray: &Ray, meet_other: impl Fn(u32, &Ray) -> Option<Hit>) -> bool {
        self.dispatch::<true>(tree, ray, meet_other).is_some()
    }

    #[inline(always)]
    fn dispatch<const ANY: bool>(
        &self,
        tree: &Tree,
        ray: &Ray,
        meet_other: impl Fn(u32, &Ray) -> Option<Hit>,
    ) -> Option<Hit> {
        match self.kernel {
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2(avx2) => {
                #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt")]
                fn walk_avx2<const ANY: bool>(
                    avx2: super::simd::Avx2,
                    bvh: &Bvh,
                    tree: &Tree,
                    ray: &Ray,
                    meet_other: impl Fn(u32, &Ray) -> Option<Hit>,
                ) -> Option<Hit> {
                    walk::<_, ANY>(avx2, bvh, tree, ray, meet_other)
                }
                // SAFETY: an `Avx2` is the proof that this processor has these features.
                unsafe { walk_avx2::<ANY>(avx2, self, tree, ray, meet_other) }
            }
            Kernel::Portable(Portable) => walk::<_, ANY>(Portable, self, tree, ray, meet_other),
        }
    }
}
