//! What must hold of every scattering model, checked sample by sample.

use glam::{Vec2, Vec3};
use sr_bsdf::{AnyBsdf, Bsdf, BsdfSample};
use sr_sampling::{Independent, SampleId, Sequence};

use sr_testing::bsdfs::{energy_limit, is_reciprocal, lossless_models};
use sr_testing::{BsdfCase, bsdf_cases, bsdf_models};

/// All cases, more from along the normal and from grazing angles, and proof that there are some.
fn cases() -> Vec<BsdfCase> {
    let mut cases = bsdf_cases();
    assert!(cases.len() > 100, "no cases, no evidence");
    let hard = [Vec3::Z, Vec3::new(0.6, 0.8, 0.02), Vec3::new(0.8, -0.6, 1e-3)].map(Vec3::normalize);
    for (name, bsdf) in bsdf_models() {
        cases.extend(hard.map(|wo| (format!("{name}, from {wo}"), bsdf, wo)));
    }
    cases
}

/// The `i`-th sample of a case.
fn sample(bsdf: &AnyBsdf, wo: Vec3, i: u32) -> Option<BsdfSample> {
    let (u_lobe, u) = uniforms(i);
    bsdf.sample(wo, u_lobe, u)
}

fn uniforms(i: u32) -> (f32, Vec2) {
    let (sequence, at) = (Independent::new(11), SampleId { pixel: 0, index: i });
    (sequence.get_1d(at, 0), sequence.get_2d(at, 1))
}

fn uniform_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let (sin, cos) = (std::f32::consts::TAU * u.y).sin_cos();
    (Vec3::new(cos, sin, 0.0) * (1.0 - z * z).max(0.0).sqrt()).with_z(z)
}

/// The index of refraction on the other side of the surface, over that on the side of `wo`.
fn index_beyond(bsdf: &AnyBsdf, wo: Vec3) -> f32 {
    let eta_from = |wo| (0..200).filter_map(|i| sample(bsdf, wo, i)).map(|s| s.eta).find(|&eta| eta != 1.0);
    // Where reflection is all but total, the other side knows, or the normal.
    let along_normal = Vec3::Z * wo.z.signum();
    let other_side = || eta_from(-wo).map(|eta| 1.0 / eta);
    eta_from(wo).or_else(other_side).or_else(|| eta_from(along_normal)).unwrap_or(1.0)
}

#[test]
fn names_tell_cases_apart() {
    let mut names: Vec<String> = cases().into_iter().map(|(name, ..)| name).collect();
    let all = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), all);
}

#[test]
fn samples_are_finite_and_of_unit_length() {
    for (name, bsdf, wo) in cases() {
        for s in (0..2000).filter_map(|i| sample(&bsdf, wo, i)) {
            assert!(s.weight.is_finite() && s.weight.min_element() >= 0.0, "{name}: {s:?}");
            assert!(s.pdf > 0.0 && s.pdf.is_finite(), "{name}: {s:?}");
            assert!((s.wi.length() - 1.0).abs() < 1e-5, "{name}: {s:?}");
            assert!(s.eta > 0.0 && (s.eta == 1.0 || s.wi.z * wo.z < 0.0), "{name}: {s:?}");
            assert!(!s.delta || s.pdf < 1.0 + 1e-6, "{name}: {s:?}");
        }
    }
}

/// `sample` may compute density and weight by other formulas than `pdf` and `eval`; they must agree.
/// The halfway vector of two `f32` directions is off by about 10⁻⁷ / |η − 1|, which roughness 0.01 magnifies.
#[test]
fn sample_agrees_with_eval_and_pdf() {
    let mut checked = 0;
    for (name, bsdf, wo) in cases() {
        let samples: Vec<_> = (0..2000).filter_map(|i| sample(&bsdf, wo, i)).filter(|s| !s.delta).collect();
        checked += samples.len();
        for s in samples {
            let pdf = bsdf.pdf(wo, s.wi);
            let weight = bsdf.eval(wo, s.wi) * s.wi.z.abs() / s.pdf;
            let tolerance = if name.contains("0.01") { 0.05 } else { 0.005 };
            assert!((pdf / s.pdf - 1.0).abs() < tolerance, "{name}: {s:?}, but pdf = {pdf}");
            assert!(
                (weight - s.weight).abs().max_element() < tolerance,
                "{name}: {s:?}, but weight = {weight}"
            );
        }
    }
    assert!(checked > 100_000);
}

