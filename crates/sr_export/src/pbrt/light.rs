//! Lights, and what shapes emit. RGB values of lights are what they say.

use glam::{Mat4, Vec3};
use sr_render::light::Probe;
use sr_scene::{ColorInput, LightDesc, Rgb, Span, SphereMapping, SpotFalloff};

use super::Writer;
use super::text::{Params, Text};
use crate::bake::{decoded, luminance};
use crate::directions;

/// A side of the image of a light that shines unevenly.
const GONIOMETRIC: u32 = 1024;
/// A side of the image of a sky.
const SKY: u32 = 512;

impl Writer<'_> {
    pub(super) fn lights(&mut self, text: &mut Text) {
        for light in &self.scene.lights {
            text.line("AttributeBegin");
            self.light(text, light);
            text.line("AttributeEnd");
        }
    }

    fn light(&mut self, text: &mut Text, light: &LightDesc) {
        if let LightDesc::Point { range, span, .. } | LightDesc::Spot { range, span, .. } = light
            && range.is_finite()
        {
            let message = "pbrt's lights have no range";
            self.notes.push("convert::light", span, message, "it falls off with the square of the distance");
        }
        match light {
            LightDesc::Constant { radiance, .. } => {
                text.directive("LightSource", "infinite", &Params::default().rgb("L", *radiance));
            }
            LightDesc::Environment { .. } => self.environment(text, light),
            LightDesc::Point { position, intensity, .. } => {
                let params = Params::default().rgb("I", *intensity);
                text.directive("LightSource", "point", &params.floats("point3 from", &position.to_array()));
            }
            LightDesc::Directional { direction, irradiance, .. } => {
                distant(text, *direction, *irradiance);
            }
            LightDesc::Spot {
                world_from_light, intensity, cutoff_angle, beam_width, texture: None, ..
            } if cutoff_angle == beam_width => {
                text.concat(rigid(world_from_light));
                let params = Params::default()
                    .rgb("I", *intensity)
                    .float("coneangle", cutoff_angle.to_degrees())
                    .float("conedeltaangle", 0.0);
                text.directive("LightSource", "spot", &params);
            }
            LightDesc::Spot { world_from_light, span, texture, falloff, .. } => {
                let what = match (texture, falloff) {
                    (Some(_), _) => "spot light with a texture",
                    (None, SpotFalloff::Linear) => "spot light that falls off linearly",
                    (None, SpotFalloff::SquaredCosine) => {
                        "spot light that falls off by the square of a cosine"
                    }
                };
                self.goniometric(text, light, world_from_light, (what, span));
            }
            LightDesc::Projector { world_from_light, span, .. } => {
                self.goniometric(
                    text,
                    light,
                    world_from_light,
                    ("light that is evenly bright on a plane", span),
                );
            }
            LightDesc::Goniometric { world_from_light, span, .. } => {
                self.goniometric(text, light, world_from_light, ("goniometric light of colors", span));
            }
            LightDesc::Profile { world_from_light, span, .. } => {
                self.goniometric(text, light, world_from_light, ("measured light", span));
            }
            LightDesc::Sky { span, .. } => {
                let message = "pbrt has no model of the sky";
                let instead = format!("an environment map of {SKY} × {SKY} texels is written");
                self.notes.push("convert::light", span, message, instead);
                let probe = Probe::new(light, self.scene, self.baker.textures());
                let mapping = SphereMapping::EqualAreaOctahedral;
                let image = directions::image("sky", (SKY, SKY), mapping, |w| probe.radiance(w));
                let params = Params::default().string("filename", &self.files.image(&image));
                text.directive("LightSource", "infinite", &params);
            }
            LightDesc::Sun { direction, aperture, world_from_light, span, .. } => {
                let message = "pbrt has no sun";
                let instead = "parallel light of the same irradiance is written";
                self.notes.push("convert::light", span, message, instead);
                let towards = *world_from_light * *direction;
                let probe = Probe::new(light, self.scene, self.baker.textures());
                let solid_angle = std::f32::consts::TAU * (1.0 - (0.5 * aperture).cos());
                distant(text, -towards, probe.radiance(towards) * solid_angle);
            }
        }
    }

    fn environment(&mut self, text: &mut Text, light: &LightDesc) {
        let LightDesc::Environment { image, mapping, scale, world_from_light, span, .. } = light else {
            return;
        };
        let Some(image) = self.scene.images.get(*image as usize) else { return };
        let params = if *mapping == SphereMapping::EqualAreaOctahedral {
            text.concat(Mat4::from_mat3(*world_from_light));
            Params::default().string("filename", &self.files.image(image)).float("scale", *scale)
        } else {
            let message = "pbrt's environment maps are octahedra, not by latitude and longitude";
            let side = directions::square_side(image);
            let instead = format!("it is resampled to {side} × {side} texels");
            self.notes.push("convert::resampled", span, message, instead);
            let probe = Probe::new(light, self.scene, self.baker.textures());
            let mapping = SphereMapping::EqualAreaOctahedral;
            let made = directions::image(&image.name, (side, side), mapping, |w| probe.radiance(w));
            Params::default().string("filename", &self.files.image(&made))
        };
        text.directive("LightSource", "infinite", &params);
    }

    /// A light as an image of its intensity: pbrt's have no colors but one.
    fn goniometric(
        &mut self,
        text: &mut Text,
        light: &LightDesc,
        placement: &Mat4,
        (what, span): (&str, &Span),
    ) {
        let position = placement.w_axis.truncate();
        let probe = Probe::new(light, self.scene, self.baker.textures());
        // Images of directions are drawn with y and z swapped.
        let swapped = |w: Vec3| Vec3::new(w.x, w.z, w.y);
        let mapping = SphereMapping::EqualAreaOctahedral;
        let size = (GONIOMETRIC, GONIOMETRIC);
        let colors = directions::image("intensity", size, mapping, |w| probe.intensity(position, swapped(w)));
        let sum = decoded(&colors, false).fold(glam::DVec3::ZERO, |sum, color| sum + color.as_dvec3());
        let mean = sum.as_vec3();
        let hue = mean / luminance(mean).max(f32::MIN_POSITIVE);
        let data = decoded(&colors, false).map(luminance).collect();
        let pixels = sr_scene::Pixels::F32 { channels: 1, data };
        let image = std::sync::Arc::new(sr_scene::Image { pixels, ..(*colors).clone() });
        let instead = format!(
            "an image of its directions of {GONIOMETRIC} × {GONIOMETRIC} texels, of one color, is written"
        );
        self.notes.push("convert::light", span, format!("pbrt has no {what}"), instead);
        text.concat(Mat4::from_translation(position));
        let params = Params::default().string("filename", &self.files.image(&image)).rgb("I", hue);
        text.directive("LightSource", "goniometric", &params);
    }

    /// The parameters of a shape's light.
    pub(super) fn area_light(&mut self, radiance: ColorInput, span: &Span) -> Params {
        match radiance {
            ColorInput::Constant(color) => Params::default().rgb("L", color),
            ColorInput::Texture(id) => {
                let (image, factor) = self.plain_image(id, span, true);
                let is_grey = factor.x == factor.y && factor.y == factor.z;
                let (image, scale) = match is_grey {
                    true => (image, factor.x),
                    false => (self.baker.texels(&image, true, |color| color * factor), 1.0),
                };
                Params::default().string("filename", &self.files.image(&image)).float("scale", scale)
            }
        }
    }
}

fn distant(text: &mut Text, direction: Vec3, irradiance: Rgb) {
    let params = Params::default()
        .rgb("L", irradiance)
        .floats("point3 from", &[0.0, 0.0, 0.0])
        .floats("point3 to", &direction.to_array());
    text.directive("LightSource", "distant", &params);
}

/// A placement without its scale: a light at a point has no size.
fn rigid(m: &Mat4) -> Mat4 {
    let unit = |axis: glam::Vec4| axis.truncate().normalize_or_zero().extend(0.0);
    Mat4::from_cols(unit(m.x_axis), unit(m.y_axis), unit(m.z_axis), m.w_axis)
}
