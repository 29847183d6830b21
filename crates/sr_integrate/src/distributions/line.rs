//! Distributions on the line that know their distribution function: the leaves.

use std::fmt;

use crate::columns::{Columns, ColumnsMut};
use crate::density::{Cumulative, Density, DensityError, Inverse};
use crate::space::Space;

/// The least uniform that a sample is drawn from: half the spacing of uniforms of 53 bits.
///
/// A uniform of 0 stands for all numbers up to the next one. Drawn from 0 itself, a distribution without a
/// lower end would give −∞, and a pole there an infinite density.
pub(crate) const LEAST: f64 = f64::EPSILON / 4.0;

/// A distribution of one real number with a distribution function that can be inverted. Everything else
/// follows: whatever implements it is a [`Density`] of [`Space::Line`], drawn by inversion, so that strata
/// survive.
pub trait OnLine: Cumulative + Send + Sync + fmt::Debug {
    /// The density at `x`; 0 outside the support, and at NaN.
    fn density(&self, x: f64) -> f64;

    /// The ends of the support, both of which belong to it if they are finite.
    fn ends(&self) -> [f64; 2];

    /// The expected value, if it exists.
    fn expected(&self) -> Option<f64>;

    /// The interval that the distribution is about, if the density may be 0 within. See [`Density::domain`].
    fn range(&self) -> Option<[f64; 2]> {
        None
    }
}

impl<L: OnLine> Density for L {
    fn space(&self) -> Space {
        Space::Line
    }

    fn uniforms(&self) -> usize {
        1
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        for ((&u, x), pdf) in u.column(0).iter().zip(x.column(0)).zip(pdf) {
            *x = self.icdf(u.max(LEAST));
            *pdf = self.density(*x);
        }
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        for (&x, pdf) in x.column(0).iter().zip(pdf) {
            *pdf = self.density(x);
        }
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        vec![self.ends()]
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        self.range().map(|ends| vec![ends])
    }

    fn mean(&self) -> Option<Vec<f64>> {
        self.expected().map(|mean| vec![mean])
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }

    fn cumulative(&self) -> Option<&dyn Cumulative> {
        Some(self)
    }
}

impl<L: OnLine> Inverse for L {
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        for (&x, u) in x.column(0).iter().zip(u.column(0)) {
            *u = if self.density(x) > 0.0 { below_one(self.cdf(x)) } else { f64::NAN };
        }
        Ok(())
    }
}

/// A uniform: not 1, and not below 0.
#[inline]
pub(crate) fn below_one(u: f64) -> f64 {
    u.clamp(0.0, 1.0 - f64::EPSILON / 2.0)
}
