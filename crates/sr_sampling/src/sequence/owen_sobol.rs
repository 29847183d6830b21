//! Sobol' points, Owen-scrambled by hashing and padded to any number of dimensions.
//!
//! Every call takes the first one or two Sobol' dimensions, the best there are, with its own random
//! order of the points and its own scramble. So each dimension is stratified, each pair is a
//! (0, 2)-net, and dimensions of different calls are independent of one another: there are as many
//! as anybody wants, and no table.
//!
//! Brent Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020.

use glam::Vec2;

use super::mix::{derive_key, hash, mix64, scramble_low_first, to_unit};
use super::{SampleId, Sequence};

/// The points of a pixel fill every dimension and every pair evenly: any 2ᵏ consecutive indices that
/// start at a multiple of 2ᵏ are a (0, k, 2)-net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OwenSobol {
    key: u64,
}

impl OwenSobol {
    /// The sequence of a seed; different seeds give unrelated scrambles.
    pub fn new(seed: u64) -> Self {
        // Unlike the key of `Independent`, so that the two sequences are unrelated as well.
        Self { key: mix64(!seed) }
    }
}

impl Sequence for OwenSobol {
    #[inline]
    fn get_1d(&self, at: SampleId, dim: u32) -> f32 {
        let seeds = Seeds::new(self.key, at.pixel, dim);
        let index = shuffle(at.index, seeds.order);
        to_unit(scramble_low_first(index, seeds.x).reverse_bits())
    }

    #[inline]
    fn get_2d(&self, at: SampleId, dim: u32) -> Vec2 {
        let seeds = Seeds::new(self.key, at.pixel, dim);
        let index = shuffle(at.index, seeds.order);
        let x = scramble_low_first(index, seeds.x);
        let y = scramble_low_first(sobol_1_reversed(index), seeds.y);
        // One reversal for both: it costs as much as one for either.
        let both = (u64::from(y) << 32 | u64::from(x)).reverse_bits();
        Vec2::new(to_unit((both >> 32) as u32), to_unit(both as u32))
    }

    #[inline]
    fn replicate(&self, number: u32) -> Self {
        Self { key: derive_key(self.key, number) }
    }
}

/// What randomises one dimension or pair of one pixel.
struct Seeds {
    order: u32,
    x: u32,
    y: u32,
}

impl Seeds {
    #[inline]
    fn new(key: u64, pixel: u32, dim: u32) -> Self {
        let bits = hash(key, pixel, 0, dim);
        let more = bits.wrapping_mul(0xda94_2042_e4dd_58b5);
        Self { order: bits as u32, x: (bits >> 32) as u32, y: (more >> 32) as u32 }
    }
}

/// The index in a random order that maps aligned blocks of 2ᵏ indices to such blocks.
#[inline]
fn shuffle(index: u32, seed: u32) -> u32 {
    scramble_low_first(index.reverse_bits(), seed).reverse_bits()
}

/// Dimension 1 of the Sobol' sequence with its bits reversed. (Dimension 0, reversed, is the index.)
///
/// The generator matrix is Pascal's triangle modulo 2, a Kronecker power of `[1 1; 0 1]`: one step
/// for each factor.
#[inline]
fn sobol_1_reversed(index: u32) -> u32 {
    let mut x = index;
    x ^= x >> 16;
    x ^= (x & 0xff00_ff00) >> 8;
    x ^= (x & 0xf0f0_f0f0) >> 4;
    x ^= (x & 0xcccc_cccc) >> 2;
    x ^ (x & 0xaaaa_aaaa) >> 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Dimension 1 from its direction numbers, vₖ₊₁ = vₖ ^ (vₖ >> 1) (Sobol' 1967; Joe & Kuo 2008).
    fn sobol_1(index: u32) -> u32 {
        let mut direction = 1_u32 << 31;
        let mut x = 0;
        for bit in 0..32 {
            if index >> bit & 1 == 1 {
                x ^= direction;
            }
            direction ^= direction >> 1;
        }
        x
    }

    #[test]
    fn the_short_form_is_sobol() {
        for index in (0..1 << 12).chain((0..32).map(|k| 0x9e37_79b9_u32 << k)) {
            assert_eq!(sobol_1_reversed(index).reverse_bits(), sobol_1(index), "index {index}");
        }
    }

    /// Every elementary interval of area 2⁻ᵏ holds exactly one of 2ᵏ aligned points.
    #[test]
    fn pairs_are_nets() {
        for (pixel, dim, block) in [(0, 0, 0), (5, 1, 3), (77, 1000, 9)] {
            let sequence = OwenSobol::new(u64::from(pixel) + 11);
            for k in 0..=10_u32 {
                for k_x in 0..=k {
                    let k_y = k - k_x;
                    let mut hits = vec![0; 1 << k];
                    for index in block << k..(block + 1) << k {
                        let u = sequence.get_2d(SampleId { pixel, index }, dim);
                        let cell_x = (u.x * (1 << k_x) as f32) as usize;
                        let cell_y = (u.y * (1 << k_y) as f32) as usize;
                        hits[cell_x << k_y | cell_y] += 1;
                    }
                    assert!(hits.iter().all(|&n| n == 1), "2^{k_x} × 2^{k_y} cells: {hits:?}");
                }
            }
        }
    }

    #[test]
    fn one_dimension_is_the_first_of_two() {
        let sequence = OwenSobol::new(3);
        for index in 0..100 {
            let at = SampleId { pixel: 9, index };
            assert_eq!(sequence.get_1d(at, 4), sequence.get_2d(at, 4).x);
        }
    }
}
