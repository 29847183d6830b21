//! What a scene is, before it is compiled: plain data that a person can edit and Python can build.
//!
//! In: whatever a front end has read. Out: [`SceneDesc`] that [`validate`] has nothing to say against, and
//! [`Diagnostics`] with two renderings. No file format, no ray, no sampling algorithm lives here.

pub mod camera;
pub mod curves;
pub mod desc;
pub mod diagnostic;
pub mod film;
pub mod image;
mod inputs;
pub mod light;
pub mod material;
mod places;
pub mod profile;
mod report;
pub mod shape;
pub mod texture;
mod validate;

pub use camera::{CameraDesc, FovAxis, Lens, Projection};
pub use curves::{CurveBasis, CurveUv, CurvesDesc};
pub use desc::{MaterialId, SceneDesc, Settings, TextureId};
pub use diagnostic::{Diagnostic, Diagnostics, Effect, Severity, SourceId, Sources, Span};
pub use film::{Crop, FilmDesc, FilmWindow, FilterDesc};
pub use image::{Image, Pixels};
pub use light::{LightDesc, MAX_PORTALS, Portal, SphereMapping, SpotFalloff};
pub use material::{
    ColorInput, HairAbsorption, HairDesc, MaterialDesc, MetallicRoughnessDesc, MicrofacetKind,
    PrincipledDesc, PrincipledThinDesc, ScalarInput, Tilting,
};
pub use profile::IntensityProfile;
pub use shape::{Emission, Geometry, GroupDesc, InstanceDesc, MAX_UV_SETS, MeshDesc, ShapeDesc};
pub use texture::{Filter, MeshColorOf, TextureDesc, Wrap};
pub use validate::{MAX_FILM_PIXELS, validate};

/// Linear RGB: radiance, reflectance or importance.
pub type Rgb = glam::Vec3;
