//! Learn a density, then integrate with it.

use std::sync::Arc;
use std::time::Instant;

use rayon::ThreadPool;
use sr_sampling::sequence::mix::derive_key;
use statrs::distribution::{ContinuousCDF, StudentsT};
use statrs::function::gamma::gamma_ur;

use super::learn::{Learning, learn};
use super::learned::Learned;
use super::round::{REPLICATES, Round};
use crate::density::Density;
use crate::integrate::{Integral, Integrand, IntegrateError, OnRound, Plan, Progress, Single, integrate};

/// An integral, the density that was learned for it, and whether what was seen on the way agrees.
#[derive(Clone, Debug)]
pub struct Adapted {
    /// From points that nothing was learned from, with a density that was fixed before.
    pub integral: Integral,
    /// What was learned.
    pub density: Arc<Learned>,
    /// What each round of learning estimated.
    pub rounds: Vec<Round>,
    /// The sum of squared differences between the integral and rounds that saw enough, over their variances.
    pub chi2: f64,
    /// Its degrees of freedom: rounds that saw enough, times outputs.
    pub dof: u64,
    /// The probability of a larger `chi2` if all estimate the same; 1 if there is nothing to compare.
    pub q: f64,
}

impl Adapted {
    /// Below this, [`Adapted::q`] asks for a warning: the rounds disagree, and no error can be trusted.
    pub const DISAGREEMENT: f64 = 1e-3;

    /// Do the rounds disagree?
    pub fn disagrees(&self) -> bool {
        self.q < Self::DISAGREEMENT
    }

    /// All evaluations, those included that the density was learned from.
    pub fn n(&self) -> u64 {
        self.integral.n + self.rounds.iter().map(|round| round.n).sum::<u64>()
    }
}

/// A round has seen enough if so many equal points would do as well.
const ENOUGH: f64 = 200.0;

/// Learns a density over `base` and integrates with it. `plan.n` and `plan.seconds` limit both together; a quarter of
/// either is for learning at most.
///
/// # Errors
/// As [`integrate`].
pub fn adapt(
    base: &Arc<dyn Density>,
    integrand: &mut Integrand<'_>,
    plan: &Plan,
    pool: Option<&ThreadPool>,
    on_round: &mut OnRound<'_>,
) -> Result<Adapted, IntegrateError> {
    plan.check()?;
    let began = Instant::now();
    let learning = Learning {
        seed: derive_key(plan.seed, 0xada9),
        evaluations: plan.n.map_or(1 << 24, |n| n / 4),
        rtol: plan.rtol,
    };
    let mut spent = 0;
    let mut tell = |round: &Round| {
        spent += round.n;
        let seconds = began.elapsed().as_secs_f64();
        let (mean, stderr) = (round.mean.clone(), round.stderr.clone());
        on_round(&Progress { n: spent, n_max: plan.n, seconds, mean, stderr })
            .map_err(IntegrateError::Foreign)
    };
    let lesson = learn(base, integrand, &learning, pool, &mut tell)?;
    let density = Arc::new(Learned::new(base.clone(), lesson.cube));
    let rest = Plan {
        n: plan.n.map(|n| n.saturating_sub(spent).max(2)),
        seconds: plan.seconds.map(|seconds| (seconds - began.elapsed().as_secs_f64()).max(1e-9)),
        seed: derive_key(plan.seed, 0xf17a1),
        ..plan.clone()
    };
    let mut tell = |progress: &Progress| {
        on_round(&Progress {
            n: progress.n + spent,
            n_max: plan.n,
            seconds: began.elapsed().as_secs_f64(),
            ..progress.clone()
        })
    };
    let single = Single(density.clone());
    let mut integral = integrate(&[(&single, 1)], integrand, &rest, pool, &mut tell)?;
    integral.seconds = began.elapsed().as_secs_f64();
    let (chi2, dof) = chi2(&lesson.rounds, &integral);
    let q = if dof > 0 { gamma_ur(0.5 * dof as f64, (0.5 * chi2).max(f64::MIN_POSITIVE)) } else { 1.0 };
    Ok(Adapted { integral, density, rounds: lesson.rounds, chi2, dof, q })
}

/// Each round's difference to the integral, as the number of standard deviations of a normal variable that is as
/// unlikely as Student's t of it: errors from few replicates are themselves uncertain.
fn chi2(rounds: &[Round], integral: &Integral) -> (f64, u64) {
    let errors = integral.stderr();
    let (mut sum, mut dof) = (0.0, 0);
    for round in rounds.iter().filter(|round| round.effective_n >= ENOUGH) {
        for (a, error) in errors.iter().enumerate() {
            let variance = round.stderr[a].powi(2) + error * error;
            if !(variance > 0.0 && variance.is_finite()) {
                continue;
            }
            let t = (round.mean[a] - integral.mean[a]) / variance.sqrt();
            // Welch & Satterthwaite.
            let own = round.stderr[a].powi(4) / f64::from(REPLICATES - 1);
            let theirs = error.powi(4) / (integral.dof.max(1) as f64);
            sum += as_normal(t, variance * variance / (own + theirs)).powi(2);
            dof += 1;
        }
    }
    (sum, dof)
}

/// The normal deviation that is as unlikely as `t` with `dof` degrees of freedom.
fn as_normal(t: f64, dof: f64) -> f64 {
    let below = StudentsT::new(0.0, 1.0, dof).map_or(0.0, |student| student.cdf(-t.abs()));
    if below > 0.0 { std::f64::consts::SQRT_2 * statrs::function::erf::erfc_inv(2.0 * below) } else { 40.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_are_translated() {
        assert!((as_normal(2.0, 1e9) - 2.0).abs() < 1e-6);
        assert!((as_normal(2.131_449_5, 15.0) - 1.959_964).abs() < 1e-4);
        assert_eq!(as_normal(f64::INFINITY, 15.0), 40.0);
    }
}
