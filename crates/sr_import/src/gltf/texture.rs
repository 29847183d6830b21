//! Textures: which image, how it repeats, how its coordinates are moved, and which set of them it takes.

use glam::{Affine2, Mat2, Vec2};
use sr_scene::{ColorInput, Filter, MAX_UV_SETS, Rgb, ScalarInput, Span, TextureDesc, Wrap};

use super::document::Document;
use super::image::{self, Part};
use super::json::Value;

/// The sets of texture coordinates that a material's textures take; the first is that which tangents follow.
#[derive(Clone, Debug)]
pub struct Sets {
    pub used: Vec<usize>,
    /// Does any texture take one?
    pub any: bool,
}

impl Sets {
    /// A material's, of which the first is known: that of its normals, or else of what has a direction, of its base, or of any texture.
    pub fn of(material: &Value) -> Self {
        let directed = [
            &["normalTexture"][..],
            &["extensions", "KHR_materials_clearcoat", "clearcoatNormalTexture"],
            &["extensions", "KHR_materials_anisotropy", "anisotropyTexture"],
            &["pbrMetallicRoughness", "baseColorTexture"],
        ];
        let info =
            directed.into_iter().find_map(|path| material.path(path)).or_else(|| first_texture(material));
        Self { used: vec![info.map_or(0, set_of)], any: false }
    }

    /// Where a set is among those used; `None` if there are too many.
    fn index(&mut self, set: usize) -> Option<u32> {
        self.any = true;
        let known = self.used.iter().position(|&used| used == set);
        let index = known.unwrap_or_else(|| {
            self.used.push(set);
            self.used.len() - 1
        });
        u32::try_from(index).ok().filter(|&index| index < MAX_UV_SETS)
    }
}

/// The set that a reference to a texture names.
fn set_of(info: &Value) -> usize {
    let transform = info.extension("KHR_texture_transform");
    let set = transform.and_then(|t| t.get("texCoord")).or_else(|| info.get("texCoord"));
    set.and_then(Value::index).unwrap_or(0)
}

/// The first reference to a texture in an object.
fn first_texture(object: &Value) -> Option<&Value> {
    let is_texture = |name: &str, value: &Value| name.ends_with("Texture") && value.get("index").is_some();
    let members = || object.members().iter();
    let own = members().find(|(name, value)| is_texture(name, value)).map(|(_, value)| value);
    own.or_else(|| members().find_map(|(_, value)| first_texture(value)))
}

/// Meshes have v upwards, as the frames of normal maps want it; glTF counts it downwards.
const UPRIGHT: Affine2 = Affine2 { matrix2: Mat2::from_cols(Vec2::X, Vec2::NEG_Y), translation: Vec2::Y };

impl Document<'_, '_> {
    /// The index of the image that a reference to a texture shows.
    pub fn image_of(&mut self, info: &Value) -> Option<usize> {
        let texture = self.item("textures", info.get("index")?)?;
        image::source(texture)?.index()
    }

