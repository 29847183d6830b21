//! A ray, made ready to meet the boxes of a node.
//!
//! Slabs are widened by the rounding errors of their own test (Ize 2013) and of the triangles' shear (Woop, Benthin &
//! Wald 2013), so no box is missed whose triangles would be hit. The shear moves vertices across the ray's longest axis, not
//! along it: slabs across that axis are as they are, and a ray that leaves a wall does not come back to it.

use glam::Vec3;

use super::sheared::{SHEAR_SLACK, longest};
use super::simd::Lanes;
use super::slots::flips;
use super::{Node, WIDE};
use crate::Bounds3;

/// How an interval's end grows to cover the four roundings of (bound − origin) · ((1 / direction) · slack).
const FAR_SLACK: f32 = 1.0 + 5.0 * f32::EPSILON;

/// Bytes of a row of [`Node::bounds`].
const ROW: u32 = size_of::<[f32; WIDE]>() as u32;

/// A line among boxes: slabs that a ray is between from (near − `origin_near`) · `inverse` to (far − `origin_far`) ·
/// `inverse_far`.
#[derive(Clone, Copy)]
pub(super) struct Line {
    /// What a child's place in the order of a walk, the last of which is the nearest, differs by from its slot in the node:
    /// bits to be flipped, four for each axis that a node's slots may have. See [`super::slots`].
    pub flips: u32,
    /// Per axis, where the nearer ends of slabs are in [`Node::bounds`]: 0 or [`ROW`].
    pub near: [u32; 3],
    /// Origins, moved apart by the rounding errors of sheared vertices.
    pub origin_near: [f32; 3],
    pub origin_far: [f32; 3],
    /// 1 / direction, and again for the ends of intervals, a little larger.
    pub inverse: [f32; 3],
    pub inverse_far: [f32; 3],
}

impl Line {
    /// Among boxes within `bounds`.
    #[inline(always)]
    pub fn new(origin: Vec3, direction: Vec3, bounds: &Bounds3) -> Self {
        let reach = larger((origin - bounds.min).abs(), (bounds.max - origin).abs());
        let reach = larger(reach, Vec3::new(reach.y, reach.z, reach.x));
        let error = SHEAR_SLACK * if reach.x > reach.y { reach.x } else { reach.y };
        let inverse = 1.0 / direction;
        let sign = |i: f32| i.to_bits() >> 31;
        let [x, y, z] = longest(direction).map(|is_longest| if is_longest { 0.0 } else { error });
        let error = Vec3::new(x.copysign(inverse.x), y.copysign(inverse.y), z.copysign(inverse.z));
        Self {
            flips: flips([sign(inverse.x), sign(inverse.y), sign(inverse.z)]),
            near: [ROW * sign(inverse.x), ROW * sign(inverse.y), ROW * sign(inverse.z)],
            origin_near: (origin + error).to_array(),
            origin_far: (origin - error).to_array(),
            inverse: inverse.to_array(),
            inverse_far: (FAR_SLACK * inverse).to_array(),
        }
    }

    /// The bits to be flipped in the slots of a node, given their axis.
    #[inline(always)]
    pub fn flip(&self, axis: u32) -> u32 {
        self.flips >> (4 * axis) & (WIDE as u32 - 1)
    }

    /// Where the ray enters and leaves the boxes of a node's children, by part of as many as there are lanes; it meets those
    /// that it enters before it leaves.
    #[inline(always)]
    pub fn meet<S: Lanes, const PARTS: usize>(&self, simd: S, node: &Node, t_max: f32) -> [[S::F; 2]; PARTS] {
        const { assert!(PARTS * S::COUNT == WIDE) };
        let mut parts = [[simd.splat(0.0), simd.splat(t_max)]; PARTS];
        for axis in 0..3 {
            let rows = std::ptr::from_ref(&node.bounds[axis]).cast::<u8>();
            let row = self.near[axis] & ROW;
            // SAFETY: the first and the second of two rows, in either order.
            let [near, far] =
                unsafe { [&*rows.add(row as usize).cast(), &*rows.add((row ^ ROW) as usize).cast()] };
            let origin = [simd.splat(self.origin_near[axis]), simd.splat(self.origin_far[axis])];
            let inverse = [simd.splat(self.inverse[axis]), simd.splat(self.inverse_far[axis])];
            for (part, [enter, leave]) in parts.iter_mut().enumerate() {
                let near = simd.sub(simd.load_part(near, part), origin[0]);
                let far = simd.sub(simd.load_part(far, part), origin[1]);
                // A ray within the plane of a slab gives NaN, which `max` and `min` then ignore.
                *enter = simd.max(simd.mul(near, inverse[0]), *enter);
                *leave = simd.min(simd.mul(far, inverse[1]), *leave);
            }
        }
        parts
    }
}

/// By component; NaN counts as small if it comes first.
#[inline(always)]
fn larger(a: Vec3, b: Vec3) -> Vec3 {
    let larger = |a, b| if a > b { a } else { b };
    Vec3::new(larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z))
}
