//! Lights that are not shapes.

use glam::{Mat3, Mat4, Vec3};

use crate::{Rgb, TextureId, diagnostic::Span};

/// A light without a surface in the scene.
#[derive(Clone, Debug)]
pub enum LightDesc {
    /// The same radiance from every direction.
    Constant {
        /// Radiance.
        radiance: Rgb,
        /// Where it was described.
        span: Span,
    },
    /// An image around the scene, in latitude–longitude form.
    ///
    /// A direction (x, y, z) in the environment's space is looked up at
    /// u = atan2(x, −z) / 2π (mod 1), v = acos(y) / π, v = 0 being the top row.
    Environment {
        /// Index into [`crate::SceneDesc::images`].
        image: u32,
        /// Multiplies the image.
        scale: f32,
        /// Rotation from the environment's space.
        world_from_light: Mat3,
        /// Where it was described.
        span: Span,
    },
    /// A point that shines equally in all directions.
    Point {
        /// Position.
        position: Vec3,
        /// Radiant intensity, in W sr⁻¹ per channel.
        intensity: Rgb,
        /// Where it was described.
        span: Span,
    },
    /// Parallel light.
    Directional {
        /// The way the light travels, unit length.
        direction: Vec3,
        /// Irradiance on a surface facing the light, in W m⁻² per channel.
        irradiance: Rgb,
        /// Where it was described.
        span: Span,
    },
    /// A point that shines into a cone about +Z of its own space.
    Spot {
        /// Placement.
        world_from_light: Mat4,
        /// Radiant intensity on the axis.
        intensity: Rgb,
        /// Angle from the axis beyond which nothing is emitted, in radians.
        cutoff_angle: f32,
        /// Angle from the axis up to which the intensity is full, in radians; it falls off linearly in between.
        beam_width: f32,
        /// Projected image, looked up over the cone's bounding square.
        texture: Option<TextureId>,
        /// Where it was described.
        span: Span,
    },
}
