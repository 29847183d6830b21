//! Sampling a sphere from a point: the cone it fills from outside (Shirley, Wang & Zimmerman 1996), its area from inside.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};
use sr_sampling::warp::{UniformCone, UniformSphere};
use sr_sampling::{Distribution, Sample, to_solid_angle};

use super::Seen;

/// The density of [`sample_cone`], in sr⁻¹; 0 from inside.
pub(super) fn cone_pdf(center: Vec3, radius: f32, from: Vec3) -> f32 {
    let sin2 = radius * radius / (center - from).length_squared();
    UniformCone::from_sin2(sin2).map_or(0.0, |cone| 1.0 / cone.solid_angle())
}

/// A point of the visible cap, if there is one: nothing is seen from inside. Does not branch.
#[inline(always)]
pub(in super::super) fn sample_cone(center: Vec3, radius: f32, from: Vec3, u: Vec2) -> Seen {
    let axis = center - from;
    let distance_squared = axis.length_squared();
    let z = axis / distance_squared.sqrt();
    let (x, y) = z.any_orthonormal_pair();
    let drawn =
        UniformCone::from_sin2(radius * radius / distance_squared).ok().and_then(|cone| cone.sample(u));
    let Sample { value, pdf } = drawn.unwrap_or(Sample { value: Vec3::Z, pdf: 0.0 });
    let wi = (x * value.x + y * value.y + z * value.z).normalize();
    // the nearer intersection, from the closest approach to the centre
    let along = axis.dot(wi);
    let miss_squared = (axis - along * wi).length_squared();
    let half_chord = (radius * radius - miss_squared).max(0.0).sqrt();
    let offset = wi * (along - half_chord) - axis;
    Seen { p: center + offset * (radius / offset.length()), wi, pdf }
}

/// A point of the whole sphere whose inside is seen.
pub(super) fn sample_area(center: Vec3, radius: f32, from: Vec3, u: Vec2) -> Seen {
    let normal = UniformSphere.sample(u).map_or(Vec3::Z, |s| s.value);
    let p = center + radius * normal;
    let to_light = p - from;
    let distance_squared = to_light.length_squared();
    let wi = to_light / distance_squared.sqrt();
    let pdf = to_solid_angle(1.0 / (4.0 * PI * radius * radius), distance_squared, normal.dot(wi));
    Seen { p, wi, pdf: if normal.dot(wi) > 0.0 && pdf.is_finite() { pdf } else { 0.0 } }
}

/// (φ / 2π, θ / π) in the sphere's frame.
pub(super) fn uv(frame: &glam::Mat3, outwards: Vec3) -> Vec2 {
    let local = (frame.transpose() * outwards).normalize_or(Vec3::Z);
    let phi = local.y.atan2(local.x) / std::f32::consts::TAU;
    Vec2::new(if phi < 0.0 { phi + 1.0 } else { phi }, local.z.clamp(-1.0, 1.0).acos() / PI)
}
