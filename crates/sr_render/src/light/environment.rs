//! Light from infinitely far away, all around: constant, or an image.

use std::f32::consts::PI;
use std::sync::Arc;

use glam::{Mat3, Vec2, Vec3};
use sr_sampling::warp::{UniformSphere, unit_circle};
use sr_sampling::{Distribution, PiecewiseConstant2D, Plane, Sample};
use sr_scene::{Image, Portal, Rgb, SphereMapping};

use super::portal::Portals;
use super::sphere_image::{SphereImage, per_solid_angle};
use super::{LightId, LightSample, Target};

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

/// How an image around the scene is to be sampled.
#[derive(Clone, Debug, Default)]
pub struct EnvironmentSampling {
    /// Less where another technique finds the light as well (Karlík, Šik, Vévoda, Skřivan & Křivánek 2019, "MIS
    /// Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling").
    pub mis_compensation: bool,
    /// Rather through these openings than elsewhere.
    pub portals: Vec<Portal>,
}

/// What MIS compensation leaves of each cell's weight, so that every direction from which light comes can be drawn: the
/// picture of light sampling alone stays right.
const LEFT_BY_COMPENSATION: f32 = 0.1;

/// The share of samples through portals, where a point sees any.
const THROUGH_PORTALS: f32 = 0.875;

/// An image around the scene, sampled in proportion to its luminance.
#[derive(Clone, Debug)]
pub struct Environment {
    map: SphereImage,
    scale: f32,
    world_from_light: Mat3,
    light_from_world: Mat3,
    /// Over (u, v), in proportion to luminance times the solid angle of a cell.
    table: Option<PiecewiseConstant2D>,
    portals: Option<Portals>,
    mean_radiance: Rgb,
}

impl Environment {
    /// Prepares an image for sampling. 8-bit images are taken as sRGB-encoded.
    pub fn new(
        image: Arc<Image>,
        mapping: SphereMapping,
        scale: f32,
        world_from_light: Mat3,
        sampling: &EnvironmentSampling,
    ) -> Self {
        let map = SphereImage::new(image, mapping);
        let light_from_world = world_from_light.transpose();
        let radiance = |wi: Vec3| map.at(map.uv_of(light_from_world * wi));
        let side = map.width().max(map.height()) as usize;
        Self {
            scale,
            world_from_light,
            light_from_world,
            table: PiecewiseConstant2D::new(&weights(&map, sampling.mis_compensation), map.width() as usize)
                .ok(),
            portals: Portals::new(&sampling.portals, side, radiance),
            mean_radiance: map.mean() * scale,
            map,
        }
    }

    /// The mean over all directions.
    pub fn mean_radiance(&self) -> Rgb {
        self.mean_radiance
    }

    /// Radiance arriving from direction `wi`, in world space: bilinear between texel centres.
    pub fn radiance(&self, wi: Vec3) -> Rgb {
        self.radiance_at(self.map.uv_of(self.light_from_world * wi))
    }

    /// [`Self::radiance`] and [`Self::pdf`] of a direction in world space.
    pub(crate) fn seen_along(&self, from: Vec3, wi: Vec3) -> (Rgb, f32) {
        let local = self.light_from_world * wi;
        let uv = self.map.uv_of(local);
        (self.radiance_at(uv), self.pdf_of(from, wi, local, uv))
    }

    /// Radiance at a point of the image.
    pub(crate) fn radiance_at(&self, uv: Vec2) -> Rgb {
        self.map.at(uv) * self.scale
    }

    /// A direction, in proportion to luminance. `None` from a black image.
    pub(crate) fn sample(&self, light: LightId, from: Vec3, u: Vec2) -> Option<LightSample> {
        let found = |wi: Vec3, uv: Vec2, pdf: f32| {
            (pdf > 0.0 && pdf < f32::INFINITY).then_some(LightSample {
                wi,
                pdf,
                target: Target::Infinity,
                light,
                uv,
            })
        };
        if let Some(seen) = self.portals.as_ref().and_then(|portals| portals.seen_from(from)) {
            let (wi, uv) = if u.x < THROUGH_PORTALS {
                let wi = seen.sample(Vec2::new(u.x / THROUGH_PORTALS, u.y))?;
                (wi, self.map.uv_of(self.light_from_world * wi))
            } else {
                let u = Vec2::new((u.x - THROUGH_PORTALS) / (1.0 - THROUGH_PORTALS), u.y);
                let uv = self.sample_image(u)?.value;
                (self.world_from_light * self.map.direction(uv), uv)
            };
            return found(wi, uv, self.pdf_of(from, wi, self.light_from_world * wi, uv));
        }
        let Sample { value: uv, pdf } = self.sample_image(u)?;
        let local = self.map.direction(uv);
        found(self.world_from_light * local, uv, self.map.per_solid_angle(pdf, local))
    }

