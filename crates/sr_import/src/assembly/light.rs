//! The light of a scene that has none, and the environment that a user puts around any.

use glam::{Mat3, Vec3};
use std::sync::Arc;

use sr_scene::{Diagnostic, Image, LightDesc, Pixels, ShapeDesc, Span, SphereMapping};

use super::Assembly;
use super::images::ImageSlot;
use crate::images::Decode;

const WIDTH: u32 = 128;
const HEIGHT: u32 = 64;

/// What is seen in a direction, +Y being up: a soft sky over grey ground, and a large, soft lamp in front, above, to the
/// left, for shape.
fn radiance(direction: Vec3) -> Vec3 {
    const GROUND: Vec3 = Vec3::new(0.24, 0.23, 0.22);
    const HORIZON: Vec3 = Vec3::new(0.82, 0.84, 0.86);
    const ZENITH: Vec3 = Vec3::new(0.42, 0.52, 0.68);
    const LAMP: Vec3 = Vec3::new(5.0, 4.8, 4.5);
    let sky = HORIZON.lerp(ZENITH, direction.y.max(0.0).sqrt());
    let above = ((direction.y + 0.04) / 0.08).clamp(0.0, 1.0);
    let towards = Vec3::new(-0.5, 0.7, 0.6).normalize();
    let lamp = ((direction.dot(towards) - 0.88) / 0.06).clamp(0.0, 1.0);
    GROUND.lerp(sky, above) + lamp * lamp * (3.0 - 2.0 * lamp) * LAMP
}

impl Assembly<'_> {
    /// Adds a soft sky if there is no light, and says so. +Y is up. `emitters`: are the shapes that shine meant as lights?
    pub fn light_if_dark(&mut self, emitters: bool, span: &Span) {
        let shines = |shape: &ShapeDesc| shape.emission.is_some();
        if self.environment.is_some() || !self.lights.is_empty() || emitters && self.shapes.iter().any(shines)
        {
            return;
        }
        self.d.push(
            Diagnostic::warning("scene::no-light", span, "the scene has no light")
                .consequence("a soft sky with a lamp in it is used"),
        );
        let mut data = Vec::with_capacity((WIDTH * HEIGHT * 3) as usize);
        for row in 0..HEIGHT {
            let theta = std::f32::consts::PI * row as f32 / (HEIGHT - 1) as f32;
            for column in 0..WIDTH {
                let phi = std::f32::consts::TAU * (column as f32 + 0.5) / WIDTH as f32;
                let (sin, cos) = theta.sin_cos();
                data.extend(radiance(Vec3::new(sin * phi.sin(), cos, -sin * phi.cos())).to_array());
            }
        }
        let pixels = Pixels::F32 { channels: 3, data };
        let name = "the default sky".to_owned();
        let image = self.image_in_memory(&Arc::new(Image { name, width: WIDTH, height: HEIGHT, pixels }));
        self.lights.push(LightDesc::Environment {
            image,
            mapping: SphereMapping::LatLong,
            scale: 1.0,
            world_from_light: Mat3::IDENTITY,
            mis_compensation: false,
            portals: Vec::new(),
            span: span.clone(),
        });
    }

    /// Adds the environment that was asked for beside the file.
    pub(super) fn surround(&mut self, span: &Span) {
        let Some(path) = self.environment.take() else { return };
        let surrounds = |light: &LightDesc| {
            matches!(
                light,
                LightDesc::Constant { .. } | LightDesc::Environment { .. } | LightDesc::Sky { .. }
            )
        };
        if self.lights.iter().any(surrounds) {
            let message = format!("the scene has an environment of its own beside {}", path.display());
            self.d.push(
                Diagnostic::warning("scene::two-environments", span, message)
                    .consequence("it is lit by both, added"),
            );
        }
        self.images.push(ImageSlot::File { path, decode: Decode::Linear, span: span.clone() });
        self.lights.push(LightDesc::Environment {
            image: self.images.len() as u32 - 1,
            mapping: SphereMapping::LatLong,
            scale: 1.0,
            world_from_light: Mat3::IDENTITY,
            mis_compensation: false,
            portals: Vec::new(),
            span: span.clone(),
        });
    }
}
