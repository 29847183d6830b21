//! The GGX (Trowbridge–Reitz) distribution at roughness 1 (Walter et al. 2007), with two kinds of masking and shadowing.

use glam::{Vec2, Vec3};
use sr_sampling::warp::unit_circle;

use crate::{MicrofacetKind, MicrofacetShape};

/// [`MicrofacetKind::Ggx`], known to compilers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ggx;

impl MicrofacetShape for Ggx {
    #[inline]
    fn kind(self) -> MicrofacetKind {
        MicrofacetKind::Ggx
    }

    #[inline(always)]
    fn d(self, slope_squared: f32, cos_squared: f32, length_squared: f32) -> f32 {
        // A normal without a length, between opposite directions, is nowhere.
        let ratio = length_squared / (slope_squared + cos_squared).max(f32::MIN_POSITIVE);
        ratio * ratio
    }

    #[inline(always)]
    fn projected_area(self, cos: f32, spread_squared: f32) -> f32 {
        0.5 * (cos + (cos * cos + spread_squared).sqrt())
    }

    /// The normals are halfway between `w` and a uniform point of the spherical cap that a hemisphere
    /// of mirrors reflects `w` into (Dupuy & Benyoub 2023).
    #[inline(always)]
    fn sample_visible(self, w: Vec3, u: Vec2) -> Vec3 {
        let height = (1.0 - u.y) * (1.0 + w.z); // z of the sum: nothing cancels
        let z = height - w.z;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let at = r * unit_circle(u.x);
        Vec3::new(w.x + at.x, w.y + at.y, height)
    }
}

/// [`MicrofacetKind::GgxCorrelated`], known to compilers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GgxCorrelated;

/// G = 1 / (1 + Λ(wo) + Λ(wi)): what is deep in the surface is both masked and shadowed (Heitz 2014, "Understanding the
/// Masking-Shadowing Function", eq. 99). pbrt-v4 takes it for light that passes as well, and so it is done here.
impl MicrofacetShape for GgxCorrelated {
    #[inline]
    fn kind(self) -> MicrofacetKind {
        MicrofacetKind::GgxCorrelated
    }

    #[inline(always)]
    fn d(self, slope_squared: f32, cos_squared: f32, length_squared: f32) -> f32 {
        Ggx.d(slope_squared, cos_squared, length_squared)
    }

    #[inline(always)]
    fn projected_area(self, cos: f32, spread_squared: f32) -> f32 {
        Ggx.projected_area(cos, spread_squared)
    }

    /// cos θₒ cos θᵢ (1 + Λₒ + Λᵢ), written with σ = cos θ (1 + Λ).
    #[inline(always)]
    fn joint_area(self, [cos_o, area_o]: [f32; 2], [cos_i, area_i]: [f32; 2]) -> f32 {
        // σ is no less than cos θ but for rounding; with both at 0, the product is at least not 0.
        let sum = area_o * cos_i + (area_i - cos_i).max(0.0) * cos_o;
        sum.max(f32::MIN_POSITIVE)
    }

    #[inline(always)]
    fn shadowing(self, o: [f32; 2], i: [f32; 2]) -> f32 {
        o[1] / self.joint_area(o, i)
    }

    #[inline(always)]
    fn sample_visible(self, w: Vec3, u: Vec2) -> Vec3 {
        Ggx.sample_visible(w, u)
    }
}
