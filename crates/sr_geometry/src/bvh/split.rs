//! Where to cut a list of primitives in two: the binned surface area heuristic (Wald 2007).

use glam::Vec4;
use rayon::prelude::*;

use super::prim::Lanes;
use super::{PrimRef, WIDTH};

/// Lists from this length on are binned in parallel.
const PARALLEL: usize = 1 << 16;

/// Boxes around primitives, and around the centres of their boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub bounds: Lanes,
    centers: Lanes,
}

impl Extent {
    const EMPTY: Self = Self { bounds: Lanes::EMPTY, centers: Lanes::EMPTY };

    pub fn of(prims: &[PrimRef]) -> Self {
        let of = |prims: &[PrimRef]| prims.iter().fold(Self::EMPTY, |extent, p| extent.with(p));
        if prims.len() < PARALLEL {
            return of(prims);
        }
        prims.par_chunks(PARALLEL / 4).map(of).reduce(|| Self::EMPTY, Self::union)
    }

    /// As [`Extent::of`] where the first of its boxes is known.
    pub fn within(bounds: Lanes, prims: &[PrimRef]) -> Self {
        let of = |prims: &[PrimRef]| {
            prims.iter().fold(Lanes::EMPTY, |centers, prim| centers.with(prim.lanes().center()))
        };
        if prims.len() < PARALLEL {
            return Self { bounds, centers: of(prims) };
        }
        Self { bounds, centers: prims.par_chunks(PARALLEL / 4).map(of).reduce(|| Lanes::EMPTY, Lanes::union) }
    }

    #[inline(always)]
    fn with(self, prim: &PrimRef) -> Self {
        let bounds = prim.lanes();
        Self { bounds: self.bounds.union(bounds), centers: self.centers.with(bounds.center()) }
    }

    fn union(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), centers: self.centers.union(other.centers) }
    }
}

/// Maps the centre of a box to one of `N` bins on each axis.
#[derive(Clone, Copy)]
struct Binning<const N: usize> {
    min: Vec4,
    /// Bins per unit of length; 0 on an axis where all centres agree, so that all are in bin 0.
    scale: Vec4,
}

/// Added to a number below it, this leaves the number, rounded to an integer, in the lowest bits of the sum.
const ROUND: f32 = (1 << 23) as f32;

impl<const N: usize> Binning<N> {
    fn new(centers: &Lanes) -> Self {
        let scale = N as f32 / centers.extent();
        Self { min: centers.min, scale: Vec4::select(scale.is_finite_mask(), scale, Vec4::ZERO) }
    }

    /// The bins on x, y and z; below `N`.
    #[inline(always)]
    fn bins(&self, prim: Lanes) -> [usize; 3] {
        let at = (prim.center() - self.min) * self.scale - 0.5;
        let [x, y, z, _] = (at.max(Vec4::ZERO).min(Vec4::splat((N - 1) as f32)) + ROUND).to_array();
        [x, y, z].map(|at| at.to_bits() as usize % N)
    }

    /// The same bin on one of the axes.
    #[inline(always)]
    fn bin(&self, prim: &PrimRef, axis: usize) -> usize {
        let at = (prim.center(axis) - self.min[axis]) * self.scale[axis] - 0.5;
        (at.max(0.0).min((N - 1) as f32) + ROUND).to_bits() as usize % N
    }
}

/// What is in the bins, by bin, then axis.
struct Bins<const N: usize> {
    bounds: [[Lanes; 3]; N],
    counts: [[u32; 3]; N],
}

impl<const N: usize> Bins<N> {
    const EMPTY: Self = Self { bounds: [[Lanes::EMPTY; 3]; N], counts: [[0; 3]; N] };

    fn of(prims: &[PrimRef], binning: &Binning<N>) -> Self {
        let fill = |prims: &[PrimRef]| {
            let mut all = Self::EMPTY;
            for prim in prims {
                let bounds = prim.lanes();
                let bins = binning.bins(bounds);
                for axis in 0..3 {
                    let bin = &mut all.bounds[bins[axis]][axis];
                    *bin = bin.union(bounds);
                    all.counts[bins[axis]][axis] += 1;
                }
            }
            all
        };
        if prims.len() < PARALLEL {
            return fill(prims);
        }
        // Minima, maxima and counts: the order of the reduction does not matter.
        prims.par_chunks(PARALLEL / 4).map(fill).reduce(|| Self::EMPTY, Self::union)
    }

    fn union(mut self, other: Self) -> Self {
        for bin in 0..N {
            for axis in 0..3 {
                self.bounds[bin][axis] = self.bounds[bin][axis].union(other.bounds[bin][axis]);
                self.counts[bin][axis] += other.counts[bin][axis];
            }
        }
        self
    }

