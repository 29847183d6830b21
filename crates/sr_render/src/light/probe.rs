//! One light by itself, in all directions: what an image of it shows.

use glam::Vec3;
use sr_scene::{LightDesc, Rgb, SceneDesc};

use super::{Compiled, Delta, Extended, Target, compile_light};
use crate::texture::Textures;

/// A light without a surface, to be looked at.
pub struct Probe<'a> {
    light: Compiled,
    textures: &'a Textures,
}

impl<'a> Probe<'a> {
    /// A light of a validated description; `textures` are those of the description.
    pub fn new(light: &LightDesc, scene: &SceneDesc, textures: &'a Textures) -> Self {
        Self { light: compile_light(light, scene), textures }
    }

    /// The radiance that arrives from direction `wi`, in world space; black of what is not all around the scene.
    pub fn radiance(&self, wi: Vec3) -> Rgb {
        match &self.light {
            Compiled::Extended(Extended::Constant(light)) => light.radiance,
            Compiled::Extended(Extended::Environment(light)) => light.radiance(wi),
            Compiled::Extended(Extended::Sky(light)) => light.radiance(wi),
            Compiled::Extended(Extended::Sun(light)) => light.radiance(wi),
            Compiled::Extended(Extended::Area(_)) | Compiled::Delta(_) => Rgb::ZERO,
        }
    }

    /// The radiant intensity of a light at `position` along `w`, in world space; black of what is no point.
    pub fn intensity(&self, position: Vec3, w: Vec3) -> Rgb {
        // At the distance 1 it is what arrives.
        let p = position + w;
        let found = match &self.light {
            Compiled::Delta(Delta::Point(light)) => light.sample(p),
            Compiled::Delta(Delta::Spot(light)) => light.sample(p, self.textures),
            Compiled::Delta(Delta::Projector(light)) => light.sample(p, self.textures),
            Compiled::Delta(Delta::Goniometric(light)) => light.sample(p),
            Compiled::Delta(Delta::Profile(light)) => light.sample(p),
            Compiled::Delta(Delta::Directional(_)) | Compiled::Extended(_) => None,
        };
        found.filter(|sample| sample.target != Target::Infinity).map_or(Rgb::ZERO, |sample| sample.radiance)
    }
}
