//! A density on the unit cube that is constant in each cell of a tree: how many points each stratum gets.
//!
//! A cell is cut in halves across one axis, and each half has a share of its probability. Sampling runs down the tree
//! and stretches one coordinate at each cut, which keeps well distributed points well distributed (P. Clarberg et al.,
//! "Wavelet importance sampling", SIGGRAPH 2005, §4.3): with stratified or low-discrepancy uniforms every stratum gets
//! its number of points to within about one, as if points were dealt out to strata.

use crate::columns::{Columns, ColumnsMut};

/// The deepest tree: halves of halves are never narrower than the numbers that tell them apart.
const MAX_DEPTH: usize = 40;

/// A tree of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Strata {
    dim: usize,
    root: Cell,
    /// Every cut before those of its halves.
    cuts: Vec<Cut>,
}

/// A cell that is cut in halves.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    axis: usize,
    low: f64,
    middle: f64,
    high: f64,
    /// The probability of the lower half, given the cell; strictly between 0 and 1.
    below: f64,
    halves: [Cell; 2],
}

/// A part of the cube.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cell {
    /// It is cut: which of the cuts.
    Cut(u32),
    /// It is a stratum: which, in the order of the tree.
    Stratum(u32),
}

impl Cut {
    /// The density within a half, relative to the cell's.
    fn density(&self, half: usize) -> f64 {
        2.0 * if half == 0 { self.below } else { 1.0 - self.below }
    }

    /// The half that a number along the axis is in.
    fn half_of(&self, x: f64) -> usize {
        usize::from(x >= self.middle)
    }

    /// Where the two halves' uniforms meet.
    fn border(&self) -> f64 {
        self.low + self.below * (self.high - self.low)
    }
}

/// A cell as it is written down, before its halves: the axis that it is cut across, and the probability of its lower
/// half; nothing for a stratum.
pub type Written = Option<(usize, f64)>;

impl Strata {
    /// The tree that a list describes, cell before its lower before its upper half.
    ///
    /// Returns `None` if it describes none: cells too few or too many, no such axis, a share that is not strictly
    /// between 0 and 1, or too many cuts within one another.
    pub fn from_written(dim: usize, written: &[Written]) -> Option<Self> {
        let mut strata = Self { dim, root: Cell::Stratum(0), cuts: Vec::new() };
        let mut rest = written.iter();
        let mut bounds = vec![[0.0, 1.0]; dim];
        strata.root = strata.read(&mut rest, &mut bounds, &mut 0, 0)?;
        rest.next().is_none().then_some(strata)
    }

    /// Reads a cell, after `count` strata. Returns `None` if something is wrong.
    fn read(
        &mut self,
        rest: &mut std::slice::Iter<'_, Written>,
        bounds: &mut [[f64; 2]],
        count: &mut u32,
        depth: usize,
    ) -> Option<Cell> {
        let Some((axis, below)) = *rest.next()? else {
            *count += 1;
            return Some(Cell::Stratum(*count - 1));
        };
        if depth == MAX_DEPTH || axis >= self.dim || !(below > 0.0 && below < 1.0) {
            return None;
        }
        let [low, high] = bounds[axis];
        let middle = 0.5 * (low + high);
        let number = self.cuts.len();
        self.cuts.push(Cut { axis, low, middle, high, below, halves: [Cell::Stratum(0); 2] });
        for (half, range) in [[low, middle], [middle, high]].into_iter().enumerate() {
            bounds[axis] = range;
            self.cuts[number].halves[half] = self.read(rest, bounds, count, depth + 1)?;
        }
        bounds[axis] = [low, high];
        Some(Cell::Cut(number as u32))
    }

    /// What [`Strata::from_written`] reads.
    pub fn written(&self) -> Vec<Written> {
        let mut written = Vec::with_capacity(2 * self.cuts.len() + 1);
        let mut rest = vec![self.root];
        while let Some(cell) = rest.pop() {
            let cut = self.cut(cell);
            written.push(cut.map(|cut| (cut.axis, cut.below)));
            rest.extend(cut.iter().flat_map(|cut| [cut.halves[1], cut.halves[0]]));
        }
        written
    }

    /// The number of strata.
    pub fn count(&self) -> usize {
        self.cuts.len() + 1
    }

    /// The volume and the probability of each stratum, in the order of the tree.
    pub fn volumes(&self) -> Vec<[f64; 2]> {
        let mut all = Vec::with_capacity(self.count());
        let mut rest = vec![(self.root, [1.0; 2])];
        while let Some((cell, [volume, share])) = rest.pop() {
            match self.cut(cell) {
                None => all.push([volume, share]),
                Some(cut) => rest.extend([1, 0].map(|half| {
                    let volume = 0.5 * volume;
                    (cut.halves[half], [volume, 0.5 * share * cut.density(half)])
                })),
            }
        }
        all
    }

