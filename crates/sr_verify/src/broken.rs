//! Blocks that are wrong on purpose, in the ways in which samplers go wrong. A harness that passes one of them is no
//! evidence for the others.

use std::fmt;

use glam::{Vec2, Vec3, Vec3Swizzles};
use sr_bsdf::{Bsdf, BsdfSample, Lobes, Rgb};
use sr_sampling::{Distribution, Sample, SolidAngle};

use crate::bsdf_checks::scatters;
use crate::bsdfs;
use crate::directions;
use crate::lights::{self, SeenLight};
use crate::picture::Picture;
use crate::subject::{Group, Subject};

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Flaw {
    /// The pdf is 2 % too large.
    ScaledPdf,
    /// Samples have x and y exchanged.
    SwappedAxes,
    /// The weight lacks |cos θ|.
    LostCosine,
    /// The pdf is that of the halfway vector; or, of a light, per area.
    LostJacobian,
    /// To one side of the plane of incidence nothing is drawn, and the pdf says so.
    Hole,
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ScaledPdf => "pdf scaled by 1.02",
            Self::SwappedAxes => "axes swapped",
            Self::LostCosine => "cosine lost",
            Self::LostJacobian => "Jacobian lost",
            Self::Hole => "hole in the support",
        })
    }
}

const SCALE: f32 = 1.02;

/// All of them. Each must fail at least one of its checks.
pub fn broken_subjects() -> Vec<Subject> {
    let mut all = Vec::new();
    for (case, bsdf, wo) in bsdfs::examples() {
        let flaws = [Flaw::ScaledPdf, Flaw::SwappedAxes, Flaw::LostCosine, Flaw::LostJacobian, Flaw::Hole];
        for flaw in flaws.into_iter().filter(|&flaw| matters(&bsdf, wo, flaw)) {
            all.push(bsdfs::whole(format!("{case}, {flaw}"), BrokenBsdf { bsdf, flaw }, wo));
        }
    }
    for (case, light) in lights::cases().into_iter().step_by(13) {
        for flaw in [Flaw::ScaledPdf, Flaw::SwappedAxes, Flaw::LostJacobian, Flaw::Hole] {
            if let Some(light) = BrokenLight::new(light.clone(), flaw) {
                all.push(light.subject(format!("{case}, {flaw}")));
            }
        }
    }
    all
}

#[derive(Clone, Copy, Debug)]
struct BrokenBsdf<B> {
    bsdf: B,
    flaw: Flaw,
}

/// Does a flaw change anything of this model?
fn matters<B: Bsdf>(bsdf: &B, wo: Vec3, flaw: Flaw) -> bool {
    let rough = scatters(bsdf, wo);
    match flaw {
        Flaw::ScaledPdf => rough || bsdf.lobes().delta,
        Flaw::LostCosine | Flaw::LostJacobian | Flaw::Hole => rough,
        Flaw::SwappedAxes => (0..200).any(|i| {
            let u = Vec2::new((i as f32 + 0.5) / 200.0, (i as f32 * 0.618_034) % 1.0);
            let Some(s) = bsdf.sample(wo, u.y, u) else { return false };
            let (pdf, swapped) = (bsdf.pdf(wo, s.wi), bsdf.pdf(wo.yxz(), s.wi.yxz()));
            !s.delta && (pdf / swapped).ln().abs() > 0.5
        }),
    }
}

/// Is `wi` on the side of the plane of incidence where nothing is drawn?
fn in_hole(wo: Vec3, wi: Vec3) -> bool {
    let across = if wo.truncate().length_squared() > 1e-6 { Vec3::Z.cross(wo) } else { Vec3::X };
    wi.dot(across) > 0.0
}

impl<B: Bsdf> BrokenBsdf<B> {
    /// By what the pdf is off.
    fn factor(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self.flaw {
            Flaw::ScaledPdf => SCALE,
            Flaw::LostJacobian => {
                let sum = wo + wi * (wo.z * wi.z).signum();
                4.0 * wo.dot(sum.normalize_or(Vec3::Z)).abs()
            }
            Flaw::Hole if in_hole(wo, wi) => 0.0,
            _ => 1.0,
        }
    }
}

