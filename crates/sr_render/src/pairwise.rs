//! Sums over balanced trees: rounding errors grow with the logarithm of the count, and the order of additions is that of
//! the film's tree.

use crate::film::{AUX, PixelSums, SUMS};

/// Sums a power of two of rows over a balanced tree.
pub(crate) fn pairwise(rows: &mut [[f32; AUX]]) -> [f32; AUX] {
    let mut count = rows.len();
    while count > 1 {
        count /= 2;
        for i in 0..count {
            rows[i] = std::array::from_fn(|c| rows[2 * i][c] + rows[2 * i + 1][c]);
        }
    }
    rows[0]
}

/// A sum over a balanced binary tree, fed in order: one partial sum for each bit of the count.
pub(crate) struct PairwiseSum {
    partial: [PixelSums; 32],
    count: u32,
}

impl PairwiseSum {
    pub fn new() -> Self {
        Self { partial: [[0.0; SUMS]; 32], count: 0 }
    }

    pub fn add(&mut self, mut value: PixelSums) {
        let level = self.count.trailing_ones() as usize;
        for partial in &self.partial[..level] {
            value = std::array::from_fn(|i| partial[i] + value[i]);
        }
        self.partial[level] = value;
        self.count += 1;
    }

    /// The sum of a power of two of values; the next one begins.
    pub fn take_total(&mut self) -> PixelSums {
        debug_assert!(self.count.is_power_of_two());
        let level = self.count.trailing_zeros() as usize;
        self.count = 0;
        self.partial[level]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairwise_sums_do_not_lose_small_terms() {
        let mut tree = PairwiseSum::new();
        for _ in 0..1 << 20 {
            tree.add([0.1; SUMS]);
        }
        assert!((tree.take_total()[5] / (0.1 * (1 << 20) as f32) - 1.0).abs() < 1e-6);
    }
}
