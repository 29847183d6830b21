//! How much of a file is taken in, by the names of limits.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sr_import::Limits;

/// What Python set, by name.
pub type Named = Vec<(String, u64)>;

/// The limits, some of them set; raises ValueError if one cannot be.
pub fn limits(named: Named) -> PyResult<Limits> {
    let mut limits = Limits::default();
    for (name, most) in named {
        limits.set(&name, most).map_err(PyValueError::new_err)?;
    }
    Ok(limits)
}

/// Raises ValueError unless there are such limits and they can be set so.
#[pyfunction]
pub fn check_limits(named: Named) -> PyResult<()> {
    limits(named).map(drop)
}
