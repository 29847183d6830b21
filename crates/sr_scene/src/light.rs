//! Lights that are not shapes.

use std::sync::Arc;

use glam::{Mat3, Mat4, Vec3};

use crate::{ColorInput, FovAxis, IntensityProfile, Rgb, TextureId, diagnostic::Span};

/// How an image holds all directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphereMapping {
    /// Latitude and longitude: a direction (x, y, z) is at u = atan2(x, −z) / 2π (mod 1), v = acos(y) / π, v = 0 being
    /// the top row, all of which is at the pole: the middles of h rows are at v = k / (h − 1).
    LatLong,
    /// An octahedron unfolded into a square so that areas are kept (Clarberg 2008, "Fast Equal-Area Mapping of the
    /// (Hemi)Sphere Using SIMD"), as pbrt-v4 stores environments: +Z in the middle, −Z at the corners, +X to the right,
    /// +Y downwards.
    EqualAreaOctahedral,
}

/// How many portals an environment may have.
pub const MAX_PORTALS: usize = 16;

/// A rectangular opening through which the light around the scene comes in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Portal {
    /// A corner.
    pub corner: Vec3,
    /// The two edges that leave it, perpendicular to each other; their cross product points inside.
    pub edges: [Vec3; 2],
}

/// How a spot's intensity falls between its two angles from 1 to 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpotFalloff {
    /// Linearly with the angle, as Mitsuba's.
    Linear,
    /// By the square of what is linear in the angle's cosine, as glTF's.
    SquaredCosine,
}

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
    /// An image around the scene.
    Environment {
        /// Index into [`crate::SceneDesc::images`].
        image: u32,
        /// How it holds the directions.
        mapping: SphereMapping,
        /// Multiplies the image.
        scale: f32,
        /// Rotation from the environment's space.
        world_from_light: Mat3,
        /// Is the density with which it is sampled made for sharing with another technique (Karlík et al. 2019)?
        mis_compensation: bool,
        /// Openings through which to sample it. They change the noise, never the picture.
        portals: Vec<Portal>,
        /// Where it was described.
        span: Span,
    },
    /// A point that shines equally in all directions.
    Point {
        /// Position.
        position: Vec3,
        /// Radiant intensity, in W sr⁻¹ per channel.
        intensity: Rgb,
        /// How far it shines: light is faded out by 1 − (distance / range)⁴. Infinite for light that is not.
        range: f32,
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
        /// Angle from the axis up to which the intensity is full, in radians.
        beam_width: f32,
        /// How it falls off in between.
        falloff: SpotFalloff,
        /// How far it shines, as of a point.
        range: f32,
        /// Projected image, looked up over the cone's bounding square.
        texture: Option<TextureId>,
        /// Where it was described.
        span: Span,
    },
    /// A point that projects an image along +Z of its own space, as a camera there would see it.
    Projector {
        /// Placement.
        world_from_light: Mat4,
        /// Irradiance, over π, on the plane one unit away from the point, over the image.
        irradiance: ColorInput,
        /// Multiplies it.
        scale: f32,
        /// The side of the image along which `fov` is measured.
        fov_axis: FovAxis,
        /// Field of view, in radians.
        fov: f32,
        /// Where it was described.
        span: Span,
    },
    /// A point whose intensity an image tells for each direction.
    Goniometric {
        /// Placement.
        world_from_light: Mat4,
        /// Radiant intensity where the image is 1.
        intensity: Rgb,
        /// Index into [`crate::SceneDesc::images`].
        image: u32,
        /// How it holds the directions.
        mapping: SphereMapping,
        /// Where it was described.
        span: Span,
    },
    /// A luminaire as it was measured, at a point; its nadir is +Z of its own space, the plane of horizontal angle 0 has
    /// +X in it.
    Profile {
        /// Placement.
        world_from_light: Mat4,
        /// Multiplies the candelas of the profile.
        intensity: Rgb,
        /// The measurement.
        profile: Arc<IntensityProfile>,
        /// Where it was described.
        span: Span,
    },
    /// The clear sky of the model of Hošek & Wilkie (2012), above the horizon of its own space, whose +Z is the zenith.
    Sky {
        /// Haze: 1 is air without any, 10 is thick.
        turbidity: f32,
        /// What the ground reflects.
        albedo: Rgb,
        /// Towards the sun, in its own space, unit length.
        sun_direction: Vec3,
        /// Multiplies the radiance.
        scale: f32,
        /// Rotation from its own space.
        world_from_light: Mat3,
        /// Where it was described.
        span: Span,
    },
    /// The disk of the sun, as bright as that sky leaves it (Hošek & Wilkie 2013).
    Sun {
        /// As for the sky.
        turbidity: f32,
        /// Towards its middle, in the sky's space, unit length.
        direction: Vec3,
        /// Multiplies the radiance.
        scale: f32,
        /// The angle that it fills, in radians. Its irradiance does not depend on that.
        aperture: f32,
        /// Rotation from the sky's space.
        world_from_light: Mat3,
        /// Where it was described.
        span: Span,
    },
}
