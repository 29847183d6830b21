//! Models without a loop of their own: what each is made from, which may be many numbers, and how.

use sr_bsdf::hair::{absorption_of_color, pigments};
use sr_bsdf::{
    AnyModel, CoatedConductor, CompensatedConductor, CompensatedDielectric, DiffuseTransmission, Eon, Hair,
    HairInputs, MetallicRoughness, MetallicRoughnessInputs, OrenNayar, Principled, PrincipledInputs,
    PrincipledThin, PrincipledThinInputs, Rgb,
};
use sr_scene::{
    ColorInput, HairAbsorption, HairDesc, MetallicRoughnessDesc, PrincipledDesc, PrincipledThinDesc,
    ScalarInput,
};

use super::parts::{ModelSource, Place};
use super::tables::Tables;

/// What an uncommon model is made from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Uncommon {
    Eon {
        reflectance: ColorInput,
        roughness: ScalarInput,
    },
    OrenNayar {
        reflectance: ColorInput,
        sigma: ScalarInput,
    },
    DiffuseTransmission {
        reflectance: ColorInput,
        transmittance: ColorInput,
    },
    /// `table`: into [`Tables::metals`].
    CompensatedConductor {
        table: usize,
        eta_k: Option<(ColorInput, ColorInput)>,
        reflectance: ColorInput,
    },
    /// `tables`: into [`Tables::glasses`].
    CompensatedDielectric {
        tables: usize,
        reflectance: ColorInput,
        transmittance: ColorInput,
    },
    /// `tables`: into [`Tables::coated`].
    CoatedConductor {
        tables: usize,
        eta_k: Option<(ColorInput, ColorInput)>,
        reflectance: ColorInput,
    },
    Principled(PrincipledDesc),
    PrincipledThin(PrincipledThinDesc),
    MetallicRoughness(MetallicRoughnessDesc),
    Hair(HairDesc),
}

impl From<Uncommon> for ModelSource {
    fn from(uncommon: Uncommon) -> Self {
        ModelSource::Uncommon(uncommon)
    }
}

impl Uncommon {
    /// Does it tell the tangent from the bitangent?
    pub fn is_anisotropic(&self) -> bool {
        match self {
            Uncommon::Principled(p) => p.anisotropic != ScalarInput::Constant(0.0),
            Uncommon::PrincipledThin(p) => p.anisotropic != ScalarInput::Constant(0.0),
            Uncommon::MetallicRoughness(m) => m.anisotropy != ScalarInput::Constant(0.0),
            Uncommon::Hair(_) => true,
            _ => false,
        }
    }

    /// The model at a place.
    pub fn model<'a>(&self, at: &Place, all: &'a Tables) -> AnyModel<'a> {
        let index = |eta_k: Option<(ColorInput, ColorInput)>| -> Option<(Rgb, Rgb)> {
            eta_k.map(|(eta, k)| (at.color(eta), at.color(k)))
        };
        match *self {
            Uncommon::Eon { reflectance, roughness } => {
                Eon::new(at.color(reflectance), at.scalar(roughness)).into()
            }
            Uncommon::OrenNayar { reflectance, sigma } => {
                OrenNayar::new(at.color(reflectance), at.scalar(sigma)).into()
            }
            Uncommon::DiffuseTransmission { reflectance, transmittance } => {
                DiffuseTransmission::new(at.color(reflectance), at.color(transmittance)).into()
            }
            Uncommon::CompensatedConductor { table, eta_k, reflectance } => {
                let (distribution, table) = &all.metals[table];
                CompensatedConductor::new(*distribution, table, index(eta_k), at.color(reflectance)).into()
            }
            Uncommon::CompensatedDielectric { tables, reflectance, transmittance } => {
                let (reflectance, transmittance) = (at.color(reflectance), at.color(transmittance));
                CompensatedDielectric::new(&all.glasses[tables], reflectance, transmittance).into()
            }
            Uncommon::CoatedConductor { tables, eta_k, reflectance } => {
                CoatedConductor::new(&all.coated[tables], index(eta_k), at.color(reflectance)).into()
            }
            Uncommon::Principled(ref p) => Principled::new(PrincipledInputs {
                base_color: at.color(p.base_color),
                roughness: at.scalar(p.roughness),
                anisotropic: at.scalar(p.anisotropic),
                metallic: at.scalar(p.metallic),
                spec_trans: at.scalar(p.spec_trans),
                eta: p.eta,
                spec_tint: at.scalar(p.spec_tint),
                sheen: at.scalar(p.sheen),
                sheen_tint: at.scalar(p.sheen_tint),
                flatness: at.scalar(p.flatness),
                clearcoat: at.scalar(p.clearcoat),
                clearcoat_gloss: at.scalar(p.clearcoat_gloss),
                rates: p.rates,
            })
            .into(),
            Uncommon::MetallicRoughness(ref m) => MetallicRoughness::new(MetallicRoughnessInputs {
                base_color: at.color(m.base_color),
                metallic: at.scalar(m.metallic),
                roughness: at.scalar(m.roughness),
                specular: at.scalar(m.specular),
                specular_color: at.color(m.specular_color),
                ior: m.ior,
                clearcoat: at.scalar(m.clearcoat),
                clearcoat_roughness: at.scalar(m.clearcoat_roughness),
                sheen_color: at.color(m.sheen_color),
                sheen_roughness: at.scalar(m.sheen_roughness),
                transmission: at.scalar(m.transmission),
                is_thin: m.thin,
                diffuse_transmission: at.scalar(m.diffuse_transmission),
                diffuse_transmission_color: at.color(m.diffuse_transmission_color),
                anisotropy: at.scalar(m.anisotropy),
                anisotropy_rotation: m.anisotropy_rotation,
            })
            .into(),
            Uncommon::Hair(ref hair) => hair_at(hair, at).into(),
            Uncommon::PrincipledThin(ref p) => PrincipledThin::new(PrincipledThinInputs {
                base_color: at.color(p.base_color),
                roughness: at.scalar(p.roughness),
                anisotropic: at.scalar(p.anisotropic),
                spec_trans: at.scalar(p.spec_trans),
                eta: at.scalar(p.eta),
                spec_tint: at.scalar(p.spec_tint),
                sheen: at.scalar(p.sheen),
                sheen_tint: at.scalar(p.sheen_tint),
                flatness: at.scalar(p.flatness),
                diff_trans: at.scalar(p.diff_trans),
                rates: p.rates,
            })
            .into(),
        }
    }
}

fn hair_at(hair: &HairDesc, at: &Place) -> Hair {
    let (beta_m, beta_n) = (at.scalar(hair.beta_m), at.scalar(hair.beta_n));
    let sigma_a = match hair.absorption {
        HairAbsorption::Coefficient(sigma_a) => at.color(sigma_a),
        HairAbsorption::Color(color) => absorption_of_color(at.color(color), beta_n),
        HairAbsorption::Pigments { eumelanin, pheomelanin } => {
            pigments(at.scalar(eumelanin), at.scalar(pheomelanin))
        }
    };
    let HairDesc { eta, alpha, along_u: along_x, .. } = *hair;
    Hair::new(HairInputs { sigma_a, eta, beta_m, beta_n, alpha, along_x })
}
