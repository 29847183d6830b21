//! Cumulative probabilities in fixed point.
//!
//! A table of n weights becomes n + 1 integers, from 0 to [`TOTAL`]; the probability of an entry is
//! the difference of its two neighbours, exactly, and they sum to 1, exactly. An entry of weight 0
//! has probability 0; an entry of positive weight, however small, has positive probability: a
//! floating-point running sum would swallow it and leave a hole in the support.

use super::TableError;

/// Probability 1.
pub const TOTAL: u32 = 1 << 31;

/// The value of one step.
pub const STEP: f64 = 1.0 / TOTAL as f64;

/// The most entries a table can have: each may need a step, and rounding should stay small.
pub const MAX_LEN: usize = 1 << 26;

/// Which entry a uniform selects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// The entry.
    pub index: usize,
    /// Its probability, positive.
    pub pmf: f64,
    /// Where in the entry's share the uniform lies, in [0, 1): a uniform again.
    pub rest: f64,
}

/// Fills `out` (one longer than `weights`) with cumulative probabilities.
///
/// `sum` is that of the weights, positive, or 0 to make all probabilities 0.
pub fn fill(weights: impl ExactSizeIterator<Item = f64> + Clone, sum: f64, out: &mut [u32]) {
    debug_assert_eq!(weights.len() + 1, out.len());
    debug_assert!(weights.len() <= MAX_LEN);
    out[0] = 0;
    if sum == 0.0 {
        out.fill(0);
        return;
    }
    // One step for every positive entry, the rest in proportion.
    let reserved = weights.clone().filter(|&w| w > 0.0).count() as u32;
    let shared = f64::from(TOTAL - reserved);
    let (mut running, mut positive, mut last_positive) = (0.0, 0, 0);
    for (i, weight) in weights.enumerate() {
        if weight > 0.0 {
            running += weight;
            positive += 1;
            last_positive = i + 1;
        }
        out[i + 1] = ((running / sum).min(1.0) * shared) as u32 + positive;
    }
    // What rounding leaves goes to the last positive entry.
    out[last_positive..].fill(TOTAL);
}

/// Checks the length of a table.
pub fn check_len(len: usize) -> Result<(), TableError> {
    if len > MAX_LEN { Err(TableError::TooLarge { len, limit: MAX_LEN }) } else { Ok(()) }
}

/// The entry whose share of [0, 1) holds `u`. The table must not be all zero.
#[inline]
pub fn pick(cumulative: &[u32], u: f32) -> Picked {
    let at = f64::from(u) * f64::from(TOTAL);
    let step = at as u32;
    let index = cumulative.partition_point(|&c| c <= step) - 1;
    let (low, high) = (cumulative[index], cumulative[index + 1]);
    let share = f64::from(high - low);
    Picked { index, pmf: share * STEP, rest: (at - f64::from(low)) / share }
}

/// The probability of an entry.
#[inline]
pub fn pmf(cumulative: &[u32], index: usize) -> f64 {
    f64::from(cumulative[index + 1] - cumulative[index]) * STEP
}

/// The uniform that picks entry `index` and leaves `rest`.
pub fn unpick(cumulative: &[u32], index: usize, rest: f64) -> f64 {
    (f64::from(cumulative[index]) + rest * f64::from(cumulative[index + 1] - cumulative[index])) * STEP
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cumulative(weights: &[f64]) -> Vec<u32> {
        let mut out = vec![0; weights.len() + 1];
        fill(weights.iter().copied(), weights.iter().sum(), &mut out);
        out
    }

    #[test]
    fn zero_stays_zero_and_positive_stays_positive() {
        let weights = [0.0, 1.0, 1e-30, 0.0, 1e6, 1e-12, 0.0, 0.0];
        let table = cumulative(&weights);
        let pmfs: Vec<f64> = (0..weights.len()).map(|i| pmf(&table, i)).collect();
        for (p, w) in pmfs.iter().zip(weights) {
            assert_eq!(*p > 0.0, w > 0.0, "{pmfs:?}");
        }
        assert_eq!(pmfs.iter().sum::<f64>(), 1.0);
    }

    #[test]
    fn probabilities_are_proportional() {
        let table = cumulative(&[1.0, 3.0, 0.0, 4.0]);
        for (i, expected) in [0.125, 0.375, 0.0, 0.5].into_iter().enumerate() {
            assert!((pmf(&table, i) - expected).abs() < 1e-8);
        }
    }

    #[test]
    fn pick_never_selects_what_has_no_weight() {
        let weights = [0.0, 2.0, 0.0, 1.0, 0.0];
        let table = cumulative(&weights);
        for u in [0.0, 0.3, 0.666, 0.667, 1.0 - f32::EPSILON / 2.0] {
            let picked = pick(&table, u);
            assert!(weights[picked.index] > 0.0, "{u} picks {picked:?}");
            assert!((0.0..1.0).contains(&picked.rest));
            assert!((unpick(&table, picked.index, picked.rest) - f64::from(u)).abs() < 1e-12);
        }
    }
}
