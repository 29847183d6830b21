//! Mixtures: p(x) = Σᵢ wᵢ pᵢ(x) is a distribution again.

use std::marker::PhantomData;

use thiserror::Error;

use crate::distribution::{Distribution, PointOf, RealOf, Sample};
use crate::measure::{Measure, Real};

/// Why a list of weights is not one.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MixtureError {
    /// No component at all.
    #[error("a mixture needs at least one component")]
    Empty,
    /// A weight that is negative, infinite or NaN.
    #[error("mixture weight {index} is {weight}; weights must be finite and not negative")]
    BadWeight {
        /// Position in the list.
        index: usize,
        /// The weight given.
        weight: f32,
    },
    /// Weights that do not sum to one.
    #[error("mixture weights sum to {sum}, not to 1")]
    BadSum {
        /// The sum found.
        sum: f32,
    },
}

/// A weighted list of distributions of one kind (or of an `Any…` enum).
///
/// `S` is where the `(weight, component)` pairs live: a `Vec`, an array, a slice. Hot loops use an
/// array on the stack.
///
/// ```
/// use sr_sampling::{Distribution, Mixture};
/// use sr_sampling::warp::{AnyHemisphere, CosineHemisphere, UniformHemisphere};
/// let half = Mixture::new([
///     (0.5, AnyHemisphere::Uniform(UniformHemisphere)),
///     (0.5, AnyHemisphere::Cosine(CosineHemisphere)),
/// ])?;
/// let up = glam::Vec3::Z;
/// assert!((half.pdf(up) - 0.75 / std::f32::consts::PI).abs() < 1e-6);
/// # Ok::<(), sr_sampling::MixtureError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Mixture<D, S = Vec<(f32, D)>> {
    parts: S,
    component: PhantomData<D>,
}

impl<D: Distribution, S: AsRef<[(f32, D)]>> Mixture<D, S> {
    /// Builds a mixture from `(weight, component)` pairs.
    ///
    /// # Errors
    /// If there is no pair, a weight is negative or not finite, or the weights do not sum to 1
    /// within 10⁻⁴.
    pub fn new(parts: S) -> Result<Self, MixtureError> {
        check_weights(parts.as_ref().iter().map(|&(weight, _)| weight))?;
        Ok(Self { parts, component: PhantomData })
    }

    /// The `(weight, component)` pairs.
    pub fn parts(&self) -> &[(f32, D)] {
        self.parts.as_ref()
    }

    /// The component that a uniform selects: the first whose cumulative weight exceeds it.
    fn pick(&self, u: f32) -> &D {
        let mut left = u;
        let (last, rest) = self.parts().split_last().expect("a mixture has at least one component");
        for (weight, component) in rest {
            if left < *weight {
                return component;
            }
            left -= weight;
        }
        &last.1
    }
}

impl<D: Distribution, S: AsRef<[(f32, D)]>> Distribution for Mixture<D, S> {
    type Measure = D::Measure;
    type Uniform = (f32, D::Uniform);

    fn sample(&self, (u_pick, u): Self::Uniform) -> Option<Sample<D::Measure>> {
        let value = self.pick(u_pick).sample(u)?.value;
        let pdf = self.pdf(value); // of the mixture, not of the component
        (pdf > RealOf::<D>::ZERO).then_some(Sample { value, pdf })
    }

    /// p(x) = Σᵢ wᵢ pᵢ(x).
    fn pdf(&self, x: PointOf<D>) -> RealOf<D> {
        self.parts()
            .iter()
            .filter(|&&(weight, _)| weight > 0.0)
            .map(|&(weight, ref part)| RealOf::<D>::from_f64(f64::from(weight)) * part.pdf(x))
            .sum()
    }
}

/// A mixture of two distributions of different types over one measure.
#[derive(Clone, Copy, Debug)]
pub struct Mix2<A, B> {
    a: A,
    b: B,
    weight_a: f32,
}

impl<A: Distribution, B: Distribution<Measure = A::Measure>> Mix2<A, B> {
    /// `weight_a` · `a` + (1 − `weight_a`) · `b`.
    ///
    /// # Errors
    /// If `weight_a` is not in [0, 1].
    pub fn new(weight_a: f32, a: A, b: B) -> Result<Self, MixtureError> {
        check_weights([weight_a, 1.0 - weight_a].into_iter())?;
        Ok(Self { a, b, weight_a })
    }
}

impl<A: Distribution, B: Distribution<Measure = A::Measure>> Distribution for Mix2<A, B> {
    type Measure = A::Measure;
    type Uniform = (f32, A::Uniform, B::Uniform);

    fn sample(&self, (u_pick, u_a, u_b): Self::Uniform) -> Option<Sample<A::Measure>> {
        let value =
            if u_pick < self.weight_a { self.a.sample(u_a)?.value } else { self.b.sample(u_b)?.value };
        let pdf = self.pdf(value);
        (pdf > RealOf::<A>::ZERO).then_some(Sample { value, pdf })
    }

    fn pdf(&self, x: PointOf<A>) -> <A::Measure as Measure>::Real {
        let w = f64::from(self.weight_a);
        let real = <A::Measure as Measure>::Real::from_f64;
        real(w) * self.a.pdf(x) + real(1.0 - w) * self.b.pdf(x)
    }
}

/// The conditions on weights that every mixture shares.
///
/// # Errors
/// As [`Mixture::new`].
pub fn check_weights(weights: impl Iterator<Item = f32>) -> Result<(), MixtureError> {
    let (mut sum, mut count) = (0.0, 0);
    for (index, weight) in weights.enumerate() {
        if !(weight >= 0.0 && weight.is_finite()) {
            return Err(MixtureError::BadWeight { index, weight });
        }
        sum += weight;
        count += 1;
    }
    match count {
        0 => Err(MixtureError::Empty),
        _ if (sum - 1.0).abs() > 1e-4 => Err(MixtureError::BadSum { sum }),
        _ => Ok(()),
    }
}
