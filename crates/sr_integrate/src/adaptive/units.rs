//! Integrands whose values are far from 1, in a unit in which squares neither overflow nor vanish.
//!
//! Learning squares f in many places. So f is multiplied by a power of two, which changes no digit, and what comes out
//! is divided by it.

use std::error::Error;
use std::sync::OnceLock;

use crate::columns::Columns;
use crate::integrate::{Blocks, Exponent, Integrand, Parallel, exponent_of};

/// The unit for the first values seen: those of the first round of learning, which one thread evaluates.
#[derive(Debug, Default)]
pub struct Unit(OnceLock<Exponent>);

impl Unit {
    /// The unit; 1 if nothing was seen yet.
    pub fn get(&self) -> Exponent {
        self.0.get().copied().unwrap_or_default()
    }

    fn divide(&self, values: &mut [f64]) {
        let largest = || values.iter().filter(|x| x.is_finite()).fold(0.0, |most: f64, x| most.max(x.abs()));
        let unit = *self.0.get_or_init(|| exponent_of(largest()));
        if unit.is_far() {
            unit.divide(values);
        }
    }
}

/// An integrand in a unit of its own.
pub enum InUnit<'a> {
    /// See [`Integrand::Blocks`].
    Blocks(BlocksInUnit<'a>),
    /// See [`Integrand::Parallel`].
    Parallel(ParallelInUnit<'a>),
}

impl<'a> InUnit<'a> {
    /// `integrand` in `unit`.
    pub fn new(integrand: &'a mut Integrand<'_>, unit: &'a Unit) -> Self {
        match integrand {
            Integrand::Blocks(f) => Self::Blocks(BlocksInUnit { f: *f, unit }),
            Integrand::Parallel(f) => Self::Parallel(ParallelInUnit { f: *f, unit }),
        }
    }

    /// As any other integrand.
    pub fn integrand(&mut self) -> Integrand<'_> {
        match self {
            Self::Blocks(f) => Integrand::Blocks(f),
            Self::Parallel(f) => Integrand::Parallel(f),
        }
    }
}

pub struct BlocksInUnit<'a> {
    f: &'a mut dyn Blocks,
    unit: &'a Unit,
}

impl Blocks for BlocksInUnit<'_> {
    fn eval(
        &mut self,
        x: Vec<f64>,
        n: usize,
        f: &mut Vec<f64>,
    ) -> Result<usize, Box<dyn Error + Send + Sync>> {
        let first = f.len();
        let outputs = self.f.eval(x, n, f)?;
        self.unit.divide(&mut f[first..]);
        Ok(outputs)
    }
}

pub struct ParallelInUnit<'a> {
    f: &'a dyn Parallel,
    unit: &'a Unit,
}

impl Parallel for ParallelInUnit<'_> {
    fn eval(&self, x: Columns<'_>, f: &mut [f64]) {
        self.f.eval(x, f);
        self.unit.divide(f);
    }
}
