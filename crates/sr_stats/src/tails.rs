//! Probabilities of the tails of the usual distributions.

use statrs::function::{beta::beta_reg, erf::erfc, gamma::gamma_ur};

/// P(χ² ≥ x) with `dof` degrees of freedom.
pub fn chi2_above(x: f64, dof: f64) -> f64 {
    if x <= 0.0 { 1.0 } else { gamma_ur(0.5 * dof, 0.5 * x) }
}

/// P(|T| ≥ |t|) of Student's distribution with `dof` degrees of freedom.
pub fn student_beyond(t: f64, dof: f64) -> f64 {
    if t.is_infinite() { 0.0 } else { beta_reg(0.5 * dof, 0.5, dof / (dof + t * t)) }
}

/// The number that Student's t with `dof` degrees of freedom stays below with probability `p` in (0, 1).
///
/// By bisection of [`student_beyond`]; above 10⁷ degrees of freedom that of the normal distribution, which is as near.
/// NaN if an argument makes no sense.
pub fn student_t_quantile(p: f64, dof: f64) -> f64 {
    if !(p > 0.0 && p < 1.0 && dof > 0.0) {
        return f64::NAN;
    }
    let beyond = 2.0 * p.min(1.0 - p);
    let above = |t: f64| if dof < 1e7 { student_beyond(t, dof) } else { normal_beyond(t) };
    let (mut low, mut high) = (0.0, 1.0);
    while above(high) > beyond && high < 1e300 {
        (low, high) = (high, high * 2.0);
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if above(middle) > beyond {
            low = middle;
        } else {
            high = middle;
        }
    }
    if p < 0.5 { -high } else { high }
}

/// P(|Z| ≥ |z|) of the normal distribution.
pub fn normal_beyond(z: f64) -> f64 {
    erfc(z.abs() * std::f64::consts::FRAC_1_SQRT_2)
}

/// P(K ≥ x) of Kolmogorov's distribution: 2 Σ (−1)^(j−1) exp(−2 j² x²).
pub fn kolmogorov_above(x: f64) -> f64 {
    if x < 0.2 {
        return 1.0; // to 10⁻¹², and where the series converges slowly
    }
    let term = |j: i32| {
        let size = (-2.0 * f64::from(j * j) * x * x).exp();
        if j % 2 == 1 { size } else { -size }
    };
    (2.0 * (1..=100).map(term).sum::<f64>()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 1e-6, "{value} is not {expected}");
    }

    /// Closed forms, for 2 degrees of freedom (and 1 for Student's), and tables (Abramowitz & Stegun).
    #[test]
    fn known_tails() {
        close(chi2_above(5.0, 2.0), (-2.5_f64).exp());
        close(chi2_above(60.0, 2.0), (-30.0_f64).exp());
        close(chi2_above(3.841_458_820_694_124, 1.0), 0.05);
        close(student_beyond(1.0, 1.0), 0.5);
        close(student_beyond(2.0, 2.0), 1.0 - 2.0 / 6.0_f64.sqrt());
        close(normal_beyond(1.959_963_984_540_054), 0.05);
        close(kolmogorov_above(1.358_098_68), 0.05);
        assert_eq!(chi2_above(0.0, 3.0), 1.0);
        assert_eq!(student_beyond(f64::INFINITY, 3.0), 0.0);
    }

    /// Tables of Student's t (Abramowitz & Stegun 26.10).
    #[test]
    fn known_quantiles() {
        close(student_t_quantile(0.975, 1.0), 12.706_204_736);
        close(student_t_quantile(0.975, 31.0), 2.039_513_446);
        close(student_t_quantile(0.025, 31.0), -2.039_513_446);
        close(student_t_quantile(0.9995, 7.0), 5.407_882_521);
        close(student_t_quantile(0.975, 1e9), 1.959_963_985);
        assert!(student_t_quantile(0.5, 3.0).abs() < 1e-12);
        assert!(student_t_quantile(1.5, 3.0).is_nan());
    }

    /// For many degrees of freedom the tail is that of the normal law, by Wilson & Hilferty (1931).
    #[test]
    fn many_degrees_of_freedom() {
        for dof in [500.0, 5000.0, 50_000.0] {
            for z in [-2.0, 0.0, 2.0, 4.0_f64] {
                let spread: f64 = 2.0 / (9.0 * dof);
                let x = dof * (1.0 - spread + z * spread.sqrt()).powi(3);
                let expected = 0.5 * erfc(z * std::f64::consts::FRAC_1_SQRT_2);
                assert!(
                    (chi2_above(x, dof) / expected - 1.0).abs() < 0.02,
                    "{dof}, {z}: {}",
                    chi2_above(x, dof)
                );
            }
        }
    }
}
