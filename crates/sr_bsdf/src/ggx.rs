//! The GGX (Trowbridge–Reitz) distribution at roughness 1 (Walter et al. 2007).

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
