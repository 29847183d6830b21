//! What must hold of every scattering model, whichever it is.

use glam::{Vec2, Vec3};
use sr_bsdf::{Bsdf, BsdfSample, Rgb};
use sr_sampling::{Accumulator, Independent, SampleId, Sequence};
use sr_stats::chi2;
use sr_stats::{TestReport, z_test};

use crate::subject::Verdict;

/// Uniforms for the choice of a lobe and of a direction.
fn uniforms(seed: u64, index: u32) -> (f32, Vec2) {
    let (sequence, at) = (Independent::new(seed), SampleId { pixel: 0, index });
    (sequence.get_1d(at, 0), sequence.get_2d(at, 1))
}

fn samples<B: Bsdf>(bsdf: &B, wo: Vec3, seed: u64, n: u32) -> impl Iterator<Item = BsdfSample> {
    (0..n).filter_map(move |i| {
        let (u_lobe, u) = uniforms(seed, i);
        bsdf.sample(wo, u_lobe, u)
    })
}

fn uniform_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let (sin, cos) = (std::f32::consts::TAU * u.y).sin_cos();
    (Vec3::new(cos, sin, 0.0) * (1.0 - z * z).max(0.0).sqrt()).with_z(z)
}

/// Does anything but a delta lobe answer to this direction?
pub fn scatters<B: Bsdf>(bsdf: &B, wo: Vec3) -> bool {
    samples(bsdf, wo, 5, 100).any(|s| !s.delta)
}

/// `sample` may compute density and weight by other formulas than `pdf` and `eval`; they must agree. The halfway
/// vector of two directions in single precision is off by about 10⁻⁷ / |η − 1|, which a narrow lobe magnifies.
pub fn sample_is_eval_and_pdf<B: Bsdf>(bsdf: &B, wo: Vec3, seed: u64) -> Verdict {
    Verdict::of(samples(bsdf, wo, seed, 2000).filter(|s| !s.delta).find_map(|s| {
        let pdf = bsdf.pdf(wo, s.wi);
        let weight = bsdf.eval(wo, s.wi) * s.wi.z.abs() / s.pdf;
        let tolerance = if s.pdf > 100.0 { 0.05 } else { 0.005 };
        let off = !((pdf / s.pdf - 1.0).abs() < tolerance)
            || !((weight - s.weight).abs().max_element() < tolerance * s.weight.max_element().max(1.0));
        off.then(|| format!("{s:?}, but pdf = {pdf} and f cos / pdf = {weight}"))
    }))
}

/// Where f > 0, the density is > 0: anywhere, at grazing angles, and around what is drawn.
pub fn covered<B: Bsdf>(bsdf: &B, wo: Vec3, seed: u64) -> Verdict {
    let around = |i: u32| {
        let (u_lobe, u) = uniforms(seed, i / 4);
        let width = [0.01, 0.03, 0.1, 0.3][(i % 4) as usize];
        let s = bsdf.sample(wo, u_lobe, u)?;
        (s.wi + width * uniform_sphere(uniforms(!seed, i).1)).try_normalize()
    };
    let direction = |i: u32| match i % 3 {
        0 => Some(uniform_sphere(uniforms(seed, i).1)),
        1 => (uniform_sphere(uniforms(seed, i).1) * Vec3::new(1.0, 1.0, 1e-3)).try_normalize(),
        _ => around(i),
    };
    Verdict::of((0..6000).filter_map(direction).find_map(|wi| {
        let (f, pdf) = (bsdf.eval(wo, wi), bsdf.pdf(wo, wi));
        let missed = f.max_element() * wi.z.abs() > 1e-6 && !(pdf > 0.0);
        missed.then(|| format!("f = {f} along wi = {wi}, where the density is {pdf}"))
    }))
}

