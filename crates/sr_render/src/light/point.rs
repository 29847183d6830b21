//! Lights of no extent: deltas, found by light sampling alone.

use std::f32::consts::PI;

use glam::{Mat4, Vec2, Vec3};
use sr_scene::{ColorInput, Rgb, SpotFalloff, TextureId};

use super::{DeltaSample, Target};
use crate::texture::Textures;

/// A point that shines equally in all directions.
#[derive(Clone, Copy, Debug)]
pub struct PointLight {
    /// Position.
    pub position: Vec3,
    /// Radiant intensity, in W sr⁻¹.
    pub intensity: Rgb,
    /// How far it shines.
    pub range: f32,
}

impl PointLight {
    /// Light arriving at `p`: I / r², faded out at the range.
    pub fn sample(&self, p: Vec3) -> Option<DeltaSample> {
        let fading = within(self.range, self.position, p);
        towards(self.position, p, |_| self.intensity * fading).filter(|_| fading > 0.0)
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

/// How much of a light there is at a point that is within its range, as KHR_lights_punctual recommends.
fn within(range: f32, from: Vec3, p: Vec3) -> f32 {
    let part = from.distance_squared(p) / (range * range);
    (1.0 - part * part).clamp(0.0, 1.0)
}

/// A cone about +Z: full within `beam_width`, then falling to nothing at `cutoff_angle`. Angles in radians.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// Nothing is beyond.
    pub cutoff_angle: f32,
    /// Everything is within.
    pub beam_width: f32,
    /// In between.
    pub falloff: SpotFalloff,
}

impl Cone {
    fn at(&self, cos_angle: f32) -> f32 {
        let (cos_cutoff, cos_beam) = (self.cutoff_angle.cos(), self.beam_width.cos());
        if cos_angle <= cos_cutoff {
            return 0.0;
        }
        if cos_angle >= cos_beam {
            return 1.0;
        }
        match self.falloff {
            SpotFalloff::Linear => {
                let angle = cos_angle.clamp(-1.0, 1.0).acos();
                (self.cutoff_angle - angle) / (self.cutoff_angle - self.beam_width)
            }
            SpotFalloff::SquaredCosine => ((cos_angle - cos_cutoff) / (cos_beam - cos_cutoff)).powi(2),
        }
    }
}

/// A point that shines into a cone about +Z of its own space.
#[derive(Clone, Copy, Debug)]
pub struct SpotLight {
    light_from_world: Mat4,
    position: Vec3,
    intensity: Rgb,
    cone: Cone,
    range: f32,
    texture: Option<TextureId>,
}

impl SpotLight {
    /// `world_from_light` is rigid.
    pub fn new(
        world_from_light: Mat4,
        intensity: Rgb,
        cone: Cone,
        range: f32,
        texture: Option<TextureId>,
    ) -> Self {
        Self {
            light_from_world: world_from_light.inverse(),
            position: world_from_light.transform_point3(Vec3::ZERO),
            intensity,
            cone,
            range,
            texture,
        }
    }

    /// Light arriving at `p`.
    pub fn sample(&self, p: Vec3, textures: &Textures) -> Option<DeltaSample> {
        let fading = within(self.range, self.position, p);
        towards(self.position, p, |outwards| {
            let local = self.light_from_world.transform_vector3(outwards).normalize();
            self.cone.at(local.z) * fading * self.tint(local, textures)
        })
        .filter(|s| s.radiance != Rgb::ZERO)
    }

    fn tint(&self, local: Vec3, textures: &Textures) -> Rgb {
        let Some(texture) = self.texture else { return self.intensity };
        let half = 0.5 / self.cone.cutoff_angle.tan();
        let uv = Vec2::splat(0.5) + half * local.truncate() / local.z;
        self.intensity * textures.color(ColorInput::Texture(texture), uv)
    }

    /// Emitted power, the texture taken as white.
    pub fn power(&self) -> Rgb {
        let mean_cos = 0.5 * (self.cone.cutoff_angle.cos() + self.cone.beam_width.cos());
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
        let light = PointLight { position: Vec3::Z, intensity: Rgb::ONE, range: f32::INFINITY };
        let s = light.sample(Vec3::new(0.0, 0.0, -1.0)).unwrap();
        assert_eq!((s.wi, s.radiance), (Vec3::Z, Rgb::splat(0.25)));
        assert!(light.sample(Vec3::Z).is_none());
        // Half of the range away: 1 − 1/16 is left.
        let light = PointLight { range: 4.0, ..light };
        assert_eq!(light.sample(Vec3::NEG_Z).unwrap().radiance, Rgb::splat(0.25 * 15.0 / 16.0));
        assert!(light.sample(Vec3::new(0.0, 0.0, -3.0)).is_none());
    }

    #[test]
    fn a_cone_by_the_square_of_a_cosine() {
        let cone = Cone { cutoff_angle: 1.0, beam_width: 0.5, falloff: SpotFalloff::SquaredCosine };
        let middle = 0.5 * (1_f32.cos() + 0.5_f32.cos());
        assert_eq!((cone.at(0.5_f32.cos()), cone.at(1_f32.cos())), (1.0, 0.0));
        assert!((cone.at(middle) - 0.25).abs() < 1e-6);
    }

    #[test]
    fn a_spot_light_ends_at_its_cutoff() {
        let none = Textures::new(&[], &[]);
        let cone = Cone { cutoff_angle: 0.5, beam_width: 0.3, falloff: SpotFalloff::Linear };
        let light = SpotLight::new(Mat4::IDENTITY, Rgb::ONE, cone, f32::INFINITY, None);
        let at = |angle: f32| {
            light.sample(Vec3::new(angle.sin(), 0.0, angle.cos()), &none).map_or(0.0, |s| s.radiance.x)
        };
        assert!((at(0.0) - 1.0).abs() < 1e-6 && (at(0.29) - 1.0).abs() < 1e-6);
        assert!((at(0.4) - 0.5).abs() < 1e-3);
        assert_eq!(at(0.51), 0.0);
        assert!(light.sample(-Vec3::Z, &none).is_none());
    }
}
