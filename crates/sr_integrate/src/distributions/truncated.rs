//! Any distribution on the line, cut to an interval.

use std::sync::Arc;

use super::parameter::{ParameterError, bad};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Cumulative, Density, DensityError, Inverse};
use crate::space::Space;

/// `of` cut to [low, high], and scaled up to integrate to 1.
///
/// A distribution may have a form of its own for that ([`Cumulative::between`]): a normal one, which keeps
/// its digits at any distance. All others are cut by their distribution functions.
///
/// # Errors
/// If `of` is not on the line or has no distribution function, `low` is not below `high`, or nothing is drawn
/// between.
pub fn truncate(of: Arc<dyn Density>, low: f64, high: f64) -> Result<Arc<dyn Density>, ParameterError> {
    if of.space() != Space::Line {
        let need = Space::Line.to_string();
        return Err(ParameterError::WrongSpace {
            argument: "the density to be cut".into(),
            space: of.space(),
            need,
        });
    }
    if !(low < high) {
        return Err(ParameterError::Cut { argument: "[low, high]", low, high });
    }
    let Some(cumulative) = of.cumulative() else {
        let (argument, what) = ("the density to be cut", "distribution function");
        return Err(ParameterError::Missing { argument, what });
    };
    if let Some(cut) = cumulative.between(low, high) {
        return cut;
    }
    Ok(Arc::new(Truncated::new(of, low, high)?))
}

/// A distribution cut to an interval, by its distribution function: from the tail in which the interval lies,
/// so that it loses no more digits than the interval is narrower than its distance from that tail's end.
#[derive(Clone, Debug)]
struct Truncated {
    of: Arc<dyn Density>,
    low: f64,
    high: f64,
    /// Are probabilities counted from above?
    from_above: bool,
    /// The probability beyond the end that is counted from.
    beyond: f64,
    /// That between the ends.
    mass: f64,
}

impl Truncated {
    fn new(of: Arc<dyn Density>, low: f64, high: f64) -> Result<Self, ParameterError> {
        let [[of_low, of_high]] = of.support()[..] else { unreachable!("on the line") };
        let nothing = ParameterError::Nothing { argument: "[low, high]", low, high };
        // An end beyond the support cuts nothing.
        let (low, high) = (low.max(of_low), high.min(of_high));
        let mut cut = Self { of, low, high, from_above: false, beyond: 0.0, mass: 1.0 };
        let of = cut.cumulative_of();
        let (below, above) = (of.cdf(low), of.above(high));
        let from_above = below > above;
        let mass = if from_above { of.above(low) - above } else { of.cdf(high) - below };
        if !(mass > 0.0) {
            return Err(nothing);
        }
        if !mass.recip().is_finite() {
            return Err(bad("the probability within [low, high]", mass, "one whose inverse is finite"));
        }
        (cut.from_above, cut.beyond, cut.mass) = (from_above, if from_above { above } else { below }, mass);
        Ok(cut)
    }

    fn cumulative_of(&self) -> &dyn Cumulative {
        self.of.cumulative().expect("checked by `truncate`")
    }
}

impl Density for Truncated {
    fn space(&self) -> Space {
        Space::Line
    }

    fn uniforms(&self) -> usize {
        1
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        for (&u, x) in u.column(0).iter().zip(x.column(0)) {
            *x = self.icdf(u.max(super::line::LEAST));
        }
        self.pdf(x.as_columns(), pdf)
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        self.of.pdf(x, pdf)?;
        for (&x, pdf) in x.column(0).iter().zip(pdf) {
            *pdf = if x >= self.low && x <= self.high { *pdf / self.mass } else { 0.0 };
        }
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        vec![[self.low, self.high]]
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        self.of.domain().map(|_| self.support())
    }

    /// ∫ x p(x) dx as the mean of the inverse distribution function over [0, 1], if the interval is finite
    /// and halving parts of it settles the sum.
    fn mean(&self) -> Option<Vec<f64>> {
        if !(self.low.is_finite() && self.high.is_finite()) {
            return None;
        }
        let width = self.high - self.low;
        let offset = super::quadrature::integrate(|u| (self.icdf(u) - self.low) / width, 0.0, 1.0, 1e-12)?;
        Some(vec![(self.low + offset * width).clamp(self.low, self.high)])
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }

