//! Drawing samples, and what is noticed on the way.

use super::super::pearson::too_many_strays;
use super::Blocks;
use crate::report::TestReport;

/// Points of a block.
pub const BLOCK: usize = 1 << 14;
/// A sample's `pdf` may differ from the density at it by this factor, since the point is rounded …
const PDF_TOLERANCE: f64 = 1e-5;
/// … and by more in this share of the samples: at rims, where the density jumps.
const PDF_OUTLIERS: f64 = 1e-3;

/// What is noticed while samples are drawn.
#[derive(Default)]
pub struct Tally {
    samples: usize,
    broken: usize,
    stray: usize,
    wrong: usize,
    example: String,
}

impl Tally {
    /// Compares what a sample says with the density at it.
    fn check(&mut self, said: f64, is: f64, point: impl Fn() -> Vec<f64>) {
        self.samples += 1;
        if said == 0.0 {
            return;
        }
        let broken = !(said > 0.0 && said.is_finite());
        let stray = is == 0.0;
        let wrong = is.is_nan() || (said - is).abs() > PDF_TOLERANCE * said.max(is);
        self.broken += usize::from(broken);
        self.stray += usize::from(stray);
        self.wrong += usize::from(wrong);
        if (broken || stray || wrong) && self.example.is_empty() {
            self.example = format!("{:?} was drawn with pdf {said}, the density there is {is}", point());
        }
    }

    /// What is certainly wrong, if anything.
    pub fn verdict(&self) -> Option<TestReport> {
        let Self { samples, broken, stray, wrong, example } = self;
        let n = *samples as f64;
        let (count, what) = if *broken > 0 {
            (broken, "carry a pdf that is not a positive number")
        } else if too_many_strays(*stray as u64, *samples as u64) {
            (stray, "lie where the density is 0")
        } else if *wrong as f64 > PDF_OUTLIERS * n {
            (wrong, "carry a pdf that is not the density there")
        } else {
            return None;
        };
        Some(TestReport::impossible(format!("{count} of {samples} samples {what}: {example}")))
    }
}

/// Draws `n` samples, a block at a time, and passes each block on.
pub fn each_block<B: Blocks>(
    of: &mut B,
    seed: u64,
    n: usize,
    tally: &mut Tally,
    mut use_block: impl FnMut(&[f64], &[f64]),
) -> Result<(), B::Error> {
    let mut random = Random::new(seed);
    let (dim, uniforms) = (of.dim(), of.uniforms());
    let mut first = 0;
    while first < n {
        let len = BLOCK.min(n - first);
        let u: Vec<f64> = (0..len * uniforms).map(|_| random.next()).collect();
        let (mut x, mut said, mut is) = (vec![0.0; len * dim], vec![0.0; len], vec![0.0; len]);
        of.sample(&u, &mut x, &mut said)?;
        of.pdf(&x, &mut is)?;
        for i in 0..len {
            tally.check(said[i], is[i], || (0..dim).map(|j| x[j * len + i]).collect());
        }
        use_block(&x, &said);
        first += len;
    }
    Ok(())
}

/// Numbers in [0, 1) with 53 bits: Steele, Lea & Flood, "Fast Splittable Pseudorandom Number Generators",
/// 2014.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xd134_2543_de82_ef95))
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_numbers_are_uniform() {
        let mut random = Random::new(5);
        let numbers: Vec<f64> = (0..10_000).map(|_| random.next()).collect();
        assert!(crate::ks(&numbers, |x| x).passes(1e-3));
    }
}
