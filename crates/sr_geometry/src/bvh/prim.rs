//! What the builder sees of primitives, and boxes in the form in which it computes with them.

use glam::{Vec4, Vec4Swizzles};

use crate::Bounds3;

/// A primitive: a box and an identity, in two registers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PrimRef {
    /// Smallest coordinates, and the bits of the shape.
    low: Vec4,
    /// Largest coordinates, and the bits of the primitive.
    high: Vec4,
}

impl PrimRef {
    /// `shape` of everything that is not a triangle.
    pub const OTHER: u32 = u32::MAX;

    /// - `shape`: the triangle's, or [`PrimRef::OTHER`]
    /// - `primitive`: the triangle within its mesh, or what an other leaf refers to
    #[inline(always)]
    pub fn new(bounds: Bounds3, shape: u32, primitive: u32) -> Self {
        let with = |corner: glam::Vec3, id| corner.extend(f32::from_bits(id));
        Self { low: with(bounds.min, shape), high: with(bounds.max, primitive) }
    }

    #[inline(always)]
    pub(super) fn shape(&self) -> u32 {
        self.low.w.to_bits()
    }

    #[inline(always)]
    pub(super) fn primitive(&self) -> u32 {
        self.high.w.to_bits()
    }

    #[inline(always)]
    pub(super) fn is_triangle(&self) -> bool {
        self.shape() != Self::OTHER
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        self.lanes().bounds()
    }

    /// The box in registers. Identities must not get into arithmetic: as numbers they are denormal, which is slow.
    #[inline(always)]
    pub(super) fn lanes(&self) -> Lanes {
        Lanes { min: self.low.xyzz(), max: self.high.xyzz() }
    }

    /// One coordinate of the middle of the box: that of [`Lanes::center`].
    #[inline(always)]
    pub(super) fn center(&self, axis: usize) -> f32 {
        0.5 * self.low[axis] + 0.5 * self.high[axis]
    }
}

/// A box in two registers. The fourth lanes repeat the third.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lanes {
    pub min: Vec4,
    pub max: Vec4,
}

impl Lanes {
    pub const EMPTY: Self = Self { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    #[inline(always)]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    #[inline(always)]
    pub fn with(self, point: Vec4) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    #[inline(always)]
    pub fn center(self) -> Vec4 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Lengths of the edges; zero for the empty box.
    #[inline(always)]
    pub fn extent(self) -> Vec4 {
        (self.max - self.min).max(Vec4::ZERO)
    }

    /// Half the surface area: what the surface area heuristic compares.
    #[inline(always)]
    pub fn half_area(self) -> f32 {
        let e = self.extent();
        let products = e * e.yzxx();
        products.x + products.y + products.z
    }

    pub fn bounds(self) -> Bounds3 {
        Bounds3 { min: self.min.xyz(), max: self.max.xyz() }
    }
}
