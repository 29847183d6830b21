//! Making densities from tables and functions.

use std::sync::Arc;

use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sr_integrate::DensityError;
use sr_integrate::distributions::{
    Alias, Discrete, FromPdf, ParameterError, PiecewiseConstant, PiecewiseLinear, Tabulated2D,
};

use super::arrays::append_columns;
use super::density::{Density, density_error};
use super::make::made;
use crate::names::value_error;

/// Adds the functions of this file to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(piecewise_constant, module)?)?;
    module.add_function(wrap_pyfunction!(piecewise_linear, module)?)?;
    module.add_function(wrap_pyfunction!(discrete, module)?)?;
    module.add_function(wrap_pyfunction!(alias, module)?)?;
    module.add_function(wrap_pyfunction!(tabulated_2d, module)?)?;
    module.add_function(wrap_pyfunction!(from_pdf, module)?)?;
    Ok(())
}

type Numbers<'py> = PyReadonlyArray1<'py, f64>;

#[pyfunction]
fn piecewise_constant(edges: Numbers<'_>, counts: Numbers<'_>) -> PyResult<Density> {
    made(PiecewiseConstant::new(edges.as_array().to_vec(), &counts.as_array().to_vec()))
}

#[pyfunction]
fn piecewise_linear(x: Numbers<'_>, y: Numbers<'_>) -> PyResult<Density> {
    made(PiecewiseLinear::new(x.as_array().to_vec(), y.as_array().to_vec()))
}

#[pyfunction]
fn discrete(weights: Numbers<'_>) -> PyResult<Density> {
    made(Discrete::new(&weights.as_array().to_vec()))
}

#[pyfunction]
fn alias(weights: Numbers<'_>) -> PyResult<Density> {
    made(Alias::new(&weights.as_array().to_vec()))
}

#[pyfunction]
fn tabulated_2d(values: PyReadonlyArray2<'_, f64>, low: [f64; 2], high: [f64; 2]) -> PyResult<Density> {
    let view = values.as_array();
    let (nx, ny) = view.dim();
    made(Tabulated2D::new(&view.iter().copied().collect::<Vec<_>>(), [nx, ny], low, high))
}

/// A density proportional to `f`, a function of numbers (n,) that returns (n,); its error, and the integral of `f`.
#[pyfunction]
fn from_pdf(
    py: Python<'_>,
    f: Py<PyAny>,
    low: f64,
    high: f64,
    tolerance: f64,
) -> PyResult<(Density, f64, f64)> {
    let call = |x: &[f64], y: &mut [f64]| -> PyResult<()> {
        let values = f.bind(py).call1((PyArray1::from_slice(py, x),))?;
        let mut numbers = Vec::with_capacity(y.len());
        if append_columns(&values, y.len(), &mut numbers) != Some(1) {
            return Err(PyValueError::new_err(format!("f must return {} numbers for as many", y.len())));
        }
        y.copy_from_slice(&numbers);
        Ok(())
    };
    let mut blocks =
        |x: &[f64], y: &mut [f64]| call(x, y).map_err(|error| DensityError::Foreign(Box::new(error)));
    match FromPdf::from_blocks(&mut blocks, low, high, tolerance) {
        Ok(density) => {
            let (error, integral) = (density.error(), density.integral());
            Ok((Density(Arc::new(density)), error, integral))
        }
        Err(ParameterError::Density(error)) => Err(density_error(py, error)),
        Err(error) => Err(value_error(error)),
    }
}
