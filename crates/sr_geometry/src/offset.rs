//! Leaving a surface without hitting it again: bounds of rounding errors instead of a global epsilon.

use glam::Vec3;

/// Half of [`f32::EPSILON`]: the largest relative error of one rounding.
pub(crate) const ROUNDING: f32 = 0.5 * f32::EPSILON;

/// How far a ray's origin is moved along the normal to leave a surface.
///
/// - `p`, `p_error`: a point that was computed on the surface, and a bound of its error on each axis
/// - `ng`: unit normal, of either side
/// - returns: a distance by which `p` is moved so far that the surface, which passes through the box `p` ± `p_error`,
///   is behind it, also after rounding
///
/// Pharr, Jakob & Humphreys, Physically Based Rendering, 4th edition, §6.8.6, with the rounding of the moved point
/// counted into the distance.
#[inline]
pub(crate) fn clearance(p: Vec3, p_error: Vec3, ng: Vec3) -> f32 {
    ng.abs().dot(p_error + (2.0 * ROUNDING) * p.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_at_least_the_error() {
        let (p, error, ng) = (Vec3::new(1e3, -2.0, 0.5), Vec3::splat(1e-4), Vec3::new(0.6, 0.0, 0.8));
        assert!(clearance(p, error, ng) >= 1.4e-4);
        assert_eq!(clearance(p, error, ng), clearance(p, error, -ng));
    }

    #[test]
    fn without_an_error_is_the_rounding_of_the_result() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        let moved = p.z + clearance(p, Vec3::ZERO, Vec3::Z);
        assert!(moved > p.z && moved < p.z + 1e-6, "{moved}");
    }
}
