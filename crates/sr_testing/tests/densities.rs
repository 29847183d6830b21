//! Every density that is chosen at run time: samples, densities, distribution functions and means belong
//! together.

use sr_integrate::{Columns, ColumnsMut, Cumulative, Density, Space};
use sr_sampling::Accumulator;
use sr_stats::{Chi2Settings, TestReport, ks, sidak, z_test};
use sr_testing::density_tests::{Drawn, chi2};
use sr_testing::{DensityCase, densities};

/// The chance that a test of this file raises a false alarm, had its seeds not been fixed.
const SUITE_FAILURE_RATE: f64 = 1e-3;

fn cases() -> Vec<DensityCase> {
    let cases = densities();
    assert!(cases.len() > 100, "only {} cases", cases.len());
    cases
}

/// Panics with all reports that do not pass at the level that the number of them asks for.
fn all_pass(reports: &[(String, TestReport)], at_least: usize) {
    assert!(reports.len() >= at_least, "only {} tests", reports.len());
    let level = sidak(SUITE_FAILURE_RATE, reports.len());
    let failures: Vec<String> = reports
        .iter()
        .filter(|(_, report)| !report.passes(level))
        .map(|(name, report)| format!("{name}: {report}"))
        .collect();
    assert!(failures.is_empty(), "{} of {} fail:\n{}", failures.len(), reports.len(), failures.join("\n"));
}

fn pdf_at(density: &dyn Density, x: Columns<'_>) -> Vec<f64> {
    let mut pdf = vec![0.0; x.len()];
    density.pdf(x, &mut pdf).expect("densities of this project do not fail");
    pdf
}

/// Those on the line with a distribution function.
fn with_cdf(cases: &[DensityCase]) -> impl Iterator<Item = (&DensityCase, &dyn Cumulative)> {
    let cumulative =
        |case: &'_ DensityCase| case.density.space() == Space::Line && case.density.cumulative().is_some();
    cases
        .iter()
        .filter(move |case| cumulative(case))
        .map(|case| (case, case.density.cumulative().expect("filtered")))
}

#[test]
fn names_tell_cases_apart() {
    let mut names: Vec<String> = cases().into_iter().map(|case| case.name).collect();
    let all = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), all);
}

#[test]
fn samples_follow_densities() {
    let test = |(case, seed): (&DensityCase, u64)| {
        let settings = Chi2Settings { samples: 1 << 16, bins: (16, 16), seed };
        (case.name.clone(), chi2(case.density.as_ref(), settings))
    };
    let cases = cases();
    let reports: Vec<_> = cases.iter().zip(1..).map(test).collect();
    all_pass(&reports, 100);
}

#[test]
fn samples_follow_distribution_functions() {
    let cases = cases();
    let test = |((case, cumulative), seed): ((&DensityCase, &dyn Cumulative), u64)| {
        let drawn = Drawn::independent(case.density.as_ref(), 1 << 16, seed);
        (case.name.clone(), ks(&drawn.x, |x| cumulative.cdf(x)))
    };
    let reports: Vec<_> = with_cdf(&cases).zip(1..).map(test).collect();
    all_pass(&reports, 45);
}

