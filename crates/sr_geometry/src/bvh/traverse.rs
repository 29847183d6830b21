//! Walking a tree with a ray, front to back.
//!
//! - Triangles: Woop, Benthin & Wald 2013, "Watertight ray/triangle intersection": vertices are moved to the ray's
//!   origin and sheared so that the ray becomes the +Z axis; a vertex lands on the same point for every triangle
//!   that shares it, and the sign of an edge function is never wrong, so no ray slips between neighbours.
//! - Boxes: slabs that are widened by the rounding errors of their own test (Ize 2013) and of the shear (Woop et
//!   al.), so no box is missed whose triangles would be hit.

use std::mem::MaybeUninit;

use glam::Vec3A;

use super::simd::{Kernel, LANE, Portable, Simd};
use super::{Bvh, MAX_DEPTH, Node, NodeRef, Tree, TriangleBlock, WIDTH};
use crate::{Bounds3, Hit, NO_INSTANCE, Ray, ShapeId};

/// Orders of axes, by the last.
static AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

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
    /// `None` for rays that cannot hit anything: not finite, or without a direction or an extent.
    #[inline(always)]
    fn new(simd: S, ray: &Ray, bounds: &Bounds3) -> Option<Self> {
        let (origin, direction) = (Vec3A::from(ray.origin), Vec3A::from(ray.direction));
        let length = direction.abs();
        let longest = length.max_element();
        let sum = (origin.abs() + length).element_sum();
        if !(sum < f32::INFINITY && longest > 0.0 && ray.t_max > 0.0) {
            return None;
        }
        let inverse = direction.recip();
        let negative = inverse.is_negative_bitmask() as usize;
        let reach = (Vec3A::from(bounds.min) - origin).abs().max((Vec3A::from(bounds.max) - origin).abs());
        let error = Vec3A::splat(SHEAR_SLACK * reach.max_element()).copysign(inverse);
        let longest = length.cmpeq(Vec3A::splat(longest)).bitmask().trailing_zeros() as usize;
        let axes = AXES[longest % 3];
        let (from, along) = (ray.origin.to_array(), ray.direction.to_array());
        let scale = inverse.to_array()[axes[2]];
        Some(Self {
            near: [negative & 1, negative >> 1 & 1, negative >> 2 & 1],
            origin_near: splat(simd, origin + error),
            origin_far: splat(simd, origin - error),
            inv_near: splat(simd, inverse),
            inv_far: splat(simd, inverse * FAR_SLACK),
            axes,
            origin: [simd.splat(from[axes[0]]), simd.splat(from[axes[1]]), simd.splat(from[axes[2]])],
            shear: [
                simd.splat(along[axes[0]] * scale),
                simd.splat(along[axes[1]] * scale),
                simd.splat(scale),
            ],
        })
    }

    /// The children of a node that the ray meets before `t_max`, ordered by where it enters them.
    #[inline(always)]
    fn meet_node(&self, simd: S, node: &Node, t_max: S::F) -> S::Keys {
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
        simd.keys(enter, leave)
    }

    /// Which triangles of a block the ray meets in (0, `t_max`), with their t and barycentric coordinates.
    #[inline(always)]
    fn meet_block(&self, simd: S, block: &TriangleBlock, t_max: f32) -> Option<(u32, [S::F; 3])> {
        let a = self.sheared(simd, &block.vertices[0]);
        let b = self.sheared(simd, &block.vertices[1]);
        let c = self.sheared(simd, &block.vertices[2]);
        let (of_a, of_b, of_c) = (edge(simd, c, b), edge(simd, a, c), edge(simd, b, a));
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
        let x = simd.sub(simd.load(&vertex[self.axes[0]]), self.origin[0]);
        let y = simd.sub(simd.load(&vertex[self.axes[1]]), self.origin[1]);
        let z = simd.sub(simd.load(&vertex[self.axes[2]]), self.origin[2]);
        [simd.sub(x, simd.mul(self.shear[0], z)), simd.sub(y, simd.mul(self.shear[1], z)), z]
    }
}

// Functions rather than closures: only what is always inlined is compiled for the instruction set of the caller.

#[inline(always)]
fn splat<S: Simd>(simd: S, v: Vec3A) -> [S::F; 3] {
    [simd.splat(v.x), simd.splat(v.y), simd.splat(v.z)]
}

/// Twice the signed area between the ray and the projected edge from `q` to `p`.
#[inline(always)]
fn edge<S: Simd>(simd: S, p: [S::F; 3], q: [S::F; 3]) -> S::F {
    simd.sub(simd.mul(p[0], q[1]), simd.mul(p[1], q[0]))
}

/// The children of a node that wait for their turn.
#[derive(Clone, Copy)]
struct Waiting<'a, S: Simd> {
    keys: S::Keys,
    children: &'a [NodeRef; WIDTH],
}

