//! Infinite lights: a color or an image around the scene.

use std::f32::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DVec3, Mat3};
use sr_scene::{Image, LightDesc, Pixels, Portal, Rgb, Span, SphereMapping};

use super::super::syntax::Kind;
use super::{Params, Reader, positive};
use crate::images::{self, Decode};

impl Reader<'_> {
    pub(super) fn infinite(&mut self, params: &mut Params) -> Option<LightDesc> {
        let scale = self.light_scale(params);
        let illuminance = positive(params, "illuminance");
        let portals = self.portals(params);
        // Names of older files.
        let file =
            params.string("filename").or_else(|| params.string("mapname")).filter(|(_, f)| !f.is_empty());
        let color = self.light_color(params, "L");
        let span = params.span.clone();
        let image = match (file, portals.is_empty()) {
            (None, true) => {
                let color = color.unwrap_or_else(|| self.white_light());
                let radiance = color * scale * illuminance.map_or(1.0, |e| e / PI);
                return Some(LightDesc::Constant { radiance, span });
            }
            (None, false) => {
                let color = color.unwrap_or_else(|| self.white_light());
                self.out.image_in_memory(&Arc::new(uniform(color)))
            }
            (Some((span, file)), _) => {
                if color.is_some() {
                    let message = "an infinite light has both \"L\" and \"filename\"";
                    self.warn("pbrt::conflict", &params.span, message, "the file is used");
                }
                match illuminance {
                    None => self.out.image_file(&file, Decode::Linear, &span),
                    Some(_) => self.image_now(&file, &span)?.1,
                }
            }
        };
        let world_from_light = self.rotation(&span)?;
        let scale = match illuminance {
            None => scale,
            Some(target) => {
                let found = self.out.image(image).map_or(PI, |image| upward_illuminance(image));
                scale * target / found.max(f32::MIN_POSITIVE)
            }
        };
        Some(LightDesc::Environment {
            image,
            mapping: SphereMapping::EqualAreaOctahedral,
            scale,
            world_from_light,
            mis_compensation: false,
            portals,
            span,
        })
    }

    /// An image that is read at once, because something has to be worked out from it.
    pub(super) fn image_now(&mut self, file: &str, span: &Span) -> Option<(Arc<Image>, u32)> {
        let path = self.out.find(file);
        match images::load(&path, Decode::Linear, &self.out.limits) {
            Ok(image) => {
                let image = Arc::new(image);
                let index = self.out.image_in_memory(&image);
                Some((image, index))
            }
            Err(reason) => {
                let error = crate::files::error("file::bad-image", span, "image", &path, &reason);
                self.notes().push(error);
                None
            }
        }
    }

    /// The rotation of the current transform: the size of something infinitely far away does not matter. A mirroring
    /// one is a rotation here, too.
    fn rotation(&mut self, span: &Span) -> Option<Mat3> {
        let linear = DMat3::from_mat4(self.state.ctm);
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::normalize_or_zero);
        let is_rotation = x.dot(y).abs() < 1e-3 && y.dot(z).abs() < 1e-3 && z.dot(x).abs() < 1e-3;
        if is_rotation && [x, y, z].iter().all(|axis| *axis != DVec3::ZERO) {
            return Some(DMat3::from_cols(x, y, z).as_mat3());
        }
        let message = "the transform of an infinite light is more than a rotation and a scale";
        self.error("pbrt::bad-transform", span, message);
        None
    }

    /// A rectangle in world space: pbrt lets light in only through it; here it is where the light is looked for.
    fn portals(&mut self, params: &mut Params) -> Vec<Portal> {
        let Some((span, points)) = params.take_floats("portal", &[Kind::Point3]) else { return Vec::new() };
        let corners: Vec<glam::Vec3> = points.chunks_exact(3).map(glam::Vec3::from_slice).collect();
        let [a, b, c, d] = corners[..] else {
            let message = format!("a portal has 4 corners, not {}", corners.len());
            self.warn("pbrt::bad-value", &span, message, "the light has no portal");
            return Vec::new();
        };
        let edges = [b - a, d - a];
        let size = edges[0].length() * edges[1].length();
        let is_rectangle = edges[0].dot(edges[1]).abs() <= 1e-4 * size
            && (a + c - b - d).length() <= 1e-3 * (c - a).length();
        if !is_rectangle {
            self.warn("pbrt::bad-value", &span, "a portal has to be a rectangle", "the light has no portal");
            return Vec::new();
        }
        let message = "a portal is where light is looked for";
        self.warn("pbrt::portal", &span, message, "light around it is not shut out as in pbrt");
        vec![Portal { corner: a, edges }]
    }
}

/// An image of one color all around.
fn uniform(color: Rgb) -> Image {
    let pixels = Pixels::F32 { channels: 3, data: color.to_array().to_vec() };
    Image { name: "a uniform environment".into(), width: 1, height: 1, pixels }
}

/// The illuminance of a plane that faces +Z, from an equal-area octahedral image: half of it, as pbrt counts it.
fn upward_illuminance(image: &Image) -> f32 {
    let Pixels::F32 { channels, data } = &image.pixels else { return PI };
    let (width, height) = (image.width as usize, image.height as usize);
    let channels = usize::from(*channels);
    let mut sum = 0.0f64;
    for (i, texel) in data.chunks_exact(channels).enumerate() {
        let u = 2.0 * ((i % width) as f64 + 0.5) / width as f64 - 1.0;
        let v = 2.0 * ((i / width) as f64 + 0.5) / height as f64 - 1.0;
        // Clarberg 2008: the upper half is where |u| + |v| < 1, and z = 1 − (|u| + |v|)² there.
        let r = u.abs() + v.abs();
        if r < 1.0 {
            let luminance = match texel {
                [r, g, b, ..] => 0.2126 * r + 0.7152 * g + 0.0722 * b,
                _ => texel[0],
            };
            sum += f64::from(luminance) * (1.0 - r * r);
        }
    }
    // All texels fill the same solid angle.
    (sum * 2.0 * std::f64::consts::PI / (width * height) as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_sky_of_radiance_one_lights_with_pi_of_which_half_counts() {
        let pixels = Pixels::F32 { channels: 3, data: vec![1.0; 3 * 128 * 128] };
        let image = Image { name: String::new(), width: 128, height: 128, pixels };
        assert!((upward_illuminance(&image) / PI - 0.5).abs() < 1e-3, "{}", upward_illuminance(&image));
    }
}