    /// A point of the image, in proportion to luminance. `None` from a black image.
    #[inline(always)]
    fn sample_image(&self, u: Vec2) -> Option<Sample<Plane>> {
        self.table.as_ref()?.sample(u)
    }

    /// Is a point drawn from [`Self::plain_table`], with [`direction`], all there is to sampling?
    pub(super) fn is_plain(&self) -> bool {
        self.plain_table().is_some()
    }

    /// Over the image, if it is of latitudes and longitudes, is not black, and has no portals.
    #[inline(always)]
    pub(super) fn plain_table(&self) -> Option<&PiecewiseConstant2D> {
        let is_plain = self.map.mapping == SphereMapping::LatLong && self.portals.is_none();
        self.table.as_ref().filter(|_| is_plain)
    }

    /// Asks for the memory that [`Self::radiance_at`] reads.
    #[inline(always)]
    pub(super) fn prefetch_radiance(&self, uv: Vec2) {
        self.map.prefetch(uv);
    }

    /// The image's axes, for [`direction`].
    pub(super) fn world_from_light(&self) -> Mat3 {
        self.world_from_light
    }

    /// The density of `sample` from a point at a direction in world space, in sr⁻¹.
    pub fn pdf(&self, from: Vec3, wi: Vec3) -> f32 {
        let local = self.light_from_world * wi;
        self.pdf_of(from, wi, local, self.map.uv_of(local))
    }

    fn pdf_of(&self, from: Vec3, wi: Vec3, local: Vec3, uv: Vec2) -> f32 {
        let image = self.table.as_ref().map_or(0.0, |t| self.map.per_solid_angle(t.pdf(uv), local));
        match self.portals.as_ref().and_then(|portals| portals.seen_from(from)) {
            Some(seen) => THROUGH_PORTALS * seen.pdf(wi) + (1.0 - THROUGH_PORTALS) * image,
            None => image,
        }
    }
}

/// What each cell of the image counts in sampling.
fn weights(map: &SphereImage, mis_compensation: bool) -> Vec<f32> {
    let cells = |y: u32| (0..map.width()).map(move |x| map.cell_luminance(x, y));
    let (mut sum, mut total) = (0.0, 0.0);
    if mis_compensation {
        for y in 0..map.height() {
            let weight = f64::from(map.row_weight(y));
            sum += weight * cells(y).map(f64::from).sum::<f64>();
            total += weight * f64::from(map.width());
        }
    }
    let mean = if total > 0.0 { (sum / total) as f32 } else { 0.0 };
    let compensated = |luminance: f32| (luminance - mean).max(LEFT_BY_COMPENSATION * luminance);
    let row = |y: u32| {
        let weight = map.row_weight(y);
        cells(y).map(move |l| weight * if mis_compensation { compensated(l) } else { l })
    };
    (0..map.height()).flat_map(row).collect()
}

/// The direction of a point of a latitude–longitude image, in world space, and the density in sr⁻¹ that becomes of one in
/// the image: 0 at the poles, where there is none. Does not branch.
#[inline(always)]
pub(super) fn direction(world_from_light: &Mat3, uv: Vec2, pdf_uv: f32) -> (Vec3, f32) {
    let (theta, phi) = (unit_circle(0.5 * uv.y), unit_circle(uv.x));
    let local = Vec3::new(theta.y * phi.y, theta.x, -theta.y * phi.x);
    let pdf = per_solid_angle(pdf_uv, theta.y);
    let counts = (theta.y > 0.0) & (pdf < f32::INFINITY);
    (*world_from_light * local, if counts { pdf } else { 0.0 })
}
