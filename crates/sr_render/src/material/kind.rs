//! Kinds of scattering model, and how a model of each kind is made from its inputs.
//!
//! In: [`Inputs`], the colours and numbers at a point. Out: a model, of the type that it is. Whoever serves many points
//! of one kind chooses once, [`Materials::with_recipe`], and then makes their models in a loop.

use sr_bsdf::{
    AnyModel, Beckmann, Bsdf, Conductor, Dielectric, Diffuse, Ggx, GgxCorrelated, Microfacet, MicrofacetKind,
    MicrofacetShape, Plastic, Rgb, RoughCoat, RoughConductor, RoughDielectric, RoughPlastic, SmoothCoat,
    ThinDielectric,
};

use super::{COLORS, Inputs, Materials};

/// What tells models apart besides their inputs. The comments name the inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Reflectance.
    Diffuse,
    /// Reflectance and transmittance; η.
    Dielectric,
    /// Reflectance and transmittance; η.
    ThinDielectric,
    /// Reflectance and transmittance; α along x and y, η.
    RoughDielectric { shape: MicrofacetKind },
    /// Reflectance, η and k.
    Conductor { has_index: bool },
    /// Reflectance, η and k; α along x and y.
    RoughConductor { shape: MicrofacetKind, has_index: bool },
    /// Reflectance of the base and of the coating.
    Plastic { coat: SmoothCoat, nonlinear: bool },
    /// Reflectance of the base and of the coating.
    RoughPlastic { coat: u32, nonlinear: bool },
}

/// Makes models of one kind.
pub(crate) trait Recipe: Copy {
    type Model: Bsdf + Into<AnyModel<'static>>;

    fn model(self, inputs: &Inputs) -> Self::Model;
}

/// What is done with a recipe of whatever type: compiled once for each.
pub(crate) trait RecipeUser {
    type Out;
    fn call<R: Recipe>(self, recipe: R) -> Self::Out;
}

impl Materials {
    /// Calls `user` with the recipe of a kind.
    #[inline(always)]
    pub(crate) fn with_recipe<U: RecipeUser>(&self, kind: u32, user: U) -> U::Out {
        use MicrofacetKind::{Beckmann as IsBeckmann, Ggx as IsGgx, GgxCorrelated as IsCorrelated};
        match self.kinds[kind as usize] {
            Kind::Diffuse => user.call(MakeDiffuse),
            Kind::Dielectric => user.call(MakeDielectric),
            Kind::ThinDielectric => user.call(MakeThinDielectric),
            Kind::RoughDielectric { shape: IsBeckmann } => user.call(MakeRoughDielectric(Beckmann)),
            Kind::RoughDielectric { shape: IsGgx } => user.call(MakeRoughDielectric(Ggx)),
            Kind::RoughDielectric { shape: IsCorrelated } => user.call(MakeRoughDielectric(GgxCorrelated)),
            Kind::Conductor { has_index: false } => user.call(MakeConductor::<false>),
            Kind::Conductor { has_index: true } => user.call(MakeConductor::<true>),
            Kind::RoughConductor { shape: IsBeckmann, has_index: false } => {
                user.call(MakeRoughConductor::<_, false>(Beckmann))
            }
            Kind::RoughConductor { shape: IsBeckmann, has_index: true } => {
                user.call(MakeRoughConductor::<_, true>(Beckmann))
            }
            Kind::RoughConductor { shape: IsGgx, has_index: false } => {
                user.call(MakeRoughConductor::<_, false>(Ggx))
            }
            Kind::RoughConductor { shape: IsGgx, has_index: true } => {
                user.call(MakeRoughConductor::<_, true>(Ggx))
            }
            Kind::RoughConductor { shape: IsCorrelated, has_index: false } => {
                user.call(MakeRoughConductor::<_, false>(GgxCorrelated))
            }
            Kind::RoughConductor { shape: IsCorrelated, has_index: true } => {
                user.call(MakeRoughConductor::<_, true>(GgxCorrelated))
            }
            Kind::Plastic { coat, nonlinear } => user.call(MakePlastic { coat, nonlinear }),
            Kind::RoughPlastic { coat, nonlinear } => {
                let coat = self.coats[coat as usize];
                match coat.distribution().kind() {
                    IsBeckmann => user.call(MakeRoughPlastic { shape: Beckmann, coat, nonlinear }),
                    IsGgx => user.call(MakeRoughPlastic { shape: Ggx, coat, nonlinear }),
                    IsCorrelated => user.call(MakeRoughPlastic { shape: GgxCorrelated, coat, nonlinear }),
                }
            }
        }
    }
}

