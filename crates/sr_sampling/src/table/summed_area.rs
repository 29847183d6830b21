//! A picture of which any axis-parallel window is a density.

use glam::{DVec2, Vec2};

use super::{TableError, checked_sum};
use crate::distribution::{Distribution, Sample};
use crate::measure::Plane;

/// Cells over [0, 1)², row 0 at y = 0, whose sum over any window takes four look-ups (Crow 1984).
///
/// A [`Window`] of it is a distribution: what a scene sees of the sky through an opening, from any point, without a
/// table for each point. Eight bytes a cell; sampling takes O(log n).
#[derive(Clone, Debug)]
pub struct SummedArea {
    width: usize,
    height: usize,
    /// `sums[y * (width + 1) + x]`: all cells with smaller indices along both axes, divided by the number of all cells.
    sums: Vec<f64>,
}

impl SummedArea {
    /// The most cells along a side.
    pub const MAX_SIDE: usize = 1 << 14;

    /// From values in rows of `width` cells.
    ///
    /// # Errors
    /// If there is no value, they do not fill whole rows, a side is longer than 2¹⁴, a value is negative or not finite,
    /// or all are 0.
    pub fn new(values: &[f32], width: usize) -> Result<Self, TableError> {
        checked_sum(values)?;
        if width == 0 || !values.len().is_multiple_of(width) {
            return Err(TableError::BadShape { len: values.len(), width });
        }
        let height = values.len() / width;
        let side = width.max(height);
        if side > Self::MAX_SIDE {
            return Err(TableError::TooLarge { len: side, limit: Self::MAX_SIDE });
        }
        let per_cell = 1.0 / values.len() as f64;
        let stride = width + 1;
        let mut sums = vec![0.0; stride * (height + 1)];
        for (y, row) in values.chunks_exact(width).enumerate() {
            let mut row_sum = 0.0;
            for (x, &value) in row.iter().enumerate() {
                row_sum += f64::from(value) * per_cell;
                sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row_sum;
            }
        }
        Ok(Self { width, height, sums })
    }

    /// The part of a window that is inside the unit square, as a distribution; `None` if nothing is in it.
    pub fn window(&self, low: Vec2, high: Vec2) -> Option<Window<'_>> {
        let size = DVec2::new(self.width as f64, self.height as f64);
        let inside = |p: Vec2| p.as_dvec2().clamp(DVec2::ZERO, DVec2::ONE) * size;
        if low.is_nan() || high.is_nan() {
            return None; // which `clamp` would hide
        }
        let (low, high) = (inside(low), inside(high));
        let integral = self.between(low, high);
        (low.x < high.x && low.y < high.y && integral > 0.0).then_some(Window {
            table: self,
            low,
            high,
            integral,
        })
    }

    /// The integral up to a point, in cells, along both axes: between corners of cells it is bilinear.
    fn up_to(&self, x: f64, y: f64) -> f64 {
        let (column, row) = ((x as usize).min(self.width - 1), (y as usize).min(self.height - 1));
        let (s, t) = (x - column as f64, y - row as f64);
        let stride = self.width + 1;
        let at = |x: usize, y: usize| self.sums[y * stride + x];
        let along = |row: usize| at(column, row) * (1.0 - s) + at(column + 1, row) * s;
        along(row) * (1.0 - t) + along(row + 1) * t
    }

    fn between(&self, low: DVec2, high: DVec2) -> f64 {
        self.up_to(high.x, high.y) - self.up_to(low.x, high.y) - self.up_to(high.x, low.y)
            + self.up_to(low.x, low.y)
    }

    /// The value of a cell, as its sums tell it.
    fn value(&self, column: usize, row: usize) -> f64 {
        let low = DVec2::new(column as f64, row as f64);
        self.between(low, low + DVec2::ONE).max(0.0) * (self.width * self.height) as f64
    }
}

/// A window of a [`SummedArea`]: the density is a cell's value over the window's integral, and 0 outside.
#[derive(Clone, Copy, Debug)]
pub struct Window<'a> {
    table: &'a SummedArea,
    /// In cells.
    low: DVec2,
    high: DVec2,
    integral: f64,
}

