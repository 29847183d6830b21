//! Any function as a density.

mod bernstein;
mod cells;

use self::bernstein::{Coefficients, first_moment, integral, value};
pub use self::cells::Blocks;
use super::bins::{Bins, locate, place};
use super::line::OnLine;
use super::parameter::{ParameterError, bad, finite, width};
use super::solve::increasing;
use crate::density::Cumulative;

/// A density proportional to any function f ≥ 0 on an interval, normalised and inverted numerically.
///
/// The function is replaced by polynomials of degree five that are nowhere negative, in cells that are halved
/// until ∫ |polynomials − f| ≤ tolerance · ∫ f. From then on f is not needed: `pdf`, `cdf`, `icdf` and
/// `sample` are those of the polynomials, and agree with one another to the last digits. So an estimate with
/// this density is unbiased whatever the tolerance; only its variance feels it. (After Derflinger, Hörmann &
/// Leydold, "Random Variate Generation by Numerical Inversion when Only the Density Is Known", 2010, who
/// interpolate the distribution function.)
///
/// Jumps and integrable poles are closed in on by halving. Not seen is what lies between the nodes of the
/// first cells, which are 1/900 of the interval apart on average: a narrower peak, or gap. Cut the interval
/// there, and mix the parts. A pole so steep that more than the tolerance lies closer to it than numbers do
/// is an error.
#[derive(Clone, Debug)]
pub struct FromPdf {
    edges: Vec<f64>,
    /// Of each cell, scaled to an integral of 1.
    shapes: Vec<Coefficients>,
    /// The mean density in each cell.
    means: Vec<f64>,
    bins: Bins,
    error: f64,
    integral: f64,
}

impl FromPdf {
    /// - `f`: what the density is proportional to; it is not called at `low` and `high`
    /// - `tolerance`: of ∫ |density − f / ∫ f|, at least 10⁻¹³
    ///
    /// # Errors
    /// If [low, high] is no interval, the tolerance is not in [10⁻¹³, 0.1], f is negative, infinite or NaN
    /// somewhere, or 0 wherever it was looked at, or cannot be resolved.
    pub fn new(f: impl Fn(f64) -> f64, low: f64, high: f64, tolerance: f64) -> Result<Self, ParameterError> {
        let mut blocks = |x: &[f64], y: &mut [f64]| {
            for (x, y) in x.iter().zip(y) {
                *y = f(*x);
            }
            Ok(())
        };
        Self::from_blocks(&mut blocks, low, high, tolerance)
    }

    /// The same, for a function of many numbers at once, which may fail.
    ///
    /// # Errors
    /// As [`FromPdf::new`], and those of the function.
    pub fn from_blocks(
        f: &mut Blocks<'_>,
        low: f64,
        high: f64,
        tolerance: f64,
    ) -> Result<Self, ParameterError> {
        width("[low, high]", low, high)?;
        if !(1e-13..=0.1).contains(&tolerance) {
            return Err(bad("tolerance", tolerance, "from 1e-13 to 0.1"));
        }
        let cells::Cells { cells, error, integral } = cells::cut(f, low, high, tolerance)?;
        let masses: Vec<f64> = cells.iter().map(|cell| cell.mass).collect();
        let (bins, sum) = Bins::new("integrals over cells", &masses)?;
        let edges: Vec<f64> = cells.iter().map(|cell| cell.low).chain([high]).collect();
        let means: Vec<f64> = cells.iter().map(|cell| cell.mass / sum / (cell.high - cell.low)).collect();
        for (mean, cell) in means.iter().zip(&cells) {
            finite(&format!("the density near {}", cell.low), *mean)?;
        }
        let scaled = |cell: &cells::Cell| {
            let mean = cell.shape.iter().sum::<f64>() / cell.shape.len() as f64;
            if mean > 0.0 { cell.shape.map(|c| c / mean) } else { [1.0; bernstein::LEN] }
        };
        Ok(Self { edges, shapes: cells.iter().map(scaled).collect(), means, bins, error, integral })
    }

    /// ∫ |density − f / ∫ f|, as far as the values of f tell.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// ∫ f.
    pub fn integral(&self) -> f64 {
        self.integral
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.bins.len()
    }

    /// The cell that holds `x`, and where in it.
    #[inline]
    fn at(&self, x: f64) -> Option<(usize, f64)> {
        locate(&self.edges, x).map(|i| (i, (x - self.edges[i]) / (self.edges[i + 1] - self.edges[i])))
    }
}

impl OnLine for FromPdf {
    #[inline]
    fn density(&self, x: f64) -> f64 {
        self.at(x).map_or(0.0, |(i, t)| self.means[i] * value(&self.shapes[i], t))
    }

    fn ends(&self) -> [f64; 2] {
        let first = self.means.iter().position(|&m| m > 0.0).unwrap_or(0);
        let last = self.means.iter().rposition(|&m| m > 0.0).unwrap_or(0);
        [self.edges[first], self.edges[last + 1]]
    }

    fn expected(&self) -> Option<f64> {
        let part = |i: usize| {
            let share = self.bins.below(i + 1) - self.bins.below(i);
            share * (self.edges[i] + (self.edges[i + 1] - self.edges[i]) * first_moment(&self.shapes[i]))
        };
        Some((0..self.bins.len()).map(part).sum())
    }

    fn range(&self) -> Option<[f64; 2]> {
        self.means.contains(&0.0).then(|| [self.edges[0], self.edges[self.bins.len()]])
    }
}

