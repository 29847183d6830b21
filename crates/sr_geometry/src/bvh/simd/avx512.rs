//! Sixteen lanes in a 512-bit register.

use std::arch::x86_64::*;
use std::ops::Neg;

use super::super::leaves::Leaf;
use super::super::sheared::{Projected, Sheared};
use super::super::slabs::Line;
use super::super::stack::Stack;
use super::super::{NARROW, Node, WIDE};
use super::{Avx2, Lanes, Walk};

/// Calls an intrinsic.
macro_rules! avx512 {
    ($call:expr) => {
        // SAFETY: an `Avx512` exists only where AVX-512 was detected, and what is read is behind references.
        unsafe { $call }
    };
}

/// Proof that this processor has the parts F, VL, DQ and BW of AVX-512, what they imply, and what an [`Avx2`] proves:
/// what `meet_avx512` is compiled for.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Avx512(Avx2);

impl Avx512 {
    pub fn detect() -> Option<Self> {
        let found = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("f16c");
        Avx2::detect().filter(|_| found).map(Self)
    }
}

impl Lanes for Avx512 {
    type F = __m512;
    type Mask = __mmask16;
    const COUNT: usize = WIDE;

    #[inline(always)]
    fn splat(self, x: f32) -> Self::F {
        avx512!(_mm512_set1_ps(x))
    }
    #[inline(always)]
    fn load_part(self, x: &[f32; WIDE], _part: usize) -> Self::F {
        avx512!(_mm512_loadu_ps(x.as_ptr()))
    }
    #[inline(always)]
    fn load_at(self, x: &[f32], first: usize) -> Self::F {
        let x = &x[first..first + Self::COUNT];
        avx512!(_mm512_loadu_ps(x.as_ptr()))
    }
    #[inline(always)]
    fn store_at(self, x: Self::F, to: &mut [f32], first: usize) {
        let to = &mut to[first..first + Self::COUNT];
        avx512!(_mm512_storeu_ps(to.as_mut_ptr(), x))
    }
    #[inline(always)]
    fn store_bits_at(self, x: Self::F, to: &mut [u32], first: usize) {
        let to = &mut to[first..first + Self::COUNT];
        avx512!(_mm512_storeu_ps(to.as_mut_ptr().cast(), x))
    }
    #[inline(always)]
    fn gather(self, table: &[u32], at: Self::F) -> Self::F {
        let last = table.len().checked_sub(1).expect("a table has entries") as i32;
        // Within the table, as the minimum is.
        avx512!({
            let at = _mm512_min_epu32(_mm512_cvttps_epi32(at), _mm512_set1_epi32(last));
            _mm512_castsi512_ps(_mm512_i32gather_epi32::<4>(at, table.as_ptr().cast()))
        })
    }
    #[inline(always)]
    fn extract(self, x: Self::F, lane: usize) -> f32 {
        avx512!(_mm512_cvtss_f32(_mm512_permutexvar_ps(_mm512_set1_epi32(lane as i32), x)))
    }
    #[inline(always)]
    fn add(self, a: Self::F, b: Self::F) -> Self::F {
        avx512!(_mm512_add_ps(a, b))
    }
    #[inline(always)]
    fn sub(self, a: Self::F, b: Self::F) -> Self::F {
        avx512!(_mm512_sub_ps(a, b))
    }
    #[inline(always)]
    fn mul(self, a: Self::F, b: Self::F) -> Self::F {
        avx512!(_mm512_mul_ps(a, b))
    }
    #[inline(always)]
    fn div(self, a: Self::F, b: Self::F) -> Self::F {
        avx512!(_mm512_div_ps(a, b))
    }
    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        avx512!(_mm512_min_ps(a, b))
    }
    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        avx512!(_mm512_max_ps(a, b))
    }
    #[inline(always)]
    fn abs(self, x: Self::F) -> Self::F {
        avx512!(_mm512_abs_ps(x))
    }
    #[inline(always)]
    fn sqrt(self, x: Self::F) -> Self::F {
        avx512!(_mm512_sqrt_ps(x))
    }
    #[inline(always)]
    fn flip(self, x: Self::F, sign: Self::F) -> Self::F {
        avx512!({
            let (x, sign, bit) =
                (_mm512_castps_si512(x), _mm512_castps_si512(sign), _mm512_set1_epi32(i32::MIN));
            // x ^ (sign & bit)
            _mm512_castsi512_ps(_mm512_ternarylogic_epi32::<0b0111_1000>(x, sign, bit))
        })
    }
    #[inline(always)]
    fn le(self, a: Self::F, b: Self::F) -> Self::Mask {
        avx512!(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b))
    }
    #[inline(always)]
    fn lt(self, a: Self::F, b: Self::F) -> Self::Mask {
        avx512!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b))
    }
    #[inline(always)]
    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        a & b
    }
    #[inline(always)]
    fn or(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        a | b
    }
    #[inline(always)]
    fn bits(self, mask: Self::Mask) -> u32 {
        mask.into()
    }
    #[inline(always)]
    fn mask(self, bits: u32) -> Self::Mask {
        bits as u16
    }
    #[inline(always)]
    fn select(self, mask: Self::Mask, a: Self::F, b: Self::F) -> Self::F {
        avx512!(_mm512_mask_blend_ps(mask, b, a))
    }
    #[inline(always)]
    fn least(self, x: Self::F) -> f32 {
        avx512!({
            let high = _mm256_castpd_ps(_mm512_extractf64x4_pd::<1>(_mm512_castps_pd(x)));
            self.0.least(_mm256_min_ps(_mm512_castps512_ps256(x), high))
        })
    }
}

