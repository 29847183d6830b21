//! The film: sums of samples per pixel, in replicates, so that every pixel has a mean and an error.
//!
//! In: blocks of samples, each a power of two long and aligned to its length. Out: an
//! [`crate::image::RenderedImage`]. No ray, no filter (filters are sampled, see [`crate::filter`]).
//!
//! # Honest errors
//! Sample `i` belongs to replicate `i % 8`. Replicates draw from independently scrambled sequences, so
//! the spread of their eight means measures the error also where the samples of one replicate are
//! correlated on purpose (Sobol' points).
//!
//! # The same bits, however the work was cut
//! Sums are pairwise over a fixed binary tree on sample indices. A block is a subtree; two siblings
//! are added as soon as both are there. Passes, threads, resumed and merged runs therefore end in
//! the same additions. Pairwise sums in `f32` lose about log₂(n) · 6·10⁻⁸ of their value, so that even
//! 10⁸ samples do not saturate.

use std::ops::Range;

use thiserror::Error;

use crate::image::RenderedImage;

/// Independent replicates per pixel.
pub const REPLICATES: usize = 8;

/// Floats per pixel: RGB per replicate, then the auxiliary sums.
pub(crate) const SUMS: usize = 3 * REPLICATES + AUX;
/// Auxiliary sums: albedo (3), normal (3), depth, hits.
pub(crate) const AUX: usize = 8;
/// The sums of one pixel over one block.
pub(crate) type PixelSums = [f32; SUMS];

/// The most pixels that a film may have.
pub const MAX_PIXELS: u64 = 1 << 27;

/// Why there is no film, or why two do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FilmError {
    /// Zero or too many pixels.
    #[error(
        "a film of {width} × {height} pixels is not possible; at least 1 and at most {MAX_PIXELS} pixels are"
    )]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// The memory was refused.
    #[error("no memory for a film of {width} × {height} pixels ({megabytes} MB)")]
    Memory {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// What was asked for.
        megabytes: u64,
    },
    /// Films of different sizes.
    #[error("films of {} × {} and {} × {} pixels cannot be merged", .0.0, .0.1, .1.0, .1.1)]
    SizesDiffer((u32, u32), (u32, u32)),
    /// The same samples twice.
    #[error("samples {} to {} are in both films", .0.start, .0.end)]
    Overlap(Range<u32>),
}

/// A subtree of the sum over samples.
#[derive(Clone, Debug)]
struct Block {
    first: u32,
    len: u32,
    sums: Vec<PixelSums>,
}

impl Block {
    fn end(&self) -> u32 {
        self.first + self.len
    }

    fn is_left_sibling_of(&self, right: &Block) -> bool {
        self.len == right.len && self.end() == right.first && self.first.is_multiple_of(2 * self.len)
    }
}

/// Accumulated samples.
#[derive(Clone, Debug)]
pub struct Film {
    width: u32,
    height: u32,
    /// Sorted by first sample, disjoint, no two of them siblings.
    blocks: Vec<Block>,
    rejected: u64,
}