impl Cumulative for FromPdf {
    fn cdf(&self, x: f64) -> f64 {
        match self.at(x) {
            Some((i, t)) => self.bins.unpick(i, integral(&self.shapes[i], t)).min(1.0),
            None => f64::from(u8::from(x > self.edges[0])),
        }
    }

    fn icdf(&self, u: f64) -> f64 {
        if u >= 1.0 {
            return self.ends()[1];
        }
        let picked = self.bins.pick(u);
        let shape = &self.shapes[picked.index];
        let t = increasing(|t| (integral(shape, t), value(shape, t)), picked.rest, [0.0, 1.0], picked.rest);
        place(&self.edges, picked.index, t)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn check(
        name: &str,
        f: impl Fn(f64) -> f64 + Copy,
        [low, high]: [f64; 2],
        tolerance: f64,
        integral: f64,
    ) {
        let p = FromPdf::new(f, low, high, tolerance).unwrap();
        assert!((p.integral() / integral - 1.0).abs() < tolerance, "{name}: {}", p.integral());
        assert!(p.error() <= tolerance);
        // What is drawn has the density that is said, and the distribution function too.
        for i in 0..2000 {
            let u = (f64::from(i) + 0.5) / 2000.0;
            let x = p.icdf(u);
            assert!(p.density(x) > 0.0, "{name}: {u}");
            let steps = p.density(x) * x.abs() * f64::EPSILON;
            assert!((p.cdf(x) - u).abs() < 1e-13 + steps, "{name}: {u}: {}", p.cdf(x));
        }
        // The error that is claimed is the error, by the midpoint rule.
        let n = 400_000;
        let h = (high - low) / f64::from(n);
        let at = |i: i32| low + (f64::from(i) + 0.5) * h;
        let error: f64 = (0..n).map(|i| (p.density(at(i)) - f(at(i)) / integral).abs() * h).sum();
        assert!(error < 3.0 * tolerance + 1e-9, "{name}: {error:e} of {} cells", p.cells());
    }

    #[test]
    fn smooth_kinked_and_jumping_functions_are_followed() {
        check("sine", |x| x.sin(), [0.0, PI], 1e-9, 2.0);
        check("normal", |x| (-0.5 * x * x).exp(), [-30.0, 30.0], 1e-10, (2.0 * PI).sqrt());
        check("kink", |x| (x - 0.3).abs(), [0.0, 1.0], 1e-7, 0.5 * (0.09 + 0.49));
        check(
            "steps",
            |x| {
                if x < 0.1234 {
                    3.0
                } else if x < 0.7 {
                    0.0
                } else {
                    1.0
                }
            },
            [0.0, 1.0],
            1e-6,
            0.6702,
        );
        check("narrow", |x| 1.0 / (1.0 + 1e6 * (x - 0.5).powi(2)), [0.0, 1.0], 1e-6, 2e-3 * 500.0_f64.atan());
    }

    #[test]
    fn poles_that_can_be_integrated() {
        for (f, [low, high], integral) in [
            ((|x: f64| 1.0 / x.sqrt()) as fn(f64) -> f64, [0.0, 4.0], 4.0),
            (|x: f64| -x.ln(), [0.0, 1.0], 1.0),
            (|x: f64| (x - 0.3).abs().powf(-0.5), [0.0, 1.0], 2.0 * (0.3_f64.sqrt() + 0.7_f64.sqrt())),
        ] {
            let p = FromPdf::new(f, low, high, 1e-6).unwrap();
            assert!((p.integral() / integral - 1.0).abs() < 1e-5, "{}", p.integral());
            assert!((p.cdf(p.icdf(1e-4)) - 1e-4).abs() < 1e-13);
        }
        let error = FromPdf::new(|x| (x - 0.3).abs().powf(-0.95), 0.0, 1.0, 1e-6).unwrap_err();
        assert!(error.to_string().starts_with("the density is not resolved near 0.29999999"), "{error}");
    }

    #[test]
    fn a_few_evaluations_are_enough() {
        let mut calls = 0;
        let mut count = |x: &[f64], y: &mut [f64]| {
            calls += x.len();
            y.copy_from_slice(x);
            Ok(())
        };
        let p = FromPdf::from_blocks(&mut count, 0.0, 5.0, 1e-6).unwrap();
        assert_eq!((calls, p.cells()), (128 * 18, 128));
        assert!((p.expected().unwrap() - 10.0 / 3.0).abs() < 1e-13);
        assert!((p.density(1.0) - 0.08).abs() < 1e-14);
    }

    #[test]
    fn errors_name_the_value() {
        let text = |f: fn(f64) -> f64, low, high, tolerance| {
            FromPdf::new(f, low, high, tolerance).unwrap_err().to_string()
        };
        assert!(text(|x| x - 0.5, 0.0, 1.0, 1e-6).starts_with("the density at 0.000"));
        assert!(text(|_| f64::NAN, 0.0, 1.0, 1e-6).contains("is NaN"));
        assert!(text(|_| 0.0, 0.0, 1.0, 1e-6).starts_with("the density is 0"));
        assert!(text(|x| x, 1.0, 1.0, 1e-6).contains("[1, 1]"));
        assert!(text(|x| x, 0.0, 1.0, 0.0).starts_with("tolerance is 0"));
        assert!(text(|x| x, 0.0, f64::INFINITY, 1e-6).contains("[low, high]"));
    }
}
