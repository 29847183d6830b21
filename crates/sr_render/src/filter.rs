//! Pixel filters, sampled: a sample's offset is drawn from the filter, so that all samples weigh the same.
//!
//! With the offset's density proportional to the filter, f / p is constant and every sample belongs to
//! exactly one pixel (Ernst, Stamminger & Greiner 2006). Filters are separable; one axis at a time.
//!
//! A filter with lobes below zero is sampled by its absolute value. A sample then weighs f / p = ± ∫|f| / ∫f: every
//! sample the same but for the sign, and the mean is not biased.

use sr_scene::FilterDesc;

/// Cells of the tabulated inverse CDF of a filter without a closed one, at least; and per pixel of its radius.
const CELLS: usize = 256;
const CELLS_PER_PIXEL: f32 = 128.0;

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
    Table(Table),
}

/// A filter over [−radius, radius], constant in each of equal cells.
#[derive(Clone, Debug)]
struct Table {
    /// ∫|f| up to the borders of the cells, over the whole of it.
    cdf: Vec<f32>,
    /// ∫f up to the borders of the cells, in the same unit; `None` if it is the same.
    signed: Option<Vec<f32>>,
}

impl PixelFilter {
    /// Prepares a filter for sampling.
    pub fn new(desc: FilterDesc) -> Self {
        let radius = desc.radius();
        let shape = match desc {
            FilterDesc::Box { .. } => Shape::Box,
            FilterDesc::Tent { .. } => Shape::Tent,
            FilterDesc::Gaussian { stddev, .. } => {
                let gauss = |x: f32| (-0.5 * (x / stddev) * (x / stddev)).exp();
                Shape::Table(Table::new(radius, |x| (gauss(x) - gauss(radius)).max(0.0)))
            }
            FilterDesc::Mitchell { b, c } => Shape::Table(Table::new(radius, |x| cubic(x, b, c))),
            FilterDesc::CatmullRom => Shape::Table(Table::new(radius, |x| cubic(x, 0.0, 0.5))),
            FilterDesc::Lanczos { .. } => Shape::Table(Table::new(radius, |x| sinc(x) * sinc(x / radius))),
            FilterDesc::BlackmanHarris { .. } => {
                Shape::Table(Table::new(radius, |x| blackman_harris(x / radius)))
            }
        };
        Self { shape, radius }
    }

    /// Half the filter's width, in pixels.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Is it negative somewhere? Then samples have weights.
    pub fn is_signed(&self) -> bool {
        matches!(&self.shape, Shape::Table(Table { signed: Some(_), .. }))
    }

