//! Lights that are not shapes.

use super::Check;
use crate::LightDesc;

impl Check<'_> {
    pub(super) fn light(&mut self, light: &LightDesc) {
        match light {
            LightDesc::Constant { radiance, span } => self.color(*radiance, "radiance", span),
            LightDesc::Environment { image, scale, world_from_light, span } => {
                if *image as usize >= self.scene.images.len() {
                    self.error("scene::bad-id", span, format!("there is no image {image}"));
                }
                if !(*scale >= 0.0 && scale.is_finite()) {
                    self.error("scene::bad-color", span, format!("an environment's scale of {scale}"));
                }
                if !world_from_light.is_finite() || world_from_light.determinant() == 0.0 {
                    self.error("scene::bad-transform", span, "the environment's placement is not invertible");
                }
            }
            LightDesc::Point { position, intensity, span } => {
                self.color(*intensity, "intensity", span);
                if !position.is_finite() {
                    self.error("scene::not-finite", span, "the position is not finite");
                }
            }
            LightDesc::Directional { direction, irradiance, span } => {
                self.color(*irradiance, "irradiance", span);
                if !direction.is_normalized() {
                    self.error("scene::direction", span, "the direction is not of unit length");
                }
            }
            LightDesc::Spot { world_from_light, intensity, cutoff_angle, beam_width, texture, span } => {
                self.color(*intensity, "intensity", span);
                if let Some(id) = texture {
                    self.texture_id(*id, span);
                }
                if !(*cutoff_angle > 0.0
                    && *cutoff_angle <= std::f32::consts::PI
                    && (0.0..=*cutoff_angle).contains(beam_width))
                {
                    let (cutoff, beam) = (cutoff_angle.to_degrees(), beam_width.to_degrees());
                    let message = format!(
                        "cutoff angle {cutoff}°, beam width {beam}°: 0 ≤ beam ≤ cutoff ≤ 180° is needed"
                    );
                    self.error("scene::spot", span, message);
                }
                if !world_from_light.is_finite() || world_from_light.determinant() == 0.0 {
                    self.error("scene::bad-transform", span, "the spot light's placement is not invertible");
                }
            }
        }
    }
}
