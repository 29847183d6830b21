//! EXT_lights_image_based: the cube of images around a scene, as one of latitude and longitude. The smaller, blurred copies of
//! the cube and its irradiance stand for what is traced here.

use std::path::Path;
use std::sync::Arc;

use glam::{Mat3, Quat, Vec2, Vec3};
use rayon::prelude::*;
use sr_scene::{Image, LightDesc, Pixels, Rgb, SphereMapping};

use super::document::Document;
use super::image::channels;
use super::json::Value;
use crate::images::{self, Decode, decode_bytes};
use crate::values::srgb_to_linear;

/// A side of a cube has at most so many texels across.
const MAX_SIDE: u32 = 4096;

impl<'v> Document<'v, '_> {
    /// The light around the chosen scene, if it has one.
    pub fn image_based_light(&mut self, scene: &'v Value) {
        let Some(chosen) = scene.extension("EXT_lights_image_based").and_then(|e| e.get("light")) else {
            return;
        };
        let root = self.root;
        let lights = root.extension("EXT_lights_image_based").and_then(|all| all.get("lights"));
        let lights = lights.map_or(&[][..], Value::list);
        let Some(light) = chosen.index().and_then(|at| lights.get(at)) else {
            return self.error("gltf::bad-index", &chosen.span, "this is none of the file's lights");
        };
        let faces =
            light.get("specularImages").and_then(|mips| mips.list().first()).map_or(&[][..], Value::list);
        if faces.len() != 6 {
            let message = format!("the light around the scene has {} images and not 6", faces.len());
            return self.warn("gltf::image-based-light", &light.span, message, "it is left out");
        }
        let cube: Option<Vec<Face>> = faces.iter().map(|face| self.face(face)).collect();
        // What is missing was said.
        let Some(cube) = cube else { return };
        let side = cube.iter().map(|face| face.width).max().unwrap_or(1);
        let (width, height) = (4 * side, 2 * side);
        if side > MAX_SIDE || !self.images.take(u64::from(width) * u64::from(height)) {
            let message = format!("a cube of {side} × {side} texels is too large");
            return self.error("file::bad-image", &light.span, message);
        }
        let row = |row: u32| {
            let theta = std::f32::consts::PI * row as f32 / (height - 1).max(1) as f32;
            let (sin, cos) = theta.sin_cos();
            let cube = &cube;
            (0..width).flat_map(move |column| {
                let phi = std::f32::consts::TAU * (column as f32 + 0.5) / width as f32;
                seen(cube, Vec3::new(sin * phi.sin(), cos, -sin * phi.cos())).to_array()
            })
        };
        let data = (0..height).into_par_iter().flat_map_iter(row).collect();
        let pixels = Pixels::F32 { channels: 3, data };
        let image = Image { name: "the light around the scene".into(), width, height, pixels };
        let image = self.out.image_in_memory(&Arc::new(image));
        let rotation =
            Quat::from_array(self.numbers(light, "rotation", [0.0, 0.0, 0.0, 1.0]).map(|v| v as f32));
        let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { Quat::IDENTITY };
        let scale = self.number(light, "intensity", 1.0) as f32;
        self.out.lights.push(LightDesc::Environment {
            image,
            mapping: SphereMapping::LatLong,
            scale,
            world_from_light: Mat3::from_quat(rotation),
            mis_compensation: false,
            portals: Vec::new(),
            span: light.span.clone(),
        });
    }

    /// One of the six images, as radiance: sRGB-encoded, and divided by its opacity if it has one (RGBD).
    fn face(&mut self, index: &Value) -> Option<Face> {
        let (name, bytes, place) = self.encoded_image(index)?;
        if !self.images.take(images::texels(Path::new(&name), &bytes)) {
            self.error("file::bad-image", &place.span, "with it the file's images are too large");
            return None;
        }
        let image = match decode_bytes(Path::new(&name), &bytes, Decode::Raw, self.out.limits.image_texels) {
            Ok(image) => image,
            Err(reason) => {
                self.bad_image(place, &name, &reason);
                return None;
            }
        };
        let width = channels(&image);
        let linear = |v: u8| srgb_to_linear(f64::from(v) / 255.0) as f32;
        let texels = match &image.pixels {
            Pixels::U8 { data, .. } => data
                .chunks_exact(width)
                .map(|t| match *t {
                    [r, g, b, d] => Rgb::new(linear(r), linear(g), linear(b)) * (255.0 / f32::from(d.max(1))),
                    [r, g, b] => Rgb::new(linear(r), linear(g), linear(b)),
                    _ => Rgb::splat(linear(t[0])),
                })
                .collect(),
            Pixels::F32 { data, .. } => data
                .chunks_exact(width)
                .map(|t| if width < 3 { Rgb::splat(t[0]) } else { Rgb::from_slice(t) })
                .collect(),
        };
        Some(Face { width: image.width, height: image.height, texels })
    }
}

/// A side of the cube, its first row above.
struct Face {
    width: u32,
    height: u32,
    texels: Vec<Rgb>,
}

/// What is seen in a direction. The sides are those of OpenGL's cube maps: each is seen from outside.
fn seen(cube: &[Face], d: Vec3) -> Rgb {
    let a = d.abs();
    let (face, s, t, major) = if a.x >= a.y && a.x >= a.z {
        if d.x > 0.0 { (0, -d.z, -d.y, a.x) } else { (1, d.z, -d.y, a.x) }
    } else if a.y >= a.z {
        if d.y > 0.0 { (2, d.x, d.z, a.y) } else { (3, d.x, -d.z, a.y) }
    } else if d.z > 0.0 {
        (4, d.x, -d.y, a.z)
    } else {
        (5, -d.x, -d.y, a.z)
    };
    cube.get(face).map_or(Rgb::ZERO, |face| face.at(0.5 + 0.5 * Vec2::new(s, t) / major))
}

impl Face {
    /// Linear between texels, the last ones as they are up to the edge.
    fn at(&self, uv: Vec2) -> Rgb {
        let most = Vec2::new((self.width - 1) as f32, (self.height - 1) as f32);
        let at = (uv * (most + 1.0) - 0.5).clamp(Vec2::ZERO, most);
        let (low, part) = (at.floor(), at.fract());
        let texel = |x: f32, y: f32| {
            let at = y.min(most.y) as usize * self.width as usize + x.min(most.x) as usize;
            self.texels.get(at).copied().unwrap_or_default()
        };
        let row = |y: f32| texel(low.x, y).lerp(texel(low.x + 1.0, y), part.x);
        row(low.y).lerp(row(low.y + 1.0), part.y)
    }
}
