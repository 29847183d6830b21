//! exp and ln as polynomials, in single precision: no library call, so that loops can serve many points at a time, and
//! the same bits everywhere. Coefficients: S. L. Moshier, Cephes Mathematical Library, 1989 (`expf`, `logf`).

use std::f32::consts::{LOG2_E, SQRT_2};

/// ln 2 in two parts, of which the first has few digits: its products with small integers are exact.
const LN_2: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];

/// eˣ for x in [−87, 88], to 2 · 10⁻⁷ of itself; beyond, as at the ends.
#[inline(always)]
pub(crate) fn exp(x: f32) -> f32 {
    let x = x.clamp(-87.0, 88.0);
    let twos = (x * LOG2_E + 0.5f32.copysign(x)) as i32;
    let r = x - twos as f32 * LN_2[0] - twos as f32 * LN_2[1];
    let tail =
        horner(r, [1.987_569_1e-4, 1.398_199_9e-3, 8.333_452e-3, 4.166_579_6e-2, 0.166_666_66, 0.500_000_03]);
    (tail * r * r + r + 1.0) * f32::from_bits(((twos + 127) as u32) << 23)
}

/// ln x for positive x that is not subnormal, to 2 · 10⁻⁷ of itself.
#[inline(always)]
pub(crate) fn ln(x: f32) -> f32 {
    // x = m · 2ⁿ with m in [1/√2, √2).
    let m = f32::from_bits((x.to_bits() & 0x007f_ffff) | 0x3f80_0000);
    let n = (x.to_bits() >> 23) as i32 - 127;
    let (m, n) = if m > SQRT_2 { (0.5 * m, n + 1) } else { (m, n) };
    let (r, n) = (m - 1.0, n as f32);
    let tail = horner(
        r,
        [
            7.037_683_6e-2,
            -0.115_146_1,
            0.116_769_99,
            -0.124_201_41,
            0.142_493_23,
            -0.166_680_58,
            0.200_007_15,
            -0.249_999_94,
            0.333_333_3,
        ],
    );
    r + (tail * r * r * r + n * LN_2[1] - 0.5 * r * r) + n * LN_2[0]
}

/// A polynomial, its highest coefficient first.
#[inline(always)]
pub(crate) fn horner<const N: usize>(x: f32, coefficients: [f32; N]) -> f32 {
    let mut sum = 0.0;
    for c in coefficients {
        sum = sum * x + c;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exp_is_as_good_as_f32() {
        for i in -870_000..=880_000 {
            let x = i as f32 * 1e-4;
            let exact = f64::from(x).exp();
            assert!((f64::from(exp(x)) / exact - 1.0).abs() < 2e-7, "{x}: {}", exp(x));
        }
        assert_eq!((exp(0.0), exp(f32::NEG_INFINITY)), (1.0, exp(-87.0)));
    }

    #[test]
    fn ln_is_as_good_as_f32() {
        for i in 0..2_000_000 {
            let x = f32::from_bits(f32::MIN_POSITIVE.to_bits() + i * 1056);
            let exact = f64::from(x).ln();
            assert!((f64::from(ln(x)) - exact).abs() <= 2e-7 * exact.abs(), "{x}: {} {exact}", ln(x));
        }
        assert_eq!(ln(1.0), 0.0);
    }
}