/// f(wo, wi) = f(wi, wo) for reflection; for transmission up to η², as radiance is scaled by 1/η².
pub fn reciprocal<B: Bsdf>(bsdf: &B, wo: Vec3, seed: u64) -> Verdict {
    let eta_from = |wo| samples(bsdf, wo, 7, 200).map(|s| s.eta).find(|&eta| eta != 1.0);
    // Where reflection is all but total, the other side knows.
    let beyond = |w: Vec3| eta_from(w).or_else(|| eta_from(-w).map(|eta| 1.0 / eta));
    let eta = beyond(wo).or_else(|| beyond(Vec3::Z * wo.z.signum())).unwrap_or(1.0);
    Verdict::of((0..500).find_map(|i| {
        let wi = uniform_sphere(uniforms(seed, i).1);
        let scale = if wo.z * wi.z > 0.0 { 1.0 } else { eta * eta };
        let (there, back) = (bsdf.eval(wo, wi) * scale, bsdf.eval(wi, wo));
        // Rounding is magnified by a narrow tail, at the critical angle, and where a facet is seen edge-on.
        let off = (there - back).abs().max_element() > 0.01 * there.max_element() + 3e-5;
        off.then(|| format!("wi = {wi}: {there} and, with both directions exchanged, {back}"))
    }))
}

/// The power that returns, relative to what comes in: the scaling of radiance by η² undone.
fn returned<B: Bsdf>(bsdf: &B, wo: Vec3, seed: u64, n: u32, of: impl Fn(Rgb) -> f32) -> Accumulator {
    let power = |i| {
        let (u_lobe, u) = uniforms(seed, i);
        bsdf.sample(wo, u_lobe, u).map_or(0.0, |s| f64::from(of(s.weight) * s.eta * s.eta))
    };
    (0..n).map(power).collect()
}

/// A surface does not return more light than it receives, or than is known of its model.
pub fn energy<B: Bsdf>(bsdf: &B, wo: Vec3, limit: f64, seed: u64) -> Verdict {
    let estimate = returned(bsdf, wo, seed, 1 << 14, Vec3::max_element).estimate();
    let excess = sr_sampling::Estimate { mean: (estimate.mean - limit - 1e-4).max(0.0), ..estimate };
    Verdict::Chance(TestReport { remark: format!("{estimate} of the light returns"), ..z_test(excess, 0.0) })
}

/// A surface that absorbs nothing returns all of it, up to `slack`.
pub fn white_furnace<B: Bsdf>(bsdf: &B, wo: Vec3, slack: f64, seed: u64) -> Verdict {
    let estimate = returned(bsdf, wo, seed, 1 << 17, Vec3::min_element).estimate();
    let off = sr_sampling::Estimate { mean: ((estimate.mean - 1.0).abs() - slack).max(0.0), ..estimate };
    Verdict::Chance(TestReport {
        remark: format!("{estimate} of the light returns, not all"),
        ..z_test(off, 0.0)
    })
}

