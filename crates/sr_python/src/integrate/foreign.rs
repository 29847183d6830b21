//! Densities, integrands and targets that are written in Python.

use std::error::Error;
use std::fmt;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sr_integrate::integrate::{Blocks, Target};
use sr_integrate::{Columns, ColumnsMut, DensityError, Space};

use super::arrays::{append_columns, to_rows};

fn foreign(error: PyErr) -> DensityError {
    DensityError::Foreign(Box::new(error))
}

/// A density whose `sample` and `pdf` are Python's.
pub struct ForeignDensity {
    /// `sample(u) -> (x, pdf)` and `pdf(x)`, over float64 arrays whose shapes were checked.
    pub object: Py<PyAny>,
    /// Its class, for messages.
    pub name: String,
    pub space: Space,
    pub uniforms: usize,
    pub support: Vec<[f64; 2]>,
}

impl fmt::Debug for ForeignDensity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ForeignDensity").field("space", &self.space).finish_non_exhaustive()
    }
}

impl ForeignDensity {
    fn sample_rows(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> PyResult<()> {
        Python::attach(|py| {
            let n = pdf.len();
            let rows = to_rows(py, u.numbers().to_vec(), n)?;
            let pair = self.object.call_method1(py, "_sample_rows", (rows,))?;
            let (value, density): (Bound<'_, PyAny>, Bound<'_, PyAny>) = pair.extract(py)?;
            copy(&value, n, x.numbers())?;
            copy(&density, n, pdf)
        })
    }
}

/// Copies an array with `n` rows to columns.
fn copy(array: &Bound<'_, PyAny>, n: usize, to: &mut [f64]) -> PyResult<()> {
    let mut numbers = Vec::with_capacity(to.len());
    if append_columns(array, n, &mut numbers).is_none() || numbers.len() != to.len() {
        return Err(PyValueError::new_err("an array of another shape than expected"));
    }
    to.copy_from_slice(&numbers);
    Ok(())
}

impl sr_integrate::Density for ForeignDensity {
    fn space(&self) -> Space {
        self.space
    }

    fn uniforms(&self) -> usize {
        self.uniforms
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        self.sample_rows(u, x.reborrow(), pdf).map_err(foreign)?;
        DensityError::check(&format!("the pdf of {}.sample", self.name), pdf, x.as_columns(), |_| true)
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        Python::attach(|py| {
            let rows = to_rows(py, x.numbers().to_vec(), pdf.len())?;
            copy(self.object.call_method1(py, "_pdf_rows", (rows,))?.bind(py), pdf.len(), pdf)
        })
        .map_err(foreign)?;
        DensityError::check(&format!("{}.pdf", self.name), pdf, x, |_| true)
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.support.clone()
    }
}

/// A function of points (n, dim) that returns (n,) or (n, outputs), float64.
#[derive(Debug)]
pub struct Function(pub Py<PyAny>);

impl Function {
    fn call(&self, x: Vec<f64>, n: usize, f: &mut Vec<f64>) -> PyResult<usize> {
        Python::attach(|py| {
            let values = self.0.call1(py, (to_rows(py, x, n)?,))?;
            append_columns(values.bind(py), n, f)
                .ok_or_else(|| PyValueError::new_err("an array of another shape than expected"))
        })
    }
}

impl Blocks for Function {
    fn eval(
        &mut self,
        x: Vec<f64>,
        n: usize,
        f: &mut Vec<f64>,
    ) -> Result<usize, Box<dyn Error + Send + Sync>> {
        Ok(self.call(x, n, f)?)
    }
}

impl Target for Function {
    fn eval(&self, x: Columns<'_>, target: &mut [f64]) -> Result<(), DensityError> {
        let mut values = Vec::with_capacity(target.len());
        self.call(x.numbers().to_vec(), x.len(), &mut values).map_err(foreign)?;
        if values.len() != target.len() {
            return Err(foreign(PyValueError::new_err("target must return one number a point")));
        }
        target.copy_from_slice(&values);
        Ok(())
    }
}
