//! An embedded rank-1 lattice, randomly shifted, and folded.
//!
//! Any 2ᵏ consecutive points whose first index is a multiple of 2ᵏ are a shifted lattice. Folding, u → 1 − |2u − 1|,
//! makes every integrand periodic, so that smooth ones gain a further order (F. J. Hickernell, "Obtaining
//! O(N^(-2+ε)) convergence for lattice quadrature rules", MCQMC 2000).
//!
//! There are 2²⁰ points; more are as many again, with another shift. Points of more dimensions than the vector has are
//! made of groups of dimensions, each with its own random order of the points.

use std::sync::LazyLock;

use sr_sampling::sequence::mix::{mix64, scramble_low_first};

use super::unit::to_unit;

const MAX_BITS: u32 = 20;

static VECTOR: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let lines = include_str!("lattice_vector.txt").lines().filter(|line| !line.starts_with('#'));
    lines.flat_map(str::split_ascii_whitespace).map(|z| z.parse().expect("a number")).collect()
});

/// The generating vector.
#[derive(Clone, Debug)]
pub struct Lattice {
    vector: Vec<u32>,
}

impl Lattice {
    pub fn new(dim: usize) -> Self {
        Self { vector: VECTOR.iter().copied().take(dim).collect() }
    }

    /// Dimension `j` of points `first` and following.
    #[inline(always)]
    pub fn fill(&self, key: u64, first: u32, j: usize, u: &mut [f64]) {
        let step = u64::from(self.vector[j % VECTOR.len()]) << (64 - MAX_BITS);
        let group = j / VECTOR.len();
        let order = mix64(group as u64) as u32;
        for (i, u) in u.iter_mut().enumerate() {
            let index = first.wrapping_add(i as u32);
            let shift = mix64(key ^ u64::from(index >> MAX_BITS));
            // The radical inverse, so that the first 2ᵏ points are a lattice.
            let mut place = index << (32 - MAX_BITS);
            place = place.reverse_bits();
            if group > 0 {
                place = scramble_high_first(place, order);
            }
            let x = to_unit(step.wrapping_mul(u64::from(place)).wrapping_add(shift));
            *u = (1.0 - (2.0 * x - 1.0).abs()).min(1.0 - f64::EPSILON);
        }
    }
}

/// A random order of the 2²⁰ points that maps each aligned block of 2ᵏ, which is a lattice, to one.
#[inline(always)]
fn scramble_high_first(place: u32, seed: u32) -> u32 {
    let top_first = place << (32 - MAX_BITS);
    scramble_low_first(top_first.reverse_bits(), seed).reverse_bits() >> (32 - MAX_BITS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_points_are_a_lattice() {
        let lattice = Lattice::new(3);
        for j in 0..3 {
            let mut u = [0.0; 64];
            lattice.fill(5, 0, j, &mut u);
            // Unfolded, 64 points are 1/64 apart; folded, each cell of a 32nd holds two.
            let mut seen = [0; 32];
            u.iter().for_each(|u| seen[(u * 32.0) as usize] += 1);
            assert!(seen.iter().all(|&n| n == 2), "dimension {j}: {seen:?}");
        }
    }

    #[test]
    fn the_vector_is_odd_and_short_enough() {
        assert_eq!(VECTOR.len(), 184);
        assert!(VECTOR.iter().all(|z| z % 2 == 1 && *z < 1 << MAX_BITS));
    }
}
