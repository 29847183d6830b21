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

/// Adds what this folder has to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    // The first array looks up NumPy's functions, and would take a Ctrl-C that comes then for NumPy's absence.
    drop(PyArray1::<f64>::zeros(module.py(), 0, false));
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
