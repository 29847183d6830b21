//! Densities as Python sees them.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use sr_integrate::{Columns, ColumnsMut, DensityError};

use super::arrays::{to_columns, to_rows};

/// A density and how to sample it. Never changes.
#[pyclass(frozen, module = "steradian._internal")]
pub struct Density(pub Arc<dyn sr_integrate::Density>);

/// What Python raises: its own exception, if one was at the root of it.
pub fn density_error(py: Python<'_>, error: DensityError) -> PyErr {
    match error {
        DensityError::Foreign(error) => foreign_error(py, error),
        improper @ DensityError::Improper { .. } => PyValueError::new_err(improper.to_string()),
    }
}

/// See [`density_error`].
pub fn foreign_error(py: Python<'_>, error: Box<dyn std::error::Error + Send + Sync>) -> PyErr {
    match error.downcast::<PyErr>() {
        Ok(error) => error.clone_ref(py),
        Err(error) => PyValueError::new_err(error.to_string()),
    }
}

type Rows<'py> = Bound<'py, PyArray2<f64>>;
type Row<'py> = Bound<'py, PyArray1<f64>>;

impl Density {
    fn check(&self, argument: &str, found: usize, expected: usize) -> PyResult<()> {
        if found == expected {
            return Ok(());
        }
        Err(PyValueError::new_err(format!(
            "{argument} has {found} columns; this distribution needs {expected}"
        )))
    }
}

#[pymethods]
impl Density {
    fn space(&self) -> String {
        self.0.space().to_string()
    }

    fn is_real(&self) -> bool {
        self.0.space().is_real()
    }

    fn dim(&self) -> usize {
        self.0.space().dim()
    }

    fn uniforms(&self) -> usize {
        self.0.uniforms()
    }

    /// Points (n, dim) and densities (n,) from uniforms (n, uniforms).
    fn sample<'py>(&self, py: Python<'py>, u: PyReadonlyArray2<'py, f64>) -> PyResult<(Rows<'py>, Row<'py>)> {
        let (u, n) = to_columns(&u);
        self.check("u", u.len().checked_div(n).unwrap_or(self.0.uniforms()), self.0.uniforms())?;
        let (mut x, mut pdf) = (vec![0.0; n * self.dim()], vec![0.0; n]);
        py.detach(|| self.0.sample(Columns::new(&u, n), ColumnsMut::new(&mut x, n), &mut pdf))
            .map_err(|error| density_error(py, error))?;
        Ok((to_rows(py, x, n)?, PyArray1::from_vec(py, pdf)))
    }

    /// Densities (n,) at points (n, dim).
    fn pdf<'py>(&self, py: Python<'py>, x: PyReadonlyArray2<'py, f64>) -> PyResult<Row<'py>> {
        let (x, n) = to_columns(&x);
        self.check("x", x.len().checked_div(n).unwrap_or(self.dim()), self.dim())?;
        let mut pdf = vec![0.0; n];
        py.detach(|| self.0.pdf(Columns::new(&x, n), &mut pdf)).map_err(|error| density_error(py, error))?;
        Ok(PyArray1::from_vec(py, pdf))
    }

    /// Can samples be traced back to their uniforms?
    fn has_inverse(&self) -> bool {
        self.0.inverse().is_some()
    }

    /// Uniforms (n, uniforms) of points (n, dim); NaN outside the support.
    fn invert<'py>(&self, py: Python<'py>, x: PyReadonlyArray2<'py, f64>) -> PyResult<Rows<'py>> {
        let Some(inverse) = self.0.inverse() else {
            return Err(PyTypeError::new_err("this distribution cannot be inverted"));
        };
        let (x, n) = to_columns(&x);
        self.check("x", x.len().checked_div(n).unwrap_or(self.dim()), self.dim())?;
        let mut u = vec![0.0; n * self.0.uniforms()];
        inverse
            .invert(Columns::new(&x, n), ColumnsMut::new(&mut u, n))
            .map_err(|error| density_error(py, error))?;
        to_rows(py, u, n)
    }

    /// Is the distribution function known?
    fn has_cdf(&self) -> bool {
        self.0.cumulative().is_some()
    }

    /// The distribution function at numbers (n,).
    fn cdf<'py>(&self, py: Python<'py>, x: PyReadonlyArray1<'py, f64>) -> PyResult<Row<'py>> {
        let Some(cumulative) = self.0.cumulative() else {
            return Err(PyTypeError::new_err("the cdf of this distribution is not known"));
        };
        Ok(PyArray1::from_iter(py, x.as_array().iter().map(|&x| cumulative.cdf(x)).collect::<Vec<_>>()))
    }

    /// The inverse of the distribution function at uniforms (n,).
    fn icdf<'py>(&self, py: Python<'py>, u: PyReadonlyArray1<'py, f64>) -> PyResult<Row<'py>> {
        let Some(cumulative) = self.0.cumulative() else {
            return Err(PyTypeError::new_err("the cdf of this distribution is not known"));
        };
        Ok(PyArray1::from_iter(py, u.as_array().iter().map(|&u| cumulative.icdf(u)).collect::<Vec<_>>()))
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.0.support()
    }

    fn domain(&self) -> Option<Vec<[f64; 2]>> {
        self.0.domain()
    }

    fn mean(&self) -> Option<Vec<f64>> {
        self.0.mean()
    }

    fn __repr__(&self) -> String {
        format!("<density of {}>", self.0.space())
    }
}
