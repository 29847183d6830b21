//! Points that project images, and points whose intensity images or measurements tell.

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use glam::{Mat4, Vec2, Vec3};
use sr_scene::{ColorInput, IntensityProfile, Rgb};

use super::DeltaSample;
use super::point::towards;
use super::sphere_image::SphereImage;
use crate::texture::Textures;

/// A camera turned round: an image projected along +Z of its own space.
#[derive(Clone, Copy, Debug)]
pub struct Projector {
    light_from_world: Mat4,
    position: Vec3,
    irradiance: ColorInput,
    scale: f32,
    tan_half: Vec2,
}

impl Projector {
    /// `tan_half`: half the image's width and height on the plane one unit away.
    pub fn new(world_from_light: Mat4, irradiance: ColorInput, scale: f32, tan_half: Vec2) -> Self {
        Self {
            light_from_world: world_from_light.inverse(),
            position: world_from_light.transform_point3(Vec3::ZERO),
            irradiance,
            scale,
            tan_half,
        }
    }

    /// Light arriving at `p`: so much that a plane across the axis is evenly lit by an even image.
    pub fn sample(&self, p: Vec3, textures: &Textures) -> Option<DeltaSample> {
        towards(self.position, p, |outwards| {
            let local = self.light_from_world.transform_vector3(outwards).normalize();
            if !(local.z > 0.0) {
                return Rgb::ZERO;
            }
            // as a camera sees it: x to the left, y up
            let uv = 0.5 - 0.5 * local.truncate() / (local.z * self.tan_half);
            if !(uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all()) {
                return Rgb::ZERO;
            }
            let per_cos3 = 1.0 / (local.z * local.z * local.z);
            textures.color(self.irradiance, uv) * (PI * self.scale * per_cos3)
        })
        .filter(|s| s.radiance != Rgb::ZERO)
    }

    /// Emitted power: irradiance times area on the plane one unit away, where the cosine there takes one of the
    /// intensity's three.
    pub fn power(&self, textures: &Textures) -> Rgb {
        let area = 4.0 * self.tan_half.x * self.tan_half.y;
        textures.average(self.irradiance) * (PI * self.scale * area)
    }
}

/// A point whose intensity an image of all directions tells.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    light_from_world: Mat4,
    position: Vec3,
    intensity: Rgb,
    map: SphereImage,
    mean: Rgb,
}

impl GoniometricLight {
    pub(super) fn new(world_from_light: Mat4, intensity: Rgb, map: SphereImage) -> Self {
        Self {
            light_from_world: world_from_light.inverse(),
            position: world_from_light.transform_point3(Vec3::ZERO),
            intensity,
            mean: map.mean(),
            map,
        }
    }

    /// Light arriving at `p`.
    pub fn sample(&self, p: Vec3) -> Option<DeltaSample> {
        towards(self.position, p, |outwards| {
            let local = self.light_from_world.transform_vector3(outwards).normalize();
            self.intensity * self.map.at(self.map.uv_of(local))
        })
        .filter(|s| s.radiance != Rgb::ZERO)
    }

    /// Emitted power.
    pub fn power(&self) -> Rgb {
        2.0 * TAU * self.intensity * self.mean
    }
}

/// A point whose intensity was measured over vertical and horizontal angles.
#[derive(Clone, Debug)]
pub struct ProfileLight {
    light_from_world: Mat4,
    position: Vec3,
    intensity: Rgb,
    profile: Arc<IntensityProfile>,
    mean: f32,
}

impl ProfileLight {
    /// `intensity` multiplies the profile's candelas.
    pub fn new(world_from_light: Mat4, intensity: Rgb, profile: Arc<IntensityProfile>) -> Self {
        Self {
            light_from_world: world_from_light.inverse(),
            position: world_from_light.transform_point3(Vec3::ZERO),
            intensity,
            mean: mean_candelas(&profile),
            profile,
        }
    }

