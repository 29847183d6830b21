//! A peak of any width, anywhere on the sphere.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2, Vec3};
use sr_sampling::{Distribution, Sample, SolidAngle};

/// Directions within 90° of an axis, with the density D(θ) cos θ of GGX normals of width `alpha`
/// (Walter et al. 2007, eqs. 33 to 36). Its long tails and narrow peak are what a test has to cope with.
#[derive(Clone, Copy, Debug)]
pub struct Lobe {
    world_from_lobe: Quat,
    alpha: f32,
}

impl Lobe {
    /// A lobe about an axis of any length.
    pub fn new(axis: Vec3, alpha: f32) -> Self {
        Self { world_from_lobe: Quat::from_rotation_arc(Vec3::Z, axis.normalize()), alpha }
    }
}

impl Distribution for Lobe {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let tan2 = self.alpha * self.alpha * u.x / (1.0 - u.x);
        let cos = 1.0 / (1.0 + tan2).sqrt();
        let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
        let sin = cos * tan2.sqrt();
        let value = self.world_from_lobe * Vec3::new(sin * cos_phi, sin * sin_phi, cos);
        let pdf = self.pdf(value);
        (pdf > 0.0).then_some(Sample { value, pdf })
    }

    fn pdf(&self, w: Vec3) -> f32 {
        let w = self.world_from_lobe.inverse() * w;
        if w.z <= 0.0 {
            return 0.0;
        }
        let a2 = self.alpha * self.alpha;
        let denominator = a2 * w.z * w.z + w.truncate().length_squared();
        a2 * w.z / (PI * denominator * denominator)
    }
}
