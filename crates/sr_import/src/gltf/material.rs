//! Materials: the metallic-roughness model with its extensions, what covers it, and what it emits.

use sr_scene::{
    ColorInput, Emission, MaterialDesc, MaterialId, MeshColorOf, MetallicRoughnessDesc, Rgb, ScalarInput,
    Span, TextureDesc, Tilting,
};

use super::document::Document;
use super::image::Part;
use super::json::Value;
use super::texture::{Sets, rgb};

/// A material of the file, none being the default one; and has the mesh colors?
pub type Key = (Option<usize>, bool);

/// What a primitive is covered with.
#[derive(Clone)]
pub struct Surface {
    pub material: MaterialId,
    pub emission: Option<Emission>,
    /// The sets of texture coordinates that its textures take.
    pub sets: Sets,
}

/// What an object of the file says about the base of its surface.
pub struct Base {
    /// Factor and texture, alpha not counted.
    pub color: ColorInput,
    /// Red, green, blue and alpha.
    pub factor: [f64; 4],
    /// Where alpha comes from besides.
    pub texture: Option<usize>,
}

impl Document<'_, '_> {
    /// The surface of a primitive.
    pub fn surface(&mut self, material: Option<&Value>, has_colors: bool) -> Surface {
        let key = (material.and_then(Value::index), has_colors);
        if let Some(known) = self.materials.get(&key) {
            return known.clone();
        }
        let found = material.and_then(|index| self.item("materials", index));
        let nothing = Value { kind: super::json::Kind::Null, span: Span::default() };
        let surface = self.make_surface(found.unwrap_or(&nothing), has_colors);
        self.materials.insert(key, surface.clone());
        surface
    }

    fn make_surface(&mut self, material: &Value, has_colors: bool) -> Surface {
        let span = &material.span;
        let mut sets = Sets::of(material);
        let old = material.extension("KHR_materials_pbrSpecularGlossiness");
        let (base, desc) = match old {
            Some(old) => self.specular_glossiness(old, has_colors, &mut sets),
            None => self.metallic_roughness(material, has_colors, &mut sets),
        };
        let unlit = material.extension("KHR_materials_unlit");
        let (mut desc, emission) = match unlit {
            Some(unlit) => {
                let message = "an unlit surface emits its color to its front and reflects nothing";
                self.warn("gltf::unlit", &unlit.span, message, "it also shines on what is around it");
                let color = if has_colors { self.product(None, factor_of(&base), span) } else { base.color };
                (MaterialDesc::Diffuse { reflectance: ColorInput::Constant(Rgb::ZERO) }, Some(color))
            }
            None => (desc, self.emission(material, &mut sets)),
        };
        let transmits = matches!(
            &desc,
            MaterialDesc::MetallicRoughness(m)
                if [m.transmission, m.diffuse_transmission].iter().any(|part| *part != ScalarInput::Constant(0.0))
        );
        if let Some(info) = material.get("normalTexture") {
            let scale = self.number(info, "scale", 1.0) as f32;
            if let Some(normal) = self.texture(info, Part::Normal(scale.to_bits()), &mut sets) {
                let inner = self.out.add_material(desc, span);
                let tilting = Tilting { along_v: true, ..Tilting::default() };
                desc = MaterialDesc::NormalMap { normal, tilting, inner };
            }
        }
        let mut id = self.out.add_material(desc, span);
        if !transmits {
            id = self.out.add_material(MaterialDesc::TwoSided { front: id, back: id }, span);
        }
        if let Some(opacity) = self.opacity(material, &base, &mut sets) {
            id = self.out.add_material(MaterialDesc::Mask { opacity, inner: id }, span);
        }
        Surface { material: id, emission: emission.map(|radiance| Emission { radiance }), sets }
    }