    /// Moves each point from the uniforms of a sample to where it is drawn, and multiplies `pdf` by its density. Returns
    /// the stratum of each, in the order of the tree.
    pub fn sample(&self, mut points: ColumnsMut<'_>, pdf: &mut [f64]) -> Vec<u32> {
        let mut strata = Vec::with_capacity(pdf.len());
        for (i, pdf) in pdf.iter_mut().enumerate() {
            let mut cell = self.root;
            let stratum = loop {
                let cut = match cell {
                    Cell::Stratum(stratum) => break stratum,
                    Cell::Cut(cut) => &self.cuts[cut as usize],
                };
                let u = points.as_columns().get(i, cut.axis);
                let border = cut.border();
                let half = usize::from(u >= border);
                let density = cut.density(half);
                let moved = match half {
                    0 => (cut.low + (u - cut.low) / density).min(cut.middle.next_down()),
                    _ => (cut.middle + (u - border) / density).clamp(cut.middle, cut.high.next_down()),
                };
                points.set(i, cut.axis, moved);
                *pdf *= density;
                cell = cut.halves[half];
            };
            strata.push(stratum);
        }
        strata
    }

    /// Multiplies `pdf` by the density at each point.
    pub fn pdf(&self, points: Columns<'_>, pdf: &mut [f64]) {
        for (i, pdf) in pdf.iter_mut().enumerate() {
            let mut cell = self.root;
            while let Some(cut) = self.cut(cell) {
                let half = cut.half_of(points.get(i, cut.axis));
                *pdf *= cut.density(half);
                cell = cut.halves[half];
            }
        }
    }

    /// The stratum that each point is in, in the order of the tree.
    pub fn find(&self, points: Columns<'_>) -> Vec<u32> {
        let find = |i: usize| {
            let mut cell = self.root;
            loop {
                match cell {
                    Cell::Stratum(stratum) => return stratum,
                    Cell::Cut(cut) => {
                        let cut = &self.cuts[cut as usize];
                        cell = cut.halves[cut.half_of(points.get(i, cut.axis))];
                    }
                }
            }
        };
        (0..points.len()).map(find).collect()
    }

    /// Moves each point back to the uniforms that are mapped to it.
    pub fn invert(&self, mut points: ColumnsMut<'_>) {
        let mut path: Vec<(&Cut, usize)> = Vec::with_capacity(MAX_DEPTH);
        for i in 0..points.len() {
            let mut cell = self.root;
            while let Some(cut) = self.cut(cell) {
                let half = cut.half_of(points.as_columns().get(i, cut.axis));
                path.push((cut, half));
                cell = cut.halves[half];
            }
            while let Some((cut, half)) = path.pop() {
                let (from, to) = if half == 0 { (cut.low, cut.low) } else { (cut.middle, cut.border()) };
                let x = points.as_columns().get(i, cut.axis);
                points.set(i, cut.axis, (to + (x - from) * cut.density(half)).min(cut.high.next_down()));
            }
        }
    }

    fn cut(&self, cell: Cell) -> Option<&Cut> {
        match cell {
            Cell::Cut(cut) => Some(&self.cuts[cut as usize]),
            Cell::Stratum(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Strata {
        // The lower half of x twice, then y.
        let written =
            [Some((0, 0.9)), Some((0, 0.25)), None, Some((1, 0.5)), None, None, Some((1, 0.01)), None, None];
        Strata::from_written(2, &written).unwrap()
    }

    #[test]
    fn it_runs_backwards_and_tells_what_it_samples() {
        let strata = example();
        let u: Vec<f64> = (0..4000).map(|i| (f64::from(i) * 0.618_033_988_75) % 1.0).collect();
        let (mut x, mut drawn) = (u.clone(), vec![1.0; 2000]);
        strata.sample(ColumnsMut::new(&mut x, 2000), &mut drawn);
        let mut told = vec![1.0; 2000];
        strata.pdf(Columns::new(&x, 2000), &mut told);
        assert_eq!(drawn, told);
        strata.invert(ColumnsMut::new(&mut x, 2000));
        assert!(x.iter().zip(&u).all(|(a, b)| (a - b).abs() < 1e-14));
        assert_eq!(strata.count(), 5);
    }

    /// The number of points in a stratum is its probability's share, to within one, of points on a line.
    #[test]
    fn points_are_dealt_out() {
        let strata = Strata::from_written(1, &[Some((0, 0.9)), Some((0, 0.5)), None, None, None]).unwrap();
        let mut x: Vec<f64> = (0..1000).map(|i| (f64::from(i) + 0.5) / 1000.0).collect();
        strata.sample(ColumnsMut::new(&mut x, 1000), &mut vec![1.0; 1000]);
        let within = |low: f64, high: f64| x.iter().filter(|x| (low..high).contains(*x)).count();
        assert_eq!([within(0.0, 0.25), within(0.25, 0.5), within(0.5, 1.0)], [450, 450, 100]);
    }

    #[test]
    fn it_is_read_back() {
        let strata = example();
        assert_eq!(Strata::from_written(2, &strata.written()), Some(strata));
        assert_eq!(Strata::from_written(2, &[None]).unwrap().count(), 1);
        let deep: Vec<Written> = std::iter::repeat_n(Some((0, 0.5)), 60).chain([None; 61]).collect();
        for wrong in
            [&[][..], &[Some((2, 0.5)), None, None], &[Some((0, 1.0)), None, None], &[None, None], &deep]
        {
            assert_eq!(Strata::from_written(2, wrong), None, "{wrong:?}");
        }
    }
}
