//! Coordinates that have nothing to do with one another.

use std::sync::Arc;

use super::parameter::ParameterError;
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Cumulative, Density, DensityError, Inverse};
use crate::space::Space;

/// Independent coordinates: p(x, y, …) = p₁(x) p₂(y) …, over the coordinates of all factors in order. Each
/// factor takes uniforms of its own.
#[derive(Clone, Debug)]
pub struct Product {
    factors: Vec<Arc<dyn Density>>,
    space: Space,
}

impl Product {
    /// # Errors
    /// If there is no factor, or one is no density per length, area or volume.
    pub fn new(factors: Vec<Arc<dyn Density>>) -> Result<Self, ParameterError> {
        if factors.is_empty() {
            return Err(ParameterError::Length { argument: "factors", len: 0, need: "at least 1".into() });
        }
        for (i, factor) in factors.iter().enumerate() {
            let space = factor.space();
            if !space.is_real() {
                let need = "length, area in the plane or volume".into();
                return Err(ParameterError::WrongSpace { argument: format!("factors[{i}]"), space, need });
            }
        }
        let space = Space::real(factors.iter().map(|factor| factor.space().dim()).sum());
        Ok(Self { factors, space })
    }

    /// The factors.
    pub fn factors(&self) -> &[Arc<dyn Density>] {
        &self.factors
    }

    /// Calls `f` with each factor, its first coordinate and its first uniform.
    fn each(
        &self,
        mut f: impl FnMut(&dyn Density, usize, usize) -> Result<(), DensityError>,
    ) -> Result<(), DensityError> {
        let (mut x, mut u) = (0, 0);
        for factor in &self.factors {
            f(factor.as_ref(), x, u)?;
            x += factor.space().dim();
            u += factor.uniforms();
        }
        Ok(())
    }
}

impl Density for Product {
    fn space(&self) -> Space {
        self.space
    }

    fn uniforms(&self) -> usize {
        self.factors.iter().map(|factor| factor.uniforms()).sum()
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let mut part = vec![0.0; pdf.len()];
        pdf.fill(1.0);
        self.each(|factor, at, first| {
            let u = u.columns(first..first + factor.uniforms());
            factor.sample(u, x.columns(at..at + factor.space().dim()), &mut part)?;
            multiply(pdf, &part);
            Ok(())
        })
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let mut part = vec![0.0; pdf.len()];
        pdf.fill(1.0);
        self.each(|factor, at, _| {
            factor.pdf(x.columns(at..at + factor.space().dim()), &mut part)?;
            multiply(pdf, &part);
            Ok(())
        })
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.factors.iter().flat_map(|factor| factor.support()).collect()
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        let any = self.factors.iter().any(|factor| factor.domain().is_some());
        let sides =
            self.factors.iter().flat_map(|factor| factor.domain().unwrap_or_else(|| factor.support()));
        any.then(|| sides.collect())
    }

    fn mean(&self) -> Option<Vec<f64>> {
        let means: Option<Vec<_>> = self.factors.iter().map(|factor| factor.mean()).collect();
        Some(means?.concat())
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        let all = self.factors.iter().all(|factor| factor.inverse().is_some());
        all.then_some(self as &dyn Inverse)
    }

    fn cumulative(&self) -> Option<&dyn Cumulative> {
        if let [factor] = self.factors.as_slice() { factor.cumulative() } else { None }
    }
}

impl Inverse for Product {
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        self.each(|factor, at, first| {
            let x = x.columns(at..at + factor.space().dim());
            let mut u = u.columns(first..first + factor.uniforms());
            match factor.inverse() {
                Some(inverse) => inverse.invert(x, u),
                None => {
                    u.numbers().fill(f64::NAN);
                    Ok(())
                }
            }
        })?;
        // Outside in one coordinate is outside in all.
        for i in 0..x.len() {
            if (0..u.dim()).any(|j| u.as_columns().get(i, j).is_nan()) {
                (0..u.dim()).for_each(|j| u.set(i, j, f64::NAN));
            }
        }
        Ok(())
    }
}

/// 0 · ∞ is 0: where one coordinate is outside, the point is.
fn multiply(pdf: &mut [f64], part: &[f64]) {
    for (pdf, &part) in pdf.iter_mut().zip(part) {
        *pdf = if *pdf == 0.0 || part == 0.0 { 0.0 } else { *pdf * part };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distributions::{Exponential, Linear, UniformBox};

    #[test]
    fn coordinates_follow_one_another() {
        let box2: Arc<dyn Density> = Arc::new(UniformBox::new(&[[0.0, 2.0], [0.0, 4.0]]).unwrap());
        let line: Arc<dyn Density> = Arc::new(Linear::new(0.0, 1.0, 0.0, 1.0).unwrap());
        let product = Product::new(vec![box2, line]).unwrap();
        assert_eq!((product.space(), product.uniforms()), (Space::Volume(3), 3));
        let u = [0.5, 0.25, 0.25];
        let (mut x, mut pdf, mut back) = ([0.0; 3], [0.0], [0.0; 3]);
        product.sample(Columns::new(&u, 1), ColumnsMut::new(&mut x, 1), &mut pdf).unwrap();
        assert_eq!((x, pdf), ([1.0, 1.0, 0.5], [0.125]));
        product.inverse().unwrap().invert(Columns::new(&x, 1), ColumnsMut::new(&mut back, 1)).unwrap();
        assert_eq!(back, u);
        product
            .inverse()
            .unwrap()
            .invert(Columns::new(&[1.0, 9.0, 0.5], 1), ColumnsMut::new(&mut back, 1))
            .unwrap();
        assert!(back.iter().all(|u| u.is_nan()));
        assert_eq!(product.mean(), Some(vec![1.0, 2.0, 2.0 / 3.0]));
    }

    #[test]
    fn outside_in_one_coordinate_is_outside() {
        let line = || -> Arc<dyn Density> { Arc::new(Exponential::new(1e300).unwrap()) };
        let product = Product::new(vec![line(), line(), line()]).unwrap();
        let mut pdf = [1.0];
        product.pdf(Columns::new(&[0.0, 0.0, -1.0], 1), &mut pdf).unwrap();
        assert_eq!(pdf, [0.0]);
        assert!(Product::new(vec![]).unwrap_err().to_string().contains("factors has 0"));
    }
}
