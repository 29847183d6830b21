//! Descriptions' trees to [`Side`]s.

use sr_bsdf::{Microfacet, MicrofacetKind, RoughPlasticTables, SmoothCoat};
use sr_scene::{ColorInput, MaterialDesc, Rgb, ScalarInput};

use super::kind::{COLORS, Kind, SCALARS};
use super::{Bump, Face, Inputs, Materials, Queue, Side};

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

/// A surface: what it is seen from the front, and from behind if that differs from the front unturned.
struct Material {
    /// Used on both sides, with directions as they are, if there is no `back`.
    front: Unfinished,
    /// Used from behind, with the normal turned to the viewer.
    back: Option<Unfinished>,
}

/// A side in the making.
#[derive(Clone, Copy)]
struct Unfinished {
    opacity: Option<ScalarInput>,
    bump: Option<Bump>,
    kind: Kind,
    colors: [ColorInput; COLORS],
    scalars: [ScalarInput; SCALARS],
}

impl Material {
    fn with_sides(
        self,
        change: impl Fn(Unfinished) -> Result<Unfinished, MaterialError>,
    ) -> Result<Self, MaterialError> {
        Ok(Self { front: change(self.front)?, back: self.back.map(&change).transpose()? })
    }
}

impl Unfinished {
    /// Without holes or bumps. Inputs beyond those given are 0.
    fn plain(kind: Kind, colors: &[ColorInput], scalars: &[ScalarInput]) -> Self {
        let mut side = Self {
            opacity: None,
            bump: None,
            kind,
            colors: [ColorInput::Constant(Rgb::ZERO); COLORS],
            scalars: [ScalarInput::Constant(0.0); SCALARS],
        };
        side.colors[..colors.len()].copy_from_slice(colors);
        side.scalars[..scalars.len()].copy_from_slice(scalars);
        side
    }

    fn is_textured(&self) -> bool {
        let is_color = |c: &ColorInput| matches!(c, ColorInput::Texture(_));
        let is_scalar = |s: &ScalarInput| matches!(s, ScalarInput::Texture(_));
        self.colors.iter().any(is_color) || self.scalars.iter().chain(&self.opacity).any(is_scalar)
    }

    fn is_anisotropic(&self) -> bool {
        let is_rough = matches!(self.kind, Kind::RoughConductor { .. } | Kind::RoughDielectric { .. });
        is_rough && self.scalars[0] != self.scalars[1]
    }
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
        let faces = Vec::with_capacity(descs.len());
        let mut all = Self { faces, sides: Vec::new(), kinds: Vec::new(), coats: Vec::new() };
        for id in 0..descs.len() {
            let Material { front, back } = all.flatten(descs, id as u32)?;
            let tilts = front.bump.is_some();
            let front = all.add(front, tilts);
            let back = back.map_or(front, |back| Face { turn: -1.0, ..all.add(back, tilts) });
            all.faces.push([front, back]);
        }
        Ok(all)
    }

    /// `tilts`: does a bump map decide which side is seen?
    fn add(&mut self, side: Unfinished, tilts: bool) -> Face {
        let Unfinished { opacity, bump, kind, colors, scalars } = side;
        let has_holes = opacity.is_some();
        let opacity = opacity.unwrap_or(ScalarInput::Constant(1.0));
        let constant = |scalar| match scalar {
            ScalarInput::Constant(scalar) => scalar,
            ScalarInput::Texture(_) => 0.0,
        };
        let known = self.kinds.iter().position(|&k| k == kind);
        let number = known.unwrap_or_else(|| {
            self.kinds.push(kind);
            self.kinds.len() - 1
        }) as u32;
        let is_anisotropic = side.is_anisotropic();
        let queue = if tilts || bump.is_some() || is_anisotropic {
            Queue::SINGLE
        } else if kind == Kind::Diffuse && !has_holes {
            Queue::LAMBERT
        } else {
            Queue::of_kind(number)
        };
        self.sides.push(Side {
            kind: number,
            colors,
            scalars,
            opacity,
            constant: Inputs {
                colors: colors.map(|color| match color {
                    ColorInput::Constant(color) => color,
                    ColorInput::Texture(_) => Rgb::ZERO,
                }),
                scalars: scalars.map(constant),
                opacity: constant(opacity),
            },
            bump,
            is_textured: side.is_textured(),
            is_anisotropic,
        });
        let (albedo, has_picture) = match colors[0] {
            ColorInput::Constant(albedo) => (albedo, false),
            ColorInput::Texture(_) => (Rgb::ZERO, queue == Queue::LAMBERT),
        };
        Face { side: self.sides.len() as u32 - 1, queue, turn: 1.0, albedo, has_picture }
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
                    None => Ok(Unfinished { opacity: Some(*opacity), ..side }),
                })?
            }
            MaterialDesc::BumpMap { scale, texture, inner } => {
                self.flatten(descs, inner.0)?.with_sides(|side| match side.bump {
                    Some(_) => Err(nested("bumpmap")),
                    None => Ok(Unfinished { bump: Some(Bump { scale: *scale, texture: *texture }), ..side }),
                })?
            }
            plain => Material { front: self.side_of(plain), back: None },
        })
    }

    fn side_of(&mut self, desc: &MaterialDesc) -> Unfinished {
        let plain = Unfinished::plain;
        match *desc {
            MaterialDesc::Diffuse { reflectance } => plain(Kind::Diffuse, &[reflectance], &[]),
            MaterialDesc::Dielectric { eta, specular_reflectance: r, specular_transmittance: t } => {
                plain(Kind::Dielectric, &[r, t], &[ScalarInput::Constant(eta)])
            }
            MaterialDesc::ThinDielectric { eta, specular_reflectance: r, specular_transmittance: t } => {
                plain(Kind::ThinDielectric, &[r, t], &[ScalarInput::Constant(eta)])
            }
            MaterialDesc::RoughDielectric {
                kind,
                alpha: [x, y],
                eta,
                specular_reflectance: r,
                specular_transmittance: t,
            } => {
                let kind = Kind::RoughDielectric { shape: microfacet_kind(kind) };
                plain(kind, &[r, t], &[x, y, ScalarInput::Constant(eta)])
            }
            MaterialDesc::Conductor { eta_k, specular_reflectance: r } => {
                let kind = Kind::Conductor { has_index: eta_k.is_some() };
                plain(kind, &metal_colors(r, eta_k), &[])
            }
            MaterialDesc::RoughConductor { kind, alpha, eta_k, specular_reflectance: r } => {
                let (shape, has_index) = (microfacet_kind(kind), eta_k.is_some());
                plain(Kind::RoughConductor { shape, has_index }, &metal_colors(r, eta_k), &alpha)
            }
            MaterialDesc::Plastic { eta, diffuse_reflectance: d, specular_reflectance: s, nonlinear } => {
                plain(Kind::Plastic { coat: SmoothCoat::new(eta), nonlinear }, &[d, s], &[])
            }
            MaterialDesc::RoughPlastic {
                kind,
                alpha,
                eta,
                diffuse_reflectance: d,
                specular_reflectance: s,
                nonlinear,
            } => {
                let coat = self.coat(microfacet_kind(kind), alpha, eta);
                plain(Kind::RoughPlastic { coat, nonlinear }, &[d, s], &[])
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
}

/// Reflectance, η and k.
fn metal_colors(reflectance: ColorInput, eta_k: Option<(ColorInput, ColorInput)>) -> [ColorInput; COLORS] {
    let (eta, k) = eta_k.unwrap_or((ColorInput::Constant(Rgb::ZERO), ColorInput::Constant(Rgb::ZERO)));
    [reflectance, eta, k]
}
