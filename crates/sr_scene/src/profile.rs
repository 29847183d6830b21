//! Measured luminaires: intensity over directions.

/// Luminous intensity over vertical and horizontal angles: a photometric web of type C.
#[derive(Clone, Debug, PartialEq)]
pub struct IntensityProfile {
    /// What to call it in messages: usually the file's path.
    pub name: String,
    /// Angles from the nadir, in radians, rising within [0, π]. Nothing shines outside of them.
    pub vertical: Vec<f32>,
    /// Angles about the vertical, in radians, rising from 0. The last one says how the rest is to be found: 0, all
    /// around the same; π/2, both halves of each half mirrored; π, the other half mirrored; 2π, all of it is there.
    pub horizontal: Vec<f32>,
    /// In cd; for each horizontal angle, one for each vertical angle.
    pub candelas: Vec<f32>,
}
