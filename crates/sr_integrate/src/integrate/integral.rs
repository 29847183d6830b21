//! What is known of an integral.

use sr_sampling::Estimate;
use thiserror::Error;

/// An integral, or several of one integrand's outputs, with their covariance.
#[derive(Clone, Debug)]
pub struct Integral {
    /// The mean of each output.
    pub mean: Vec<f64>,
    /// The covariance of these means, m × m, row after row. NaN if nobody knows.
    pub covariance: Vec<f64>,
    /// Degrees of freedom of the covariance: what Student's t needs for an interval.
    pub dof: u64,
    /// The number of points, those included that count as 0.
    pub n: u64,
    /// How many of them f was infinite or not a number at, and which counted as 0.
    pub nans: u64,
    /// How many of them a density did not draw, and which counted as 0.
    pub not_drawn: u64,
    /// The largest share of a single point in Σ |f / p| of the first output; near 1, a single point decides.
    pub largest_share: f64,
    /// (Σ |f / p|)² / Σ (f / p)² of the first output: as many equal points would do as well (Kish 1965).
    pub effective_n: f64,
    /// How long it took.
    pub seconds: f64,
}

/// Why control variates cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ControlError {
    /// Integrals that are not finite.
    #[error("the known integral of control {index} is {value}; it must be finite")]
    Known {
        /// Position in the list.
        index: usize,
        /// The number given.
        value: f64,
    },
    /// More controls than can be fitted.
    #[error(
        "{controls} controls need more than {dof} degrees of freedom; use more replicates, or fewer controls"
    )]
    TooMany {
        /// How many controls there are.
        controls: usize,
        /// What there is to fit them with.
        dof: u64,
    },
}

impl Integral {
    /// The standard error of each output.
    pub fn stderr(&self) -> Vec<f64> {
        let m = self.mean.len();
        (0..m).map(|a| self.covariance[a * m + a].max(0.0).sqrt()).collect()
    }

    /// Output `a` alone.
    pub fn estimate(&self, a: usize) -> Estimate {
        Estimate { mean: self.mean[a], stderr: self.stderr()[a], n: self.n }
    }

    /// Does every output's error obey a tolerance?
    pub(crate) fn is_within(&self, rtol: f64, atol: f64) -> bool {
        self.stderr().iter().zip(&self.mean).all(|(stderr, mean)| *stderr <= atol.max(rtol * mean.abs()))
    }

    /// Takes the last outputs as control variates, whose integrals are known, and removes from the others what is
    /// correlated with them: mean_f − β (mean_g − known), β = Σ_fg Σ_gg⁻¹ from the measured covariance.
    ///
    /// β is fitted to the same points, which costs a degree of freedom for each control, and a bias of the order of
    /// 1 / dof of what the controls correct (S. Lavenberg & P. Welch 1981; for replicates of low-discrepancy points,
    /// F. Hickernell, C. Lemieux & A. Owen 2005, which is why the covariance must be that of the replicates).
    ///
    /// # Errors
    /// If a known integral is not finite, or there are more controls than the covariance can tell apart.
    pub fn with_controls(&self, known: &[f64]) -> Result<Self, ControlError> {
        if let Some(index) = known.iter().position(|value| !value.is_finite()) {
            return Err(ControlError::Known { index, value: known[index] });
        }
        let (k, m) = (known.len(), self.mean.len() - known.len());
        if self.dof <= k as u64 {
            return Err(ControlError::TooMany { controls: k, dof: self.dof });
        }
        let all = m + k;
        let between = |a: usize, b: usize| self.covariance[a * all + b];
        let controls: Vec<f64> = (0..k * k).map(|i| between(m + i / k, m + i % k)).collect();
        let beta: Vec<Vec<f64>> =
            (0..m).map(|a| solve(controls.clone(), (0..k).map(|c| between(a, m + c)).collect())).collect();
        let mean = (0..m)
            .map(|a| self.mean[a] - (0..k).map(|c| beta[a][c] * (self.mean[m + c] - known[c])).sum::<f64>())
            .collect();
        let dof = self.dof - k as u64;
        let scale = self.dof as f64 / dof as f64;
        let mut covariance = vec![0.0; m * m];
        for a in 0..m {
            for b in 0..m {
                let explained: f64 = (0..k).map(|c| beta[a][c] * between(b, m + c)).sum();
                covariance[a * m + b] = (between(a, b) - explained) * scale;
            }
        }
        Ok(Self { mean, covariance, dof, ..self.clone() })
    }
}

/// Solves a symmetric, positive semi-definite system by Cholesky's method; directions without variance get 0.
fn solve(mut matrix: Vec<f64>, mut right: Vec<f64>) -> Vec<f64> {
    let k = right.len();
    let largest = (0..k).map(|i| matrix[i * k + i]).fold(0.0, f64::max);
    let mut skipped = vec![false; k];
    for i in 0..k {
        for j in 0..=i {
            let sum: f64 =
                (0..j).filter(|&l| !skipped[l]).map(|l| matrix[i * k + l] * matrix[j * k + l]).sum();
            let rest = matrix[i * k + j] - sum;
            if i != j {
                matrix[i * k + j] = if skipped[j] { 0.0 } else { rest / matrix[j * k + j] };
            } else {
                skipped[i] = !(rest > 1e-12 * largest);
                matrix[i * k + i] = if skipped[i] { 0.0 } else { rest.sqrt() };
            }
        }
        let sum: f64 = (0..i).map(|l| matrix[i * k + l] * right[l]).sum();
        right[i] = if skipped[i] { 0.0 } else { (right[i] - sum) / matrix[i * k + i] };
    }
    for i in (0..k).rev() {
        let sum: f64 = (i + 1..k).map(|l| matrix[l * k + i] * right[l]).sum();
        right[i] = if skipped[i] { 0.0 } else { (right[i] - sum) / matrix[i * k + i] };
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_are_solved() {
        let x = solve(vec![4.0, 2.0, 2.0, 3.0], vec![8.0, 7.0]);
        assert!((x[0] - 1.25).abs() < 1e-12 && (x[1] - 1.5).abs() < 1e-12, "{x:?}");
        assert_eq!(solve(vec![4.0, 4.0, 4.0, 4.0], vec![8.0, 8.0]), [2.0, 0.0]);
        assert_eq!(solve(vec![0.0], vec![0.0]), [0.0]);
    }

    #[test]
    fn a_control_removes_what_it_explains() {
        let integral = Integral {
            mean: vec![2.0, 1.1],
            covariance: vec![0.05, 0.02, 0.02, 0.01],
            dof: 31,
            n: 100,
            nans: 0,
            not_drawn: 0,
            largest_share: 0.1,
            effective_n: 90.0,
            seconds: 0.0,
        };
        let controlled = integral.with_controls(&[1.0]).unwrap();
        assert!((controlled.mean[0] - 1.8).abs() < 1e-12);
        assert!((controlled.covariance[0] - 0.01 * 31.0 / 30.0).abs() < 1e-12);
        assert_eq!(controlled.dof, 30);
        assert_eq!(
            integral.with_controls(&[f64::NAN]).unwrap_err().to_string(),
            "the known integral of control 0 is NaN; it must be finite"
        );
    }
}