    /// Light arriving at `p`.
    pub fn sample(&self, p: Vec3) -> Option<DeltaSample> {
        towards(self.position, p, |outwards| {
            self.intensity * candelas(&self.profile, self.light_from_world.transform_vector3(outwards))
        })
        .filter(|s| s.radiance != Rgb::ZERO)
    }

    /// Emitted power.
    pub fn power(&self) -> Rgb {
        2.0 * TAU * self.mean * self.intensity
    }
}

/// Intensity along a direction with +Z to the nadir, bilinear between the measured angles; 0 beyond them.
fn candelas(profile: &IntensityProfile, local: Vec3) -> f32 {
    let vertical = local.truncate().length().atan2(local.z);
    let around = local.y.atan2(local.x);
    let Some((v, s)) = bracket(&profile.vertical, vertical) else { return 0.0 };
    let (h, t) = horizontal(&profile.horizontal, if around < 0.0 { around + TAU } else { around });
    let rows = profile.vertical.len();
    let along = |h: usize| {
        let at = |v: usize| profile.candelas[h * rows + v.min(rows - 1)];
        at(v) + s * (at(v + 1) - at(v))
    };
    let next = (h + 1) % profile.horizontal.len();
    along(h) + t * (along(next) - along(h))
}

/// The last angle at or below `x`, and how far on it is to the next; `None` outside of all.
fn bracket(angles: &[f32], x: f32) -> Option<(usize, f32)> {
    let (first, last) = (*angles.first()?, *angles.last()?);
    // angles come in degrees: half a turn rounds to either side
    if !(first - 1e-5..=last + 1e-5).contains(&x) {
        return None;
    }
    let above = angles.partition_point(|&a| a <= x).clamp(1, angles.len().max(2) - 1);
    let (Some(&low), Some(&high)) = (angles.get(above - 1), angles.get(above)) else { return Some((0, 0.0)) };
    Some((above - 1, ((x - low) / (high - low)).clamp(0.0, 1.0)))
}

/// The same around the vertical: what was not measured is mirrored as the last angle says.
fn horizontal(angles: &[f32], x: f32) -> (usize, f32) {
    let last = angles.last().copied().unwrap_or(0.0);
    let folded = if last < 0.25 * PI {
        return (0, 0.0);
    } else if last < 0.75 * PI {
        let half = if x > PI { TAU - x } else { x };
        half.min(PI - half)
    } else if last < 1.25 * PI {
        x.min(TAU - x)
    } else {
        x
    };
    // measurements of the whole turn may end before it, and the first angle closes it
    bracket(angles, folded).unwrap_or_else(|| {
        let (end, start) = (last, angles[0]);
        (angles.len() - 1, ((folded - end) / (TAU + start - end)).clamp(0.0, 1.0))
    })
}