/// ∫ p over the intervals between many quantiles is what the distribution function says. Where the density
/// jumps or has a pole the rule is off, but that is in few of them.
#[test]
fn densities_are_slopes_of_distribution_functions() {
    const INTERVALS: usize = 4000;
    let nodes =
        [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
    for (case, cumulative) in with_cdf(&cases()) {
        let edges: Vec<f64> = (1..INTERVALS).map(|i| cumulative.icdf(i as f64 / INTERVALS as f64)).collect();
        let mut off = 0;
        for pair in edges.windows(2) {
            let x = nodes.map(|(node, _)| pair[0] * (1.0 - node) + pair[1] * node);
            let pdf = pdf_at(case.density.as_ref(), Columns::new(&x, 3));
            let integral: f64 = pdf.iter().zip(nodes).map(|(p, (_, w))| p * w * (pair[1] - pair[0])).sum();
            let rounding = 4.0 * f64::EPSILON * pair[1].abs() / (pair[1] - pair[0]);
            let difference = (integral * INTERVALS as f64 - 1.0).abs();
            off += usize::from(!(difference < 1e-3 + rounding));
        }
        let allowed = if case.name.contains("thousand") { INTERVALS / 2 } else { 40 };
        assert!(off <= allowed, "{}: {off} of {INTERVALS} intervals", case.name);
    }
}

#[test]
fn icdf_undoes_cdf() {
    for (case, cumulative) in with_cdf(&cases()) {
        let drawn = Drawn::independent(case.density.as_ref(), 2000, 5);
        for (&x, &pdf) in drawn.x.iter().zip(&drawn.pdf) {
            let u = cumulative.cdf(x);
            assert!((0.0..=1.0).contains(&u), "{}: cdf({x}) = {u}", case.name);
            // u is rounded by 10⁻¹⁶, and x.
            let tolerance = 1e-9 * x.abs().min(1.0 / pdf) + 1e-13 / pdf + 8.0 * f64::EPSILON * x.abs();
            let back = cumulative.icdf(u);
            assert!((back - x).abs() <= tolerance, "{}: icdf(cdf({x})) = {back}", case.name);
            let from_above = cumulative.inverse_above(cumulative.above(x));
            assert!(
                (from_above - x).abs() <= tolerance,
                "{}: from above, {x} became {from_above}",
                case.name
            );
            assert!((cumulative.above(x) + u - 1.0).abs() < 1e-12, "{}: both tails of {x}", case.name);
        }
        let [[low, high]] = case.density.support()[..] else { panic!("on the line") };
        let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-9 * (high - low);
        assert!(near(cumulative.icdf(0.0), low) && near(cumulative.icdf(1.0), high), "{}: ends", case.name);
        assert_eq!((cumulative.cdf(low), cumulative.cdf(high)), (0.0, 1.0), "{}", case.name);
    }
}

#[test]
fn invert_undoes_sample() {
    let mut inverted = 0;
    for case in cases() {
        let Some(inverse) = case.density.inverse() else { continue };
        inverted += 1;
        let drawn = Drawn::independent(case.density.as_ref(), 10_000, 3);
        let mut u = vec![0.0; drawn.u.len()];
        let n = drawn.pdf.len();
        inverse
            .invert(drawn.points(), ColumnsMut::new(&mut u, n))
            .expect("densities of this project do not fail");
        let again =
            Drawn::new(case.density.as_ref(), u.iter().map(|u| u.min(1.0 - f64::EPSILON / 2.0)).collect());
        for i in (0..n).filter(|&i| drawn.pdf[i] > 0.0) {
            if !case.is_continuous() {
                assert_eq!(again.x[i], drawn.x[i], "{}", case.name);
                continue;
            }
            for j in 0..case.density.uniforms() {
                let (there, back) = (drawn.uniforms().get(i, j), u[j * n + i]);
                assert!((0.0..1.0).contains(&back), "{}: {back}", case.name);
                let error = (there - back).abs();
                // Points in single precision near a vertex have uniforms that are all but arbitrary.
                let tolerance =
                    case.tolerance / if case.tolerance > 1e-4 { drawn.uniforms().get(i, 1) } else { 1.0 };
                assert!(error <= tolerance, "{}: uniform {j}, {there}, came back as {back}", case.name);
            }
        }
        // What is not in the support has no uniforms.
        let outside = vec![f64::NAN; case.density.space().dim()];
        let mut nothing = vec![0.0; case.density.uniforms()];
        inverse.invert(Columns::new(&outside, 1), ColumnsMut::new(&mut nothing, 1)).expect("no failure");
        assert!(nothing.iter().all(|u| u.is_nan()), "{}", case.name);
    }
    assert!(inverted > 100, "only {inverted} can be inverted");
}

#[test]
fn means_are_those_of_the_samples() {
    let mut reports = Vec::new();
    for (case, seed) in cases().iter().zip(1..) {
        let Some(mean) = case.density.mean() else { continue };
        let drawn = Drawn::independent(case.density.as_ref(), 1 << 16, seed);
        // In units of the spread, so that no square is too large for a number.
        for (j, &mean) in mean.iter().enumerate() {
            let column = drawn.points().column(j);
            let scale = column.iter().fold(0.0, |scale: f64, x| scale.max((x - mean).abs()));
            if scale <= 1e-12 * mean.abs() {
                continue; // nothing but rounding
            }
            let estimate = column.iter().map(|x| (x - mean) / scale).collect::<Accumulator>().estimate();
            reports.push((format!("{}, coordinate {j}", case.name), z_test(estimate, 0.0)));
        }
    }
    all_pass(&reports, 100);
}

#[test]
fn supports_hold_all_samples_and_edges_of_the_unit_cube_are_harmless() {
    for case in cases() {
        let density = case.density.as_ref();
        let (support, uniforms) = (density.support(), density.uniforms());
        let corner = 1.0 - f64::EPSILON / 2.0;
        let mut u = Vec::new();
        for j in 0..uniforms {
            // All corners of the first few axes, then the middle of each side.
            u.extend((0..256_usize).map(|i| if (i >> (j % 8)) & 1 == 1 { corner } else { 0.0 }));
            u.extend(
                (0..uniforms * 2)
                    .map(|i| if i / 2 == j { f64::from(u8::from(i % 2 == 0)) * corner } else { 0.5 }),
            );
        }
        for drawn in [Drawn::new(density, u), Drawn::independent(density, 20_000, 9)] {
            let is = pdf_at(density, drawn.points());
            let mut strays = 0;
            for i in 0..is.len() {
                let (said, point) = (drawn.pdf[i], drawn.points().point(i));
                assert!(said >= 0.0 && said.is_finite(), "{}: {point:?} with pdf {said}", case.name);
                if said == 0.0 {
                    continue;
                }
                for (x, [low, high]) in point.iter().zip(&support) {
                    assert!(x >= low && x <= high, "{}: {point:?} is outside {support:?}", case.name);
                }
                strays += usize::from(is[i] == 0.0);
            }
            assert!(strays as f64 <= 1e-3 * is.len() as f64, "{}: {strays} samples of density 0", case.name);
        }
    }
}

#[test]
fn no_density_beyond_the_support_at_infinity_or_of_nan() {
    for case in cases() {
        let dim = case.density.space().dim();
        for (j, [low, high]) in case.density.support().into_iter().enumerate() {
            let beyond =
                [low - (1.0 + low.abs()), high + (1.0 + high.abs()), f64::NAN, f64::INFINITY, -f64::INFINITY];
            let inside = Drawn::independent(case.density.as_ref(), 1, 1).x;
            let mut x = vec![0.0; beyond.len() * dim];
            for (k, &inside) in inside.iter().enumerate() {
                x[k * beyond.len()..(k + 1) * beyond.len()].fill(inside);
            }
            x[j * beyond.len()..(j + 1) * beyond.len()].copy_from_slice(&beyond);
            let pdf = pdf_at(case.density.as_ref(), Columns::new(&x, beyond.len()));
            assert_eq!(pdf, [0.0; 5], "{}, coordinate {j}", case.name);
        }
    }
}
