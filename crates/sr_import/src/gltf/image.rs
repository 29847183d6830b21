//! Images: decoded in parallel, each once, and what is made of their channels.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;
use sr_scene::{Image, Pixels};

use super::container;
use super::document::Document;
use super::json::Value;
use crate::images::{self, Decode, decode_bytes};
use crate::limits::Limit;
use crate::values::srgb_to_linear;

/// What is read out of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// Its color, sRGB-encoded.
    Color,
    /// One channel.
    Channel(usize),
    /// One less alpha times a factor, by its bits.
    Inverse(u32),
    /// Is alpha times a factor at least a cutoff? Both by their bits.
    AtLeast { cutoff: u32, factor: u32 },
    /// A normal whose first two coordinates are scaled, by the bits of the factor.
    Normal(u32),
}

/// The images of a file by their index.
pub struct Images {
    decoded: HashMap<usize, Arc<Image>>,
    parts: HashMap<(usize, Part), u32>,
    /// How many texels may be decoded, and made of what was: a file may show one image in many ways.
    limit: Limit,
    /// How many still may.
    left: u64,
}

impl<'v> Document<'v, '_> {
    /// Decodes every image that a texture shows.
    pub fn load_images(&mut self) {
        let mut encoded: Vec<(usize, String, Vec<u8>, &Value)> = Vec::new();
        for texture in self.root.get("textures").map_or(&[][..], Value::list) {
            let Some(source) = source(texture) else { continue };
            let Some(index) = source.index() else { continue };
            if encoded.iter().any(|(known, ..)| *known == index) {
                continue;
            }
            if let Some((name, bytes, image)) = self.encoded_image(source) {
                encoded.push((index, name, bytes, image));
            }
        }
        encoded.retain(|(_, name, bytes, image)| {
            let fits = self.images.take(images::texels(Path::new(name), bytes));
            if !fits {
                let limit = self.images.limit;
                let reason = format!("with it the file's images have more than {limit} pixels");
                self.bad_image(image, name, &limit.refusal(reason));
            }
            fits
        });
        let limit = self.out.limits.image_texels;
        let decoded: Vec<Result<Image, String>> = encoded
            .par_iter()
            .map(|(_, name, bytes, _)| decode_bytes(Path::new(name), bytes, Decode::Raw, limit))
            .collect();
        for ((index, name, _, image), result) in encoded.into_iter().zip(decoded) {
            match result {
                Ok(decoded) => {
                    self.images.decoded.insert(index, Arc::new(decoded));
                }
                Err(reason) => self.bad_image(image, &name, &reason),
            }
        }
    }

    /// An image of the file as it is encoded: what to call it, its bytes, and where it is described.
    pub fn encoded_image(&mut self, index: &Value) -> Option<(String, Vec<u8>, &'v Value)> {
        let image = self.item("images", index)?;
        let name = image.get("uri").or(image.get("name")).and_then(Value::text).unwrap_or("");
        let name = if name.starts_with("data:") || name.is_empty() {
            format!("images[{}]", index.index()?)
        } else {
            name.to_owned()
        };
        let bytes = match (image.get("uri").and_then(Value::text), image.get("bufferView")) {
            (Some(uri), _) => container::fetch(uri, |name| self.out.find(name), self.out.limits.file_bytes),
            (None, Some(view)) => Ok(self.view(view)?.bytes().to_vec()),
            (None, None) => Err("it names no file".into()),
        };
        match bytes {
            Ok(bytes) => Some((name, bytes, image)),
            Err(reason) => {
                self.bad_image(image, &name, &reason);
                None
            }
        }
    }

    pub fn bad_image(&mut self, image: &Value, name: &str, reason: &str) {
        let message = format!("cannot read the image {}: {reason}", crate::values::shown(name));
        self.error("file::bad-image", &image.span, message);
    }

    /// Has the image a channel of opacity?
    pub fn has_alpha(&self, index: usize) -> bool {
        self.images.decoded.get(&index).is_some_and(|image| channels(image) == 4)
    }

    /// A part of an image; its index in the scene.
    pub fn image_part(&mut self, index: usize, part: Part) -> Option<u32> {
        if let Some(&known) = self.images.parts.get(&(index, part)) {
            return Some(known);
        }
        let image = self.images.decoded.get(&index)?.clone();
        let is_whole = match part {
            Part::Color => matches!(image.pixels, Pixels::U8 { .. }),
            Part::Normal(bits) => f32::from_bits(bits) == 1.0,
            _ => false,
        };
        let made = if is_whole {
            image
        } else if self.images.take(u64::from(image.width) * u64::from(image.height)) {
            Arc::new(make(&image, part))
        } else {
            let span = self.root.get("images").map(|images| images.span.clone()).unwrap_or_default();
            let limit = self.images.limit;
            let message = format!("what is made of the file's images has more than {limit} pixels");
            self.error("file::bad-image", &span, limit.refusal(message));
            return None;
        };
        let slot = self.out.image_in_memory(&made);
        self.images.parts.insert((index, part), slot);
        Some(slot)
    }
}

