//! Axis-aligned boxes.

use glam::{DAffine3, DVec3, Vec3};

/// An axis-aligned box, closed on all sides; empty if `min > max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Bounds3 {
    /// The box without points: the neutral element of [`Bounds3::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest box around this one and a point.
    pub fn with(self, p: Vec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// Does it hold no point?
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The middle; NaN for the empty box.
    pub fn center(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Lengths of the edges; zero for the empty box.
    pub fn extent(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    /// Larger by a few units in the last place of its largest coordinates, to cover rounding in its making.
    pub(crate) fn padded(self) -> Self {
        let slack = 4.0 * f32::EPSILON * self.min.abs().max(self.max.abs());
        Self { min: self.min - slack, max: self.max + slack }
    }

    /// The box around its transformed corners, padded for rounding.
    pub(crate) fn transformed(&self, transform: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let corner = |i: usize| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
            transform.transform_point3(DVec3::new(pick(0).into(), pick(1).into(), pick(2).into())).as_vec3()
        };
        (0..8).fold(Self::EMPTY, |bounds, i| bounds.with(corner(i))).padded()
    }
}
