//! Plain Rust, which compilers turn into SSE2 or NEON.

use glam::Vec3A;

use super::super::sheared::Order;
use super::super::{WIDE, WIDTH};
use super::{LANE, Lanes, Simd};

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
    fn permute(self, v: Vec3A, order: &Order) -> Vec3A {
        let [x, y, z, _] = order.0;
        Vec3A::new(v[x as usize], v[y as usize], v[z as usize])
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

impl Simd for Portable {
    type Keys = [u32; WIDTH];

    #[inline(always)]
    fn load(self, x: &[f32; WIDTH]) -> Self::F {
        *x
    }
    #[inline(always)]
    fn keys(self, x: Self::F, limit: Self::F) -> Self::Keys {
        each(|i| if x[i] <= limit[i] { x[i].to_bits() & !LANE | i as u32 } else { u32::MAX })
    }
    #[inline(always)]
    fn keyed(self, keys: Self::Keys) -> u32 {
        keys.iter().enumerate().fold(0, |lanes, (i, &key)| lanes | u32::from(key != u32::MAX) << i)
    }
    #[inline(always)]
    fn take_least(self, keys: &mut Self::Keys) -> u32 {
        let least = keys.iter().fold(u32::MAX, |least, &key| least.min(key));
        *keys = each(|i| if keys[i] == least { u32::MAX } else { keys[i] });
        least
    }
    #[inline(always)]
    fn prefetch(self, _at: *const u8) {}
}