/// A ray, ready to meet the boxes of a node, an axis at a time: the nearer ends of the slabs in the lower half of the
/// lanes, the farther ones in the upper half, children in the order of [`Line::flip`]. What is far is negated: the first
/// that is left becomes the largest number, as the last that is entered is.
#[derive(Clone, Copy)]
pub(in crate::bvh) struct Slabs {
    /// Per axis, the lanes of [`Node::bounds`].
    lanes: [__m512i; 3],
    origin: [__m512; 3],
    inverse: [__m512; 3],
    /// 0 and −`t_max`.
    ends: __m512,
}

const FAR: __mmask16 = 0xff00;

impl Avx512 {
    /// The lanes of bounds along an axis.
    #[inline(always)]
    fn order(self, line: &Line, flip: u32, axis: u32) -> __m512i {
        let flip = flip | (line.negative >> axis & 1) << 3;
        avx512!({
            let lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
            _mm512_xor_si512(lane, _mm512_set1_epi32(flip as i32))
        })
    }

    #[inline(always)]
    fn half(self, near: f32, far: f32) -> __m512 {
        avx512!(_mm512_mask_blend_ps(FAR, _mm512_set1_ps(near), _mm512_set1_ps(far)))
    }

    #[inline(always)]
    fn halves(self, near: [f32; 3], far: [f32; 3]) -> [__m512; 3] {
        [self.half(near[0], far[0]), self.half(near[1], far[1]), self.half(near[2], far[2])]
    }

    #[inline(always)]
    fn low(self, v: __m512) -> __m256 {
        avx512!(_mm512_castps512_ps256(v))
    }

    /// v[lanes[i]]
    #[inline(always)]
    fn lanes_of(self, v: __m512, lanes: __m512i) -> __m512 {
        avx512!(_mm512_permutexvar_ps(lanes, v))
    }

    /// For each vertex of `count` triangles, the lane of the next one of its triangle.
    #[inline(always)]
    fn next(self, count: usize) -> __m512i {
        avx512!(_mm512_load_si512((&raw const NEXT[count % NEXT.len()]).cast()))
    }
}

impl Walk for Avx512 {
    type Eight = Avx2;
    type Slabs = Slabs;

