//! Textures: an image as PNG, how it repeats, and how its coordinates are moved.

use std::sync::Arc;

use glam::{Affine2, Mat2, Vec2};
use sr_scene::{ColorInput, Filter, Image, Pixels, Rgb, Span, TextureDesc, TextureId, Wrap};

use super::json::Json;
use super::{Writer, uri};
use crate::bake::{decoded, luminance, srgb_byte};
use crate::pictures::write_png;

/// From glTF's texture coordinates, whose v is counted downwards, to ours, and back.
const UPRIGHT: Affine2 = Affine2 { matrix2: Mat2::from_cols(Vec2::X, Vec2::NEG_Y), translation: Vec2::Y };

/// An image with its place on a surface.
#[derive(Clone)]
pub(super) struct Placed {
    image: Arc<Image>,
    srgb: bool,
    filter: Filter,
    wrap: Wrap,
    to_uv: Affine2,
    /// Of texture coordinates.
    set: u32,
}

/// What the channels of an image are made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Channels {
    /// A color, sRGB-encoded; and the texture of its opacity.
    Color(Option<TextureId>),
    /// White, and an opacity.
    Opacity,
    /// A color as it is: normals.
    Linear,
    /// Numbers in green (roughness) and blue (metal); 1 where there is no texture.
    GreenBlue(Option<TextureId>, Option<TextureId>),
    /// A number in one channel.
    One(usize),
}

