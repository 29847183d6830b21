//! Lights as images of all directions.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use rayon::prelude::*;
use sr_render::light::{Probe, sphere_direction};
use sr_scene::{Image, LightDesc, Pixels, Rgb, SceneDesc, SphereMapping};

use crate::bake::{Baker, decoded};

/// Looks in each direction of a texel: so often across and down.
const LOOKS: u32 = 2;

/// An image of what `of` is in each direction, the mean over each texel.
pub fn image(
    name: &str,
    (width, height): (u32, u32),
    mapping: SphereMapping,
    of: impl Fn(Vec3) -> Rgb + Sync,
) -> Arc<Image> {
    let size = Vec2::new(width as f32, height as f32);
    let texel = |at: u32| {
        let corner = Vec2::new((at % width) as f32, (at / width) as f32);
        let mut sum = Rgb::ZERO;
        for look in 0..LOOKS * LOOKS {
            let offset = Vec2::new((look % LOOKS) as f32 + 0.5, (look / LOOKS) as f32 + 0.5) / LOOKS as f32;
            let mut uv = (corner + offset) / size;
            if mapping == SphereMapping::LatLong {
                // The middles of the first and the last row are at the poles.
                uv.y = ((corner.y + offset.y - 0.5) / (size.y - 1.0).max(1.0)).clamp(0.0, 1.0);
            }
            sum += of(sphere_direction(mapping, uv));
        }
        (sum / (LOOKS * LOOKS) as f32).to_array()
    };
    let data = (0..width * height).into_par_iter().flat_map_iter(texel).collect();
    Arc::new(Image { name: name.to_owned(), width, height, pixels: Pixels::F32 { channels: 3, data } })
}

/// A side of a square image that is about as fine as another image, and not coarse.
pub fn square_side(image: &Image) -> u32 {
    let texels = image.width as f32 * image.height as f32;
    ((1.25 * texels.sqrt()).ceil() as u32).clamp(512, 2048)
}

/// The mean over all directions of the intensity of a light at a point.
pub fn mean_intensity(scene: &SceneDesc, baker: &Baker<'_>, light: &LightDesc, position: Vec3) -> Rgb {
    let probe = Probe::new(light, scene, baker.textures());
    // All texels of such an image fill the same solid angle.
    let mapping = SphereMapping::EqualAreaOctahedral;
    let image = image("", (128, 128), mapping, |w| probe.intensity(position, w));
    let sum = decoded(&image, false).fold(glam::DVec3::ZERO, |sum, color| sum + color.as_dvec3());
    (sum / f64::from(image.width * image.height)).as_vec3()
}
