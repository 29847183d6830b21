//! The GGX (Trowbridge–Reitz) distribution at roughness 1 (Walter et al. 2007).

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

/// π αₓ α_y D, from the squared length of (mₓ/αₓ, m_y/α_y) and m_z.
#[inline]
pub(crate) fn d(slope_squared: f32, cos: f32) -> f32 {
    let q = slope_squared + cos * cos;
    1.0 / (q * q)
}

/// |cos θ| (1 + Λ), from |cos θ| and the length of (αₓ wₓ, α_y w_y).
#[inline]
pub(crate) fn projected_area(cos: f32, spread: f32) -> f32 {
    0.5 * (cos + (cos * cos + spread * spread).sqrt())
}

/// Draws a normal (not of unit length) of those that the unit vector `w` sees.
///
/// The normals are halfway between `w` and a uniform point of the spherical cap that a hemisphere
/// of mirrors reflects `w` into (Dupuy & Benyoub 2023).
#[inline]
pub(crate) fn sample_visible(w: Vec3, u: Vec2) -> Vec3 {
    let (sin_phi, cos_phi) = (TAU * u.x).sin_cos();
    let height = (1.0 - u.y) * (1.0 + w.z); // z of the sum: nothing cancels
    let z = height - w.z;
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(w.x + r * cos_phi, w.y + r * sin_phi, height)
}
