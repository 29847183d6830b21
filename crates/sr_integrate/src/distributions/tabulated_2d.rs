//! A table over a rectangle: a marginal density along x, and one along y for each column.

use super::bins::{Bins, locate, place};
use super::line::below_one;
use super::parameter::{ParameterError, width};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError, Inverse};
use crate::space::Space;

/// A density over a rectangle that is constant in each cell of a regular grid.
///
/// The first uniform picks x by the marginal density, the second y by the conditional density at that x.
#[derive(Clone, Debug)]
pub struct Tabulated2D {
    edges: [Vec<f64>; 2],
    along_x: Bins,
    /// For each x; `None` where there is nothing.
    along_y: Vec<Option<Bins>>,
    /// The density in each cell, y fastest.
    values: Vec<f64>,
    mean: [f64; 2],
}

impl Tabulated2D {
    /// - `values`: what the density is proportional to in each cell; y changes fastest, as in a histogram of
    ///   NumPy's `histogram2d`
    /// - `cells`: their number along x and along y
    /// - `low`, `high`: corners of the rectangle
    ///
    /// # Errors
    /// If the number of values is not that of the cells, one is negative or not finite, all are 0, or the
    /// rectangle has no width or height.
    pub fn new(
        values: &[f64],
        cells: [usize; 2],
        low: [f64; 2],
        high: [f64; 2],
    ) -> Result<Self, ParameterError> {
        super::parameter::checked_sum("values", values)?;
        let [nx, ny] = cells;
        if nx.checked_mul(ny) != Some(values.len()) {
            let need = format!("{nx} x {ny}");
            return Err(ParameterError::Length { argument: "values", len: values.len(), need });
        }
        let mut sides = [0.0; 2];
        for j in 0..2 {
            sides[j] = width(&format!("[low, high][{j}]"), low[j], high[j])?;
        }
        let edges = [0, 1].map(|j| {
            let edge = |i: usize| low[j] + sides[j] * (i as f64 / cells[j] as f64);
            let mut edges: Vec<f64> = (0..cells[j]).map(edge).collect();
            edges.push(high[j]);
            edges
        });
        for (j, edges) in edges.iter().enumerate() {
            for pair in edges.windows(2) {
                width(&format!("a cell along axis {j},"), pair[0], pair[1])?;
            }
        }
        let rows: Vec<f64> = values.chunks_exact(ny).map(|row| row.iter().sum()).collect();
        let (along_x, sum) = Bins::new("values", &rows)?;
        let mut along_y = Vec::with_capacity(nx);
        for (row, &sum) in values.chunks_exact(ny).zip(&rows) {
            along_y.push(if sum > 0.0 { Some(Bins::new("values", row)?.0) } else { None });
        }
        let mut mean = [0.0; 2];
        let mut density = Vec::with_capacity(values.len());
        for (i, row) in values.chunks_exact(ny).enumerate() {
            for (k, value) in row.iter().enumerate() {
                let share = value / sum;
                let cell = [(0, i), (1, k)].map(|(j, at)| (edges[j][at], edges[j][at + 1]));
                density.push(share / (cell[0].1 - cell[0].0) / (cell[1].1 - cell[1].0));
                for j in 0..2 {
                    mean[j] += share * (0.5 * cell[j].0 + 0.5 * cell[j].1);
                }
            }
        }
        for &value in &density {
            super::parameter::finite("the density of a cell", value)?;
        }
        Ok(Self { edges, along_x, along_y, values: density, mean })
    }

    /// The cell that holds a point.
    #[inline]
    fn cell(&self, x: f64, y: f64) -> Option<[usize; 2]> {
        Some([locate(&self.edges[0], x)?, locate(&self.edges[1], y)?])
    }

    #[inline]
    fn value(&self, [i, k]: [usize; 2]) -> f64 {
        self.values[i * (self.edges[1].len() - 1) + k]
    }
}

