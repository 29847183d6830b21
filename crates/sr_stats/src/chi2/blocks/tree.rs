//! Cells that hold equally many points: a box, halved again and again at the median.
//!
//! The cells are cut further, into leaves of a few points, of which empty space is cut off: where a support
//! is thin, or a density steep, leaves follow it.

/// A tree of cuts of the unit cube, into cells and on into leaves.
pub struct Tree {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    cells: usize,
}

/// A box, and the cell that it is a part of.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// (low, high) along each axis.
    pub sides: Vec<[f64; 2]>,
    /// The points that it holds.
    pub points: Vec<Vec<f64>>,
    pub cell: usize,
    /// Along which it is to be halved next.
    axis: usize,
}

impl Leaf {
    /// Both halves, along each axis in turn.
    pub fn halves(self) -> [Self; 2] {
        let axis = self.axis;
        let [low, high] = self.sides[axis];
        let middle = 0.5 * (low + high);
        let (below, above) = self.points.into_iter().partition(|point| point[axis] < middle);
        let next = (axis + 1) % self.sides.len();
        [([low, middle], below), ([middle, high], above)].map(|(side, points)| {
            let mut sides = self.sides.clone();
            sides[axis] = side;
            Self { sides, points, cell: self.cell, axis: next }
        })
    }
}

/// A leaf has no more points than this.
const LEAF: usize = 4;
/// Empty space at one end of a leaf is cut off if it is more than this share of the side …
const EMPTY: f64 = 0.25;
/// … and, of more than [`FEW_AXES`], if by chance so many sides of a leaf are as empty.
const BY_CHANCE: f64 = 0.5;
const FEW_AXES: usize = 6;

enum Node {
    /// Below `at` along `axis` is the next node, the others are at `above`.
    Split { axis: usize, at: f64, above: usize },
    /// Of this cell.
    Leaf(usize),
}

impl Tree {
    /// About `wanted` cells, from points in the unit cube.
    pub fn new(points: Vec<Vec<f64>>, wanted: usize) -> Self {
        let dim = points.first().map_or(0, Vec::len);
        let mut tree = Self { nodes: Vec::new(), leaves: Vec::new(), cells: usize::from(wanted < 2) };
        let halvings = wanted.max(1).ilog2() as usize;
        tree.grow(points, vec![[0.0, 1.0]; dim], 0, halvings);
        tree
    }

