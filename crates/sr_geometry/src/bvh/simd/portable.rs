//! Plain Rust, which compilers turn into SSE2 or NEON.

use super::super::slabs::Line;
use super::super::stack::Stack;
use super::super::{Node, NodeRef, WIDE, WIDTH};
use super::{Eight, Lanes, Walk};

/// Eight lanes in an array.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Portable;

#[inline(always)]
fn each<R>(f: impl Fn(usize) -> R) -> [R; WIDTH] {
    std::array::from_fn(f)
}

impl Lanes for Portable {
    type F = [f32; WIDTH];
    type Mask = [bool; WIDTH];
    const COUNT: usize = WIDTH;

    #[inline(always)]
    fn splat(self, x: f32) -> Self::F {
        [x; WIDTH]
    }
    #[inline(always)]
    fn load_part(self, x: &[f32; WIDE], part: usize) -> Self::F {
        each(|i| x[part * WIDTH + i])
    }
    #[inline(always)]
    fn load_at(self, x: &[f32], first: usize) -> Self::F {
        let x = &x[first..first + WIDTH];
        each(|i| x[i])
    }
    #[inline(always)]
    fn store_at(self, x: Self::F, to: &mut [f32], first: usize) {
        to[first..first + WIDTH].copy_from_slice(&x);
    }
    #[inline(always)]
    fn store_bits_at(self, x: Self::F, to: &mut [u32], first: usize) {
        to[first..first + WIDTH].copy_from_slice(&x.map(f32::to_bits));
    }
    #[inline(always)]
    fn gather(self, table: &[u32], at: Self::F) -> Self::F {
        each(|i| f32::from_bits(table[(at[i] as usize).min(table.len() - 1)]))
    }
    #[inline(always)]
    fn extract(self, x: Self::F, lane: usize) -> f32 {
        x[lane % WIDTH]
    }
    #[inline(always)]
    fn add(self, a: Self::F, b: Self::F) -> Self::F {
        each(|i| a[i] + b[i])
    }
    #[inline(always)]
    fn sub(self, a: Self::F, b: Self::F) -> Self::F {
        each(|i| a[i] - b[i])
    }
    #[inline(always)]
    fn mul(self, a: Self::F, b: Self::F) -> Self::F {
        each(|i| a[i] * b[i])
    }
    #[inline(always)]
    fn div(self, a: Self::F, b: Self::F) -> Self::F {
        each(|i| a[i] / b[i])
    }
    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        each(|i| if a[i] < b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        each(|i| if a[i] > b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn abs(self, x: Self::F) -> Self::F {
        each(|i| x[i].abs())
    }
    #[inline(always)]
    fn sqrt(self, x: Self::F) -> Self::F {
        each(|i| x[i].sqrt())
    }
    #[inline(always)]
    fn flip(self, x: Self::F, sign: Self::F) -> Self::F {
        each(|i| f32::from_bits(x[i].to_bits() ^ (sign[i].to_bits() & 1 << 31)))
    }
    #[inline(always)]
    fn le(self, a: Self::F, b: Self::F) -> Self::Mask {
        each(|i| a[i] <= b[i])
    }
    #[inline(always)]
    fn lt(self, a: Self::F, b: Self::F) -> Self::Mask {
        each(|i| a[i] < b[i])
    }
    #[inline(always)]
    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        each(|i| a[i] & b[i])
    }
    #[inline(always)]
    fn or(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        each(|i| a[i] | b[i])
    }
    #[inline(always)]
    fn bits(self, mask: Self::Mask) -> u32 {
        (0..WIDTH).fold(0, |bits, i| bits | u32::from(mask[i]) << i)
    }
    #[inline(always)]
    fn mask(self, bits: u32) -> Self::Mask {
        each(|i| bits >> i & 1 != 0)
    }
    #[inline(always)]
    fn select(self, mask: Self::Mask, a: Self::F, b: Self::F) -> Self::F {
        each(|i| if mask[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn least(self, x: Self::F) -> f32 {
        x.into_iter().fold(f32::INFINITY, f32::min)
    }
}

impl Eight for Portable {
    #[inline(always)]
    fn load(self, x: &[f32; WIDTH]) -> Self::F {
        *x
    }
}

impl Walk for Portable {
    type Eight = Self;

    #[inline(always)]
    fn eight(self) -> Self {
        self
    }
    #[inline(always)]
    fn enter<const ANY: bool>(
        self,
        line: &Line,
        t_max: f32,
        node: &Node,
        flip: u32,
        stack: &mut Stack,
    ) -> NodeRef {
        let parts: [_; WIDE / WIDTH] = line.meet(self, node, t_max);
        for place in 0..WIDE as u32 {
            let slot = (place ^ flip) as usize % WIDE;
            let [enter, leave] = parts[slot / WIDTH].map(|of_part| of_part[slot % WIDTH]);
            let [child, at] = stack.top();
            // SAFETY: the top of the stack has room for as many children as a node has.
            unsafe {
                (*child.cast(), *at.cast()) = (node.children[slot], enter);
                stack.keep(u32::from(enter <= leave));
            }
        }
        stack.pop()
    }
    #[inline(always)]
    unsafe fn forget_beyond(self, t_max: f32, within: u32, from: [*mut u32; 2], to: [*mut u32; 2]) -> u32 {
        let mut kept = 0;
        for i in 0..within.trailing_ones() as usize {
            // SAFETY: by the caller's promise these were written, and there is room for as many.
            unsafe {
                let (child, enter) = (*from[0].add(i), *from[1].add(i));
                (*to[0].add(kept), *to[1].add(kept)) = (child, enter);
                kept += usize::from(f32::from_bits(enter) <= t_max);
            }
        }
        kept as u32
    }
    #[inline(always)]
    fn prefetch(self, _at: *const u8) {}
}
