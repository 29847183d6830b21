//! Scattering models in the local frame: the surface is z = 0, its normal +Z.
//!
//! In: two unit directions pointing away from the surface, `wo` towards the camera and `wi` towards
//! the light. Out: the BSDF value (without the cosine), a sampled `wi`, a density. No scene, no
//! texture, no ray.
//!
//! One model a file; [`AnyBsdf`] is any of them by value. Models that reflect on one side do so on +Z and
//! are black from below: who wants both sides flips the frame. No model divides two numbers that both
//! vanish at grazing angles; see [`microfacet`](Microfacet) for how.

mod albedo_table;
mod any;
mod beckmann;
mod blend;
mod coated_conductor;
mod compensated_conductor;
mod compensated_dielectric;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod disney;
mod elementary;
mod eon;
mod erf;
mod ggx;
pub mod hair;
pub mod interface;
mod layer_walk;
mod mask;
mod metallic_roughness;
mod microfacet;
mod oren_nayar;
mod plastic;
mod principled;
mod principled_thin;
mod rough_coat;
mod rough_conductor;
mod rough_dielectric;
mod rough_plastic;
mod shape;
mod thin_dielectric;
mod tilt;

pub use albedo_table::AlbedoTable;
pub use any::{AnyBsdf, AnyModel};
pub use beckmann::Beckmann;
pub use blend::{Blend, MAX_PARTS, MAX_STEPS, Part};
pub use coated_conductor::{CoatedConductor, CoatedConductorTables};
pub use compensated_conductor::CompensatedConductor;
pub use compensated_dielectric::{CompensatedDielectric, DielectricTables};
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmission::DiffuseTransmission;
pub use eon::Eon;
pub use ggx::{Ggx, GgxCorrelated};
pub use hair::{Hair, HairInputs};
pub use layer_walk::BOUNCES as MAX_BOUNCES_BELOW_COAT;
pub use mask::Mask;
pub use metallic_roughness::{MetallicRoughness, MetallicRoughnessInputs};
pub use microfacet::Microfacet;
pub use oren_nayar::OrenNayar;
pub use plastic::{Plastic, SmoothCoat};
pub use principled::{Principled, PrincipledInputs};
pub use principled_thin::{PrincipledThin, PrincipledThinInputs};
pub use rough_coat::{RoughCoat, rough_internal_reflectance};
pub use rough_conductor::RoughConductor;
pub use rough_dielectric::RoughDielectric;
pub use rough_plastic::RoughPlastic;
pub use shape::{MicrofacetKind, MicrofacetShape};
pub use thin_dielectric::ThinDielectric;
pub use tilt::{Step, Tilt};

use glam::{Vec2, Vec3};
use sr_sampling::{Distribution, Sample, SolidAngle};

/// Linear RGB.
pub type Rgb = Vec3;

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Unit vector away from the surface.
    pub wi: Vec3,
    /// f · |cos θᵢ| / pdf: what the path's throughput is multiplied by.
    pub weight: Rgb,
    /// Density in sr⁻¹; of a delta lobe, the probability of choosing it.
    pub pdf: f32,
    /// Is the lobe a Dirac delta, which `eval` and `pdf` know nothing of?
    pub delta: bool,
    /// Index of refraction on the side of `wi` over that on the side of `wo`: 1 for reflection.
    pub eta: f32,
}

/// A scattering model.
///
/// `eval` and `pdf` speak of the non-delta part only. `pdf(wo, ·)` integrates to the probability that
/// `sample(wo, ·)` returns a non-delta sample.
pub trait Bsdf {
    /// f(wo, wi), in sr⁻¹, without the cosine.
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb;

    /// Draws `wi` given `wo`. `u_lobe` chooses among lobes, `u` a direction within one.
    /// `None`: absorbed, or a direction that contributes nothing.
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample>;

    /// The density, in sr⁻¹, with which `sample` draws `wi` from a non-delta lobe.
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32;

    /// What kinds of lobe it has.
    fn lobes(&self) -> Lobes;

    /// The fraction of light that it reflects or transmits, roughly; for denoising features only.
    fn albedo(&self) -> Rgb;

    /// This model with `wo` held fixed: a distribution over directions `wi`.
    fn given(&self, wo: Vec3) -> Given<'_, Self>
    where
        Self: Sized,
    {
        Given { bsdf: self, wo }
    }
}

/// What kinds of lobe a BSDF has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lobes {
    /// Is there a non-delta lobe on the side of `wo`?
    pub reflection: bool,
    /// Is there a non-delta lobe on the other side?
    pub transmission: bool,
    /// Is there a delta lobe?
    pub delta: bool,
}

impl Lobes {
    /// Does light sampling have anything to connect to?
    pub fn smooth(self) -> bool {
        self.reflection || self.transmission
    }
}

/// A BSDF with `wo` held fixed.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a, B> {
    bsdf: &'a B,
    wo: Vec3,
}

impl<B: Bsdf> Distribution for Given<'_, B> {
    type Measure = SolidAngle;
    type Uniform = (f32, Vec2);

    fn sample(&self, (u_lobe, u): (f32, Vec2)) -> Option<Sample<SolidAngle>> {
        let s = self.bsdf.sample(self.wo, u_lobe, u)?;
        (!s.delta).then_some(Sample { value: s.wi, pdf: s.pdf })
    }

    fn pdf(&self, wi: Vec3) -> f32 {
        self.bsdf.pdf(self.wo, wi)
    }
}
