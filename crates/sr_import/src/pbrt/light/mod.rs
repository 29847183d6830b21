//! Lights that are not shapes, and what shapes emit.
//!
//! Units are pbrt-v4's: RGB values are what they say, and spectra have the luminance 1, times `scale`; `power` and
//! `illuminance` are photometric.

mod area;
mod environment;
mod image;

use std::f32::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3, Mat4};
use sr_scene::{IntensityProfile, LightDesc, Rgb};

use super::Reader;
use super::params::Params;
use super::support::{LIGHTS, unsupported};
pub use area::AreaLight;

impl Reader<'_> {
    /// `LightSource "point"` and parameters.
    pub(super) fn light(&mut self, kind: &str, mut params: Params) {
        if self.object.is_some() {
            let message = "a light inside of an object";
            self.warn("pbrt::light-in-object", &params.span, message, "it is part of the scene itself");
        }
        let light = match kind {
            "point" => self.point(&mut params),
            "spot" => self.spot(&mut params),
            "distant" => self.distant(&mut params),
            "infinite" => self.infinite(&mut params),
            "goniometric" => self.goniometric(&mut params),
            "projection" => self.projection(&mut params),
            _ => {
                params.use_all();
                let consequence = "it is left out, and the picture is darker";
                let code = "pbrt::unsupported-light";
                let note = unsupported(LIGHTS, code, &params.span, "a light", kind, consequence);
                self.notes().push(note);
                None
            }
        };
        params.finish(&mut self.notes());
        self.out.lights.extend(light);
    }

    /// `I` or `L`, and `scale`.
    fn scaled_light(&mut self, params: &mut Params, name: &'static str) -> Rgb {
        let color = self.light_color(params, name).unwrap_or_else(|| self.white_light());
        color * self.light_scale(params)
    }

    /// `scale`, and the film's exposure: light is what it is proportional to.
    fn light_scale(&mut self, params: &mut Params) -> f32 {
        params.float("scale").unwrap_or(1.0).max(0.0) * self.options.exposure
    }

    fn point(&mut self, params: &mut Params) -> Option<LightDesc> {
        let mut intensity = self.scaled_light(params, "I");
        if let Some(power) = positive(params, "power") {
            intensity *= power / (4.0 * PI);
        }
        let from = params.vector("from").unwrap_or(DVec3::ZERO);
        let position = self.state.ctm.transform_point3(from).as_vec3();
        Some(LightDesc::Point { position, intensity, range: f32::INFINITY, span: params.span.clone() })
    }

    fn distant(&mut self, params: &mut Params) -> Option<LightDesc> {
        let mut irradiance = self.scaled_light(params, "L");
        if let Some(illuminance) = positive(params, "illuminance") {
            irradiance *= illuminance;
        }
        let from = params.vector("from").unwrap_or(DVec3::ZERO);
        let to = params.vector("to").unwrap_or(DVec3::Z);
        match self.state.ctm.transform_vector3(to - from).try_normalize() {
            Some(direction) => {
                let direction = direction.as_vec3().normalize();
                Some(LightDesc::Directional { direction, irradiance, span: params.span.clone() })
            }
            None => {
                let message = "a distant light needs a direction: \"from\" and \"to\" are the same";
                self.error("pbrt::bad-value", &params.span, message);
                None
            }
        }
    }

    /// A cone. Its edge is smooth in the cosine, which a measured luminaire can be, too.
    fn spot(&mut self, params: &mut Params) -> Option<LightDesc> {
        let mut intensity = self.scaled_light(params, "I");
        let angle = params.float("coneangle").unwrap_or(30.0);
        let delta = params.float("conedeltaangle").unwrap_or(5.0);
        let full = angle - delta;
        if !(angle > 0.0 && angle <= 180.0 && (0.0..=angle).contains(&full)) {
            let message =
                format!("a cone of {angle}° with an edge of {delta}°: 0 ≤ edge ≤ cone ≤ 180 is needed");
            self.error("pbrt::bad-value", &params.span, message);
            return None;
        }
        let (end, start) = (angle.to_radians(), full.to_radians());
        if let Some(power) = positive(params, "power") {
            let solid_angle = 2.0 * PI * ((1.0 - start.cos()) + (start.cos() - end.cos()) / 2.0);
            intensity *= power / solid_angle;
        }
        let from = params.vector("from").unwrap_or(DVec3::ZERO);
        let to = params.vector("to").unwrap_or(DVec3::Z);
        let Some(axis) = (to - from).try_normalize() else {
            let message = "a spot light needs a direction: \"from\" and \"to\" are the same";
            self.error("pbrt::bad-value", &params.span, message);
            return None;
        };
        let (x, y) = axis.any_orthonormal_pair();
        let turn = DMat4::from_mat3(DMat3::from_cols(x, y, axis));
        let world_from_light = self.state.ctm * DMat4::from_translation(from) * turn;
        let profile = Arc::new(cone(start, end));
        let span = params.span.clone();
        Some(LightDesc::Profile { world_from_light: world_from_light.as_mat4(), intensity, profile, span })
    }

    /// The current transform with y and z swapped: images of directions are drawn so.
    fn swapped(&self) -> Mat4 {
        let swap = DMat4::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Y));
        (self.state.ctm * swap).as_mat4()
    }
}

/// A number above 0; others mean that there is none.
fn positive(params: &mut Params, name: &'static str) -> Option<f32> {
    params.float(name).filter(|v| *v > 0.0)
}

/// Full up to `start`, and down to 0 at `end`: 3 t² − 2 t³ in the cosine.
fn cone(start: f32, end: f32) -> IntensityProfile {
    /// Angles in between, at which the intensity is told.
    const STEPS: usize = 64;
    let (cos_start, cos_end) = (start.cos(), end.cos());
    let mut vertical = vec![0.0];
    let mut candelas = vec![1.0];
    // Where there is no edge, one that nobody sees.
    let start = start.min(end * (1.0 - 1e-4));
    for i in 0..=STEPS {
        let angle = start + (end - start) * i as f32 / STEPS as f32;
        if angle <= vertical[vertical.len() - 1] {
            continue;
        }
        let t = if cos_start > cos_end { (angle.cos() - cos_end) / (cos_start - cos_end) } else { 1.0 };
        let t = t.clamp(0.0, 1.0);
        vertical.push(angle);
        candelas.push(t * t * (3.0 - 2.0 * t));
    }
    IntensityProfile { name: "a spot light".into(), vertical, horizontal: vec![0.0], candelas }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cones_fall_off_smoothly() {
        for (start, end) in [(0.4f32, 0.5f32), (0.0, 0.5), (0.5, 0.5), (0.0, PI)] {
            let profile = cone(start, end);
            assert!(profile.vertical.windows(2).all(|w| w[0] < w[1]), "{start} {end}");
            assert_eq!(profile.vertical.len(), profile.candelas.len());
            assert!(profile.candelas.windows(2).all(|w| w[0] >= w[1]));
            assert!((profile.vertical[profile.vertical.len() - 1] - end).abs() < 1e-5);
        }
    }
}
