//! Tests of means.

use sr_sampling::{Accumulator, Estimate};

use crate::report::TestReport;
use crate::tails::{normal_beyond, student_beyond};

/// Is `expected` the mean that these independent numbers were drawn about? Student's t-test, two-sided.
///
/// For renders and Sobol' points the numbers are the means of independent replicates. Fewer than two
/// numbers are no evidence: the p-value is NaN, which passes at no level.
pub fn t_test(numbers: &[f64], expected: f64) -> TestReport {
    let estimate = numbers.iter().copied().collect::<Accumulator>().estimate();
    let t = deviations(estimate.mean - expected, estimate.stderr);
    let dof = numbers.len() as f64 - 1.0;
    let p_value = if dof > 0.0 && !t.is_nan() { student_beyond(t, dof) } else { f64::NAN };
    TestReport { statistic: t, dof, p_value, remark: format!("{estimate} against {expected}") }
}

/// Do two sets of independent numbers have the same mean? Welch's t-test, two-sided: their variances
/// may differ.
pub fn welch(a: &[f64], b: &[f64]) -> TestReport {
    let of = |numbers: &[f64]| numbers.iter().copied().collect::<Accumulator>().estimate();
    let (a, b) = (of(a), of(b));
    let (va, vb) = (a.stderr * a.stderr, b.stderr * b.stderr);
    let t = deviations(a.mean - b.mean, (va + vb).sqrt());
    // Welch & Satterthwaite; two constants leave no variance, and then the dof do not matter.
    let spread = va * va / (a.n as f64 - 1.0) + vb * vb / (b.n as f64 - 1.0);
    let dof = if spread == 0.0 { (a.n + b.n) as f64 - 2.0 } else { (va + vb) * (va + vb) / spread };
    let p_value = if dof > 0.0 && !t.is_nan() { student_beyond(t, dof) } else { f64::NAN };
    TestReport { statistic: t, dof, p_value, remark: format!("{a} against {b}") }
}

/// Is `expected` the true value of an estimate of many samples? Normal, two-sided.
pub fn z_test(estimate: Estimate, expected: f64) -> TestReport {
    let z = deviations(estimate.mean - expected, estimate.stderr);
    let remark = format!("{estimate} against {expected}");
    TestReport { statistic: z, dof: f64::INFINITY, p_value: normal_beyond(z), remark }
}

/// Do two independent estimates of many samples estimate the same? Normal, two-sided.
pub fn z_test_pair(a: Estimate, b: Estimate) -> TestReport {
    let z = deviations(a.mean - b.mean, a.stderr.hypot(b.stderr));
    let remark = format!("{a} against {b}");
    TestReport { statistic: z, dof: f64::INFINITY, p_value: normal_beyond(z), remark }
}

/// A difference in standard errors; 0 for no difference, also where there is no error.
fn deviations(difference: f64, stderr: f64) -> f64 {
    if difference == 0.0 && stderr == 0.0 { 0.0 } else { difference / stderr }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn t_test_of_known_numbers() {
        // Mean 3, standard error √(2.5 / 5): t = 2 / √0.5 with 4 degrees of freedom.
        let report = t_test(&[1.0, 2.0, 3.0, 4.0, 5.0], 1.0);
        assert!((report.statistic - 8.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(report.dof, 4.0);
        // Student's tail for 4 degrees of freedom, in closed form.
        let x = 4.0 / (4.0 + 8.0_f64);
        let beyond = 1.0 - (1.0 - x).sqrt() * (1.0 + 0.5 * x);
        assert!((report.p_value - beyond).abs() < 1e-12, "{report}");
    }

    #[test]
    fn without_spread_only_equality_passes() {
        assert_eq!(t_test(&[2.0, 2.0, 2.0], 2.0).p_value, 1.0);
        assert_eq!(t_test(&[2.0, 2.0, 2.0], 2.1).p_value, 0.0);
        assert_eq!(welch(&[2.0, 2.0], &[2.0, 2.0]).p_value, 1.0);
        assert_eq!(welch(&[2.0, 2.0], &[3.0, 3.0]).p_value, 0.0);
    }

    #[test]
    fn too_few_or_broken_numbers_never_pass() {
        for report in
            [t_test(&[1.0], 1.0), t_test(&[], 0.0), t_test(&[1.0, f64::NAN], 1.0), welch(&[1.0], &[1.0])]
        {
            assert!(!report.passes(0.0), "{report}");
        }
        let nothing = Estimate { mean: f64::NAN, stderr: f64::NAN, n: 0 };
        assert!(!z_test(nothing, 0.0).passes(0.0));
    }

    #[test]
    fn welch_of_equal_sizes_and_variances_is_the_pooled_test() {
        let report = welch(&[1.0, 2.0, 3.0], &[2.0, 3.0, 4.0]);
        assert!((report.dof - 4.0).abs() < 1e-12);
        assert!((report.statistic + (1.5_f64).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn z_tests_measure_in_standard_errors() {
        let a = Estimate { mean: 5.0, stderr: 3.0, n: 100 };
        let b = Estimate { mean: 0.0, stderr: 4.0, n: 100 };
        assert_eq!(z_test_pair(a, b).statistic, 1.0);
        assert!((z_test(a, 2.0).p_value - 0.317_310_507_862_914).abs() < 1e-9);
    }
}