    fn metallic_roughness(
        &mut self,
        material: &Value,
        has_colors: bool,
        sets: &mut Sets,
    ) -> (Base, MaterialDesc) {
        let pbr = material.get("pbrMetallicRoughness");
        let mut base = self.base(pbr, "baseColorFactor", "baseColorTexture", has_colors, sets);
        let metallic_roughness = "metallicRoughnessTexture";
        let metallic =
            self.scalar(pbr, ("metallicFactor", 1.0), (metallic_roughness, Part::Channel(2)), sets);
        let roughness =
            self.scalar(pbr, ("roughnessFactor", 1.0), (metallic_roughness, Part::Channel(1)), sets);
        let specular = material.extension("KHR_materials_specular");
        let clearcoat = material.extension("KHR_materials_clearcoat");
        let sheen = material.extension("KHR_materials_sheen");
        let transmission = material.extension("KHR_materials_transmission");
        let channel = Part::Channel;
        if let Some(coat) =
            clearcoat.filter(|coat| coat.get("clearcoatFactor").is_some_and(|f| f.number() != Some(0.0)))
        {
            let (own, base) = (coat.get("clearcoatNormalTexture"), material.get("normalTexture"));
            if own.map(normal_map) != base.map(normal_map) {
                let message = "a coat has no normals of its own";
                let span = own.map_or(&coat.span, |own| &own.span);
                self.warn("gltf::clearcoat-normal", span, message, "those of the base are used");
            }
        }
        let thin = match material.extension("KHR_materials_volume") {
            Some(volume) => {
                let tint = self.attenuation(volume);
                base.color = self.product(Some(base.color), tint, &volume.span);
                self.number(volume, "thicknessFactor", 0.0) == 0.0
            }
            None => true,
        };
        let (anisotropy, anisotropy_rotation) = self.anisotropy(material, sets);
        let leaf = material.extension("KHR_materials_diffuse_transmission");
        let factor = ("diffuseTransmissionFactor", 0.0);
        let diffuse_transmission =
            self.scalar(leaf, factor, ("diffuseTransmissionTexture", channel(3)), sets);
        let factor = ("diffuseTransmissionColorFactor", 1.0);
        let diffuse_transmission_color = self.color(leaf, factor, "diffuseTransmissionColorTexture", sets);
        if let (Some(leaf), false) = (leaf, thin || diffuse_transmission == ScalarInput::Constant(0.0)) {
            let message = "light is not scattered inside bodies";
            self.warn("gltf::diffuse-body", &leaf.span, message, "their surfaces are thin sheets");
        }
        let thin = thin || diffuse_transmission != ScalarInput::Constant(0.0);
        let desc = MaterialDesc::MetallicRoughness(MetallicRoughnessDesc {
            base_color: base.color,
            metallic,
            roughness,
            specular: self.scalar(specular, ("specularFactor", 1.0), ("specularTexture", channel(3)), sets),
            specular_color: self.color(specular, ("specularColorFactor", 1.0), "specularColorTexture", sets),
            ior: self.ior(material),
            clearcoat: self.scalar(
                clearcoat,
                ("clearcoatFactor", 0.0),
                ("clearcoatTexture", channel(0)),
                sets,
            ),
            clearcoat_roughness: self.scalar(
                clearcoat,
                ("clearcoatRoughnessFactor", 0.0),
                ("clearcoatRoughnessTexture", channel(1)),
                sets,
            ),
            sheen_color: self.color(sheen, ("sheenColorFactor", 0.0), "sheenColorTexture", sets),
            sheen_roughness: self.scalar(
                sheen,
                ("sheenRoughnessFactor", 0.0),
                ("sheenRoughnessTexture", channel(3)),
                sets,
            ),
            transmission: self.scalar(
                transmission,
                ("transmissionFactor", 0.0),
                ("transmissionTexture", channel(0)),
                sets,
            ),
            thin,
            diffuse_transmission,
            diffuse_transmission_color,
            anisotropy,
            anisotropy_rotation,
        });
        (base, desc)
    }

    /// The color of a base: a factor, a texture, and the colors of the mesh.
    pub fn base(
        &mut self,
        object: Option<&Value>,
        factor: &str,
        texture: &str,
        has_colors: bool,
        sets: &mut Sets,
    ) -> Base {
        let numbers = object.map_or([1.0; 4], |object| self.numbers(object, factor, [1.0; 4]));
        let info = object.and_then(|object| object.get(texture));
        let span = object.map(|object| object.span.clone()).unwrap_or_default();
        let image = info.and_then(|info| self.texture(info, Part::Color, sets));
        let [r, g, b, _] = numbers;
        let mut color = self.product(image, rgb([r, g, b]), &span);
        if has_colors {
            let of = MeshColorOf::Vertices;
            let input = self.out.add_texture(TextureDesc::MeshColor { of, scale: 1.0, span: span.clone() });
            color = match color {
                ColorInput::Constant(factor) => self.product(Some(input), factor, &span),
                factor => self.out.add_texture(TextureDesc::Scale { input, factor, span }),
            };
        }
        Base { color, factor: numbers, texture: info.and_then(|info| self.image_of(info)) }
    }