impl Window<'_> {
    /// ∫ over the window, of values over the unit square.
    pub fn integral(&self) -> f64 {
        self.integral
    }

    /// The value at a point; 0 outside the window.
    pub fn value(&self, p: Vec2) -> f64 {
        let p = p.as_dvec2() * DVec2::new(self.table.width as f64, self.table.height as f64);
        if !(p.cmpge(self.low).all() && p.cmple(self.high).all()) {
            return 0.0;
        }
        let (column, row) = (p.x as usize, p.y as usize);
        self.table.value(column.min(self.table.width - 1), row.min(self.table.height - 1))
    }

    /// Where a rising function, linear between whole numbers, reaches `u` times its value at `high`; it is 0 at `low`.
    fn solve(low: f64, high: f64, u: f64, f: impl Fn(f64) -> f64) -> f64 {
        let goal = u * f(high);
        // the whole numbers within are bisected: `below` is one that is not reached yet, or the start
        let (mut below, mut above) = (low.floor(), high.ceil());
        while above - below > 1.5 {
            let middle = (0.5 * (below + above)).floor();
            if f(middle) <= goal {
                below = middle;
            } else {
                above = middle;
            }
        }
        let (start, end) = (below.max(low), above.min(high));
        let (f_start, f_end) = (f(start), f(end));
        let share =
            if f_end > f_start { ((goal - f_start) / (f_end - f_start)).clamp(0.0, 1.0) } else { 0.5 };
        start + share * (end - start)
    }
}

impl Distribution for Window<'_> {
    type Measure = Plane;
    type Uniform = Vec2;

    fn sample(&self, u: Vec2) -> Option<Sample<Plane>> {
        let Self { table, low, high, integral } = *self;
        let x = Self::solve(low.x, high.x, u.x.into(), |x| table.between(low, DVec2::new(x, high.y)));
        // given x, the rows are in proportion to the values of its column
        let column = (x as usize).min(table.width - 1) as f64;
        let left = DVec2::new(column, low.y);
        let y = Self::solve(low.y, high.y, u.y.into(), |y| table.between(left, DVec2::new(column + 1.0, y)));
        let size = Vec2::new(table.width as f32, table.height as f32);
        let value = Vec2::new(x as f32, y as f32) / size;
        let pdf = (table.value(column as usize, (y as usize).min(table.height - 1)) / integral) as f32;
        (pdf > 0.0).then_some(Sample { value, pdf })
    }

    fn pdf(&self, p: Vec2) -> f32 {
        (self.value(p) / self.integral) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::testing::uniforms;

    fn table() -> SummedArea {
        let values: Vec<f32> = (0..7 * 5).map(|i| (i % 4) as f32).collect();
        SummedArea::new(&values, 7).unwrap()
    }

    #[test]
    fn a_window_of_whole_cells_sums_them() {
        let table = table();
        let all = table.window(Vec2::ZERO, Vec2::ONE).unwrap();
        let mean = (0..35).map(|i| f64::from(i % 4)).sum::<f64>() / 35.0;
        assert!((all.integral() - mean).abs() < 1e-12);
        let cell = table.window(Vec2::new(1.0 / 7.0, 0.2), Vec2::new(2.0 / 7.0, 0.4)).unwrap();
        assert!((cell.integral() - f64::from(8 % 4) / 35.0).abs() < 1e-7, "{}", cell.integral());
    }

    #[test]
    fn samples_lie_in_the_window_and_carry_its_density() {
        let table = table();
        for (low, high) in [
            (Vec2::new(0.1, 0.15), Vec2::new(0.93, 0.7)),
            (Vec2::new(0.45, 0.5), Vec2::new(0.5, 0.55)),
            (Vec2::splat(-1.0), Vec2::splat(2.0)),
        ] {
            let window = table.window(low, high).unwrap();
            for u in uniforms() {
                let s = window.sample(u).unwrap();
                assert!(s.value.cmpge(low - 1e-6).all() && s.value.cmple(high + 1e-6).all(), "{}", s.value);
                assert!(s.pdf > 0.0);
            }
        }
    }

    #[test]
    fn empty_windows_are_none() {
        let table = table();
        for (low, high) in [
            (Vec2::splat(0.5), Vec2::splat(0.5)),
            (Vec2::splat(0.6), Vec2::splat(0.4)),
            (Vec2::splat(1.5), Vec2::splat(2.0)),
            (Vec2::NAN, Vec2::ONE),
            (Vec2::ZERO, Vec2::new(0.14, 0.19)),
        ] {
            assert!(table.window(low, high).is_none(), "{low} {high}");
        }
        assert_eq!(SummedArea::new(&[], 3).unwrap_err(), TableError::Empty);
        assert_eq!(SummedArea::new(&[0.0; 4], 2).unwrap_err(), TableError::AllZero { len: 4 });
        assert_eq!(SummedArea::new(&[1.0; 5], 2).unwrap_err(), TableError::BadShape { len: 5, width: 2 });
    }
}
