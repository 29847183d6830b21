//! Scattering models that are wrong on purpose: the usual mistakes. The chi-square test has to reject each of them, or it
//! is no evidence for the others.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};
use sr_bsdf::{
    AnyBsdf, Bsdf, Eon, Microfacet, MicrofacetKind, Principled, PrincipledInputs, PrincipledThin,
    PrincipledThinInputs, Rgb, RoughConductor, RoughDielectric,
};
use sr_sampling::{Distribution, Sample, SolidAngle};
use sr_stats::{Chi2Settings, TestReport, chi2};

/// No right sampler among a million would be rejected at this level.
const LEVEL: f64 = 1e-9;

const WO: Vec3 = Vec3::new(0.48, 0.36, 0.8);

/// Samples of one model, claimed to have a density made from another's.
struct Claim<'a, P> {
    samples: &'a AnyBsdf<'a>,
    pdf: P,
}

impl<P: Fn(Vec3) -> f32> Distribution for Claim<'_, P> {
    type Measure = SolidAngle;
    type Uniform = (f32, Vec2);

    fn sample(&self, (u_lobe, u): (f32, Vec2)) -> Option<Sample<SolidAngle>> {
        let wi = self.samples.sample(WO, u_lobe, u)?.wi;
        Some(Sample { value: wi, pdf: (self.pdf)(wi) })
    }

    fn pdf(&self, wi: Vec3) -> f32 {
        (self.pdf)(wi)
    }
}

fn test(samples: &AnyBsdf, pdf: impl Fn(Vec3) -> f32) -> TestReport {
    let settings = Chi2Settings { samples: 1 << 18, bins: (16, 32), seed: 11 };
    chi2::sphere(&Claim { samples, pdf }, settings)
}

fn all() -> Vec<AnyBsdf<'static>> {
    let plain = PrincipledInputs { roughness: 0.4, ..PrincipledInputs::default() };
    vec![
        Eon::new(Rgb::ONE, 0.7).into(),
        rough_metal(0.1, 0.4),
        RoughDielectric::new(Microfacet::isotropic(MicrofacetKind::Ggx, 0.3), 1.5, Rgb::ONE, Rgb::ONE).into(),
        Principled::new(PrincipledInputs { clearcoat: 1.0, spec_trans: 0.5, ..plain }).into(),
        PrincipledThin::new(PrincipledThinInputs { spec_trans: 0.5, diff_trans: 0.7, ..Default::default() })
            .into(),
    ]
}

fn rough_metal(x: f32, y: f32) -> AnyBsdf<'static> {
    RoughConductor::new(Microfacet::new(MicrofacetKind::Ggx, x, y), None, Rgb::ONE).into()
}

#[track_caller]
fn rejected(report: TestReport) {
    assert!(!report.passes(LEVEL), "not rejected: {report}");
}

/// The wrapper itself is not what is rejected.
#[test]
fn honest_claims_pass() {
    for bsdf in all() {
        let report = test(&bsdf, |wi| bsdf.pdf(WO, wi));
        assert!(report.passes(1e-4), "{bsdf:?}: {report}");
    }
}

#[test]
fn a_scaled_pdf() {
    for bsdf in all() {
        for scale in [0.98, 1.02] {
            rejected(test(&bsdf, |wi| scale * bsdf.pdf(WO, wi)));
        }
    }
}

#[test]
fn swapped_axes() {
    let (right, swapped) = (rough_metal(0.1, 0.4), rough_metal(0.4, 0.1));
    rejected(test(&right, |wi| swapped.pdf(WO, wi)));
    let cloth = |anisotropic| {
        let inputs = PrincipledInputs { metallic: 1.0, anisotropic, ..PrincipledInputs::default() };
        Principled::new(inputs)
    };
    let turned = |w: Vec3| Vec3::new(-w.y, w.x, w.z);
    let bsdf = cloth(0.9);
    rejected(test(&bsdf.into(), |wi| bsdf.pdf(turned(WO), turned(wi))));
}

/// Of the cosine lobe among the principled model's, and of what is drawn like it.
#[test]
fn a_lost_cosine() {
    let base = Principled::new(PrincipledInputs { rates: [1.0, 0.0, 0.0], ..PrincipledInputs::default() });
    rejected(test(&base.into(), |wi| base.pdf(WO, wi) / wi.z.max(1e-6)));
    rejected(test(&base.into(), |wi| if wi.z > 0.0 { FRAC_1_PI } else { 0.0 }));
}

/// A density of half vectors, taken for one of directions.
#[test]
fn a_lost_jacobian() {
    let metal = rough_metal(0.1, 0.4);
    rejected(test(&metal, |wi| metal.pdf(WO, wi) * 4.0 * WO.dot((WO + wi).normalize_or_zero()).max(0.0)));
    // Only what the cosine varies, scaled so that the density is about normalised.
    rejected(test(&metal, |wi| metal.pdf(WO, wi) * 1.02 * WO.dot((WO + wi).normalize_or_zero()).max(0.0)));
}

/// A lobe that is drawn, but forgotten in the density of the mixture.
#[test]
fn a_forgotten_lobe() {
    let inputs = PrincipledInputs { clearcoat: 1.0, ..PrincipledInputs::default() };
    let without = Principled::new(PrincipledInputs { clearcoat: 0.0, ..inputs });
    rejected(test(&Principled::new(inputs).into(), |wi| without.pdf(WO, wi)));
}