    /// A part of a texture.
    pub fn texture(&mut self, info: &Value, part: Part, sets: &mut Sets) -> Option<ColorInput> {
        let Some(index) = info.get("index") else {
            self.error("gltf::bad-index", &info.span, "the texture has no \"index\"");
            return None;
        };
        let texture = self.item("textures", index)?;
        let Some(source) = image::source(texture) else {
            let consequence = "the texture is left out";
            self.warn(
                "gltf::no-image",
                &texture.span,
                "the texture has no image that can be read",
                consequence,
            );
            return None;
        };
        let image = self.image_part(source.index()?, part)?;
        let (filter, wrap) = self.sampler(texture);
        let transform = info.extension("KHR_texture_transform");
        let set = sets.index(set_of(info)).unwrap_or_else(|| {
            let message = format!("the material's textures take more than {MAX_UV_SETS} sets of coordinates");
            self.warn("gltf::texture-sets", &info.span, message, "this one takes the first");
            0
        });
        let to_uv = transform.map_or(Affine2::IDENTITY, |t| self.uv_transform(t)) * UPRIGHT;
        let srgb = part == Part::Color;
        let span = info.span.clone();
        let input = self.out.add_texture(TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, span });
        if set == 0 {
            return Some(input);
        }
        Some(self.out.add_texture(TextureDesc::OtherUvs { input, set, span: info.span.clone() }))
    }

    /// A rotation of the coordinates counter-clockwise as one sees them, v being downwards, after scaling.
    fn uv_transform(&mut self, transform: &Value) -> Affine2 {
        let offset = self.numbers(transform, "offset", [0.0; 2]).map(|v| v as f32);
        let scale = self.numbers(transform, "scale", [1.0; 2]).map(|v| v as f32);
        let (sin, cos) = (self.number(transform, "rotation", 0.0) as f32).sin_cos();
        let rotation = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
        Affine2::from_mat2_translation(rotation * Mat2::from_diagonal(scale.into()), offset.into())
    }

    fn sampler(&mut self, texture: &Value) -> (Filter, Wrap) {
        let sampler = texture.get("sampler").and_then(|sampler| self.item("samplers", sampler));
        let Some(sampler) = sampler else { return (Filter::Bilinear, Wrap::Repeat) };
        let nearest = sampler.get("magFilter").and_then(Value::index) == Some(9728);
        let wrap = |name| match sampler.get(name).and_then(Value::index) {
            Some(33071) => Wrap::Clamp,
            Some(33648) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let (s, t) = (wrap("wrapS"), wrap("wrapT"));
        if s != t {
            let message = "the texture repeats otherwise along v than along u";
            self.warn("gltf::wrap", &sampler.span, message, "it repeats along both as along u");
        }
        (if nearest { Filter::Nearest } else { Filter::Bilinear }, s)
    }

    /// A number times a channel of a texture.
    pub fn scalar(
        &mut self,
        object: Option<&Value>,
        (factor, default): (&str, f64),
        (texture, part): (&str, Part),
        sets: &mut Sets,
    ) -> ScalarInput {
        let Some(object) = object else { return ScalarInput::Constant(default as f32) };
        let factor = self.number(object, factor, default) as f32;
        let texture = object.get(texture).filter(|_| factor != 0.0);
        let texture = texture.and_then(|info| self.texture(info, part, sets));
        self.scalar_product(texture, factor, &object.span)
    }

    pub fn scalar_product(&mut self, texture: Option<ColorInput>, factor: f32, span: &Span) -> ScalarInput {
        match self.product(texture, Rgb::splat(factor), span) {
            ColorInput::Constant(color) => ScalarInput::Constant(color.x),
            ColorInput::Texture(texture) => ScalarInput::Texture(texture),
        }
    }

    /// A color times one of a texture.
    pub fn color(
        &mut self,
        object: Option<&Value>,
        (factor, default): (&str, f64),
        texture: &str,
        sets: &mut Sets,
    ) -> ColorInput {
        let Some(object) = object else { return ColorInput::Constant(Rgb::splat(default as f32)) };
        let factor = rgb(self.numbers(object, factor, [default; 3]));
        let texture = object.get(texture).filter(|_| factor != Rgb::ZERO);
        let texture = texture.and_then(|info| self.texture(info, Part::Color, sets));
        self.product(texture, factor, &object.span)
    }

    /// What there is of a texture, times a factor.
    pub fn product(&mut self, texture: Option<ColorInput>, factor: Rgb, span: &Span) -> ColorInput {
        match texture {
            None => ColorInput::Constant(factor),
            Some(input) if factor == Rgb::ONE => input,
            Some(ColorInput::Constant(color)) => ColorInput::Constant(color * factor),
            Some(input) => {
                let factor = ColorInput::Constant(factor);
                self.out.add_texture(TextureDesc::Scale { input, factor, span: span.clone() })
            }
        }
    }
}

pub fn rgb(numbers: [f64; 3]) -> Rgb {
    Rgb::from_array(numbers.map(|v| v as f32))
}
