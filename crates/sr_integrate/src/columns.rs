//! Blocks of points: a column of numbers for each coordinate.
//!
//! Points lie coordinate after coordinate, not one after the other: loops over a block are loops over arrays, which
//! compilers turn into vector instructions, and NumPy sees each coordinate as one contiguous array.

use std::ops::Range;

/// `len` points of `dim` coordinates each.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a> {
    numbers: &'a [f64],
    len: usize,
}

/// [`Columns`] to be written.
#[derive(Debug)]
pub struct ColumnsMut<'a> {
    numbers: &'a mut [f64],
    len: usize,
}

impl<'a> Columns<'a> {
    /// `numbers` as columns of `len` each.
    ///
    /// # Panics
    /// If they do not come out even.
    pub fn new(numbers: &'a [f64], len: usize) -> Self {
        assert_eq!(numbers.len() % len.max(1), 0, "columns of unequal length");
        Self { numbers, len }
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Are there no points?
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The number of coordinates of a point.
    pub fn dim(&self) -> usize {
        self.numbers.len().checked_div(self.len).unwrap_or(0)
    }

    /// Coordinate `j` of all points.
    #[inline]
    pub fn column(&self, j: usize) -> &'a [f64] {
        &self.numbers[j * self.len..(j + 1) * self.len]
    }

    /// Some of the coordinates of all points.
    #[inline]
    pub fn columns(&self, range: Range<usize>) -> Columns<'a> {
        Self { numbers: &self.numbers[range.start * self.len..range.end * self.len], len: self.len }
    }

    /// Coordinate `j` of point `i`.
    #[inline]
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.column(j)[i]
    }

    /// Writes point `i` to `point`, as many coordinates as it has room for.
    #[inline]
    pub fn read(&self, i: usize, point: &mut [f64]) {
        for (j, x) in point.iter_mut().enumerate() {
            *x = self.get(i, j);
        }
    }

    /// Point `i`, in a list of its own.
    pub fn point(&self, i: usize) -> Vec<f64> {
        (0..self.dim()).map(|j| self.get(i, j)).collect()
    }

    /// All numbers, column after column.
    pub fn numbers(&self) -> &'a [f64] {
        self.numbers
    }
}

impl<'a> ColumnsMut<'a> {
    /// `numbers` as columns of `len` each.
    ///
    /// # Panics
    /// If they do not come out even.
    pub fn new(numbers: &'a mut [f64], len: usize) -> Self {
        assert_eq!(numbers.len() % len.max(1), 0, "columns of unequal length");
        Self { numbers, len }
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Are there no points?
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The number of coordinates of a point.
    pub fn dim(&self) -> usize {
        self.numbers.len().checked_div(self.len).unwrap_or(0)
    }

    /// To be read.
    #[inline]
    pub fn as_columns(&self) -> Columns<'_> {
        Columns { numbers: self.numbers, len: self.len }
    }

    /// The same columns, borrowed for less long.
    #[inline]
    pub fn reborrow(&mut self) -> ColumnsMut<'_> {
        ColumnsMut { numbers: self.numbers, len: self.len }
    }

    /// Coordinate `j` of all points.
    #[inline]
    pub fn column(&mut self, j: usize) -> &mut [f64] {
        &mut self.numbers[j * self.len..(j + 1) * self.len]
    }

    /// Some of the coordinates of all points.
    #[inline]
    pub fn columns(&mut self, range: Range<usize>) -> ColumnsMut<'_> {
        ColumnsMut { numbers: &mut self.numbers[range.start * self.len..range.end * self.len], len: self.len }
    }

    /// Sets coordinate `j` of point `i`.
    #[inline]
    pub fn set(&mut self, i: usize, j: usize, x: f64) {
        self.column(j)[i] = x;
    }

    /// Sets point `i`.
    #[inline]
    pub fn write(&mut self, i: usize, point: &[f64]) {
        for (j, &x) in point.iter().enumerate() {
            self.set(i, j, x);
        }
    }

    /// All numbers, column after column.
    pub fn numbers(&mut self) -> &mut [f64] {
        self.numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_a_row() {
        let mut numbers = [0.0; 6];
        let mut columns = ColumnsMut::new(&mut numbers, 3);
        columns.write(1, &[5.0, 7.0]);
        columns.columns(1..2).set(2, 0, 9.0);
        assert_eq!(columns.dim(), 2);
        assert_eq!(columns.as_columns().point(1), [5.0, 7.0]);
        assert_eq!(columns.as_columns().columns(1..2).column(0), [0.0, 7.0, 9.0]);
        assert_eq!(numbers, [0.0, 5.0, 0.0, 0.0, 7.0, 9.0]);
    }

    #[test]
    fn no_points_have_no_columns() {
        assert_eq!(Columns::new(&[], 0).dim(), 0);
    }
}
