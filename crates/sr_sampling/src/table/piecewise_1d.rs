//! A histogram as a density on the line.

use super::{TableError, checked_sum, cumulative};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::Line;

/// A density that is constant in each of n bins, which need not be of the same width.
///
/// ```
/// use sr_sampling::{Distribution, PiecewiseConstant1D};
/// // Nine of ten events fell in the narrow first bin.
/// let p = PiecewiseConstant1D::from_counts(&[0.0, 0.1, 1.0], &[9.0, 1.0])?;
/// assert!((p.pdf(0.05) - 9.0).abs() < 1e-6);
/// assert!((p.cdf(0.1) - 0.9).abs() < 1e-6);
/// # Ok::<(), sr_sampling::TableError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PiecewiseConstant1D {
    edges: Vec<f32>,
    cumulative: Vec<u32>,
}

impl PiecewiseConstant1D {
    /// A density from how much falls in each bin; the density in a bin is its share over its width.
    ///
    /// - `edges`: n + 1 increasing numbers
    /// - `counts`: n numbers, not necessarily whole
    ///
    /// # Errors
    /// If the lengths do not fit, an edge is not finite or not above the one before, a count is
    /// negative or not finite, or all counts are 0.
    pub fn from_counts(edges: &[f32], counts: &[f32]) -> Result<Self, TableError> {
        cumulative::check_len(counts.len())?;
        let sum = checked_sum(counts)?;
        if edges.len() != counts.len() + 1 {
            return Err(TableError::EdgeCount { edges: edges.len(), counts: counts.len() });
        }
        let bad = |i: usize| !(edges[i].is_finite() && (i == 0 || edges[i] > edges[i - 1]));
        if let Some(index) = (0..edges.len()).find(|&i| bad(i)) {
            return Err(TableError::BadEdge { index, edge: edges[index] });
        }
        let mut table = vec![0; edges.len()];
        cumulative::fill(counts.iter().map(|&c| f64::from(c)), sum, &mut table);
        Ok(Self { edges: edges.to_vec(), cumulative: table })
    }

    /// A density on [0, 1) proportional to `values`, in bins of equal width.
    ///
    /// # Errors
    /// If there is no value, one is negative or not finite, or all are 0.
    pub fn from_values(values: &[f32]) -> Result<Self, TableError> {
        cumulative::check_len(values.len())?;
        let n = values.len() as f64;
        let edges: Vec<f32> = (0..=values.len()).map(|i| (i as f64 / n) as f32).collect();
        Self::from_counts(&edges, values)
    }

    /// The n + 1 edges of the bins.
    pub fn edges(&self) -> &[f32] {
        &self.edges
    }

    /// The bin that holds `x`, and how far into it `x` lies, in [0, 1).
    fn locate(&self, x: f32) -> Option<(usize, f64)> {
        let end = self.edges[self.edges.len() - 1];
        if !(x >= self.edges[0] && x < end) {
            return None;
        }
        let bin = self.edges.partition_point(|&edge| edge <= x) - 1;
        Some((bin, (f64::from(x) - f64::from(self.edges[bin])) / self.width(bin)))
    }

    fn width(&self, bin: usize) -> f64 {
        f64::from(self.edges[bin + 1]) - f64::from(self.edges[bin])
    }

    fn density(&self, bin: usize) -> f32 {
        (cumulative::pmf(&self.cumulative, bin) / self.width(bin)) as f32
    }

    /// The probability of a value below `x`.
    pub fn cdf(&self, x: f32) -> f32 {
        match self.locate(x) {
            Some((bin, rest)) => cumulative::unpick(&self.cumulative, bin, rest) as f32,
            None if x < self.edges[0] => 0.0,
            None => 1.0,
        }
    }

    /// The value below which a share `u` in [0, 1) of the probability lies.
    #[inline]
    pub fn icdf(&self, u: f32) -> f32 {
        self.draw(u).0
    }

