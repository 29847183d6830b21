//! x = A y + b: stretched, turned, moved.

use std::sync::Arc;

use super::parameter::{ParameterError, bad, finite, positive};
use super::truncated::truncate;
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Cumulative, Density, DensityError, Inverse};
use crate::space::Space;

/// The distribution of A y + b, where y follows another; pdf(x) = pdf(y) / |det A|.
#[derive(Clone, Debug)]
pub struct Affine {
    of: Arc<dyn Density>,
    /// Row after row.
    matrix: Vec<f64>,
    inverse: Vec<f64>,
    offset: Vec<f64>,
    /// 1 / |det A|.
    scale: f64,
}

/// Of 16 digits so many may cancel where a point is traced back: ten.
const WORST_CONDITION: f64 = 1e10;

impl Affine {
    /// - `matrix`: A, square, row after row
    /// - `offset`: b
    ///
    /// # Errors
    /// If the density is not one of length, area in the plane or volume, a number is not finite, their counts
    /// do not fit the dimension, or A cannot be inverted.
    pub fn new(of: Arc<dyn Density>, matrix: Vec<f64>, offset: Vec<f64>) -> Result<Self, ParameterError> {
        let space = of.space();
        if !space.is_real() {
            let need = "length, area in the plane or volume".into();
            return Err(ParameterError::WrongSpace {
                argument: "the density to be transformed".into(),
                space,
                need,
            });
        }
        let dim = space.dim();
        for (argument, len, need) in [("matrix", matrix.len(), dim * dim), ("offset", offset.len(), dim)] {
            if len != need {
                return Err(ParameterError::Length {
                    argument,
                    len,
                    need: format!("{need}, for {dim} dimensions"),
                });
            }
        }
        for (i, &a) in matrix.iter().enumerate() {
            finite(&format!("matrix[{}, {}]", i / dim, i % dim), a)?;
        }
        for (i, &b) in offset.iter().enumerate() {
            finite(&format!("offset[{i}]"), b)?;
        }
        let (inverse, determinant) = invert_matrix(&matrix, dim)?;
        positive("the size of the determinant of matrix", determinant.abs())?;
        // How much larger than a coordinate of y the terms are that it is the sum of; units of x and y do not matter.
        let cancels =
            |i: usize| (0..dim).map(|j| (inverse[i * dim + j] * matrix[j * dim + i]).abs()).sum::<f64>();
        let condition = (0..dim).map(cancels).fold(0.0, f64::max);
        if !(condition < WORST_CONDITION) {
            let what = format!(
                "can hardly be inverted: its rows are nearly multiples of one another, or sums of such, and {} digits \
                 of every point would be lost",
                condition.log10().ceil()
            );
            return Err(ParameterError::Shape { argument: "matrix", what });
        }
        Ok(Self { of, matrix, inverse, offset, scale: determinant.abs().recip() })
    }

    /// A y + b of all points.
    fn forward(&self, y: Columns<'_>, mut x: ColumnsMut<'_>) {
        let dim = self.offset.len();
        for (i, &offset) in self.offset.iter().enumerate() {
            let column = x.column(i);
            column.fill(offset);
            for (j, &a) in self.matrix[i * dim..(i + 1) * dim].iter().enumerate().filter(|(_, a)| **a != 0.0)
            {
                for (x, y) in column.iter_mut().zip(y.column(j)) {
                    *x += a * y;
                }
            }
        }
    }

    /// A⁻¹ (x − b) of all points, column after column.
    fn backward(&self, x: Columns<'_>) -> Vec<f64> {
        let (dim, len) = (self.offset.len(), x.len());
        let mut y = vec![0.0; dim * len];
        for i in 0..dim {
            let column = &mut y[i * len..(i + 1) * len];
            for (j, &a) in self.inverse[i * dim..(i + 1) * dim].iter().enumerate().filter(|(_, a)| **a != 0.0)
            {
                let offset = self.offset[j];
                for (y, x) in column.iter_mut().zip(x.column(j)) {
                    *y += a * (x - offset);
                }
            }
        }
        y
    }

    /// The least box that holds the image of a box.
    fn image(&self, sides: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let dim = self.offset.len();
        let side = |i: usize| {
            let (mut low, mut high) = (self.offset[i], self.offset[i]);
            for (&a, side) in
                self.matrix[i * dim..(i + 1) * dim].iter().zip(sides).filter(|(a, _)| **a != 0.0)
            {
                low += (a * side[0]).min(a * side[1]);
                high += (a * side[0]).max(a * side[1]);
            }
            [low, high]
        };
        (0..dim).map(side).collect()
    }

    /// In one dimension: the distribution function of y, and y.
    fn on_line(&self, x: f64) -> (&dyn Cumulative, f64) {
        (self.cumulative_of(), (x - self.offset[0]) / self.matrix[0])
    }

    fn cumulative_of(&self) -> &dyn Cumulative {
        self.of.cumulative().expect("asked for by `Density::cumulative`")
    }

