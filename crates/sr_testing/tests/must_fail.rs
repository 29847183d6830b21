//! Samplers that are wrong on purpose. The chi-square test has to reject each of them, or it is no
//! evidence for the others.

use std::f32::consts::{FRAC_1_PI, TAU};

use glam::{Vec2, Vec3};
use sr_sampling::warp::{CosineHemisphere, UniformHemisphere};
use sr_sampling::{Counting, Discrete, Distribution, Line, PiecewiseConstant1D, Sample, SolidAngle};
use sr_stats::{Chi2Settings, TestReport, chi2};

/// No right sampler among a million would be rejected at this level.
const LEVEL: f64 = 1e-9;

const SETTINGS: Chi2Settings = Chi2Settings { samples: 1 << 18, bins: (16, 32), seed: 9 };

/// A sampler, and the density that it claims to follow.
struct Claim<S, P> {
    sample: S,
    pdf: P,
}

impl<S: Fn(Vec2) -> Option<Vec3>, P: Fn(Vec3) -> f32> Distribution for Claim<S, P> {
    type Measure = SolidAngle;
    type Uniform = Vec2;

    fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
        let value = (self.sample)(u)?;
        Some(Sample { value, pdf: (self.pdf)(value) })
    }

    fn pdf(&self, w: Vec3) -> f32 {
        (self.pdf)(w)
    }
}

fn test(sample: impl Fn(Vec2) -> Option<Vec3>, pdf: impl Fn(Vec3) -> f32) -> TestReport {
    chi2::sphere(&Claim { sample, pdf }, SETTINGS)
}

fn uniform(u: Vec2) -> Option<Vec3> {
    UniformHemisphere.sample(u).map(|s| s.value)
}

fn cosine(u: Vec2) -> Option<Vec3> {
    CosineHemisphere.sample(u).map(|s| s.value)
}

#[track_caller]
fn rejected(report: TestReport) {
    assert!(!report.passes(LEVEL), "not rejected: {report}");
}

/// The wrapper itself is not what is rejected.
#[test]
fn honest_claims_pass() {
    for report in [test(uniform, |w| UniformHemisphere.pdf(w)), test(cosine, |w| CosineHemisphere.pdf(w))] {
        assert!(report.passes(1e-3), "{report}");
    }
}

#[test]
fn a_scaled_pdf() {
    for scale in [0.98, 1.02] {
        rejected(test(cosine, |w| scale * CosineHemisphere.pdf(w)));
        rejected(test(uniform, |w| scale * UniformHemisphere.pdf(w)));
    }
}

/// Far too large everywhere: said at once, and not after learning where most.
#[test]
fn a_density_of_a_million() {
    rejected(test(uniform, |_| 1e6));
}

#[test]
fn a_missing_cosine() {
    rejected(test(cosine, |w| UniformHemisphere.pdf(w)));
    rejected(test(cosine, |w| if w.z > 0.0 { FRAC_1_PI } else { 0.0 }));
}

#[test]
fn samples_of_another_distribution() {
    rejected(test(uniform, |w| CosineHemisphere.pdf(w)));
}

/// cos θ to the power of 1.1, claimed to be cos θ.
#[test]
fn samples_slightly_off() {
    let sharper = |u: Vec2| {
        let z = u.x.powf(1.0 / 2.1);
        let (sin, cos) = (TAU * u.y).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        (z > 0.0).then(|| Vec3::new(r * cos, r * sin, z))
    };
    rejected(test(sharper, |w| CosineHemisphere.pdf(w)));
}

/// Within 0.1 rad of +Z: 0.5 % of the hemisphere.
fn in_hole(w: Vec3) -> bool {
    w.z > 0.995
}

#[test]
fn a_hole_in_the_density() {
    rejected(test(uniform, |w| if in_hole(w) { 0.0 } else { UniformHemisphere.pdf(w) }));
}

