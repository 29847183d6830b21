//! Coordinates in which the samples are spread evenly: each axis by the quantiles of the first samples.

use std::f64::consts::TAU;

/// What kind of points there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// Real coordinates.
    Real,
    /// Unit vectors.
    Sphere,
}

impl Domain {
    /// Coordinates of a point, as many as it has degrees of freedom, in which volumes are those of the space
    /// but for a factor: on the sphere by Lambert's cylinder, (1 − z) / 2 and φ / 2π.
    pub fn coordinates(self, point: &[f64]) -> Vec<f64> {
        match (self, point) {
            (Self::Sphere, &[x, y, z]) => {
                // Near the upper pole 1 − z cancels.
                let depth = if z > 0.5 { (x * x + y * y) / (1.0 + z) } else { 1.0 - z };
                let turn = y.atan2(x) / TAU;
                vec![0.5 * depth, if turn < 0.0 { turn + 1.0 } else { turn }]
            }
            _ => point.to_vec(),
        }
    }

    /// The point at given coordinates.
    pub fn point(self, coordinates: &[f64]) -> Vec<f64> {
        match (self, coordinates) {
            (Self::Sphere, &[half_depth, turn]) => {
                let depth = 2.0 * half_depth;
                let r = (depth * (2.0 - depth)).max(0.0).sqrt();
                let (sin, cos) = (TAU * turn).sin_cos();
                vec![r * cos, r * sin, 1.0 - depth]
            }
            _ => coordinates.to_vec(),
        }
    }

    /// Where coordinates can lie, of a support that is real.
    pub fn sides(self, support: &[[f64; 2]]) -> Vec<[f64; 2]> {
        match self {
            Self::Real => support.to_vec(),
            Self::Sphere => vec![[0.0, 1.0]; 2],
        }
    }

    /// What a unit of volume of the coordinates measures.
    pub fn measure(self) -> f64 {
        match self {
            Self::Real => 1.0,
            Self::Sphere => 2.0 * TAU,
        }
    }

    /// A box of unit coordinates in words.
    pub fn describe(self, axes: &Axes, cell: &[[f64; 2]]) -> String {
        let corner = |end: usize| {
            let at: Vec<f64> = cell.iter().map(|side| side[end]).collect();
            self.point(&axes.at_unit(&at).0)
        };
        format!("{:.4?} to {:.4?}", corner(0), corner(1))
    }
}

/// For each coordinate the quantiles of the first samples, with a piece more at both ends that reaches as far
/// as the support, or as the samples are wide: knots of a piecewise linear map from [0, 1].
pub struct Axes(Vec<Vec<f64>>);

/// The pieces of an axis.
const PIECES: usize = 64;

impl Axes {
    /// - `sides`: of the support
    ///
    /// `None` if an axis has fewer than a handful of values, and so no density.
    pub fn of(points: &[Vec<f64>], sides: &[[f64; 2]]) -> Option<Self> {
        let axis = |j: usize| {
            let mut values: Vec<f64> = points.iter().map(|point| point[j]).collect();
            values.sort_by(f64::total_cmp);
            let mut knots: Vec<f64> = (0..=PIECES).map(|k| values[k * (values.len() - 1) / PIECES]).collect();
            let (low, high) = (knots[0], knots[PIECES]);
            let reach = high - low;
            knots.insert(0, if sides[j][0].is_finite() { sides[j][0].min(low) } else { low - reach });
            knots.push(if sides[j][1].is_finite() { sides[j][1].max(high) } else { high + reach });
            knots.dedup();
            (knots.len() > PIECES / 4).then_some(knots)
        };
        (0..points[0].len()).map(axis).collect::<Option<Vec<_>>>().map(Self)
    }

    /// Where in the unit cube coordinates lie; `None` outside, and for NaN.
    pub fn to_unit(&self, coordinates: &[f64]) -> Option<Vec<f64>> {
        let along = |(knots, &x): (&Vec<f64>, &f64)| {
            let pieces = knots.len() - 1;
            if !(x >= knots[0] && x <= knots[pieces]) {
                return None;
            }
            let k = (knots.partition_point(|&knot| knot <= x) - 1).min(pieces - 1);
            Some((k as f64 + (x - knots[k]) / (knots[k + 1] - knots[k])) / pieces as f64)
        };
        self.0.iter().zip(coordinates).map(along).collect()
    }

    /// Coordinates from the unit cube, and how much the map stretches volumes there.
    pub fn at_unit(&self, at: &[f64]) -> (Vec<f64>, f64) {
        let mut stretch = 1.0;
        let coordinates = self
            .0
            .iter()
            .zip(at)
            .map(|(knots, t)| {
                let pieces = knots.len() - 1;
                let scaled = t * pieces as f64;
                let k = (scaled as usize).min(pieces - 1);
                let width = knots[k + 1] - knots[k];
                stretch *= width * pieces as f64;
                knots[k] + (scaled - k as f64) * width
            })
            .collect();
        (coordinates, stretch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        let points: Vec<Vec<f64>> = (0..1000).map(|i| vec![f64::from(i * i), f64::from(i % 100)]).collect();
        let axes = Axes::of(&points, &[[0.0, f64::INFINITY], [-5.0, 99.0]]).unwrap();
        for point in &points {
            let back = axes.at_unit(&axes.to_unit(point).unwrap()).0;
            assert!(
                (0..2).all(|j| (back[j] - point[j]).abs() < 1e-9 * (1.0 + point[j])),
                "{point:?} {back:?}"
            );
        }
        assert_eq!(axes.to_unit(&[-1.0, 3.0]), None);
        assert!(Axes::of(&vec![vec![1.0]; 1000], &[[1.0, 1.0]]).is_none());
        let w = Domain::Sphere.point(&Domain::Sphere.coordinates(&[0.48, -0.6, 0.64]));
        assert!((w[0] - 0.48).abs() + (w[1] + 0.6).abs() + (w[2] - 0.64).abs() < 1e-14);
    }
}
