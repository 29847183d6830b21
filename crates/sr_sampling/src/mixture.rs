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
    /// The sum of the weights: 1, but for rounding.
    sum: f32,
    component: PhantomData<D>,
}

impl<D: Distribution, S: AsRef<[(f32, D)]>> Mixture<D, S> {
    /// Builds a mixture from `(weight, component)` pairs.
    ///
    /// # Errors
    /// If there is no pair, a weight is negative or not finite, or the weights do not sum to 1
    /// within 10⁻⁴. What they miss by is made up for, so that the density is one all the same.
    pub fn new(parts: S) -> Result<Self, MixtureError> {
        let sum = check_weights(parts.as_ref().iter().map(|&(weight, _)| weight))?;
        Ok(Self { parts, sum, component: PhantomData })
    }

    /// The `(weight, component)` pairs.
    pub fn parts(&self) -> &[(f32, D)] {
        self.parts.as_ref()
    }

    /// The weight and the component that a uniform selects: the first whose cumulative weight exceeds
    /// it. Never one of weight 0.
    pub fn pick(&self, u: f32) -> &(f32, D) {
        self.pick_and_reuse(u).0
    }

    /// [`Mixture::pick`], and what is left of the uniform: a uniform that may be used again, if coarser.
    ///
    /// Used for the component's sample, it keeps the strata of the uniform that it came from.
    pub fn pick_and_reuse(&self, u: f32) -> (&(f32, D), f32) {
        const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
        let mut left = u * self.sum;
        let mut last = &self.parts()[0];
        for part in self.parts().iter().filter(|(weight, _)| *weight > 0.0) {
            if left < part.0 {
                return (part, (left / part.0).min(BELOW_ONE));
            }
            left -= part.0;
            last = part;
        }
        (last, BELOW_ONE)
    }
}

impl<D: Distribution, S: AsRef<[(f32, D)]>> Distribution for Mixture<D, S> {
    type Measure = D::Measure;
    type Uniform = (f32, D::Uniform);

    fn sample(&self, (u_pick, u): Self::Uniform) -> Option<Sample<D::Measure>> {
        let value = self.pick(u_pick).1.sample(u)?.value;
        let pdf = self.pdf(value); // of the mixture, not of the component
        (pdf > RealOf::<D>::ZERO).then_some(Sample { value, pdf })
    }

    /// p(x) = Σᵢ wᵢ pᵢ(x).
    fn pdf(&self, x: PointOf<D>) -> RealOf<D> {
        self.parts()
            .iter()
            .filter(|&&(weight, _)| weight > 0.0)
            .map(|&(weight, ref part)| RealOf::<D>::from_f64(f64::from(weight / self.sum)) * part.pdf(x))
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
        let real = |w: f32| <A::Measure as Measure>::Real::from_f64(f64::from(w));
        let weighted = |w: f32, pdf| if w > 0.0 { real(w) * pdf } else { RealOf::<A>::ZERO };
        weighted(self.weight_a, self.a.pdf(x)) + weighted(1.0 - self.weight_a, self.b.pdf(x))
    }
}

/// The conditions on weights that every mixture shares. Returns their sum, nearly 1.
///
/// # Errors
/// As [`Mixture::new`].
pub fn check_weights(weights: impl Iterator<Item = f32>) -> Result<f32, MixtureError> {
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
        _ if (sum - 1.0_f32).abs() > 1e-4 => Err(MixtureError::BadSum { sum }),
        _ => Ok(sum),
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::warp::{AnyHemisphere, CosineHemisphere, UniformCone, UniformHemisphere, UniformSphere};

    const UNIFORM: AnyHemisphere = AnyHemisphere::Uniform(UniformHemisphere);
    const COSINE: AnyHemisphere = AnyHemisphere::Cosine(CosineHemisphere);

    #[test]
    fn the_density_is_of_the_mixture_not_of_the_component() {
        let mixture = Mixture::new([(0.25, UNIFORM), (0.75, COSINE)]).unwrap();
        for u_pick in [0.0, 0.24, 0.26, 0.99] {
            let s = mixture.sample((u_pick, Vec2::new(0.3, 0.8))).unwrap();
            let expected = 0.25 * UNIFORM.pdf(s.value) + 0.75 * COSINE.pdf(s.value);
            assert!((s.pdf - expected).abs() < 1e-6);
            let component = if u_pick < 0.25 { UNIFORM } else { COSINE };
            assert_eq!(s.value, component.sample(Vec2::new(0.3, 0.8)).unwrap().value);
        }
    }

    #[test]
    fn a_pair_is_a_list_of_two() {
        let pair = Mix2::new(0.3, UniformHemisphere, CosineHemisphere).unwrap();
        let list = Mixture::new(vec![(0.3, UNIFORM), (0.7, COSINE)]).unwrap();
        let u = Vec2::new(0.7, 0.1);
        for u_pick in [0.1, 0.29, 0.31, 0.9] {
            let (a, b) = (pair.sample((u_pick, u, u)).unwrap(), list.sample((u_pick, u)).unwrap());
            assert_eq!(a.value, b.value);
            assert!((a.pdf - b.pdf).abs() < 1e-6);
        }
    }

    #[test]
    fn weights_that_miss_one_a_little_still_give_a_density() {
        let parts = [(0.33333, UNIFORM), (0.33333, UNIFORM), (0.33333, UNIFORM)];
        let mixture = Mixture::new(parts).unwrap();
        assert!((mixture.pdf(Vec3::Z) / UNIFORM.pdf(Vec3::Z) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_component_of_weight_zero_is_never_drawn() {
        let cone = |cos| UniformCone::from_cos(cos).unwrap(); // the whole sphere; about the pole
        let mixture = Mixture::new([(0.0, cone(-1.0)), (1.0, cone(0.5)), (0.0, cone(-1.0))]).unwrap();
        let rim = Vec2::new(0.0, 0.5);
        for u_pick in [0.0, 0.5, 1.0 - f32::EPSILON / 2.0] {
            assert!(mixture.sample((u_pick, rim)).unwrap().value.z > 0.49);
        }
        assert_eq!(mixture.pdf(-Vec3::Z), 0.0);
        let pair = Mix2::new(0.0, UniformSphere, UniformHemisphere).unwrap();
        assert_eq!(pair.pdf(-Vec3::Z), 0.0);
    }

    #[test]
    fn errors_name_the_weight() {
        let new = |w: [f32; 2]| Mixture::new([(w[0], UNIFORM), (w[1], COSINE)]).map(|_| ()).unwrap_err();
        assert_eq!(new([1.5, -0.5]), MixtureError::BadWeight { index: 1, weight: -0.5 });
        assert_eq!(new([f32::INFINITY, 0.0]), MixtureError::BadWeight { index: 0, weight: f32::INFINITY });
        assert!(matches!(new([0.5, f32::NAN]), MixtureError::BadWeight { index: 1, .. }));
        assert_eq!(new([0.5, 0.25]), MixtureError::BadSum { sum: 0.75 });
        assert_eq!(Mixture::<UniformSphere>::new(vec![]).map(|_| ()).unwrap_err(), MixtureError::Empty);
        assert!(Mix2::new(1.25, UniformSphere, UniformSphere).is_err());
    }
}
