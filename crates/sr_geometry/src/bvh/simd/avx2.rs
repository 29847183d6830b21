//! Eight lanes in a 256-bit register.

use std::arch::x86_64::*;

use glam::Vec3A;

use super::super::sheared::Order;
use super::super::{WIDE, WIDTH};
use super::{LANE, Lanes, Simd};

/// Calls an intrinsic.
macro_rules! avx2 {
    ($call:expr) => {
        // SAFETY: an `Avx2` exists only where AVX2 was detected, and what is read is behind references.
        unsafe { $call }
    };
}

/// Proof that this processor has AVX2, BMI1, BMI2 and LZCNT: what `meet_avx2` is compiled for.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Avx2(());

impl Avx2 {
    pub fn detect() -> Option<Self> {
        let found = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt");
        found.then_some(Self(()))
    }

    /// The smallest key, in every lane.
    #[inline(always)]
    fn broadcast_least(self, keys: __m256i) -> __m256i {
        avx2!({
            let least = _mm256_min_epu32(keys, _mm256_permute2x128_si256::<0x01>(keys, keys));
            let least = _mm256_min_epu32(least, _mm256_shuffle_epi32::<0b01_00_11_10>(least));
            _mm256_min_epu32(least, _mm256_shuffle_epi32::<0b10_11_00_01>(least))
        })
    }
}

impl Lanes for Avx2 {
    type F = __m256;
    type Mask = __m256;
    const COUNT: usize = WIDTH;