impl Film {
    /// An empty film.
    ///
    /// # Errors
    /// If the size is zero or above [`MAX_PIXELS`].
    pub fn new(width: u32, height: u32) -> Result<Self, FilmError> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || pixels > MAX_PIXELS {
            return Err(FilmError::Size { width, height });
        }
        Ok(Self { width, height, blocks: Vec::new(), rejected: 0 })
    }

    /// Pixels across and down.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Samples per pixel so far.
    pub fn spp(&self) -> u32 {
        self.blocks.iter().map(|b| b.len).sum()
    }

    /// The sample ranges that are in, as few as possible.
    pub fn ranges(&self) -> Vec<Range<u32>> {
        let mut ranges: Vec<Range<u32>> = Vec::new();
        for block in &self.blocks {
            match ranges.last_mut() {
                Some(last) if last.end == block.first => last.end = block.end(),
                _ => ranges.push(block.first..block.end()),
            }
        }
        ranges
    }

    /// Samples that were infinite or NaN and count as black.
    pub fn rejected_samples(&self) -> u64 {
        self.rejected
    }

    /// Zeroed sums for one block.
    pub(crate) fn new_sums(&self) -> Result<Vec<PixelSums>, FilmError> {
        let pixels = self.width as usize * self.height as usize;
        let mut sums = Vec::new();
        sums.try_reserve_exact(pixels).map_err(|_| FilmError::Memory {
            width: self.width,
            height: self.height,
            megabytes: (pixels * size_of::<PixelSums>()) as u64 >> 20,
        })?;
        sums.resize(pixels, [0.0; SUMS]);
        Ok(sums)
    }

    /// Adds the sums of samples `first .. first + len`.
    pub(crate) fn push(
        &mut self,
        first: u32,
        sums: Vec<PixelSums>,
        len: u32,
        rejected: u64,
    ) -> Result<(), FilmError> {
        debug_assert!(len.is_power_of_two() && first.is_multiple_of(len));
        self.insert(Block { first, len, sums })?;
        self.rejected += rejected;
        Ok(())
    }

    fn insert(&mut self, block: Block) -> Result<(), FilmError> {
        let mut at = self.blocks.partition_point(|b| b.first < block.first);
        let clash = |b: &Block| b.first < block.end() && block.first < b.end();
        if self.blocks[at.saturating_sub(1)..(at + 1).min(self.blocks.len())].iter().any(clash) {
            return Err(FilmError::Overlap(block.first..block.end()));
        }
        self.blocks.insert(at, block);
        loop {
            let left = match at {
                at if at > 0 && self.blocks[at - 1].is_left_sibling_of(&self.blocks[at]) => at - 1,
                at if at + 1 < self.blocks.len()
                    && self.blocks[at].is_left_sibling_of(&self.blocks[at + 1]) =>
                {
                    at
                }
                _ => return Ok(()),
            };
            let right = self.blocks.remove(left + 1);
            let parent = &mut self.blocks[left];
            parent.len *= 2;
            for (pixel, other) in parent.sums.iter_mut().zip(&right.sums) {
                for (a, b) in pixel.iter_mut().zip(other) {
                    *a += b;
                }
            }
            at = left;
        }
    }

    /// Takes in the samples of another film. Any cut of a sample range, merged, gives the bits of the whole.
    ///
    /// # Errors
    /// If the sizes differ or a sample is in both; `self` is then unchanged.
    pub fn merge(&mut self, other: Film) -> Result<(), FilmError> {
        if self.size() != other.size() {
            return Err(FilmError::SizesDiffer(self.size(), other.size()));
        }
        for b in &other.blocks {
            if self.blocks.iter().any(|a| a.first < b.end() && b.first < a.end()) {
                return Err(FilmError::Overlap(b.first..b.end()));
            }
        }
        for block in other.blocks {
            self.insert(block)?;
        }
        self.rejected += other.rejected;
        Ok(())
    }

    /// Samples per replicate.
    fn replicate_counts(&self) -> [u64; REPLICATES] {
        let mut counts = [0; REPLICATES];
        for block in &self.blocks {
            for (r, count) in counts.iter_mut().enumerate() {
                let upto = |end: u32| (u64::from(end) + REPLICATES as u64 - 1 - r as u64) / REPLICATES as u64;
                *count += upto(block.end()) - upto(block.first);
            }
        }
        counts
    }

    /// The image so far: means and standard errors.
    ///
    /// The variance of a pixel's mean is R / (R − 1) · Σᵣ (Sᵣ − nᵣ m)² / N² over its R replicates with
    /// nᵣ samples and sum Sᵣ, m being the mean of all N samples (Cochran 1977, §2.11: the ratio
    /// estimator's variance). With fewer than two replicates the error is infinite: unknown.
    pub fn image(&self) -> RenderedImage {
        let counts = self.replicate_counts();
        let n = f64::from(self.spp());
        let used = counts.iter().filter(|&&c| c > 0).count() as f64;
        let mut image = RenderedImage::black(self.width, self.height, self.spp());
        if n == 0.0 {
            return image;
        }
        for pixel in 0..image.pixel_count() {
            let mut sums = [0.0_f64; SUMS];
            for block in &self.blocks {
                for (total, &part) in sums.iter_mut().zip(&block.sums[pixel]) {
                    *total += f64::from(part);
                }
            }
            for c in 0..3 {
                let replicate = |r: usize| sums[3 * r + c];
                let mean = (0..REPLICATES).map(replicate).sum::<f64>() / n;
                let spread: f64 =
                    (0..REPLICATES).map(|r| (replicate(r) - counts[r] as f64 * mean).powi(2)).sum();
                let variance =
                    if used > 1.0 { used / (used - 1.0) * spread / (n * n) } else { f64::INFINITY };
                image.rgb[3 * pixel + c] = mean as f32;
                image.stderr[3 * pixel + c] = variance.sqrt() as f32;
            }
            let aux = &sums[3 * REPLICATES..];
            let hits = aux[7];
            for c in 0..3 {
                image.albedo[3 * pixel + c] = (aux[c] / n) as f32;
                image.normal[3 * pixel + c] = (aux[3 + c] / n) as f32;
            }
            image.depth[pixel] = if hits > 0.0 { (aux[6] / hits) as f32 } else { f32::INFINITY };
            image.alpha[pixel] = (hits / n) as f32;
        }
        image
    }
}

