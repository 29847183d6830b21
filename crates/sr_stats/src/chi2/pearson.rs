//! Pearson's statistic, with small cells pooled.

use crate::report::TestReport;
use crate::tails::chi2_above;

/// A cell: how many samples were expected there, and how many came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Expected number of samples.
    pub expected: f64,
    /// Their number.
    pub observed: u64,
}

/// The fewest samples expected in a cell, or pool of cells, for the statistic to be nearly chi-square.
const MIN_EXPECTED: f64 = 5.0;

/// Of samples where none were expected, rounding at a rim explains this share of all.
const STRAY_SHARE: f64 = 1e-5;

/// Are there more samples where none were expected than rounding explains? Strays are rare, so their number is nearly
/// Poisson's: five standard deviations, and one for the tail of the smallest means, are never exceeded by chance.
pub(super) fn too_many_strays(strays: u64, samples: u64) -> bool {
    let mean = STRAY_SHARE * samples as f64;
    strays as f64 > mean + 5.0 * mean.sqrt() + 1.0
}

/// Do observed counts follow expected ones? The cells make up everything that can happen.
///
/// Cells that expect fewer than five samples are pooled, the smallest first.
///
/// - `describe`: where cell i is, for the remark
pub fn pearson(cells: &[Cell], describe: impl Fn(usize) -> String) -> TestReport {
    if let Some(i) = cells.iter().position(|c| !(c.expected >= 0.0 && c.expected.is_finite())) {
        return TestReport::impossible(format!("{} expects {} samples", describe(i), cells[i].expected));
    }
    let samples: u64 = cells.iter().map(|c| c.observed).sum();
    let empty = |c: &Cell| c.expected < 1e-9;
    let strays: u64 = cells.iter().filter(|c| empty(c)).map(|c| c.observed).sum();
    if too_many_strays(strays, samples) {
        let worst = (0..cells.len()).filter(|&i| empty(&cells[i])).max_by_key(|&i| cells[i].observed);
        let place = worst.map(describe).unwrap_or_default();
        return TestReport::impossible(format!("{strays} samples where the density is 0, most in {place}"));
    }

    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by(|&i, &j| cells[i].expected.total_cmp(&cells[j].expected));
    let mut pool = Cell { expected: 0.0, observed: 0 };
    let (mut statistic, mut terms) = (0.0, 0);
    let mut worst = (0.0, None);
    for i in order {
        pool.expected += cells[i].expected;
        pool.observed += cells[i].observed;
        // Ascending: a pool is only begun by cells that are too small, and ends once it is large enough.
        if pool.expected >= MIN_EXPECTED {
            let difference = pool.observed as f64 - pool.expected;
            let term = difference * difference / pool.expected;
            if term > worst.0 {
                worst = (term, Some((i, pool)));
            }
            statistic += term;
            terms += 1;
            pool = Cell { expected: 0.0, observed: 0 };
        }
    }
    if terms < 2 {
        let remark = format!("{terms} cell(s) expect {MIN_EXPECTED} samples or more: no evidence");
        return TestReport { statistic, dof: 0.0, p_value: f64::NAN, remark };
    }
    let dof = f64::from(terms - 1);
    let remark = worst.1.map_or_else(String::new, |(i, cell): (usize, Cell)| {
        let sigma = (cell.observed as f64 - cell.expected) / cell.expected.sqrt();
        let Cell { expected, observed } = cell;
        format!("worst at {}: {observed} samples for {expected:.1} expected ({sigma:+.1} sigma)", describe(i))
    });
    TestReport { statistic, dof, p_value: chi2_above(statistic, dof), remark }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(pairs: &[(f64, u64)]) -> Vec<Cell> {
        pairs.iter().map(|&(expected, observed)| Cell { expected, observed }).collect()
    }

    fn test(pairs: &[(f64, u64)]) -> TestReport {
        pearson(&cells(pairs), |i| format!("cell {i}"))
    }

    #[test]
    fn the_statistic_is_a_sum_over_cells() {
        let report = test(&[(10.0, 12), (20.0, 15), (30.0, 33)]);
        assert!((report.statistic - (0.4 + 1.25 + 0.3)).abs() < 1e-12);
        assert_eq!(report.dof, 2.0);
        assert!(report.remark.contains("cell 1"), "{report}");
    }

    #[test]
    fn small_cells_are_pooled() {
        let report = test(&[(2.0, 4), (50.0, 50), (1.0, 0), (3.0, 3), (50.0, 50)]);
        assert!((report.statistic - 1.0 / 6.0).abs() < 1e-12, "{report}");
        assert_eq!(report.dof, 2.0);
    }

    #[test]
    fn certainly_wrong_is_certain() {
        assert_eq!(test(&[(0.0, 10), (50.0, 45), (50.0, 45)]).p_value, 0.0);
        assert_eq!(test(&[(f64::NAN, 10), (50.0, 45)]).p_value, 0.0);
        assert_eq!(test(&[(-1.0, 0), (50.0, 45)]).p_value, 0.0);
    }

    #[test]
    fn one_cell_is_no_evidence() {
        assert!(!test(&[(100.0, 100)]).passes(0.0));
        assert!(!test(&[]).passes(0.0));
    }
}
