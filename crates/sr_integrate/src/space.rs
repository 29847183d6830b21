//! What a density that is chosen at run time is a density *of*.

use std::fmt;

/// A measure, and with it the coordinates of a point: [`sr_sampling::Measure`] at run time.
///
/// Densities of different spaces are never mixed, multiplied or compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Space {
    /// Length on the real line.
    Line,
    /// Area in the plane.
    Plane,
    /// Volume in so many dimensions; neither 1 nor 2, which are the line and the plane.
    Volume(usize),
    /// Solid angle, in steradians; points are unit vectors.
    SolidAngle,
    /// Area of a surface in space; points are positions.
    Area,
    /// The number of elements; points are indices, densities are probabilities.
    Counting,
}

impl Space {
    /// The space of `dim` real coordinates.
    pub fn real(dim: usize) -> Self {
        match dim {
            1 => Self::Line,
            2 => Self::Plane,
            dim => Self::Volume(dim),
        }
    }

    /// The number of coordinates of a point.
    pub fn dim(self) -> usize {
        match self {
            Self::Line | Self::Counting => 1,
            Self::Plane => 2,
            Self::Volume(dim) => dim,
            Self::SolidAngle | Self::Area => 3,
        }
    }

    /// Is every coordinate a length of its own, so that the density is one per volume of them?
    pub fn is_real(self) -> bool {
        matches!(self, Self::Line | Self::Plane | Self::Volume(_))
    }
}

impl fmt::Display for Space {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line => write!(f, "length"),
            Self::Plane => write!(f, "area in the plane"),
            Self::Volume(dim) => write!(f, "volume in {dim} dimensions"),
            Self::SolidAngle => write!(f, "solid angle"),
            Self::Area => write!(f, "surface area"),
            Self::Counting => write!(f, "counting"),
        }
    }
}
