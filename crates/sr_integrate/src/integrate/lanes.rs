//! Sums over many numbers, in lanes.
//!
//! Adding one number after another waits for each sum. Eight sums of every eighth number do not, and are one vector; the
//! order in which numbers are added is the same for every instruction set.

use sr_sampling::isa::{Isa, Work};

const LANES: usize = 8;

/// What is to be known of a list of numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Σ x
    pub sum: f64,
    /// Σ |x|
    pub absolute: f64,
    /// Σ x²
    pub squares: f64,
    /// The largest |x|, NaN aside.
    pub largest: f64,
}

impl Summary {
    /// Of these numbers.
    pub fn of(numbers: &[f64]) -> Self {
        Isa::detect().run(Summarise(numbers))
    }

    /// As if the numbers of both had been one list.
    pub fn merge(&mut self, other: &Self) {
        self.sum += other.sum;
        self.absolute += other.absolute;
        self.squares += other.squares;
        self.largest = self.largest.max(other.largest);
    }

    /// As if all numbers had been multiplied by a positive factor.
    pub fn scale(&mut self, factor: f64) {
        self.sum *= factor;
        self.absolute *= factor;
        self.squares = self.squares * factor * factor;
        self.largest *= factor;
    }
}

struct Summarise<'a>(&'a [f64]);

impl Work for Summarise<'_> {
    type Out = Summary;

    #[inline(always)]
    fn run(self) -> Summary {
        let (mut sum, mut absolute) = ([0.0; LANES], [0.0; LANES]);
        let (mut squares, mut largest) = ([0.0; LANES], [0.0_f64; LANES]);
        let (chunks, rest) = self.0.as_chunks::<LANES>();
        let mut last = [0.0; LANES];
        last[..rest.len()].copy_from_slice(rest);
        for chunk in chunks.iter().chain([&last]) {
            // A loop for each sum: compilers make one vector of each.
            for lane in 0..LANES {
                sum[lane] += chunk[lane];
            }
            let mut size = [0.0; LANES];
            for lane in 0..LANES {
                size[lane] = chunk[lane].abs();
            }
            for lane in 0..LANES {
                absolute[lane] += size[lane];
            }
            for lane in 0..LANES {
                squares[lane] += size[lane] * size[lane];
            }
            for lane in 0..LANES {
                largest[lane] = if size[lane] > largest[lane] { size[lane] } else { largest[lane] };
            }
        }
        Summary {
            sum: total(sum),
            absolute: total(absolute),
            squares: total(squares),
            largest: largest.into_iter().fold(0.0, f64::max),
        }
    }
}

/// How many numbers are positive.
pub fn count_positive(numbers: &[f64]) -> usize {
    Isa::detect().run(CountPositive(numbers))
}

struct CountPositive<'a>(&'a [f64]);

impl Work for CountPositive<'_> {
    type Out = usize;

    #[inline(always)]
    fn run(self) -> usize {
        let mut count = 0;
        for &x in self.0 {
            count += usize::from(x > 0.0);
        }
        count
    }
}

/// Writes x · y, number by number.
pub fn multiply(x: &[f64], y: &[f64], out: &mut [f64]) {
    Isa::detect().run(Multiply { x, y, out });
}

struct Multiply<'a> {
    x: &'a [f64],
    y: &'a [f64],
    out: &'a mut [f64],
}

impl Work for Multiply<'_> {
    type Out = ();

    #[inline(always)]
    fn run(self) {
        for ((out, x), y) in self.out.iter_mut().zip(self.x).zip(self.y) {
            *out = x * y;
        }
    }
}

/// Σ (xᵢ − x̄) (yᵢ − ȳ), of lists of the same length and any two numbers.
pub fn products(x: &[f64], x_mean: f64, y: &[f64], y_mean: f64) -> f64 {
    Isa::detect().run(Products { x, x_mean, y, y_mean })
}

struct Products<'a> {
    x: &'a [f64],
    x_mean: f64,
    y: &'a [f64],
    y_mean: f64,
}

impl Work for Products<'_> {
    type Out = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let Self { x, x_mean, y, y_mean } = self;
        let mut sum = [0.0; LANES];
        let ((x, x_rest), (y, y_rest)) = (x.as_chunks::<LANES>(), y.as_chunks::<LANES>());
        for (x, y) in x.iter().zip(y) {
            for lane in 0..LANES {
                sum[lane] += (x[lane] - x_mean) * (y[lane] - y_mean);
            }
        }
        for (lane, (x, y)) in x_rest.iter().zip(y_rest).enumerate() {
            sum[lane] += (x - x_mean) * (y - y_mean);
        }
        total(sum)
    }
}

#[inline(always)]
fn total(lanes: [f64; LANES]) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_whole_numbers_are_exact() {
        for n in [0, 1, 7, 8, 9, 100] {
            let numbers: Vec<f64> =
                (0..n).map(|i| f64::from(i) * if i % 3 == 0 { -1.0 } else { 1.0 }).collect();
            let summary = Summary::of(&numbers);
            assert_eq!(summary.sum, numbers.iter().sum::<f64>());
            assert_eq!(summary.absolute, numbers.iter().map(|x| x.abs()).sum::<f64>());
            assert_eq!(summary.squares, numbers.iter().map(|x| x * x).sum::<f64>());
            assert_eq!(summary.largest, f64::from((n - 1).max(0)));
            assert_eq!(count_positive(&numbers), numbers.iter().filter(|x| **x > 0.0).count());
            let about_two: f64 = numbers.iter().map(|x| (x - 2.0) * (x - 3.0)).sum();
            assert_eq!(products(&numbers, 2.0, &numbers, 3.0), about_two);
        }
    }
}
