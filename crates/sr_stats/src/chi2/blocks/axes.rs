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

/// For each coordinate a piecewise linear map from [0, 1], in which the first samples are spread evenly, with a piece more
/// at both ends that reaches as far as the support, or as the samples are wide.
///
/// Each piece has the share of [0, 1] that it has of the samples, so that how much the map stretches volumes, times the
/// density, is about 1 everywhere, and stays so when many axes multiply. Three things keep it there: towards the ends
/// pieces become shorter, as densities of tails differ by orders of magnitude within a long one; the pieces beyond the
/// samples, in which there is next to nothing, have the smaller a share the more axes there are; and there must be enough
/// samples for all pieces of all axes, see [`Axes::samples`].
pub struct Axes(Vec<Axis>);

/// Of one coordinate: knots, and where in [0, 1] they lie.
struct Axis {
    knots: Vec<f64>,
    at: Vec<f64>,
}

/// The pieces of an axis that hold equally many samples, before those at its ends are cut further …
const PIECES: usize = 64;
/// … down to pieces of so many samples.
const FEW: usize = 4;
/// The share of a piece beyond the samples, up to [`FULL_ENDS`] axes; of more axes, all of these pieces have as much.
const END: f64 = 0.015;
const FULL_ENDS: usize = 4;

impl Axes {
    /// How many samples it takes to know this many axes, none of them so ill that their product is noise: the density in
    /// a piece of c samples is off by a factor 1 ± 1/√c, and on [`PIECES`] pieces of each axis that adds up.
    pub fn samples(axes: usize, at_least: usize) -> usize {
        at_least.max(8 * PIECES * axes)
    }

    /// - `sides`: of the support
    ///
    /// `None` if an axis has fewer than a handful of values, and so no density.
    pub fn of(points: &[Vec<f64>], sides: &[[f64; 2]]) -> Option<Self> {
        let end = END * (FULL_ENDS as f64 / sides.len().max(FULL_ENDS) as f64);
        let axis = |j: usize| {
            let mut values: Vec<f64> = points.iter().map(|point| point[j]).collect();
            values.sort_by(f64::total_cmp);
            let (low, high) = (values[0], values[values.len() - 1]);
            let reach = high - low;
            let mut knots = Vec::with_capacity(PIECES + 16);
            let mut widths = Vec::with_capacity(PIECES + 16);
            let first = if sides[j][0].is_finite() { sides[j][0].min(low) } else { low - reach };
            let last = if sides[j][1].is_finite() { sides[j][1].max(high) } else { high + reach };
            if first < low {
                knots.push(first);
                widths.push(end);
            }
            knots.push(low);
            let mut rank = 0;
            for next in ranks(values.len()) {
                if values[next] > values[rank] {
                    knots.push(values[next]);
                    widths.push((next - rank) as f64 / (values.len() - 1) as f64);
                }
                rank = next;
            }
            if last > high {
                knots.push(last);
                widths.push(end);
            }
            (knots.len() > PIECES / 4).then(|| Axis::new(knots, &widths))
        };
        (0..points[0].len()).map(axis).collect::<Option<Vec<_>>>().map(Self)
    }

    /// Where in the unit cube coordinates lie; `None` outside, and for NaN.
    pub fn to_unit(&self, coordinates: &[f64]) -> Option<Vec<f64>> {
        self.0.iter().zip(coordinates).map(|(axis, &x)| axis.to_unit(x)).collect()
    }

    /// Coordinates from the unit cube, and how much the map stretches volumes there.
    pub fn at_unit(&self, at: &[f64]) -> (Vec<f64>, f64) {
        let mut stretch = 1.0;
        let along = |(axis, t): (&Axis, &f64)| {
            let (x, slope) = axis.at_unit(*t);
            stretch *= slope;
            x
        };
        let coordinates = self.0.iter().zip(at).map(along).collect();
        (coordinates, stretch)
    }
}

impl Axis {
    /// `widths`: of the pieces in the unit interval, in any unit.
    fn new(knots: Vec<f64>, widths: &[f64]) -> Self {
        let total: f64 = widths.iter().sum();
        let mut at = vec![0.0];
        at.extend(widths.iter().scan(0.0, |sum, width| {
            *sum += width / total;
            Some(*sum)
        }));
        if let Some(last) = at.last_mut() {
            *last = 1.0;
        }
        Self { knots, at }
    }

    fn to_unit(&self, x: f64) -> Option<f64> {
        let Self { knots, at } = self;
        let pieces = knots.len() - 1;
        if !(x >= knots[0] && x <= knots[pieces]) {
            return None;
        }
        let k = (knots.partition_point(|&knot| knot <= x) - 1).min(pieces - 1);
        Some(at[k] + (x - knots[k]) / (knots[k + 1] - knots[k]) * (at[k + 1] - at[k]))
    }

    /// The coordinate, and the slope of the map.
    fn at_unit(&self, t: f64) -> (f64, f64) {
        let Self { knots, at } = self;
        let pieces = knots.len() - 1;
        let k = at.partition_point(|&start| start <= t).clamp(1, pieces) - 1;
        let slope = (knots[k + 1] - knots[k]) / (at[k + 1] - at[k]);
        (knots[k] + (t - at[k]) * slope, slope)
    }
}

/// Ranks of the samples that are knots, the first aside: even ones, and more towards both ends.
fn ranks(len: usize) -> Vec<usize> {
    let last = len - 1;
    let mut ranks: Vec<usize> = (1..PIECES).map(|k| k * last / PIECES).collect();
    let mut tail = last / PIECES / 2;
    while tail >= FEW {
        ranks.extend([tail, last - tail]);
        tail /= 2;
    }
    ranks.push(last);
    ranks.sort_unstable();
    ranks.dedup();
    ranks
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
        let ends = |t: f64| axes.at_unit(&[t, t]).0;
        assert_eq!((ends(0.0)[1], ends(1.0)[1]), (-5.0, 99.0));
        assert!(Axes::of(&vec![vec![1.0]; 1000], &[[1.0, 1.0]]).is_none());
        let w = Domain::Sphere.point(&Domain::Sphere.coordinates(&[0.48, -0.6, 0.64]));
        assert!((w[0] - 0.48).abs() + (w[1] + 0.6).abs() + (w[2] - 0.64).abs() < 1e-14);
    }
}
