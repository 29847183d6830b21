//! p(x) = Σᵢ wᵢ pᵢ(x) is a density again.

use std::sync::Arc;

use super::parameter::{ParameterError, bad};
use super::solve::increasing;
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Cumulative, Density, DensityError};
use crate::space::Space;

/// A weighted sum of densities of one space.
///
/// The first uniform picks a component; stretched over the component's share of [0, 1), it is then the
/// component's own first uniform, so that strata survive. There are as many uniforms as the neediest
/// component takes.
#[derive(Clone, Debug)]
pub struct Mixture {
    components: Vec<Arc<dyn Density>>,
    /// They sum to 1, but for rounding.
    weights: Vec<f64>,
    /// Cumulative weights; the last is 1.
    bounds: Vec<f64>,
    uniforms: usize,
    space: Space,
}

/// How far a sum of weights may be from 1.
const SLACK: f64 = 1e-9;

impl Mixture {
    /// # Errors
    /// If there is no component, the lists differ in length, a weight is negative or not finite, the weights
    /// do not sum to 1 within 10⁻⁹, or the components are densities of different spaces.
    pub fn new(components: Vec<Arc<dyn Density>>, weights: Vec<f64>) -> Result<Self, ParameterError> {
        let Some(first) = components.first() else {
            return Err(ParameterError::Length { argument: "components", len: 0, need: "at least 1".into() });
        };
        if weights.len() != components.len() {
            let need = format!("{}, as many as there are components", components.len());
            return Err(ParameterError::Length { argument: "weights", len: weights.len(), need });
        }
        for (i, &weight) in weights.iter().enumerate() {
            if !(weight >= 0.0 && weight.is_finite()) {
                return Err(bad(format!("weights[{i}]"), weight, "finite and not negative"));
            }
        }
        let sum: f64 = weights.iter().sum();
        if (sum - 1.0).abs() > SLACK {
            return Err(ParameterError::Sum { sum });
        }
        let space = first.space();
        for (i, component) in components.iter().enumerate() {
            if component.space() != space {
                let (argument, found) = (format!("components[{i}]"), component.space());
                return Err(ParameterError::WrongSpace { argument, space: found, need: space.to_string() });
            }
        }
        let uniforms = components.iter().map(|component| component.uniforms()).max().unwrap_or(0).max(1);
        // A component of weight 0 is never asked for anything.
        let (components, weights): (Vec<_>, Vec<_>) =
            components.into_iter().zip(weights).filter(|&(_, weight)| weight > 0.0).unzip();
        let weights: Vec<f64> = weights.iter().map(|weight| weight / sum).collect();
        let mut bounds: Vec<f64> = weights
            .iter()
            .scan(0.0, |below, weight| {
                *below += weight;
                Some(*below)
            })
            .collect();
        *bounds.last_mut().expect("weights that sum to 1") = 1.0;
        Ok(Self { components, weights, bounds, uniforms, space })
    }

    /// The components that have a weight.
    pub fn components(&self) -> &[Arc<dyn Density>] {
        &self.components
    }

    /// Their weights, which sum to 1.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The component that a uniform picks, and what is left of the uniform.
    fn pick(&self, u: f64) -> (usize, f64) {
        let i = self.bounds.partition_point(|&bound| bound <= u).min(self.bounds.len() - 1);
        let low = if i == 0 { 0.0 } else { self.bounds[i - 1] };
        let rest = (u - low) / (self.bounds[i] - low);
        (i, rest.min(1.0 - f64::EPSILON / 2.0))
    }

    fn cumulatives(&self) -> impl Iterator<Item = (f64, &dyn Cumulative)> {
        self.weights
            .iter()
            .zip(&self.components)
            .filter_map(|(&weight, component)| component.cumulative().map(|cumulative| (weight, cumulative)))
    }
}

impl Density for Mixture {
    fn space(&self) -> Space {
        self.space
    }

