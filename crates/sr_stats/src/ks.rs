//! Samples on the line against a cumulative distribution.

use crate::report::TestReport;
use crate::tails::kolmogorov_above;

/// Were the samples drawn with this cumulative distribution? Kolmogorov-Smirnov, one sample, two-sided.
///
/// The p-value is the asymptotic one with Stephens' (1970) correction, good from ten samples on. No
/// sample, or one that is NaN, passes at no level.
pub fn ks(samples: &[f64], cdf: impl Fn(f64) -> f64) -> TestReport {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    if sorted.is_empty() || sorted.iter().any(|x| x.is_nan()) {
        return TestReport {
            statistic: f64::NAN,
            dof: n,
            p_value: f64::NAN,
            remark: "no valid samples".into(),
        };
    }
    let distance = |(i, &x): (usize, &f64)| {
        let f = cdf(x);
        ((f - i as f64 / n).max((i + 1) as f64 / n - f), x)
    };
    let (d, at) =
        sorted.iter().enumerate().map(distance).fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
    let scale = n.sqrt() + 0.12 + 0.11 / n.sqrt();
    let remark = format!("farthest at x = {at}");
    TestReport { statistic: d, dof: n, p_value: kolmogorov_above(scale * d), remark }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_statistic_is_the_largest_gap() {
        let report = ks(&[0.1, 0.2, 0.9], |x| x);
        assert!((report.statistic - (2.0 / 3.0 - 0.2)).abs() < 1e-12, "{report}");
    }

    #[test]
    fn even_samples_pass_and_others_do_not() {
        let even: Vec<f64> = (0..1000).map(|i| (f64::from(i) + 0.5) / 1000.0).collect();
        assert!(ks(&even, |x| x).passes(0.99));
        assert!(!ks(&even, |x| x * x).passes(1e-6));
        assert!(!ks(&[], |x| x).passes(0.0));
        assert!(!ks(&[f64::NAN; 20], |x| x).passes(0.0));
    }
}
