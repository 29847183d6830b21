//! One type for all models, so that hot loops hold a BSDF by value.

use glam::{Vec2, Vec3};

use crate::{
    Bsdf, BsdfSample, Conductor, Dielectric, Diffuse, Lobes, Mask, Plastic, Rgb, RoughConductor,
    RoughDielectric, RoughPlastic, ThinDielectric,
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

macro_rules! for_each_model {
    ($self:expr, $model:ident => $call:expr) => {
        match $self {
            AnyModel::Diffuse($model) => $call,
            AnyModel::Dielectric($model) => $call,
            AnyModel::ThinDielectric($model) => $call,
            AnyModel::RoughDielectric($model) => $call,
            AnyModel::Conductor($model) => $call,
            AnyModel::RoughConductor($model) => $call,
            AnyModel::Plastic($model) => $call,
            AnyModel::RoughPlastic($model) => $call,
        }
    };
}

impl Bsdf for AnyModel<'_> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        for_each_model!(self, model => model.eval(wo, wi))
    }
    #[inline]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        for_each_model!(self, model => model.sample(wo, u_lobe, u))
    }
    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        for_each_model!(self, model => model.pdf(wo, wi))
    }
    #[inline]
    fn lobes(&self) -> Lobes {
        for_each_model!(self, model => model.lobes())
    }
    #[inline]
    fn albedo(&self) -> Rgb {
        for_each_model!(self, model => model.albedo())
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

macro_rules! from_models {
    ($($model:ident => $type:ty),* $(,)?) => {$(
        impl<'a> From<$type> for AnyModel<'a> {
            #[inline]
            fn from(model: $type) -> Self {
                AnyModel::$model(model)
            }
        }
        impl<'a> From<$type> for AnyBsdf<'a> {
            #[inline]
            fn from(model: $type) -> Self {
                AnyBsdf::Solid(AnyModel::$model(model))
            }
        }
    )*};
}

from_models! {
    Diffuse => Diffuse,
    Dielectric => Dielectric,
    ThinDielectric => ThinDielectric,
    RoughDielectric => RoughDielectric,
    Conductor => Conductor,
    RoughConductor => RoughConductor,
    Plastic => Plastic,
    RoughPlastic => RoughPlastic<'a>,
}
