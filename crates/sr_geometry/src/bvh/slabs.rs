//! A ray, made ready to meet the boxes of a node.
//!
//! Slabs are widened by the rounding errors of their own test (Ize 2013) and of the triangles' shear (Woop, Benthin &
//! Wald 2013), so no box is missed whose triangles would be hit.

use glam::Vec3;

use super::sheared::SHEAR_SLACK;
use super::simd::Eight;
use super::{Node, WIDTH};
use crate::Bounds3;

/// How an interval's end grows to cover the four roundings of (bound − origin) · ((1 / direction) · slack).
const FAR_SLACK: f32 = 1.0 + 5.0 * f32::EPSILON;

/// A line among boxes: slabs that a ray is between from (near − `origin_near`) · `inverse` to (far − `origin_far`) ·
/// `inverse_far`.
pub(super) struct Line {
    /// Bit per axis: is the largest coordinate the nearer end of a slab?
    pub negative: u32,
    /// Origins, moved apart by the rounding errors of sheared vertices.
    pub origin_near: [f32; 3],
    pub origin_far: [f32; 3],
    /// 1 / direction, and again for the ends of intervals, a little larger.
    pub inverse: [f32; 3],
    pub inverse_far: [f32; 3],
    pub t_max: f32,
}

impl Line {
    /// Among boxes within `bounds`.
    #[inline(always)]
    pub fn new(origin: Vec3, direction: Vec3, t_max: f32, bounds: &Bounds3) -> Self {
        let reach = larger((origin - bounds.min).abs(), (bounds.max - origin).abs());
        let reach = larger(reach, Vec3::new(reach.y, reach.z, reach.x));
        let error = SHEAR_SLACK * if reach.x > reach.y { reach.x } else { reach.y };
        let inverse = 1.0 / direction;
        let sign = |i: f32| i.to_bits() >> 31;
        let error =
            Vec3::new(error.copysign(inverse.x), error.copysign(inverse.y), error.copysign(inverse.z));
        Self {
            negative: sign(inverse.x) | sign(inverse.y) << 1 | sign(inverse.z) << 2,
            origin_near: (origin + error).to_array(),
            origin_far: (origin - error).to_array(),
            inverse: inverse.to_array(),
            inverse_far: (FAR_SLACK * inverse).to_array(),
            t_max,
        }
    }

    /// What a child's place in the order of a walk, the last of which is the nearest, differs by from its slot in the node:
    /// bits to be flipped. See [`super::slots`].
    #[inline(always)]
    pub fn flip(&self) -> u32 {
        !self.negative & (WIDTH as u32 - 1)
    }
}

/// A ray, ready to meet boxes, an axis after the other.
#[derive(Clone, Copy)]
pub(super) struct Slabs<S: Eight> {
    negative: u32,
    origin_near: [S::F; 3],
    origin_far: [S::F; 3],
    inverse: [S::F; 3],
    inverse_far: [S::F; 3],
    t_max: S::F,
}

impl<S: Eight> Slabs<S> {
    #[inline(always)]
    pub fn new(simd: S, line: &Line) -> Self {
        Self {
            negative: line.negative,
            origin_near: splat(simd, line.origin_near),
            origin_far: splat(simd, line.origin_far),
            inverse: splat(simd, line.inverse),
            inverse_far: splat(simd, line.inverse_far),
            t_max: simd.splat(line.t_max),
        }
    }

    #[inline(always)]
    pub fn shorten(&mut self, simd: S, t_max: f32) {
        self.t_max = simd.splat(t_max);
    }

    /// Where the ray enters and leaves the boxes of a node's children; it meets those that it enters before it leaves.
    #[inline(always)]
    pub fn meet(&self, simd: S, node: &Node) -> [S::F; 2] {
        let [mut enter, mut leave] = [simd.splat(0.0), self.t_max];
        for axis in 0..3 {
            let negative = (self.negative >> axis & 1) as usize;
            let near = simd.load(&node.bounds[axis][negative]);
            let far = simd.load(&node.bounds[axis][1 - negative]);
            let near = simd.sub(near, self.origin_near[axis]);
            let far = simd.sub(far, self.origin_far[axis]);
            // A ray within the plane of a slab gives NaN, which `max` and `min` then ignore.
            enter = simd.max(simd.mul(near, self.inverse[axis]), enter);
            leave = simd.min(simd.mul(far, self.inverse_far[axis]), leave);
        }
        [enter, leave]
    }
}

/// By component; NaN counts as small if it comes first.
#[inline(always)]
fn larger(a: Vec3, b: Vec3) -> Vec3 {
    let larger = |a, b| if a > b { a } else { b };
    Vec3::new(larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z))
}

#[inline(always)]
fn splat<S: Eight>(simd: S, [x, y, z]: [f32; 3]) -> [S::F; 3] {
    [simd.splat(x), simd.splat(y), simd.splat(z)]
}
