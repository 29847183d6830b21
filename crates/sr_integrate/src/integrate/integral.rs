//! What is known of an integral.

use sr_sampling::Estimate;
use thiserror::Error;

use super::tail::Tail;

/// An integral, or several of one integrand's outputs, with their covariance.
#[derive(Clone, Debug)]
pub struct Integral {
    /// The mean of each output.
    pub mean: Vec<f64>,
    /// The standard error of each; NaN if nobody knows.
    pub stderr: Vec<f64>,
    /// The covariance of these means, m × m, row after row. NaN if nobody knows; 0 or infinite where squares are.
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
    /// What the largest |f / p| of the first output say of how rare and large they are.
    pub tail: Tail,
    /// Did [`Plan::CAP`](super::Plan::CAP) end it, before tolerances were met?
    pub ended_by_cap: bool,
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

/// So many standard errors off, a known integral is none: by chance, with 31 degrees of freedom, once in 10⁹ times.
const ALARM: f64 = 8.5;

impl Integral {
    /// The correlation of two outputs; 0 with one that does not vary.
    fn correlation(&self, a: usize, b: usize) -> f64 {
        let (m, varies) = (self.mean.len(), self.stderr[a] > 0.0 && self.stderr[b] > 0.0);
        match varies {
            true if a == b => 1.0,
            true => self.covariance[a * m + b] / self.stderr[a] / self.stderr[b],
            false => 0.0,
        }
    }

    /// Output `a` alone.
    pub fn estimate(&self, a: usize) -> Estimate {
        Estimate { mean: self.mean[a], stderr: self.stderr[a], n: self.n }
    }

    /// Does every output's error obey a tolerance? A relative one says nothing of a mean of 0.
    pub(crate) fn is_within(&self, rtol: f64, atol: f64) -> bool {
        let mut outputs = self.stderr.iter().zip(&self.mean);
        outputs.all(|(stderr, mean)| *stderr <= atol.max(rtol * mean.abs()) && (*mean != 0.0 || atol > 0.0))
    }

    /// In other units: all outputs multiplied by a positive factor.
    pub(crate) fn scaled(mut self, by: impl Fn(f64) -> f64) -> Self {
        self.mean.iter_mut().chain(&mut self.stderr).for_each(|x| *x = by(*x));
        self.covariance.iter_mut().for_each(|x| *x = by(by(*x)));
        self
    }

    /// A control whose points contradict the integral that is said to be known, with what they say instead: the last
    /// outputs are the controls.
    pub fn contradicted(&self, known: &[f64]) -> Option<(usize, Estimate)> {
        let m = self.mean.len() - known.len();
        known.iter().enumerate().find_map(|(index, value)| {
            let found = self.estimate(m + index);
            let rounding = 1e-12 * value.abs().max(found.mean.abs());
            let beyond = (found.mean - value).abs() > ALARM * found.stderr + rounding;
            beyond.then_some((index, found))
        })
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
        // In units in which squares are numbers; what does not vary has no error to correct.
        let unit: Vec<f64> = self.stderr.iter().map(|s| if *s > 0.0 { *s } else { 1.0 }).collect();
        let known: Vec<f64> = known.iter().zip(&unit[m..]).map(|(value, unit)| value / unit).collect();
        let scaled: Vec<f64> = self.mean.iter().zip(&unit).map(|(mean, unit)| mean / unit).collect();
        let between = |a: usize, b: usize| self.correlation(a, b);
        let controls: Vec<f64> = (0..k * k).map(|i| between(m + i / k, m + i % k)).collect();
        let beta: Vec<Vec<f64>> =
            (0..m).map(|a| solve(controls.clone(), (0..k).map(|c| between(a, m + c)).collect())).collect();
        let mean = (0..m)
            .map(|a| {
                let beyond: f64 = (0..k).map(|c| beta[a][c] * (scaled[m + c] - known[c])).sum();
                self.mean[a] - beyond * unit[a]
            })
            .collect();
        let dof = self.dof - k as u64;
        let scale = self.dof as f64 / dof as f64;
        let mut covariance = vec![0.0; m * m];
        let mut stderr = vec![0.0; m];
        for a in 0..m {
            for b in 0..m {
                let explained: f64 = (0..k).map(|c| beta[a][c] * between(b, m + c)).sum();
                let rest = (between(a, b) - explained) * scale;
                covariance[a * m + b] = rest * unit[a] * unit[b];
                if a == b {
                    stderr[a] = rest.max(0.0).sqrt() * unit[a];
                }
            }
        }
        Ok(Self { mean, stderr, covariance, dof, ..self.clone() })
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
    use super::super::tail::Maxima;
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
            stderr: vec![0.05_f64.sqrt(), 0.1],
            covariance: vec![0.05, 0.02, 0.02, 0.01],
            dof: 31,
            n: 100,
            nans: 0,
            not_drawn: 0,
            largest_share: 0.1,
            effective_n: 90.0,
            tail: Tail::new(&Maxima::default(), 1.0, 90.0, 100),
            ended_by_cap: false,
            seconds: 0.0,
        };
        let controlled = integral.with_controls(&[1.0]).unwrap();
        assert!((controlled.mean[0] - 1.8).abs() < 1e-12);
        assert!((controlled.covariance[0] - 0.01 * 31.0 / 30.0).abs() < 1e-12);
        assert_eq!(controlled.dof, 30);
        assert!((controlled.stderr[0].powi(2) - controlled.covariance[0]).abs() < 1e-12);
        assert_eq!(integral.contradicted(&[1.0]), None);
        assert_eq!(integral.contradicted(&[2.0]).unwrap().1.mean, 1.1);
        assert_eq!(
            integral.with_controls(&[f64::NAN]).unwrap_err().to_string(),
            "the known integral of control 0 is NaN; it must be finite"
        );
    }
}
