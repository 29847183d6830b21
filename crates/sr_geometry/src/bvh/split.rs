//! Where to cut a list of primitives in two: the binned surface area heuristic (Wald 2007).

use glam::Vec3;
use rayon::prelude::*;

use super::{PrimRef, WIDTH};
use crate::Bounds3;

/// Bins per axis.
const BINS: usize = 32;

/// Lists from this length on are binned in parallel.
const PARALLEL: usize = 1 << 16;

/// Boxes around primitives, and around the centres of their boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub bounds: Bounds3,
    centers: Bounds3,
}

impl Extent {
    const EMPTY: Self = Self { bounds: Bounds3::EMPTY, centers: Bounds3::EMPTY };

    pub fn of(prims: &[PrimRef]) -> Self {
        let of = |prims: &[PrimRef]| prims.iter().fold(Self::EMPTY, |extent, p| extent.with(p));
        if prims.len() < PARALLEL {
            return of(prims);
        }
        prims.par_chunks(PARALLEL / 4).map(of).reduce(|| Self::EMPTY, Self::union)
    }

    fn with(self, prim: &PrimRef) -> Self {
        Self { bounds: self.bounds.union(prim.bounds), centers: self.centers.with(prim.bounds.center()) }
    }

    fn union(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), centers: self.centers.union(other.centers) }
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds3,
    count: usize,
}

type Bins = [[Bin; BINS]; 3];

const NO_BINS: Bins = [[Bin { bounds: Bounds3::EMPTY, count: 0 }; BINS]; 3];

/// Maps the centre of a box to its bin on each axis.
#[derive(Clone, Copy)]
struct Binning {
    min: Vec3,
    /// Bins per unit of length; 0 on an axis where all centres agree, so that all are in bin 0.
    scale: Vec3,
}

impl Binning {
    fn new(centers: &Bounds3) -> Self {
        let scale = (BINS as f32 * 0.9999) / centers.extent();
        Self { min: centers.min, scale: scale.map(|s| if s.is_finite() { s } else { 0.0 }) }
    }

    #[inline]
    fn bin(&self, prim: &PrimRef, axis: usize) -> usize {
        let i = (prim.bounds.center()[axis] - self.min[axis]) * self.scale[axis];
        (i as usize).min(BINS - 1)
    }

    fn fill(&self, prims: &[PrimRef]) -> Bins {
        let fill = |prims: &[PrimRef]| {
            let mut bins = NO_BINS;
            for prim in prims {
                for (axis, bins) in bins.iter_mut().enumerate() {
                    let bin = &mut bins[self.bin(prim, axis)];
                    bin.bounds = bin.bounds.union(prim.bounds);
                    bin.count += 1;
                }
            }
            bins
        };
        if prims.len() < PARALLEL {
            return fill(prims);
        }
        // Minima, maxima and counts: the order of the reduction does not matter.
        prims.par_chunks(PARALLEL / 4).map(fill).reduce(
            || NO_BINS,
            |mut a, b| {
                for (a, b) in a.as_flattened_mut().iter_mut().zip(b.as_flattened()) {
                    a.bounds = a.bounds.union(b.bounds);
                    a.count += b.count;
                }
                a
            },
        )
    }
}

/// What a list of primitives costs where it is hit: one test for each block it fills.
pub(super) fn cost(count: usize) -> f32 {
    count.div_ceil(WIDTH) as f32
}

/// Reorders `prims` and returns where to cut them and the cost of the cut, Σ area × [`cost`].
/// Both parts are non-empty. `None` where no plane separates the centres.
pub(super) fn split_sah(prims: &mut [PrimRef], extent: &Extent) -> Option<(usize, f32)> {
    let binning = Binning::new(&extent.centers);
    let bins = binning.fill(prims);
    let mut best: Option<(f32, usize, usize)> = None;
    for (axis, bins) in bins.iter().enumerate().filter(|(axis, _)| binning.scale[*axis] > 0.0) {
        let mut right_costs = [0.0; BINS];
        let (mut bounds, mut count) = (Bounds3::EMPTY, 0);
        for i in (1..BINS).rev() {
            bounds = bounds.union(bins[i].bounds);
            count += bins[i].count;
            right_costs[i] = bounds.half_area() * cost(count);
        }
        let (mut bounds, mut left) = (Bounds3::EMPTY, 0);
        for i in 1..BINS {
            bounds = bounds.union(bins[i - 1].bounds);
            left += bins[i - 1].count;
            let total = bounds.half_area() * cost(left) + right_costs[i];
            if left > 0 && left < prims.len() && best.is_none_or(|(least, ..)| total < least) {
                best = Some((total, axis, i));
            }
        }
    }
    let (total, axis, bin) = best?;
    Some((partition(prims, |prim| binning.bin(prim, axis) < bin), total))
}

/// Cuts a list of at least two in the middle along the widest axis: the fallback that bounds the depth.
pub(super) fn split_middle(prims: &mut [PrimRef], extent: &Extent) -> usize {
    let axis = extent.centers.extent().max_position();
    let middle = prims.len() / 2;
    let key = |p: &PrimRef| p.bounds.center()[axis];
    prims.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
    middle
}

/// Moves the primitives for which `is_left` holds to the front; returns their number.
fn partition(prims: &mut [PrimRef], is_left: impl Fn(&PrimRef) -> bool) -> usize {
    let (mut left, mut right) = (0, prims.len());
    loop {
        while left < right && is_left(&prims[left]) {
            left += 1;
        }
        while left < right && !is_left(&prims[right - 1]) {
            right -= 1;
        }
        if left >= right {
            return left;
        }
        prims.swap(left, right - 1);
    }
}
