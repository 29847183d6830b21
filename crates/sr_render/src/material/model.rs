//! Descriptions of single models to what they are made from; tables that they share are ordered here.

use sr_bsdf::{MicrofacetKind, SmoothCoat};
use sr_scene::{ColorInput, MaterialDesc, Rgb, ScalarInput};

use super::kind::Kind;
use super::parts::ModelSource;
use super::tables::Orders;
use super::uncommon::Uncommon;
use super::{COLORS, Materials, Sources};

impl Materials {
    /// What a description that nests nothing is made from.
    pub(super) fn model_source(&mut self, desc: &MaterialDesc, orders: &mut Orders) -> ModelSource {
        match *desc {
            MaterialDesc::Diffuse { reflectance } => self.common(Kind::Diffuse, &[reflectance], &[]),
            MaterialDesc::Dielectric { eta, specular_reflectance: r, specular_transmittance: t } => {
                self.common(Kind::Dielectric, &[r, t], &[ScalarInput::Constant(eta)])
            }
            MaterialDesc::ThinDielectric { eta, specular_reflectance: r, specular_transmittance: t } => {
                self.common(Kind::ThinDielectric, &[r, t], &[ScalarInput::Constant(eta)])
            }
            MaterialDesc::RoughDielectric {
                kind,
                alpha: [ScalarInput::Constant(x), ScalarInput::Constant(y)],
                eta,
                specular_reflectance: reflectance,
                specular_transmittance: transmittance,
                multiscatter: true,
            } if x == y => {
                let tables = orders.glass(microfacet_kind(kind), x, eta);
                Uncommon::CompensatedDielectric { tables, reflectance, transmittance }.into()
            }
            MaterialDesc::RoughDielectric {
                kind,
                alpha: [x, y],
                eta,
                specular_reflectance: r,
                specular_transmittance: t,
                multiscatter: _,
            } => {
                let kind = Kind::RoughDielectric { shape: microfacet_kind(kind) };
                self.common(kind, &[r, t], &[x, y, ScalarInput::Constant(eta)])
            }
            MaterialDesc::Conductor { eta_k, specular_reflectance: r } => {
                let kind = Kind::Conductor { has_index: eta_k.is_some() };
                self.common(kind, &metal_colors(r, eta_k), &[])
            }
            MaterialDesc::RoughConductor {
                kind,
                alpha: [ScalarInput::Constant(x), ScalarInput::Constant(y)],
                eta_k,
                specular_reflectance: reflectance,
                multiscatter: true,
            } if x == y => {
                let table = orders.metal(microfacet_kind(kind), x);
                Uncommon::CompensatedConductor { table, eta_k, reflectance }.into()
            }
            MaterialDesc::RoughConductor { kind, alpha, eta_k, specular_reflectance: r, multiscatter: _ } => {
                let (shape, has_index) = (microfacet_kind(kind), eta_k.is_some());
                self.common(Kind::RoughConductor { shape, has_index }, &metal_colors(r, eta_k), &alpha)
            }
            MaterialDesc::Plastic { eta, diffuse_reflectance: d, specular_reflectance: s, nonlinear } => {
                self.common(Kind::Plastic { coat: SmoothCoat::new(eta), nonlinear }, &[d, s], &[])
            }
            MaterialDesc::RoughPlastic {
                kind,
                alpha,
                eta,
                diffuse_reflectance: d,
                specular_reflectance: s,
                nonlinear,
                multiscatter,
            } => {
                let coat = orders.coat(microfacet_kind(kind), alpha, eta, multiscatter) as u32;
                self.common(Kind::RoughPlastic { coat, nonlinear }, &[d, s], &[])
            }
            MaterialDesc::Eon { reflectance, roughness } => Uncommon::Eon { reflectance, roughness }.into(),
            MaterialDesc::OrenNayar { reflectance, sigma } => {
                Uncommon::OrenNayar { reflectance, sigma }.into()
            }
            MaterialDesc::DiffuseTransmission { reflectance, transmittance } => {
                Uncommon::DiffuseTransmission { reflectance, transmittance }.into()
            }
            MaterialDesc::CoatedConductor {
                kind,
                coat_alpha,
                eta,
                alpha,
                eta_k,
                specular_reflectance: reflectance,
                bounces,
            } => {
                let kind = microfacet_kind(kind);
                let tables = orders.coated(kind, [coat_alpha, eta, alpha], bounces);
                Uncommon::CoatedConductor { tables, eta_k, reflectance }.into()
            }
            MaterialDesc::Principled(principled) => Uncommon::Principled(principled).into(),
            MaterialDesc::PrincipledThin(thin) => Uncommon::PrincipledThin(thin).into(),
            MaterialDesc::MetallicRoughness(m) => Uncommon::MetallicRoughness(m).into(),
            MaterialDesc::Hair(hair) => Uncommon::Hair(hair).into(),
            MaterialDesc::TwoSided { .. }
            | MaterialDesc::Mask { .. }
            | MaterialDesc::Blend { .. }
            | MaterialDesc::BumpMap { .. }
            | MaterialDesc::NormalMap { .. } => unreachable!("flatten handles what nests"),
        }
    }

    /// A model of a common kind.
    fn common(&mut self, kind: Kind, colors: &[ColorInput], scalars: &[ScalarInput]) -> ModelSource {
        let known = self.kinds.iter().position(|&k| k == kind);
        let number = known.unwrap_or_else(|| {
            self.kinds.push(kind);
            self.kinds.len() - 1
        });
        ModelSource::Common { kind: number as u32, sources: Sources::new(colors, scalars) }
    }
}

/// Reflectance, η and k.
fn metal_colors(reflectance: ColorInput, eta_k: Option<(ColorInput, ColorInput)>) -> [ColorInput; COLORS] {
    let (eta, k) = eta_k.unwrap_or((ColorInput::Constant(Rgb::ZERO), ColorInput::Constant(Rgb::ZERO)));
    [reflectance, eta, k]
}

fn microfacet_kind(kind: sr_scene::MicrofacetKind) -> MicrofacetKind {
    match kind {
        sr_scene::MicrofacetKind::Beckmann => MicrofacetKind::Beckmann,
        sr_scene::MicrofacetKind::Ggx => MicrofacetKind::Ggx,
        sr_scene::MicrofacetKind::GgxCorrelated => MicrofacetKind::GgxCorrelated,
    }
}
