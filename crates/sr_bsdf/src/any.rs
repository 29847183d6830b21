//! One type for all models, so that hot loops hold a BSDF by value.

use glam::{Vec2, Vec3};

use crate::{
    Bsdf, BsdfSample, Conductor, Dielectric, Diffuse, Lobes, Mask, MicrofacetShape, Plastic, Rgb,
    RoughConductor, RoughDielectric, RoughPlastic, ThinDielectric,
};

/// Any model that fills its surface.
#[derive(Clone, Copy, Debug)]
pub enum AnyModel<'a> {
    /// Lambertian reflection.
    Diffuse(Diffuse),
    /// A smooth interface.
    Dielectric(Dielectric),
    /// A thin plate.
    ThinDielectric(ThinDielectric),
    /// A rough interface.
    RoughDielectric(RoughDielectric),
    /// A smooth metal.
    Conductor(Conductor),
    /// A rough metal.
    RoughConductor(RoughConductor),
    /// A smooth coating over a diffuse base.
    Plastic(Plastic),
    /// A rough coating over a diffuse base.
    RoughPlastic(RoughPlastic<'a>),
}

/// Any model, with or without holes. `'a` is the lifetime of the material's tables.
#[derive(Clone, Copy, Debug)]
pub enum AnyBsdf<'a> {
    /// The model fills its surface.
    Solid(AnyModel<'a>),
    /// Light also passes straight through.
    Masked(Mask<AnyModel<'a>>),
}

impl Bsdf for AnyModel<'_> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        match self {
            AnyModel::Diffuse(model) => model.eval(wo, wi),
            AnyModel::Dielectric(model) => model.eval(wo, wi),
            AnyModel::ThinDielectric(model) => model.eval(wo, wi),
            AnyModel::RoughDielectric(model) => model.eval(wo, wi),
            AnyModel::Conductor(model) => model.eval(wo, wi),
            AnyModel::RoughConductor(model) => model.eval(wo, wi),
            AnyModel::Plastic(model) => model.eval(wo, wi),
            AnyModel::RoughPlastic(model) => model.eval(wo, wi),
        }
    }
    #[inline]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        match self {
            AnyModel::Diffuse(model) => model.sample(wo, u_lobe, u),
            AnyModel::Dielectric(model) => model.sample(wo, u_lobe, u),
            AnyModel::ThinDielectric(model) => model.sample(wo, u_lobe, u),
            AnyModel::RoughDielectric(model) => model.sample(wo, u_lobe, u),
            AnyModel::Conductor(model) => model.sample(wo, u_lobe, u),
            AnyModel::RoughConductor(model) => model.sample(wo, u_lobe, u),
            AnyModel::Plastic(model) => model.sample(wo, u_lobe, u),
            AnyModel::RoughPlastic(model) => model.sample(wo, u_lobe, u),
        }
    }
    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            AnyModel::Diffuse(model) => model.pdf(wo, wi),
            AnyModel::Dielectric(model) => model.pdf(wo, wi),
            AnyModel::ThinDielectric(model) => model.pdf(wo, wi),
            AnyModel::RoughDielectric(model) => model.pdf(wo, wi),
            AnyModel::Conductor(model) => model.pdf(wo, wi),
            AnyModel::RoughConductor(model) => model.pdf(wo, wi),
            AnyModel::Plastic(model) => model.pdf(wo, wi),
            AnyModel::RoughPlastic(model) => model.pdf(wo, wi),
        }
    }
    #[inline]
    fn lobes(&self) -> Lobes {
        match self {
            AnyModel::Diffuse(model) => model.lobes(),
            AnyModel::Dielectric(model) => model.lobes(),
            AnyModel::ThinDielectric(model) => model.lobes(),
            AnyModel::RoughDielectric(model) => model.lobes(),
            AnyModel::Conductor(model) => model.lobes(),
            AnyModel::RoughConductor(model) => model.lobes(),
            AnyModel::Plastic(model) => model.lobes(),
            AnyModel::RoughPlastic(model) => model.lobes(),
        }
    }
    #[inline]
    fn albedo(&self) -> Rgb {
        match self {
            AnyModel::Diffuse(model) => model.albedo(),
            AnyModel::Dielectric(model) => model.albedo(),
            AnyModel::ThinDielectric(model) => model.albedo(),
            AnyModel::RoughDielectric(model) => model.albedo(),
            AnyModel::Conductor(model) => model.albedo(),
            AnyModel::RoughConductor(model) => model.albedo(),
            AnyModel::Plastic(model) => model.albedo(),
            AnyModel::RoughPlastic(model) => model.albedo(),
        }
    }
}

impl Bsdf for AnyBsdf<'_> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        match self {
            AnyBsdf::Solid(model) => model.eval(wo, wi),
            AnyBsdf::Masked(mask) => mask.eval(wo, wi),
        }
    }
    #[inline]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        match self {
            AnyBsdf::Solid(model) => model.sample(wo, u_lobe, u),
            AnyBsdf::Masked(mask) => mask.sample(wo, u_lobe, u),
        }
    }
    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            AnyBsdf::Solid(model) => model.pdf(wo, wi),
            AnyBsdf::Masked(mask) => mask.pdf(wo, wi),
        }
    }
    #[inline]
    fn lobes(&self) -> Lobes {
        match self {
            AnyBsdf::Solid(model) => model.lobes(),
            AnyBsdf::Masked(mask) => mask.lobes(),
        }
    }
    #[inline]
    fn albedo(&self) -> Rgb {
        match self {
            AnyBsdf::Solid(model) => model.albedo(),
            AnyBsdf::Masked(mask) => mask.albedo(),
        }
    }
}

/// Whatever is a model is also a BSDF without holes.
impl<'a, M: Into<AnyModel<'a>>> From<M> for AnyBsdf<'a> {
    #[inline]
    fn from(model: M) -> Self {
        AnyBsdf::Solid(model.into())
    }
}

impl From<Diffuse> for AnyModel<'_> {
    #[inline]
    fn from(model: Diffuse) -> Self {
        AnyModel::Diffuse(model)
    }
}

impl From<Dielectric> for AnyModel<'_> {
    #[inline]
    fn from(model: Dielectric) -> Self {
        AnyModel::Dielectric(model)
    }
}

impl From<ThinDielectric> for AnyModel<'_> {
    #[inline]
    fn from(model: ThinDielectric) -> Self {
        AnyModel::ThinDielectric(model)
    }
}

impl<S: MicrofacetShape> From<RoughDielectric<S>> for AnyModel<'_> {
    #[inline]
    fn from(model: RoughDielectric<S>) -> Self {
        AnyModel::RoughDielectric(model.of_any_shape())
    }
}

impl From<Conductor> for AnyModel<'_> {
    #[inline]
    fn from(model: Conductor) -> Self {
        AnyModel::Conductor(model)
    }
}

impl<S: MicrofacetShape> From<RoughConductor<S>> for AnyModel<'_> {
    #[inline]
    fn from(model: RoughConductor<S>) -> Self {
        AnyModel::RoughConductor(model.of_any_shape())
    }
}

impl From<Plastic> for AnyModel<'_> {
    #[inline]
    fn from(model: Plastic) -> Self {
        AnyModel::Plastic(model)
    }
}

impl<'a, S: MicrofacetShape> From<RoughPlastic<'a, S>> for AnyModel<'a> {
    #[inline]
    fn from(model: RoughPlastic<'a, S>) -> Self {
        AnyModel::RoughPlastic(model.of_any_shape())
    }
}
