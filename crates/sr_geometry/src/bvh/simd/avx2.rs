//! Eight lanes in a 256-bit register.

use std::arch::x86_64::*;

use super::super::slabs::Line;
use super::super::stack::Stack;
use super::super::{Node, NodeRef, WIDE, WIDTH};
use super::{Eight, Lanes, Walk};

/// Calls an intrinsic.
macro_rules! avx2 {
    ($call:expr) => {
        // SAFETY: an `Avx2` exists only where AVX2 was detected, and what is read is behind references.
        unsafe { $call }
    };
}

/// Proof that this processor has AVX2, BMI1, BMI2, LZCNT and POPCNT: what `meet_avx2` is compiled for.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Avx2(());

impl Avx2 {
    pub fn detect() -> Option<Self> {
        let found = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        found.then_some(Self(()))
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

impl Eight for Avx2 {
    #[inline(always)]
    fn load(self, x: &[f32; WIDTH]) -> Self::F {
        avx2!(_mm256_loadu_ps(x.as_ptr()))
    }
}

/// What moves the lanes of a mask to the front, by mask.
static COMPRESS: [[u8; WIDTH]; 1 << WIDTH] = {
    let mut table = [[0; WIDTH]; 1 << WIDTH];
    let mut mask = 0;
    while mask < table.len() {
        let (mut lane, mut count) = (0, 0);
        while lane < WIDTH {
            if mask >> lane & 1 != 0 {
                table[mask][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
};

impl Avx2 {
    /// What moves the lanes of a mask to the front.
    #[inline(always)]
    fn compress(self, mask: u32) -> __m256i {
        let lanes = &COMPRESS[mask as usize % COMPRESS.len()];
        avx2!(_mm256_cvtepu8_epi32(_mm_loadl_epi64(lanes.as_ptr().cast())))
    }
}

/// By the lowest bits to be flipped: the slots of half a node in the order in which a ray meets them.
static ORDER: [Slots; WIDTH] = {
    let mut order = [const { Slots([0; WIDTH]) }; WIDTH];
    let mut i = 0;
    while i < WIDTH * WIDTH {
        order[i / WIDTH].0[i % WIDTH] = ((i / WIDTH) ^ (i % WIDTH)) as u32;
        i += 1;
    }
    order
};

/// Numbers of slots.
#[repr(align(32))]
struct Slots([u32; WIDTH]);

impl Walk for Avx2 {
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
        let order = &ORDER[flip as usize % WIDTH];
        let [children, enters] = stack.top();
        let [low, high] = line.meet(self, node, t_max);
        // The halves of the node in the order in which the ray meets them: chosen, not branched to.
        let first = flip as usize / WIDTH % (WIDE / WIDTH);
        let mut all_met = 0_u32;
        // The top of the stack has room for as many children as a node has.
        avx2!({
            let slots = _mm256_load_si256(order.0.as_ptr().cast());
            let is_high = _mm256_castsi256_ps(_mm256_set1_epi32(-(first as i32)));
            for half in 0..WIDE / WIDTH {
                let (one, other) = if half == 0 { (low, high) } else { (high, low) };
                let enter = _mm256_blendv_ps(one[0], other[0], is_high);
                let leave = _mm256_blendv_ps(one[1], other[1], is_high);
                let met = _mm256_cmp_ps::<_CMP_LE_OQ>(enter, leave);
                let met = _mm256_movemask_ps(_mm256_permutevar8x32_ps(met, slots)) as u32;
                let order = _mm256_permutevar8x32_epi32(slots, self.compress(met));
                let all = _mm256_load_si256(node.children.as_ptr().add((half ^ first) * WIDTH).cast());
                let before = all_met.count_ones() as usize;
                _mm256_storeu_si256(children.add(before).cast(), _mm256_permutevar8x32_epi32(all, order));
                if !ANY {
                    _mm256_storeu_ps(enters.add(before).cast(), _mm256_permutevar8x32_ps(enter, order));
                }
                all_met |= met << (half * WIDTH);
            }
            stack.keep_and_pop(all_met, flip, node)
        })
    }
    #[inline(always)]
    unsafe fn forget_beyond(self, t_max: f32, within: u32, from: [*mut u32; 2], to: [*mut u32; 2]) -> u32 {
        // What is read was written, and there is room for what is written, by the caller's promise.
        avx2!({
            let mask = _mm256_castps_si256(self.mask(within));
            let children = _mm256_maskload_epi32(from[0].cast(), mask);
            let enters = _mm256_maskload_ps(from[1].cast(), mask);
            let near = _mm256_cmp_ps::<_CMP_LE_OQ>(enters, _mm256_set1_ps(t_max));
            let kept = _mm256_movemask_ps(near) as u32 & within;
            let order = self.compress(kept);
            _mm256_storeu_si256(to[0].cast(), _mm256_permutevar8x32_epi32(children, order));
            _mm256_storeu_ps(to[1].cast(), _mm256_permutevar8x32_ps(enters, order));
            kept.count_ones()
        })
    }
    #[inline(always)]
    fn prefetch(self, at: *const u8) {
        avx2!(_mm_prefetch::<_MM_HINT_T0>(at.cast()));
    }
}
