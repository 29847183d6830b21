//! Shapes of microfacet distributions, at roughness 1.
//!
//! In: directions, and lengths of slopes. Out: what [`Microfacet`](crate::Microfacet) scales to any roughness. A shape is
//! chosen at run time, [`MicrofacetKind`], or known to compilers, [`Beckmann`] and [`Ggx`]: loops that serve many points
//! at a time must not choose in them.

use std::fmt::Debug;

use glam::{Vec2, Vec3};

use crate::{Beckmann, Ggx};

/// The shape of a distribution of microfacet normals.
pub trait MicrofacetShape: Copy + Debug + PartialEq {
    /// Which it is.
    fn kind(self) -> MicrofacetKind;

    /// π αₓ α_y D of a normal m of any length, from the squares of (mₓ/αₓ, m_y/α_y), of m_z and of m.
    fn d(self, slope_squared: f32, cos_squared: f32, length_squared: f32) -> f32;

    /// |cos θ| (1 + Λ), from |cos θ| and the squared length of (αₓ wₓ, α_y w_y).
    fn projected_area(self, cos: f32, spread_squared: f32) -> f32;

    /// Draws a normal (not of unit length) of those that the unit vector `w` sees, w.z > 0.
    fn sample_visible(self, w: Vec3, u: Vec2) -> Vec3;
}

/// A shape that is chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MicrofacetKind {
    /// Beckmann: Gaussian slopes.
    Beckmann,
    /// GGX, also called Trowbridge–Reitz: longer tails.
    Ggx,
}

impl MicrofacetShape for MicrofacetKind {
    #[inline]
    fn kind(self) -> MicrofacetKind {
        self
    }

    #[inline(always)]
    fn d(self, slope_squared: f32, cos_squared: f32, length_squared: f32) -> f32 {
        match self {
            Self::Beckmann => Beckmann.d(slope_squared, cos_squared, length_squared),
            Self::Ggx => Ggx.d(slope_squared, cos_squared, length_squared),
        }
    }

    #[inline(always)]
    fn projected_area(self, cos: f32, spread_squared: f32) -> f32 {
        match self {
            Self::Beckmann => Beckmann.projected_area(cos, spread_squared),
            Self::Ggx => Ggx.projected_area(cos, spread_squared),
        }
    }

    #[inline]
    fn sample_visible(self, w: Vec3, u: Vec2) -> Vec3 {
        match self {
            Self::Beckmann => Beckmann.sample_visible(w, u),
            Self::Ggx => Ggx.sample_visible(w, u),
        }
    }
}
