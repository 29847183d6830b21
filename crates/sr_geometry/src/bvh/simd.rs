//! Eight `f32` at once: the few operations that traversal needs, in AVX2 and in plain Rust.
//!
//! Both give the same bits: nothing is fused or reassociated, and `min` and `max` treat NaN alike.

use super::WIDTH;

/// The bits of a key that tell its lane.
pub(super) const LANE: u32 = WIDTH as u32 - 1;

/// Eight lanes. `min(a, b)` and `max(a, b)` return `b` where either is NaN.
pub(super) trait Simd: Copy {
    type F: Copy;
    type Keys: Copy;
    fn splat(self, x: f32) -> Self::F;
    fn load(self, x: &[f32; WIDTH]) -> Self::F;
    fn to_array(self, x: Self::F) -> [f32; WIDTH];
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    /// Bit i: a[i] ≤ b[i]; false where either is NaN.
    fn le(self, a: Self::F, b: Self::F) -> u32;
    /// What orders the lanes by `x` ≥ 0: the bits of x[i] with the lowest three replaced by i.
    /// `u32::MAX` for lanes where not x[i] ≤ `limit`[i].
    fn keys(self, x: Self::F, limit: Self::F) -> Self::Keys;
    /// The smallest key.
    fn least(self, keys: Self::Keys) -> u32;
    /// Removes and returns the smallest key, leaving `u32::MAX` in its lane.
    fn take_least(self, keys: &mut Self::Keys) -> u32;
    /// Bit i: a[i] < b[i]; false where either is NaN.
    fn lt(self, a: Self::F, b: Self::F) -> u32;
    /// Asks for the cache lines of a `T` that may be needed soon. Any address will do: nothing is read.
    fn prefetch<T>(self, start: *const T);
}

/// Plain Rust, which compilers turn into SSE2 or NEON.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portable;

#[inline(always)]
fn lanes<R>(f: impl Fn(usize) -> R) -> [R; WIDTH] {
    std::array::from_fn(f)
}

impl Simd for Portable {
    type F = [f32; WIDTH];
    type Keys = [u32; WIDTH];

    #[inline(always)]
    fn splat(self, x: f32) -> Self::F {
        [x; WIDTH]
    }
    #[inline(always)]
    fn load(self, x: &[f32; WIDTH]) -> Self::F {
        *x
    }
    #[inline(always)]
    fn to_array(self, x: Self::F) -> [f32; WIDTH] {
        x
    }
    #[inline(always)]
    fn add(self, a: Self::F, b: Self::F) -> Self::F {
        lanes(|i| a[i] + b[i])
    }
    #[inline(always)]
    fn sub(self, a: Self::F, b: Self::F) -> Self::F {
        lanes(|i| a[i] - b[i])
    }
    #[inline(always)]
    fn mul(self, a: Self::F, b: Self::F) -> Self::F {
        lanes(|i| a[i] * b[i])
    }
    #[inline(always)]
    fn div(self, a: Self::F, b: Self::F) -> Self::F {
        lanes(|i| a[i] / b[i])
    }
    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        lanes(|i| if a[i] < b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        lanes(|i| if a[i] > b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn le(self, a: Self::F, b: Self::F) -> u32 {
        (0..WIDTH).fold(0, |mask, i| mask | u32::from(a[i] <= b[i]) << i)
    }
    #[inline(always)]
    fn lt(self, a: Self::F, b: Self::F) -> u32 {
        (0..WIDTH).fold(0, |mask, i| mask | u32::from(a[i] < b[i]) << i)
    }
    #[inline(always)]
    fn keys(self, x: Self::F, limit: Self::F) -> Self::Keys {
        lanes(|i| if x[i] <= limit[i] { x[i].to_bits() & !LANE | i as u32 } else { u32::MAX })
    }
    #[inline(always)]
    fn least(self, keys: Self::Keys) -> u32 {
        keys.iter().fold(u32::MAX, |least, &key| least.min(key))
    }
    #[inline(always)]
    fn take_least(self, keys: &mut Self::Keys) -> u32 {
        let least = self.least(*keys);
        *keys = lanes(|i| if keys[i] == least { u32::MAX } else { keys[i] });
        least
    }
    #[inline(always)]
    fn prefetch<T>(self, _start: *const T) {}
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::{LANE, Simd, WIDTH};

    /// Proof that this processor has AVX2, BMI1, BMI2 and LZCNT.
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
    }

    /// Calls an intrinsic.
    macro_rules! avx2 {
        ($call:expr) => {
            // SAFETY: an `Avx2` exists only where AVX2 was detected, and loads and stores are through references.
            unsafe { $call }
        };
    }

    impl Avx2 {
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

    impl Simd for Avx2 {
        type F = __m256;
        type Keys = __m256i;

        #[inline(always)]
        fn splat(self, x: f32) -> Self::F {
            avx2!(_mm256_set1_ps(x))
        }
        #[inline(always)]
        fn load(self, x: &[f32; WIDTH]) -> Self::F {
            avx2!(_mm256_loadu_ps(x.as_ptr()))
        }
        #[inline(always)]
        fn to_array(self, x: Self::F) -> [f32; WIDTH] {
            let mut array = [0.0; WIDTH];
            avx2!(_mm256_storeu_ps(array.as_mut_ptr(), x));
            array
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
        fn le(self, a: Self::F, b: Self::F) -> u32 {
            avx2!(_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32)
        }
        #[inline(always)]
        fn lt(self, a: Self::F, b: Self::F) -> u32 {
            avx2!(_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b)) as u32)
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
        fn least(self, keys: Self::Keys) -> u32 {
            avx2!(_mm256_cvtsi256_si32(self.broadcast_least(keys)) as u32)
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
        fn prefetch<T>(self, start: *const T) {
            for offset in (0..size_of::<T>()).step_by(64) {
                avx2!(_mm_prefetch::<_MM_HINT_T0>(start.cast::<i8>().wrapping_add(offset)));
            }
        }
    }
}

/// The instruction set that traversal uses, chosen when the tree is built.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kernel {
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    Portable(Portable),
}

impl Kernel {
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = Avx2::detect() {
            return Self::Avx2(avx2);
        }
        Self::Portable(Portable)
    }
}
