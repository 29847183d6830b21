//! Cameras placed by what they look at.

use glam::{DAffine3, DMat4, DVec3};

/// The view is along +Z, +X is to the left; an `up` along the view (or none) is replaced.
pub fn look_at(origin: DVec3, target: DVec3, up: DVec3) -> Result<DMat4, String> {
    let forward =
        (target - origin).try_normalize().ok_or("the origin and the target of a lookat coincide")?;
    let left = up.cross(forward).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
    let up = forward.cross(left);
    let columns = glam::DMat3::from_cols(left, up, forward);
    Ok(DAffine3::from_mat3_translation(columns, origin).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Figures printed by Mitsuba 3.9.1 for the same `lookat`.
    #[test]
    fn look_at_agrees_with_mitsuba() {
        let m = look_at(DVec3::new(1., 2., 3.), DVec3::new(4., 5., 7.), DVec3::Y).unwrap();
        let expected =
            [0.8, 0.0, -0.6, 0.0, -0.308697, 0.857493, -0.411597, 0.0, 0.514496, 0.514496, 0.685994, 0.0];
        for (got, want) in m.to_cols_array().iter().zip(expected) {
            assert!((got - want).abs() < 1e-6, "{m}");
        }
        assert_eq!(m.w_axis.truncate(), DVec3::new(1., 2., 3.));
    }
}
