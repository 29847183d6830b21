//! Sampling the side of a cylinder from a point: by the angle in its cross-section, and uniformly along its axis.
//!
//! In the plane across the axis the cylinder is a circle, and a point sees it under an angle α. A direction that is
//! uniform in α and in the place along the axis has density |p|³ / (α L r²) per solid angle, for a point p of the
//! light at distance r in that plane: without the infinity that areas have at the outline, and nothing is drawn that
//! faces away.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use sr_geometry::Cylinder;

use super::area::Seen;

/// The angle, in radians, under which a point at `distance` from the axis sees the shining side; 0 if it does not.
fn angle(c: &Cylinder, distance: f32) -> f32 {
    match distance > c.radius {
        true => 2.0 * (c.radius / distance).asin(),
        false if c.flip_normals => TAU,
        false => 0.0,
    }
}

/// A point of the shining side, and its texture coordinates. Of density 0 if nothing is seen.
pub(super) fn sample(c: &Cylinder, from: Vec3, u: Vec2) -> (Seen, Vec2) {
    let at = (c.frame.transpose() * (from - c.base)).truncate();
    let (distance, to_axis) = (at.length(), (-at).normalize_or(Vec2::X));
    let angle = angle(c, distance);
    let w = Vec2::from_angle((u.x - 0.5) * angle);
    let (along, across) = (distance * w.x, distance * w.y.abs());
    let half_chord = ((c.radius - across) * (c.radius + across)).max(0.0).sqrt();
    let r = match distance > c.radius && !c.flip_normals {
        // the nearer end of the chord, without cancellation
        true => (distance - c.radius) * (distance + c.radius) / (along + half_chord),
        false => along + half_chord,
    };
    let out = (at + r * to_axis.rotate(w)).normalize_or(Vec2::X);
    let normal = c.frame * out.extend(0.0);
    let p = c.base + c.radius * normal + u.y * c.length * c.frame.z_axis;
    let facing = if c.flip_normals { -normal } else { normal };
    let wi = (p - from).normalize_or_zero();
    let pdf = if facing.dot(wi) < 0.0 { pdf(c, from, p) } else { 0.0 };
    let turns = out.to_angle() / TAU;
    (Seen { p, wi, pdf }, Vec2::new(if turns < 0.0 { turns + 1.0 } else { turns }, u.y))
}

/// The density, in sr⁻¹, of the direction from `from` to the point `p`, which faces it; 0 if it is not finite.
pub(super) fn pdf(c: &Cylinder, from: Vec3, p: Vec3) -> f32 {
    let to_frame = c.frame.transpose();
    let angle = angle(c, (to_frame * (from - c.base)).truncate().length());
    let to_light = p - from;
    let across = (to_frame * to_light).truncate().length_squared();
    let squared = to_light.length_squared();
    let pdf = squared.sqrt() / (angle * c.length) * (squared / across);
    if pdf < f32::INFINITY { pdf } else { 0.0 }
}
