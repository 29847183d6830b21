//! Pixel filters, sampled: a sample's offset is drawn from the filter, so that all samples weigh the same.
//!
//! With the offset's density proportional to the filter, f / p is constant and every sample belongs to
//! exactly one pixel (Ernst, Stamminger & Greiner 2006). Filters are separable; one axis at a time.

use sr_scene::FilterDesc;

/// Cells of the tabulated inverse CDF of a filter without a closed one.
const CELLS: usize = 256;

/// One axis of a pixel filter, as a density over offsets from the pixel's centre, in pixels.
#[derive(Clone, Debug)]
pub struct PixelFilter {
    shape: Shape,
    radius: f32,
}

#[derive(Clone, Debug)]
enum Shape {
    Box,
    Tent,
    /// The CDF at the borders of equal cells over [−radius, radius].
    Table(Vec<f32>),
}

impl PixelFilter {
    /// Prepares a filter for sampling.
    pub fn new(desc: FilterDesc) -> Self {
        match desc {
            FilterDesc::Box { radius } => Self { shape: Shape::Box, radius },
            FilterDesc::Tent { radius } => Self { shape: Shape::Tent, radius },
            FilterDesc::Gaussian { stddev, radius } => {
                let gauss = |x: f32| (-0.5 * (x / stddev) * (x / stddev)).exp();
                let lowered = |x: f32| f64::from((gauss(x) - gauss(radius)).max(0.0));
                let mut cdf = vec![0.0_f64];
                for i in 0..CELLS {
                    let middle = (2.0 * (i as f32 + 0.5) / CELLS as f32 - 1.0) * radius;
                    cdf.push(cdf[i] + lowered(middle));
                }
                let total = cdf[CELLS];
                Self { shape: Shape::Table(cdf.iter().map(|c| (c / total) as f32).collect()), radius }
            }
        }
    }

    /// Half the filter's width, in pixels.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The probability that an offset is below `x`.
    pub fn cdf(&self, x: f32) -> f32 {
        let t = (x / self.radius).clamp(-1.0, 1.0);
        match &self.shape {
            Shape::Box => 0.5 + 0.5 * t,
            Shape::Tent if t < 0.0 => 0.5 * (1.0 + t) * (1.0 + t),
            Shape::Tent => 1.0 - 0.5 * (1.0 - t) * (1.0 - t),
            Shape::Table(cdf) => {
                let cell = (0.5 + 0.5 * t) * CELLS as f32;
                let i = (cell as usize).min(CELLS - 1);
                cdf[i] + (cell - i as f32) * (cdf[i + 1] - cdf[i])
            }
        }
    }

    /// The offset below which a sample lies with probability `u`.
    pub fn icdf(&self, u: f32) -> f32 {
        let mut offset = [u];
        self.place(&mut offset);
        offset[0]
    }

    /// [`PixelFilter::icdf`] of each of many probabilities, in their place.
    #[inline(always)]
    pub fn place(&self, u: &mut [f32]) {
        match &self.shape {
            Shape::Box => {
                for u in u {
                    *u = (2.0 * *u - 1.0) * self.radius;
                }
            }
            Shape::Tent => {
                for u in u {
                    *u = tent_icdf(*u) * self.radius;
                }
            }
            Shape::Table(cdf) => {
                for u in u {
                    *u = table_icdf(cdf, *u) * self.radius;
                }
            }
        }
    }

    /// The part of [0, 1) whose offsets stay within the film, for a pixel at `index` of `count`.
    #[inline]
    pub fn inside(&self, index: u32, count: u32) -> (f32, f32) {
        let (below, above) = (index as f32 + 0.5, (count - index) as f32 - 0.5);
        let is_amid = below >= self.radius && above >= self.radius;
        if is_amid { (0.0, 1.0) } else { (self.cdf(-below), self.cdf(above)) }
    }
}

/// Of a tent over [−1, 1]. Does not branch.
#[inline(always)]
fn tent_icdf(u: f32) -> f32 {
    let (left, right) = ((2.0 * u).sqrt() - 1.0, 1.0 - (2.0 * (1.0 - u)).max(0.0).sqrt());
    if u < 0.5 { left } else { right }
}

/// Of a tabulated CDF over [−1, 1].
#[inline]
fn table_icdf(cdf: &[f32], u: f32) -> f32 {
    let i = cdf.partition_point(|&c| c <= u).clamp(1, CELLS) - 1;
    let width = cdf[i + 1] - cdf[i];
    let within = if width > 0.0 { ((u - cdf[i]) / width).clamp(0.0, 1.0) } else { 0.5 };
    2.0 * (i as f32 + within) / CELLS as f32 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<PixelFilter> {
        [
            FilterDesc::Box { radius: 0.5 },
            FilterDesc::Tent { radius: 1.0 },
            FilterDesc::Gaussian { stddev: 0.5, radius: 2.0 },
        ]
        .map(PixelFilter::new)
        .into()
    }

    #[test]
    fn icdf_inverts_cdf() {
        for filter in all() {
            for i in 1..100 {
                let u = i as f32 / 100.0;
                assert!((filter.cdf(filter.icdf(u)) - u).abs() < 1e-4, "{filter:?} at {u}");
            }
        }
    }

    #[test]
    fn variance_is_the_filter_s() {
        let expected = [1.0 / 12.0, 1.0 / 6.0, 0.2486];
        for (filter, expected) in all().iter().zip(expected) {
            let n = 100_000;
            let sum: f64 = (0..n).map(|i| f64::from(filter.icdf((i as f32 + 0.5) / n as f32)).powi(2)).sum();
            assert!((sum / f64::from(n) - expected).abs() < 1e-3, "{filter:?}: {}", sum / f64::from(n));
        }
    }

    #[test]
    fn border_pixels_stay_inside() {
        for filter in all() {
            let (low, high) = filter.inside(0, 4);
            assert!((filter.icdf(low) - -filter.radius().min(0.5)).abs() < 1e-3);
            assert!(high > 0.99);
        }
    }
}
