//! Distributions of `sr.integrate`: samples, densities, distribution functions, inverses and means belong together.

use std::sync::Arc;

use sr_integrate::{Columns, ColumnsMut, Cumulative, Density, Space};
use sr_sampling::Accumulator;
use sr_stats::{Chi2Settings, ks, z_test};
use sr_testing::density_tests::{Drawn, chi2};
use sr_testing::{DensityCase, densities};

use crate::subject::{Group, Subject, Verdict};

const SETTINGS: Chi2Settings = Chi2Settings { samples: 1 << 16, bins: (16, 16), seed: 0 };

pub fn subjects() -> Vec<Subject> {
    densities().into_iter().map(subject).collect()
}

fn subject(case: DensityCase) -> Subject {
    let DensityCase { name, density, tolerance } = case;
    let mut subject = Subject::new(Group::Distribution, name);
    let of = Arc::clone(&density);
    subject = subject.check("chi-square", move |seed| {
        Verdict::Chance(chi2(of.as_ref(), Chi2Settings { seed, ..SETTINGS }))
    });
    let of = Arc::clone(&density);
    subject = subject.check("finite", move |seed| finite(of.as_ref(), seed));
    let of = Arc::clone(&density);
    subject = subject.check("support", move |seed| nothing_beyond_support(of.as_ref(), seed));
    if density.space() == Space::Line && density.cumulative().is_some() {
        let of = Arc::clone(&density);
        subject = subject.check("cdf", move |seed| {
            let (drawn, cdf) = (Drawn::independent(of.as_ref(), 1 << 16, seed), cumulative(of.as_ref()));
            Verdict::Chance(ks(&drawn.x, |x| cdf.cdf(x)))
        });
        let of = Arc::clone(&density);
        subject = subject.check("icdf", move |seed| icdf_undoes_cdf(of.as_ref(), seed));
        let of = Arc::clone(&density);
        let steep = subject.case.contains("thousand");
        subject = subject.check("slope", move |_| is_slope_of_cdf(of.as_ref(), steep));
    }
    if density.inverse().is_some() {
        let of = Arc::clone(&density);
        subject = subject.check("invert", move |seed| invert_undoes_sample(of.as_ref(), tolerance, seed));
    }
    if density.mean().is_some() {
        subject = subject.check("mean", move |seed| mean_is_that_of_samples(density.as_ref(), seed));
    }
    subject
}

fn cumulative(density: &dyn Density) -> &dyn Cumulative {
    density.cumulative().expect("only those that have one are asked")
}

/// Samples lie in the support and carry the density at them, also at the corners of the unit cube.
fn finite(density: &dyn Density, seed: u64) -> Verdict {
    let (support, uniforms) = (density.support(), density.uniforms());
    let corner = 1.0 - f64::EPSILON / 2.0;
    let corners = (0..uniforms)
        .flat_map(|j| (0..256_usize).map(move |i| if (i >> (j % 8)) & 1 == 1 { corner } else { 0.0 }));
    let mut strays = 0;
    for drawn in [Drawn::new(density, corners.collect()), Drawn::independent(density, 10_000, seed)] {
        let mut is = vec![0.0; drawn.pdf.len()];
        if let Err(error) = density.pdf(drawn.points(), &mut is) {
            return Verdict::Fails(error.to_string());
        }
        for i in 0..is.len() {
            let (said, point) = (drawn.pdf[i], drawn.points().point(i));
            if !(said >= 0.0 && said.is_finite() && is[i] >= 0.0 && is[i].is_finite()) {
                return Verdict::Fails(format!("{point:?} with pdf {said}, and density {}", is[i]));
            }
            let outside = point.iter().zip(&support).any(|(x, [low, high])| !(x >= low && x <= high));
            if said > 0.0 && outside {
                return Verdict::Fails(format!("{point:?} is outside of the support {support:?}"));
            }
            strays += usize::from(said > 0.0 && is[i] == 0.0);
        }
    }
    Verdict::of((strays > 10).then(|| format!("{strays} of 10,000 samples where the density is 0")))
}

fn icdf_undoes_cdf(density: &dyn Density, seed: u64) -> Verdict {
    let (drawn, cumulative) = (Drawn::independent(density, 2000, seed), cumulative(density));
    let [[low, high]] = density.support()[..] else { return Verdict::Fails("has no interval".into()) };
    let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-9 * (high - low);
    let ends = [(0.0, low), (1.0, high)];
    let end = ends.into_iter().find(|&(u, x)| !near(cumulative.icdf(u), x) || cumulative.cdf(x) != u);
    if let Some((u, x)) = end {
        return Verdict::Fails(format!(
            "cdf({x}) = {}, icdf({u}) = {}",
            cumulative.cdf(x),
            cumulative.icdf(u)
        ));
    }
    Verdict::of(drawn.x.iter().zip(&drawn.pdf).find_map(|(&x, &pdf)| {
        let (u, above) = (cumulative.cdf(x), cumulative.above(x));
        // u is rounded by 10⁻¹⁶, and x.
        let tolerance = 1e-9 * x.abs().min(1.0 / pdf) + 1e-13 / pdf + 8.0 * f64::EPSILON * x.abs();
        let (back, from_above) = (cumulative.icdf(u), cumulative.inverse_above(above));
        let off = [back, from_above].iter().any(|back| !((back - x).abs() <= tolerance))
            || !(0.0..=1.0).contains(&u)
            || !((above + u - 1.0).abs() < 1e-12);
        off.then(|| format!("cdf({x}) = {u}, icdf of that {back}; {above} above, from which {from_above}"))
    }))
}

