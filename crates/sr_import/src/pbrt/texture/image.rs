//! Textures of images.

use glam::{Affine2, Vec2};
use sr_scene::{ColorInput, Filter, Rgb, Span, TextureDesc, Wrap};

use crate::images::{BelowCoat, Decode, Encoding, TexelMap};
use crate::pbrt::Reader;
use crate::pbrt::params::Params;

/// An image of numbers, not yet asked for.
#[derive(Clone, Debug)]
pub struct FloatImage {
    file: String,
    map: TexelMap,
    place: Place,
    span: Span,
}

impl FloatImage {
    /// Its numbers times another one.
    pub fn scaled(mut self, factor: f32) -> Self {
        self.map = self.map.scaled(factor);
        self
    }
}

/// An image of colors, not yet asked for.
#[derive(Clone, Debug)]
pub struct ColorImage {
    file: String,
    decode: Decode,
    srgb: bool,
    place: Place,
    scale: f32,
    span: Span,
}

impl ColorImage {
    /// The same below a coat; `None`: its values are not plain colors.
    pub fn below(&self, coat: BelowCoat) -> Option<Self> {
        let is_plain = self.decode == Decode::Color && self.scale == 1.0;
        is_plain.then(|| Self { decode: Decode::BelowCoat(coat), ..self.clone() })
    }
}

/// How an image lies on a surface.
#[derive(Clone, Copy, Debug)]
struct Place {
    filter: Filter,
    wrap: Wrap,
    to_uv: Affine2,
}

impl Reader<'_> {
    pub(super) fn float_image(&mut self, params: &mut Params) -> Option<FloatImage> {
        let place = self.place(params);
        let (scale, invert) = scale_and_invert(params);
        let (span, file) = self.image_name(params)?;
        let encoding = self.encoding(params, &file);
        let map = TexelMap::new(encoding, true).scaled(scale).inverted(invert);
        Some(FloatImage { file, map, place, span })
    }

    pub(super) fn add_float_image(&mut self, image: &FloatImage, roots: bool) -> ColorInput {
        let decode = Decode::Texels(if roots { image.map.rooted() } else { image.map });
        let index = self.out.image_file(&image.file, decode, &image.span);
        let Place { filter, wrap, to_uv } = image.place;
        let span = image.span.clone();
        self.out.add_texture(TextureDesc::Bitmap { image: index, filter, wrap, srgb: false, to_uv, span })
    }

    pub(super) fn color_image(&mut self, params: &mut Params) -> Option<ColorImage> {
        let place = self.place(params);
        let (scale, invert) = scale_and_invert(params);
        let (span, file) = self.image_name(params)?;
        let encoding = self.encoding(params, &file);
        let (decode, srgb) = match encoding {
            _ if invert => {
                (Decode::Texels(TexelMap::new(encoding, false).scaled(scale).inverted(true)), false)
            }
            Encoding::Srgb => (Decode::Color, true),
            Encoding::Linear => (Decode::Raw, false),
            Encoding::Gamma(_) => (Decode::Texels(TexelMap::new(encoding, false)), false),
        };
        let scale = if invert { 1.0 } else { scale };
        Some(ColorImage { file, decode, srgb, place, scale, span })
    }

    pub(super) fn add_color_image(&mut self, image: &ColorImage) -> ColorInput {
        let index = self.out.image_file(&image.file, image.decode, &image.span);
        let Place { filter, wrap, to_uv } = image.place;
        let (srgb, span) = (image.srgb, image.span.clone());
        let input =
            self.out.add_texture(TextureDesc::Bitmap { image: index, filter, wrap, srgb, to_uv, span });
        if image.scale == 1.0 {
            return input;
        }
        let (factor, span) = (ColorInput::Constant(Rgb::splat(image.scale)), image.span.clone());
        self.out.add_texture(TextureDesc::Scale { input, factor, span })
    }

    pub(in crate::pbrt) fn image_name(&mut self, params: &mut Params) -> Option<(Span, String)> {
        let found = params.string("filename").filter(|(_, name)| !name.is_empty());
        if found.is_none() {
            let message = format!("{} needs a \"filename\"", params.title);
            self.warn("pbrt::missing-parameter", &params.span, message, "the constant 0.5 is used");
        }
        found
    }

    fn place(&mut self, params: &mut Params) -> Place {
        let known = ["bilinear", "point", "trilinear", "ewa", "EWA"];
        let filter = match params.choice("filter", &known, &mut self.notes()) {
            "point" => Filter::Nearest,
            // Mipmaps stand for the mean over what a sample sees, which is a quarter of a pixel and less in pbrt: the mean of a
            // pixel's samples, without the blur.
            _ => Filter::Bilinear,
        };
        let wrap =
            match params.choice("wrap", &["repeat", "clamp", "black", "octahedralsphere"], &mut self.notes())
            {
                "repeat" => Wrap::Repeat,
                "clamp" => Wrap::Clamp,
                other => {
                    let message = format!("\"{other}\" around an image is not supported");
                    self.warn("pbrt::unsupported-wrap", &params.span, message, "the border texels continue");
                    Wrap::Clamp
                }
            };
        // As far as it is seen at a grazing angle; other names are of older files.
        params.ignore(&["maxanisotropy", "trilinear"]);
        // t counts from the bottom row.
        let from_top = Affine2::from_scale_angle_translation(Vec2::new(1.0, -1.0), 0.0, Vec2::Y);
        Place { filter, wrap, to_uv: from_top * self.uv_mapping(params) }
    }

    /// How 8-bit values are to be read. pbrt asks only for PNG files; others are sRGB.
    fn encoding(&mut self, params: &mut Params, file: &str) -> Encoding {
        let Some((span, text)) = params.string("encoding") else { return Encoding::Srgb };
        let gamma = text.strip_prefix("gamma").and_then(|rest| rest.trim().parse::<f32>().ok());
        let encoding = match (&*text, gamma) {
            ("sRGB" | "srgb", _) => Encoding::Srgb,
            ("linear", _) => Encoding::Linear,
            (_, Some(gamma)) if gamma > 0.0 && gamma.is_finite() => Encoding::gamma(gamma),
            _ => {
                let message = format!("\"{}\" is not an encoding that is known", crate::values::shown(&text));
                self.warn("pbrt::unknown-value", &span, message, "sRGB is used");
                Encoding::Srgb
            }
        };
        let is_png = file.to_ascii_lowercase().ends_with(".png");
        if is_png { encoding } else { Encoding::Srgb }
    }
}

fn scale_and_invert(params: &mut Params) -> (f32, bool) {
    (params.float("scale").unwrap_or(1.0), params.boolean("invert").unwrap_or(false))
}