impl Writer<'_> {
    /// A reference to a texture of colors, or of what `channels` says; `None` if there is no such texture.
    pub(super) fn texture(&mut self, id: TextureId, channels: Channels, span: &Span) -> Json {
        let key = format!("{id:?} {channels:?}");
        let parts: Vec<TextureId> = match channels {
            Channels::Color(opacity) => [Some(id), opacity].into_iter().flatten().collect(),
            Channels::GreenBlue(green, blue) => [green, blue].into_iter().flatten().collect(),
            Channels::Linear | Channels::Opacity | Channels::One(_) => vec![id],
        };
        let placed: Vec<Option<Placed>> = parts.iter().map(|part| self.placed(*part)).collect();
        let first = placed.first().cloned().flatten();
        let is_alike = |other: &Option<Placed>| match (&first, other) {
            (Some(a), Some(b)) => {
                a.to_uv == b.to_uv
                    && a.set == b.set
                    && a.wrap == b.wrap
                    && (a.image.width, a.image.height) == (b.image.width, b.image.height)
            }
            _ => false,
        };
        let place = match first.clone().filter(|_| placed.iter().all(is_alike)) {
            Some(place) if transform(place.to_uv).is_some() => place,
            _ => return self.baked(&key, &parts, channels, span),
        };
        if placed.iter().flatten().any(|part| matches!(part.image.pixels, Pixels::F32 { .. })) {
            self.say_eight_bits(span);
        }
        let texels = |at: usize| -> Vec<Rgb> {
            let part = placed.get(at).and_then(Option::as_ref);
            part.map_or_else(Vec::new, |part| decoded(&part.image, part.srgb).collect())
        };
        let size = (place.image.width, place.image.height);
        let colors: Vec<Vec<Rgb>> = (0..parts.len()).map(texels).collect();
        let index = self.image_texture(&key, size, &colors, channels, (place.filter, place.wrap));
        let mut info = vec![("index", Json::Integer(index))];
        if place.set > 0 {
            info.push(("texCoord", Json::Integer(place.set as usize)));
        }
        if let Some(transform) = transform(place.to_uv).filter(|list| !list.is_empty()) {
            self.extensions.insert("KHR_texture_transform");
            let transform = ("KHR_texture_transform", Json::Object(transform));
            info.push(("extensions", Json::Object(vec![transform])));
        }
        Json::Object(info)
    }

    /// The image of a texture that is one, perhaps times a factor that is taken care of elsewhere.
    fn placed(&self, id: TextureId) -> Option<Placed> {
        match self.scene.textures.get(id.0 as usize)? {
            TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, .. } => Some(Placed {
                image: self.scene.images.get(*image as usize)?.clone(),
                srgb: *srgb,
                filter: *filter,
                wrap: *wrap,
                to_uv: *to_uv,
                set: 0,
            }),
            TextureDesc::OtherUvs { input: ColorInput::Texture(input), set, .. } => {
                self.placed(*input).map(|placed| Placed { set: *set, ..placed })
            }
            _ => None,
        }
    }

    fn say_eight_bits(&mut self, span: &Span) {
        let message = "glTF's images have eight bits, from 0 to 1";
        self.notes.push("convert::eight-bits", span, message, "values are rounded, and cut at 1");
    }

    fn baked(&mut self, key: &str, parts: &[TextureId], channels: Channels, span: &Span) -> Json {
        let first: Vec<_> = parts.iter().map(|part| self.baker.over_unit_square(*part, |c| c)).collect();
        let (width, height) = first
            .iter()
            .fold((1, 1), |size, baked| (size.0.max(baked.image.width), size.1.max(baked.image.height)));
        let resized = |baked: &crate::bake::Baked| -> Vec<Rgb> {
            let colors: Vec<Rgb> = decoded(&baked.image, false).collect();
            let (w, h) = (baked.image.width as usize, baked.image.height as usize);
            let nearest =
                |at: u32, of: u32, size: usize| (at as usize * size / of.max(1) as usize).min(size - 1);
            (0..width * height)
                .map(|at| {
                    let (x, y) = (nearest(at % width, width, w), nearest(at / width, height, h));
                    colors.get(y * w + x).copied().unwrap_or_default()
                })
                .collect()
        };
        let colors: Vec<Vec<Rgb>> = first.iter().map(resized).collect();
        if colors.iter().flatten().any(|color| color.max_element() > 1.0) {
            self.say_eight_bits(span);
        }
        let filter = first.first().map_or(Filter::Bilinear, |baked| baked.filter);
        let message = "glTF's textures are images";
        let instead =
            format!("one of {width} × {height} texels is written, repeated for each unit of u and v");
        self.notes.push("convert::texture-as-image", span, message, instead);
        let index = self.image_texture(key, (width, height), &colors, channels, (filter, Wrap::Repeat));
        // v is counted from the other end.
        let mut info = vec![("index", Json::Integer(index))];
        if let Some(transform) = transform(Affine2::IDENTITY) {
            self.extensions.insert("KHR_texture_transform");
            let transform = ("KHR_texture_transform", Json::Object(transform));
            info.push(("extensions", Json::Object(vec![transform])));
        }
        Json::Object(info)
    }

    /// The index of a texture of these texels, one list for each part.
    fn image_texture(
        &mut self,
        key: &str,
        (width, height): (u32, u32),
        parts: &[Vec<Rgb>],
        channels: Channels,
        (filter, wrap): (Filter, Wrap),
    ) -> usize {
        if let Some(&known) = self.known_textures.get(key) {
            return known;
        }
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        let texel = |part: usize, at: usize| parts.get(part).and_then(|list| list.get(at)).copied();
        let count = width as usize * height as usize;
        let mut codes = Vec::with_capacity(4 * count);
        for at in 0..count {
            let first = texel(0, at).unwrap_or_default();
            match channels {
                Channels::Color(opacity) => {
                    codes.extend(first.to_array().map(srgb_byte));
                    codes.extend(opacity.map(|_| byte(texel(1, at).map_or(1.0, luminance))));
                }
                Channels::Opacity => codes.extend([255, 255, 255, byte(luminance(first))]),
                Channels::Linear => codes.extend(first.to_array().map(byte)),
                Channels::GreenBlue(green, blue) => {
                    let second = if green.is_some() { texel(1, at) } else { Some(first) };
                    let green = green.map_or(255, |_| byte(luminance(first)));
                    let blue = blue.map_or(255, |_| byte(second.map_or(1.0, luminance)));
                    codes.extend([0, green, blue]);
                }
                Channels::One(channel) => {
                    let mut texel = [0, 0, 0, 255];
                    texel[channel.min(3)] = byte(luminance(first));
                    codes.extend(texel);
                }
            }
        }
        let color = if codes.len() == 4 * count { png::ColorType::Rgba } else { png::ColorType::Rgb };
        let mut bytes = Vec::new();
        // Writing to memory does not fail but for sizes that no image has.
        let written = write_png(width, height, color, &codes, &mut bytes);
        debug_assert!(written.is_ok());
        let image = match self.is_binary {
            true => {
                let view = self.buffer.view(bytes, None);
                vec![("bufferView", Json::Integer(view)), ("mimeType", Json::text("image/png"))]
            }
            false => {
                let file = self.files.bytes_in_folder("image", "", "png", bytes);
                vec![("uri", Json::Text(uri(&file)))]
            }
        };
        self.images.push(Json::Object(image));
        let (mag, min) = match filter {
            Filter::Nearest => (9728, 9728),
            Filter::Bilinear => (9729, 9729),
            Filter::Mipmap => (9729, 9987),
        };
        let wrap = match wrap {
            Wrap::Repeat => 10497,
            Wrap::Mirror => 33648,
            Wrap::Clamp => 33071,
        };
        self.samplers.push(Json::Object(vec![
            ("magFilter", Json::Integer(mag)),
            ("minFilter", Json::Integer(min)),
            ("wrapS", Json::Integer(wrap)),
            ("wrapT", Json::Integer(wrap)),
        ]));
        self.textures.push(Json::Object(vec![
            ("sampler", Json::Integer(self.samplers.len() - 1)),
            ("source", Json::Integer(self.images.len() - 1)),
        ]));
        self.known_textures.insert(key.to_owned(), self.textures.len() - 1);
        self.textures.len() - 1
    }
}

/// KHR_texture_transform: empty if there is nothing to say, `None` if it cannot be said.
fn transform(to_uv: Affine2) -> Option<Vec<(&'static str, Json)>> {
    let m = to_uv * UPRIGHT;
    if m == Affine2::IDENTITY {
        return Some(Vec::new());
    }
    // Rotation times scale: the columns are sx (cos, −sin) and sy (sin, cos).
    let (x, y) = (m.matrix2.x_axis, m.matrix2.y_axis);
    let length = x.length();
    let (cos, sin, sx) = match x.y == 0.0 {
        true => (1.0, 0.0, x.x),
        false => (x.x / length, -x.y / length, length),
    };
    let sy = y.dot(Vec2::new(sin, cos));
    if (y - sy * Vec2::new(sin, cos)).length() > 1e-5 * y.length().max(length) {
        return None;
    }
    let mut list =
        vec![("offset", Json::numbers(&m.translation.to_array())), ("scale", Json::numbers(&[sx, sy]))];
    if sin != 0.0 {
        list.push(("rotation", Json::Number(f32::atan2(sin, cos))));
    }
    Some(list)
}
