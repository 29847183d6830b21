//! Several `f32` at once: the few operations that traversal needs, in AVX-512, in AVX2 and in plain Rust.
//!
//! All give the same bits: nothing is fused or reassociated, and `min` and `max` treat NaN alike.
//!
//! Whoever calls these methods is compiled for the instruction set of its caller only if it is a function that is
//! always inlined; a closure is not.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod portable;

#[cfg(target_arch = "x86_64")]
pub(super) use {avx2::Avx2, avx512::Avx512};

pub(super) use portable::Portable;

use super::slabs::Line;
use super::stack::Stack;
use super::{Node, NodeRef, WIDE, WIDTH};

/// A number of lanes. `min(a, b)` and `max(a, b)` return `b` where either is NaN.
pub(super) trait Lanes: Copy {
    type F: Copy;
    type Mask: Copy;
    /// How many, a divisor of [`WIDE`].
    const COUNT: usize;
    fn splat(self, x: f32) -> Self::F;
    /// `x[part * COUNT ..][.. COUNT]`
    fn load_part(self, x: &[f32; WIDE], part: usize) -> Self::F;
    /// `x[first ..][.. COUNT]`
    fn load_at(self, x: &[f32], first: usize) -> Self::F;
    /// Writes `to[first ..][.. COUNT]`.
    fn store_at(self, x: Self::F, to: &mut [f32], first: usize);
    /// Writes the bits to `to[first ..][.. COUNT]`.
    fn store_bits_at(self, x: Self::F, to: &mut [u32], first: usize);
    /// The bits `table[at[i]]`, where `at` are whole numbers; those beyond the end of the table mean its last entry.
    fn gather(self, table: &[u32], at: Self::F) -> Self::F;
    /// x[lane]; `lane` is taken modulo the count.
    fn extract(self, x: Self::F, lane: usize) -> f32;
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    fn abs(self, x: Self::F) -> Self::F;
    /// Correctly rounded.
    fn sqrt(self, x: Self::F) -> Self::F;
    /// x[i], negated where `sign[i]` has its sign bit set.
    fn flip(self, x: Self::F, sign: Self::F) -> Self::F;
    /// a[i] ≤ b[i]; false where either is NaN.
    fn le(self, a: Self::F, b: Self::F) -> Self::Mask;
    /// a[i] < b[i]; false where either is NaN.
    fn lt(self, a: Self::F, b: Self::F) -> Self::Mask;
    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn or(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Bit i: is lane i set?
    fn bits(self, mask: Self::Mask) -> u32;
    /// The lanes whose bits are set.
    fn mask(self, bits: u32) -> Self::Mask;
    /// a[i] where the mask is set, else b[i].
    fn select(self, mask: Self::Mask, a: Self::F, b: Self::F) -> Self::F;
    /// The smallest lane. None may be NaN.
    fn least(self, x: Self::F) -> f32;
}

/// Eight lanes.
pub(super) trait Eight: Lanes {
    fn load(self, x: &[f32; WIDTH]) -> Self::F;
}

/// What walking a tree needs of an instruction set. None of it branches: several walks go in turn, and a branch that is
/// guessed wrongly costs the work of all.
pub(super) trait Walk: Lanes {
    /// Eight lanes, for the triangles of a leaf.
    type Eight: Eight;
    fn eight(self) -> Self::Eight;
    /// Of the children of a node that a ray meets before `t_max`, in the order of their slots, pushes all but the nearest
    /// and returns that; or else what the stack has on top. `ANY`: does not keep where they are entered.
    /// `flip`: the bits to be flipped in the slots' numbers.
    fn enter<const ANY: bool>(
        self,
        line: &Line,
        t_max: f32,
        node: &Node,
        flip: u32,
        stack: &mut Stack,
    ) -> NodeRef;
    /// Copies those of the children at `from` that are `within`, bit by bit, and entered not beyond `t_max`, to
    /// `to`; returns their number. Up to [`WIDTH`] are overwritten there.
    ///
    /// # Safety
    /// Both are places of [`WIDTH`] children, and of as many numbers that tell where they are entered. At `from` those that are
    /// `within`, the lowest bits, were written; `to` is not beyond `from`, or does not overlap it.
    unsafe fn forget_beyond(self, t_max: f32, within: u32, from: [*mut u32; 2], to: [*mut u32; 2]) -> u32;
    /// Asks for the cache line of a byte that may be needed soon. Any address will do: nothing is read.
    fn prefetch(self, at: *const u8);
}

/// The instruction set that traversal uses, chosen when the tree is built.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kernel {
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    Portable(Portable),
}

impl Kernel {
    /// The fastest that this processor has.
    pub fn detect() -> Self {
        Self::available().next().unwrap_or(Self::Portable(Portable))
    }

    /// Those that this processor has, fastest first.
    pub fn available() -> impl Iterator<Item = Self> {
        let kernels = [
            #[cfg(target_arch = "x86_64")]
            Avx512::detect().map(Self::Avx512),
            #[cfg(target_arch = "x86_64")]
            Avx2::detect().map(Self::Avx2),
            Some(Self::Portable(Portable)),
        ];
        kernels.into_iter().flatten()
    }
}
