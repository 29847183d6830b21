//! Rays and what they hit.

use glam::Vec3;

/// Index of a shape: the world's shapes in the order of the input, then each group's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ShapeId(pub u32);

/// [`Hit::instance`] of a shape that lies in world space.
pub const NO_INSTANCE: u32 = u32::MAX;

/// The points `origin + t direction` for t in (0, `t_max`).
///
/// A ray with a NaN, an infinity or a zero direction hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes; of any length, which is the unit of t.
    pub direction: Vec3,
    /// Where it ends, exclusive; may be infinite.
    pub t_max: f32,
}

impl Ray {
    /// A ray without an end.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_max: f32::INFINITY }
    }

    /// The point at t.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// Where a ray meets a primitive. [`crate::Geometry::surface`] turns it into positions and normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter, in units of the direction's length.
    pub t: f32,
    /// Triangles: barycentric coordinate of vertex 1. Disks: coordinate along `u_axis`. Patches: u. Curves: place along
    /// the segment. Others: 0.
    pub b1: f32,
    /// Triangles: barycentric coordinate of vertex 2. Disks: coordinate along `v_axis`. Patches: v. Others: 0.
    pub b2: f32,
    /// The shape that was hit.
    pub shape: ShapeId,
    /// The triangle within its mesh, the segment of curves; 0 for other shapes.
    pub primitive: u32,
    /// The instance through which it was hit, or [`NO_INSTANCE`].
    pub instance: u32,
}

impl Hit {
    /// Stands for the closest hit before there is any: nothing, at `t`.
    #[inline(always)]
    pub(crate) fn none_before(t: f32) -> Self {
        Self { t, b1: 0.0, b2: 0.0, shape: ShapeId(0), primitive: 0, instance: NO_INSTANCE }
    }
}
