//! What a density is a density *of*.
//!
//! A measure is a type, so that a density per area and a density per solid angle cannot be added,
//! compared or mixed by mistake. Changing from one to the other is a visible call: [`to_solid_angle`].

use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, Div, Mul};

use glam::{Vec2, Vec3};

/// The floating-point type in which a measure's densities are expressed.
pub trait Real:
    Copy + Debug + PartialOrd + Add<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Sum + 'static
{
    /// The additive identity.
    const ZERO: Self;
    /// The multiplicative identity.
    const ONE: Self;
    /// Widens (or keeps) the value.
    fn to_f64(self) -> f64;
    /// Rounds (or keeps) the value.
    fn from_f64(x: f64) -> Self;
}

impl Real for f32 {
    const ZERO: f32 = 0.0;
    const ONE: f32 = 1.0;
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    fn from_f64(x: f64) -> f32 {
        x as f32
    }
}

impl Real for f64 {
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;
    fn to_f64(self) -> f64 {
        self
    }
    fn from_f64(x: f64) -> f64 {
        x
    }
}

/// A measure: the kind of point that is sampled, and the number type of its densities.
pub trait Measure: Copy + Debug {
    /// A point of the measured space.
    type Point: Copy + Debug;
    /// The number type of a density with respect to this measure.
    type Real: Real;
}

/// Length on the real line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line;
/// Area in the plane, points being coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane;
/// Solid angle, in steradians; points are unit vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SolidAngle;
/// Surface area in space; points are positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area;
/// The number of elements; densities are probabilities, points are indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counting;
/// Volume in N dimensions, in double precision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lebesgue<const N: usize>;

impl Measure for Line {
    type Point = f32;
    type Real = f32;
}
impl Measure for Plane {
    type Point = Vec2;
    type Real = f32;
}
impl Measure for SolidAngle {
    type Point = Vec3;
    type Real = f32;
}
impl Measure for Area {
    type Point = Vec3;
    type Real = f32;
}
impl Measure for Counting {
    type Point = usize;
    type Real = f32;
}
impl<const N: usize> Measure for Lebesgue<N> {
    type Point = [f64; N];
    type Real = f64;
}

/// Turns a density per area at a point into a density per solid angle, as seen from a distance.
///
/// - `pdf_area`: density at the point, in m⁻²
/// - `distance_squared`: squared distance to the point, in m²
/// - `cos_at_point`: cosine between the surface normal at the point and the direction; its sign is ignored
/// - returns: density in sr⁻¹, infinite where the surface is seen edge-on
///
/// From dω = |cos θ| dA / r².
#[inline]
pub fn to_solid_angle(pdf_area: f32, distance_squared: f32, cos_at_point: f32) -> f32 {
    pdf_area * distance_squared / cos_at_point.abs()
}
