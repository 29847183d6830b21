//! A grid that becomes finer as points are added, with a point at random in each of its cells.
//!
//! The bits of the index are dealt out to the dimensions in turn, from the lowest, and are the leading digits of their
//! coordinates. So an aligned block of 2ᵏ points fills a grid of 2ᵏ cells, whose sides differ by a factor of two at
//! most, and every block is one of finer cells, too. The bits are scrambled first, each by a random function of those
//! below it: which half of a cell a point falls in is chosen anew in every cell.

use sr_sampling::sequence::mix::{mix64, scramble_low_first};

use super::unit::to_unit;

/// The coordinates of one dimension, `[j, dim]`: which of how many.
///
/// - `key`: of all dimensions; `key_j`: of this one
#[inline(always)]
pub fn fill(key: u64, key_j: u64, first: u32, [j, dim]: [usize; 2], u: &mut [f64]) {
    let digits = 32_usize.saturating_sub(j).div_ceil(dim) as u32;
    let beyond = if digits == 0 { u64::MAX } else { (1 << (64 - digits)) - 1 };
    for (i, u) in u.iter_mut().enumerate() {
        let index = first.wrapping_add(i as u32);
        let cell = dealt(scramble_low_first(index, key as u32), [j, dim], digits).reverse_bits();
        // Which cell is the scramble's choice; where in it, nobody's.
        let within = mix64(key_j.wrapping_add(u64::from(index).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
        *u = to_unit((u64::from(cell) << 32 & !beyond) | (within & beyond));
    }
}

/// Bits j, j + dim, j + 2 dim, … of the index, the first of them lowest.
#[inline(always)]
fn dealt(index: u32, [j, dim]: [usize; 2], digits: u32) -> u32 {
    (0..digits).fold(0, |bits, k| bits | (index >> (j + k as usize * dim) & 1) << k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_fills_a_grid() {
        for (dim, sides) in [(1, vec![64]), (2, vec![8, 8]), (3, vec![4, 4, 4]), (4, vec![4, 4, 2, 2])] {
            for block in [0, 5] {
                let mut seen = vec![0; 64];
                let columns: Vec<Vec<f64>> = (0..dim)
                    .map(|j| {
                        let mut u = vec![0.0; 64];
                        fill(5, mix64(j as u64 + 9), 64 * block, [j, dim], &mut u);
                        u
                    })
                    .collect();
                for i in 0..64 {
                    let cell = (0..dim)
                        .fold(0, |cell, j| cell * sides[j] + (columns[j][i] * sides[j] as f64) as usize);
                    seen[cell] += 1;
                }
                assert!(seen.iter().all(|&n| n == 1), "{dim} dimensions, block {block}: {seen:?}");
            }
        }
    }
}