/// A hole so small that few samples fall into it, in a density that makes up for it elsewhere.
#[test]
fn a_small_hole_in_the_density() {
    let hole = Vec3::new(0.6, 0.0, 0.8);
    let share = 5e-4; // of the hemisphere
    let pdf = move |w: Vec3| match w.dot(hole) > 1.0 - share {
        true => 0.0,
        false => UniformHemisphere.pdf(w) / (1.0 - share),
    };
    rejected(test(uniform, pdf));
}

#[test]
fn a_hole_in_the_samples() {
    // Nothing is drawn there, and the rest is drawn as it should be: the density claims too much.
    rejected(test(|u| uniform(u).filter(|w| !in_hole(*w)), |w| UniformHemisphere.pdf(w)));
    // What should have gone there goes elsewhere.
    let moved = |u| uniform(u).map(|w| if in_hole(w) { Vec3::new(w.x, w.z, w.y.abs()) } else { w });
    rejected(test(moved, |w| UniformHemisphere.pdf(w)));
}

#[test]
fn a_wrong_rotation() {
    // The density leans towards +X, the samples towards −X.
    let leaning = |u| cosine(u).map(|w| Vec3::new(-w.z.abs(), w.y, w.x));
    rejected(test(leaning, |w| w.x.max(0.0) * FRAC_1_PI));
}

#[test]
fn a_density_that_is_not_a_number() {
    rejected(test(uniform, |_| f32::NAN));
    rejected(test(uniform, |w| if in_hole(w) { f32::INFINITY } else { UniformHemisphere.pdf(w) }));
    rejected(test(uniform, |w| if w.z > 0.0 { UniformHemisphere.pdf(w) } else { -0.01 }));
}

#[test]
fn a_sampler_that_returns_nothing() {
    rejected(test(|_| None, |w| UniformHemisphere.pdf(w)));
    rejected(test(|u| if u.x < 0.01 { None } else { uniform(u) }, |w| UniformHemisphere.pdf(w)));
}

/// The density is right, but the sample says something else.
#[test]
fn a_pdf_that_the_sample_contradicts() {
    struct Contradiction;
    impl Distribution for Contradiction {
        type Measure = SolidAngle;
        type Uniform = Vec2;
        fn sample(&self, u: Vec2) -> Option<Sample<SolidAngle>> {
            CosineHemisphere.sample(u).map(|s| Sample { pdf: 1.02 * s.pdf, ..s })
        }
        fn pdf(&self, w: Vec3) -> f32 {
            CosineHemisphere.pdf(w)
        }
    }
    rejected(chi2::sphere(&Contradiction, SETTINGS));
}

/// One table drawn, another claimed.
struct Swapped<D>(D, D);

impl Distribution for Swapped<Discrete> {
    type Measure = Counting;
    type Uniform = f32;
    fn sample(&self, u: f32) -> Option<Sample<Counting>> {
        self.0.sample(u).map(|s| Sample { pdf: self.1.pdf(s.value), ..s })
    }
    fn pdf(&self, index: usize) -> f32 {
        self.1.pdf(index)
    }
}

impl Distribution for Swapped<PiecewiseConstant1D> {
    type Measure = Line;
    type Uniform = f32;
    fn sample(&self, u: f32) -> Option<Sample<Line>> {
        self.0.sample(u).map(|s| Sample { pdf: self.1.pdf(s.value), ..s })
    }
    fn pdf(&self, x: f32) -> f32 {
        self.1.pdf(x)
    }
}

#[test]
fn tables_that_are_a_little_different() {
    let (drawn, claimed) = ([1.0, 2.0, 3.0], [1.0, 2.1, 3.0]);
    let discrete = Swapped(Discrete::new(&drawn).unwrap(), Discrete::new(&claimed).unwrap());
    rejected(chi2::counting(&discrete, 3, SETTINGS));
    let density = |values: &[f32]| PiecewiseConstant1D::from_values(values).unwrap();
    rejected(chi2::line(&Swapped(density(&drawn), density(&claimed)), [0.0, 1.0], SETTINGS));
}

#[test]
fn samples_outside_the_domain() {
    let density = PiecewiseConstant1D::from_counts(&[0.0, 2.0], &[1.0]).unwrap();
    rejected(chi2::line(&density, [0.0, 1.0], SETTINGS));
}
