//! Blocks of points to NumPy arrays and back.
//!
//! Points are rows in Python, (n, dim), and columns in Rust; an array in Fortran order is both.

use numpy::ndarray::{Array2, ArrayView2, ShapeBuilder};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Columns, one after the other, of a two-dimensional array.
pub fn to_columns(rows: &PyReadonlyArray2<'_, f64>) -> (Vec<f64>, usize) {
    let view: ArrayView2<'_, f64> = rows.as_array();
    let (n, dim) = view.dim();
    let mut numbers = Vec::with_capacity(n * dim);
    for column in view.columns() {
        match column.as_slice() {
            Some(column) => numbers.extend_from_slice(column),
            None => numbers.extend(column),
        }
    }
    (numbers, n)
}

/// Columns as an array of rows, in Fortran order. Nothing is copied.
pub fn to_rows<'py>(py: Python<'py>, numbers: Vec<f64>, n: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let dim = numbers.len().checked_div(n).unwrap_or(0);
    let array = Array2::from_shape_vec((n, dim).f(), numbers);
    let array = array.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(PyArray2::from_owned_array(py, array))
}

/// The numbers of an array of one or two dimensions with `n` rows, column after column, appended to `to`.
///
/// - returns: the number of columns; `None` if it has another shape
pub fn append_columns(array: &Bound<'_, PyAny>, n: usize, to: &mut Vec<f64>) -> Option<usize> {
    if let Ok(one) = array.cast::<PyArray1<f64>>() {
        let view = one.readonly();
        let view = view.as_array();
        to.extend(view.iter());
        return (view.len() == n).then_some(1);
    }
    let two = array.cast::<PyArray2<f64>>().ok()?.readonly();
    if two.as_array().nrows() != n {
        return None;
    }
    let (numbers, _) = to_columns(&two);
    let outputs = two.as_array().ncols();
    to.extend(numbers);
    Some(outputs)
}
