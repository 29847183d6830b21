//! The principled models, a parameter or a few at a time at either end.

use sr_bsdf::{
    AnyBsdf, MetallicRoughness, MetallicRoughnessInputs, Principled, PrincipledInputs, PrincipledThin,
    PrincipledThinInputs, Rgb,
};

use crate::bsdfs::{GREEN, PINK};

pub(crate) fn models() -> Vec<(String, AnyBsdf<'static>)> {
    let plain = PrincipledInputs { base_color: GREEN, ..PrincipledInputs::default() };
    let inputs = [
        ("plain", plain),
        ("rough", PrincipledInputs { roughness: 1.0, anisotropic: 1.0, ..plain }),
        ("metal", PrincipledInputs { metallic: 1.0, roughness: 0.4, anisotropic: 0.8, ..plain }),
        ("half metal", PrincipledInputs { metallic: 0.5, spec_tint: 0.7, flatness: 1.0, ..plain }),
        ("glass", PrincipledInputs { base_color: PINK, spec_trans: 1.0, ..plain }),
        (
            "thin medium",
            PrincipledInputs { base_color: PINK, spec_trans: 0.7, eta: 0.8, roughness: 0.7, ..plain },
        ),
        ("not bending", PrincipledInputs { eta: 1.0, metallic: 0.3, ..plain }),
        ("velvet", PrincipledInputs { base_color: 0.3 * GREEN, sheen: 1.0, sheen_tint: 1.0, ..plain }),
        ("coated", PrincipledInputs { clearcoat: 1.0, ..plain }),
        (
            "all",
            PrincipledInputs {
                metallic: 0.2,
                spec_trans: 0.4,
                anisotropic: 0.5,
                spec_tint: 0.3,
                sheen: 0.2,
                sheen_tint: 0.5,
                flatness: 0.3,
                clearcoat: 0.6,
                clearcoat_gloss: 0.2,
                rates: [0.5, 2.0, 3.0],
                ..plain
            },
        ),
    ];
    let thin = PrincipledThinInputs { base_color: GREEN, ..PrincipledThinInputs::default() };
    let thin_inputs = [
        ("plain", thin),
        ("pane", PrincipledThinInputs { spec_trans: 1.0, roughness: 0.4, spec_tint: 0.5, ..thin }),
        ("leaf", PrincipledThinInputs { diff_trans: 1.2, sheen: 0.3, ..thin }),
        ("paper", PrincipledThinInputs { diff_trans: 2.0, roughness: 1.0, ..thin }),
        (
            "all",
            PrincipledThinInputs {
                spec_trans: 0.5,
                diff_trans: 0.8,
                anisotropic: 0.7,
                eta: 1.3,
                flatness: 0.6,
                sheen: 0.2,
                sheen_tint: 0.4,
                rates: [2.0, 1.0, 0.5, 1.0],
                ..thin
            },
        ),
    ];
    let full = inputs.map(|(name, inputs)| (format!("principled {name}"), Principled::new(inputs).into()));
    let thin =
        thin_inputs.map(|(name, i)| (format!("thin principled {name}"), PrincipledThin::new(i).into()));
    full.into_iter().chain(thin).chain(metallic_roughness()).collect()
}

fn metallic_roughness() -> Vec<(String, AnyBsdf<'static>)> {
    let metal = MetallicRoughnessInputs { base_color: GREEN, roughness: 0.5, ..Default::default() };
    let plastic = MetallicRoughnessInputs { metallic: 0.0, ..metal };
    let glass = MetallicRoughnessInputs { transmission: 1.0, base_color: PINK, ..plastic };
    let inputs = [
        ("metal", metal),
        ("rough", MetallicRoughnessInputs { roughness: 1.0, ..metal }),
        (
            "turned",
            MetallicRoughnessInputs { anisotropy: 0.7, anisotropy_rotation: 0.6, roughness: 0.4, ..metal },
        ),
        ("plastic", plastic),
        ("no gloss", MetallicRoughnessInputs { specular: 0.0, ..plastic }),
        ("tinted", MetallicRoughnessInputs { specular_color: Rgb::new(2.0, 0.5, 0.1), ior: 1.8, ..plastic }),
        (
            "coated",
            MetallicRoughnessInputs { clearcoat: 1.0, clearcoat_roughness: 0.4, metallic: 0.5, ..metal },
        ),
        ("fibres", MetallicRoughnessInputs { sheen_color: PINK, sheen_roughness: 0.5, ..plastic }),
        ("pane", glass),
        ("glass", MetallicRoughnessInputs { is_thin: false, ..glass }),
        (
            "leaf",
            MetallicRoughnessInputs {
                diffuse_transmission: 0.6,
                diffuse_transmission_color: PINK,
                transmission: 0.2,
                clearcoat: 0.3,
                ..plastic
            },
        ),
        (
            "all",
            MetallicRoughnessInputs {
                metallic: 0.3,
                clearcoat: 0.5,
                clearcoat_roughness: 0.5,
                sheen_color: 0.5 * GREEN,
                sheen_roughness: 0.7,
                transmission: 0.6,
                is_thin: false,
                anisotropy: 0.5,
                anisotropy_rotation: -1.0,
                ..plastic
            },
        ),
    ];
    let named = |(name, inputs)| (format!("glTF {name}"), MetallicRoughness::new(inputs).into());
    inputs.map(named).into()
}
