//! Names that choose an algorithm, checked and brought into their normal form.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sr_render::Strategy;
use sr_render::output::Tone;
use sr_sampling::SequenceKind;

/// A value error with the message of another error.
pub fn value_error(error: impl ToString) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The normal form of a strategy expression.
#[pyfunction]
pub fn normalize_strategy(expression: &str) -> PyResult<String> {
    expression.parse::<Strategy>().map(|strategy| strategy.to_string()).map_err(value_error)
}

/// The normal form of a sampler's name.
#[pyfunction]
pub fn normalize_sampler(name: &str) -> PyResult<&'static str> {
    name.parse::<SequenceKind>().map(SequenceKind::name).map_err(value_error)
}

/// The names of the tone curves.
#[pyfunction]
pub fn tones() -> Vec<&'static str> {
    Tone::ALL.iter().map(|tone| tone.name()).collect()
}