    fn out(&self, y: f64) -> f64 {
        self.matrix[0] * y + self.offset[0]
    }

    fn falls(&self) -> bool {
        self.matrix[0] < 0.0
    }
}

impl Density for Affine {
    fn space(&self) -> Space {
        self.of.space()
    }

    fn uniforms(&self) -> usize {
        self.of.uniforms()
    }

    fn sample(&self, u: Columns<'_>, x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let mut y = vec![0.0; x.len() * x.dim()];
        self.of.sample(u, ColumnsMut::new(&mut y, x.len()), pdf)?;
        self.forward(Columns::new(&y, x.len()), x);
        pdf.iter_mut().for_each(|pdf| *pdf *= self.scale);
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let y = self.backward(x);
        self.of.pdf(Columns::new(&y, x.len()), pdf)?;
        pdf.iter_mut().for_each(|pdf| *pdf *= self.scale);
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.image(&self.of.support())
    }

    /// Of a table that is turned, the corners of the box around it are no part.
    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        let dim = self.offset.len();
        let straight = (0..dim).all(|i| (0..dim).filter(|j| self.matrix[i * dim + j] != 0.0).count() == 1);
        if straight { self.of.domain().map(|sides| self.image(&sides)) } else { None }
    }

    fn mean(&self) -> Option<Vec<f64>> {
        let y = self.of.mean()?;
        let mut x = vec![0.0; y.len()];
        self.forward(Columns::new(&y, 1), ColumnsMut::new(&mut x, 1));
        Some(x)
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        self.of.inverse().map(|_| self as &dyn Inverse)
    }

    fn cumulative(&self) -> Option<&dyn Cumulative> {
        self.of.cumulative().map(|_| self as &dyn Cumulative)
    }
}

impl Inverse for Affine {
    fn invert(&self, x: Columns<'_>, u: ColumnsMut<'_>) -> Result<(), DensityError> {
        let y = self.backward(x);
        let of = self.of.inverse().expect("asked for by `Density::inverse`");
        of.invert(Columns::new(&y, x.len()), u)
    }
}

impl Cumulative for Affine {
    fn cdf(&self, x: f64) -> f64 {
        let (of, y) = self.on_line(x);
        if self.falls() { of.above(y) } else { of.cdf(y) }
    }

    fn icdf(&self, u: f64) -> f64 {
        let of = self.cumulative_of();
        self.out(if self.falls() { of.inverse_above(u) } else { of.icdf(u) })
    }

    fn above(&self, x: f64) -> f64 {
        let (of, y) = self.on_line(x);
        if self.falls() { of.cdf(y) } else { of.above(y) }
    }

    fn inverse_above(&self, q: f64) -> f64 {
        let of = self.cumulative_of();
        self.out(if self.falls() { of.icdf(q) } else { of.inverse_above(q) })
    }

    fn between(&self, low: f64, high: f64) -> Option<Result<Arc<dyn Density>, ParameterError>> {
        let [a, b] = [low, high].map(|x| self.on_line(x).1);
        let cut = truncate(self.of.clone(), a.min(b), a.max(b));
        Some(cut.map(|of| Arc::new(Self { of, ..self.clone() }) as Arc<dyn Density>))
    }
}