    /// What passes where a surface has holes or is clear; nothing if it is opaque.
    fn opacity(&mut self, material: &Value, base: &Base, sets: &mut Sets) -> Option<ScalarInput> {
        let mode = material.get("alphaMode").and_then(Value::text).unwrap_or("OPAQUE");
        let factor = base.factor[3] as f32;
        let part = match mode {
            "MASK" => {
                let cutoff = self.number(material, "alphaCutoff", 0.5) as f32;
                if !base.texture.is_some_and(|index| self.has_alpha(index)) {
                    return (factor < cutoff).then_some(ScalarInput::Constant(0.0));
                }
                Part::AtLeast { cutoff: cutoff.to_bits(), factor: factor.to_bits() }
            }
            "BLEND" if base.texture.is_some_and(|index| self.has_alpha(index)) => Part::Channel(3),
            "BLEND" => return (factor < 1.0).then_some(ScalarInput::Constant(factor.max(0.0))),
            _ => return None,
        };
        let old = ["extensions", "KHR_materials_pbrSpecularGlossiness", "diffuseTexture"];
        let info =
            material.path(&old).or_else(|| material.path(&["pbrMetallicRoughness", "baseColorTexture"]))?;
        let texture = self.texture(info, part, sets)?;
        let factor = if mode == "MASK" { 1.0 } else { factor };
        Some(self.scalar_product(Some(texture), factor, &material.span))
    }

    /// What the front emits.
    fn emission(&mut self, material: &Value, sets: &mut Sets) -> Option<ColorInput> {
        let strength = material.extension("KHR_materials_emissive_strength");
        let strength = strength.map_or(1.0, |s| self.number(s, "emissiveStrength", 1.0));
        let factor = rgb(self.numbers(material, "emissiveFactor", [0.0; 3]).map(|v| v * strength));
        if factor == Rgb::ZERO {
            return None;
        }
        self.strong_emission |= strength > 1.0;
        if material.get("doubleSided").is_some_and(Value::is_true) {
            let message = "a surface emits from its front alone";
            self.warn("gltf::two-sided-emission", &material.span, message, "its back is dark");
        }
        let texture = material.get("emissiveTexture");
        let texture = texture.and_then(|info| self.texture(info, Part::Color, sets));
        Some(self.product(texture, factor, &material.span))
    }

    fn ior(&mut self, material: &Value) -> f32 {
        let Some(object) = material.extension("KHR_materials_ior") else { return 1.5 };
        let ior = self.number(object, "ior", 1.5) as f32;
        if ior >= 1.0 {
            return ior;
        }
        let message = format!("an index of refraction of {ior} is less than 1");
        self.warn("gltf::ior", &object.span, message, "1.5 is used");
        1.5
    }

    /// What a body's two surfaces take from the light instead of the body between them, each the root of it.
    fn attenuation(&mut self, volume: &Value) -> Rgb {
        let thickness = self.number(volume, "thicknessFactor", 0.0) as f32;
        let distance = self.number(volume, "attenuationDistance", f64::INFINITY) as f32;
        let color = rgb(self.numbers(volume, "attenuationColor", [1.0; 3]));
        if thickness <= 0.0 || color == Rgb::ONE || !distance.is_finite() || distance <= 0.0 {
            return Rgb::ONE;
        }
        let message = "light is not attenuated inside bodies yet";
        let instead = "their surfaces are colored as the stated thickness would color the light";
        self.warn_once("gltf::attenuation", &volume.span, message, instead);
        color.clamp(Rgb::ZERO, Rgb::ONE).powf(0.5 * thickness / distance)
    }

    /// Strength, and the direction from the tangent in radians.
    fn anisotropy(&mut self, material: &Value, sets: &mut Sets) -> (ScalarInput, f32) {
        let object = material.extension("KHR_materials_anisotropy");
        let strength =
            self.scalar(object, ("anisotropyStrength", 0.0), ("anisotropyTexture", Part::Channel(2)), sets);
        let Some(object) = object else { return (strength, 0.0) };
        let mut rotation = self.number(object, "anisotropyRotation", 0.0) as f32;
        let texture = object.get("anisotropyTexture");
        let image = texture.and_then(|info| self.image_of(info));
        if let (Some(texture), Some((mean, uniform))) =
            (texture, image.and_then(|image| self.images.mean_direction(image)))
        {
            rotation += mean;
            if !uniform {
                let message = "the direction of an anisotropy cannot vary over a surface";
                self.warn("gltf::anisotropy", &texture.span, message, "its mean is used");
            }
        }
        (strength, rotation)
    }
}

/// What a reference to a normal map says: which texture, how strong, by which coordinates.
fn normal_map(info: &Value) -> (Option<usize>, f64, Option<usize>, bool) {
    let number = |name: &str| info.get(name).and_then(Value::index);
    let scale = info.get("scale").and_then(Value::number).unwrap_or(1.0);
    let is_moved = info.extension("KHR_texture_transform").is_some();
    (number("index"), scale, number("texCoord").filter(|set| *set > 0), is_moved)
}

pub fn factor_of(base: &Base) -> Rgb {
    let [r, g, b, _] = base.factor;
    rgb([r, g, b])
}