/// f(wo, wi) = f(wi, wo) for reflection; for transmission up to η², as radiance is scaled by 1/η².
/// Rounding is magnified by the exponential of a Beckmann tail, at the critical angle, and where a facet is seen
/// edge-on.
#[test]
fn light_may_travel_either_way() {
    let mut checked = 0;
    for (name, bsdf, wo) in cases().into_iter().filter(|(name, ..)| is_reciprocal(name)) {
        let eta = index_beyond(&bsdf, wo);
        for i in 0..500 {
            let wi = uniform_sphere(uniforms(i).1);
            let scale = if wo.z * wi.z > 0.0 { 1.0 } else { eta * eta };
            let (there, back) = (bsdf.eval(wo, wi) * scale, bsdf.eval(wi, wo));
            let error = (there - back).abs().max_element();
            assert!(error <= 0.01 * there.max_element() + 1e-5, "{name}, wi = {wi}: {there} {back}");
            checked += usize::from(there.max_element() > 1e-4);
        }
    }
    assert!(checked > 50_000);
}

/// A surface does not return more light than it receives: the mean weight, with the scaling of radiance
/// undone, is at most 1 (or what is known of the model). The slack is five standard errors.
#[test]
fn energy_is_not_created() {
    for (name, bsdf, wo) in cases() {
        let n = 4000;
        let powers = (0..n)
            .map(|i| sample(&bsdf, wo, i).map_or(0.0, |s| f64::from(s.weight.max_element() * s.eta * s.eta)));
        let (sum, squares) = powers.fold((0.0, 0.0), |(a, b), x| (a + x, b + x * x));
        let mean = sum / f64::from(n);
        let stderr = ((squares / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt();
        assert!(mean <= energy_limit(&name) + 5.0 * stderr + 1e-5, "{name}: {mean} ± {stderr}");
    }
}

/// A white furnace: what is lossless returns as much as it receives, to 0.1 % and five standard errors.
#[test]
fn lossless_models_lose_nothing() {
    let models = lossless_models();
    assert!(models.len() > 20, "no cases, no evidence");
    for (name, bsdf) in models {
        let sides: &[f32] =
            if bsdf.sample(-Vec3::Z, 0.99, Vec2::splat(0.5)).is_some() { &[1.0, -1.0] } else { &[1.0] };
        for (z, side) in
            [0.97_f32, 0.7, 0.4, 0.15].into_iter().flat_map(|z| sides.iter().map(move |&side| (z, side)))
        {
            let wo = Vec3::new((1.0 - z * z).sqrt(), 0.0, side * z);
            let n = 20_000;
            let power = |i| sample(&bsdf, wo, i).map_or(0.0, |s| f64::from(s.weight.y * s.eta * s.eta));
            let (sum, squares) = (0..n).map(power).fold((0.0, 0.0), |(a, b), x| (a + x, b + x * x));
            let mean = sum / f64::from(n);
            let stderr = ((squares / f64::from(n) - mean * mean).max(0.0) / f64::from(n)).sqrt();
            assert!((mean - 1.0).abs() <= 1e-3 + 5.0 * stderr, "{name} from {wo}: {mean} ± {stderr}");
        }
    }
}

/// Directions in the surface, along the normal, and opposite to one another give numbers, not NaN.
#[test]
fn degenerate_directions_are_harmless() {
    let tiny = f32::MIN_POSITIVE;
    let directions = [
        Vec3::X,
        -Vec3::X,
        Vec3::Z,
        -Vec3::Z,
        Vec3::new(1.0, 0.0, tiny),
        Vec3::new(-1.0, 0.0, tiny),
        Vec3::new(0.0, 1.0, -tiny),
        Vec3::new(0.0, 1.0, 1e-20),
        Vec3::new(0.0, -1.0, 1e-20),
        Vec3::new(0.6, 0.0, 0.8),
    ];
    let corner = 1.0 - f32::EPSILON / 2.0;
    let corners = [0.0, 0.5, corner];
    for (name, bsdf, _) in cases() {
        for wo in directions {
            for wi in directions {
                assert!(bsdf.eval(wo, wi).is_finite(), "{name}, {wo}, {wi}");
                assert!(bsdf.pdf(wo, wi).is_finite() && bsdf.pdf(wo, wi) >= 0.0, "{name}, {wo}, {wi}");
            }
            for u_lobe in corners {
                for u in corners.iter().flat_map(|&x| corners.map(|y| Vec2::new(x, y))) {
                    let Some(s) = bsdf.sample(wo, u_lobe, u) else { continue };
                    assert!(
                        s.weight.is_finite() && s.pdf.is_finite() && s.wi.is_finite(),
                        "{name}, {wo}: {s:?}"
                    );
                }
            }
        }
    }
}