    /// The probability that an offset is below `x`.
    pub fn cdf(&self, x: f32) -> f32 {
        let t = (x / self.radius).clamp(-1.0, 1.0);
        match &self.shape {
            Shape::Box => 0.5 + 0.5 * t,
            Shape::Tent if t < 0.0 => 0.5 * (1.0 + t) * (1.0 + t),
            Shape::Tent => 1.0 - 0.5 * (1.0 - t) * (1.0 - t),
            Shape::Table(Table { cdf, .. }) => {
                let cells = cdf.len() - 1;
                let cell = (0.5 + 0.5 * t) * cells as f32;
                let i = (cell as usize).min(cells - 1);
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
            Shape::Table(Table { cdf, .. }) => {
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

    /// ∫|f| / ∫f over the offsets of a part of [0, 1): how much a sample of it weighs, but for its sign.
    pub fn gain(&self, (low, high): (f32, f32)) -> f32 {
        match &self.shape {
            Shape::Table(table) => (high - low) / (table.signed_at(high) - table.signed_at(low)),
            Shape::Box | Shape::Tent => 1.0,
        }
    }

    /// The sign of the filter at the offset of probability `u`.
    pub fn sign(&self, u: f32) -> f32 {
        match &self.shape {
            Shape::Table(Table { cdf, signed: Some(signed) }) => {
                let i = cell_of(cdf, u);
                (signed[i + 1] - signed[i]).signum()
            }
            _ => 1.0,
        }
    }
}

impl Table {
    /// Tabulates `f`, whose integral is positive.
    fn new(radius: f32, f: impl Fn(f32) -> f32) -> Self {
        let cells = CELLS.max((CELLS_PER_PIXEL * radius) as usize);
        let (mut cdf, mut signed) = (vec![0.0_f64], vec![0.0_f64]);
        for i in 0..cells {
            let middle = (2.0 * (i as f32 + 0.5) / cells as f32 - 1.0) * radius;
            let value = f64::from(f(middle));
            cdf.push(cdf[i] + value.abs());
            signed.push(signed[i] + value);
        }
        let total = cdf[cells];
        let scaled = |sums: &[f64]| sums.iter().map(|sum| (sum / total) as f32).collect();
        let is_signed = signed[cells] < total;
        Self { cdf: scaled(&cdf), signed: is_signed.then(|| scaled(&signed)) }
    }

    /// ∫f up to the offset of probability `u`.
    fn signed_at(&self, u: f32) -> f32 {
        let Some(signed) = &self.signed else { return u };
        let i = cell_of(&self.cdf, u);
        let width = self.cdf[i + 1] - self.cdf[i];
        let within = if width > 0.0 { ((u - self.cdf[i]) / width).clamp(0.0, 1.0) } else { 0.0 };
        signed[i] + within * (signed[i + 1] - signed[i])
    }
}

/// Mitchell & Netravali 1988, eq. 8.
fn cubic(x: f32, b: f32, c: f32) -> f32 {
    let x = x.abs();
    let (x2, x3) = (x * x, x * x * x);
    if x < 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x3 + (-18.0 + 12.0 * b + 6.0 * c) * x2 + (6.0 - 2.0 * b)) / 6.0
    } else if x < 2.0 {
        let linear = -12.0 * b - 48.0 * c;
        ((-b - 6.0 * c) * x3 + (6.0 * b + 30.0 * c) * x2 + linear * x + (8.0 * b + 24.0 * c)) / 6.0
    } else {
        0.0
    }
}

/// sin(πx) / (πx).
fn sinc(x: f32) -> f32 {
    let a = std::f32::consts::PI * x;
    if a.abs() < 1e-4 { 1.0 } else { a.sin() / a }
}

/// The minimum four-term window over [−1, 1] (Harris 1978, table I).
fn blackman_harris(x: f32) -> f32 {
    let a = std::f32::consts::PI * x;
    0.35875 + 0.48829 * a.cos() + 0.14128 * (2.0 * a).cos() + 0.01168 * (3.0 * a).cos()
}

/// Of a tent over [−1, 1]. Does not branch.
#[inline(always)]
fn tent_icdf(u: f32) -> f32 {
    let (left, right) = ((2.0 * u).sqrt() - 1.0, 1.0 - (2.0 * (1.0 - u)).max(0.0).sqrt());
    if u < 0.5 { left } else { right }
}

/// The cell in which a tabulated CDF reaches `u`.
#[inline]
fn cell_of(cdf: &[f32], u: f32) -> usize {
    cdf.partition_point(|&c| c <= u).clamp(1, cdf.len() - 1) - 1
}

/// Of a tabulated CDF over [−1, 1].
#[inline]
fn table_icdf(cdf: &[f32], u: f32) -> f32 {
    let i = cell_of(cdf, u);
    let width = cdf[i + 1] - cdf[i];
    let within = if width > 0.0 { ((u - cdf[i]) / width).clamp(0.0, 1.0) } else { 0.5 };
    2.0 * (i as f32 + within) / (cdf.len() - 1) as f32 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<PixelFilter> {
        sr_testing::FILTERS.map(PixelFilter::new).into()
    }

    #[test]
    fn variance_is_the_filter_s() {
        // Mitchell & Netravali's is B / 3 where B + 2 C = 1; the last one is by quadrature
        let expected = [1.0 / 12.0, 1.0 / 6.0, 0.2486, 1.0 / 9.0, 0.0, 0.0, 0.17266];
        for (filter, expected) in all().iter().zip(expected) {
            let n = 100_000;
            let gain = f64::from(filter.gain((0.0, 1.0)));
            let squared = |u: f32| f64::from(filter.icdf(u)).powi(2) * f64::from(filter.sign(u)) * gain;
            let sum: f64 = (0..n).map(|i| squared((i as f32 + 0.5) / n as f32)).sum();
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
