//! The clear sky and its sun, after Hošek & Wilkie.
//!
//! In: turbidity, the ground's albedo, where the sun is. Out: radiance, and directions with their densities: of the sky
//! from a table, of the sun from the cone it fills. The zenith is +Z of the sky's own space; below its horizon there is
//! nothing.

mod hosek_wilkie;

use std::f32::consts::{PI, TAU};

use glam::{Mat3, Vec2, Vec3};
use sr_sampling::warp::{UniformCone, unit_circle};
use sr_sampling::{Distribution, PiecewiseConstant2D, Sample};
use sr_scene::Rgb;

use super::{LightId, LightSample, Target};
use crate::texture::luminance;
use hosek_wilkie::{SkyModel, sun_radiance};

/// Cells of the table: around, and from the horizon up.
const CELLS: [usize; 2] = [64, 32];
/// Points along each side of a cell.
const POINTS_PER_CELL: usize = 2;
/// The part of the mean that every cell has on top of its own: no direction of the sky is left out.
const FLOOR: f32 = 0.02;
/// What the angle of the sun's disk is in nature, in radians.
const TRUE_APERTURE: f32 = 0.5358 * PI / 180.0;

/// The sky without its sun.
#[derive(Clone, Debug)]
pub struct Sky {
    model: SkyModel,
    scale: f32,
    world_from_light: Mat3,
    /// Over (φ / 2π, z), where areas are solid angles.
    table: Option<PiecewiseConstant2D>,
    mean_radiance: Rgb,
}

impl Sky {
    /// `sun_direction` is in the sky's own space; a sun below the horizon leaves no light.
    pub fn new(turbidity: f32, albedo: Rgb, sun_direction: Vec3, scale: f32, world_from_light: Mat3) -> Self {
        let model = SkyModel::new(turbidity, albedo, sun_direction);
        let [around, up] = CELLS.map(|n| n * POINTS_PER_CELL);
        let (mut weights, mut mean) = (vec![0.0; CELLS[0] * CELLS[1]], glam::DVec3::ZERO);
        for row in 0..up {
            for column in 0..around {
                let uv = Vec2::new((column as f32 + 0.5) / around as f32, (row as f32 + 0.5) / up as f32);
                let radiance = model.radiance(direction(uv));
                weights[row / POINTS_PER_CELL * CELLS[0] + column / POINTS_PER_CELL] += luminance(radiance);
                mean += radiance.as_dvec3();
            }
        }
        let floor = FLOOR * weights.iter().sum::<f32>() / weights.len() as f32;
        weights.iter_mut().for_each(|w| *w += floor);
        // half of all directions are below the horizon
        let mean_radiance = scale * (mean / (2 * around * up) as f64).as_vec3();
        let table = PiecewiseConstant2D::new(&weights, CELLS[0]).ok();
        Self { model, scale, world_from_light, table, mean_radiance }
    }

    /// The mean over all directions.
    pub fn mean_radiance(&self) -> Rgb {
        self.mean_radiance
    }

    /// Radiance arriving from direction `wi`, in world space.
    pub fn radiance(&self, wi: Vec3) -> Rgb {
        self.scale * self.model.radiance(self.world_from_light.transpose() * wi)
    }

    /// A direction above the horizon, in proportion to luminance.
    pub(crate) fn sample(&self, light: LightId, u: Vec2) -> Option<LightSample> {
        let Sample { value: uv, pdf } = self.table.as_ref()?.sample(u)?;
        let wi = self.world_from_light * direction(uv);
        Some(LightSample { wi, pdf: pdf / TAU, target: Target::Infinity, light, uv: Vec2::ZERO })
    }

    /// The density of `sample` at a direction in world space, in sr⁻¹.
    pub fn pdf(&self, wi: Vec3) -> f32 {
        let local = self.world_from_light.transpose() * wi;
        let u = local.y.atan2(local.x) / TAU;
        let largest = 1.0 - f32::EPSILON / 2.0;
        let uv = Vec2::new(if u < 0.0 { u + 1.0 } else { u }.min(largest), local.z.min(largest));
        match &self.table {
            Some(table) if local.z >= 0.0 => table.pdf(uv) / TAU,
            _ => 0.0,
        }
    }
}

/// The direction at (φ / 2π, z).
fn direction(uv: Vec2) -> Vec3 {
    let around = (1.0 - uv.y * uv.y).max(0.0).sqrt() * unit_circle(uv.x);
    around.extend(uv.y)
}

