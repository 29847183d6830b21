//! Making densities: one function for each kind, from checked Python values.

use std::sync::Arc;

use pyo3::prelude::*;
use sr_integrate::Space;

use super::density::Density;
use super::foreign::ForeignDensity;

/// Adds the functions of this file to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(foreign_density, module)?)?;
    Ok(())
}

/// A density that is written in Python.
#[pyfunction]
fn foreign_density(
    object: Py<PyAny>,
    space: &str,
    dim: usize,
    uniforms: usize,
    support: Vec<[f64; 2]>,
) -> Density {
    let space = match space {
        "solid angle" => Space::SolidAngle,
        "surface area" => Space::Area,
        "counting" => Space::Counting,
        _ => Space::real(dim),
    };
    Density(Arc::new(ForeignDensity { object, space, uniforms, support }))
}