/// Cuts a range of samples into the next block: the longest aligned power of two that starts at
/// `range.start`, fits, and is at most `cap` long.
pub(crate) fn next_block(range: &Range<u32>, cap: u32) -> u32 {
    let left = range.end - range.start;
    let longest_fit = 1 << left.ilog2();
    let aligned = if range.start == 0 { longest_fit } else { 1 << range.start.trailing_zeros() };
    longest_fit.min(aligned).min(1 << cap.max(1).ilog2())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block whose replicate sums follow from the sample indices.
    fn block(film: &Film, first: u32, len: u32, value: impl Fn(u32) -> f32 + Copy) -> Vec<PixelSums> {
        if len > 1 {
            let mut left = block(film, first, len / 2, value);
            let right = block(film, first + len / 2, len / 2, value);
            for (a, b) in left.iter_mut().flatten().zip(right.iter().flatten()) {
                *a += b;
            }
            return left;
        }
        let mut sums = film.new_sums().unwrap();
        for pixel in &mut sums {
            pixel[3 * (first as usize % REPLICATES)] = value(first);
        }
        sums
    }

    fn filled(range: Range<u32>, cap: u32, value: impl Fn(u32) -> f32 + Copy) -> Film {
        let mut film = Film::new(2, 1).unwrap();
        let mut left = range;
        while !left.is_empty() {
            let len = next_block(&left, cap);
            let sums = block(&film, left.start, len, value);
            film.push(left.start, sums, len, 0).unwrap();
            left.start += len;
        }
        film
    }

    fn noise(i: u32) -> f32 {
        (f32::from((i.wrapping_mul(2_654_435_761) >> 16) as u16) / 65536.0).exp2() - 0.3
    }

    #[test]
    fn any_cut_gives_the_same_bits() {
        let whole = filled(0..100, u32::MAX, noise).image();
        for (cut, cap) in [(50, 4), (37, 1), (99, 64), (8, 16)] {
            let mut a = filled(0..cut, cap, noise);
            let b = filled(cut..100, cap, noise);
            let mut c = b.clone();
            c.merge(a.clone()).unwrap();
            a.merge(b).unwrap();
            assert_eq!(a.ranges(), vec![0..100]);
            assert_eq!(a.image(), whole, "cut at {cut}");
            assert_eq!(c.image(), whole, "cut at {cut}, merged in the other order");
        }
    }

    #[test]
    fn mean_and_error_are_those_of_the_replicates() {
        let image = filled(0..16, 4, |i| (i % 8) as f32).image();
        assert_eq!(image.rgb[0], 3.5);
        // eight replicate means 0…7: variance 6, of their mean 6 / 8
        assert!((image.stderr[0] - (6.0_f32 / 8.0).sqrt()).abs() < 1e-6);
        assert_eq!(image.spp, 16);
    }

    #[test]
    fn one_sample_has_no_known_error() {
        assert!(filled(0..1, 1, noise).image().stderr[0].is_infinite());
    }

    #[test]
    fn overlaps_and_other_sizes_are_refused_and_change_nothing() {
        let mut a = filled(0..8, 8, noise);
        let before = a.image();
        assert_eq!(a.merge(filled(4..12, 8, noise)), Err(FilmError::Overlap(4..8)));
        assert!(matches!(a.merge(Film::new(3, 1).unwrap()), Err(FilmError::SizesDiffer(..))));
        assert_eq!(a.image(), before);
        assert!(matches!(Film::new(60_000, 60_000), Err(FilmError::Size { .. })));
        assert!(matches!(Film::new(0, 7), Err(FilmError::Size { .. })));
    }

    #[test]
    fn blocks_are_aligned_powers_of_two_that_cover_the_range() {
        for (range, cap) in [(0..64, 1000), (0..100, 7), (3..77, 16), (u32::MAX - 5..u32::MAX, 4)] {
            let mut at = range.clone();
            while !at.is_empty() {
                let len = next_block(&at, cap);
                assert!(len.is_power_of_two() && len <= cap && at.start.is_multiple_of(len));
                at.start += len;
            }
            assert_eq!(at.start, range.end);
        }
    }
}
