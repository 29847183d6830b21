//! Are a few points as large as all others together? Then the error is a guess.
//!
//! The standard error of a mean rests on the variance, and if that is infinite, or finite but made by points too rare to
//! have been met, intervals are too short. What tells is the tail of |f / p|: if P(|f / p| > t) falls as t^(−1/ξ), the
//! variance is infinite from ξ = ½ on, and its own variance from ξ = ¼ on.

/// An index above this is warned of, if the largest square is also more than this share of all: see [`Tail::is_heavy`].
const HEAVY: [f64; 2] = [0.35, 1.0 / 12.0];
/// The same for fewer than [`MANY`] points, among which a peak looks like a tail …
const HEAVY_OF_FEW: [f64; 2] = [0.4, 0.25];
const MANY: u64 = 1 << 12;
/// … and where there are too few groups for an index.
const HEAVY_SHARE: f64 = 1.0 / 3.0;
/// From so many groups an index is known.
const ENOUGH: usize = 16;
/// Below so many points all is guesswork, and their intervals are wide.
const FEW: u64 = 128;

/// The largest |f / p| of each of several groups of points.
#[derive(Clone, Debug, Default)]
pub struct Maxima {
    groups: Vec<f64>,
    parts: usize,
}

impl Maxima {
    /// Independent points have no replicates: so many after one another are a group.
    pub const PART: usize = 128;
    /// At most so many groups of them; later ones join the first.
    const GROUPS: usize = 64;

    /// The maximum of some points of a replicate.
    pub fn add_replicate(&mut self, replicate: usize, largest: f64) {
        if self.groups.len() <= replicate {
            self.groups.resize(replicate + 1, 0.0);
        }
        self.groups[replicate] = self.groups[replicate].max(largest);
    }

    /// The maximum of the next part of independent points.
    pub fn add_part(&mut self, largest: f64) {
        self.add_replicate(self.parts % Self::GROUPS, largest);
        self.parts += 1;
    }

    /// In another unit.
    pub fn scale(&mut self, factor: f64) {
        self.groups.iter_mut().for_each(|largest| *largest *= factor);
    }

    /// The index ξ of the tail, if there are enough groups: the mean of ln(m / median) over the maxima m above their
    /// median (B. M. Hill, "A simple general approach to inference about the tail of a distribution", Ann. Stat. 3, 1975).
    /// Maxima of independent points make it some 15 % too large.
    pub fn index(&self) -> Option<f64> {
        let mut sorted = self.groups.clone();
        sorted.sort_by(f64::total_cmp);
        let (below, above) = sorted.split_at(sorted.len() / 2);
        let median = *below.last()?;
        let sum: f64 = above.iter().map(|largest| (largest / median).ln()).sum();
        match sorted.len() {
            ..ENOUGH => None,
            _ if median == 0.0 => Some(f64::INFINITY), // all there is, is rare
            _ => Some(sum / above.len() as f64),
        }
    }
}

/// What the sizes of the points say of the tail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tail {
    /// ξ by the maxima of replicates or parts; `None` if these are too few.
    pub index: Option<f64>,
    /// The share of the largest square in the sum of all: what the variance owes to a single point.
    pub share: f64,
    n: u64,
}

impl Tail {
    /// - `largest`, `squares`: the largest |x| and Σ x² of `n` numbers
    pub fn new(maxima: &Maxima, largest: f64, squares: f64, n: u64) -> Self {
        let share = if squares > 0.0 { largest * largest / squares } else { 0.0 };
        Self { index: maxima.index(), share, n }
    }

    /// Can an interval not be trusted? The bounds are from experiments, see `docs/intervals.md`: an infinite variance is
    /// noticed nearly always, one at the edge of it, x^−0.5, mostly; what is bounded and met by a dozen points or more,
    /// less than once in 300 times.
    pub fn is_heavy(&self) -> bool {
        let bounds = if self.n < MANY { HEAVY_OF_FEW } else { HEAVY };
        self.n >= FEW
            && match self.index {
                Some(index) => index > bounds[0] && self.share > bounds[1],
                None => self.share > HEAVY_SHARE,
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Maxima of 64 groups of 1,000 numbers u^−ξ, at even quantiles.
    fn maxima(xi: f64) -> Maxima {
        let mut maxima = Maxima::default();
        for group in 0..64 {
            let least = 1.0 - (f64::from(group) + 0.5).mul_add(-1.0 / 64.0, 1.0).powf(1e-3);
            maxima.add_replicate(group as usize, least.powf(-xi));
        }
        maxima
    }

    #[test]
    fn the_index_of_powers() {
        for xi in [0.1, 0.5, 1.0] {
            let found = maxima(xi).index().unwrap();
            assert!(found > xi && found < 1.25 * xi, "{found}, not {xi}");
        }
        let mut scaled = maxima(0.5);
        scaled.scale(1e-100);
        assert!((scaled.index().unwrap() - maxima(0.5).index().unwrap()).abs() < 1e-9);
        assert_eq!(Maxima::default().index(), None);
    }

    #[test]
    fn a_point_that_outweighs_others_is_heavy() {
        assert!(Tail::new(&maxima(0.5), 100.0, 20_000.0, 10_000).is_heavy());
        assert!(!Tail::new(&maxima(0.1), 100.0, 20_000.0, 10_000).is_heavy());
        assert!(!Tail::new(&maxima(0.5), 1.0, 10_000.0, 10_000).is_heavy());
        assert!(!Tail::new(&maxima(0.5), 0.0, 0.0, 10_000).is_heavy());
        assert!(!Tail::new(&maxima(0.5), 100.0, 20_000.0, 100).is_heavy());
    }
}