    fn uniforms(&self) -> usize {
        self.uniforms
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let mut rows = vec![Vec::new(); self.components.len()];
        for (i, &u) in u.column(0).iter().enumerate() {
            let (component, rest) = self.pick(u);
            rows[component].push((i, rest));
        }
        let dim = self.space.dim();
        let mut drawn = vec![false; u.len()];
        let (mut some_u, mut some_x, mut some_pdf) = (Vec::new(), Vec::new(), Vec::new());
        for (component, rows) in self.components.iter().zip(&rows).filter(|(_, rows)| !rows.is_empty()) {
            // The rows of this component, side by side.
            some_u.clear();
            for j in 0..component.uniforms() {
                let column = u.column(j);
                some_u.extend(rows.iter().map(|&(i, rest)| if j == 0 { rest } else { column[i] }));
            }
            some_x.resize(rows.len() * dim, 0.0);
            some_pdf.resize(rows.len(), 0.0);
            let columns = Columns::new(&some_u, rows.len());
            component.sample(columns, ColumnsMut::new(&mut some_x, rows.len()), &mut some_pdf)?;
            for j in 0..dim {
                let column = x.column(j);
                for (&(i, _), &x) in rows.iter().zip(&some_x[j * rows.len()..]) {
                    column[i] = x;
                }
            }
            for (&(i, _), &pdf) in rows.iter().zip(&some_pdf) {
                drawn[i] = pdf > 0.0;
            }
        }
        self.pdf(x.as_columns(), pdf)?; // of the mixture, not of the component
        for (pdf, drawn) in pdf.iter_mut().zip(drawn) {
            *pdf = if drawn { *pdf } else { 0.0 };
        }
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let mut part = vec![0.0; pdf.len()];
        pdf.fill(0.0);
        for (component, weight) in self.components.iter().zip(&self.weights) {
            component.pdf(x, &mut part)?;
            for (pdf, part) in pdf.iter_mut().zip(&part) {
                *pdf += weight * part;
            }
        }
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        union(self.components.iter().map(|component| component.support()))
    }

    /// Between components on the line, or of indices, there may be nothing. In more dimensions the box around
    /// all of them is rarely what is meant: only components that have a range of their own have one together.
    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        if let [component] = self.components.as_slice() {
            return component.domain();
        }
        // Each asked once: components may be mixtures themselves, and theirs, too.
        let known: Vec<_> = self.components.iter().map(|part| (part.domain(), part.support())).collect();
        let union = union(known.iter().map(|(domain, support)| domain.clone().unwrap_or(support.clone())));
        if self.space.dim() > 1 {
            return known.iter().any(|(domain, _)| domain.is_some()).then_some(union);
        }
        let covers = |(domain, support): &(Option<_>, Vec<_>)| domain.is_none() && *support == union;
        (!known.iter().any(covers)).then_some(union)
    }

    fn mean(&self) -> Option<Vec<f64>> {
        let mut mean = vec![0.0; self.space.dim()];
        for (component, weight) in self.components.iter().zip(&self.weights) {
            for (mean, part) in mean.iter_mut().zip(component.mean()?) {
                *mean += weight * part;
            }
        }
        Some(mean)
    }

    fn cumulative(&self) -> Option<&dyn Cumulative> {
        (self.cumulatives().count() == self.components.len()).then_some(self as &dyn Cumulative)
    }
}

impl Cumulative for Mixture {
    fn cdf(&self, x: f64) -> f64 {
        self.cumulatives().map(|(weight, component)| weight * component.cdf(x)).sum()
    }

    /// Between the least and the greatest of the components' values.
    fn icdf(&self, u: f64) -> f64 {
        let ends = self.cumulatives().map(|(_, component)| component.icdf(u));
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if low >= high {
            return low;
        }
        if self.space == Space::Counting {
            return least_index(|index| self.cdf(index) >= u, low, high);
        }
        let step = |x: f64| (self.cdf(x), self.slope(x));
        increasing(step, u, [low, high], 0.5 * (low + high))
    }

    fn above(&self, x: f64) -> f64 {
        self.cumulatives().map(|(weight, component)| weight * component.above(x)).sum()
    }

    fn inverse_above(&self, q: f64) -> f64 {
        let ends = self.cumulatives().map(|(_, component)| component.inverse_above(q));
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if low >= high {
            return low;
        }
        if self.space == Space::Counting {
            return least_index(|index| self.above(index) <= q, low, high);
        }
        let step = |x: f64| (-self.above(x), self.slope(x));
        increasing(step, -q, [low, high], 0.5 * (low + high))
    }
}

impl Mixture {
    /// The density at one number; NaN, which is no slope, if a component fails.
    fn slope(&self, x: f64) -> f64 {
        let mut pdf = [0.0];
        match self.pdf(Columns::new(&[x], 1), &mut pdf) {
            Ok(()) => pdf[0],
            Err(_) => f64::NAN,
        }
    }
}

