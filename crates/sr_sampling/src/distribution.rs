//! The one abstraction: a probability density that can be sampled and evaluated.

use crate::measure::Measure;
use crate::uniforms::Uniforms;

/// A sampled point with the density it was drawn with.
///
/// Invariant: `pdf` is positive and finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<M: Measure> {
    /// The point.
    pub value: M::Point,
    /// Its density with respect to `M`.
    pub pdf: M::Real,
}

/// The points that a distribution draws.
pub type PointOf<D> = <<D as Distribution>::Measure as Measure>::Point;
/// The number type of a distribution's densities.
pub type RealOf<D> = <<D as Distribution>::Measure as Measure>::Real;

/// A probability density over a [`Measure`].
///
/// Uniforms are passed in, never drawn, so that stratification, inversion, replay and exact tests
/// all work on every distribution. The density may integrate to less than one: the rest is the
/// probability that `sample` returns `None`.
pub trait Distribution {
    /// What the density is a density of.
    type Measure: Measure;
    /// The uniforms in [0, 1) that one sample consumes.
    type Uniform: Uniforms;

    /// Draws a point. `None` contributes nothing to an estimate; it is not an error.
    fn sample(&self, u: Self::Uniform) -> Option<Sample<Self::Measure>>;

    /// The density at `x`; 0 outside the support.
    fn pdf(&self, x: PointOf<Self>) -> RealOf<Self>;
}

/// A distribution whose `sample` can be run backwards.
pub trait Invert: Distribution {
    /// The uniforms that `sample` maps to `x`; `None` outside the support.
    fn invert(&self, x: PointOf<Self>) -> Option<Self::Uniform>;
}

impl<D: Distribution + ?Sized> Distribution for &D {
    type Measure = D::Measure;
    type Uniform = D::Uniform;
    #[inline]
    fn sample(&self, u: Self::Uniform) -> Option<Sample<Self::Measure>> {
        (**self).sample(u)
    }
    #[inline]
    fn pdf(&self, x: PointOf<Self>) -> RealOf<Self> {
        (**self).pdf(x)
    }
}

impl<D: Invert + ?Sized> Invert for &D {
    #[inline]
    fn invert(&self, x: PointOf<Self>) -> Option<Self::Uniform> {
        (**self).invert(x)
    }
}