    fn cumulative(&self) -> Option<&dyn Cumulative> {
        Some(self)
    }
}

impl Inverse for Truncated {
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        let mut pdf = vec![0.0; x.len()];
        self.pdf(x, &mut pdf)?;
        for ((&x, u), pdf) in x.column(0).iter().zip(u.column(0)).zip(pdf) {
            *u = if pdf > 0.0 { super::line::below_one(self.cdf(x)) } else { f64::NAN };
        }
        Ok(())
    }
}

impl Cumulative for Truncated {
    fn cdf(&self, x: f64) -> f64 {
        let (x, of) = (x.clamp(self.low, self.high), self.cumulative_of());
        if self.from_above {
            1.0 - ((of.above(x) - self.beyond) / self.mass).clamp(0.0, 1.0)
        } else {
            ((of.cdf(x) - self.beyond) / self.mass).clamp(0.0, 1.0)
        }
    }

    fn icdf(&self, u: f64) -> f64 {
        let of = self.cumulative_of();
        let x = if self.from_above {
            of.inverse_above(((1.0 - u) * self.mass + self.beyond).min(1.0))
        } else {
            of.icdf((u * self.mass + self.beyond).min(1.0))
        };
        x.clamp(self.low, self.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distributions::{Exponential, Linear, Normal, Uniform};

    #[test]
    fn far_tails_keep_their_digits() {
        // An exponential forgets: cut to [700, 701] it is as on [0, 1].
        let cut = truncate(Arc::new(Exponential::new(1.0).unwrap()), 700.0, 701.0).unwrap();
        let cumulative = cut.cumulative().unwrap();
        let whole = -(-1.0_f64).exp_m1();
        for u in [0.0, 0.3, 0.9, 1.0] {
            let x = 700.0 - (-u * whole).ln_1p();
            assert!((cumulative.icdf(u) - x).abs() < 1e-12, "{u}: {}", cumulative.icdf(u));
            assert!((cumulative.cdf(x) - u).abs() < 1e-12);
        }
        let mean = cut.mean().unwrap()[0];
        assert!((mean - 700.0 - (1.0 - 1.0 / whole * (-1.0_f64).exp())).abs() < 1e-9, "{mean}");
        let mut pdf = [0.0];
        cut.pdf(Columns::new(&[700.0], 1), &mut pdf).unwrap();
        assert!((pdf[0] - 1.0 / whole).abs() < 1e-12);
    }

    #[test]
    fn a_normal_has_a_form_of_its_own() {
        let normal = Arc::new(Normal::new(1.0, 2.0).unwrap());
        let cut = truncate(normal, 81.0, 83.0).unwrap();
        let x = cut.cumulative().unwrap().icdf(0.5);
        assert!((81.0..81.1).contains(&x), "{x}");
    }

    #[test]
    fn cuts_outside_the_support_cut_nothing() {
        let cut = truncate(Arc::new(Linear::new(0.0, 1.0, 1.0, 0.0).unwrap()), -5.0, 0.5).unwrap();
        assert_eq!(cut.support(), [[0.0, 0.5]]);
        let text = |low, high| {
            truncate(Arc::new(Uniform::new(0.0, 1.0).unwrap()), low, high).unwrap_err().to_string()
        };
        assert!(text(0.0, 0.0).ends_with("either may be infinite"));
        assert!(text(1e300, 2e300).starts_with("[low, high] = [1e300, 2e300] holds nothing"));
        let error = truncate(Arc::new(Uniform::new(0.0, 1.0).unwrap()), 2.0, 3.0).unwrap_err();
        assert!(matches!(error, ParameterError::Nothing { .. }), "{error}");
        assert!(truncate(Arc::new(Uniform::new(0.0, 1.0).unwrap()), 0.5, f64::NAN).is_err());
    }
}
