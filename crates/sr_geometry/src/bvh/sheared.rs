//! A ray, made ready to meet many triangles at once.
//!
//! Woop, Benthin & Wald 2013, "Watertight ray/triangle intersection": vertices are moved to the ray's origin and
//! sheared so that the ray becomes the +Z axis; a vertex lands on the same point for every triangle that shares it,
//! and the sign of an edge function is never wrong, so no ray slips between neighbours.

use glam::Vec3;

use super::leaves::Leaf;
use super::simd::{Eight, Lanes};
use crate::Ray;

/// Rounding error of a sheared vertex, per unit of its distance from the ray's origin (largest component).
pub(super) const SHEAR_SLACK: f32 = 5.0 * f32::EPSILON;

/// Hits nearer than this part of what the triangle spans along the ray are looked at twice. Errors are larger only for
/// triangles that are seen several thousand times longer than wide.
const NEAR: f32 = 1.0 / 256.0;

/// Triangles, transposed.
pub(super) trait Triangles<L: Lanes> {
    /// One coordinate of one vertex of all triangles.
    ///
    /// # Safety
    /// `vertex` and `axis` are below 3.
    unsafe fn coordinate(&self, lanes: L, vertex: usize, axis: usize) -> L::F;

    /// One of the triangles.
    fn vertices(&self, lane: usize) -> [Vec3; 3];
}

/// A ray, ready to meet triangles.
#[derive(Clone, Copy)]
pub(super) struct Sheared {
    /// The axis along which the direction is longest.
    pub longest: u32,
    /// Origin: along the two axes after the longest, in turn, and last along that.
    pub origin: [f32; 3],
    /// What z is multiplied by: shears of the first two axes, and the scale of the last.
    pub shear: [f32; 3],
    /// [`NEAR`] times the scale, which is positive here.
    pub near: f32,
}

/// Triangles as a ray sees them.
pub(super) struct Projected<L: Lanes> {
    /// Which triangles the line of the ray passes through.
    pub inside: L::Mask,
    /// Twice the signed areas of the triangles that the ray makes with the edges opposite to the vertices.
    pub areas: [L::F; 3],
    /// Unscaled distances of the vertices along the ray.
    pub z: [L::F; 3],
}

/// Where a ray meets triangles.
pub(super) struct Meets<L: Lanes> {
    /// Which are met.
    pub hit: L::Mask,
    /// Ray parameters.
    pub t: L::F,
    /// Barycentric coordinates of vertices 1 and 2.
    pub b: [L::F; 2],
}