/// The inverse of a square matrix, row after row, and its determinant: Gauss and Jordan's elimination with
/// the largest pivot of each column.
pub(crate) fn invert_matrix(matrix: &[f64], dim: usize) -> Result<(Vec<f64>, f64), ParameterError> {
    let mut a = matrix.to_vec();
    let mut inverse: Vec<f64> = (0..dim * dim).map(|i| f64::from(u8::from(i / dim == i % dim))).collect();
    let mut determinant = 1.0;
    // Each row by its largest number, so that units of length do not matter.
    let sizes: Vec<f64> =
        matrix.chunks_exact(dim).map(|row| row.iter().fold(0.0, |m: f64, a| m.max(a.abs()))).collect();
    if let Some(i) = sizes.iter().position(|&size| size == 0.0) {
        return Err(bad(format!("row {i} of matrix"), 0.0, "other than 0"));
    }
    let mut order: Vec<usize> = (0..dim).collect();
    for column in 0..dim {
        let size = |row: usize| a[row * dim + column].abs() / sizes[order[row]];
        let pivot = (column..dim).max_by(|&i, &j| size(i).total_cmp(&size(j))).unwrap_or(column);
        if !(size(pivot) > 1e-13) {
            let what = "cannot be inverted: its rows are multiples of one another, or sums of such".into();
            return Err(ParameterError::Shape { argument: "matrix", what });
        }
        if pivot != column {
            order.swap(pivot, column);
            for k in 0..dim {
                a.swap(pivot * dim + k, column * dim + k);
                inverse.swap(pivot * dim + k, column * dim + k);
            }
            determinant = -determinant;
        }
        let divisor = a[column * dim + column];
        determinant *= divisor;
        for k in 0..dim {
            a[column * dim + k] /= divisor;
            inverse[column * dim + k] /= divisor;
        }
        for row in (0..dim).filter(|&row| row != column) {
            let factor = a[row * dim + column];
            for k in 0..dim {
                a[row * dim + k] -= factor * a[column * dim + k];
                inverse[row * dim + k] -= factor * inverse[column * dim + k];
            }
        }
    }
    Ok((inverse, determinant))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distributions::{Exponential, Normal, UniformBox};

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        let a = [0.0, 2.0, 1e-9, 3.0, -1.0, 0.5, 1e6, 2e6, 0.0];
        let (inverse, determinant) = invert_matrix(&a, 3).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let sum: f64 = (0..3).map(|k| a[3 * i + k] * inverse[3 * k + j]).sum();
                assert!((sum - f64::from(u8::from(i == j))).abs() < 1e-9, "{i}, {j}: {sum}");
            }
        }
        // Along the first row: −2 · (3 · 0 − 0.5 · 10⁶) + 10⁻⁹ · (3 · 2 · 10⁶ + 10⁶).
        assert!((determinant / 1_000_000.007 - 1.0).abs() < 1e-14, "{determinant}");
        assert!(invert_matrix(&[1.0, 2.0, 2.0, 4.0], 2).is_err());
        assert!((invert_matrix(&[0.0, 2.0, 3.0, 1.0], 2).unwrap().1 + 6.0).abs() < 1e-15);
    }

    #[test]
    fn a_falling_line_keeps_both_tails() {
        let affine = Affine::new(Arc::new(Exponential::new(1.0).unwrap()), vec![-2.0], vec![3.0]).unwrap();
        assert_eq!(affine.support(), [[f64::NEG_INFINITY, 3.0]]);
        assert!((affine.cdf(-997.0) / (-500.0_f64).exp() - 1.0).abs() < 1e-12);
        assert!((affine.icdf(affine.cdf(-997.0)) + 997.0).abs() < 1e-9);
        assert!((affine.above(2.0) + (-0.5_f64).exp_m1()).abs() < 1e-15);
        assert_eq!(affine.mean(), Some(vec![1.0]));
        let cut = truncate(Arc::new(affine), -1000.0, -997.0).unwrap();
        assert!((cut.cumulative().unwrap().icdf(1.0) + 997.0).abs() < 1e-9);
        let normal = Affine::new(Arc::new(Normal::new(0.0, 1.0).unwrap()), vec![2.0], vec![0.0]).unwrap();
        assert!(truncate(Arc::new(normal), 80.0, 90.0).is_ok());
    }

    #[test]
    fn a_turned_box() {
        let unit = Arc::new(UniformBox::new(&[[0.0, 1.0]; 2]).unwrap());
        let turned = Affine::new(unit, vec![1.0, -1.0, 1.0, 1.0], vec![10.0, 0.0]).unwrap();
        let (mut x, mut pdf, mut u) = ([0.0; 2], [0.0], [0.0; 2]);
        turned.sample(Columns::new(&[0.25, 0.5], 1), ColumnsMut::new(&mut x, 1), &mut pdf).unwrap();
        assert_eq!((x, pdf), ([9.75, 0.75], [0.5]));
        turned.invert(Columns::new(&x, 1), ColumnsMut::new(&mut u, 1)).unwrap();
        assert_eq!(u, [0.25, 0.5]);
        assert_eq!(turned.support(), [[9.0, 11.0], [0.0, 2.0]]);
        turned.pdf(Columns::new(&[9.1, 0.1], 1), &mut pdf).unwrap();
        assert_eq!(pdf, [0.0]);
    }

    #[test]
    fn errors_name_the_argument() {
        let unit = || Arc::new(UniformBox::new(&[[0.0, 1.0]; 2]).unwrap());
        let text =
            |matrix: Vec<f64>, offset: Vec<f64>| Affine::new(unit(), matrix, offset).unwrap_err().to_string();
        assert!(text(vec![1.0; 3], vec![0.0; 2]).starts_with("matrix has 3 entries; it must have 4"));
        assert!(text(vec![1.0, 0.0, 0.0, f64::NAN], vec![0.0; 2]).starts_with("matrix[1, 1] is NaN"));
        assert!(text(vec![1.0; 4], vec![0.0; 2]).starts_with("matrix cannot be inverted"));
        let nearly = text(vec![1.0, 1.0, 1.0, 1.0 + 1e-12], vec![0.0; 2]);
        assert!(
            nearly.starts_with("matrix can hardly be inverted") && nearly.contains("and 13 digits"),
            "{nearly}"
        );
        assert!(
            Affine::new(unit(), vec![1e-12, 0.0, 0.0, 1e12], vec![0.0; 2]).is_ok(),
            "units do not matter"
        );
        assert!(text(vec![1.0, 0.0, 0.0, 0.0], vec![0.0; 2]).starts_with("row 1 of matrix is 0"));
        assert!(text(vec![1.0, 0.0, 0.0, 1.0], vec![0.0]).starts_with("offset has 1"));
    }
}
