//! Integer hashing, scrambling, and integers to uniforms: what every sequence is made of.

/// 2⁶⁴ divided by the golden ratio, made odd: the step that spreads consecutive integers farthest.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// A bijection of 64-bit words whose every output bit depends on every input bit.
///
/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014; constants: Stafford's variant 13).
#[inline(always)]
pub fn mix64(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// 64 random bits for three words under a key. For a fixed key and `c`, a bijection in (`a`, `b`).
#[inline]
pub fn hash(key: u64, a: u32, b: u32, c: u32) -> u64 {
    let x = (key ^ (u64::from(a) << 32 | u64::from(b))).wrapping_mul(0xd6e8_feb8_6659_fd93);
    mix64((x ^ (x >> 32)).wrapping_add(u64::from(c).wrapping_mul(GOLDEN)))
}

/// The key of the `number`-th independent copy of whatever `key` drives.
#[inline]
pub fn derive_key(key: u64, number: u32) -> u64 {
    mix64(key.wrapping_add((u64::from(number) + 1).wrapping_mul(GOLDEN)))
}

/// The top 24 bits as a fraction: in [0, 1), exactly representable, never 1.
#[inline]
pub fn to_unit(bits: u32) -> f32 {
    const STEP: f32 = 1.0 / (1 << 24) as f32;
    (bits >> 8) as f32 * STEP
}

/// An Owen scramble of a number whose *lowest* bit is the most significant: each bit is flipped by a
/// random function of the bits below it.
///
/// The construction is Laine & Karras' (2011), with the steps and constants of Nathan Vegdahl,
/// "Building a Better LK Hash" (2021). Even multipliers keep every step a bijection.
#[inline(always)]
pub fn scramble_low_first(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_never_one() {
        assert_eq!(to_unit(0), 0.0);
        assert_eq!(to_unit(u32::MAX), 1.0 - f32::EPSILON / 2.0);
    }

    /// Flipping any input bit flips each output bit half the time: 64 × 96 proportions over 4096
    /// keys each, the worst of which exceeds 6 standard deviations with probability 10⁻⁵.
    #[test]
    fn hash_has_avalanche() {
        const TRIALS: u32 = 4096;
        let mut worst = 0.0_f64;
        for bit in 0..96 {
            let flip = |part: u32| if bit / 32 == part { 1_u32 << (bit % 32) } else { 0 };
            let mut flips = [0_u32; 64];
            for trial in 0..TRIALS {
                let (key, a, c) = (mix64(u64::from(trial)), trial * 7, trial % 50);
                let change = hash(key, a, trial, c) ^ hash(key, a ^ flip(0), trial ^ flip(1), c ^ flip(2));
                for (i, count) in flips.iter_mut().enumerate() {
                    *count += (change >> i & 1) as u32;
                }
            }
            for count in flips {
                let n = f64::from(TRIALS);
                worst = worst.max((f64::from(count) - n / 2.0).abs() / (n / 4.0).sqrt());
            }
        }
        assert!(worst < 6.0, "{worst} standard deviations");
    }

    #[test]
    fn a_scrambled_bit_depends_on_lower_bits_only() {
        for trial in 0..1000_u32 {
            let (x, seed) = (mix64(u64::from(trial)) as u32, mix64(!u64::from(trial)) as u32);
            let scrambled = scramble_low_first(x, seed);
            for bit in 0..32 {
                let change = scrambled ^ scramble_low_first(x ^ 1 << bit, seed);
                assert_eq!(change.trailing_zeros(), bit, "bit {bit} of {x:#x}, seed {seed:#x}");
            }
        }
    }
}
