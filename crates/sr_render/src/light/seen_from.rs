//! Lights as a distribution over directions.

use glam::{Vec2, Vec3};
use sr_sampling::{Distribution, Sample, SolidAngle};

use super::{LightId, Lights};

/// One light, or all of them, as seen from a point: a density over directions.
///
/// Occluders are ignored: a direction towards a hidden light is as likely as towards a visible one.
#[derive(Clone, Copy, Debug)]
pub struct SeenFrom<'a> {
    lights: &'a Lights,
    from: Vec3,
    only: Option<LightId>,
}

impl<'a> SeenFrom<'a> {
    pub(super) fn new(lights: &'a Lights, from: Vec3, only: Option<LightId>) -> Self {
        Self { lights, from, only }
    }
}

impl Distribution for SeenFrom<'_> {
    type Measure = SolidAngle;
    type Uniform = (f32, Vec2);

    fn sample(&self, (u_pick, u): (f32, Vec2)) -> Option<Sample<SolidAngle>> {
        let drawn = match self.only {
            Some(id) => self.lights.sample_one(id, self.from, u_pick, u),
            None => self.lights.sample(self.from, u_pick, u),
        }?;
        // Rounding can make the ray miss the edge of a light that was just sampled; what was drawn is
        // a lower bound of the density.
        let pdf = self.pdf(drawn.wi).max(drawn.pdf);
        (pdf > 0.0 && pdf.is_finite()).then_some(Sample { value: drawn.wi, pdf })
    }

    fn pdf(&self, wi: Vec3) -> f32 {
        self.lights.pdf_of_direction(self.from, wi, self.only)
    }
}
