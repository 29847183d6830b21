//! A ray, made ready to meet the boxes of a node.
//!
//! Slabs are widened by the rounding errors of their own test (Ize 2013) and of the triangles' shear (Woop, Benthin &
//! Wald 2013), so no box is missed whose triangles would be hit.

use glam::Vec3A;

use super::Node;
use super::sheared::SHEAR_SLACK;
use super::simd::Simd;
use crate::{Bounds3, Ray};

/// How an interval's end grows to cover the three roundings of (bound − origin) · (1 / direction).
const FAR_SLACK: f32 = 1.0 + 4.0 * f32::EPSILON;

/// A ray, ready to meet boxes.
#[derive(Clone, Copy)]
pub(super) struct Slabs<S: Simd> {
    /// Per axis: the row of [`Node::bounds`] with the nearer ends of the slabs. The farther ones are in row `^ 1`.
    near: [usize; 3],
    /// Origins, moved apart by the rounding errors of sheared vertices.
    origin_near: [S::F; 3],
    origin_far: [S::F; 3],
    inverse: [S::F; 3],
}

impl<S: Simd> Slabs<S> {
    /// For boxes within `bounds`.
    #[inline(always)]
    pub fn new(simd: S, ray: &Ray, bounds: &Bounds3) -> Self {
        let origin = Vec3A::from(ray.origin);
        let (min, max) = (Vec3A::from(bounds.min), Vec3A::from(bounds.max));
        let reach = (origin - min).abs().max((max - origin).abs()).max_element();
        let inverse = Vec3A::from(ray.direction).recip();
        let negative = inverse.is_negative_bitmask() as usize;
        let error = Vec3A::splat(SHEAR_SLACK * reach).copysign(inverse);
        Self {
            near: [negative & 1, 2 + (negative >> 1 & 1), 4 + (negative >> 2 & 1)],
            origin_near: splat(simd, origin + error),
            origin_far: splat(simd, origin - error),
            inverse: splat(simd, inverse),
        }
    }

    /// The children of a node that the ray meets before `t_max`, ordered by where it enters them.
    #[inline(always)]
    pub fn meet(&self, simd: S, node: &Node, t_max: S::F) -> S::Keys {
        let [mut enter, mut leave] = [simd.splat(0.0), simd.splat(f32::INFINITY)];
        for axis in 0..3 {
            let row = self.near[axis];
            // SAFETY: `new` makes rows from 0 to 5.
            let (near, far) = unsafe { (node.bounds.get_unchecked(row), node.bounds.get_unchecked(row ^ 1)) };
            let near = simd.sub(simd.load(near), self.origin_near[axis]);
            let far = simd.sub(simd.load(far), self.origin_far[axis]);
            // A ray within the plane of a slab gives NaN, which `max` and `min` then ignore.
            enter = simd.max(simd.mul(near, self.inverse[axis]), enter);
            leave = simd.min(simd.mul(far, self.inverse[axis]), leave);
        }
        simd.keys(enter, simd.min(simd.mul(leave, simd.splat(FAR_SLACK)), t_max))
    }
}

#[inline(always)]
fn splat<S: Simd>(simd: S, v: Vec3A) -> [S::F; 3] {
    [simd.splat(v.x), simd.splat(v.y), simd.splat(v.z)]
}
