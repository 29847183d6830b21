//! Descriptions of lights without a surface to what is sampled.

use std::sync::Arc;

use glam::Vec2;
use sr_scene::{ColorInput, LightDesc, SceneDesc, TextureDesc};

use super::point::Cone;
use super::sphere_image::SphereImage;
use super::{
    ConstantEnvironment, Delta, DirectionalLight, Environment, EnvironmentSampling, Extended,
    GoniometricLight, PointLight, ProfileLight, Projector, Sky, SpotLight, Sun,
};

/// Either kind of light.
pub(crate) enum Compiled {
    Extended(Extended),
    Delta(Delta),
}

/// Prepares a light of a validated description for sampling.
pub(crate) fn compile_light(light: &LightDesc, desc: &SceneDesc) -> Compiled {
    let image = |index: u32| Arc::clone(&desc.images[index as usize]);
    match *light {
        LightDesc::Constant { radiance, .. } => {
            Compiled::Extended(Extended::Constant(ConstantEnvironment { radiance }))
        }
        LightDesc::Environment {
            image: index,
            mapping,
            scale,
            world_from_light,
            mis_compensation,
            ref portals,
            ..
        } => {
            let sampling = EnvironmentSampling { mis_compensation, portals: portals.clone() };
            let light = Environment::new(image(index), mapping, scale, world_from_light, &sampling);
            Compiled::Extended(Extended::Environment(light))
        }
        LightDesc::Sky { turbidity, albedo, sun_direction, scale, world_from_light, .. } => {
            let sky = Sky::new(turbidity, albedo, sun_direction, scale, world_from_light);
            Compiled::Extended(Extended::Sky(sky))
        }
        LightDesc::Sun { turbidity, direction, scale, aperture, world_from_light, .. } => {
            let sun = Sun::new(turbidity, direction, scale, aperture, world_from_light);
            Compiled::Extended(Extended::Sun(sun))
        }
        LightDesc::Point { position, intensity, range, .. } => {
            Compiled::Delta(Delta::Point(PointLight { position, intensity, range }))
        }
        LightDesc::Directional { direction, irradiance, .. } => {
            Compiled::Delta(Delta::Directional(DirectionalLight { direction, irradiance }))
        }
        LightDesc::Spot {
            world_from_light,
            intensity,
            cutoff_angle,
            beam_width,
            falloff,
            range,
            texture,
            ..
        } => {
            let cone = Cone { cutoff_angle, beam_width, falloff };
            let spot = SpotLight::new(world_from_light, intensity, cone, range, texture);
            Compiled::Delta(Delta::Spot(spot))
        }
        LightDesc::Projector { world_from_light, irradiance, scale, fov_axis, fov, .. } => {
            let aspect = aspect(irradiance, desc);
            let tan_x = (0.5 * fov_axis.horizontal(fov, aspect)).tan();
            let tan_half = Vec2::new(tan_x, tan_x / aspect);
            Compiled::Delta(Delta::Projector(Projector::new(world_from_light, irradiance, scale, tan_half)))
        }
        LightDesc::Goniometric { world_from_light, intensity, image: index, mapping, .. } => {
            let map = SphereImage::new(image(index), mapping);
            Compiled::Delta(Delta::Goniometric(GoniometricLight::new(world_from_light, intensity, map)))
        }
        LightDesc::Profile { world_from_light, intensity, ref profile, .. } => {
            let light = ProfileLight::new(world_from_light, intensity, Arc::clone(profile));
            Compiled::Delta(Delta::Profile(light))
        }
    }
}

/// Width over height of an image; 1 of anything else.
fn aspect(input: ColorInput, desc: &SceneDesc) -> f32 {
    let ColorInput::Texture(id) = input else { return 1.0 };
    match &desc.textures[id.0 as usize] {
        TextureDesc::Bitmap { image, .. } => {
            let image = &desc.images[*image as usize];
            image.width as f32 / image.height as f32
        }
        _ => 1.0,
    }
}
