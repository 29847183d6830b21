//! Owen-scrambled Sobol' points.
//!
//! Any 2ᵏ consecutive points whose first index is a multiple of 2ᵏ are a (t, k, d)-net, and stay one when scrambled:
//! for smooth integrands the error of their mean falls nearly as n^(-3/2) (A. B. Owen, "Scrambled net variance for
//! integrals of smooth functions", Ann. Stat. 25, 1997).
//!
//! The scramble is a hash (see [`scramble_low_first`]). Points of more dimensions than the table has are made of
//! groups of dimensions, each with its own random order of the points.

use sr_sampling::sequence::mix::{mix64, scramble_low_first};

use super::unit::{extend, to_unit};

const TABLE: &str = include_str!("joe_kuo.txt");

/// The number of dimensions of the table.
const TABLE_DIM: usize = 1024;

/// So many points share the bits of their index above a table of the bits below.
const BLOCK: u32 = 256;

/// The generating matrices of some dimensions.
#[derive(Clone, Debug)]
pub struct Sobol {
    /// For each dimension, what each bit of the index, from the lowest, contributes. Bits are reversed: the lowest is
    /// the first digit, which is the order in which the scramble wants them.
    directions: Vec<[u32; 32]>,
    /// For each dimension, what the lowest bits of an index contribute together.
    low: Vec<[u32; BLOCK as usize]>,
}

impl Sobol {
    pub fn new(dim: usize) -> Self {
        let mut lines = TABLE.lines().filter(|line| !line.starts_with('#'));
        let directions = (0..dim.min(TABLE_DIM)).map(|j| match j {
            0 => std::array::from_fn(|bit| 1 << bit),
            _ => directions(lines.next().expect("the table has this many lines")),
        });
        let directions: Vec<_> = directions.collect();
        let low = directions.iter().map(low_contributions).collect();
        Self { directions, low }
    }

    /// Dimension `j` of points `first` and following.
    #[inline(always)]
    pub fn fill(&self, key: u64, first: u32, j: usize, u: &mut [f64]) {
        let directions = &self.directions[j % TABLE_DIM];
        let seed = key as u32;
        let more = mix64(key);
        // The order of the points of a group of dimensions; the first group keeps the natural one.
        let group = j / TABLE_DIM;
        let order = mix64(group as u64) as u32;
        let low = &self.low[j % TABLE_DIM];
        let mut done = 0;
        while done < u.len() {
            let index = first.wrapping_add(done as u32);
            let (block, start) = (index / BLOCK, (index % BLOCK) as usize);
            let len = (BLOCK as usize - start).min(u.len() - done);
            let u = &mut u[done..done + len];
            if group == 0 {
                let high = contribution(directions, block * BLOCK);
                for (u, low) in u.iter_mut().zip(&low[start..]) {
                    *u = scrambled(high ^ low, seed, more);
                }
            } else {
                for (i, u) in u.iter_mut().enumerate() {
                    let shuffled =
                        scramble_low_first((index + i as u32).reverse_bits(), order).reverse_bits();
                    *u = scrambled(contribution(directions, shuffled), seed, more);
                }
            }
            done += len;
        }
    }
}

#[inline(always)]
fn scrambled(reversed: u32, seed: u32, more: u64) -> f64 {
    to_unit(extend(scramble_low_first(reversed, seed).reverse_bits(), more))
}

/// The sum, without carries, of what the bits of an index contribute.
fn contribution(directions: &[u32; 32], index: u32) -> u32 {
    (0..32).filter(|bit| index >> bit & 1 == 1).fold(0, |sum, bit| sum ^ directions[bit])
}

/// [`contribution`] of the indices below [`BLOCK`].
fn low_contributions(directions: &[u32; 32]) -> [u32; BLOCK as usize] {
    let mut low = [0; BLOCK as usize];
    for bit in 0..BLOCK.ilog2() as usize {
        for i in 0..1 << bit {
            low[i | 1 << bit] = low[i] ^ directions[bit];
        }
    }
    low
}

/// A line of the table to direction numbers, by the recurrence of Bratley & Fox 1988 (Algorithm 659).
fn directions(line: &str) -> [u32; 32] {
    let mut numbers = line.split_ascii_whitespace().map(|n| n.parse::<u32>().expect("a number in the table"));
    let mut next = || numbers.next().expect("a line of the table is complete");
    let (_, degree, coefficients) = (next(), next() as usize, next());
    let mut v = [0_u32; 32]; // v[k] has its first digit at the top
    for k in 0..32 {
        v[k] = if k < degree {
            next() << (31 - k)
        } else {
            let tail = (1..degree).filter(|i| coefficients >> (degree - 1 - i) & 1 == 1);
            tail.fold(v[k - degree] ^ (v[k - degree] >> degree), |sum, i| sum ^ v[k - i])
        };
    }
    v.map(u32::reverse_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first points of dimensions 1 to 6, unscrambled, in natural order (Joe & Kuo 2008; the van der Corput
    /// numbers, and by hand from the recurrence).
    #[test]
    fn the_first_points_are_sobol() {
        let sobol = Sobol::new(6);
        let point = |i: u32| {
            sobol
                .directions
                .iter()
                .map(move |d| f64::from(contribution(d, i).reverse_bits()) / 2_f64.powi(32))
        };
        assert_eq!(point(1).collect::<Vec<_>>(), [0.5; 6]);
        assert_eq!(point(2).collect::<Vec<_>>(), [0.25, 0.75, 0.75, 0.75, 0.25, 0.25]);
        assert_eq!(point(3).collect::<Vec<_>>(), [0.75, 0.25, 0.25, 0.25, 0.75, 0.75]);
    }

    /// Every elementary interval of volume 2⁻ᵏ of the first two dimensions holds one of 2ᵏ aligned points, and each
    /// dimension alone is stratified.
    #[test]
    fn scrambled_points_are_nets() {
        let sobol = Sobol::new(TABLE_DIM);
        let column = |j: usize, first: u32| {
            let mut u = vec![0.0; 256];
            sobol.fill(mix64(j as u64), first, j, &mut u);
            u
        };
        for first in [0, 256 * 77] {
            let (x, y) = (column(0, first), column(1, first));
            for k in 0..=8 {
                let mut seen = [0; 256];
                for (x, y) in x.iter().zip(&y) {
                    let (i, j) = ((x * f64::from(1 << k)) as usize, (y * f64::from(1 << (8 - k))) as usize);
                    seen[i << (8 - k) | j] += 1;
                }
                assert!(seen.iter().all(|&n| n == 1), "2^{k} columns");
            }
            for j in [2, 17, 500, 1023] {
                let mut seen = [0; 256];
                column(j, first).iter().for_each(|u| seen[(u * 256.0) as usize] += 1);
                assert!(seen.iter().all(|&n| n == 1), "dimension {j}");
            }
        }
    }
}