/// The directions of delta lobes come as often as their `pdf` says, and carry the same pdf and weight.
pub fn delta_lobes<B: Bsdf>(bsdf: &B, wo: Vec3, seed: u64) -> Verdict {
    let n = 1 << 14;
    let mut lobes: Vec<(BsdfSample, u32)> = Vec::new();
    for s in samples(bsdf, wo, seed, n).filter(|s| s.delta) {
        let Some((known, count)) = lobes.iter_mut().find(|(known, _)| known.wi.distance(s.wi) < 1e-4) else {
            lobes.push((s, 1));
            if lobes.len() > 8 {
                return Verdict::Fails("more than eight delta lobes".into());
            }
            continue;
        };
        *count += 1;
        let same = (known.pdf - s.pdf).abs() < 1e-4
            && (known.weight - s.weight).abs().max_element() < 1e-3 * known.weight.max_element().max(1.0);
        if !same {
            return Verdict::Fails(format!("{known:?} and {s:?} differ"));
        }
    }
    let cell = |expected: f64, observed: u32| chi2::Cell { expected, observed: u64::from(observed) };
    let mut cells: Vec<chi2::Cell> =
        lobes.iter().map(|(s, count)| cell(f64::from(n) * f64::from(s.pdf), *count)).collect();
    let (expected, observed): (f64, u64) =
        cells.iter().fold((0.0, 0), |(e, o), c| (e + c.expected, o + c.observed));
    if expected > f64::from(n) * (1.0 + 1e-4) {
        return Verdict::Fails(format!("the probabilities of the lobes sum to {}", expected / f64::from(n)));
    }
    if cells.len() == 1 && f64::from(n) - expected < 1.0 {
        // The only thing that can happen: there is nothing for chance to decide.
        let off = observed != u64::from(n);
        return Verdict::of(off.then(|| format!("{observed} of {n} are drawn, whose probability is 1")));
    }
    cells.push(cell((f64::from(n) - expected).max(0.0), n - observed as u32));
    Verdict::Chance(chi2::pearson(&cells, |i| match lobes.get(i) {
        Some((s, count)) => format!("{count} of {n} along {}, whose probability is {}", s.wi, s.pdf),
        None => "anything else".into(),
    }))
}

/// No direction and no corner of the unit cube gives NaN, infinity or a negative number. What is refracted changes the side,
/// unless the normal is `tilted`.
pub fn finite<B: Bsdf>(bsdf: &B, wo: Vec3, tilted: bool, seed: u64) -> Verdict {
    let tiny = f32::MIN_POSITIVE;
    let mut directions = vec![
        wo,
        Vec3::X,
        -Vec3::X,
        Vec3::Z,
        -Vec3::Z,
        Vec3::new(1.0, 0.0, tiny),
        Vec3::new(-1.0, 0.0, tiny),
        Vec3::new(0.0, 1.0, -tiny),
        Vec3::new(0.0, -1.0, 1e-20),
        Vec3::new(0.6, 0.0, 0.8),
        Vec3::new(0.8, -0.6, 1e-3).normalize(),
    ];
    directions.extend((0..20).map(|i| uniform_sphere(uniforms(seed, i).1)));
    let corner = 1.0 - f32::EPSILON / 2.0;
    let corners = [0.0, 0.5, corner];
    let mut tried: Vec<(f32, Vec2)> = corners
        .into_iter()
        .flat_map(|u_lobe| corners.into_iter().flat_map(move |x| corners.map(|y| (u_lobe, Vec2::new(x, y)))))
        .collect();
    tried.extend((0..50).map(|i| uniforms(seed, i)));
    let wrong_value = |&wo: &Vec3, &wi: &Vec3| {
        let (f, pdf) = (bsdf.eval(wo, wi), bsdf.pdf(wo, wi));
        let right = f.is_finite() && f.min_element() >= 0.0 && pdf.is_finite() && pdf >= 0.0;
        (!right).then(|| format!("wo = {wo:?}, wi = {wi:?}: f = {f}, pdf = {pdf}"))
    };
    let wrong_sample = |&wo: &Vec3, &(u_lobe, u): &(f32, Vec2)| {
        let s = bsdf.sample(wo, u_lobe, u)?;
        let right = s.weight.is_finite()
            && s.weight.min_element() >= 0.0
            && s.pdf > 0.0
            && s.pdf.is_finite()
            && (s.wi.length() - 1.0).abs() < 1e-5
            && s.eta > 0.0
            && (s.eta == 1.0 || tilted || s.wi.z * wo.z <= 0.0)
            && !(s.delta && s.pdf > 1.0 + 1e-6);
        (!right).then(|| format!("wo = {wo:?}, u = {u_lobe}, {u:?}: {s:?}"))
    };
    Verdict::of(directions.iter().find_map(|wo| {
        let value = directions.iter().find_map(|wi| wrong_value(wo, wi));
        value.or_else(|| tried.iter().find_map(|u| wrong_sample(wo, u)))
    }))
}
