//! KHR_lights_punctual. Candelas, lux and the nits of emissive surfaces are taken one to one for W sr⁻¹, W m⁻² and
//! W sr⁻¹ m⁻², so that all lights of a file keep their proportions.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use glam::{DMat4, DVec3};
use sr_scene::{LightDesc, Rgb, SpotFalloff};

use super::document::Document;
use super::json::Value;
use super::texture::rgb;

impl Document<'_, '_> {
    /// The light at a node; it shines along -Z.
    pub fn light(&mut self, light: &Value, world: &DMat4) {
        let span = light.span.clone();
        let color = rgb(self.numbers(light, "color", [1.0; 3]));
        let intensity = color * self.number(light, "intensity", 1.0) as f32;
        let range = self.number(light, "range", f64::INFINITY) as f32;
        if !(range > 0.0) {
            self.warn("gltf::light", &span, format!("a light that shines {range} far"), "it is left out");
            return;
        }
        if intensity == Rgb::ZERO {
            return;
        }
        let (_, rotation, place) = world.to_scale_rotation_translation();
        if !(rotation.is_finite() && place.is_finite()) {
            self.warn("gltf::light", &span, "the light's node turns it to nothing", "it is left out");
            return;
        }
        let desc = match light.get("type").and_then(Value::text) {
            Some("point") => LightDesc::Point { position: place.as_vec3(), intensity, range, span },
            Some("directional") => LightDesc::Directional {
                direction: (rotation * DVec3::NEG_Z).normalize().as_vec3(),
                irradiance: intensity,
                span,
            },
            Some("spot") => {
                let none = Value { kind: super::json::Kind::Null, span: span.clone() };
                let spot = light.get("spot").unwrap_or(&none);
                let outer = self.number(spot, "outerConeAngle", FRAC_PI_4);
                let inner = self.number(spot, "innerConeAngle", 0.0);
                if !(outer > 0.0 && outer <= FRAC_PI_2 && inner >= 0.0 && inner <= outer) {
                    let message = format!("a cone from {inner} to {outer} radians is none");
                    self.warn("gltf::light", &spot.span, message, "the light is left out");
                    return;
                }
                let turned = DMat4::from_rotation_translation(rotation, place) * DMat4::from_rotation_y(PI);
                LightDesc::Spot {
                    world_from_light: turned.as_mat4(),
                    intensity,
                    // A cone of a half space has no square around it.
                    cutoff_angle: outer.min(FRAC_PI_2 - 1e-3) as f32,
                    beam_width: inner.min(FRAC_PI_2 - 1e-3) as f32,
                    falloff: SpotFalloff::SquaredCosine,
                    range,
                    texture: None,
                    span,
                }
            }
            _ => {
                self.warn("gltf::light", &span, "the light is of no known type", "it is left out");
                return;
            }
        };
        self.out.lights.push(desc);
    }
}