impl Density for Tabulated2D {
    fn space(&self) -> Space {
        Space::Plane
    }

    fn uniforms(&self) -> usize {
        2
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        for (i, pdf) in pdf.iter_mut().enumerate() {
            let at_x = self.along_x.pick(u.get(i, 0));
            let Some(along_y) = &self.along_y[at_x.index] else { unreachable!("never an empty column") };
            let at_y = along_y.pick(u.get(i, 1));
            x.set(i, 0, place(&self.edges[0], at_x.index, at_x.rest));
            x.set(i, 1, place(&self.edges[1], at_y.index, at_y.rest));
            *pdf = self.value([at_x.index, at_y.index]);
        }
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        for ((&x, &y), pdf) in x.column(0).iter().zip(x.column(1)).zip(pdf) {
            *pdf = self.cell(x, y).map_or(0.0, |cell| self.value(cell));
        }
        Ok(())
    }

    /// The rectangle.
    fn support(&self) -> Vec<[f64; 2]> {
        self.edges.iter().map(|edges| [edges[0], edges[edges.len() - 1]]).collect()
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        self.values.contains(&0.0).then(|| self.support())
    }

    fn mean(&self) -> Option<Vec<f64>> {
        Some(self.mean.to_vec())
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }
}

impl Inverse for Tabulated2D {
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        for i in 0..x.len() {
            let point = [x.get(i, 0), x.get(i, 1)];
            let inverted =
                self.cell(point[0], point[1]).filter(|&cell| self.value(cell) > 0.0).and_then(|cell| {
                    let rest = [0, 1].map(|j| {
                        let (low, high) = (self.edges[j][cell[j]], self.edges[j][cell[j] + 1]);
                        (point[j] - low) / (high - low)
                    });
                    let along_y = self.along_y[cell[0]].as_ref()?;
                    Some(
                        [self.along_x.unpick(cell[0], rest[0]), along_y.unpick(cell[1], rest[1])]
                            .map(below_one),
                    )
                });
            u.write(i, &inverted.unwrap_or([f64::NAN; 2]));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_index_is_the_second_coordinate() {
        let p = Tabulated2D::new(&[1.0, 0.0, 3.0, 2.0, 0.0, 6.0], [2, 3], [0.0, -1.0], [4.0, 2.0]).unwrap();
        let x = [1.0, 1.0, 1.0, 3.0, 3.0, 4.0, -0.1, f64::NAN];
        let y = [-0.5, 0.5, 1.5, -0.5, 0.5, 2.0, 0.0, 0.0];
        let mut pdf = [0.0; 8];
        p.pdf(Columns::new(&[x, y].concat(), 8), &mut pdf).unwrap();
        for (pdf, value) in pdf.into_iter().zip([1.0, 0.0, 3.0, 2.0, 0.0, 6.0, 0.0, 0.0]) {
            assert!((pdf - value / 24.0).abs() < 1e-15, "{pdf} {value}");
        }
        assert_eq!(p.domain(), Some(vec![[0.0, 4.0], [-1.0, 2.0]]));
        assert!((p.mean().unwrap()[0] - (1.0 / 3.0 + 2.0)).abs() < 1e-14);
    }

    #[test]
    fn errors_name_the_values() {
        let error = |values: &[f64], cells| {
            Tabulated2D::new(values, cells, [0.0; 2], [1.0; 2]).unwrap_err().to_string()
        };
        assert!(error(&[1.0; 5], [2, 3]).starts_with("values has 5 entries; it must have 2 x 3"));
        assert!(error(&[], [0, 0]).starts_with("values has 0 entries"));
        assert!(error(&[1.0, -1.0], [1, 2]).starts_with("values[1] is -1"));
        assert!(error(&[0.0, 0.0], [1, 2]).contains("all 0"));
        assert!(Tabulated2D::new(&[1.0], [1, 1], [0.0, 3.0], [1.0, 3.0]).is_err());
    }
}
