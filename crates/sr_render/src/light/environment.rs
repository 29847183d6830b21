//! Light from infinitely far away, all around.

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use glam::{Mat3, Vec2, Vec3};
use sr_sampling::warp::UniformSphere;
use sr_sampling::{Distribution, PiecewiseConstant2D, Sample};
use sr_scene::{Image, Pixels, Rgb};

use super::{LightId, LightSample, Target};
use crate::texture::{luminance, texel};

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

    /// Radiance at a point of the image.
    pub(crate) fn radiance_at(&self, uv: Vec2) -> Rgb {
        let (width, height) = (self.image.width, self.image.height);
        let at = uv * Vec2::new(width as f32, height as f32) - 0.5;
        let (cell, t) = (at.floor(), at - at.floor());
        let column = |x: f32| (x as i64).rem_euclid(i64::from(width)) as u32;
        let row = |y: f32| (y.max(0.0) as u32).min(height - 1);
        let fetch = |x: f32, y: f32| texel(&self.image, self.srgb, column(x), row(y));
        let top = fetch(cell.x, cell.y).lerp(fetch(cell.x + 1.0, cell.y), t.x);
        let bottom = fetch(cell.x, cell.y + 1.0).lerp(fetch(cell.x + 1.0, cell.y + 1.0), t.x);
        top.lerp(bottom, t.y) * self.scale
    }

    /// A direction, in proportion to luminance. `None` from a black image.
    #[inline(never)]
    pub(crate) fn sample(&self, light: LightId, u: Vec2) -> Option<LightSample> {
        let Sample { value: uv, pdf } = self.table.as_ref()?.sample(u)?;
        let (sin_theta, cos_theta) = (PI * uv.y).sin_cos();
        let (sin_phi, cos_phi) = (TAU * uv.x).sin_cos();
        let local = Vec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi);
        let pdf = per_solid_angle(pdf, sin_theta);
        (sin_theta > 0.0 && pdf.is_finite()).then(|| LightSample {
            wi: self.world_from_light * local,
            pdf,
            target: Target::Infinity,
            light,
            uv,
        })
    }

    /// The density of `sample` at a direction in world space, in sr⁻¹.
    pub fn pdf(&self, wi: Vec3) -> f32 {
        let local = self.light_from_world * wi;
        let sin_theta = (local.x * local.x + local.z * local.z).sqrt();
        match &self.table {
            Some(table) if sin_theta > 0.0 => per_solid_angle(table.pdf(uv_of(local)), sin_theta),
            _ => 0.0,
        }
    }
}

/// dω = 2π² sin θ du dv.
#[inline]
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