/// The sun's disk, the same radiance all over it.
#[derive(Clone, Copy, Debug)]
pub struct Sun {
    radiance: Rgb,
    cone: Option<UniformCone>,
    /// The sun's middle is its +Z.
    world_from_sun: Mat3,
    /// The zenith: what is below the horizon is dark.
    up: Vec3,
}

impl Sun {
    /// `direction` is in the sky's own space; `aperture` is the full angle of the disk, and the wider it is the dimmer,
    /// so that the irradiance stays.
    pub fn new(turbidity: f32, direction: Vec3, scale: f32, aperture: f32, world_from_light: Mat3) -> Self {
        let sin2 = |angle: f32| (0.5 * angle).sin().powi(2);
        // solid angles 2π (1 − cos) = 4π sin² of half the angle
        let dimmer = sin2(0.5 * TRUE_APERTURE) / sin2(0.5 * aperture);
        let z = world_from_light * direction;
        let (x, y) = z.any_orthonormal_pair();
        let is_up = direction.z >= 0.0;
        let radiance =
            if is_up { sun_radiance(turbidity, direction.z) * (scale * dimmer) } else { Rgb::ZERO };
        Self {
            radiance,
            cone: UniformCone::from_sin2(sin2(aperture)).ok(),
            world_from_sun: Mat3::from_cols(x, y, z),
            up: world_from_light * Vec3::Z,
        }
    }

    /// The mean over all directions.
    pub fn mean_radiance(&self) -> Rgb {
        self.radiance * self.cone.map_or(0.0, |cone| cone.solid_angle()) / (2.0 * TAU)
    }

    /// Radiance arriving from direction `wi`, in world space.
    pub fn radiance(&self, wi: Vec3) -> Rgb {
        if self.pdf(wi) > 0.0 && self.up.dot(wi) >= 0.0 { self.radiance } else { Rgb::ZERO }
    }

    /// A direction to the disk, all equally likely.
    pub(crate) fn sample(&self, light: LightId, u: Vec2) -> Option<LightSample> {
        let Sample { value, pdf } = self.cone?.sample(u)?;
        let wi = self.world_from_sun * value;
        Some(LightSample { wi, pdf, target: Target::Infinity, light, uv: Vec2::ZERO })
    }

    /// The density of `sample` at a direction in world space, in sr⁻¹.
    pub fn pdf(&self, wi: Vec3) -> f32 {
        self.cone.map_or(0.0, |cone| cone.pdf(self.world_from_sun.transpose() * wi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sky_and_its_density_end_at_the_horizon() {
        let sky = Sky::new(3.0, Rgb::splat(0.3), Vec3::new(0.6, 0.0, 0.8), 2.0, Mat3::IDENTITY);
        for i in 0..1000 {
            let u = Vec2::new(i as f32 / 1000.0, (i * 379 % 1000) as f32 / 1000.0);
            let s = sky.sample(LightId(0), u).unwrap();
            assert!(s.wi.z >= 0.0 && s.pdf > 0.0);
            assert!(sky.radiance(s.wi).min_element() >= 0.0);
        }
        let below = Vec3::new(0.8, 0.0, -0.6);
        assert_eq!((sky.radiance(below), sky.pdf(below)), (Rgb::ZERO, 0.0));
    }

    /// However wide the disk is drawn.
    #[test]
    fn the_suns_irradiance_stays() {
        let power = |degrees: f32| {
            let sun = Sun::new(3.0, Vec3::new(0.6, 0.0, 0.8), 1.0, degrees.to_radians(), Mat3::IDENTITY);
            sun.mean_radiance().x
        };
        for degrees in [0.1, 5.0, 20.0] {
            assert!((power(degrees) / power(0.5358) - 1.0).abs() < 1e-4, "{degrees}: {}", power(degrees));
        }
    }

    #[test]
    fn no_sun_below_the_horizon() {
        let down = Vec3::new(0.8, 0.0, -0.6);
        assert_eq!(Sun::new(3.0, down, 1.0, 0.01, Mat3::IDENTITY).mean_radiance(), Rgb::ZERO);
        let sky = Sky::new(3.0, Rgb::splat(0.3), down, 1.0, Mat3::IDENTITY);
        assert_eq!((sky.mean_radiance(), sky.radiance(Vec3::Z)), (Rgb::ZERO, Rgb::ZERO));
        assert!(sky.sample(LightId(0), Vec2::splat(0.5)).is_none());
    }
}
