//! A picture as a density over the unit square.

use glam::Vec2;

use super::TableError;
use super::cumulative::{self, PADDING, Picked};
use crate::distribution::{Distribution, Invert, Sample};
use crate::measure::Plane;
use crate::prefetch;

/// A density over [0, 1)² that is constant in each cell of a grid: row 0 at y = 0, column 0 at x = 0.
///
/// A row is drawn first, then a column in it. Four and a half to five bytes a cell. Sampling takes constant time on average,
/// `pdf` always.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant2D {
    width: usize,
    height: usize,
    /// Cumulative probabilities of the rows, with their padding.
    rows: Vec<u32>,
    /// Of the columns, given the row: `width + 1` numbers and their padding for each.
    columns: Vec<u32>,
    /// Where to look for a uniform in `rows`, and in each row of `columns`: 2ᵇ cuts of [0, 1).
    guide_bits: [u32; 2],
    row_guide: Vec<u16>,
    column_guides: Vec<u16>,
}

/// A sample in the making: [`PiecewiseConstant2D::begin`].
#[derive(Clone, Copy, Debug)]
pub struct Draw2D {
    row: Picked,
    /// A column that is not beyond the one to be drawn.
    column: usize,
}

impl Draw2D {
    /// Not draw: to fill arrays with.
    pub const NONE: Self = Self { row: Picked { index: 0, pmf: 0.0, rest: 0.0 }, column: 0 };
}

impl PiecewiseConstant2D {
    /// The most cells along a side.
    pub const MAX_SIDE: usize = 1 << 16;

    /// A density proportional to `values`, which are rows of `width` cells.
    ///
    /// # Errors
    /// If there is no value, they do not fill whole rows, a side is longer than 2¹⁶, a value is
    /// negative or not finite, or all are 0.
    pub fn new(values: &[f32], width: usize) -> Result<Self, TableError> {
        if values.is_empty() {
            return Err(TableError::Empty);
        }
        if width == 0 || !values.len().is_multiple_of(width) {
            return Err(TableError::BadShape { len: values.len(), width });
        }
        let side = width.max(values.len() / width);
        if side > Self::MAX_SIDE {
            return Err(TableError::TooLarge { len: side, limit: Self::MAX_SIDE });
        }
        if let Some(index) = values.iter().position(|v| !(*v >= 0.0 && v.is_finite())) {
            return Err(TableError::BadWeight { index, weight: values[index] });
        }
        let sums: Vec<f64> =
            values.chunks_exact(width).map(|row| row.iter().map(|&v| f64::from(v)).sum()).collect();
        let sum: f64 = sums.iter().sum();
        if sum == 0.0 {
            return Err(TableError::AllZero { len: values.len() });
        }
        let height = sums.len();
        let mut rows = vec![0; height + 1];
        cumulative::fill(sums.iter().copied(), sum, &mut rows);
        let guide_bits = [height, width].map(cumulative::guide_bits);
        let [row_guide_len, column_guide_len] = guide_bits.map(|bits| 1 << bits);
        let mut row_guide = vec![0; row_guide_len];
        cumulative::fill_guide(&rows, &mut row_guide);
        rows.extend(PADDING);
        let mut columns = Vec::with_capacity(height * stride(width));
        let mut column_guides = vec![0; height * column_guide_len];
        for ((values, &sum), guide) in
            values.chunks_exact(width).zip(&sums).zip(column_guides.chunks_exact_mut(column_guide_len))
        {
            let start = columns.len();
            columns.resize(start + width + 1, 0);
            let row = &mut columns[start..];
            cumulative::fill(values.iter().map(|&v| f64::from(v)), sum, row);
            cumulative::fill_guide(row, guide);
            columns.extend(PADDING);
        }
        Ok(Self { width, height, rows, columns, guide_bits, row_guide, column_guides })
    }

    /// The number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The first of three steps of [`Distribution::sample`]. Each asks for the memory that the next reads, so that
    /// whoever draws many samples takes each step for all before the next: large pictures' tables are not in caches.
    #[inline(always)]
    pub fn begin(&self, u: Vec2) -> Draw2D {
        let [row_bits, bits] = self.guide_bits;
        let row = cumulative::pick_guided(&self.rows, &self.row_guide, row_bits, u.y);
        prefetch(&self.column_guides[(row.index << bits) + cumulative::cut(bits, u.x)]);
        Draw2D { row, column: 0 }
    }

    /// The second step.
    #[inline(always)]
    pub fn proceed(&self, draw: &mut Draw2D, u: Vec2) {
        let [_, bits] = self.guide_bits;
        let guide = &self.column_guides[draw.row.index << bits..];
        draw.column = usize::from(guide[cumulative::cut(bits, u.x)]);
        let first = draw.row.index * stride(self.width) + draw.column;
        prefetch(&self.columns[first]);
        prefetch(&self.columns[first + PADDING.len()]);
    }

    /// The third step.
    #[inline(always)]
    pub fn finish(&self, Draw2D { row, column }: Draw2D, u: Vec2) -> Sample<Plane> {
        let x = cumulative::pick_from(&self.columns[row.index * stride(self.width)..], column, u.x);
        let value = Vec2::new(place(x.index, x.rest, self.width), place(row.index, row.rest, self.height()));
        Sample { value, pdf: (x.pmf * row.pmf * self.cells()) as f32 }
    }

    fn row(&self, y: usize) -> &[u32] {
        &self.columns[y * stride(self.width)..][..=self.width]
    }

