//! Materials of old: KHR_materials_pbrSpecularGlossiness, as a dielectric with a colored reflection.

use sr_scene::{ColorInput, MaterialDesc, MetallicRoughnessDesc, Rgb, ScalarInput};

use super::document::Document;
use super::image::Part;
use super::json::Value;
use super::material::Base;
use super::texture::{Sets, rgb};

/// What a dielectric of index 1.5 reflects at a right angle.
const REFLECTANCE: f64 = 0.04;

impl Document<'_, '_> {
    pub fn specular_glossiness(
        &mut self,
        object: &Value,
        has_colors: bool,
        sets: &mut Sets,
    ) -> (Base, MaterialDesc) {
        let message = "KHR_materials_pbrSpecularGlossiness is shown by the metallic-roughness model";
        let instead = "the surface is a dielectric whose reflection has the specular color";
        self.warn_once("gltf::specular-glossiness", &object.span, message, instead);
        let base = self.base(Some(object), "diffuseFactor", "diffuseTexture", has_colors, sets);
        let texture = object.get("specularGlossinessTexture");
        let specular = rgb(self.numbers(object, "specularFactor", [1.0; 3]).map(|v| v / REFLECTANCE));
        let color = texture.and_then(|info| self.texture(info, Part::Color, sets));
        let specular_color = self.product(color, specular, &object.span);
        let glossiness = self.number(object, "glossinessFactor", 1.0) as f32;
        let roughness = match texture {
            Some(info) => {
                let inverse = self.texture(info, Part::Inverse(glossiness.to_bits()), sets);
                self.scalar_product(inverse, 1.0, &object.span)
            }
            None => ScalarInput::Constant((1.0 - glossiness).clamp(0.0, 1.0)),
        };
        let desc = MaterialDesc::MetallicRoughness(MetallicRoughnessDesc {
            base_color: base.color,
            metallic: ScalarInput::Constant(0.0),
            roughness,
            specular: ScalarInput::Constant(1.0),
            specular_color,
            ior: 1.5,
            clearcoat: ScalarInput::Constant(0.0),
            clearcoat_roughness: ScalarInput::Constant(0.0),
            sheen_color: ColorInput::Constant(Rgb::ZERO),
            sheen_roughness: ScalarInput::Constant(0.0),
            transmission: ScalarInput::Constant(0.0),
            thin: true,
            diffuse_transmission: ScalarInput::Constant(0.0),
            diffuse_transmission_color: ColorInput::Constant(Rgb::ONE),
            anisotropy: ScalarInput::Constant(0.0),
            anisotropy_rotation: 0.0,
        });
        (base, desc)
    }
}