    #[inline(always)]
    fn splat(self, x: f32) -> Self::F {
        avx2!(_mm256_set1_ps(x))
    }
    #[inline(always)]
    fn permute(self, v: Vec3A, order: &Order) -> Vec3A {
        // An `Order` is aligned to 16 bytes.
        avx2!(_mm_permutevar_ps(v.into(), _mm_load_si128(std::ptr::from_ref(order).cast()))).into()
    }
    #[inline(always)]
    fn load_part(self, x: &[f32; WIDE], part: usize) -> Self::F {
        let part = part % (WIDE / WIDTH);
        // Within the array, as the remainder is.
        avx2!(_mm256_loadu_ps(x.as_ptr().add(part * WIDTH)))
    }
    #[inline(always)]
    fn load_at(self, x: &[f32], first: usize) -> Self::F {
        let x = &x[first..first + Self::COUNT];
        avx2!(_mm256_loadu_ps(x.as_ptr()))
    }
    #[inline(always)]
    fn store_at(self, x: Self::F, to: &mut [f32], first: usize) {
        let to = &mut to[first..first + Self::COUNT];
        avx2!(_mm256_storeu_ps(to.as_mut_ptr(), x))
    }
    #[inline(always)]
    fn store_bits_at(self, x: Self::F, to: &mut [u32], first: usize) {
        let to = &mut to[first..first + Self::COUNT];
        avx2!(_mm256_storeu_ps(to.as_mut_ptr().cast(), x))
    }
    #[inline(always)]
    fn gather(self, table: &[u32], at: Self::F) -> Self::F {
        let last = table.len().checked_sub(1).expect("a table has entries") as i32;
        // Within the table, as the minimum is.
        avx2!({
            let at = _mm256_min_epu32(_mm256_cvttps_epi32(at), _mm256_set1_epi32(last));
            _mm256_i32gather_ps::<4>(table.as_ptr().cast(), at)
        })
    }
    #[inline(always)]
    fn extract(self, x: Self::F, lane: usize) -> f32 {
        avx2!(_mm256_cvtss_f32(_mm256_permutevar8x32_ps(x, _mm256_set1_epi32(lane as i32))))
    }
    #[inline(always)]
    fn add(self, a: Self::F, b: Self::F) -> Self::F {
        avx2!(_mm256_add_ps(a, b))
    }
    #[inline(always)]
    fn sub(self, a: Self::F, b: Self::F) -> Self::F {
        avx2!(_mm256_sub_ps(a, b))
    }
    #[inline(always)]
    fn mul(self, a: Self::F, b: Self::F) -> Self::F {
        avx2!(_mm256_mul_ps(a, b))
    }
    #[inline(always)]
    fn div(self, a: Self::F, b: Self::F) -> Self::F {
        avx2!(_mm256_div_ps(a, b))
    }
    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        avx2!(_mm256_min_ps(a, b))
    }
    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        avx2!(_mm256_max_ps(a, b))
    }
    #[inline(always)]
    fn abs(self, x: Self::F) -> Self::F {
        avx2!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), x))
    }
    #[inline(always)]
    fn sqrt(self, x: Self::F) -> Self::F {
        avx2!(_mm256_sqrt_ps(x))
    }
    #[inline(always)]
    fn flip(self, x: Self::F, sign: Self::F) -> Self::F {
        avx2!(_mm256_xor_ps(x, _mm256_and_ps(sign, _mm256_set1_ps(-0.0))))
    }
    #[inline(always)]
    fn le(self, a: Self::F, b: Self::F) -> Self::Mask {
        avx2!(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b))
    }
    #[inline(always)]
    fn lt(self, a: Self::F, b: Self::F) -> Self::Mask {
        avx2!(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b))
    }
    #[inline(always)]
    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        avx2!(_mm256_and_ps(a, b))
    }
    #[inline(always)]
    fn or(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        avx2!(_mm256_or_ps(a, b))
    }
    #[inline(always)]
    fn bits(self, mask: Self::Mask) -> u32 {
        avx2!(_mm256_movemask_ps(mask) as u32)
    }
    #[inline(always)]
    fn mask(self, bits: u32) -> Self::Mask {
        avx2!({
            let lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let set = _mm256_and_si256(_mm256_set1_epi32(bits as i32), lane);
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, lane))
        })
    }
    #[inline(always)]
    fn select(self, mask: Self::Mask, a: Self::F, b: Self::F) -> Self::F {
        avx2!(_mm256_blendv_ps(b, a, mask))
    }
    #[inline(always)]
    fn least(self, x: Self::F) -> f32 {
        avx2!({
            let least = _mm_min_ps(_mm256_castps256_ps128(x), _mm256_extractf128_ps::<1>(x));
            let least = _mm_min_ps(least, _mm_movehl_ps(least, least));
            _mm_cvtss_f32(_mm_min_ss(least, _mm_movehdup_ps(least)))
        })
    }
}

impl Simd for Avx2 {
    type Keys = __m256i;

    #[inline(always)]
    fn load(self, x: &[f32; WIDTH]) -> Self::F {
        avx2!(_mm256_loadu_ps(x.as_ptr()))
    }
    #[inline(always)]
    fn keys(self, x: Self::F, limit: Self::F) -> Self::Keys {
        avx2!({
            let lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
            let bits = _mm256_andnot_si256(_mm256_set1_epi32(LANE as i32), _mm256_castps_si256(x));
            let beyond = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_NLE_UQ>(x, limit));
            _mm256_or_si256(_mm256_or_si256(bits, lane), beyond)
        })
    }
    #[inline(always)]
    fn keyed(self, keys: Self::Keys) -> u32 {
        // The sign bits.
        avx2!(!_mm256_movemask_ps(_mm256_castsi256_ps(keys)) as u32 & 0xff)
    }
    #[inline(always)]
    fn take_least(self, keys: &mut Self::Keys) -> u32 {
        let (all, least) = (*keys, self.broadcast_least(*keys));
        avx2!({
            *keys = _mm256_or_si256(all, _mm256_cmpeq_epi32(all, least));
            _mm256_cvtsi256_si32(least) as u32
        })
    }
    #[inline(always)]
    fn prefetch(self, at: *const u8) {
        avx2!(_mm_prefetch::<_MM_HINT_T0>(at.cast()));
    }
}
