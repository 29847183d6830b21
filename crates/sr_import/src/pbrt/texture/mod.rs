//! Textures: what a name stands for.

mod image;

use std::sync::Arc;

use glam::{Affine2, Vec2};
use sr_scene::{ColorInput, Filter, Image, Pixels, Rgb, ScalarInput, Span, TextureDesc, Wrap};

use super::Reader;
use super::params::{Notes, Params};
use super::support::{TEXTURES, unsupported};
use super::syntax::{Kind, Result, Scanner, Values};
use crate::images::BelowCoat;
use crate::values::shown;
pub use image::{ColorImage, FloatImage};

/// What is shown instead of textures that are not supported.
const STAND_IN: f32 = 0.5;

/// A texture of numbers.
#[derive(Clone, Debug)]
pub enum FloatTexture {
    Constant(f32),
    /// An image, not yet asked for: some want the roots of its numbers.
    Image(FloatImage),
    Other(ColorInput),
}

/// A texture of colors.
#[derive(Clone, Debug)]
pub enum ColorTexture {
    Input(ColorInput),
    /// An image: some want it as it is seen below a coat. The input is there once it was asked for.
    Image(ColorImage, Option<ColorInput>),
}

impl Reader<'_> {
    /// `Texture "name" "float" "imagemap"` and parameters.
    pub(super) fn texture_directive(&mut self, s: &mut Scanner<'_>, mut span: Span) -> Result<()> {
        let name = s.string()?.0.into_owned();
        let (kind, kind_bytes) = s.string()?;
        let (class, class_bytes) = s.string()?;
        span.bytes.end = class_bytes.end;
        let list = s.parameters()?;
        let attributes = self.state.attributes.texture.clone();
        let mut params =
            Params::new(format!("Texture \"{}\"", shown(&class)), span.clone(), list, &attributes);
        let is_new = match &*kind {
            "float" => {
                let texture = self.float_texture(&class, &mut params);
                self.float_textures.insert(name.clone(), texture).is_none()
            }
            "spectrum" | "color" => {
                let texture = match &*class {
                    "imagemap" => match self.color_image(&mut params) {
                        Some(image) => ColorTexture::Image(image, None),
                        None => ColorTexture::Input(ColorInput::Constant(Rgb::splat(STAND_IN))),
                    },
                    _ => ColorTexture::Input(self.color_texture(&class, &mut params)),
                };
                self.color_textures.insert(name.clone(), texture).is_none()
            }
            other => {
                let message = format!("a texture is of \"float\" or \"spectrum\", not \"{}\"", shown(other));
                let span = Span { source: span.source, bytes: kind_bytes };
                self.warn("pbrt::unknown-value", &span, message, "it is ignored");
                return Ok(());
            }
        };
        if !is_new {
            let message = format!("the texture \"{}\" is described twice", shown(&name));
            self.warn("pbrt::duplicate-name", &span, message, "what follows uses the second one");
        }
        params.finish(&mut self.notes());
        Ok(())
    }

    fn float_texture(&mut self, class: &str, params: &mut Params) -> FloatTexture {
        match class {
            "constant" => FloatTexture::Constant(params.float("value").unwrap_or(1.0)),
            "scale" => {
                let scale = self.float_or_texture(params, "scale").unwrap_or(FloatTexture::Constant(1.0));
                let tex = self.float_or_texture(params, "tex").unwrap_or(FloatTexture::Constant(1.0));
                match (tex, scale) {
                    (FloatTexture::Constant(a), FloatTexture::Constant(b)) => FloatTexture::Constant(a * b),
                    (FloatTexture::Image(image), FloatTexture::Constant(factor))
                    | (FloatTexture::Constant(factor), FloatTexture::Image(image)) => {
                        FloatTexture::Image(image.scaled(factor))
                    }
                    (tex, scale) => {
                        let (input, factor) = (self.as_color(tex), self.as_color(scale));
                        let span = params.span.clone();
                        FloatTexture::Other(self.out.add_texture(TextureDesc::Scale { input, factor, span }))
                    }
                }
            }
            "imagemap" => match self.float_image(params) {
                Some(image) => FloatTexture::Image(image),
                None => FloatTexture::Constant(STAND_IN),
            },
            _ => FloatTexture::Other(self.composed(class, params, true)),
        }
    }

    fn color_texture(&mut self, class: &str, params: &mut Params) -> ColorInput {
        match class {
            "constant" => ColorInput::Constant(self.surface_color(params, "value").unwrap_or(Rgb::ONE)),
            "scale" => {
                let factor = self.float_or_texture(params, "scale").unwrap_or(FloatTexture::Constant(1.0));
                let factor = self.as_color(factor);
                let input = self.color_or_texture(params, "tex").unwrap_or(ColorInput::Constant(Rgb::ONE));
                match (input, factor) {
                    (ColorInput::Constant(a), ColorInput::Constant(b)) => ColorInput::Constant(a * b),
                    (input, factor) => {
                        let span = params.span.clone();
                        self.out.add_texture(TextureDesc::Scale { input, factor, span })
                    }
                }
            }
            _ => self.composed(class, params, false),
        }
    }

    /// Textures that are made of others alike for numbers and for colors.
    fn composed(&mut self, class: &str, params: &mut Params, is_float: bool) -> ColorInput {
        let span = params.span.clone();
        let grey = |v: f32| ColorInput::Constant(Rgb::splat(v));
        match class {
            "mix" => {
                let color0 = self.either(params, "tex1", is_float).unwrap_or(grey(0.0));
                let color1 = self.either(params, "tex2", is_float).unwrap_or(grey(1.0));
                let amount = self.float_or_texture(params, "amount").unwrap_or(FloatTexture::Constant(0.5));
                let weight = self.as_share(amount);
                self.out.add_texture(TextureDesc::Mix { color0, color1, weight, span })
            }
            "directionmix" => {
                params.unsupported(&["dir"], "the two are mixed half and half", &mut self.notes());
                let color0 = self.either(params, "tex1", is_float).unwrap_or(grey(0.0));
                let color1 = self.either(params, "tex2", is_float).unwrap_or(grey(1.0));
                self.unsupported_class(class, params, "its two textures are mixed half and half");
                let weight = ScalarInput::Constant(0.5);
                self.out.add_texture(TextureDesc::Mix { color0, color1, weight, span })
            }
            "checkerboard" => {
                let color0 = self.either(params, "tex1", is_float).unwrap_or(grey(1.0));
                let color1 = self.either(params, "tex2", is_float).unwrap_or(grey(0.0));
                if params.integer("dimension") == Some(3) {
                    self.unsupported_class(
                        "checkerboard in space",
                        params,
                        "its colors are mixed half and half",
                    );
                    let weight = ScalarInput::Constant(0.5);
                    return self.out.add_texture(TextureDesc::Mix { color0, color1, weight, span });
                }
                // A square is one unit of pbrt's, and half a unit of ours.
                let to_uv = Affine2::from_scale(Vec2::splat(0.5)) * self.uv_mapping(params);
                params.ignore(&["aamode"]);
                self.out.add_texture(TextureDesc::Checkerboard { color0, color1, to_uv, span })
            }
            "bilerp" => self.bilerp(params, is_float),
            "dots" => {
                let outside = self.either(params, "outside", is_float).unwrap_or(grey(0.0));
                params.use_all();
                self.unsupported_class(class, params, "what is between the dots is everywhere");
                outside
            }
            "marble" => {
                params.use_all();
                self.unsupported_class(class, params, "its mean color is everywhere");
                ColorInput::Constant(Rgb::new(0.82, 0.82, 0.85))
            }
            _ => {
                params.use_all();
                self.unsupported_class(class, params, "the constant 0.5 is used");
                grey(STAND_IN)
            }
        }
    }

    fn unsupported_class(&mut self, class: &str, params: &Params, unknown: &str) {
        let code = "pbrt::unsupported-texture";
        let note = unsupported(TEXTURES, code, &params.span, "a texture", class, unknown);
        self.notes().push(note);
    }

    /// Four colors at the corners of [0, 1]²: an image of 2 × 2 texels, their centers moved to the corners.
    fn bilerp(&mut self, params: &mut Params, is_float: bool) -> ColorInput {
        let mut corner = |reader: &mut Self, name, default| match is_float {
            true => Rgb::splat(params.float(name).unwrap_or(default)),
            false => reader.surface_color(params, name).unwrap_or(Rgb::splat(default)),
        };
        let [v00, v10] = [corner(self, "v00", 0.0), corner(self, "v10", 0.0)];
        let [v01, v11] = [corner(self, "v01", 1.0), corner(self, "v11", 1.0)];
        let data = [v00, v10, v01, v11].iter().flat_map(|c| c.to_array()).collect();
        let pixels = Pixels::F32 { channels: 3, data };
        let image =
            self.out.image_in_memory(&Arc::new(Image { name: "bilerp".into(), width: 2, height: 2, pixels }));
        let to_corners = Affine2::from_scale_angle_translation(Vec2::splat(0.5), 0.0, Vec2::splat(0.25));
        let to_uv = to_corners * self.uv_mapping(params);
        let (filter, wrap, span) = (Filter::Bilinear, Wrap::Clamp, params.span.clone());
        self.out.add_texture(TextureDesc::Bitmap { image, filter, wrap, srgb: false, to_uv, span })
    }

    /// From a surface's (u, v) to pbrt's (s, t).
    fn uv_mapping(&mut self, params: &mut Params) -> Affine2 {
        let mapping =
            params.choice("mapping", &["uv", "spherical", "cylindrical", "planar"], &mut self.notes());
        if mapping != "uv" {
            let message = format!("textures that are mapped by \"{mapping}\" are not supported");
            self.warn(
                "pbrt::unsupported-mapping",
                &params.span,
                message,
                "the surface's own u and v are used",
            );
            params.ignore(&["v1", "v2"]);
        }
        let mut number = |name, default: f32| params.float(name).unwrap_or(default);
        let scale = Vec2::new(number("uscale", 1.0), number("vscale", 1.0));
        let delta = Vec2::new(number("udelta", 0.0), number("vdelta", 0.0));
        Affine2::from_scale_angle_translation(scale, 0.0, delta)
    }

    fn either(&mut self, params: &mut Params, name: &'static str, is_float: bool) -> Option<ColorInput> {
        if is_float {
            return self.float_or_texture(params, name).map(|texture| self.as_color(texture));
        }
        self.color_or_texture(params, name)
    }

    /// A number, or the name of a texture.
    pub(super) fn float_or_texture(
        &mut self,
        params: &mut Params,
        name: &'static str,
    ) -> Option<FloatTexture> {
        if let Some((span, texture)) = texture_name(params, name) {
            let found = self.float_textures.get(&texture).cloned();
            if found.is_none() {
                let message = format!("there is no texture \"{}\" of type \"float\"", shown(&texture));
                let mut notes = Notes { list: self.out.d, said: &mut self.said };
                let known = self.float_textures.keys();
                Self::unresolved(&mut notes, &span, message, &texture, known, "the default is used");
            }
            return found;
        }
        params.float(name).map(FloatTexture::Constant)
    }

    /// A color, or the name of a texture.
    pub(super) fn color_or_texture(&mut self, params: &mut Params, name: &'static str) -> Option<ColorInput> {
        if let Some((span, texture)) = texture_name(params, name) {
            let found = self.color_textures.get(&texture).cloned();
            if found.is_none() {
                let message = format!("there is no texture \"{}\" of type \"spectrum\"", shown(&texture));
                let mut notes = Notes { list: self.out.d, said: &mut self.said };
                let known = self.color_textures.keys();
                Self::unresolved(&mut notes, &span, message, &texture, known, "the default is used");
            }
            return Some(match found? {
                ColorTexture::Input(input) => input,
                ColorTexture::Image(_, Some(input)) => input,
                ColorTexture::Image(image, None) => {
                    let input = self.add_color_image(&image);
                    self.color_textures.insert(texture, ColorTexture::Image(image, Some(input)));
                    input
                }
            });
        }
        self.surface_color(params, name).map(ColorInput::Constant)
    }

    /// The image that `name` names as it is seen below a coat; `None`: it names none, or one whose values are not plain colors.
    pub(super) fn image_below_coat(
        &mut self,
        params: &mut Params,
        name: &'static str,
        coat: BelowCoat,
    ) -> Option<ColorInput> {
        params.find(name, &[Kind::Texture])?;
        let (_, texture) = texture_name(params, name)?;
        let Some(ColorTexture::Image(image, _)) = self.color_textures.get(&texture) else { return None };
        let below = image.below(coat)?;
        Some(self.add_color_image(&below))
    }

    /// Numbers as greys.
    fn as_color(&mut self, texture: FloatTexture) -> ColorInput {
        match texture {
            FloatTexture::Constant(v) => ColorInput::Constant(Rgb::splat(v)),
            FloatTexture::Image(image) => self.add_float_image(&image, false),
            FloatTexture::Other(input) => input,
        }
    }

    /// As an input of a material.
    pub(super) fn as_scalar(&mut self, texture: FloatTexture) -> ScalarInput {
        match self.as_color(texture) {
            ColorInput::Constant(color) => ScalarInput::Constant(color.x),
            ColorInput::Texture(id) => ScalarInput::Texture(id),
        }
    }

    /// As a weight or an opacity, brought into [0, 1].
    pub(super) fn as_share(&mut self, texture: FloatTexture) -> ScalarInput {
        match self.as_scalar(texture) {
            ScalarInput::Constant(v) => ScalarInput::Constant(v.clamp(0.0, 1.0)),
            texture => texture,
        }
    }

    /// The square roots, which make α of pbrt's roughness.
    pub(super) fn as_root(&mut self, texture: FloatTexture, span: &Span) -> ScalarInput {
        match texture {
            FloatTexture::Constant(v) => ScalarInput::Constant(v.max(0.0).sqrt()),
            FloatTexture::Image(image) => match self.add_float_image(&image, true) {
                ColorInput::Texture(id) => ScalarInput::Texture(id),
                ColorInput::Constant(color) => ScalarInput::Constant(color.x),
            },
            FloatTexture::Other(ColorInput::Constant(color)) => {
                ScalarInput::Constant(color.x.max(0.0).sqrt())
            }
            FloatTexture::Other(ColorInput::Texture(id)) => {
                let message = "the roots of a composed texture of roughness are not supported";
                self.warn(
                    "pbrt::roughness",
                    span,
                    message,
                    "its values are used as they are, as if not remapped",
                );
                ScalarInput::Texture(id)
            }
        }
    }
}

/// The name that a `texture` parameter holds.
fn texture_name(params: &mut Params, name: &'static str) -> Option<(Span, String)> {
    let (span, parameter) = params.find(name, &[Kind::Texture])?;
    match &parameter.values {
        Values::Strings(names) => Some((span, names.first()?.clone())),
        _ => None,
    }
}
