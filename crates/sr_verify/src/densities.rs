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
    if density.space() == Space::Line && density.cumulative().is_some() {
        let of = Arc::clone(&density);
        subject = subject.check("cdf", move |seed| {
            let (drawn, cdf) = (Drawn::independent(of.as_ref(), 1 << 16, seed), cumulative(of.as_ref()));
            Verdict::Chance(ks(&drawn.x, |x| cdf.cdf(x)))
        });
        let of = Arc::clone(&density);
        subject = subject.check("icdf", move |seed| icdf_undoes_cdf(of.as_ref(), seed));
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
    Verdict::of(drawn.x.iter().zip(&drawn.pdf).find_map(|(&x, &pdf)| {
        let u = cumulative.cdf(x);
        // u is rounded by 10⁻¹⁶, and x.
        let tolerance = 1e-9 * x.abs().min(1.0 / pdf) + 1e-13 / pdf + 8.0 * f64::EPSILON * x.abs();
        let back = cumulative.icdf(u);
        let off = !((back - x).abs() <= tolerance) || !(0.0..=1.0).contains(&u);
        off.then(|| format!("cdf({x}) = {u}, icdf of that {back}"))
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
            let off = !((there - back).abs() <= tolerance / slack);
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