    #[inline(always)]
    fn eight(self) -> Avx2 {
        self.0
    }
    #[inline(always)]
    fn slabs(self, line: &Line) -> Slabs {
        let flip = line.flip();
        Slabs {
            lanes: [self.order(line, flip, 0), self.order(line, flip, 1), self.order(line, flip, 2)],
            origin: self.halves(line.origin_near, line.origin_far),
            inverse: self.halves(line.inverse, line.inverse_far.map(Neg::neg)),
            ends: self.half(0.0, -line.t_max),
        }
    }
    #[inline(always)]
    fn shorten(self, slabs: &mut Slabs, t_max: f32) {
        slabs.ends = self.half(0.0, -t_max);
    }
    #[inline(always)]
    fn enter(self, ray: &Slabs, node: &Node, stack: &mut Stack) {
        let mut ends = ray.ends;
        for axis in 0..3 {
            let bounds: *const f32 = node.bounds[axis].as_ptr().cast();
            ends = avx512!({
                let bounds = _mm512_permutexvar_ps(ray.lanes[axis], _mm512_load_ps(bounds));
                let at = _mm512_mul_ps(_mm512_sub_ps(bounds, ray.origin[axis]), ray.inverse[axis]);
                // A ray within the plane of a slab gives NaN, which is then ignored.
                _mm512_max_ps(at, ends)
            });
        }
        let [children, enters] = stack.top();
        // The top of the stack has room for as many children as a node has.
        avx512!({
            let enter = _mm512_castps512_ps256(ends);
            let leave = _mm256_xor_ps(_mm512_extractf32x8_ps::<1>(ends), _mm256_set1_ps(-0.0));
            let met = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(enter, leave);
            let order = _mm512_castsi512_si256(ray.lanes[0]);
            let all = _mm256_permutexvar_epi32(order, _mm256_load_si256(node.children.as_ptr().cast()));
            _mm256_storeu_si256(children.cast(), _mm256_maskz_compress_epi32(met, all));
            _mm256_storeu_ps(enters.cast(), _mm256_maskz_compress_ps(met, enter));
            stack.keep(u32::from(met).count_ones());
        });
    }
    #[inline(always)]
    unsafe fn forget_beyond(self, t_max: f32, within: u32, from: [*mut u32; 2], to: [*mut u32; 2]) -> u32 {
        // What is read was written, and there is room for what is written, by the caller's promise.
        avx512!({
            let children = _mm256_maskz_loadu_epi32(within as u8, from[0].cast());
            let enters = _mm256_maskz_loadu_ps(within as u8, from[1].cast());
            let kept = _mm256_mask_cmp_ps_mask::<_CMP_LE_OQ>(within as u8, enters, _mm256_set1_ps(t_max));
            _mm256_storeu_si256(to[0].cast(), _mm256_maskz_compress_epi32(kept, children));
            _mm256_storeu_ps(to[1].cast(), _mm256_maskz_compress_ps(kept, enters));
            u32::from(kept).count_ones()
        })
    }
    /// Three times as many lanes as triangles: all first vertices, all second ones, all third ones.
    #[inline(always)]
    fn project_narrow(self, sheared: &Sheared, leaf: &Leaf<'_>) -> Projected<Avx2> {
        let ([x, y, z], count) = (sheared.axes(), leaf.count);
        // SAFETY: `axes` makes a permutation of 0, 1, 2.
        let [x, y, z] = unsafe { [leaf.axis(x), leaf.axis(y), leaf.axis(z)] };
        let x = self.sub(self.load_part(x, 0), self.splat(sheared.origin[0]));
        let y = self.sub(self.load_part(y, 0), self.splat(sheared.origin[1]));
        let z = self.sub(self.load_part(z, 0), self.splat(sheared.origin[2]));
        let x = self.sub(x, self.mul(self.splat(sheared.shear[0]), z));
        let y = self.sub(y, self.mul(self.splat(sheared.shear[1]), z));
        let next = self.next(count);
        // Between a vertex and the next one, hence opposite to the one after that.
        let areas = self.sub(self.mul(self.lanes_of(x, next), y), self.mul(self.lanes_of(y, next), x));
        let zero = self.splat(0.0);
        let signs = u32::from(self.le(zero, areas)) | u32::from(self.le(areas, zero)) << 16;
        let same = signs & signs >> count & signs >> (2 * count);
        let inside = (same | same >> 16) & ((1 << count) - 1);
        let (of_a, b_z) = (self.lanes_of(areas, next), self.lanes_of(z, next));
        let (of_b, c_z) = (self.lanes_of(of_a, next), self.lanes_of(b_z, next));
        Projected {
            inside: self.0.mask(inside),
            areas: [self.low(of_a), self.low(of_b), self.low(areas)],
            z: [self.low(z), self.low(b_z), self.low(c_z)],
        }
    }
    #[inline(always)]
    fn prefetch(self, at: *const u8) {
        self.0.prefetch(at);
    }
}

/// Sixteen lane numbers.
#[repr(align(64))]
struct LaneNumbers([u32; WIDE]);

/// By the number of triangles: for each vertex, the lane of the next one of its triangle.
static NEXT: [LaneNumbers; NARROW + 1] = {
    let mut next = [const { LaneNumbers([0; WIDE]) }; NARROW + 1];
    let mut count = 1;
    while count <= NARROW {
        let mut lane = 0;
        while lane < 3 * count {
            next[count].0[lane] = ((lane + count) % (3 * count)) as u32;
            lane += 1;
        }
        count += 1;
    }
    next
};
