//! Lights of no extent: deltas, found by light sampling alone.

use std::f32::consts::PI;

use glam::{Mat4, Vec2, Vec3};
use sr_scene::{ColorInput, Rgb, TextureId};

use super::{DeltaSample, Target};
use crate::texture::Textures;

/// A point that shines equally in all directions.
#[derive(Clone, Copy, Debug)]
pub struct PointLight {
    /// Position.
    pub position: Vec3,
    /// Radiant intensity, in W sr⁻¹.
    pub intensity: Rgb,
}

impl PointLight {
    /// Light arriving at `p`: I / r².
    pub fn sample(&self, p: Vec3) -> Option<DeltaSample> {
        towards(self.position, p, |_| self.intensity)
    }

    /// Emitted power: 4π I.
    pub fn power(&self) -> Rgb {
        4.0 * PI * self.intensity
    }
}

/// Parallel light.
#[derive(Clone, Copy, Debug)]
pub struct DirectionalLight {
    /// The way the light travels, unit length.
    pub direction: Vec3,
    /// Irradiance on a surface that faces it, in W m⁻².
    pub irradiance: Rgb,
}

impl DirectionalLight {
    /// The same everywhere.
    pub fn sample(&self) -> DeltaSample {
        DeltaSample { wi: -self.direction, radiance: self.irradiance, target: Target::Infinity }
    }

    /// Power through a disk of the scene's radius.
    pub fn power(&self, scene_radius: f32) -> Rgb {
        PI * scene_radius * scene_radius * self.irradiance
    }
}

/// A point that shines into a cone about +Z of its own space, full within `beam_width`, then falling
/// linearly with the angle to nothing at `cutoff_angle`.
#[derive(Clone, Copy, Debug)]
pub struct SpotLight {
    light_from_world: Mat4,
    position: Vec3,
    intensity: Rgb,
    cutoff_angle: f32,
    beam_width: f32,
    texture: Option<TextureId>,
}

impl SpotLight {
    /// Angles in radians; `world_from_light` is rigid.
    pub fn new(
        world_from_light: Mat4,
        intensity: Rgb,
        cutoff_angle: f32,
        beam_width: f32,
        texture: Option<TextureId>,
    ) -> Self {
        Self {
            light_from_world: world_from_light.inverse(),
            position: world_from_light.transform_point3(Vec3::ZERO),
            intensity,
            cutoff_angle,
            beam_width,
            texture,
        }
    }

    /// Light arriving at `p`.
    pub fn sample(&self, p: Vec3, textures: &Textures) -> Option<DeltaSample> {
        towards(self.position, p, |outwards| {
            let local = self.light_from_world.transform_vector3(outwards).normalize();
            self.falloff(local.z) * self.tint(local, textures)
        })
        .filter(|s| s.radiance != Rgb::ZERO)
    }

    fn falloff(&self, cos_angle: f32) -> f32 {
        if cos_angle <= self.cutoff_angle.cos() {
            0.0
        } else if cos_angle >= self.beam_width.cos() {
            1.0
        } else {
            (self.cutoff_angle - cos_angle.clamp(-1.0, 1.0).acos()) / (self.cutoff_angle - self.beam_width)
        }
    }

    fn tint(&self, local: Vec3, textures: &Textures) -> Rgb {
        let Some(texture) = self.texture else { return self.intensity };
        let half = 0.5 / self.cutoff_angle.tan();
        let uv = Vec2::splat(0.5) + half * local.truncate() / local.z;
        self.intensity * textures.color(ColorInput::Texture(texture), uv)
    }

    /// Emitted power, the texture taken as white.
    pub fn power(&self) -> Rgb {
        let mean_cos = 0.5 * (self.cutoff_angle.cos() + self.beam_width.cos());
        2.0 * PI * (1.0 - mean_cos) * self.intensity
    }
}

/// Light from `position` at `p`: the intensity in that direction over the squared distance.
pub(super) fn towards(position: Vec3, p: Vec3, intensity: impl Fn(Vec3) -> Rgb) -> Option<DeltaSample> {
    let to_light = position - p;
    let distance_squared = to_light.length_squared();
    (distance_squared > 0.0).then(|| {
        let wi = to_light / distance_squared.sqrt();
        let radiance = intensity(-wi) / distance_squared;
        DeltaSample { wi, radiance, target: Target::Point(position) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_light_falls_off_with_the_square() {
        let light = PointLight { position: Vec3::Z, intensity: Rgb::ONE };
        let s = light.sample(Vec3::new(0.0, 0.0, -1.0)).unwrap();
        assert_eq!((s.wi, s.radiance), (Vec3::Z, Rgb::splat(0.25)));
        assert!(light.sample(Vec3::Z).is_none());
    }

    #[test]
    fn a_spot_light_ends_at_its_cutoff() {
        let none = Textures::new(&[], &[]);
        let light = SpotLight::new(Mat4::IDENTITY, Rgb::ONE, 0.5, 0.3, None);
        let at = |angle: f32| {
            light.sample(Vec3::new(angle.sin(), 0.0, angle.cos()), &none).map_or(0.0, |s| s.radiance.x)
        };
        assert!((at(0.0) - 1.0).abs() < 1e-6 && (at(0.29) - 1.0).abs() < 1e-6);
        assert!((at(0.4) - 0.5).abs() < 1e-3);
        assert_eq!(at(0.51), 0.0);
        assert!(light.sample(-Vec3::Z, &none).is_none());
    }
}
