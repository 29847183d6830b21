//! Compiled materials: a description's tree, flattened to one or two sides, each a model with its inputs.
//!
//! In: descriptions. Out, per hit: an [`AnyBsdf`] by value, its textures looked up. No ray, no light.

use glam::Vec2;
use sr_bsdf::{
    AnyBsdf, AnyModel, Bsdf, Conductor, Dielectric, Diffuse, Mask, Microfacet, MicrofacetKind, Plastic,
    RoughConductor, RoughDielectric, RoughPlastic, RoughPlasticTables, SmoothCoat, ThinDielectric,
};
use sr_scene::{ColorInput, MaterialDesc, MaterialId, ScalarInput, TextureId};

use crate::texture::Textures;

/// All materials of a scene.
#[derive(Clone, Debug)]
pub struct Materials {
    materials: Vec<Material>,
    coats: Vec<RoughPlasticTables>,
}

/// A surface: what it is seen from the front, and from behind if that differs from the front unturned.
#[derive(Clone, Debug)]
pub(crate) struct Material {
    /// Used on both sides, with directions as they are, if there is no `back`.
    pub front: Side,
    /// Used from behind, with the normal turned to the viewer.
    pub back: Option<Side>,
}

/// One side of a surface.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    opacity: Option<ScalarInput>,
    pub bump: Option<Bump>,
    model: Model,
}

/// A tilt of the shading normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bump {
    /// Displacement in scene units per unit of texture value.
    pub scale: f32,
    pub texture: TextureId,
}

#[derive(Clone, Debug)]
enum Model {
    Diffuse(ColorInput),
    Dielectric { eta: f32, colors: [ColorInput; 2] },
    ThinDielectric { eta: f32, colors: [ColorInput; 2] },
    RoughDielectric { kind: MicrofacetKind, alpha: [ScalarInput; 2], eta: f32, colors: [ColorInput; 2] },
    Conductor { eta_k: Option<(ColorInput, ColorInput)>, reflectance: ColorInput },
    RoughConductor(RoughMetal),
    Plastic { coat: SmoothCoat, colors: [ColorInput; 2], nonlinear: bool },
    RoughPlastic { coat: u32, colors: [ColorInput; 2], nonlinear: bool },
}

#[derive(Clone, Debug)]
struct RoughMetal {
    kind: MicrofacetKind,
    alpha: [ScalarInput; 2],
    eta_k: Option<(ColorInput, ColorInput)>,
    reflectance: ColorInput,
}

/// Nesting that has no meaning.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MaterialError {
    /// A mask in a mask, a bump map in a bump map, two sides of two sides.
    #[error("material {material}: {what} inside {what} is not supported")]
    Nested {
        /// Index of the outer material.
        material: u32,
        /// What is nested in itself.
        what: &'static str,
    },
}

fn microfacet_kind(kind: sr_scene::MicrofacetKind) -> MicrofacetKind {
    match kind {
        sr_scene::MicrofacetKind::Beckmann => MicrofacetKind::Beckmann,
        sr_scene::MicrofacetKind::Ggx => MicrofacetKind::Ggx,
    }
}

impl Materials {
    /// Flattens descriptions, which have been validated.
    ///
    /// # Errors
    /// If a material nests what cannot be nested.
    pub fn new(descs: &[MaterialDesc]) -> Result<Self, MaterialError> {
        let mut all = Self { materials: Vec::with_capacity(descs.len()), coats: Vec::new() };
        for id in 0..descs.len() {
            let material = all.flatten(descs, id as u32)?;
            all.materials.push(material);
        }
        Ok(all)
    }

    pub(crate) fn get(&self, id: MaterialId) -> &Material {
        &self.materials[id.0 as usize]
    }

