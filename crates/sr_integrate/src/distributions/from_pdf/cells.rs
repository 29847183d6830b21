//! Cutting an interval into cells until a polynomial in each follows a function.

use super::bernstein::{Coefficients, Fit, LEN, NODES, WEIGHTS, value};
use crate::density::DensityError;
use crate::distributions::parameter::{ParameterError, bad, positive};

/// A function of many numbers at once: writes f(x) for each x.
pub type Blocks<'a> = dyn FnMut(&[f64], &mut [f64]) -> Result<(), DensityError> + 'a;

/// A part of the interval, with the polynomial that stands for the function there.
#[derive(Clone, Debug)]
pub struct Cell {
    pub low: f64,
    pub high: f64,
    pub shape: Coefficients,
    /// The integral of the polynomial.
    pub mass: f64,
    /// ∫ |polynomial − f|, from values at twelve other points.
    error: f64,
    /// The values at those points: the nodes of both halves.
    halves: [[f64; LEN]; 2],
}

/// The cells that an interval is cut into at first; what is narrower than a node of these is not seen.
const FIRST: usize = 128;
/// The most cells.
const MOST: usize = 1 << 18;

impl Cell {
    fn middle(&self) -> f64 {
        0.5 * self.low + 0.5 * self.high
    }

    /// Are there numbers enough between the ends for two more sets of nodes?
    fn can_be_halved(&self) -> bool {
        let spacing = self.low.abs().max(self.high.abs()) * f64::EPSILON;
        self.high - self.low > 1024.0 * spacing.max(f64::MIN_POSITIVE)
    }

    /// Takes the values at the nodes of both halves, and tells from these how good the polynomial is.
    fn judge(&mut self, halves: [[f64; LEN]; 2]) {
        let width = self.high - self.low;
        self.halves = halves;
        self.error = 0.0;
        for (half, values) in halves.iter().enumerate() {
            for ((node, weight), f) in NODES.iter().zip(WEIGHTS).zip(values) {
                let t = 0.5 * (half as f64 + node);
                self.error += 0.5 * width * weight * (value(&self.shape, t) - f).abs();
            }
        }
    }
}

/// Cells in order, their relative error together, and the integral of the function.
pub struct Cells {
    pub cells: Vec<Cell>,
    pub error: f64,
    pub integral: f64,
}

/// Halves cells, the worst first, until ∫ |polynomials − f| is at most `tolerance` of ∫ f.
pub fn cut(f: &mut Blocks<'_>, low: f64, high: f64, tolerance: f64) -> Result<Cells, ParameterError> {
    let fit = Fit::new();
    let edge = |i: usize| if i == FIRST { high } else { low + (high - low) * (i as f64 / FIRST as f64) };
    let ends: Vec<(f64, f64)> = (0..FIRST).map(|i| (edge(i), edge(i + 1))).filter(|(a, b)| a < b).collect();
    let values = at_nodes(f, &ends)?;
    let mut cells = made(f, &fit, &ends, &values)?;
    loop {
        let integral: f64 = cells.iter().map(|cell| cell.mass).sum();
        let error: f64 = cells.iter().map(|cell| cell.error).sum();
        if error <= tolerance * integral {
            if integral == 0.0 {
                let what = format!("is 0 wherever it was looked at between {low} and {high}");
                return Err(ParameterError::Shape { argument: "the density", what });
            }
            positive("the integral of the density", integral)?;
            return Ok(Cells { cells, error: error / integral, integral });
        }
        // Cells below this threshold have a quarter of the tolerance together.
        let threshold = 0.25 * tolerance * integral / cells.len() as f64;
        let (bad, good): (Vec<Cell>, Vec<Cell>) =
            cells.into_iter().partition(|cell| cell.error > threshold && cell.can_be_halved());
        if bad.is_empty() || good.len() + 2 * bad.len() > MOST {
            let all = || good.iter().chain(&bad);
            let worst = all().max_by(|a, b| a.error.total_cmp(&b.error)).map_or(low, Cell::middle);
            return Err(ParameterError::Unresolved { near: worst, error: error / integral, tolerance });
        }
        let ends: Vec<(f64, f64)> =
            bad.iter().flat_map(|cell| [(cell.low, cell.middle()), (cell.middle(), cell.high)]).collect();
        let values: Vec<[f64; LEN]> = bad.iter().flat_map(|cell| cell.halves).collect();
        cells = good;
        cells.extend(made(f, &fit, &ends, &values)?);
        cells.sort_by(|a, b| a.low.total_cmp(&b.low));
    }
}

/// Cells with these ends, and these values at their nodes.
fn made(
    f: &mut Blocks<'_>,
    fit: &Fit,
    ends: &[(f64, f64)],
    values: &[[f64; LEN]],
) -> Result<Vec<Cell>, ParameterError> {
    let cell = |(&(low, high), values): (&(f64, f64), &[f64; LEN])| {
        let shape = fit.fit(values);
        let mass = shape.iter().sum::<f64>() / LEN as f64 * (high - low);
        Cell { low, high, shape, mass, error: 0.0, halves: [[0.0; LEN]; 2] }
    };
    let mut cells: Vec<Cell> = ends.iter().zip(values).map(cell).collect();
    let halves: Vec<(f64, f64)> =
        cells.iter().flat_map(|cell| [(cell.low, cell.middle()), (cell.middle(), cell.high)]).collect();
    let values = at_nodes(f, &halves)?;
    for (cell, pair) in cells.iter_mut().zip(values.chunks_exact(2)) {
        cell.judge([pair[0], pair[1]]);
    }
    Ok(cells)
}

/// The function at the nodes of each interval.
fn at_nodes(f: &mut Blocks<'_>, ends: &[(f64, f64)]) -> Result<Vec<[f64; LEN]>, ParameterError> {
    let x: Vec<f64> =
        ends.iter().flat_map(|&(low, high)| NODES.map(|node| low * (1.0 - node) + high * node)).collect();
    let mut y = vec![0.0; x.len()];
    f(&x, &mut y)?;
    if let Some(i) = y.iter().position(|y| !(*y >= 0.0 && y.is_finite())) {
        return Err(bad(format!("the density at {}", x[i]), y[i], "finite and not negative"));
    }
    Ok(y.chunks_exact(LEN).map(|values| values.try_into().expect("six values")).collect())
}
