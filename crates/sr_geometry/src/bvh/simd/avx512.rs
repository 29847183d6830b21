//! Sixteen lanes in a 512-bit register.

use std::arch::x86_64::*;

use super::super::slabs::Line;
use super::super::stack::Stack;
use super::super::{Node, NodeRef, WIDE};
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

/// By the bits to be flipped: the slots in the order in which a ray meets them.
static ORDER: [Slots; WIDE] = {
    let mut order = [const { Slots([0; WIDE]) }; WIDE];
    let mut i = 0;
    while i < WIDE * WIDE {
        order[i / WIDE].0[i % WIDE] = ((i / WIDE) ^ (i % WIDE)) as u32;
        i += 1;
    }
    order
};

/// Numbers of slots.
#[repr(align(64))]
struct Slots([u32; WIDE]);

impl Walk for Avx512 {
    type Eight = Avx2;

    #[inline(always)]
    fn eight(self) -> Avx2 {
        self.0
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
        let [[enter, leave]] = line.meet(self, node, t_max);
        let order = &ORDER[flip as usize % WIDE];
        let [children, enters] = stack.top();
        // The top of the stack has room for as many children as a node has.
        avx512!({
            let slots = _mm512_load_si512(order.0.as_ptr().cast());
            let enter = _mm512_permutexvar_ps(slots, enter);
            let met = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(enter, _mm512_permutexvar_ps(slots, leave));
            let all = _mm512_permutexvar_epi32(slots, _mm512_load_si512(node.children.as_ptr().cast()));
            _mm512_storeu_si512(children.cast(), _mm512_maskz_compress_epi32(met, all));
            if !ANY {
                _mm512_storeu_ps(enters.cast(), _mm512_maskz_compress_ps(met, enter));
            }
            stack.keep_and_pop(u32::from(met), flip, node)
        })
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
    #[inline(always)]
    fn prefetch(self, at: *const u8) {
        self.0.prefetch(at);
    }
}