/// Walks `tree`; was anything hit? `ANY`: stops at the first hit, else writes the closest to `closest`.
#[inline(always)]
fn walk<S: Simd, const ANY: bool>(
    simd: S,
    bvh: &Bvh,
    tree: &Tree,
    ray: &Ray,
    meet_other: impl Fn(u32, &Ray) -> Option<Hit>,
    closest: &mut Hit,
) -> bool {
    let Some(prepared) = Prepared::new(simd, ray, &tree.bounds) else { return false };
    let mut t_max = ray.t_max;
    let mut any = false;
    // A node waits here only while the walk is below it.
    let mut stack = [const { MaybeUninit::<Waiting<'_, S>>::uninit() }; MAX_DEPTH];
    let mut depth = 0;
    let mut child = tree.root;
    loop {
        if child.is_node() {
            let node = &bvh.nodes[child.index()];
            let keys = prepared.meet_node(simd, node, simd.splat(t_max));
            stack[depth].write(Waiting { keys, children: &node.children });
            depth += 1;
        } else if child.is_block() {
            let block = &bvh.blocks[child.index()];
            if let Some((mask, at)) = prepared.meet_block(simd, block, t_max) {
                if ANY {
                    return true;
                }
                write_closest(simd, block, mask, at, closest);
                (t_max, any) = (closest.t, true);
            }
        } else if child != NodeRef::NONE
            && let Some(hit) = meet_other(child.index() as u32, &Ray { t_max, ..*ray })
        {
            if ANY {
                return true;
            }
            *closest = hit;
            (t_max, any) = (hit.t, true);
        }
        child = loop {
            if depth == 0 {
                return any;
            }
            // SAFETY: every entry below `depth` was written when `depth` passed it.
            let waiting = unsafe { stack[depth - 1].assume_init_mut() };
            let key = simd.take_least(&mut waiting.keys);
            // Distances are not negative, so their bits are in the order of their values.
            if key & !LANE <= t_max.to_bits() {
                if bvh.prefetches {
                    let next = simd.least(waiting.keys);
                    bvh.prefetch(simd, waiting.children[(next & LANE) as usize]);
                }
                break waiting.children[(key & LANE) as usize];
            }
            depth -= 1;
        };
    }
}

/// Writes the closest of a block's hits, those in `mask`, to `closest`.
#[inline(always)]
fn write_closest<S: Simd>(simd: S, block: &TriangleBlock, mut mask: u32, at: [S::F; 3], closest: &mut Hit) {
    let t = simd.to_array(at[0]);
    let mut lane = mask.trailing_zeros() as usize % WIDTH;
    mask &= mask - 1;
    while mask != 0 {
        let other = mask.trailing_zeros() as usize % WIDTH;
        mask &= mask - 1;
        if t[other] < t[lane] {
            lane = other;
        }
    }
    closest.t = t[lane];
    closest.b1 = simd.to_array(at[1])[lane];
    closest.b2 = simd.to_array(at[2])[lane];
    closest.shape = ShapeId(block.shape[lane]);
    closest.primitive = block.primitive[lane];
    closest.instance = NO_INSTANCE;
}

impl Bvh {
    /// Asks for the cache lines of a child that comes next unless a hit hides it. Any reference will do.
    #[inline(always)]
    fn prefetch<S: Simd>(&self, simd: S, child: NodeRef) {
        let node = self.nodes.as_ptr().wrapping_add(child.index()).cast::<u8>();
        let block = self.blocks.as_ptr().wrapping_add(child.index()).cast::<u8>();
        simd.prefetch::<TriangleBlock>(if child.is_node() { node } else { block }.cast());
    }

    /// The closest hit. `meet_other(i, ray)` answers for the primitives that are not triangles.
    #[inline]
    pub fn intersect(
        &self,
        tree: &Tree,
        ray: &Ray,
        meet_other: impl Fn(u32, &Ray) -> Option<Hit>,
    ) -> Option<Hit> {
        let mut closest =
            Hit { t: ray.t_max, b1: 0.0, b2: 0.0, shape: ShapeId(0), primitive: 0, instance: NO_INSTANCE };
        self.walk::<false>(tree, ray, meet_other, &mut closest).then_some(closest)
    }

    /// Is there any hit?
    #[inline]
    pub fn occluded(&self, tree: &Tree, ray: &Ray, meet_other: impl Fn(u32, &Ray) -> Option<Hit>) -> bool {
        let mut unused =
            Hit { t: ray.t_max, b1: 0.0, b2: 0.0, shape: ShapeId(0), primitive: 0, instance: NO_INSTANCE };
        self.walk::<true>(tree, ray, meet_other, &mut unused)
    }

    /// [`walk`], compiled for the instruction set of this processor.
    #[inline(always)]
    fn walk<const ANY: bool>(
        &self,
        tree: &Tree,
        ray: &Ray,
        meet_other: impl Fn(u32, &Ray) -> Option<Hit>,
        closest: &mut Hit,
    ) -> bool {
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
                    closest: &mut Hit,
                ) -> bool {
                    walk::<_, ANY>(avx2, bvh, tree, ray, meet_other, closest)
                }
                // SAFETY: an `Avx2` is the proof that this processor has these features.
                unsafe { walk_avx2::<ANY>(avx2, self, tree, ray, meet_other, closest) }
            }
            Kernel::Portable(Portable) => walk::<_, ANY>(Portable, self, tree, ray, meet_other, closest),
        }
    }
}
