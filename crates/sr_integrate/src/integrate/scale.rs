//! Units in which squares neither overflow nor vanish.
//!
//! Variances are made of squares, and the square of 10⁻¹⁶⁰ is 0, that of 10¹⁶⁰ infinite. So terms that are far from 1
//! are added up in units of a power of two, which changes no digit of them. Most terms are not far, and nothing is done.

/// A power of two, as its exponent: 0 for numbers that need no other unit. `None` if all numbers are 0, so that any
/// unit will do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Exponent(Option<i32>);

/// Numbers need no other unit from 2 to the negative of this …
const NEAR: i32 = 300;
/// … and others get a multiple of this, so that few different ones meet.
const STEP: i32 = 256;

/// The unit for numbers of which `largest` is the one farthest from 0.
pub fn exponent_of(largest: f64) -> Exponent {
    let near = 2.0_f64.powi(-NEAR)..=2.0_f64.powi(NEAR);
    if near.contains(&largest) {
        return Exponent(Some(0));
    }
    if !(largest > 0.0) {
        return Exponent(None);
    }
    // At most 1024 in size, so that a multiple of the step is nearest to it within half a step.
    Exponent(Some((largest.log2() / f64::from(STEP)).round() as i32 * STEP))
}

impl Exponent {
    /// Are numbers to be divided?
    pub fn is_far(self) -> bool {
        self.0.is_some_and(|exponent| exponent != 0)
    }

    /// `number` in this unit.
    pub fn of(self, number: f64) -> f64 {
        shift(number, -self.0.unwrap_or(0))
    }

    /// What `number` of this unit is.
    pub fn out(self, number: f64) -> f64 {
        shift(number, self.0.unwrap_or(0))
    }

    /// Numbers in this unit.
    pub fn divide(self, numbers: &mut [f64]) {
        numbers.iter_mut().for_each(|x| *x = self.of(*x));
    }

    /// By what numbers in this unit are multiplied to be in another, which is not smaller.
    pub fn in_unit(self, other: Self) -> f64 {
        match (self.0, other.0) {
            (Some(from), Some(to)) => shift(1.0, from - to),
            _ => 1.0, // these are all 0
        }
    }
}

/// x · 2ⁿ. In two steps, since 2ⁿ alone may overflow.
fn shift(x: f64, n: i32) -> f64 {
    if n == 0 {
        return x;
    }
    let half = n / 2;
    x * 2.0_f64.powi(half) * 2.0_f64.powi(n - half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_near_stays() {
        for x in [1e-80, 1.0, 3.7, 1e80] {
            assert!(!exponent_of(x).is_far() && exponent_of(x).of(x) == x);
        }
        assert!(exponent_of(0.0) < exponent_of(1e-300));
    }

    #[test]
    fn what_is_far_keeps_its_digits() {
        for x in [1e-300, 1.234e-160, 5.67e200, f64::MAX] {
            let unit = exponent_of(x);
            let square = unit.of(x).powi(2);
            assert!(unit.is_far() && (1e-80..1e80).contains(&square), "{x}: {square}");
            assert_eq!(unit.out(unit.of(x)), x);
        }
        let (small, large) = (exponent_of(1e-200), exponent_of(1.0));
        assert_eq!(small.of(3e-200) * small.in_unit(large), 3e-200);
    }
}
