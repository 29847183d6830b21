//! Lights: what they emit, and directions towards them as densities.
//!
//! In: a point in space and uniforms. Out: a direction, the radiance that would arrive along it if
//! nothing were in between, and its density in sr⁻¹. Nothing here traces a shadow ray.
//!
//! - [`AreaLight`]: a mesh, a sphere or a disk that shines.
//! - [`Environment`]: an image around the scene; [`ConstantEnvironment`]: the same radiance from everywhere.
//! - [`Sky`] and [`Sun`]: those of a clear day.
//! - [`PointLight`], [`SpotLight`], [`DirectionalLight`], [`Projector`], [`GoniometricLight`], [`ProfileLight`]: deltas,
//!   which only light sampling can find.
//! - [`Probe`]: one light by itself, as an image of it shows it.
//! - [`Lights`]: all of them, and the choice among them.
//!
//! Invariant: `pdf` is the density with which `sample` draws a direction, lights behind others included.

mod area;
mod batch;
mod compile;
mod cylinder;
mod environment;
mod list;
mod point;
mod portal;
mod probe;
mod projector;
mod seen_from;
mod sky;
mod sphere_image;

use glam::{Vec2, Vec3};
use sr_scene::Rgb;

pub use area::AreaLight;
pub(crate) use area::Triangle;
pub(crate) use batch::{DeltaSamples, LightSamples};
pub(crate) use compile::{Compiled, compile_light};
pub use environment::{ConstantEnvironment, Environment, EnvironmentSampling};
pub(crate) use list::{Delta, Extended};
pub use list::{LightId, Lights};
pub use point::{DirectionalLight, PointLight, SpotLight};
pub use probe::Probe;
pub use projector::{GoniometricLight, ProfileLight, Projector};
pub use seen_from::SeenFrom;
pub use sky::{Sky, Sun};
pub use sphere_image::sphere_direction;

/// A sampled direction towards a light with an extent. What arrives along it, [`Lights::radiance`] tells: it may cost
/// a look at a picture, which a light that turns out to be hidden is not worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit vector from the shading point.
    pub wi: Vec3,
    /// Density in sr⁻¹.
    pub pdf: f32,
    /// Where the light is: what a shadow ray must reach.
    pub target: Target,
    /// The light.
    pub light: LightId,
    /// Where on it, in texture coordinates; zero on a sphere, where `target` tells.
    pub uv: Vec2,
}

/// The direction towards a delta light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaSample {
    /// Unit vector from the shading point.
    pub wi: Vec3,
    /// What arrives along `wi` if nothing is in between, already divided by the density: intensity over squared
    /// distance, or irradiance.
    pub radiance: Rgb,
    /// Where the light is.
    pub target: Target,
}

/// The far end of a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A point.
    Point(Vec3),
    /// Infinitely far along `wi`.
    Infinity,
}