/// The least integer in [low, high] at which a condition holds, which it does from there on.
fn least_index(holds: impl Fn(f64) -> bool, mut low: f64, mut high: f64) -> f64 {
    while low < high {
        let middle = (0.5 * (low + high)).floor();
        if holds(middle) {
            high = middle;
        } else {
            low = middle + 1.0;
        }
    }
    high
}

/// The least box that holds all of these.
fn union(boxes: impl Iterator<Item = Vec<[f64; 2]>>) -> Vec<[f64; 2]> {
    let join = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.min(c), b.max(d)];
    boxes.reduce(|a, b| a.into_iter().zip(b).map(|(a, b)| join(a, b)).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distributions::{Exponential, Linear, Normal, Uniform, UniformBox};

    fn uniform(low: f64, high: f64) -> Arc<dyn Density> {
        Arc::new(Uniform::new(low, high).unwrap())
    }

    #[test]
    fn a_uniform_picks_and_is_stretched() {
        let mixture = Mixture::new(vec![uniform(0.0, 1.0), uniform(10.0, 12.0)], vec![0.25, 0.75]).unwrap();
        let u = [0.0, 0.125, 0.25, 0.625, 1.0 - f64::EPSILON / 2.0];
        let (mut x, mut pdf) = ([0.0; 5], [0.0; 5]);
        mixture.sample(Columns::new(&u, 5), ColumnsMut::new(&mut x, 5), &mut pdf).unwrap();
        assert_eq!((x[1], x[2], x[3]), (0.5, 10.0, 11.0));
        assert!(x[0] < 1e-15 && x[4] <= 12.0);
        assert_eq!(pdf, [0.25, 0.25, 0.375, 0.375, 0.375]);
        assert_eq!(mixture.support(), [[0.0, 12.0]]);
        assert_eq!(mixture.domain(), Some(vec![[0.0, 12.0]]), "nothing between 1 and 10");
        assert_eq!(Density::mean(&mixture), Some(vec![0.125 + 8.25]));
    }

    #[test]
    fn its_distribution_function_is_inverted() {
        let parts: Vec<Arc<dyn Density>> = vec![
            uniform(-3.0, -2.0),
            Arc::new(Normal::new(5.0, 0.01).unwrap()),
            Arc::new(Exponential::new(0.1).unwrap()),
            Arc::new(Linear::new(-1.0, 1.0, 0.0, 1.0).unwrap()),
        ];
        let mixture = Mixture::new(parts, vec![0.2, 0.3, 0.1, 0.4]).unwrap();
        let cumulative = mixture.cumulative().unwrap();
        for i in 1..1000 {
            let u = f64::from(i) / 1000.0;
            let x = cumulative.icdf(u);
            assert!((cumulative.cdf(x) - u).abs() < 1e-12, "{u}: {x} {}", cumulative.cdf(x));
            assert!((cumulative.above(x) + u - 1.0).abs() < 1e-12);
            assert!((cumulative.above(cumulative.inverse_above(u)) - u).abs() < 1e-12);
        }
        assert!(cumulative.above(300.0) > 0.0);
        assert!((cumulative.inverse_above(cumulative.above(400.0)) - 400.0).abs() < 1e-9);
    }

    #[test]
    fn errors_name_the_argument() {
        let error = |weights: &[f64]| {
            Mixture::new(vec![uniform(0.0, 1.0), uniform(0.0, 2.0)], weights.to_vec())
                .unwrap_err()
                .to_string()
        };
        assert_eq!(error(&[1.5, -0.5]), "weights[1] is -0.5; it must be finite and not negative");
        assert_eq!(error(&[0.5, 0.25]), "weights sum to 0.75; they must sum to 1");
        assert!(error(&[0.5, f64::NAN]).starts_with("weights[1] is NaN"));
        assert!(error(&[1.0]).starts_with("weights has 1 entries; it must have 2"));
        let plane: Arc<dyn Density> = Arc::new(UniformBox::new(&[[0.0, 1.0]; 2]).unwrap());
        let error = Mixture::new(vec![uniform(0.0, 1.0), plane], vec![0.5, 0.5]).unwrap_err().to_string();
        assert_eq!(error, "components[1] is a density of area in the plane; it must be one of length");
        assert!(Mixture::new(vec![], vec![]).is_err());
    }
}
