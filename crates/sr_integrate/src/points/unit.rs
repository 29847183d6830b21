//! Integers to uniforms in double precision.

/// The top 52 of 64 bits as a fraction: in [0, 1), exactly representable, never 1.
#[inline(always)]
pub fn to_unit(bits: u64) -> f64 {
    // The bits are the fraction of a number in [1, 2). Unlike a conversion, that is one instruction for many lanes.
    f64::from_bits(1023 << 52 | bits >> 12) - 1.0
}

/// 32 bits and as many below them that look random, so that a digital net has all of a number's digits.
#[inline(always)]
pub fn extend(high: u32, key: u64) -> u64 {
    let low = (high ^ key as u32).wrapping_mul(0x9e37_79b1);
    u64::from(high) << 32 | u64::from(low ^ (key >> 32) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_never_one() {
        assert_eq!(to_unit(0), 0.0);
        assert_eq!(to_unit(1 << 63), 0.5);
        assert_eq!(to_unit(u64::MAX), 1.0 - f64::EPSILON);
    }

    #[test]
    fn what_is_appended_changes_no_digit() {
        for high in [0, 1, 0x8000_0000, u32::MAX] {
            assert_eq!((extend(high, 0x1234_5678_9abc_def0) >> 32) as u32, high);
        }
    }
}
