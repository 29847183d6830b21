//! Where to put points: a tree of strata that follows how much the integrand varies.
//!
//! vegas+ cuts the cube into a grid and gives each cell points in proportion to how much f / p varies in it (G. P. Lepage,
//! "Adaptive multidimensional integration: vegas enhanced", J. Comput. Phys. 439, 2021, §3). A grid of few dimensions
//! has many cells already, and one of many has none: a tree is cut where, and along what, it lowers the variance (as in
//! S. Jadach, "Foam", Comput. Phys. Commun. 152, 2003).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::level::Level;
use super::strata::{Strata, Written};
use crate::columns::Columns;

/// A half must have so many points: of fewer one can't say how much they vary.
const FEWEST: usize = 12;

/// A tree has at most one stratum for so many points.
const POINTS_PER_STRATUM: usize = 40;

/// Strata get points in proportion to the spread of f to this power: 1 would be best if spreads were known exactly, and
/// vegas+ takes the same (Lepage 2021, Eq. 31).
const DAMPING: f64 = 0.75;

/// A stratum's variance is drawn towards that of the cell that it is a half of, as if it had been seen in so many more
/// points: a few that are equal do not mean that all are.
const PRIOR: f64 = 2.0;

/// This share of the points is spread evenly: strata in which f seems constant may hold what no point has met.
const EVEN: f64 = 0.2;

/// Points in the cube of a density's uniforms, and f / p there for that density without strata.
#[derive(Clone, Debug, Default)]
pub struct Observed {
    /// A column for each coordinate.
    pub u: Vec<Vec<f64>>,
    /// A column for each output, if these are few; else one of their mean size.
    pub f: Vec<Vec<f64>>,
    /// Is `f` the outputs themselves?
    pub is_exact: bool,
    /// One over the density that drew each point.
    pub weight: Vec<f64>,
}

impl Observed {
    /// Points of both.
    pub fn extend(&mut self, other: Self) {
        if self.weight.is_empty() {
            *self = other;
            return;
        }
        self.u.iter_mut().zip(other.u).for_each(|(all, more)| all.extend(more));
        self.f.iter_mut().zip(other.f).for_each(|(all, more)| all.extend(more));
        self.weight.extend(other.weight);
    }

    fn len(&self) -> usize {
        self.weight.len()
    }

    /// How much f varies among some points: the square root of the sum of all outputs' variances.
    fn spread(&self, points: &[u32], scales: &[f64]) -> f64 {
        let [spread, _] = self.spreads(points, scales, |_| 0);
        spread
    }

    /// The same of each of two parts of some points.
    fn spreads(&self, points: &[u32], scales: &[f64], part: impl Fn(u32) -> usize) -> [f64; 2] {
        let mut variances = [0.0; 2];
        for (column, scale) in self.f.iter().zip(scales).filter(|(_, scale)| **scale > 0.0) {
            // About one of the points, so that nothing is lost where all are alike.
            let about = points.first().map_or(0.0, |&i| column[i as usize]);
            let mut sums = [[0.0; 3]; 2];
            for &i in points {
                let [total, sum, squares] = &mut sums[part(i)];
                let (weight, f) = (self.weight[i as usize], (column[i as usize] - about) / scale);
                *total += weight;
                *sum += weight * f;
                *squares += weight * f * f;
            }
            for (variance, [total, sum, squares]) in variances.iter_mut().zip(sums) {
                if total > 0.0 {
                    *variance += (squares / total - (sum / total).powi(2)).max(0.0);
                }
            }
        }
        variances.map(f64::sqrt)
    }

    /// The mean size of each output.
    fn scales(&self) -> Vec<f64> {
        let total: f64 = self.weight.iter().sum();
        let mean = |column: &Vec<f64>| {
            column.iter().zip(&self.weight).map(|(f, weight)| f.abs() * weight).sum::<f64>() / total
        };
        self.f.iter().map(mean).collect()
    }

    /// Strata, what f / p is in them, and the variance that they leave, as a share of that without them, if points within
    /// a stratum were independent. That is told by points that other strata were not made from.
    ///
    /// Returns `None` if points are too few.
    pub fn stratified(&self) -> Option<(Level, f64)> {
        let all: Vec<u32> = (0..self.len() as u32).collect();
        let (learned, kept): (Vec<u32>, Vec<u32>) = all.iter().partition(|i| (*i >> 3) % 2 == 0);
        let scales = self.scales();
        if learned.len().min(kept.len()) < FEWEST {
            return None;
        }
        let without = self.spread(&kept, &scales).powi(2);
        let with = Tree::grow(self, learned, &scales).variance(self, &kept, &scales);
        let tree = Tree::grow(self, all, &scales);
        let strata = Strata::from_written(self.u.len(), &tree.written())?;
        Some((self.level_of(strata), if without > 0.0 { with / without } else { 1.0 }))
    }

