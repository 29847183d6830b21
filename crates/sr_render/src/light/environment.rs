//! Light from infinitely far away, all around.

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use glam::{Mat3, Vec2, Vec3};
use sr_sampling::warp::{UniformSphere, unit_circle};
use sr_sampling::{Distribution, PiecewiseConstant2D, Plane, Sample};
use sr_scene::{Image, Pixels, Rgb};

use super::{LightId, LightSample, Target};
use crate::texture::{bilinear, luminance, texel, to_cell};

/// The same radiance from every direction.
#[derive(Clone, Copy, Debug)]
pub struct ConstantEnvironment {
    /// Radiance.
    pub radiance: Rgb,
}

impl ConstantEnvironment {
    /// A direction, all equally likely.
    pub(crate) fn sample(&self, light: LightId, u: Vec2) -> Option<LightSample> {
        let Sample { value: wi, pdf } = UniformSphere.sample(u)?;
        Some(LightSample { wi, pdf, target: Target::Infinity, light, uv: Vec2::ZERO })
    }

    /// 1 / 4π, in sr⁻¹.
    pub fn pdf(&self) -> f32 {
        0.25 / PI
    }
}

/// An image around the scene, in latitude–longitude form, sampled in proportion to its luminance.
#[derive(Clone, Debug)]
pub struct Environment {
    image: Arc<Image>,
    srgb: bool,
    scale: f32,
    world_from_light: Mat3,
    light_from_world: Mat3,
    /// Over (u, v), in proportion to luminance times sin θ.
    table: Option<PiecewiseConstant2D>,
    mean_radiance: Rgb,
}

impl Environment {
    /// Prepares an image for sampling. 8-bit images are taken as sRGB-encoded.
    pub fn new(image: Arc<Image>, scale: f32, world_from_light: Mat3) -> Self {
        let srgb = matches!(image.pixels, Pixels::U8 { .. });
        let (width, height) = (image.width as usize, image.height as usize);
        let lum = |x: usize, y: usize| luminance(texel(&image, srgb, x as u32, y as u32)).max(0.0);
        let mut weights = Vec::with_capacity(width * height);
        let (mut mean, mut total_sin) = (glam::DVec3::ZERO, 0.0_f64);
        for y in 0..height {
            let sin_theta = (PI * (y as f32 + 0.5) / height as f32).sin();
            let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)];
            for x in 0..width {
                let columns = [(x + width - 1) % width, x, (x + 1) % width];
                // the exact mean of the bilinear interpolant over the cell: never 0 where it shines
                let mut sum = 0.0;
                for (row, wy) in rows.into_iter().zip([0.125, 0.75, 0.125]) {
                    for (column, wx) in columns.into_iter().zip([0.125, 0.75, 0.125]) {
                        sum += wx * wy * lum(column, row);
                    }
                }
                weights.push(sum * sin_theta);
                mean += texel(&image, srgb, x as u32, y as u32).as_dvec3() * f64::from(sin_theta);
                total_sin += f64::from(sin_theta);
            }
        }
        Self {
            srgb,
            scale,
            world_from_light,
            light_from_world: world_from_light.transpose(),
            table: PiecewiseConstant2D::new(&weights, width).ok(),
            mean_radiance: (mean / total_sin).as_vec3() * scale,
            image,
        }
    }

    /// The mean over all directions.
    pub fn mean_radiance(&self) -> Rgb {
        self.mean_radiance
    }

    /// Radiance arriving from direction `wi`, in world space: bilinear between texel centres.
    pub fn radiance(&self, wi: Vec3) -> Rgb {
        self.radiance_at(uv_of(self.light_from_world * wi))
    }

    /// [`Self::radiance`] and [`Self::pdf`] of a direction in world space.
    pub(crate) fn seen_along(&self, wi: Vec3) -> (Rgb, f32) {
        let local = self.light_from_world * wi;
        let uv = uv_of(local);
        (self.radiance_at(uv), self.pdf_of(local, uv))
    }

    /// Radiance at a point of the image.
    pub(crate) fn radiance_at(&self, uv: Vec2) -> Rgb {
        let (width, height) = (self.image.width, self.image.height);
        let at = uv * Vec2::new(width as f32, height as f32) - 0.5;
        let (x, y) = (to_cell(at.x), to_cell(at.y));
        let t = at - Vec2::new(x as f32, y as f32);
        let column = |x: i32| {
            if (x as u32) < width { x as u32 } else { i64::from(x).rem_euclid(i64::from(width)) as u32 }
        };
        let row = |y: i32| (y.max(0) as u32).min(height - 1);
        let (columns, rows) = ([column(x), column(x + 1)], [row(y), row(y + 1)]);
        bilinear(&self.image, self.srgb, columns, rows, t) * self.scale
    }

    /// A direction, in proportion to luminance. `None` from a black image.
    pub(crate) fn sample(&self, light: LightId, u: Vec2) -> Option<LightSample> {
        let Sample { value: uv, pdf } = self.sample_image(u)?;
        let (wi, pdf) = direction(&self.world_from_light, uv, pdf);
        (pdf > 0.0).then_some(LightSample { wi, pdf, target: Target::Infinity, light, uv })
    }

    /// A point of the image, in proportion to luminance. `None` from a black image.
    #[inline(always)]
    pub(super) fn sample_image(&self, u: Vec2) -> Option<Sample<Plane>> {
        self.table.as_ref()?.sample(u)
    }

    /// The image's axes, for [`direction`].
    pub(super) fn world_from_light(&self) -> Mat3 {
        self.world_from_light
    }

    /// The density of `sample` at a direction in world space, in sr⁻¹.
    pub fn pdf(&self, wi: Vec3) -> f32 {
        let local = self.light_from_world * wi;
        self.pdf_of(local, uv_of(local))
    }

    fn pdf_of(&self, local: Vec3, uv: Vec2) -> f32 {
        let sin_theta = (local.x * local.x + local.z * local.z).sqrt();
        match &self.table {
            Some(table) if sin_theta > 0.0 => per_solid_angle(table.pdf(uv), sin_theta),
            _ => 0.0,
        }
    }
}

/// The direction of a point of the image, in world space, and the density in sr⁻¹ that becomes of one in the image: 0 at
/// the poles, where there is none. Does not branch.
#[inline(always)]
pub(super) fn direction(world_from_light: &Mat3, uv: Vec2, pdf_uv: f32) -> (Vec3, f32) {
    let (theta, phi) = (unit_circle(0.5 * uv.y), unit_circle(uv.x));
    let local = Vec3::new(theta.y * phi.y, theta.x, -theta.y * phi.x);
    let pdf = per_solid_angle(pdf_uv, theta.y);
    let counts = (theta.y > 0.0) & (pdf < f32::INFINITY);
    (*world_from_light * local, if counts { pdf } else { 0.0 })
}

/// dω = 2π² sin θ du dv.
#[inline(always)]
fn per_solid_angle(pdf_uv: f32, sin_theta: f32) -> f32 {
    pdf_uv / (TAU * PI * sin_theta)
}

#[inline]
fn uv_of(local: Vec3) -> Vec2 {
    let u = local.x.atan2(-local.z) / TAU;
    // atan2 of the two sides of the triangle keeps its precision at the poles, where acos loses it
    let v = (local.x * local.x + local.z * local.z).sqrt().atan2(local.y) / PI;
    Vec2::new(if u < 0.0 { u + 1.0 } else { u }, v)
}