    /// Cells per unit of area.
    fn cells(&self) -> f64 {
        self.width as f64 * self.height() as f64
    }

    /// The column and row of the cell that holds `x`, and where in it `x` lies.
    fn locate(&self, x: Vec2) -> Option<[(usize, f64); 2]> {
        let along = |x: f32, n: usize| {
            let scaled = f64::from(x) * n as f64;
            let cell = scaled as usize;
            (x >= 0.0 && cell < n).then_some((cell, scaled - cell as f64))
        };
        Some([along(x.x, self.width)?, along(x.y, self.height())?])
    }
}

/// From row to row of cumulative probabilities.
#[inline(always)]
fn stride(width: usize) -> usize {
    width + 1 + PADDING.len()
}

/// A coordinate in cell `cell` of `n`: rounding must not push it into the next one.
#[inline(always)]
fn place(cell: usize, rest: f64, n: usize) -> f32 {
    let x = ((cell as f64 + rest) / n as f64) as f32;
    if f64::from(x) * n as f64 >= (cell + 1) as f64 { x.next_down() } else { x }
}

impl Distribution for PiecewiseConstant2D {
    type Measure = Plane;
    type Uniform = Vec2;

    #[inline(always)]
    fn sample(&self, u: Vec2) -> Option<Sample<Plane>> {
        let mut draw = self.begin(u);
        self.proceed(&mut draw, u);
        Some(self.finish(draw, u))
    }

    #[inline]
    fn pdf(&self, x: Vec2) -> f32 {
        let Some([(column, _), (row, _)]) = self.locate(x) else { return 0.0 };
        let pmf = cumulative::pmf(self.row(row), column) * cumulative::pmf(&self.rows, row);
        (pmf * self.cells()) as f32
    }
}

impl Invert for PiecewiseConstant2D {
    fn invert(&self, x: Vec2) -> Option<Vec2> {
        if self.pdf(x) == 0.0 {
            return None;
        }
        let [(column, rest_x), (row, rest_y)] = self.locate(x)?;
        let u_x = cumulative::unpick(self.row(row), column, rest_x) as f32;
        let u_y = cumulative::unpick(&self.rows, row, rest_y) as f32;
        Some(Vec2::new(u_x, u_y).min(Vec2::splat(1.0 - f32::EPSILON / 2.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    #[test]
    fn density_is_value_over_mean() {
        let p = PiecewiseConstant2D::new(&[1.0, 0.0, 3.0, 2.0, 0.0, 6.0], 3).unwrap();
        assert_eq!((p.width(), p.height()), (3, 2));
        for (x, y, value) in
            [(0.1, 0.1, 1.0), (0.5, 0.4, 0.0), (0.9, 0.0, 3.0), (0.0, 0.5, 2.0), (0.7, 0.9, 6.0)]
        {
            let pdf = p.pdf(Vec2::new(x, y));
            assert!((pdf - value / 2.0).abs() < 1e-6, "({x}, {y}): {pdf}");
        }
        for outside in [Vec2::new(-0.1, 0.5), Vec2::new(0.5, 1.0), Vec2::NAN] {
            assert_eq!(p.pdf(outside), 0.0);
        }
    }

    /// A picture with rows of nothing, and one cell of 10⁸ times the rest: the sun.
    #[test]
    fn samples_carry_their_density_and_invert() {
        let (width, height) = (37, 19);
        let mut values: Vec<f32> = (0..width * height).map(|i| (i % 7) as f32 + 0.1).collect();
        values[3 * width..5 * width].fill(0.0);
        let mild = PiecewiseConstant2D::new(&values, width).unwrap();
        values[10 * width + 4] = 1e8;
        let sunny = PiecewiseConstant2D::new(&values, width).unwrap();
        for p in [mild, sunny] {
            for u in uniforms() {
                let s = p.sample(u).unwrap();
                assert_eq!(p.pdf(s.value), s.pdf, "{u}");
                assert!(s.pdf > 0.0);
                let again = p.sample(p.invert(s.value).unwrap()).unwrap();
                assert!((again.value - s.value).length() < 1e-5 || again.pdf < 0.01, "{u}: {}", s.value);
            }
            // No positive cell is lost, however small its share.
            for (i, &value) in values.iter().enumerate() {
                let centre = Vec2::new((i % width) as f32 + 0.5, (i / width) as f32 + 0.5)
                    / Vec2::new(width as f32, height as f32);
                assert_eq!(p.pdf(centre) > 0.0, value > 0.0, "cell {i}");
            }
        }
    }

    #[test]
    fn errors_name_what_is_wrong() {
        let error = |values: &[f32], width| PiecewiseConstant2D::new(values, width).unwrap_err();
        assert_eq!(error(&[], 3), TableError::Empty);
        assert_eq!(error(&[1.0; 5], 3), TableError::BadShape { len: 5, width: 3 });
        assert_eq!(error(&[1.0; 5], 0), TableError::BadShape { len: 5, width: 0 });
        assert_eq!(error(&[0.0; 6], 3), TableError::AllZero { len: 6 });
        assert_eq!(error(&[1.0, -1.0], 2), TableError::BadWeight { index: 1, weight: -1.0 });
        let limit = PiecewiseConstant2D::MAX_SIDE;
        assert_eq!(error(&vec![1.0; limit + 1], 1), TableError::TooLarge { len: limit + 1, limit });
    }
}
