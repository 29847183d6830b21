//! Integrals and the densities that they sample.

mod adapt;
mod arrays;
mod check;
mod density;
mod foreign;
mod make;
mod make_directions;
mod make_tables;
mod native;
mod request;
mod run;

use numpy::PyArray1;
use pyo3::prelude::*;

pub use density::Density;

/// Looks up NumPy's functions, which the first array would do, and take a Ctrl-C that comes then for NumPy's absence.
#[pyfunction]
fn find_numpy(py: Python<'_>) {
    drop(PyArray1::<f64>::zeros(py, 0, false));
}

/// Adds what this folder has to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(find_numpy, module)?)?;
    module.add_class::<Density>()?;
    module.add_class::<native::Native>()?;
    module.add_class::<run::Integral>()?;
    module.add_class::<adapt::Adapted>()?;
    module.add_function(wrap_pyfunction!(adapt::adapt, module)?)?;
    module.add_function(wrap_pyfunction!(adapt::learned, module)?)?;
    module.add_function(wrap_pyfunction!(run::integrate, module)?)?;
    module.add_function(wrap_pyfunction!(run::mis_integrate, module)?)?;
    module.add_function(wrap_pyfunction!(run::ris_integrate, module)?)?;
    module.add_function(wrap_pyfunction!(run::points, module)?)?;
    module.add_function(wrap_pyfunction!(check::chi2, module)?)?;
    module.add_function(wrap_pyfunction!(check::ks, module)?)?;
    module.add_function(wrap_pyfunction!(run::student_t, module)?)?;
    module.add_function(wrap_pyfunction!(run::format_uncertain, module)?)?;
    make::register(module)?;
    make_tables::register(module)?;
    make_directions::register(module)
}