#[derive(Clone, Copy)]
struct MakeDiffuse;

impl Recipe for MakeDiffuse {
    type Model = Diffuse;

    #[inline(always)]
    fn model(self, Inputs { colors, .. }: &Inputs) -> Diffuse {
        Diffuse::new(colors[0])
    }
}

#[derive(Clone, Copy)]
struct MakeDielectric;

impl Recipe for MakeDielectric {
    type Model = Dielectric;

    #[inline(always)]
    fn model(self, Inputs { colors, scalars, .. }: &Inputs) -> Dielectric {
        Dielectric::new(scalars[0], colors[0], colors[1])
    }
}

#[derive(Clone, Copy)]
struct MakeThinDielectric;

impl Recipe for MakeThinDielectric {
    type Model = ThinDielectric;

    #[inline(always)]
    fn model(self, Inputs { colors, scalars, .. }: &Inputs) -> ThinDielectric {
        ThinDielectric::new(scalars[0], colors[0], colors[1])
    }
}

#[derive(Clone, Copy)]
struct MakeRoughDielectric<S>(S);

impl<S: MicrofacetShape> Recipe for MakeRoughDielectric<S> {
    type Model = RoughDielectric<S>;

    #[inline(always)]
    fn model(self, Inputs { colors, scalars, .. }: &Inputs) -> RoughDielectric<S> {
        let distribution = Microfacet::new(self.0, scalars[0], scalars[1]);
        RoughDielectric::new(distribution, scalars[2], colors[0], colors[1])
    }
}

#[derive(Clone, Copy)]
struct MakeConductor<const HAS_INDEX: bool>;

/// η and k, if the metal has them.
#[inline(always)]
fn index<const HAS_INDEX: bool>(colors: &[Rgb; COLORS]) -> Option<(Rgb, Rgb)> {
    if HAS_INDEX { Some((colors[1], colors[2])) } else { None }
}

impl<const HAS_INDEX: bool> Recipe for MakeConductor<HAS_INDEX> {
    type Model = Conductor;

    #[inline(always)]
    fn model(self, Inputs { colors, .. }: &Inputs) -> Conductor {
        Conductor::new(index::<HAS_INDEX>(colors), colors[0])
    }
}

#[derive(Clone, Copy)]
struct MakeRoughConductor<S, const HAS_INDEX: bool>(S);

impl<S: MicrofacetShape, const HAS_INDEX: bool> Recipe for MakeRoughConductor<S, HAS_INDEX> {
    type Model = RoughConductor<S>;

    #[inline(always)]
    fn model(self, Inputs { colors, scalars, .. }: &Inputs) -> RoughConductor<S> {
        let distribution = Microfacet::new(self.0, scalars[0], scalars[1]);
        RoughConductor::new(distribution, index::<HAS_INDEX>(colors), colors[0])
    }
}

#[derive(Clone, Copy)]
struct MakePlastic {
    coat: SmoothCoat,
    nonlinear: bool,
}

impl Recipe for MakePlastic {
    type Model = Plastic;

    #[inline(always)]
    fn model(self, Inputs { colors, .. }: &Inputs) -> Plastic {
        Plastic::new(self.coat, colors[0], colors[1], self.nonlinear)
    }
}

/// The coat by value: a loop that had to read it from where it might write would do so again and again.
#[derive(Clone, Copy)]
struct MakeRoughPlastic<S> {
    shape: S,
    coat: RoughCoat,
    nonlinear: bool,
}

impl<S: MicrofacetShape> Recipe for MakeRoughPlastic<S> {
    type Model = RoughPlastic<S>;

    #[inline(always)]
    fn model(self, Inputs { colors, .. }: &Inputs) -> RoughPlastic<S> {
        let Self { shape, coat, nonlinear } = self;
        let distribution = Microfacet::isotropic(shape, coat.distribution().alpha().x);
        RoughPlastic::of_distribution(distribution, &coat, colors[0], colors[1], nonlinear)
    }
}
