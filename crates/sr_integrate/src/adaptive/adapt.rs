//! Learn a density, then integrate with it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use sr_sampling::sequence::mix::derive_key;
use statrs::function::beta::beta_reg;

use super::learn::{Learning, learn};
use super::learned::Learned;
use super::level::Level;
use super::round::{REPLICATES, Round};
use super::units::{InUnit, Unit};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError};
use crate::integrate::{
    Control, Integral, Integrand, IntegrateError, OnRound, Plan, Progress, Single, Technique, integrate,
};
use crate::space::Space;

/// An integral, the density that was learned for it, and whether what was seen on the way agrees.
#[derive(Clone, Debug)]
pub struct Adapted {
    /// From points that nothing was learned from, with a density that was fixed before.
    pub integral: Integral,
    /// What was learned.
    pub density: Arc<Learned>,
    /// What each round of learning estimated.
    pub rounds: Vec<Round>,
    /// Squared differences of the integral, and of rounds that saw enough, to their common mean, over their variances.
    pub chi2: f64,
    /// Its degrees of freedom: rounds that saw enough, times outputs.
    pub dof: u64,
    /// The probability of such differences if all estimate the same; 1 if there is nothing to compare.
    pub q: f64,
}

impl Adapted {
    /// Below this, [`Adapted::q`] asks for a warning: the rounds disagree, and no error can be trusted.
    pub const DISAGREEMENT: f64 = 1e-4;

    /// Do the rounds disagree?
    pub fn disagrees(&self) -> bool {
        self.q < Self::DISAGREEMENT
    }

    /// All evaluations, those included that the density was learned from.
    pub fn n(&self) -> u64 {
        self.integral.n + self.rounds.iter().map(|round| round.n).sum::<u64>()
    }
}

/// A round has seen enough if so many equal points would do as well …
const ENOUGH: f64 = 200.0;
/// … which are this share of its points: means of few large values are not normal, and would be thought to disagree.
const ENOUGH_SHARE: f64 = 0.2;

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
        until: plan.seconds.map(|seconds| began + Duration::from_secs_f64((0.25 * seconds).min(1e9))),
    };
    let unit = Unit::default();
    let mut integrand = InUnit::new(integrand, &unit);
    let mut integrand = integrand.integrand();
    let out = |numbers: &[f64]| -> Vec<f64> { numbers.iter().map(|x| unit.get().out(*x)).collect() };
    let mut spent = 0;
    let mut tell = |round: &Round| {
        spent += round.n;
        let seconds = began.elapsed().as_secs_f64();
        let (mean, stderr) = (out(&round.mean), out(&round.stderr));
        on_round(&Progress { n: spent, n_max: plan.n, seconds, mean, stderr })
            .map_err(IntegrateError::Foreign)
    };
    let mut lesson = learn(base, &mut integrand, &learning, pool, &mut tell)?;
    let density = Arc::new(Learned::new(base.clone(), lesson.cube));
    let rest = Plan {
        n: plan.n.map(|n| n.saturating_sub(spent).max(2)),
        seconds: plan.seconds.map(|seconds| (seconds - began.elapsed().as_secs_f64()).max(1e-9)),
        atol: unit.get().of(plan.atol).min(f64::MAX),
        seed: derive_key(plan.seed, 0xf17a1),
        ..plan.clone()
    };
    let mut tell = |progress: &Progress| {
        on_round(&Progress {
            n: progress.n + spent,
            n_max: plan.n,
            seconds: began.elapsed().as_secs_f64(),
            mean: out(&progress.mean),
            stderr: out(&progress.stderr),
        })
    };
    let technique = Leveled { single: Single(density.clone()), level: lesson.level };
    let mut integral = integrate(&[(&technique, 1)], &mut integrand, &rest, pool, &mut tell)?;
    integral.seconds = began.elapsed().as_secs_f64();
    let Agreement { chi2, dof, q } = agreement(&lesson.rounds, &integral);
    let integral = integral.scaled(|x| unit.get().out(x));
    for round in &mut lesson.rounds {
        (round.mean, round.stderr) = (out(&round.mean), out(&round.stderr));
    }
    Ok(Adapted { integral, density, rounds: lesson.rounds, chi2, dof, q })
}

/// A learned density, and what is taken off the terms of its points.
struct Leveled {
    single: Single,
    level: Option<Level>,
}

impl Technique for Leveled {
    fn space(&self) -> Space {
        self.single.space()
    }

    fn uniforms(&self) -> usize {
        self.single.uniforms()
    }

