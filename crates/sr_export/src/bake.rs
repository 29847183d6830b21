//! Textures as images: what a format has no words for is looked up texel by texel.

use std::sync::Arc;

use glam::{Affine2, Vec2};
use rayon::prelude::*;
use sr_render::texture::Textures;
use sr_scene::{ColorInput, Filter, Image, Pixels, Rgb, ScalarInput, SceneDesc, TextureDesc, TextureId};

/// Texels along a side that no image made here has more than.
const LARGEST: u32 = 4096;
/// Texels across a square of a checkerboard.
const PER_SQUARE: f32 = 16.0;

/// Looks textures up.
pub struct Baker<'a> {
    scene: &'a SceneDesc,
    textures: Textures,
}

/// A texture as an image over the unit square of (u, v), v = 0 being its top row.
pub struct Baked {
    pub image: Arc<Image>,
    pub filter: Filter,
}

/// A constant times a texture, if there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factored {
    pub factor: Rgb,
    pub texture: Option<TextureId>,
}

impl<'a> Baker<'a> {
    pub fn new(scene: &'a SceneDesc) -> Self {
        Self { scene, textures: Textures::new(&scene.textures, &scene.images) }
    }

    /// The textures to look up in.
    pub fn textures(&self) -> &Textures {
        &self.textures
    }

    /// The mean color.
    pub fn average(&self, input: ColorInput) -> Rgb {
        self.textures.average(input)
    }

    /// The mean number.
    pub fn average_number(&self, input: ScalarInput) -> f32 {
        match input {
            ScalarInput::Constant(value) => value,
            ScalarInput::Texture(id) => luminance(self.average(ColorInput::Texture(id))),
        }
    }

    /// Takes constant factors out of products.
    pub fn factored(&self, input: ColorInput) -> Factored {
        let id = match input {
            ColorInput::Constant(factor) => return Factored { factor, texture: None },
            ColorInput::Texture(id) => id,
        };
        let whole = Factored { factor: Rgb::ONE, texture: Some(id) };
        let Some(TextureDesc::Scale { input, factor, .. }) = self.scene.textures.get(id.0 as usize) else {
            return whole;
        };
        let (a, b) = (self.factored(*input), self.factored(*factor));
        match (a.texture, b.texture) {
            (Some(_), Some(_)) => whole,
            (one, other) => Factored { factor: a.factor * b.factor, texture: one.or(other) },
        }
    }

    /// A function of a color's texture over the unit square.
    pub fn over_unit_square(&self, id: TextureId, of: impl Fn(Rgb) -> Rgb + Sync) -> Baked {
        let (size, has_images) = self.resolution(id);
        let side = |v: f32| (v.ceil().clamp(1.0, LARGEST as f32)) as u32;
        let (width, height) = (side(size.x), side(size.y));
        let texel = |at: u32| {
            let uv = Vec2::new((at % width) as f32 + 0.5, (at / width) as f32 + 0.5)
                / Vec2::new(width as f32, height as f32);
            of(self.textures.color(ColorInput::Texture(id), uv)).to_array()
        };
        let data = (0..width * height).into_par_iter().flat_map_iter(texel).collect();
        let pixels = Pixels::F32 { channels: 3, data };
        let image = Arc::new(Image { name: format!("texture{}", id.0), width, height, pixels });
        Baked { image, filter: if has_images { Filter::Bilinear } else { Filter::Nearest } }
    }

    /// A function of every texel of an image.
    pub fn texels(&self, image: &Image, srgb: bool, of: impl Fn(Rgb) -> Rgb) -> Arc<Image> {
        let pixels = Pixels::F32 {
            channels: 3,
            data: decoded(image, srgb).flat_map(|color| of(color).to_array()).collect(),
        };
        Arc::new(Image { name: image.name.clone(), width: image.width, height: image.height, pixels })
    }

    /// Texels that the unit square of (u, v) should have, and whether images are part of it.
    fn resolution(&self, id: TextureId) -> (Vec2, bool) {
        let of_color = |input: &ColorInput| match input {
            ColorInput::Texture(id) => self.resolution(*id),
            ColorInput::Constant(_) => (Vec2::ONE, false),
        };
        let of_number = |input: &ScalarInput| match input {
            ScalarInput::Texture(id) => self.resolution(*id),
            ScalarInput::Constant(_) => (Vec2::ONE, false),
        };
        let larger = |a: (Vec2, bool), b: (Vec2, bool)| (a.0.max(b.0), a.1 || b.1);
        // Along u and v of the surface.
        let stretched = |to_uv: &Affine2, size: Vec2| {
            let along = |axis: Vec2| (axis * size).abs().max_element();
            Vec2::new(along(to_uv.matrix2.x_axis), along(to_uv.matrix2.y_axis))
        };
        match self.scene.textures.get(id.0 as usize) {
            Some(TextureDesc::Bitmap { image, to_uv, .. }) => {
                let size = self.scene.images.get(*image as usize);
                let size = size.map_or(Vec2::ONE, |i| Vec2::new(i.width as f32, i.height as f32));
                (stretched(to_uv, size), true)
            }
            Some(TextureDesc::Checkerboard { color0, color1, to_uv, .. }) => {
                let own = (stretched(to_uv, Vec2::splat(2.0 * PER_SQUARE)), false);
                larger(own, larger(of_color(color0), of_color(color1)))
            }
            Some(TextureDesc::Scale { input, factor, .. }) => larger(of_color(input), of_color(factor)),
            Some(TextureDesc::Mix { color0, color1, weight, .. }) => {
                larger(of_number(weight), larger(of_color(color0), of_color(color1)))
            }
            Some(TextureDesc::OtherUvs { input, .. }) => of_color(input),
            Some(TextureDesc::MeshColor { .. }) | None => (Vec2::ONE, false),
        }
    }
}

/// The luminance of a linear color.
pub fn luminance(c: Rgb) -> f32 {
    c.dot(Rgb::new(0.2126, 0.7152, 0.0722))
}

/// The texels of an image as linear colors.
pub fn decoded(image: &Image, srgb: bool) -> impl Iterator<Item = Rgb> {
    let count = image.width as usize * image.height as usize;
    (0..count).map(move |at| {
        let value = |c: usize| match &image.pixels {
            Pixels::U8 { channels, data } => {
                let channels = usize::from(*channels);
                let code = data.get(at * channels + c.min(channels - 1)).copied().unwrap_or(0);
                let v = f32::from(code) / 255.0;
                if srgb { from_srgb(v) } else { v }
            }
            Pixels::F32 { channels, data } => {
                let channels = usize::from(*channels);
                data.get(at * channels + c.min(channels - 1)).copied().unwrap_or(0.0)
            }
        };
        Rgb::new(value(0), value(1), value(2))
    })
}

fn from_srgb(v: f32) -> f32 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// The byte that stands for a linear value in sRGB.
pub fn srgb_byte(v: f32) -> u8 {
    let v = v.clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}