    /// The mean of each output in each stratum.
    fn level_of(&self, strata: Strata) -> Level {
        let outputs = if self.is_exact { self.f.len() } else { 0 };
        let columns = self.u.concat();
        let found = strata.find(Columns::new(&columns, self.len()));
        let (mut sums, mut totals) = (vec![0.0; strata.count() * outputs], vec![0.0; strata.count()]);
        for (i, stratum) in found.into_iter().enumerate() {
            let (stratum, weight) = (stratum as usize, self.weight[i]);
            totals[stratum] += weight;
            for (sum, column) in sums[stratum * outputs..][..outputs].iter_mut().zip(&self.f) {
                *sum += weight * column[i];
            }
        }
        for (sums, total) in sums.chunks_mut(outputs.max(1)).zip(totals) {
            sums.iter_mut().for_each(|sum| *sum = if total > 0.0 { *sum / total } else { 0.0 });
        }
        Level::new(strata, outputs, &sums)
    }
}

/// A tree in the making.
struct Tree {
    cells: Vec<Cell>,
}

struct Cell {
    /// Along each axis.
    bounds: Vec<[f64; 2]>,
    volume: f64,
    depth: usize,
    points: Vec<u32>,
    /// Among the points.
    spread: f64,
    /// In the cell, as far as points can tell.
    believed: f64,
    /// The axis that it is cut across, and its halves.
    cut: Option<(usize, [usize; 2])>,
    /// Of all that is drawn.
    share: f64,
}

/// What cutting a cell gains.
struct Offer {
    gain: f64,
    cell: usize,
    axis: usize,
    /// The spreads of its halves.
    spreads: [f64; 2],
}

impl Ord for Offer {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain.total_cmp(&other.gain).then(other.cell.cmp(&self.cell))
    }
}

impl PartialOrd for Offer {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Offer {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Offer {}

/// Deeper cells are not cut.
const MAX_DEPTH: usize = 32;

impl Tree {
    /// Cuts, always where it gains most, until strata are as small as the points allow.
    fn grow(seen: &Observed, points: Vec<u32>, scales: &[f64]) -> Self {
        let most = points.len() / POINTS_PER_STRATUM;
        let bounds = vec![[0.0, 1.0]; seen.u.len()];
        let spread = seen.spread(&points, scales);
        let root =
            Cell { bounds, volume: 1.0, depth: 0, points, spread, believed: spread, cut: None, share: 0.0 };
        let mut offers = BinaryHeap::from_iter(root.offer(seen, scales, 0));
        let mut tree = Self { cells: vec![root] };
        let mut strata = 1;
        while strata < most
            && let Some(offer) = offers.pop()
        {
            let numbers = [tree.cells.len(), tree.cells.len() + 1];
            let halves = tree.cells[offer.cell].cut(seen, &offer, numbers);
            for (half, number) in halves.into_iter().zip(numbers) {
                offers.extend(half.offer(seen, scales, number));
                tree.cells.push(half);
            }
            strata += 1;
        }
        tree.deal();
        tree
    }

    /// Gives each stratum its share, and each cell those of its halves.
    fn deal(&mut self) {
        let wish = |cell: &Cell| cell.volume * cell.believed.powf(DAMPING);
        let total: f64 = self.cells.iter().filter(|cell| cell.cut.is_none()).map(wish).sum();
        // Halves come after their cell.
        for i in (0..self.cells.len()).rev() {
            let cell = &self.cells[i];
            self.cells[i].share = match cell.cut {
                Some((_, [a, b])) => self.cells[a].share + self.cells[b].share,
                None if total > 0.0 => EVEN * cell.volume + (1.0 - EVEN) * wish(cell) / total,
                None => cell.volume,
            };
        }
    }

    /// Σ (V σ)² / share over strata, from points that it was not made from.
    fn variance(&self, seen: &Observed, points: &[u32], scales: &[f64]) -> f64 {
        let mut within: Vec<Vec<u32>> = vec![Vec::new(); self.cells.len()];
        for &i in points {
            let mut at = 0;
            while let Some((axis, halves)) = self.cells[at].cut {
                at = halves[usize::from(seen.u[axis][i as usize] >= self.cells[halves[1]].bounds[axis][0])];
            }
            within[at].push(i);
        }
        let leaves = self.cells.iter().zip(&within).filter(|(cell, _)| cell.cut.is_none());
        let variance = leaves.map(|(cell, points)| {
            let spread = if points.len() < FEWEST { cell.believed } else { seen.spread(points, scales) };
            (cell.volume * spread).powi(2) / cell.share
        });
        variance.sum()
    }

