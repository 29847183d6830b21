//! What shapes emit.

use std::f32::consts::PI;
use std::rc::Rc;

use glam::{Affine2, Vec2};
use sr_scene::{ColorInput, Diagnostic, Filter, Rgb, Span, TextureDesc, Wrap};

use super::{Params, Reader, positive};
use crate::images::Decode;
use crate::values::shown;

/// An `AreaLightSource`.
pub struct AreaLight {
    /// `L`, or an image.
    color: ColorInput,
    scale: f32,
    power: Option<f32>,
    is_two_sided: bool,
    span: Span,
}

/// What a shape emits.
pub struct AreaEmission {
    pub radiance: ColorInput,
    /// On its back, too.
    pub is_two_sided: bool,
}

impl Reader<'_> {
    /// `AreaLightSource "diffuse"` and parameters.
    pub(in crate::pbrt) fn area_light_source(&mut self, kind: &str, mut params: Params) {
        if kind != "diffuse" && kind != "area" {
            let message = format!("an area light \"{}\" is not supported", shown(kind));
            let note = Diagnostic::warning("pbrt::unsupported-light", &params.span, message)
                .guess(kind, ["diffuse"])
                .consequence("the shapes that follow do not emit");
            self.notes().push(note);
            self.state.area_light = None;
            return;
        }
        let is_two_sided = params.boolean("twosided").unwrap_or(false);
        let scale = self.light_scale(&mut params);
        let power = positive(&mut params, "power");
        let color = self.light_color(&mut params, "L");
        let file = params.string("filename").filter(|(_, file)| !file.is_empty());
        let span = params.span.clone();
        params.ignore(&["nsamples", "samples"]);
        params.finish(&mut self.notes());
        let color = match file {
            Some((file_span, file)) => {
                let image = self.out.image_file(&file, Decode::Linear, &file_span);
                let to_uv = Affine2::from_scale_angle_translation(Vec2::new(1.0, -1.0), 0.0, Vec2::Y);
                let (filter, wrap, srgb) = (Filter::Bilinear, Wrap::Clamp, false);
                let span = span.clone();
                self.out.add_texture(TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, span })
            }
            None => ColorInput::Constant(color.unwrap_or_else(|| self.white_light())),
        };
        self.state.area_light = Some(Rc::new(AreaLight { color, scale, power, is_two_sided, span }));
    }

    /// What a shape of this area emits, if it does; `None` is an area that is not known.
    pub(in crate::pbrt) fn area_emission(&mut self, area: Option<f32>) -> Option<AreaEmission> {
        let light = self.state.area_light.clone()?;
        let mut scale = light.scale;
        let is_two_sided = light.is_two_sided;
        match (light.power, area) {
            (Some(power), Some(area)) if area > 0.0 => {
                scale *= power / (area * PI * if is_two_sided { 2.0 } else { 1.0 });
            }
            (Some(_), _) => {
                let message =
                    "the \"power\" of a shape whose area is not known, or whose triangles differ in area";
                self.warn("pbrt::power", &light.span, message, "\"L\" and \"scale\" tell how bright it is");
            }
            (None, _) => {}
        }
        let radiance = match light.color {
            ColorInput::Constant(color) => ColorInput::Constant(color * scale),
            input if scale == 1.0 => input,
            input => {
                let factor = ColorInput::Constant(Rgb::splat(scale));
                self.out.add_texture(TextureDesc::Scale { input, factor, span: light.span.clone() })
            }
        };
        Some(AreaEmission { radiance, is_two_sided })
    }
}