    fn draw(&self, u: Columns<'_>, x: ColumnsMut<'_>, factor: &mut [f64]) -> Result<(), DensityError> {
        self.single.draw(u, x, factor)
    }

    fn control(&self) -> Option<&dyn Control> {
        self.level.as_ref().map(|level| level as &dyn Control)
    }
}

/// Do estimates of the same agree?
#[derive(Clone, Copy, Debug, PartialEq)]
struct Agreement {
    chi2: f64,
    dof: u64,
    q: f64,
}

fn agreement(rounds: &[Round], integral: &Integral) -> Agreement {
    let saw_enough = |round: &&Round| round.effective_n >= ENOUGH.max(ENOUGH_SHARE * round.n as f64);
    let rounds: Vec<&Round> = rounds.iter().filter(saw_enough).collect();
    let outputs = integral.mean.len();
    let mut all = Agreement { chi2: 0.0, dof: 0, q: 1.0 };
    for (a, stderr) in integral.stderr.iter().copied().enumerate() {
        let mut estimates = vec![(integral.mean[a], stderr, integral.dof as f64)];
        estimates
            .extend(rounds.iter().map(|round| (round.mean[a], round.stderr[a], f64::from(REPLICATES - 1))));
        estimates.retain(|(mean, stderr, _)| mean.is_finite() && *stderr > 0.0 && stderr.is_finite());
        let one = welch(&estimates);
        all.chi2 += one.chi2;
        all.dof += one.dof;
        all.q = all.q.min(one.q * outputs as f64);
    }
    all
}

/// Are (mean, standard error, its degrees of freedom) of the same? The errors are uncertain themselves, which chi-square
/// would take for disagreement (B. L. Welch, "On the comparison of several mean values", Biometrika 38, 1951).
fn welch(estimates: &[(f64, f64, f64)]) -> Agreement {
    let k = estimates.len() as f64;
    if estimates.len() < 2 {
        return Agreement { chi2: 0.0, dof: 0, q: 1.0 };
    }
    let weight = |stderr: f64| stderr.powi(-2);
    let total: f64 = estimates.iter().map(|&(_, stderr, _)| weight(stderr)).sum();
    let mean = estimates.iter().map(|&(mean, stderr, _)| weight(stderr) / total * mean).sum::<f64>();
    let chi2: f64 = estimates.iter().map(|&(m, stderr, _)| weight(stderr) * (m - mean).powi(2)).sum();
    let doubt: f64 =
        estimates.iter().map(|&(_, stderr, dof)| (1.0 - weight(stderr) / total).powi(2) / dof.max(1.0)).sum();
    let f = chi2 / (k - 1.0) / (1.0 + 2.0 * (k - 2.0) / (k * k - 1.0) * doubt);
    let dof = (k * k - 1.0) / (3.0 * doubt);
    // P(F > f), by the incomplete beta function.
    let q =
        if f.is_finite() { beta_reg(0.5 * dof, 0.5 * (k - 1.0), dof / (dof + (k - 1.0) * f)) } else { 0.0 };
    Agreement { chi2, dof: estimates.len() as u64 - 1, q }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two means: F is the square of Welch's t, here with as many degrees of freedom as Welch & Satterthwaite's.
    #[test]
    fn two_means_are_a_t_test() {
        let agreement = welch(&[(1.0, 0.3, 10.0), (2.0, 0.4, 20.0)]);
        assert!((agreement.chi2 - 4.0).abs() < 1e-12);
        let dof = 0.25_f64.powi(2) / (0.3_f64.powi(4) / 10.0 + 0.4_f64.powi(4) / 20.0);
        let expected = beta_reg(0.5 * dof, 0.5, dof / (dof + 4.0));
        assert!((agreement.q - expected).abs() < 1e-9, "{} {expected}", agreement.q);
    }

    #[test]
    fn what_differs_disagrees() {
        let same = [(1.0, 0.1, 15.0), (1.05, 0.1, 15.0), (0.95, 0.2, 15.0)];
        assert!(welch(&same).q > 0.5);
        let mut other = same.to_vec();
        other.push((2.0, 0.05, 31.0));
        assert!(welch(&other).q < 1e-6);
        assert_eq!(welch(&same[..1]).q, 1.0);
        // Few degrees of freedom: chi-square would say 10⁻⁴.
        assert!(welch(&[(0.0, 1.0, 2.0), (5.5, 1.0, 2.0)]).q > 0.01);
    }
}
