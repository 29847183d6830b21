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
    let at = to_step(u);
    picked(cumulative, at, cumulative.partition_point(|&c| c <= at as u32) - 1)
}

/// A uniform in steps.
#[inline(always)]
fn to_step(u: f32) -> f64 {
    f64::from(u) * f64::from(TOTAL)
}

#[inline(always)]
fn picked(cumulative: &[u32], at: f64, index: usize) -> Picked {
    let (low, high) = (cumulative[index], cumulative[index + 1]);
    let share = f64::from(high - low);
    Picked { index, pmf: share * STEP, rest: (at - f64::from(low)) / share }
}

/// How many entries [`pick_from`] compares at a time.
const WINDOW: usize = 8;

/// What must follow a table that [`pick_from`] is to search: more than any uniform.
pub const PADDING: [u32; WINDOW - 1] = [u32::MAX; WINDOW - 1];

/// The logarithm of the number of cuts that guide a table of `len` entries: about one for every four.
pub fn guide_bits(len: usize) -> u32 {
    len.div_ceil(4).next_power_of_two().trailing_zeros()
}

/// Fills `guide`, 2ᵇ long, with the entries that the uniforms k / 2ᵇ pick, so that [`pick_guided`] need not search
/// the whole table (the cutpoint method, Chen & Asau 1974). The table has at most 2¹⁶ entries.
pub fn fill_guide(cumulative: &[u32], guide: &mut [u16]) {
    let last = cumulative.len() - 2;
    debug_assert!(last <= usize::from(u16::MAX) && guide.len().is_power_of_two());
    let width = TOTAL / guide.len() as u32;
    let mut index = 0;
    for (k, out) in guide.iter_mut().enumerate() {
        while index < last && cumulative[index + 1] <= k as u32 * width {
            index += 1;
        }
        *out = index as u16;
    }
}

/// Which of the 2ᵇ cuts of a guide is for `u`.
#[inline(always)]
pub fn cut(bits: u32, u: f32) -> usize {
    (to_step(u) as u32 >> (TOTAL.trailing_zeros() - bits)) as usize
}

/// [`pick`], with the table's guide of 2ᵇ cuts, in a padded table: two entries on average, whatever the weights.
#[inline(always)]
pub fn pick_guided(cumulative: &[u32], guide: &[u16], bits: u32, u: f32) -> Picked {
    pick_from(cumulative, usize::from(guide[cut(bits, u)]), u)
}

/// [`pick`], from an entry on that is not beyond it, in a table with its [`PADDING`].
#[inline(always)]
pub fn pick_from(cumulative: &[u32], first: usize, u: f32) -> Picked {
    let (at, mut index) = (to_step(u), first);
    let step = at as u32;
    // How far it is differs from draw to draw, so that a branch at each entry would be guessed wrongly.
    loop {
        let window = &cumulative[index + 1..index + 1 + WINDOW];
        let passed = window.iter().map(|&c| u32::from(c <= step)).sum::<u32>() as usize;
        index += passed;
        if passed < WINDOW {
            return picked(cumulative, at, index);
        }
    }
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
    fn a_guide_changes_nothing() {
        for len in [1, 2, 3, 4, 5, 64, 1000] {
            let weight = |i: usize| match i % 5 {
                0 => 0.0,
                1 => 1e-9,
                _ => ((i * 7919) % 97) as f64,
            };
            let weights: Vec<f64> = (0..len).map(|i| if len == 1 { 1.0 } else { weight(i) }).collect();
            let table = cumulative(&weights);
            let mut guide = vec![0; 1 << guide_bits(len)];
            fill_guide(&table, &mut guide);
            let searched = [&table[..], &PADDING].concat();
            for u in (0..4096).map(|i| i as f32 / 4096.0).chain([1.0 - f32::EPSILON / 2.0]) {
                assert_eq!(
                    pick_guided(&searched, &guide, guide_bits(len), u),
                    pick(&table, u),
                    "{len} entries, {u}"
                );
            }
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