    /// A value and its bin.
    #[inline]
    fn draw(&self, u: f32) -> (f32, usize) {
        let picked = cumulative::pick(&self.cumulative, u);
        let (low, high) = (self.edges[picked.index], self.edges[picked.index + 1]);
        let x = f64::from(low) + picked.rest * self.width(picked.index);
        // Rounding must not push the value into the next bin, whose density is another.
        ((x as f32).min(high.next_down()), picked.index)
    }
}

impl Distribution for PiecewiseConstant1D {
    type Measure = Line;
    type Uniform = f32;

    #[inline]
    fn sample(&self, u: f32) -> Option<Sample<Line>> {
        let (value, bin) = self.draw(u);
        Some(Sample { value, pdf: self.density(bin) })
    }

    #[inline]
    fn pdf(&self, x: f32) -> f32 {
        self.locate(x).map_or(0.0, |(bin, _)| self.density(bin))
    }
}

impl Invert for PiecewiseConstant1D {
    fn invert(&self, x: f32) -> Option<f32> {
        let (bin, rest) = self.locate(x)?;
        let u = cumulative::unpick(&self.cumulative, bin, rest) as f32;
        (self.density(bin) > 0.0).then_some(u.min(1.0 - f32::EPSILON / 2.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uneven() -> PiecewiseConstant1D {
        PiecewiseConstant1D::from_counts(&[-1.0, 0.0, 0.5, 4.0, 5.0], &[1.0, 4.0, 0.0, 3.0]).unwrap()
    }

    #[test]
    fn density_is_share_over_width() {
        let p = uneven();
        for (x, expected) in
            [(-2.0, 0.0), (-1.0, 0.125), (0.2, 1.0), (0.5, 0.0), (2.0, 0.0), (4.5, 0.375), (5.0, 0.0)]
        {
            assert!((p.pdf(x) - expected).abs() < 1e-6, "pdf({x}) = {}", p.pdf(x));
        }
        for (x, expected) in [(-9.0, 0.0), (-1.0, 0.0), (0.0, 0.125), (0.5, 0.625), (3.0, 0.625), (9.0, 1.0)]
        {
            assert!((p.cdf(x) - expected).abs() < 1e-6, "cdf({x}) = {}", p.cdf(x));
        }
    }

    #[test]
    fn samples_carry_the_density_of_their_bin_and_invert() {
        for p in [uneven(), PiecewiseConstant1D::from_values(&[0.0, 1.0, 1e-7, 3.0, 0.0]).unwrap()] {
            for i in 0..1 << 12 {
                let u = i as f32 / (1 << 12) as f32;
                let s = p.sample(u).unwrap();
                assert_eq!(p.pdf(s.value), s.pdf, "{u}");
                assert!((p.cdf(s.value) - u).abs() < 1e-6, "{u} gives {}", s.value);
                assert!((p.invert(s.value).unwrap() - u).abs() < 1e-6);
            }
            assert!(p.sample(1.0 - f32::EPSILON / 2.0).unwrap().pdf > 0.0);
        }
        assert_eq!(uneven().invert(2.0), None);
    }

    #[test]
    fn errors_name_the_edge() {
        let error =
            |edges: &[f32], counts: &[f32]| PiecewiseConstant1D::from_counts(edges, counts).unwrap_err();
        assert_eq!(error(&[0.0, 1.0], &[1.0, 1.0]), TableError::EdgeCount { edges: 2, counts: 2 });
        assert_eq!(error(&[0.0, 1.0, 1.0], &[1.0, 1.0]), TableError::BadEdge { index: 2, edge: 1.0 });
        assert!(matches!(error(&[0.0, f32::NAN], &[1.0]), TableError::BadEdge { index: 1, .. }));
        assert_eq!(error(&[0.0, 1.0], &[-1.0]), TableError::BadWeight { index: 0, weight: -1.0 });
        assert_eq!(PiecewiseConstant1D::from_values(&[]).unwrap_err(), TableError::Empty);
    }
}