    /// Cuts a box that holds some points. It is a cell, or a part of one, if it was halved often enough.
    fn grow(&mut self, mut points: Vec<Vec<f64>>, sides: Vec<[f64; 2]>, depth: usize, halvings: usize) {
        if depth >= halvings
            && let Some((axis, at)) = empty_space(&points, &sides)
        {
            self.cut(axis, at, points, sides, (depth, depth), halvings);
            return;
        }
        // Axes in turn; one along which the points cannot be parted is left out.
        let dim = sides.len();
        let mut axes = (0..dim).map(|k| (depth + k) % dim);
        let median = axes.find_map(|axis| {
            let middle = points.len() / 2;
            let (_, median, _) = points.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis]));
            let (at, [low, high]) = (median[axis], sides[axis]);
            (at > low && at < high).then_some((axis, at))
        });
        match median.filter(|_| points.len() > LEAF) {
            Some((axis, at)) => self.cut(axis, at, points, sides, (depth, depth + 1), halvings),
            None => {
                if depth < halvings {
                    self.cells += 1; // a cell that cannot be halved as often as others
                }
                self.leaf(sides, points);
            }
        }
    }

    /// Cuts a box in two, whose depth was the first and becomes the second.
    fn cut(
        &mut self,
        axis: usize,
        at: f64,
        points: Vec<Vec<f64>>,
        sides: Vec<[f64; 2]>,
        (was, depth): (usize, usize),
        halvings: usize,
    ) {
        let (below, above): (Vec<_>, Vec<_>) = points.into_iter().partition(|point| point[axis] < at);
        let (mut low_half, mut high_half) = (sides.clone(), sides);
        low_half[axis][1] = at;
        high_half[axis][0] = at;
        let place = self.nodes.len();
        self.nodes.push(Node::Split { axis, at, above: 0 });
        for (points, sides) in [(below, low_half), (above, high_half)] {
            let next = self.nodes.len();
            if let Node::Split { above, .. } = &mut self.nodes[place] {
                *above = next; // what is written last
            }
            if was < halvings && (depth == halvings || points.is_empty()) {
                self.cells += 1;
            }
            if points.is_empty() {
                self.leaf(sides, points)
            } else {
                self.grow(points, sides, depth, halvings)
            }
        }
    }

    fn leaf(&mut self, sides: Vec<[f64; 2]>, points: Vec<Vec<f64>>) {
        let cell = self.cells - 1;
        self.nodes.push(Node::Leaf(cell));
        self.leaves.push(Leaf { sides, points, cell, axis: 0 });
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// The leaves, those of a cell side by side.
    pub fn leaves(&self) -> &[Leaf] {
        &self.leaves
    }

    /// The least box that holds a cell.
    pub fn sides(&self, cell: usize) -> Vec<[f64; 2]> {
        let join = |a: Vec<[f64; 2]>, b: Vec<[f64; 2]>| {
            a.iter().zip(b).map(|(a, b)| [a[0].min(b[0]), a[1].max(b[1])]).collect()
        };
        let leaves = self.leaves.iter().filter(|leaf| leaf.cell == cell).map(|leaf| leaf.sides.clone());
        leaves.reduce(join).unwrap_or_default()
    }

    /// The cell that holds a point of the unit cube.
    pub fn find(&self, point: &[f64]) -> usize {
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Split { axis, at, above } => node = if point[axis] < at { node + 1 } else { above },
                Node::Leaf(cell) => return cell,
            }
        }
    }
}

/// An axis and a number at which nothing but empty space is cut off.
fn empty_space(points: &[Vec<f64>], sides: &[[f64; 2]]) -> Option<(usize, f64)> {
    // The more sides, the emptier is the emptiest by chance: k points leave a share s of one empty with (1 − s)ᵏ.
    let share = if sides.len() <= FEW_AXES {
        EMPTY
    } else {
        EMPTY.max(1.0 - (0.5 * BY_CHANCE / sides.len() as f64).powf(1.0 / points.len().max(1) as f64))
    };
    sides.iter().enumerate().find_map(|(axis, &[low, high])| {
        let along = || points.iter().map(|point| point[axis]);
        let (first, last) = (along().fold(high, f64::min), along().fold(low, f64::max));
        let enough = share * (high - low);
        if first - low > enough {
            Some((axis, first))
        } else if high - last > enough && last.next_up() < high {
            Some((axis, last.next_up()))
        } else {
            None
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_holds_the_same_number_of_points() {
        let fraction = |x: f64| x - x.floor();
        let points: Vec<Vec<f64>> =
            (0..1024).map(|i| vec![fraction(f64::from(i) * 0.618).powi(3), f64::from(i) / 1024.0]).collect();
        let tree = Tree::new(points.clone(), 64);
        let mut counts = vec![0; tree.cells()];
        for point in &points {
            let cell = tree.find(point);
            assert!(point.iter().zip(tree.sides(cell)).all(|(&x, [low, high])| x >= low && x <= high));
            counts[cell] += 1;
        }
        assert_eq!(counts, [16; 64]);
        let leaves = tree.leaves();
        assert!(leaves.len() > 256 && leaves.is_sorted_by_key(|leaf| leaf.cell));
        let volume: f64 = leaves.iter().map(|l| l.sides.iter().map(|[a, b]| b - a).product::<f64>()).sum();
        assert!((volume - 1.0).abs() < 1e-12);
    }
}
