//! How to share a sample's contribution among the techniques that could have drawn it.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use crate::measure::Real;

/// A weight for one sample each of n techniques (Veach 1997, §9.2). For any point that some technique
/// can draw, the weights sum to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heuristic {
    /// pᵢ / Σ pⱼ. No other can be much better (Veach 1997, theorem 9.2).
    Balance,
    /// pᵢ² / Σ pⱼ². Sharper: better where one technique is nearly perfect.
    #[default]
    Power,
    /// Balance among the techniques within a factor α = 0.1 of the likeliest; 0 for the others.
    Cutoff,
    /// All to the likeliest technique.
    Maximum,
}

impl Heuristic {
    /// Every heuristic.
    pub const ALL: [Self; 4] = [Self::Balance, Self::Power, Self::Cutoff, Self::Maximum];

    /// Veach's α: a technique less likely than α times the likeliest counts for nothing in `Cutoff`.
    pub const CUTOFF_ALPHA: f64 = 0.1;

    /// The weight of a sample that was drawn with density `p_this`.
    ///
    /// - `all`: the densities of every technique at the sample, `p_this` among them
    /// - returns: in [0, 1]; 0 if `p_this` is 0. Techniques that tie share.
    #[inline]
    pub fn weight<R: Real>(self, p_this: R, all: &[R]) -> R {
        // `!(… > 0)`, so that NaN gets no weight either.
        let likeliest = all.iter().fold(R::ZERO, |most, &p| if p > most { p } else { most });
        if !(p_this > R::ZERO && likeliest > R::ZERO) {
            return R::ZERO;
        }
        // Relative to the likeliest: squares do not overflow, and an infinite density takes all.
        let relative = |p: R| if p == likeliest { R::ONE } else { p / likeliest };
        let share = |p: R| {
            let r = relative(p);
            match self {
                Self::Balance => r,
                Self::Power => r * r,
                Self::Cutoff if r < R::from_f64(Self::CUTOFF_ALPHA) => R::ZERO,
                Self::Cutoff => r,
                Self::Maximum if r == R::ONE => R::ONE,
                Self::Maximum => R::ZERO,
            }
        };
        share(p_this) / all.iter().map(|&p| share(p)).sum::<R>()
    }

    /// Its name, as in a strategy.
    pub fn name(self) -> &'static str {
        match self {
            Self::Balance => "balance",
            Self::Power => "power",
            Self::Cutoff => "cutoff",
            Self::Maximum => "maximum",
        }
    }
}

impl fmt::Display for Heuristic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// There is no heuristic of that name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no heuristic {name:?}; there are balance, power, cutoff and maximum")]
pub struct UnknownHeuristic {
    /// The name given.
    pub name: String,
}

impl FromStr for Heuristic {
    type Err = UnknownHeuristic;

    fn from_str(name: &str) -> Result<Self, UnknownHeuristic> {
        Self::ALL
            .into_iter()
            .find(|heuristic| heuristic.name() == name)
            .ok_or_else(|| UnknownHeuristic { name: name.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mis::{balance_weight, power_weight};

    #[test]
    fn weights_sum_to_one() {
        let densities = [
            vec![1.0],
            vec![0.3, 0.7],
            vec![0.0, 2.0, 5.0],
            vec![1e30, 1e-30, 3e29],
            vec![4.0, 4.0, 0.3],
            vec![f32::INFINITY, 1.0],
            vec![1e-38, 3e-39],
        ];
        for heuristic in Heuristic::ALL {
            for all in &densities {
                let sum: f32 = all.iter().map(|&p| heuristic.weight(p, all)).sum();
                assert!((sum - 1.0).abs() < 1e-6, "{heuristic} of {all:?} sums to {sum}");
            }
        }
    }

    #[test]
    fn known_weights() {
        let all = [6.0, 3.0, 0.5];
        let weights = |h: Heuristic| all.map(|p| h.weight(p, &all));
        let close = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(close(weights(Heuristic::Balance), [6.0 / 9.5, 3.0 / 9.5, 0.5 / 9.5]));
        assert!(close(weights(Heuristic::Power), [36.0 / 45.25, 9.0 / 45.25, 0.25 / 45.25]));
        assert!(close(weights(Heuristic::Cutoff), [6.0 / 9.0, 3.0 / 9.0, 0.0]));
        assert!(close(weights(Heuristic::Maximum), [1.0, 0.0, 0.0]));
    }

    #[test]
    fn two_techniques_agree_with_the_short_forms() {
        for (p, q) in [(1.0, 2.0), (0.0, 1.0), (3.0, 0.0), (1e25, 1e24)] {
            assert!((Heuristic::Balance.weight(p, &[p, q]) - balance_weight(p, q)).abs() < 1e-6);
            assert!((Heuristic::Power.weight(p, &[p, q]) - power_weight(p, q)).abs() < 1e-6);
        }
    }

    #[test]
    fn no_density_no_weight() {
        for heuristic in Heuristic::ALL {
            assert_eq!(heuristic.weight(0.0, &[0.0, 0.0]), 0.0);
            assert_eq!(heuristic.weight(f32::NAN, &[f32::NAN, 1.0]), 0.0);
        }
    }

    #[test]
    fn names_round_trip() {
        for heuristic in Heuristic::ALL {
            assert_eq!(heuristic.to_string().parse(), Ok(heuristic));
        }
        assert!("best".parse::<Heuristic>().is_err());
    }
}
