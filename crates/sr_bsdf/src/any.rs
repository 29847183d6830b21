//! One type for all models, so that hot loops hold a BSDF by value.

use glam::{Vec2, Vec3};

use crate::{
    Blend, Bsdf, BsdfSample, CoatedConductor, CompensatedConductor, CompensatedDielectric, Conductor,
    Dielectric, Diffuse, DiffuseTransmission, Eon, Hair, Lobes, Mask, MetallicRoughness, MicrofacetShape,
    OrenNayar, Plastic, Principled, PrincipledThin, Rgb, RoughConductor, RoughDielectric, RoughPlastic,
    ThinDielectric,
};

/// Declares an enum of models, and hands its questions on to them, inlined as the first line says. Those marked `from` also
/// convert into it.
macro_rules! any {
    (
        #[$inline:meta]
        $(#[$enum_doc:meta])* $any:ident;
        $($(#[$doc:meta])* $name:ident($model:ty) $(, $from:ident)?;)*
    ) => {
        $(#[$enum_doc])*
        #[derive(Clone, Copy, Debug)]
        pub enum $any<'a> {
            $($(#[$doc])* $name($model),)*
        }

        impl Bsdf for $any<'_> {
            #[$inline]
            fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
                match self { $($any::$name(model) => model.eval(wo, wi),)* }
            }
            #[inline]
            fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
                match self { $($any::$name(model) => model.sample(wo, u_lobe, u),)* }
            }
            #[$inline]
            fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
                match self { $($any::$name(model) => model.pdf(wo, wi),)* }
            }
            #[inline]
            fn lobes(&self) -> Lobes {
                match self { $($any::$name(model) => model.lobes(),)* }
            }
            #[inline]
            fn albedo(&self) -> Rgb {
                match self { $($any::$name(model) => model.albedo(),)* }
            }
        }

        $($(
            any!(@$from $any, $name, $model);
        )?)*
    };
    (@from $any:ident, $name:ident, $model:ty) => {
        impl<'a> From<$model> for $any<'a> {
            #[inline]
            fn from(model: $model) -> Self {
                $any::$name(model)
            }
        }
    };
}

any! {
    #[inline(always)]
    /// Any model that fills its surface.
    AnyModel;
    /// Lambertian reflection.
    Diffuse(Diffuse), from;
    /// A smooth interface.
    Dielectric(Dielectric), from;
    /// A thin plate.
    ThinDielectric(ThinDielectric), from;
    /// A rough interface.
    RoughDielectric(RoughDielectric);
    /// A smooth metal.
    Conductor(Conductor), from;
    /// A rough metal.
    RoughConductor(RoughConductor);
    /// A smooth coating over a diffuse base.
    Plastic(Plastic), from;
    /// A rough coating over a diffuse base.
    RoughPlastic(RoughPlastic);
    /// Rough diffuse reflection that preserves energy.
    Eon(Eon), from;
    /// Rough diffuse reflection.
    OrenNayar(OrenNayar), from;
    /// Diffuse reflection and transmission.
    DiffuseTransmission(DiffuseTransmission), from;
    /// A rough metal that loses nothing.
    CompensatedConductor(CompensatedConductor<'a>), from;
    /// A rough interface that loses nothing.
    CompensatedDielectric(CompensatedDielectric<'a>), from;
    /// A metal under a coating.
    CoatedConductor(CoatedConductor<'a>), from;
    /// Metals, plastics, cloth, rough glass.
    Principled(Principled), from;
    /// glTF's material.
    MetallicRoughness(MetallicRoughness), from;
    /// Leaves, paper, frosted panes.
    PrincipledThin(PrincipledThin), from;
    /// Hair and fur.
    Hair(Hair), from;
}

any! {
    #[inline]
    /// Any model, with or without holes, or several in one place. `'a` is the lifetime of the material's tables, and of a
    /// blend, which is large.
    AnyBsdf;
    /// The model fills its surface.
    Solid(AnyModel<'a>);
    /// Light also passes straight through.
    Masked(Mask<AnyModel<'a>>);
    /// Several models, or one in a frame of its own.
    Blended(&'a Blend<'a>);
}

impl AnyBsdf<'_> {
    /// The normal with its bumps, in the surface's frame; of several, their mean.
    pub fn normal(&self) -> Vec3 {
        match self {
            AnyBsdf::Blended(blend) => blend.normal(),
            _ => Vec3::Z,
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

impl<S: MicrofacetShape> From<RoughDielectric<S>> for AnyModel<'_> {
    #[inline]
    fn from(model: RoughDielectric<S>) -> Self {
        AnyModel::RoughDielectric(model.of_any_shape())
    }
}

impl<S: MicrofacetShape> From<RoughConductor<S>> for AnyModel<'_> {
    #[inline]
    fn from(model: RoughConductor<S>) -> Self {
        AnyModel::RoughConductor(model.of_any_shape())
    }
}

impl<S: MicrofacetShape> From<RoughPlastic<S>> for AnyModel<'_> {
    #[inline]
    fn from(model: RoughPlastic<S>) -> Self {
        AnyModel::RoughPlastic(model.of_any_shape())
    }
}
