//! The density that learning returns.

use std::sync::Arc;

use thiserror::Error;

use super::component::Component;
use super::cube::CubeDensity;
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError, Inverse};
use crate::space::Space;

/// A density that was drawn from a cube, itself sampled by a learned density.
///
/// `base` maps uniforms to points; instead of uniforms it is given points of `cube`. So the density at x is base's
/// times the cube's at the uniforms that base maps to x.
#[derive(Clone, Debug)]
pub struct Learned {
    base: Arc<dyn Density>,
    cube: CubeDensity,
}

/// The density of a learned density cannot be told at points from elsewhere, though it can be sampled.
#[derive(Debug, Error)]
#[error("the density that was learned over cannot be inverted, so its pdf is known only where it samples")]
struct NotInvertible;

impl Learned {
    /// # Panics
    /// If `cube` has not as many coordinates as `base` consumes uniforms.
    pub fn new(base: Arc<dyn Density>, cube: CubeDensity) -> Self {
        assert_eq!(base.uniforms(), cube.dim());
        Self { base, cube }
    }

    /// What was learned over.
    pub fn base(&self) -> &Arc<dyn Density> {
        &self.base
    }

    /// What was learned.
    pub fn cube(&self) -> &CubeDensity {
        &self.cube
    }

    fn base_inverse(&self) -> Result<&dyn Inverse, DensityError> {
        self.base.inverse().ok_or_else(|| DensityError::Foreign(Box::new(NotInvertible)))
    }

    /// The only component, if there is one.
    fn only(&self) -> Option<&Component> {
        let [component] = self.cube.components() else { return None };
        component.frame().is_none().then_some(component)
    }
}

impl Density for Learned {
    fn space(&self) -> Space {
        self.base.space()
    }

    fn uniforms(&self) -> usize {
        self.base.uniforms()
    }

    fn sample(&self, u: Columns<'_>, x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let n = pdf.len();
        let mut v = vec![0.0; n * self.uniforms()];
        let mut q = vec![0.0; n];
        self.cube.sample(u, ColumnsMut::new(&mut v, n), &mut q);
        self.base.sample(Columns::new(&v, n), x, pdf)?;
        pdf.iter_mut().zip(&q).for_each(|(p, q)| *p *= q);
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let n = pdf.len();
        let mut v = vec![0.0; n * self.uniforms()];
        let mut q = vec![0.0; n];
        self.base_inverse()?.invert(x, ColumnsMut::new(&mut v, n))?;
        self.cube.pdf(Columns::new(&v, n), &mut q);
        self.base.pdf(x, pdf)?;
        pdf.iter_mut().zip(&q).for_each(|(p, q)| *p = if *p > 0.0 { *p * q } else { 0.0 });
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.base.support()
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        self.base.domain()
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        (self.only().is_some() && self.base.inverse().is_some()).then_some(self)
    }
}

impl Inverse for Learned {
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        let n = x.len();
        let mut v = vec![0.0; n * self.uniforms()];
        self.base_inverse()?.invert(x, ColumnsMut::new(&mut v, n))?;
        let v = Columns::new(&v, n);
        self.cube.invert_only(v, u.reborrow());
        // What is not in the support of the base has no uniforms.
        for i in (0..n).filter(|&i| (0..v.dim()).any(|j| v.get(i, j).is_nan())) {
            (0..v.dim()).for_each(|j| u.set(i, j, f64::NAN));
        }
        Ok(())
    }
}
