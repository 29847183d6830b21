//! Densities from tables of numbers on the line: constant, or linear, between neighbours.

use super::bins::{Bins, locate, place};
use super::line::OnLine;
use super::linear::{cdf_of_unit, icdf_of_unit};
use super::parameter::{ParameterError, bad, finite, width};
use crate::density::Cumulative;

/// Checks that each edge is finite and lies above the one before it.
fn check_edges(argument: &'static str, edges: &[f64]) -> Result<(), ParameterError> {
    for (i, &edge) in edges.iter().enumerate() {
        finite(&format!("{argument}[{i}]"), edge)?;
        if i > 0 && edge <= edges[i - 1] {
            return Err(bad(format!("{argument}[{i}]"), edge, "above the one before"));
        }
        if i > 0 {
            width(&format!("{argument}[{}..={i}]", i - 1), edges[i - 1], edge)?;
        }
    }
    width(argument, edges[0], edges[edges.len() - 1]).map(|_| ())
}

/// A histogram as a density: constant in each bin, whose widths may differ; pdf = count / (sum of counts ·
/// width).
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseConstant {
    edges: Vec<f64>,
    /// The density in each bin.
    values: Vec<f64>,
    bins: Bins,
}

impl PiecewiseConstant {
    /// - `edges`: n + 1 numbers, each above the one before
    /// - `counts`: how much lies in each of the n bins, in any unit
    ///
    /// # Errors
    /// If there is no bin, the numbers of edges and counts do not fit, an edge is not finite or not above the
    /// one before, a count is negative or not finite, or all are 0.
    pub fn new(edges: Vec<f64>, counts: &[f64]) -> Result<Self, ParameterError> {
        let (bins, sum) = Bins::new("counts", counts)?;
        if edges.len() != counts.len() + 1 {
            let need = format!("{}, one more than there are counts", counts.len() + 1);
            return Err(ParameterError::Length { argument: "edges", len: edges.len(), need });
        }
        check_edges("edges", &edges)?;
        let values: Vec<f64> =
            counts.iter().zip(edges.windows(2)).map(|(c, e)| c / sum / (e[1] - e[0])).collect();
        for (i, &value) in values.iter().enumerate() {
            finite(&format!("the density of bin {i}"), value)?;
        }
        Ok(Self { edges, values, bins })
    }
}

impl OnLine for PiecewiseConstant {
    #[inline]
    fn density(&self, x: f64) -> f64 {
        locate(&self.edges, x).map_or(0.0, |i| self.values[i])
    }

    fn ends(&self) -> [f64; 2] {
        let first = self.values.iter().position(|&v| v > 0.0).unwrap_or(0);
        let last = self.values.iter().rposition(|&v| v > 0.0).unwrap_or(0);
        [self.edges[first], self.edges[last + 1]]
    }

    fn expected(&self) -> Option<f64> {
        let share = |i: usize| self.bins.below(i + 1) - self.bins.below(i);
        Some((0..self.bins.len()).map(|i| share(i) * (0.5 * self.edges[i] + 0.5 * self.edges[i + 1])).sum())
    }

    fn range(&self) -> Option<[f64; 2]> {
        self.values.contains(&0.0).then(|| [self.edges[0], self.edges[self.bins.len()]])
    }
}

impl Cumulative for PiecewiseConstant {
    fn cdf(&self, x: f64) -> f64 {
        match locate(&self.edges, x) {
            Some(i) => {
                self.bins.unpick(i, (x - self.edges[i]) / (self.edges[i + 1] - self.edges[i])).min(1.0)
            }
            None => f64::from(u8::from(x > self.edges[0])),
        }
    }

    fn icdf(&self, u: f64) -> f64 {
        if u >= 1.0 {
            return self.ends()[1];
        }
        let picked = self.bins.pick(u);
        place(&self.edges, picked.index, picked.rest)
    }
}

/// A density that is linear between the points of a table, and 0 beyond them.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    x: Vec<f64>,
    /// The density at each.
    y: Vec<f64>,
    bins: Bins,
}

impl PiecewiseLinear {
    /// - `x`: n ≥ 2 numbers, each above the one before
    /// - `y`: what the density is proportional to at each
    ///
    /// # Errors
    /// If there are fewer than two points, the numbers of x and y do not fit, an x is not finite or not above
    /// the one before, a y is negative or not finite, or all are 0.
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Result<Self, ParameterError> {
        if x.len() < 2 {
            return Err(ParameterError::Length { argument: "x", len: x.len(), need: "at least 2".into() });
        }
        if y.len() != x.len() {
            let need = format!("{}, as many as x", x.len());
            return Err(ParameterError::Length { argument: "y", len: y.len(), need });
        }
        check_edges("x", &x)?;
        super::parameter::checked_sum("y", &y)?;
        let largest = y.iter().fold(0.0, |a: f64, &b| a.max(b));
        let segment = |i: usize| (0.5 * (y[i] / largest) + 0.5 * (y[i + 1] / largest)) * (x[i + 1] - x[i]);
        let areas: Vec<f64> = (0..x.len() - 1).map(segment).collect();
        let (bins, area) = Bins::new("areas under the segments of y", &areas)?;
        let y: Vec<f64> = y.iter().map(|y| y / largest / area).collect();
        for (i, &value) in y.iter().enumerate() {
            finite(&format!("the density at x[{i}]"), value)?;
        }
        Ok(Self { x, y, bins })
    }

    /// The values at the ends of a segment, scaled to a mean of 1.
    fn shape(&self, i: usize) -> [f64; 2] {
        let (a, b) = (self.y[i], self.y[i + 1]);
        let mean = 0.5 * a + 0.5 * b;
        [a / mean, b / mean]
    }
}