    /// The cheapest cut that leaves neither side empty.
    fn cheapest(&self, count: u32) -> Option<Plane> {
        let mut right_costs = [[0.0; 3]; N];
        let (mut bounds, mut counts) = ([Lanes::EMPTY; 3], [0; 3]);
        for bin in (1..N).rev() {
            for axis in 0..3 {
                bounds[axis] = bounds[axis].union(self.bounds[bin][axis]);
                counts[axis] += self.counts[bin][axis];
                right_costs[bin][axis] = bounds[axis].half_area() * cost(counts[axis]);
            }
        }
        let mut best = Plane { total: f32::INFINITY, axis: 0, bin: 0 };
        let (mut bounds, mut counts) = ([Lanes::EMPTY; 3], [0; 3]);
        for bin in 1..N {
            for axis in 0..3 {
                bounds[axis] = bounds[axis].union(self.bounds[bin - 1][axis]);
                counts[axis] += self.counts[bin - 1][axis];
                let total = bounds[axis].half_area() * cost(counts[axis]) + right_costs[bin][axis];
                if total < best.total && counts[axis] > 0 && counts[axis] < count {
                    best = Plane { total, axis, bin };
                }
            }
        }
        (best.bin > 0).then_some(best)
    }

    /// The boxes of what is left and right of a plane.
    fn sides(&self, plane: &Plane) -> [Lanes; 2] {
        let (left, right) = self.bounds.split_at(plane.bin);
        [left, right].map(|bins| bins.iter().fold(Lanes::EMPTY, |all, bin| all.union(bin[plane.axis])))
    }
}

/// A plane between bins: below `bin` on `axis`, or not.
struct Plane {
    /// Σ area × [`cost`] of the two sides.
    total: f32,
    axis: usize,
    bin: usize,
}

/// What a list of primitives costs where it is hit: one test for each block it fills.
#[inline(always)]
fn cost(count: u32) -> f32 {
    // Through `i32`, which is one instruction.
    count.div_ceil(WIDTH as u32) as i32 as f32
}

/// A list cut in two: the length of the first part, and the extents of both.
pub(super) struct Cut {
    pub middle: usize,
    pub parts: [Extent; 2],
}

impl Cut {
    fn new(prims: &[PrimRef], middle: usize, [left, right]: [Lanes; 2]) -> Self {
        let (first, second) = prims.split_at(middle);
        Self { middle, parts: [Extent::within(left, first), Extent::within(right, second)] }
    }
}

/// Reorders and cuts `prims`, unless the parts' Σ area × [`cost`] is above `limit`. Both parts are non-empty.
/// `None` also where no plane separates the centres.
pub(super) fn split_sah(prims: &mut [PrimRef], extent: &Extent, limit: f32) -> Option<Cut> {
    // Bins beyond the number of primitives tell little apart.
    match prims.len() {
        ..=16 => split_binned::<8>(prims, extent, limit),
        17..=64 => split_binned::<16>(prims, extent, limit),
        _ => split_binned::<32>(prims, extent, limit),
    }
}

fn split_binned<const N: usize>(prims: &mut [PrimRef], extent: &Extent, limit: f32) -> Option<Cut> {
    let binning = Binning::<N>::new(&extent.centers);
    let bins = Bins::of(prims, &binning);
    let plane = bins.cheapest(prims.len() as u32).filter(|plane| plane.total <= limit)?;
    let middle = partition(prims, |prim| binning.bin(prim, plane.axis) < plane.bin);
    Some(Cut::new(prims, middle, bins.sides(&plane)))
}

/// Cuts a list of at least two in the middle along the widest axis: the fallback that bounds the depth.
pub(super) fn split_middle(prims: &mut [PrimRef], extent: &Extent) -> Cut {
    let axis = extent.centers.extent().truncate().max_position();
    let middle = prims.len() / 2;
    prims.select_nth_unstable_by(middle, |a, b| a.center(axis).total_cmp(&b.center(axis)));
    let (first, second) = prims.split_at(middle);
    Cut { middle, parts: [Extent::of(first), Extent::of(second)] }
}

/// Moves the primitives for which `is_left` holds to the front; returns their number. Without branches, which would be
/// guessed wrongly half of the time.
#[inline(always)]
fn partition(prims: &mut [PrimRef], is_left: impl Fn(&PrimRef) -> bool) -> usize {
    let mut left = 0;
    for i in 0..prims.len() {
        let goes_left = is_left(&prims[i]);
        prims.swap(i, left);
        left += usize::from(goes_left);
    }
    left
}