/// ∫ p over the intervals between many quantiles is what the distribution function says. Where the density jumps or has a
/// pole the rule is off, but that is in few of them, unless it is `steep` almost everywhere.
fn is_slope_of_cdf(density: &dyn Density, steep: bool) -> Verdict {
    const INTERVALS: usize = 4000;
    // Gauss and Legendre's rule of three points.
    const NODES: [(f64, f64); 3] =
        [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
    let cumulative = cumulative(density);
    let edges: Vec<f64> = (1..INTERVALS).map(|i| cumulative.icdf(i as f64 / INTERVALS as f64)).collect();
    let x: Vec<f64> = edges
        .windows(2)
        .flat_map(|pair| NODES.map(|(node, _)| pair[0] * (1.0 - node) + pair[1] * node))
        .collect();
    let mut pdf = vec![0.0; x.len()];
    if let Err(error) = density.pdf(Columns::new(&x, x.len()), &mut pdf) {
        return Verdict::Fails(error.to_string());
    }
    let is_off = |(pair, pdf): &(&[f64], &[f64])| {
        let integral: f64 = pdf.iter().zip(NODES).map(|(p, (_, w))| p * w * (pair[1] - pair[0])).sum();
        let rounding = 4.0 * f64::EPSILON * pair[1].abs() / (pair[1] - pair[0]);
        !((integral * INTERVALS as f64 - 1.0).abs() < 1e-3 + rounding)
    };
    let off = edges.windows(2).zip(pdf.chunks(3)).filter(is_off).count();
    let allowed = if steep { INTERVALS / 2 } else { 40 };
    let many = off > allowed;
    Verdict::of(
        many.then(|| format!("∫ p is not the difference of the cdf in {off} of {INTERVALS} intervals")),
    )
}

/// Beyond the support, at infinity and of NaN the density is 0.
fn nothing_beyond_support(density: &dyn Density, seed: u64) -> Verdict {
    let inside = Drawn::independent(density, 1, seed).x;
    let at = |j: usize, value: f64| {
        let mut x = inside.clone();
        x[j] = value;
        let mut pdf = [f64::NAN];
        match density.pdf(Columns::new(&x, 1), &mut pdf) {
            Ok(()) => (pdf[0] != 0.0).then(|| format!("the density of {x:?} is {}", pdf[0])),
            Err(error) => Some(error.to_string()),
        }
    };
    Verdict::of(density.support().into_iter().enumerate().find_map(|(j, [low, high])| {
        let beyond =
            [low - (1.0 + low.abs()), high + (1.0 + high.abs()), f64::NAN, f64::INFINITY, -f64::INFINITY];
        beyond.into_iter().find_map(|value| at(j, value))
    }))
}

fn invert_undoes_sample(density: &dyn Density, tolerance: f64, seed: u64) -> Verdict {
    let Some(inverse) = density.inverse() else { return Verdict::Holds };
    let drawn = Drawn::independent(density, 10_000, seed);
    let n = drawn.pdf.len();
    let mut u = vec![0.0; drawn.u.len()];
    if let Err(error) = inverse.invert(drawn.points(), ColumnsMut::new(&mut u, n)) {
        return Verdict::Fails(error.to_string());
    }
    let below_one = u.iter().map(|u| u.min(1.0 - f64::EPSILON / 2.0)).collect();
    let again = Drawn::new(density, below_one);
    // What is not in the support has no uniforms.
    let mut nothing = vec![0.0; density.uniforms()];
    let outside = vec![f64::NAN; density.space().dim()];
    let asked = inverse.invert(Columns::new(&outside, 1), ColumnsMut::new(&mut nothing, 1));
    if asked.is_err() || !nothing.iter().all(|u| u.is_nan()) {
        return Verdict::Fails(format!("NaN has the uniforms {nothing:?}"));
    }
    let counts = density.space() == Space::Counting;
    Verdict::of((0..n).filter(|&i| drawn.pdf[i] > 0.0).find_map(|i| {
        if counts {
            let off = again.x[i] != drawn.x[i];
            return off.then(|| format!("{} came back as {}", drawn.x[i], again.x[i]));
        }
        // Points in single precision near a vertex have uniforms that are all but arbitrary.
        let slack = if tolerance > 1e-4 { drawn.uniforms().get(i, 1) } else { 1.0 };
        (0..density.uniforms()).find_map(|j| {
            let (there, back) = (drawn.uniforms().get(i, j), Columns::new(&u, n).get(i, j));
            let off = !((there - back).abs() <= tolerance / slack) || !(0.0..1.0).contains(&back);
            off.then(|| format!("uniform {j}, {there}, came back as {back}"))
        })
    }))
}

fn mean_is_that_of_samples(density: &dyn Density, seed: u64) -> Verdict {
    let Some(mean) = density.mean() else { return Verdict::Holds };
    let drawn = Drawn::independent(density, 1 << 16, seed);
    let reports = mean.iter().enumerate().filter_map(|(j, &mean)| {
        let column = drawn.points().column(j);
        // In units of the spread, so that no square is too large for a number.
        let scale = column.iter().fold(0.0, |scale: f64, x| scale.max((x - mean).abs()));
        let nothing_but_rounding = scale <= 1e-12 * mean.abs();
        let units = column.iter().map(|x| (x - mean) / scale);
        (!nothing_but_rounding).then(|| z_test(units.collect::<Accumulator>().estimate(), 0.0))
    });
    let worst = reports.min_by(|a, b| a.p_value.total_cmp(&b.p_value));
    worst.map_or(Verdict::Holds, |mut report| {
        report.p_value = (report.p_value * mean.len() as f64).min(1.0); // the worst of so many
        Verdict::Chance(report)
    })
}