impl OnLine for PiecewiseLinear {
    #[inline]
    fn density(&self, x: f64) -> f64 {
        locate(&self.x, x).map_or(0.0, |i| {
            let t = (x - self.x[i]) / (self.x[i + 1] - self.x[i]);
            self.y[i] * (1.0 - t) + self.y[i + 1] * t
        })
    }

    fn ends(&self) -> [f64; 2] {
        let last = self.bins.len();
        let first = (0..last).find(|&i| self.y[i + 1] > 0.0 || self.y[i] > 0.0).unwrap_or(0);
        let end = (0..last).rfind(|&i| self.y[i] > 0.0 || self.y[i + 1] > 0.0).unwrap_or(0);
        [self.x[first], self.x[end + 1]]
    }

    fn expected(&self) -> Option<f64> {
        let part = |i: usize| {
            let [a, b] = self.shape(i);
            let share = self.bins.below(i + 1) - self.bins.below(i);
            if share > 0.0 {
                share * (self.x[i] + (self.x[i + 1] - self.x[i]) * (a + 2.0 * b) / 6.0)
            } else {
                0.0
            }
        };
        Some((0..self.bins.len()).map(part).sum())
    }

    /// A segment may be empty.
    fn range(&self) -> Option<[f64; 2]> {
        let empty = self.y.windows(2).any(|pair| pair == [0.0; 2]);
        empty.then(|| [self.x[0], self.x[self.bins.len()]])
    }
}

impl Cumulative for PiecewiseLinear {
    fn cdf(&self, x: f64) -> f64 {
        match locate(&self.x, x) {
            Some(i) if self.y[i] > 0.0 || self.y[i + 1] > 0.0 => {
                let t = (x - self.x[i]) / (self.x[i + 1] - self.x[i]);
                self.bins.unpick(i, cdf_of_unit(t, self.shape(i))).min(1.0)
            }
            Some(i) => self.bins.below(i),
            None => f64::from(u8::from(x > self.x[0])),
        }
    }

    fn icdf(&self, u: f64) -> f64 {
        if u >= 1.0 {
            return self.ends()[1];
        }
        let picked = self.bins.pick(u);
        place(&self.x, picked.index, icdf_of_unit(picked.rest, self.shape(picked.index)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_histogram_is_count_over_width() {
        let p = PiecewiseConstant::new(vec![-1.0, 0.0, 0.5, 3.0], &[2.0, 0.0, 6.0]).unwrap();
        for (x, pdf) in
            [(-1.0, 0.25), (-0.5, 0.25), (0.0, 0.0), (0.4, 0.0), (0.5, 0.3), (3.0, 0.3), (3.1, 0.0)]
        {
            assert!((p.density(x) - pdf).abs() < 1e-15, "{x}: {}", p.density(x));
        }
        assert_eq!((p.cdf(0.2), p.icdf(0.25), p.icdf(1.0)), (0.25, 0.5, 3.0));
        assert_eq!(p.range(), Some([-1.0, 3.0]));
        assert!((p.expected().unwrap() - (0.25 * -0.5 + 0.75 * 1.75)).abs() < 1e-15);
        for i in 0..1000 {
            let u = f64::from(i) / 1000.0;
            assert!(p.density(p.icdf(u)) > 0.0 && (p.cdf(p.icdf(u)) - u).abs() < 1e-15);
        }
    }

    #[test]
    fn a_polygon_is_what_lies_under_it() {
        let p = PiecewiseLinear::new(vec![0.0, 1.0, 2.0, 4.0, 5.0], vec![0.0, 3.0, 0.0, 0.0, 1.0]).unwrap();
        let area = 1.5 + 1.5 + 0.5;
        assert!((p.density(0.5) - 1.5 / area).abs() < 1e-15);
        assert_eq!((p.density(3.0), p.density(5.5), p.density(f64::NAN)), (0.0, 0.0, 0.0));
        assert!((p.cdf(1.0) - 1.5 / area).abs() < 1e-15 && p.cdf(9.0) == 1.0);
        for i in 0..1000 {
            let u = (f64::from(i) + 0.5) / 1000.0;
            let x = p.icdf(u);
            assert!(p.density(x) > 0.0 && (p.cdf(x) - u).abs() < 1e-14, "{u}: {x} {}", p.cdf(x));
        }
        assert!(p.range().is_some());
        assert_eq!(p.ends(), [0.0, 5.0]);
    }

    #[test]
    fn errors_name_the_entry() {
        let text = |edges: &[f64], counts: &[f64]| {
            PiecewiseConstant::new(edges.to_vec(), counts).unwrap_err().to_string()
        };
        assert!(text(&[0.0], &[]).starts_with("counts has 0 entries"));
        assert!(text(&[0.0, 1.0], &[0.0]).contains("counts are all 0"));
        assert!(text(&[0.0, 1.0, 2.0], &[1.0, -2.0]).starts_with("counts[1] is -2"));
        assert!(text(&[0.0, 1.0, 1.0], &[1.0, 2.0]).starts_with("edges[2] is 1"));
        assert!(text(&[0.0, 1.0], &[1.0, 2.0]).starts_with("edges has 2 entries; it must have 3"));
        assert!(text(&[0.0, f64::INFINITY], &[1.0]).starts_with("edges[1] is inf"));
        assert!(PiecewiseLinear::new(vec![0.0], vec![1.0]).is_err());
        assert!(PiecewiseLinear::new(vec![0.0, 1.0], vec![0.0, 0.0]).is_err());
        assert!(PiecewiseLinear::new(vec![0.0, 1.0], vec![1.0, f64::NAN]).is_err());
    }
}