    fn written(&self) -> Vec<Written> {
        let mut written = Vec::with_capacity(self.cells.len());
        let mut stack = vec![0];
        while let Some(i) = stack.pop() {
            let cell = &self.cells[i];
            written.push(cell.cut.map(|(axis, [a, _])| (axis, self.cells[a].share / cell.share)));
            stack.extend(cell.cut.iter().flat_map(|(_, [a, b])| [*b, *a]));
        }
        written
    }
}

impl Cell {
    /// The best cut, if any gains.
    fn offer(&self, seen: &Observed, scales: &[f64], cell: usize) -> Option<Offer> {
        if self.points.len() < 2 * FEWEST || self.depth == MAX_DEPTH || !(self.spread > 0.0) {
            return None;
        }
        let offer = |axis: usize| {
            let half_of = self.half_of(seen, axis);
            let above = self.points.iter().filter(|&&i| half_of(i) == 1).count();
            if above.min(self.points.len() - above) < FEWEST {
                return None;
            }
            let spreads = seen.spreads(&self.points, scales, half_of);
            let gain = self.volume * (self.spread - 0.5 * (spreads[0] + spreads[1]));
            (gain > 0.0).then_some(Offer { gain, cell, axis, spreads })
        };
        (0..self.bounds.len()).filter_map(offer).max()
    }

    /// In which half across an axis a point is.
    fn half_of<'a>(&self, seen: &'a Observed, axis: usize) -> impl Fn(u32) -> usize + use<'a> {
        let [low, high] = self.bounds[axis];
        let middle = 0.5 * (low + high);
        let column = &seen.u[axis];
        move |i| usize::from(column[i as usize] >= middle)
    }

    /// Cuts it in halves, which get numbers.
    fn cut(&mut self, seen: &Observed, offer: &Offer, numbers: [usize; 2]) -> [Self; 2] {
        let Offer { axis, spreads, .. } = *offer;
        let half_of = self.half_of(seen, axis);
        let (below, above): (Vec<u32>, Vec<u32>) =
            std::mem::take(&mut self.points).into_iter().partition(|&i| half_of(i) == 0);
        self.cut = Some((axis, numbers));
        let [low, high] = self.bounds[axis];
        let middle = 0.5 * (low + high);
        let half = |points: Vec<u32>, range: [f64; 2], spread: f64| {
            let mut bounds = self.bounds.clone();
            bounds[axis] = range;
            let (volume, depth, n) = (0.5 * self.volume, self.depth + 1, points.len() as f64);
            let believed = ((n * spread * spread + PRIOR * self.believed.powi(2)) / (n + PRIOR)).sqrt();
            Self { bounds, volume, depth, points, spread, believed, cut: None, share: 0.0 }
        };
        [half(below, [low, middle], spreads[0]), half(above, [middle, high], spreads[1])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::ColumnsMut;
    use crate::points::{Points, Sequence};

    fn observed(dim: usize, n: usize, f: impl Fn(&[f64]) -> f64) -> Observed {
        let mut u = vec![0.0; dim * n];
        Points::new(Sequence::Independent, dim, 1).fill(0, 0, ColumnsMut::new(&mut u, n));
        let u: Vec<Vec<f64>> = u.chunks(n).map(<[f64]>::to_vec).collect();
        let f = (0..n).map(|i| f(&u.iter().map(|u| u[i]).collect::<Vec<f64>>())).collect();
        Observed { u, f: vec![f], is_exact: true, weight: vec![1.0; n] }
    }

    /// A quarter disk: variance is at its rim alone, where almost all points then go.
    #[test]
    fn points_go_where_f_varies() {
        let seen = observed(2, 1 << 14, |x| f64::from(u8::from(x[0] * x[0] + x[1] * x[1] < 1.0)));
        let (level, left) = seen.stratified().unwrap();
        let strata = level.strata();
        assert!(left < 0.1, "{left}");
        let density = |x: [f64; 2]| {
            let mut pdf = [1.0];
            strata.pdf(crate::Columns::new(&x, 1), &mut pdf);
            pdf[0]
        };
        assert!(density([0.6, 0.8]) > 10.0 * density([0.2, 0.3]));
        assert!((EVEN..0.5).contains(&density([0.2, 0.3])), "{}", density([0.2, 0.3]));
    }

    /// Noise in all directions cannot be stratified, and what is predicted does not pretend it could.
    #[test]
    fn noise_is_not_thought_to_be_structure() {
        let hash = |x: &[f64]| (x.iter().sum::<f64>() * 1e7).sin();
        let (_, left) = observed(3, 1 << 13, |x| 2.0 + hash(x)).stratified().unwrap();
        assert!(left > 0.95, "{left}");
    }

    #[test]
    fn a_constant_needs_no_strata() {
        let (level, left) = observed(2, 1000, |_| 3.0).stratified().unwrap();
        assert_eq!((level.strata().count(), left), (1, 1.0));
        assert!(observed(2, 5, |x| x[0]).stratified().is_none());
    }
}
