//! Leaving a surface without hitting it again: bounds of rounding errors instead of a global epsilon.

use glam::Vec3;

/// Half of [`f32::EPSILON`]: the largest relative error of one rounding.
pub(crate) const ROUNDING: f32 = 0.5 * f32::EPSILON;

/// Moves a ray's origin off the surface, to the side that `direction` points to.
///
/// - `p`, `p_error`: a point that was computed on the surface, and a bound of its error on each axis
/// - `ng`: unit normal, of either side
/// - returns: `p` moved along `ng` so far that the surface, which passes through the box `p` ± `p_error`, is
///   behind it, also after rounding
///
/// Pharr, Jakob & Humphreys, Physically Based Rendering, 4th edition, §6.8.6, with the rounding of the moved point
/// counted into the distance.
#[inline]
pub fn offset_ray_origin(p: Vec3, p_error: Vec3, ng: Vec3, direction: Vec3) -> Vec3 {
    let distance = ng.abs().dot(p_error + (2.0 * ROUNDING) * p.abs());
    p + ng * distance.copysign(direction.dot(ng))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moves_to_the_side_of_the_direction_by_at_least_the_error() {
        let (p, error, ng) = (Vec3::new(1e3, -2.0, 0.5), Vec3::splat(1e-4), Vec3::new(0.6, 0.0, 0.8));
        let above = offset_ray_origin(p, error, ng, Vec3::new(0.0, 1.0, 0.1));
        let below = offset_ray_origin(p, error, ng, -ng);
        assert!((above - p).dot(ng) >= 1.4e-4 && (below - p).dot(ng) <= -1.4e-4, "{above} {below}");
        assert_eq!(above.y, p.y);
    }

    #[test]
    fn without_an_error_moves_by_the_rounding_of_the_result() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        let moved = offset_ray_origin(p, Vec3::ZERO, Vec3::Z, Vec3::Z);
        assert!(moved.z > p.z && moved.z < p.z + 1e-6, "{moved}");
    }
}
