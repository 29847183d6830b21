//! Where points come from, and by what their f is multiplied.

use std::sync::Arc;

use sr_sampling::Heuristic;
use sr_sampling::isa::{Isa, Work};
use thiserror::Error;

use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError};
use crate::space::Space;

/// A way to draw points, each with a factor: the mean of f(x) · factor, summed over the techniques of an integral, is
/// its estimate.
pub trait Technique: Sync {
    /// Where the points are.
    fn space(&self) -> Space;

    /// How many uniforms a point consumes.
    fn uniforms(&self) -> usize;

    /// Draws a point from each row of `u`. Where `factor` is 0, the point counts as 0 and may be anything.
    ///
    /// # Errors
    /// Those of the densities.
    fn draw(&self, u: Columns<'_>, x: ColumnsMut<'_>, factor: &mut [f64]) -> Result<(), DensityError>;

    /// What is taken off the points' terms, if anything is.
    fn control(&self) -> Option<&dyn Control> {
        None
    }
}

/// A control variate: numbers that resemble the terms f(x) · factor of a technique, less their known mean.
pub trait Control: Sync {
    /// How many outputs it resembles: the first so many.
    fn outputs(&self) -> usize;

    /// Writes, for each row of uniforms, a number for each output, a column each. Over the unit cube their means are 0.
    fn fill(&self, u: Columns<'_>, control: ColumnsMut<'_>);
}

/// One density: the factor is 1 / p(x).
#[derive(Clone, Debug)]
pub struct Single(pub Arc<dyn Density>);

impl Technique for Single {
    fn space(&self) -> Space {
        self.0.space()
    }

    fn uniforms(&self) -> usize {
        self.0.uniforms()
    }

    fn draw(&self, u: Columns<'_>, x: ColumnsMut<'_>, factor: &mut [f64]) -> Result<(), DensityError> {
        self.0.sample(u, x, factor)?;
        Isa::detect().run(Reciprocals(factor));
        Ok(())
    }
}

/// 1 / p, and 0 where nothing is drawn.
struct Reciprocals<'a>(&'a mut [f64]);

impl Work for Reciprocals<'_> {
    type Out = ();

    #[inline(always)]
    fn run(self) {
        for p in self.0 {
            *p = if *p > 0.0 { 1.0 / *p } else { 0.0 };
        }
    }
}

/// One of several densities whose samples are combined: the factor is wᵢ(x) / pᵢ(x) (Veach & Guibas 1995, eq. 9).
#[derive(Clone, Debug)]
pub struct Combined {
    densities: Arc<[Arc<dyn Density>]>,
    counts: Arc<[f64]>,
    heuristic: Heuristic,
    /// The one that draws.
    this: usize,
}

/// Why densities cannot be combined.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TechniqueError {
    /// Nothing to combine.
    #[error("there is no density to combine")]
    Empty,
    /// Densities of different things.
    #[error("density {index} is one of {found}, and the first is one of {expected}; they cannot be combined")]
    Spaces {
        /// Position in the list.
        index: usize,
        /// Its space.
        found: Space,
        /// That of the first.
        expected: Space,
    },
    /// Not as many counts as densities.
    #[error("counts has {counts} numbers for {densities} densities")]
    CountsLength {
        /// How many counts were given.
        counts: usize,
        /// How many densities.
        densities: usize,
    },
    /// A technique without samples.
    #[error("counts[{index}] is {count}; it must be from 1 to 2^16")]
    Count {
        /// Position in the list.
        index: usize,
        /// The number given.
        count: u32,
    },
}

impl Combined {
    /// A technique for each density. `counts`: samples of each, relative to one another.
    ///
    /// # Errors
    /// If there is none, they are densities of different things, or counts do not fit.
    pub fn all(
        densities: &[Arc<dyn Density>],
        counts: &[u32],
        heuristic: Heuristic,
    ) -> Result<Vec<Self>, TechniqueError> {
        let expected = densities.first().ok_or(TechniqueError::Empty)?.space();
        if let Some(index) = densities.iter().position(|p| p.space() != expected) {
            return Err(TechniqueError::Spaces { index, found: densities[index].space(), expected });
        }
        if counts.len() != densities.len() {
            return Err(TechniqueError::CountsLength { counts: counts.len(), densities: densities.len() });
        }
        if let Some(index) = counts.iter().position(|count| !(1..=1 << 16).contains(count)) {
            return Err(TechniqueError::Count { index, count: counts[index] });
        }
        let shared: Arc<[Arc<dyn Density>]> = densities.into();
        let counts: Arc<[f64]> = counts.iter().map(|&count| f64::from(count)).collect();
        let technique = |this| Self { densities: shared.clone(), counts: counts.clone(), heuristic, this };
        Ok((0..densities.len()).map(technique).collect())
    }
}

impl Technique for Combined {
    fn space(&self) -> Space {
        self.densities[self.this].space()
    }

    fn uniforms(&self) -> usize {
        self.densities[self.this].uniforms()
    }

    fn draw(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, factor: &mut [f64]) -> Result<(), DensityError> {
        let n = factor.len();
        let mut all = vec![0.0; n * self.densities.len()];
        self.densities[self.this].sample(u, x.reborrow(), factor)?;
        for (j, (density, pdf)) in self.densities.iter().zip(all.chunks_mut(n.max(1))).enumerate() {
            if j == self.this {
                pdf.copy_from_slice(factor);
            } else {
                density.pdf(x.as_columns(), pdf)?;
            }
        }
        let mut row = vec![0.0; self.densities.len()];
        for (i, factor) in factor.iter_mut().enumerate() {
            for (j, p) in row.iter_mut().enumerate() {
                *p = self.counts[j] * all[j * n + i];
            }
            let weight = self.heuristic.weight(row[self.this], &row);
            *factor = if *factor > 0.0 { weight / *factor } else { 0.0 };
        }
        Ok(())
    }
}