    fn flatten(&mut self, descs: &[MaterialDesc], id: u32) -> Result<Material, MaterialError> {
        let nested = |what| MaterialError::Nested { material: id, what };
        Ok(match &descs[id as usize] {
            MaterialDesc::TwoSided { front, back } => {
                let (front, back) = (self.flatten(descs, front.0)?, self.flatten(descs, back.0)?);
                if front.back.is_some() || back.back.is_some() {
                    return Err(nested("twosided"));
                }
                Material { front: front.front, back: Some(back.front) }
            }
            MaterialDesc::Mask { opacity, inner } => {
                self.flatten(descs, inner.0)?.with_sides(|side| match side.opacity {
                    Some(_) => Err(nested("mask")),
                    None => Ok(Side { opacity: Some(*opacity), ..side }),
                })?
            }
            MaterialDesc::BumpMap { scale, texture, inner } => {
                self.flatten(descs, inner.0)?.with_sides(|side| match side.bump {
                    Some(_) => Err(nested("bumpmap")),
                    None => Ok(Side { bump: Some(Bump { scale: *scale, texture: *texture }), ..side }),
                })?
            }
            plain => {
                Material { front: Side { opacity: None, bump: None, model: self.model(plain) }, back: None }
            }
        })
    }

    fn model(&mut self, desc: &MaterialDesc) -> Model {
        match *desc {
            MaterialDesc::Diffuse { reflectance } => Model::Diffuse(reflectance),
            MaterialDesc::Dielectric { eta, specular_reflectance, specular_transmittance } => {
                Model::Dielectric { eta, colors: [specular_reflectance, specular_transmittance] }
            }
            MaterialDesc::ThinDielectric { eta, specular_reflectance, specular_transmittance } => {
                Model::ThinDielectric { eta, colors: [specular_reflectance, specular_transmittance] }
            }
            MaterialDesc::RoughDielectric {
                kind,
                alpha,
                eta,
                specular_reflectance,
                specular_transmittance,
            } => Model::RoughDielectric {
                kind: microfacet_kind(kind),
                alpha,
                eta,
                colors: [specular_reflectance, specular_transmittance],
            },
            MaterialDesc::Conductor { eta_k, specular_reflectance } => {
                Model::Conductor { eta_k, reflectance: specular_reflectance }
            }
            MaterialDesc::RoughConductor { kind, alpha, eta_k, specular_reflectance } => {
                let kind = microfacet_kind(kind);
                Model::RoughConductor(RoughMetal { kind, alpha, eta_k, reflectance: specular_reflectance })
            }
            MaterialDesc::Plastic { eta, diffuse_reflectance, specular_reflectance, nonlinear } => {
                let colors = [diffuse_reflectance, specular_reflectance];
                Model::Plastic { coat: SmoothCoat::new(eta), colors, nonlinear }
            }
            MaterialDesc::RoughPlastic {
                kind,
                alpha,
                eta,
                diffuse_reflectance,
                specular_reflectance,
                nonlinear,
            } => {
                let coat = self.coat(microfacet_kind(kind), alpha, eta);
                Model::RoughPlastic { coat, colors: [diffuse_reflectance, specular_reflectance], nonlinear }
            }
            MaterialDesc::TwoSided { .. } | MaterialDesc::Mask { .. } | MaterialDesc::BumpMap { .. } => {
                unreachable!("flatten handles what nests")
            }
        }
    }

    /// The tables of a rough coating, shared by all materials with the same one.
    fn coat(&mut self, kind: MicrofacetKind, alpha: f32, eta: f32) -> u32 {
        let wanted = Microfacet::isotropic(kind, alpha);
        let known = self.coats.iter().position(|c| *c.distribution() == wanted && c.eta() == eta);
        known.unwrap_or_else(|| {
            self.coats.push(RoughPlasticTables::new(kind, alpha, eta));
            self.coats.len() - 1
        }) as u32
    }

