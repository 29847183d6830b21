//! A density on the unit cube that is a product along its own axes.

use super::axis::Axis;
use crate::columns::{Columns, ColumnsMut};

/// A product of densities along the coordinates of the cube, or along turned ones.
///
/// Along turned axes part of it lies outside the cube, where nothing is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    axes: Vec<Axis>,
    frame: Option<Frame>,
}

/// Turned coordinates: x = centre + R y.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The origin of y.
    pub centre: Vec<f64>,
    /// R, orthonormal, row after row.
    pub rotation: Vec<f64>,
}

impl Frame {
    /// The interval of each turned coordinate that the cube needs.
    pub fn ranges(&self) -> Vec<[f64; 2]> {
        let d = self.centre.len();
        (0..d)
            .map(|j| {
                (0..d).fold([0.0; 2], |[low, high], k| {
                    let (r, c) = (self.rotation[k * d + j], self.centre[k]);
                    let (a, b) = (-r * c, r * (1.0 - c));
                    [low + a.min(b), high + a.max(b)]
                })
            })
            .collect()
    }

    /// x = centre + R y.
    fn to_cube(&self, y: &[f64], mut x: ColumnsMut<'_>) {
        let (d, n) = (self.centre.len(), x.len());
        for k in 0..d {
            let column = x.column(k);
            column.fill(self.centre[k]);
            for j in 0..d {
                let r = self.rotation[k * d + j];
                for (x, y) in column.iter_mut().zip(&y[j * n..(j + 1) * n]) {
                    *x += r * y;
                }
            }
        }
    }

    /// y = Rᵀ (x − centre), coordinate `j`.
    fn along(&self, x: Columns<'_>, j: usize, y: &mut [f64]) {
        let d = self.centre.len();
        y.fill(0.0);
        for k in 0..d {
            let (r, c) = (self.rotation[k * d + j], self.centre[k]);
            for (y, x) in y.iter_mut().zip(x.column(k)) {
                *y += r * (x - c);
            }
        }
    }
}

impl Component {
    /// Along the coordinates of the cube (`None`) or turned ones.
    pub fn new(axes: Vec<Axis>, frame: Option<Frame>) -> Self {
        Self { axes, frame }
    }

    /// The constant density.
    pub fn uniform(dim: usize) -> Self {
        Self::new(vec![Axis::uniform([0.0, 1.0]); dim], None)
    }

    /// The density along each axis.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The axes' directions; those of the cube if there is none.
    pub fn frame(&self) -> Option<&Frame> {
        self.frame.as_ref()
    }

    /// The same axes with other densities along them.
    pub fn with_axes(&self, axes: Vec<Axis>) -> Self {
        Self { axes, frame: self.frame.clone() }
    }

    /// Draws a point from each row of `u`: its place, and this component's density there. Points may lie outside the
    /// cube.
    pub fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) {
        let n = u.len();
        pdf.fill(1.0);
        if let Some(frame) = &self.frame {
            let mut y = vec![0.0; n * self.axes.len()];
            for (j, axis) in self.axes.iter().enumerate() {
                axis.map(u.column(j), &mut y[j * n..(j + 1) * n], pdf);
            }
            frame.to_cube(&y, x);
        } else {
            for (j, axis) in self.axes.iter().enumerate() {
                axis.map(u.column(j), x.column(j), pdf);
            }
        }
        pdf.iter_mut().for_each(|pdf| *pdf = 1.0 / *pdf);
    }

    /// The uniforms that [`Component::sample`] maps to each point, and the density there.
    pub fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>, pdf: &mut [f64]) {
        pdf.fill(1.0);
        let mut y = vec![0.0; if self.frame.is_some() { x.len() } else { 0 }];
        for (j, axis) in self.axes.iter().enumerate() {
            if let Some(frame) = &self.frame {
                frame.along(x, j, &mut y);
                axis.unmap(&y, u.column(j), pdf);
            } else {
                axis.unmap(x.column(j), u.column(j), pdf);
            }
        }
        pdf.iter_mut().for_each(|pdf| *pdf = 1.0 / *pdf);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_component_runs_backwards() {
        let (c, s) = (0.6, 0.8);
        let frame = Frame { centre: vec![0.3, 0.4], rotation: vec![c, -s, s, c] };
        let ranges = frame.ranges();
        let axes =
            vec![Axis::bell(0.0, 0.1, ranges[0], 32, 0.01), Axis::bell(0.1, 0.02, ranges[1], 32, 0.01)];
        let component = Component::new(axes, Some(frame));
        let u: Vec<f64> = (0..400).map(|i| (f64::from(i) * 0.618_033_988) % 1.0).collect();
        let (mut x, mut pdf) = (vec![0.0; 400], vec![0.0; 200]);
        component.sample(Columns::new(&u, 200), ColumnsMut::new(&mut x, 200), &mut pdf);
        let (mut back, mut again) = (vec![0.0; 400], vec![0.0; 200]);
        component.invert(Columns::new(&x, 200), ColumnsMut::new(&mut back, 200), &mut again);
        for i in 0..400 {
            assert!((u[i] - back[i]).abs() < 1e-9);
            assert!((pdf[i % 200] / again[i % 200] - 1.0).abs() < 1e-6);
        }
    }
}
