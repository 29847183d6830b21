//! What several formats ask of materials.

use sr_scene::{
    ColorInput, Geometry, HairDesc, MaterialDesc, MaterialId, Rgb, ScalarInput, SceneDesc, TextureId,
};

/// The reflectance at a right angle of a metal of the complex index η + i k.
pub fn normal_reflectance(eta: Rgb, k: Rgb) -> Rgb {
    let k2 = k * k;
    let (less, more) = (eta - 1.0, eta + 1.0);
    (less * less + k2) / (more * more + k2)
}

/// Does light pass through a material, holes not counted?
pub fn transmits(scene: &SceneDesc, id: MaterialId) -> bool {
    match scene.materials.get(id.0 as usize) {
        Some(
            MaterialDesc::Dielectric { .. }
            | MaterialDesc::ThinDielectric { .. }
            | MaterialDesc::RoughDielectric { .. }
            | MaterialDesc::DiffuseTransmission { .. }
            | MaterialDesc::PrincipledThin(_)
            | MaterialDesc::Hair(_)
            | MaterialDesc::Mask { .. },
        ) => true,
        Some(MaterialDesc::Principled(p)) => p.spec_trans != ScalarInput::Constant(0.0),
        Some(MaterialDesc::MetallicRoughness(m)) => {
            [m.transmission, m.diffuse_transmission].iter().any(|part| *part != ScalarInput::Constant(0.0))
        }
        Some(other) => other.materials().into_iter().any(|inner| transmits(scene, inner)),
        None => false,
    }
}

/// Does a material, or what it is made of, have a texture?
pub fn has_texture(scene: &SceneDesc, id: MaterialId) -> bool {
    let Some(desc) = scene.materials.get(id.0 as usize) else { return false };
    !desc.textures().is_empty() || desc.materials().into_iter().any(|inner| has_texture(scene, inner))
}

/// Is it this number everywhere?
pub fn is(input: ScalarInput, value: f32) -> bool {
    input == ScalarInput::Constant(value)
}

/// Is it white everywhere?
pub fn is_white(input: ColorInput) -> bool {
    input == ColorInput::Constant(Rgb::ONE)
}

/// The texture of a number.
pub fn texture_of(input: ScalarInput) -> Option<TextureId> {
    input.into()
}

/// Does a shape that is no curves have this hair, whose fibres run another way where a format has them along u (`along_u`)
/// or across it? On curves they run along the curve in all formats.
pub fn turns(scene: &SceneDesc, hair: &HairDesc, along_u: bool) -> bool {
    fn holds(scene: &SceneDesc, id: MaterialId, hair: &HairDesc) -> bool {
        match scene.materials.get(id.0 as usize) {
            Some(MaterialDesc::Hair(found)) => found == hair,
            Some(other) => other.materials().into_iter().any(|inner| holds(scene, inner, hair)),
            None => false,
        }
    }
    let mut shapes = scene.shapes.iter().chain(scene.groups.iter().flat_map(|group| &group.shapes));
    hair.along_u != along_u
        && shapes
            .any(|shape| !matches!(shape.geometry, Geometry::Curves(_)) && holds(scene, shape.material, hair))
}
