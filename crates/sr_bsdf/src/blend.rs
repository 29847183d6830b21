//! Several models in one place, each with its share of the surface, in a frame of its own; the rest is holes.

use std::array;

use glam::{Vec2, Vec3};

use crate::{AnyModel, Bsdf, BsdfSample, Lobes, Rgb, Step};

/// The most models that a blend holds.
pub const MAX_PARTS: usize = 8;
/// The most frames within frames.
pub const MAX_STEPS: usize = 3;

/// A mixture of models: f = Σ shareᵢ fᵢ. Whatever the shares lack of 1 passes straight through.
///
/// A direction is drawn by a model picked in proportion to its share, and weighted by the density of all, Σ shareᵢ pᵢ.
#[derive(Clone, Copy, Debug)]
pub struct Blend<'a> {
    parts: [Option<Part<'a>>; MAX_PARTS],
    /// Probability that light passes straight through.
    through: f32,
}

/// A model of a blend.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    share: f32,
    steps: [Option<Step>; MAX_STEPS],
    model: AnyModel<'a>,
}

impl<'a> Part<'a> {
    /// - `share`: of the surface, brought into [0, 1]
    /// - `steps`: from the surface's frame to the model's, outermost first; at most [`MAX_STEPS`], others are ignored
    pub fn new(share: f32, steps: impl IntoIterator<Item = Step>, model: AnyModel<'a>) -> Self {
        let mut steps = steps.into_iter();
        Self { share: share.clamp(0.0, 1.0), steps: array::from_fn(|_| steps.next()), model }
    }

    fn steps(&self) -> impl DoubleEndedIterator<Item = &Step> {
        self.steps.iter().flatten()
    }

    fn inward(&self, w: Vec3) -> Vec3 {
        self.steps().fold(w, |w, step| step.inward(w))
    }

    /// `wi` seen from inside, and what is left of the light from there.
    fn inward_dimmed(&self, wi: Vec3) -> (Vec3, f32) {
        self.steps().fold((wi, 1.0), |(w, dimming), step| {
            let inside = step.inward(w);
            (inside, dimming * step.dimming(w, inside))
        })
    }

    /// Is its frame that of the surface?
    #[inline]
    fn is_in_place(&self) -> bool {
        self.steps[0].is_none()
    }

    /// f.
    #[inline(always)]
    fn f(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if self.is_in_place() {
            f_by_numbers(&self.model, wo.x, wo.y, wo.z, wi.x, wi.y, wi.z)
        } else {
            self.f_in_frame(&wo, &wi)
        }
    }

    /// f, the cosine being that of the inner frame; 0 in the surface itself, where it would be infinite.
    #[inline(never)]
    fn f_in_frame(&self, wo: &Vec3, wi: &Vec3) -> Rgb {
        let (inside, dimming) = self.inward_dimmed(*wi);
        if !(dimming > 0.0) || wi.z == 0.0 {
            return Rgb::ZERO;
        }
        self.model.eval(self.inward(*wo), inside) * (dimming * inside.z.abs() / wi.z.abs())
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if self.is_in_place() {
            pdf_by_numbers(&self.model, wo.x, wo.y, wo.z, wi.x, wi.y, wi.z)
        } else {
            self.pdf_in_frame(&wo, &wi)
        }
    }

    #[inline(never)]
    fn pdf_in_frame(&self, wo: &Vec3, wi: &Vec3) -> f32 {
        let (inside, dimming) = self.inward_dimmed(*wi);
        if dimming > 0.0 { self.model.pdf(self.inward(*wo), inside) } else { 0.0 }
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let mut s = self.model.sample(self.inward(wo), u_lobe, u)?;
        for step in self.steps().rev() {
            let inside = s.wi;
            s.wi = step.outward(inside);
            s.weight *= step.dimming(s.wi, inside);
        }
        (s.weight != Rgb::ZERO).then_some(s)
    }
}

impl<'a> Blend<'a> {
    /// - `parts`: at most [`MAX_PARTS`], others are ignored. Shares that sum to more than 1 are scaled down
    /// - `has_holes`: if not, the shares are scaled to sum to 1
    pub fn new(parts: impl IntoIterator<Item = Part<'a>>, has_holes: bool) -> Self {
        let mut given = parts.into_iter().filter(|part| part.share > 0.0);
        let mut parts: [Option<Part<'a>>; MAX_PARTS] = array::from_fn(|_| given.next());
        let sum: f32 = parts.iter().flatten().map(|part| part.share).sum();
        if sum > 0.0 && (sum > 1.0 || !has_holes) {
            for part in parts.iter_mut().flatten() {
                part.share /= sum;
            }
        }
        Self { parts, through: if has_holes { (1.0 - sum).max(0.0) } else { 0.0 } }
    }

    fn parts(&self) -> impl Iterator<Item = &Part<'a>> {
        self.parts.iter().map_while(Option::as_ref)
    }

    fn is_single(&self) -> bool {
        self.parts[1].is_none()
    }

    /// The mean normal of the parts' frames, on the side of +Z, in the surface's frame.
    pub fn normal(&self) -> Vec3 {
        let normal = |part: &Part| {
            let n = part.steps().rev().fold(Vec3::Z, |n, step| step.outward(n));
            part.share * if n.z < 0.0 { -n } else { n }
        };
        self.parts().map(normal).sum::<Vec3>().try_normalize().unwrap_or(Vec3::Z)
    }