/// The mean over all directions.
fn mean_candelas(profile: &IntensityProfile) -> f32 {
    const N: usize = 128;
    let mut sum = 0.0_f64;
    for i in 0..N * 2 * N {
        let (row, column) = (i / (2 * N), i % (2 * N));
        let z = 1.0 - 2.0 * (row as f32 + 0.5) / N as f32;
        let (sin, cos) = (TAU * (column as f32 + 0.5) / (2 * N) as f32).sin_cos();
        let r = (1.0 - z * z).sqrt();
        sum += f64::from(candelas(profile, Vec3::new(r * cos, r * sin, z)));
    }
    (sum / (2 * N * N) as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(vertical: &[f32], horizontal: &[f32], candelas: &[f32]) -> IntensityProfile {
        let radians = |degrees: &[f32]| degrees.iter().map(|d| d.to_radians()).collect();
        IntensityProfile {
            name: "test".into(),
            vertical: radians(vertical),
            horizontal: radians(horizontal),
            candelas: candelas.to_vec(),
        }
    }

    fn at(profile: &IntensityProfile, vertical: f32, horizontal: f32) -> f32 {
        let (sin, cos) = vertical.to_radians().sin_cos();
        let (sin_h, cos_h) = horizontal.to_radians().sin_cos();
        candelas(profile, Vec3::new(sin * cos_h, sin * sin_h, cos))
    }

    #[test]
    fn intensities_are_linear_between_angles_and_end_with_them() {
        let p = profile(&[0.0, 30.0, 90.0], &[0.0], &[100.0, 40.0, 10.0]);
        for (vertical, expected) in
            [(0.0, 100.0), (15.0, 70.0), (30.0, 40.0), (60.0, 25.0), (90.0, 10.0), (91.0, 0.0)]
        {
            assert!((at(&p, vertical, 123.0) - expected).abs() < 1e-3, "{vertical}");
        }
        let one = profile(&[0.0], &[0.0], &[5.0]);
        assert_eq!((at(&one, 0.0, 0.0), at(&one, 10.0, 0.0)), (5.0, 0.0));
    }

    #[test]
    fn halves_and_quarters_are_mirrored() {
        let quarter = profile(&[0.0, 180.0], &[0.0, 90.0], &[0.0, 0.0, 9.0, 9.0]);
        for (horizontal, expected) in [(0.0, 0.0), (30.0, 3.0), (120.0, 6.0), (200.0, 2.0), (330.0, 3.0)] {
            assert!((at(&quarter, 90.0, horizontal) - expected).abs() < 1e-3, "{horizontal}");
        }
        let half = profile(&[0.0, 180.0], &[0.0, 180.0], &[0.0, 0.0, 18.0, 18.0]);
        for (horizontal, expected) in [(0.0, 0.0), (30.0, 3.0), (180.0, 18.0), (270.0, 9.0)] {
            assert!((at(&half, 90.0, horizontal) - expected).abs() < 1e-3, "{horizontal}");
        }
        let whole =
            profile(&[0.0, 180.0], &[0.0, 90.0, 180.0, 270.0], &[0.0, 0.0, 9.0, 9.0, 0.0, 0.0, 6.0, 6.0]);
        for (horizontal, expected) in [(45.0, 4.5), (270.0, 6.0), (315.0, 3.0)] {
            assert!((at(&whole, 90.0, horizontal) - expected).abs() < 1e-3, "{horizontal}");
        }
    }

    #[test]
    fn an_even_profile_is_a_point_light() {
        let even = profile(&[0.0, 180.0], &[0.0], &[7.0, 7.0]);
        let light = ProfileLight::new(Mat4::IDENTITY, Rgb::ONE, Arc::new(even));
        assert!((light.power().x / (2.0 * TAU * 7.0) - 1.0).abs() < 1e-4);
        assert!((light.sample(Vec3::new(0.0, 2.0, 0.0)).unwrap().radiance.x - 7.0 / 4.0).abs() < 1e-5);
        assert!(light.sample(Vec3::ZERO).is_none());
    }

    #[test]
    fn a_projector_lights_a_plane_evenly() {
        let none = Textures::new(&[], &[]);
        let white = ColorInput::Constant(Rgb::ONE);
        let light = Projector::new(Mat4::IDENTITY, white, 2.0, Vec2::new(1.0, 0.5));
        let irradiance = |x: f32, y: f32| {
            let p = Vec3::new(x, y, 2.0);
            light.sample(p, &none).map_or(0.0, |s| s.radiance.x * -s.wi.z)
        };
        for (x, y) in [(0.0, 0.0), (1.9, 0.0), (-1.0, 0.9)] {
            assert!((irradiance(x, y) - 0.5 * PI).abs() < 1e-5, "{x} {y}: {}", irradiance(x, y));
        }
        assert_eq!((irradiance(2.1, 0.0), irradiance(0.0, 1.1)), (0.0, 0.0));
        assert!(light.sample(-Vec3::Z, &none).is_none(), "behind");
        assert!((light.power(&none).x - 4.0 * PI).abs() < 1e-4);
    }
}
