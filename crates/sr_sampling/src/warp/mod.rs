//! Closed-form distributions: the unit square bent into a disk, a hemisphere, a triangle.
//!
//! In: two uniforms. Out: a point and its density. Each warp is continuous and keeps neighbours
//! together, so that well distributed uniforms become well distributed points, and each can be run
//! backwards ([`Invert`](crate::Invert)).

mod cone;
mod disk;
mod hemisphere;
mod polygon;
mod rectangle;
mod sphere;
mod spherical_rectangle;
mod spherical_triangle;
mod triangle;

pub use cone::{ConeError, UniformCone};
pub use disk::{UniformDisk, concentric_disk, invert_concentric_disk, unit_circle};
pub use hemisphere::{AnyHemisphere, CosineHemisphere, UniformHemisphere};
pub use polygon::RegularPolygon;
pub use rectangle::{DegenerateRectangle, UniformRectangle};
pub use sphere::UniformSphere;
pub use spherical_rectangle::SphericalRectangle;
pub use spherical_triangle::SphericalTriangle;
pub use triangle::{DegenerateTriangle, UniformTriangle, barycentrics, invert_barycentrics};

/// The largest `f32` below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// How far, relative to the size of a support, rounding may push a sample over its rim.
///
/// A density that is 0 a few roundings outside the rim would deny the samples on it.
const RIM: f32 = 1.0 + 8.0 * f32::EPSILON;

/// Rounding must not turn an inverted uniform into 1, or into less than 0.
fn clamp_unit(u: f32) -> f32 {
    u.clamp(0.0, BELOW_ONE)
}

#[cfg(test)]
pub(crate) mod testing {
    use glam::Vec2;

    use crate::sequence::{OwenSobol, SampleId, Sequence};

    /// Well distributed uniforms, the corners and the edges of the unit square.
    pub fn uniforms() -> impl Iterator<Item = Vec2> {
        let sequence = OwenSobol::new(1);
        let edges = [0.0, 0.25, 0.5, super::BELOW_ONE];
        let on_edges = edges.into_iter().flat_map(move |x| edges.map(|y| Vec2::new(x, y)));
        on_edges.chain((0..4096).map(move |index| sequence.get_2d(SampleId { pixel: 0, index }, 0)))
    }
}