    /// The scattering model of one side at a surface coordinate.
    #[inline]
    pub(crate) fn bsdf(&self, side: &Side, uv: Vec2, textures: &Textures) -> AnyBsdf<'_> {
        self.with_bsdf(side, uv, textures, Keep)
    }

    /// Calls `user` with the scattering model of one side at a surface coordinate, as the type that it is.
    #[inline(always)]
    pub(crate) fn with_bsdf<'a, U: BsdfUser<'a>>(
        &'a self,
        side: &Side,
        uv: Vec2,
        textures: &Textures,
        user: U,
    ) -> U::Out {
        let color = |input: ColorInput| textures.color(input, uv);
        let complex = |eta_k: Option<(ColorInput, ColorInput)>| eta_k.map(|(eta, k)| (color(eta), color(k)));
        let rough = |kind, alpha: [ScalarInput; 2]| {
            let [x, y] = alpha.map(|a| textures.scalar(a, uv));
            Microfacet::new(kind, x, y)
        };
        let user = WithHoles { opacity: side.opacity.map(|opacity| textures.scalar(opacity, uv)), user };
        match &side.model {
            Model::Diffuse(reflectance) => user.call(Diffuse::new(color(*reflectance))),
            Model::Dielectric { eta, colors: [r, t] } => {
                user.call(Dielectric::new(*eta, color(*r), color(*t)))
            }
            Model::ThinDielectric { eta, colors: [r, t] } => {
                user.call(ThinDielectric::new(*eta, color(*r), color(*t)))
            }
            Model::RoughDielectric { kind, alpha, eta, colors: [r, t] } => {
                user.call(RoughDielectric::new(rough(*kind, *alpha), *eta, color(*r), color(*t)))
            }
            Model::Conductor { eta_k, reflectance } => {
                user.call(Conductor::new(complex(*eta_k), color(*reflectance)))
            }
            Model::RoughConductor(metal) => {
                let distribution = rough(metal.kind, metal.alpha);
                user.call(RoughConductor::new(distribution, complex(metal.eta_k), color(metal.reflectance)))
            }
            Model::Plastic { coat, colors: [d, s], nonlinear } => {
                user.call(Plastic::new(*coat, color(*d), color(*s), *nonlinear))
            }
            Model::RoughPlastic { coat, colors: [d, s], nonlinear } => {
                user.call(RoughPlastic::new(&self.coats[*coat as usize], color(*d), color(*s), *nonlinear))
            }
        }
    }
}

/// What is done with a scattering model of whatever type: compiled once for each, so that a vertex chooses among
/// models once and not at every question.
pub(crate) trait BsdfUser<'a> {
    type Out;
    fn call<B: Bsdf + Into<AnyModel<'a>>>(self, bsdf: B) -> Self::Out;
    fn call_masked<B: Bsdf + Into<AnyModel<'a>>>(self, bsdf: Mask<B>) -> Self::Out;
}

/// Puts the model's holes, if it has any, around it.
struct WithHoles<U> {
    opacity: Option<f32>,
    user: U,
}

impl<U> WithHoles<U> {
    #[inline(always)]
    fn call<'a, B: Bsdf + Into<AnyModel<'a>>>(self, bsdf: B) -> U::Out
    where
        U: BsdfUser<'a>,
    {
        match self.opacity {
            None => self.user.call(bsdf),
            Some(opacity) => self.user.call_masked(Mask::new(opacity, bsdf)),
        }
    }
}

/// Keeps the model, by value.
struct Keep;

impl<'a> BsdfUser<'a> for Keep {
    type Out = AnyBsdf<'a>;

    #[inline(always)]
    fn call<B: Bsdf + Into<AnyModel<'a>>>(self, bsdf: B) -> AnyBsdf<'a> {
        AnyBsdf::Solid(bsdf.into())
    }

    #[inline(always)]
    fn call_masked<B: Bsdf + Into<AnyModel<'a>>>(self, bsdf: Mask<B>) -> AnyBsdf<'a> {
        AnyBsdf::Masked(bsdf.map(Into::into))
    }
}

impl Material {
    /// The reflectance of a plain Lambertian surface, and whether its normal is turned to the viewer, who is behind
    /// it or not; `None` for any other side, and for one with holes or bumps.
    #[inline]
    pub(crate) fn lambert(&self, from_behind: bool) -> Option<(ColorInput, bool)> {
        if self.front.bump.is_some() {
            return None;
        }
        let (side, turned) = match &self.back {
            Some(back) if from_behind => (back, true),
            _ => (&self.front, false),
        };
        match side {
            Side { opacity: None, bump: None, model: Model::Diffuse(reflectance) } => {
                Some((*reflectance, turned))
            }
            _ => None,
        }
    }

    fn with_sides(self, change: impl Fn(Side) -> Result<Side, MaterialError>) -> Result<Self, MaterialError> {
        Ok(Self { front: change(self.front)?, back: self.back.map(&change).transpose()? })
    }
}

impl Side {
    /// Does the model tell the tangent from the bitangent?
    pub(crate) fn is_anisotropic(&self) -> bool {
        match &self.model {
            Model::RoughConductor(RoughMetal { alpha, .. }) | Model::RoughDielectric { alpha, .. } => {
                alpha[0] != alpha[1]
            }
            _ => false,
        }
    }
}