impl<B: Bsdf> Bsdf for BrokenBsdf<B> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.bsdf.eval(wo, wi)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if self.flaw == Flaw::SwappedAxes {
            let s = self.bsdf.sample(wo.yxz(), u_lobe, u)?;
            let wi = s.wi.yxz();
            if s.delta {
                return Some(BsdfSample { wi, ..s });
            }
            let pdf = self.bsdf.pdf(wo, wi);
            let weight = self.bsdf.eval(wo, wi) * wi.z.abs() / pdf;
            return (pdf > 0.0).then_some(BsdfSample { wi, pdf, weight, ..s });
        }
        let s = self.bsdf.sample(wo, u_lobe, u)?;
        if self.flaw == Flaw::LostCosine {
            let weight = if s.delta { s.weight } else { s.weight / s.wi.z.abs() };
            return Some(BsdfSample { weight, ..s });
        }
        let factor = if s.delta && self.flaw != Flaw::ScaledPdf { 1.0 } else { self.factor(wo, s.wi) };
        (factor > 0.0).then(|| BsdfSample { pdf: s.pdf * factor, weight: s.weight / factor, ..s })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.factor(wo, wi) * self.bsdf.pdf(wo, wi)
    }

    fn lobes(&self) -> Lobes {
        self.bsdf.lobes()
    }

    fn albedo(&self) -> Rgb {
        self.bsdf.albedo()
    }
}

#[derive(Clone)]
struct BrokenLight {
    light: SeenLight,
    flaw: Flaw,
    /// The pdf of one sample: what all have if nothing is said of distance and angle.
    constant: f32,
}

impl BrokenLight {
    /// `None` if the flaw changes nothing.
    fn new(light: SeenLight, flaw: Flaw) -> Option<Self> {
        let distribution = light.distribution();
        let draw = |i: u32| {
            let u = Vec2::new((i as f32 + 0.5) / 200.0, (i as f32 * 0.618_034) % 1.0);
            distribution.sample(((i as f32 * 0.754_877) % 1.0, u))
        };
        let samples: Vec<Sample<SolidAngle>> = (0..200).filter_map(draw).collect();
        let constant = samples.first()?.pdf;
        let differs = |pdf: f32, other: f32| (pdf / other).ln().abs() > 0.3;
        let matters = match flaw {
            Flaw::SwappedAxes => {
                let swapped = samples.iter().filter(|s| differs(s.pdf, distribution.pdf(s.value.yxz())));
                swapped.count() > 20
            }
            Flaw::LostJacobian => samples.iter().filter(|s| differs(s.pdf, constant)).count() > 20,
            Flaw::Hole => samples.iter().filter(|s| in_hole(Vec3::Z, s.value)).count() > 20,
            Flaw::ScaledPdf | Flaw::LostCosine => true,
        };
        matters.then(|| Self { light: light.clone(), flaw, constant })
    }

    fn subject(self, case: String) -> Subject {
        let (mass, picture, bins) = (self.clone(), self.clone(), self.light.bins);
        Subject::new(Group::Light, case)
            .check("chi-square", move |seed| directions::chi_square(&self, bins, seed))
            .check("normalised", move |seed| directions::normalised(&mass, bins, seed))
            .picture(move |seed| Picture::of(&picture, seed))
    }
}

impl Distribution for BrokenLight {
    type Measure = SolidAngle;
    type Uniform = (f32, Vec2);

    fn sample(&self, u: (f32, Vec2)) -> Option<Sample<SolidAngle>> {
        let s = self.light.distribution().sample(u)?;
        let value = if self.flaw == Flaw::SwappedAxes { s.value.yxz() } else { s.value };
        // A hole in the samples that the pdf does not know of.
        let hidden = self.flaw == Flaw::Hole && in_hole(Vec3::Z, value);
        let pdf = self.pdf(value);
        (!hidden && pdf > 0.0).then_some(Sample { value, pdf })
    }

    fn pdf(&self, w: Vec3) -> f32 {
        let pdf = self.light.distribution().pdf(w);
        match self.flaw {
            Flaw::ScaledPdf => SCALE * pdf,
            Flaw::LostJacobian if pdf > 0.0 => self.constant,
            _ => pdf,
        }
    }
}