/// The image that a texture shows: one that is read before one that is not.
pub fn source(texture: &Value) -> Option<&Value> {
    let webp = texture.extension("EXT_texture_webp").and_then(|webp| webp.get("source"));
    webp.or_else(|| texture.get("source"))
}

pub fn channels(image: &Image) -> usize {
    match image.pixels {
        Pixels::U8 { channels, .. } | Pixels::F32 { channels, .. } => channels.into(),
    }
}

fn make(image: &Image, part: Part) -> Image {
    let width = channels(image);
    let value = |at: usize| match &image.pixels {
        Pixels::U8 { data, .. } => f32::from(data[at]) / 255.0,
        Pixels::F32 { data, .. } => data[at],
    };
    // A grey image has the same in all channels but alpha.
    let channel = |texel: usize, c: usize| match width {
        1 if c == 3 => 1.0,
        1 => value(texel),
        3 if c == 3 => 1.0,
        _ => value(texel * width + c),
    };
    let texels = 0..image.width as usize * image.height as usize;
    let byte = |v: f32| (v * 255.0 + 0.5) as u8;
    let one = |of: &dyn Fn(usize) -> f32| match image.pixels {
        Pixels::U8 { .. } => Pixels::U8 { channels: 1, data: texels.clone().map(|t| byte(of(t))).collect() },
        Pixels::F32 { .. } => Pixels::F32 { channels: 1, data: texels.clone().map(of).collect() },
    };
    let pixels = match part {
        Part::Color => {
            let decoded = |t, c| srgb_to_linear(f64::from(channel(t, c))) as f32;
            let data = texels.flat_map(|t| [decoded(t, 0), decoded(t, 1), decoded(t, 2)]).collect();
            Pixels::F32 { channels: 3, data }
        }
        Part::Channel(c) => one(&|t| channel(t, c)),
        Part::Inverse(factor) => one(&|t| (1.0 - f32::from_bits(factor) * channel(t, 3)).clamp(0.0, 1.0)),
        Part::AtLeast { cutoff, factor } => {
            let (cutoff, factor) = (f32::from_bits(cutoff), f32::from_bits(factor));
            one(&|t| f32::from(channel(t, 3) * factor >= cutoff))
        }
        Part::Normal(bits) => {
            let scale = f32::from_bits(bits);
            let normal = |t| {
                let n = glam::Vec3::from_array([0, 1, 2].map(|c| 2.0 * channel(t, c) - 1.0));
                let n = (n * glam::Vec3::new(scale, scale, 1.0)).normalize_or(glam::Vec3::Z);
                (0.5 * n + 0.5).to_array()
            };
            Pixels::F32 { channels: 3, data: texels.flat_map(normal).collect() }
        }
    };
    Image { name: image.name.clone(), width: image.width, height: image.height, pixels }
}

impl Images {
    /// None yet.
    pub fn new(limit: Limit) -> Self {
        Self { decoded: HashMap::new(), parts: HashMap::new(), limit, left: limit.most }
    }

    /// Are so many texels allowed?
    pub fn take(&mut self, texels: u64) -> bool {
        let left = self.left.checked_sub(texels);
        self.left = left.unwrap_or(self.left);
        left.is_some()
    }

    /// The mean of the direction and the strength that an image of anisotropy holds, and whether one direction is all.
    pub fn mean_direction(&self, index: usize) -> Option<(f32, bool)> {
        let image = self.decoded.get(&index)?;
        let width = channels(image);
        if width < 3 {
            return None;
        }
        let at = |i: usize| match &image.pixels {
            Pixels::U8 { data, .. } => f64::from(data[i]) / 255.0,
            Pixels::F32 { data, .. } => f64::from(data[i]),
        };
        let (mut sum, mut total) = (glam::DVec2::ZERO, 0.0);
        for texel in 0..image.width as usize * image.height as usize {
            let i = texel * width;
            let direction = glam::DVec2::new(2.0 * at(i) - 1.0, 2.0 * at(i + 1) - 1.0).normalize_or_zero();
            // An axis and its opposite are the same: angles are doubled before they are averaged.
            let doubled =
                glam::DVec2::new(direction.x.powi(2) - direction.y.powi(2), 2.0 * direction.x * direction.y);
            sum += at(i + 2) * doubled;
            total += at(i + 2);
        }
        let uniform = sum.length() >= 0.99 * total;
        Some((0.5 * sum.y.atan2(sum.x) as f32, uniform))
    }
}
