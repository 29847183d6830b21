//! Shapes of microfacet distributions, at roughness 1.
//!
//! In: directions, and lengths of slopes. Out: what [`Microfacet`](crate::Microfacet) scales to any roughness. A shape is
//! chosen at run time, [`MicrofacetKind`], or known to compilers, [`Beckmann`], [`Ggx`], [`GgxCorrelated`]: loops that serve many points
//! at a time must not choose in them.

use std::fmt::Debug;

use glam::{Vec2, Vec3};

use crate::{Beckmann, Ggx, GgxCorrelated};

/// The shape of a distribution of microfacet normals.
pub trait MicrofacetShape: Copy + Debug + PartialEq {
    /// Which it is.
    fn kind(self) -> MicrofacetKind;

    /// π αₓ α_y D of a normal m of any length, from the squares of (mₓ/αₓ, m_y/α_y), of m_z and of m.
    fn d(self, slope_squared: f32, cos_squared: f32, length_squared: f32) -> f32;

    /// |cos θ| (1 + Λ), from |cos θ| and the squared length of (αₓ wₓ, α_y w_y).
    fn projected_area(self, cos: f32, spread_squared: f32) -> f32;

    /// cos θₒ cos θᵢ / G(wo, wi), from |cos θ| and σ of both: how masking and shadowing go together. Independent, unless a
    /// shape says otherwise: σ(wo) σ(wi).
    #[inline(always)]
    fn joint_area(self, [_, area_o]: [f32; 2], [_, area_i]: [f32; 2]) -> f32 {
        area_o * area_i
    }

    /// σ(wo) over [`Self::joint_area`].
    #[inline(always)]
    fn shadowing(self, _: [f32; 2], [_, area_i]: [f32; 2]) -> f32 {
        1.0 / area_i
    }

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
    /// The same normals, whose masking and shadowing are correlated by height.
    GgxCorrelated,
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
            Self::Ggx | Self::GgxCorrelated => Ggx.d(slope_squared, cos_squared, length_squared),
        }
    }

    #[inline(always)]
    fn projected_area(self, cos: f32, spread_squared: f32) -> f32 {
        match self {
            Self::Beckmann => Beckmann.projected_area(cos, spread_squared),
            Self::Ggx | Self::GgxCorrelated => Ggx.projected_area(cos, spread_squared),
        }
    }

    #[inline(always)]
    fn joint_area(self, o: [f32; 2], i: [f32; 2]) -> f32 {
        match self {
            Self::GgxCorrelated => GgxCorrelated.joint_area(o, i),
            Self::Beckmann | Self::Ggx => o[1] * i[1],
        }
    }

    #[inline(always)]
    fn shadowing(self, o: [f32; 2], i: [f32; 2]) -> f32 {
        match self {
            Self::GgxCorrelated => GgxCorrelated.shadowing(o, i),
            Self::Beckmann | Self::Ggx => 1.0 / i[1],
        }
    }

    #[inline]
    fn sample_visible(self, w: Vec3, u: Vec2) -> Vec3 {
        match self {
            Self::Beckmann => Beckmann.sample_visible(w, u),
            Self::Ggx | Self::GgxCorrelated => Ggx.sample_visible(w, u),
        }
    }
}
