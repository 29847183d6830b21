//! Distributions over indices.

use sr_sampling::{Counting, Distribution};

use super::Chi2Settings;
use super::pearson::{Cell, pearson};
use super::run::{Tally, draw};
use crate::report::TestReport;

/// Tests a distribution over the indices 0 to `len` − 1, each of which is a cell.
pub fn counting<D: Distribution<Measure = Counting>>(
    distribution: &D,
    len: usize,
    settings: Chi2Settings,
) -> TestReport {
    let n = f64::from(settings.samples);
    let mut cells: Vec<Cell> =
        (0..len).map(|i| Cell { expected: n * f64::from(distribution.pdf(i)), observed: 0 }).collect();
    let mut tally = Tally::default();
    let mut outside = 0;
    for sample in draw(distribution, settings) {
        let Some(sample) = tally.check(distribution, sample) else { continue };
        match cells.get_mut(sample.value) {
            Some(cell) => cell.observed += 1,
            None => outside += 1,
        }
    }
    if let Some(report) = tally.verdict(outside) {
        return report;
    }
    let sum: f64 = cells.iter().map(|c| c.expected).sum();
    // Each probability is rounded to `f32`.
    tally.push_none(&mut cells, n - sum, n * 1e-6);
    pearson(&cells, |i| if i < len { format!("index {i}") } else { "None".into() })
}