    /// A direction drawn by one part, with the density and the value of all.
    fn sample_part(&self, picked: &Part<'a>, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let s = picked.sample(wo, u_lobe, u)?;
        if s.delta || self.is_single() {
            return Some(BsdfSample { pdf: s.pdf * picked.share, ..s });
        }
        // What the part that drew it says of its own density and value, it knows best.
        let others = || self.parts().filter(|part| !std::ptr::eq(*part, picked));
        let own = picked.share * s.pdf;
        let pdf = own + others().map(|part| part.share * part.pdf(wo, s.wi)).sum::<f32>();
        let f = others().map(|part| part.share * part.f(wo, s.wi)).sum::<Rgb>();
        let f_cos = s.weight * own + f * s.wi.z.abs();
        (pdf.is_finite() && pdf > 0.0).then(|| BsdfSample { weight: f_cos / pdf, pdf, ..s })
    }
}

/// f of any model. Six numbers come in registers; two directions, through memory, would cost more than a model does.
#[inline(never)]
fn f_by_numbers(model: &AnyModel, ox: f32, oy: f32, oz: f32, ix: f32, iy: f32, iz: f32) -> Rgb {
    model.eval(Vec3::new(ox, oy, oz), Vec3::new(ix, iy, iz))
}

/// Its density, in the same way.
#[inline(never)]
fn pdf_by_numbers(model: &AnyModel, ox: f32, oy: f32, oz: f32, ix: f32, iy: f32, iz: f32) -> f32 {
    model.pdf(Vec3::new(ox, oy, oz), Vec3::new(ix, iy, iz))
}

impl Bsdf for Blend<'_> {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let mut f = Rgb::ZERO;
        for part in self.parts() {
            f += part.share * part.f(wo, wi);
        }
        f
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let mut below = 0.0;
        for part in self.parts() {
            if u_lobe < below + part.share {
                let u_lobe = ((u_lobe - below) / part.share).clamp(0.0, 1.0 - f32::EPSILON / 2.0);
                return self.sample_part(part, wo, u_lobe, u);
            }
            below += part.share;
        }
        (self.through > 0.0).then_some(BsdfSample {
            wi: -wo,
            weight: Rgb::ONE,
            pdf: self.through,
            delta: true,
            eta: 1.0,
        })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let mut pdf = 0.0;
        for part in self.parts() {
            pdf += part.share * part.pdf(wo, wi);
        }
        pdf
    }

    fn lobes(&self) -> Lobes {
        let none = Lobes { reflection: false, transmission: false, delta: self.through > 0.0 };
        self.parts().fold(none, |all, part| {
            let lobes = part.model.lobes();
            Lobes {
                reflection: all.reflection || lobes.reflection,
                transmission: all.transmission || lobes.transmission,
                delta: all.delta || lobes.delta,
            }
        })
    }

    fn albedo(&self) -> Rgb {
        self.parts().map(|part| part.share * part.model.albedo()).sum::<Rgb>() + Rgb::splat(self.through)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Conductor, Diffuse, Tilt};

    fn diffuse(share: f32, albedo: f32) -> Part<'static> {
        Part::new(share, [], Diffuse::new(Rgb::splat(albedo)).into())
    }

    #[test]
    fn values_and_densities_are_weighted_means() {
        let blend = Blend::new([diffuse(0.25, 0.2), diffuse(0.75, 0.6)], false);
        let (wo, wi) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.6, 0.8));
        assert!((blend.eval(wo, wi) - Diffuse::new(Rgb::splat(0.5)).eval(wo, wi)).length() < 1e-6);
        assert!((blend.pdf(wo, wi) - Diffuse::new(Rgb::ONE).pdf(wo, wi)).abs() < 1e-6);
        let s = blend.sample(wo, 0.1, Vec2::new(0.3, 0.7)).unwrap();
        assert!((s.weight - Rgb::splat(0.5)).length() < 1e-6, "{s:?}");
    }

    #[test]
    fn what_shares_lack_passes_through() {
        let blend = Blend::new([diffuse(0.25, 1.0)], true);
        let s = blend.sample(Vec3::Z, 0.9, Vec2::splat(0.5)).unwrap();
        assert_eq!((s.wi, s.pdf, s.delta), (-Vec3::Z, 0.75, true));
        assert_eq!(Blend::new([], true).sample(Vec3::Z, 0.0, Vec2::ZERO).map(|s| s.pdf), Some(1.0));
        assert_eq!(Blend::new([], false).sample(Vec3::Z, 0.0, Vec2::ZERO), None);
    }

    #[test]
    fn a_mirror_is_tilted() {
        let tilt = Tilt::about(Vec3::new(0.5, 0.0, 1.0));
        let mirror = Part::new(1.0, [Step::Tilt(tilt)], Conductor::new(None, Rgb::ONE).into());
        let s = Blend::new([mirror], false).sample(Vec3::Z, 0.5, Vec2::splat(0.5)).unwrap();
        assert!((s.wi - (2.0 * tilt.normal().z * tilt.normal() - Vec3::Z)).length() < 1e-6);
        let back = Part::new(1.0, [Step::Mirror], Conductor::new(None, Rgb::ONE).into());
        assert!(Blend::new([back], false).sample(-Vec3::Z, 0.5, Vec2::splat(0.5)).is_some());
    }
}
