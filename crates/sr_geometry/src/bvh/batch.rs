//! Meeting a tree with many rays: the instruction set is chosen once for all of them.
//!
//! Small trees are met by packets, and ray by ray where a packet is in doubt; others that have nodes by several rays in
//! turn, and those without ray by ray.

use super::dispatch::meet;

use super::packet;
#[cfg(target_arch = "x86_64")]
use super::simd::{Avx2, Avx512};
use super::simd::{Kernel, Walk};
use super::stream::walk_many;
use super::{Bvh, Form, Met, Pieces, Tree};
use crate::{BATCH, Hit, Hits, Ray, Rays};

impl Bvh {
    /// The closest hits of the first `count` rays. `meet_other` is as for [`Bvh::intersect`].
    pub fn intersect_batch(
        &self,
        tree: &Tree,
        (rays, count): (&Rays, usize),
        meet_other: impl Fn(u32, &Ray) -> Met,
        hits: &mut Hits,
    ) {
        self.kernel.run(Closest { batch: Batch { bvh: self, tree, rays, count, meet_other }, hits });
    }

    /// Which of the first `count` rays hit anything?
    pub fn occluded_batch(
        &self,
        tree: &Tree,
        (rays, count): (&Rays, usize),
        meet_other: impl Fn(u32, &Ray) -> Met,
        occluded: &mut [bool; BATCH],
    ) {
        self.kernel.run(Any { batch: Batch { bvh: self, tree, rays, count, meet_other }, occluded });
    }
}

/// What is done with an instruction set.
trait Work {
    /// Always to be inlined.
    fn run<S: Walk>(self, simd: S);
}

impl Kernel {
    #[inline(always)]
    fn run(self, work: impl Work) {
        match self {
            // SAFETY: an `Avx512` is the proof that this processor has these features.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx512(avx512) => unsafe { run_avx512(avx512, work) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2(avx2) => unsafe { run_avx2(avx2, work) },
            Kernel::Portable(portable) => work.run(portable),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn run_avx512(avx512: Avx512, work: impl Work) {
    work.run(avx512);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn run_avx2(avx2: Avx2, work: impl Work) {
    work.run(avx2);
}

/// Rays and the tree that they meet.
struct Batch<'a, F> {
    bvh: &'a Bvh,
    tree: &'a Tree,
    rays: &'a Rays,
    count: usize,
    meet_other: F,
}

impl<F: Fn(u32, &Ray) -> Met> Batch<'_, F> {
    /// What packets meet, if they can.
    #[inline(always)]
    fn pieces(&self) -> Option<&Pieces> {
        self.tree.pieces.map(|pieces| &self.bvh.pieces[pieces as usize])
    }

    /// Meets the tree with several rays in turn, or ray by ray if it has no nodes; `answer(i, hit)` gets what ray i hits.
    #[inline(always)]
    fn meet<S: Walk, const ANY: bool>(&self, simd: S, mut answer: impl FnMut(usize, Option<&Hit>)) {
        let Self { bvh, tree, rays, count, ref meet_other } = *self;
        match tree.form {
            Form::Nodes(root) => {
                let root = (root, &tree.bounds);
                walk_many::<_, ANY>(simd, bvh, root, (rays, count), meet_other, answer);
            }
            // No closure: it might be compiled without the instruction set.
            _ => {
                for i in 0..count {
                    self.meet_one::<_, ANY>(simd, i, &mut answer);
                }
            }
        }
    }

    /// As `meet`, with one ray.
    #[inline(always)]
    fn meet_one<S: Walk, const ANY: bool>(
        &self,
        simd: S,
        i: usize,
        mut answer: impl FnMut(usize, Option<&Hit>),
    ) {
        let Self { bvh, tree, rays, ref meet_other, .. } = *self;
        let ray = rays.get(i);
        let mut hit = Hit::none_before(ray.t_max);
        let any = meet::<_, ANY>(simd, (bvh, tree), &ray, meet_other, &mut hit);
        answer(i, any.then_some(&hit));
    }
}

/// Takes the lowest of some bits.
#[inline(always)]
fn take_lowest(bits: &mut u32) -> Option<usize> {
    let lowest = bits.trailing_zeros() as usize;
    let any = *bits != 0;
    *bits &= bits.wrapping_sub(1);
    any.then_some(lowest)
}

struct Closest<'a, F> {
    batch: Batch<'a, F>,
    hits: &'a mut Hits,
}

impl<F: Fn(u32, &Ray) -> Met> Work for Closest<'_, F> {
    #[inline(always)]
    fn run<S: Walk>(self, simd: S) {
        let Self { batch, hits } = self;
        let Some(pieces) = batch.pieces() else {
            return batch.meet::<_, false>(simd, |i, hit| hits.set(i, hit));
        };
        for first in (0..batch.count).step_by(S::COUNT) {
            let mut doubtful = packet::closest(simd, pieces, batch.rays, (first, batch.count), hits);
            while let Some(lane) = take_lowest(&mut doubtful) {
                batch.meet_one::<_, false>(simd, first + lane, |i, hit| hits.set(i, hit));
            }
        }
    }
}

struct Any<'a, F> {
    batch: Batch<'a, F>,
    occluded: &'a mut [bool; BATCH],
}

impl<F: Fn(u32, &Ray) -> Met> Work for Any<'_, F> {
    #[inline(always)]
    fn run<S: Walk>(self, simd: S) {
        let Self { batch, occluded } = self;
        let Some(pieces) = batch.pieces() else {
            return batch.meet::<_, true>(simd, |i, hit| occluded[i] = hit.is_some());
        };
        for first in (0..batch.count).step_by(S::COUNT) {
            let (hit, mut doubtful) = packet::any(simd, pieces, batch.rays, (first, batch.count));
            for (lane, occluded) in occluded[first..][..S::COUNT].iter_mut().enumerate() {
                *occluded = hit >> lane & 1 != 0;
            }
            while let Some(lane) = take_lowest(&mut doubtful) {
                let answer = |i: usize, hit: Option<&Hit>| occluded[i] = hit.is_some();
                batch.meet_one::<_, true>(simd, first + lane, answer);
            }
        }
    }
}