impl Sheared {
    /// A ray that is not finite or has no direction becomes one that meets nothing: its shears or its scale are not
    /// numbers, or its scale is 0.
    #[inline(always)]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        let [x, y, _] = longest(direction);
        let turned = |v: Vec3| {
            let pick = |of_x, of_y, of_z| {
                if x {
                    of_x
                } else if y {
                    of_y
                } else {
                    of_z
                }
            };
            [pick(v.y, v.z, v.x), pick(v.z, v.x, v.y), pick(v.x, v.y, v.z)]
        };
        let along = turned(direction);
        let scale = 1.0 / along[2];
        Self {
            longest: if x {
                0
            } else if y {
                1
            } else {
                2
            },
            origin: turned(origin),
            shear: [along[0] * scale, along[1] * scale, scale],
            near: NEAR * scale.abs(),
        }
    }

    /// The axes in the order of `origin`.
    #[inline(always)]
    pub fn axes(&self) -> [usize; 3] {
        const AXES: [[usize; 3]; 4] = [[1, 2, 0], [2, 0, 1], [0, 1, 2], [0, 1, 2]];
        AXES[self.longest as usize % 4]
    }

    /// Triangles as the ray sees them.
    #[inline(always)]
    pub fn project<L: Lanes>(&self, lanes: L, triangles: &impl Triangles<L>) -> Projected<L> {
        let a = self.sheared(lanes, triangles, 0);
        let b = self.sheared(lanes, triangles, 1);
        let c = self.sheared(lanes, triangles, 2);
        let areas @ [of_a, of_b, of_c] = [edge(lanes, c, b), edge(lanes, a, c), edge(lanes, b, a)];
        let zero = lanes.splat(0.0);
        let least = lanes.min(lanes.min(of_a, of_b), of_c);
        let most = lanes.max(lanes.max(of_a, of_b), of_c);
        let inside = lanes.or(lanes.le(zero, least), lanes.le(most, zero));
        Projected { inside, areas, z: [a[2], b[2], c[2]] }
    }

    /// The triangles of a leaf as the ray sees them.
    #[inline(always)]
    pub fn project_leaf<S: Eight>(&self, simd: S, leaf: &Leaf<'_>) -> Projected<S> {
        let seen = self.project(simd, leaf);
        Projected { inside: simd.and(seen.inside, simd.mask((1 << leaf.count) - 1)), ..seen }
    }

    /// Which triangles the ray meets in (0, `t_max`), as far as rounding lets one tell: near the vertices' plane t can
    /// be wrong by more than its value, and a sliver that the ray leaves be met.
    #[inline(always)]
    pub fn meet_roughly<L: Lanes>(&self, lanes: L, seen: &Projected<L>, t_max: L::F) -> Meets<L> {
        let [of_a, of_b, of_c] = seen.areas;
        // An edge-on triangle has a zero determinant, hence t = NaN, which fails both comparisons.
        let inv_det = lanes.div(lanes.splat(1.0), lanes.add(lanes.add(of_a, of_b), of_c));
        let [b0, b1, b2] = [lanes.mul(of_a, inv_det), lanes.mul(of_b, inv_det), lanes.mul(of_c, inv_det)];
        let z = lanes.add(lanes.mul(b0, seen.z[0]), lanes.mul(b1, seen.z[1]));
        let z = lanes.add(z, lanes.mul(b2, seen.z[2]));
        let t = lanes.mul(z, lanes.splat(self.shear[2]));
        let within = lanes.and(lanes.lt(lanes.splat(0.0), t), lanes.lt(t, t_max));
        Meets { hit: lanes.and(seen.inside, within), t, b: [b1, b2] }
    }

    /// Which triangles the ray, which is seldom asked for again, meets in (0, `t_max`).
    #[inline(always)]
    pub fn meet<L: Lanes>(
        &self,
        lanes: L,
        triangles: &impl Triangles<L>,
        seen: &Projected<L>,
        t_max: L::F,
        ray: impl Fn() -> Ray,
    ) -> Meets<L> {
        let meets = self.meet_roughly(lanes, seen, t_max);
        let first = lanes.min(lanes.min(seen.z[0], seen.z[1]), seen.z[2]);
        let last = lanes.max(lanes.max(seen.z[0], seen.z[1]), seen.z[2]);
        let near = lanes.mul(lanes.sub(last, first), lanes.splat(self.near));
        let mut doubtful = lanes.bits(lanes.and(meets.hit, lanes.lt(meets.t, near)));
        if doubtful == 0 {
            return meets;
        }
        let mut hit = lanes.bits(meets.hit);
        while doubtful != 0 {
            let lane = doubtful.trailing_zeros();
            if !is_ahead(&ray(), triangles.vertices(lane as usize % L::COUNT)) {
                hit &= !(1 << lane);
            }
            doubtful &= doubtful - 1;
        }
        Meets { hit: lanes.mask(hit), ..meets }
    }

    /// Nothing that is met at this t or beyond, of triangles that together span `extent`, needs a second look.
    #[inline(always)]
    pub fn beyond_doubt(&self, extent: f32) -> f32 {
        self.near * extent
    }

    /// A vertex relative to the ray: sheared x and y, and unscaled z.
    #[inline(always)]
    fn sheared<L: Lanes>(&self, lanes: L, triangles: &impl Triangles<L>, vertex: usize) -> [L::F; 3] {
        let [x, y, z] = self.axes();
        // SAFETY: `axes` makes a permutation of 0, 1, 2.
        let [x, y, z] = unsafe {
            [
                triangles.coordinate(lanes, vertex, x),
                triangles.coordinate(lanes, vertex, y),
                triangles.coordinate(lanes, vertex, z),
            ]
        };
        let x = lanes.sub(x, lanes.splat(self.origin[0]));
        let y = lanes.sub(y, lanes.splat(self.origin[1]));
        let z = lanes.sub(z, lanes.splat(self.origin[2]));
        let [shear_x, shear_y] = [lanes.splat(self.shear[0]), lanes.splat(self.shear[1])];
        [lanes.sub(x, lanes.mul(shear_x, z)), lanes.sub(y, lanes.mul(shear_y, z)), z]
    }
}

/// Along which axis a direction is longest, of axes that are equally long the first.
#[inline(always)]
pub(super) fn longest(direction: Vec3) -> [bool; 3] {
    let length = direction.abs();
    let x = length.x >= length.y && length.x >= length.z;
    let y = !x && length.y >= length.z;
    [x, y, !x && !y]
}

/// Does the ray meet the plane of a triangle ahead of its origin? In `f64`, where the sign of t is right also for a
/// sliver. Hits are only ever taken away by this: one that is ahead by less than the error of t may be lost.
#[cold]
#[inline(never)]
fn is_ahead(ray: &Ray, [a, b, c]: [Vec3; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(|v| v.as_dvec3());
    let normal = (b - a).cross(c - a);
    let (height, descent) = (normal.dot(a - ray.origin.as_dvec3()), normal.dot(ray.direction.as_dvec3()));
    height * descent > 0.0
}

/// Twice the signed area between the ray and the projected edge from `q` to `p`.
#[inline(always)]
fn edge<L: Lanes>(lanes: L, p: [L::F; 3], q: [L::F; 3]) -> L::F {
    lanes.sub(lanes.mul(p[0], q[1]), lanes.mul(p[1], q[0]))
}
