//! What is integrated.

use std::error::Error;

use crate::columns::Columns;

/// A function that is evaluated by one thread, a block at a time.
pub trait Blocks {
    /// Evaluates f at each point, and appends the values to `f`: all of the first output, then all of the second, …
    ///
    /// - `x`: `n` points, column after column
    /// - returns: the number of outputs, the same for every block
    ///
    /// # Errors
    /// Whatever goes wrong; the integration ends with it.
    fn eval(
        &mut self,
        x: Vec<f64>,
        n: usize,
        f: &mut Vec<f64>,
    ) -> Result<usize, Box<dyn Error + Send + Sync>>;
}

/// A function with one output that any thread may evaluate.
pub trait Parallel: Sync {
    /// Writes f at each point.
    fn eval(&self, x: Columns<'_>, f: &mut [f64]);
}

impl<F: Fn(Columns<'_>, &mut [f64]) + Sync> Parallel for F {
    fn eval(&self, x: Columns<'_>, f: &mut [f64]) {
        self(x, f);
    }
}

/// A function to be integrated.
pub enum Integrand<'a> {
    /// By the calling thread.
    Blocks(&'a mut dyn Blocks),
    /// By all threads of the pool.
    Parallel(&'a dyn Parallel),
}
