//! Point lights whose intensity an image tells.

use std::f32::consts::PI;

use sr_scene::{
    ColorInput, Filter, FovAxis, Image, LightDesc, Pixels, Rgb, SphereMapping, TextureDesc, Wrap,
};

use super::{Params, Reader, positive};
use crate::images::Decode;

impl Reader<'_> {
    pub(super) fn goniometric(&mut self, params: &mut Params) -> Option<LightDesc> {
        let mut intensity = self.scaled_light(params, "I");
        let world_from_light = self.swapped();
        let power = positive(params, "power");
        let span = params.span.clone();
        let Some((file_span, file)) = params.string("filename").filter(|(_, file)| !file.is_empty()) else {
            // Without an image it shines evenly.
            intensity *= power.map_or(1.0, |power| power / (4.0 * PI));
            let position = self.state.ctm.w_axis.truncate().as_vec3();
            return Some(LightDesc::Point { position, intensity, range: f32::INFINITY, span });
        };
        let image = match power {
            None => self.out.image_file(&file, Decode::Linear, &file_span),
            Some(power) => {
                let (image, index) = self.image_now(&file, &file_span)?;
                // The texels of an equal-area image fill the same solid angle.
                intensity *= power / (4.0 * PI * mean_luminance(&image)).max(f32::MIN_POSITIVE);
                index
            }
        };
        let mapping = SphereMapping::EqualAreaOctahedral;
        Some(LightDesc::Goniometric { world_from_light, intensity, image, mapping, span })
    }

    /// Evenly bright on a sphere in pbrt, on a plane here; the same in the middle.
    pub(super) fn projection(&mut self, params: &mut Params) -> Option<LightDesc> {
        let scale = self.light_scale(params);
        let fov = params.float("fov").unwrap_or(90.0).to_radians();
        let span = params.span.clone();
        let Some((file_span, file)) = params.string("filename").filter(|(_, file)| !file.is_empty()) else {
            self.error("pbrt::missing-parameter", &span, "a projection needs a \"filename\"");
            return None;
        };
        params.unsupported(&["power"], "\"scale\" alone tells how bright it is", &mut self.notes());
        let message = "a projection is evenly bright on a plane here, on a sphere in pbrt";
        self.warn("pbrt::projection", &span, message, "its edges are brighter");
        let image = self.out.image_file(&file, Decode::Linear, &file_span);
        let (filter, wrap) = (Filter::Nearest, Wrap::Clamp);
        // x is to the right in pbrt's space, and to the left in that of a camera turned round.
        let to_uv = glam::Affine2::IDENTITY;
        let texture = self.out.add_texture(TextureDesc::Bitmap {
            image,
            filter,
            wrap,
            srgb: false,
            to_uv,
            span: span.clone(),
        });
        let white = ColorInput::Constant(Rgb::splat(1.0 / PI));
        let irradiance =
            self.out.add_texture(TextureDesc::Scale { input: texture, factor: white, span: span.clone() });
        let mirror = glam::DMat4::from_scale(glam::DVec3::new(-1.0, 1.0, 1.0));
        let world_from_light = (self.state.ctm * mirror).as_mat4();
        Some(LightDesc::Projector {
            world_from_light,
            irradiance,
            scale,
            fov_axis: FovAxis::Smaller,
            fov,
            span,
        })
    }
}

fn mean_luminance(image: &Image) -> f32 {
    let Pixels::F32 { channels, data } = &image.pixels else { return 1.0 };
    let texels = data.chunks_exact(usize::from(*channels)).map(|texel| match texel {
        [r, g, b, ..] => 0.2126 * f64::from(*r) + 0.7152 * f64::from(*g) + 0.0722 * f64::from(*b),
        _ => f64::from(texel[0]),
    });
    (texels.sum::<f64>() / f64::from(image.width) / f64::from(image.height)) as f32
}
