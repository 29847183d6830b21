//! What descriptions are made of: the textures and the materials that a material holds.

use crate::{ColorInput, HairAbsorption, MaterialDesc, MaterialId, ScalarInput, TextureDesc, TextureId};

impl From<ColorInput> for Option<TextureId> {
    fn from(input: ColorInput) -> Self {
        match input {
            ColorInput::Constant(_) => None,
            ColorInput::Texture(id) => Some(id),
        }
    }
}

impl From<ScalarInput> for Option<TextureId> {
    fn from(input: ScalarInput) -> Self {
        match input {
            ScalarInput::Constant(_) => None,
            ScalarInput::Texture(id) => Some(id),
        }
    }
}

fn given<const N: usize>(inputs: [Option<TextureId>; N]) -> Vec<TextureId> {
    inputs.into_iter().flatten().collect()
}

impl MaterialDesc {
    /// The textures that it names itself.
    pub fn textures(&self) -> Vec<TextureId> {
        let complex = |eta_k: &Option<(ColorInput, ColorInput)>| {
            eta_k.map_or([None; 2], |(eta, k)| [eta.into(), k.into()])
        };
        match *self {
            Self::Diffuse { reflectance } => given([reflectance.into()]),
            Self::Dielectric { specular_reflectance, specular_transmittance, .. }
            | Self::ThinDielectric { specular_reflectance, specular_transmittance, .. } => {
                given([specular_reflectance.into(), specular_transmittance.into()])
            }
            Self::RoughDielectric { alpha: [x, y], specular_reflectance, specular_transmittance, .. } => {
                given([x.into(), y.into(), specular_reflectance.into(), specular_transmittance.into()])
            }
            Self::Conductor { ref eta_k, specular_reflectance } => {
                let [eta, k] = complex(eta_k);
                given([eta, k, specular_reflectance.into()])
            }
            Self::RoughConductor { alpha: [x, y], ref eta_k, specular_reflectance, .. } => {
                let [eta, k] = complex(eta_k);
                given([x.into(), y.into(), eta, k, specular_reflectance.into()])
            }
            Self::Plastic { diffuse_reflectance, specular_reflectance, .. }
            | Self::RoughPlastic { diffuse_reflectance, specular_reflectance, .. } => {
                given([diffuse_reflectance.into(), specular_reflectance.into()])
            }
            Self::Eon { reflectance, roughness } => given([reflectance.into(), roughness.into()]),
            Self::OrenNayar { reflectance, sigma } => given([reflectance.into(), sigma.into()]),
            Self::DiffuseTransmission { reflectance, transmittance } => {
                given([reflectance.into(), transmittance.into()])
            }
            Self::CoatedConductor { ref eta_k, specular_reflectance, .. } => {
                let [eta, k] = complex(eta_k);
                given([eta, k, specular_reflectance.into()])
            }
            Self::Principled(p) => given([
                p.base_color.into(),
                p.roughness.into(),
                p.anisotropic.into(),
                p.metallic.into(),
                p.spec_trans.into(),
                p.spec_tint.into(),
                p.sheen.into(),
                p.sheen_tint.into(),
                p.flatness.into(),
                p.clearcoat.into(),
                p.clearcoat_gloss.into(),
            ]),
            Self::PrincipledThin(p) => given([
                p.base_color.into(),
                p.roughness.into(),
                p.anisotropic.into(),
                p.spec_trans.into(),
                p.eta.into(),
                p.spec_tint.into(),
                p.sheen.into(),
                p.sheen_tint.into(),
                p.flatness.into(),
                p.diff_trans.into(),
            ]),
            Self::MetallicRoughness(m) => given([
                m.base_color.into(),
                m.metallic.into(),
                m.roughness.into(),
                m.specular.into(),
                m.specular_color.into(),
                m.clearcoat.into(),
                m.clearcoat_roughness.into(),
                m.sheen_color.into(),
                m.sheen_roughness.into(),
                m.transmission.into(),
                m.diffuse_transmission.into(),
                m.diffuse_transmission_color.into(),
                m.anisotropy.into(),
            ]),
            Self::Hair(hair) => {
                let [first, second] = match hair.absorption {
                    HairAbsorption::Coefficient(color) | HairAbsorption::Color(color) => [color.into(), None],
                    HairAbsorption::Pigments { eumelanin, pheomelanin } => {
                        [eumelanin.into(), pheomelanin.into()]
                    }
                };
                given([first, second, hair.beta_m.into(), hair.beta_n.into()])
            }
            Self::TwoSided { .. } => Vec::new(),
            Self::Mask { opacity, .. } => given([opacity.into()]),
            Self::Blend { weight, .. } => given([weight.into()]),
            Self::BumpMap { texture, .. } => vec![texture],
            Self::NormalMap { normal, .. } => given([normal.into()]),
        }
    }

    /// The materials that it names itself.
    pub fn materials(&self) -> Vec<MaterialId> {
        match *self {
            Self::TwoSided { front, back } if front == back => vec![front],
            Self::TwoSided { front, back } => vec![front, back],
            Self::Blend { materials, .. } => materials.to_vec(),
            Self::Mask { inner, .. } | Self::BumpMap { inner, .. } | Self::NormalMap { inner, .. } => {
                vec![inner]
            }
            _ => Vec::new(),
        }
    }
}

impl TextureDesc {
    /// The textures that it names itself.
    pub fn textures(&self) -> Vec<TextureId> {
        match *self {
            Self::Bitmap { .. } | Self::MeshColor { .. } => Vec::new(),
            Self::Checkerboard { color0, color1, .. } => given([color0.into(), color1.into()]),
            Self::OtherUvs { input, .. } => given([input.into()]),
            Self::Scale { input, factor, .. } => given([input.into(), factor.into()]),
            Self::Mix { color0, color1, weight, .. } => given([color0.into(), color1.into(), weight.into()]),
        }
    }
}
