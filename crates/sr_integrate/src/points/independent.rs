//! Unrelated numbers: a counter, hashed.

use sr_sampling::sequence::mix::mix64;

use super::unit::to_unit;

/// 2⁶⁴ divided by the golden ratio, made odd.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// SplitMix64 (Steele, Lea & Flood 2014), from any place in its stream.
#[inline(always)]
pub fn fill(key: u64, first: u64, u: &mut [f64]) {
    let start = key.wrapping_add(first.wrapping_mul(GOLDEN));
    for (i, u) in u.iter_mut().enumerate() {
        *u = to_unit(mix64(start.wrapping_add((i as u64).wrapping_mul(GOLDEN))));
    }
}
