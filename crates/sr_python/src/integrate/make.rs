//! Making densities: one function for each kind, from checked Python values.

use std::sync::Arc;

use pyo3::prelude::*;
use sr_integrate::distributions::{
    Exponential, Linear, Mixture, Normal, Power, Product, Tent, Uniform, UniformBox, truncate,
};
use sr_integrate::{Density as RustDensity, Space};

use super::density::Density;
use super::foreign::ForeignDensity;
use crate::names::value_error;

/// Adds the functions of this file to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(foreign_density, module)?)?;
    module.add_function(wrap_pyfunction!(uniform, module)?)?;
    module.add_function(wrap_pyfunction!(uniform_box, module)?)?;
    module.add_function(wrap_pyfunction!(linear, module)?)?;
    module.add_function(wrap_pyfunction!(tent, module)?)?;
    module.add_function(wrap_pyfunction!(exponential, module)?)?;
    module.add_function(wrap_pyfunction!(normal, module)?)?;
    module.add_function(wrap_pyfunction!(power, module)?)?;
    module.add_function(wrap_pyfunction!(truncated, module)?)?;
    module.add_function(wrap_pyfunction!(product, module)?)?;
    module.add_function(wrap_pyfunction!(mixture, module)?)?;
    Ok(())
}

/// What Python gets for a density, or for why there is none.
pub fn made<D: RustDensity + 'static, E: ToString>(density: Result<D, E>) -> PyResult<Density> {
    density.map(|density| Density(Arc::new(density))).map_err(value_error)
}

/// A density that is written in Python.
#[pyfunction]
fn foreign_density(
    object: Py<PyAny>,
    name: String,
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
    Density(Arc::new(ForeignDensity { object, name, space, uniforms, support }))
}

#[pyfunction]
fn uniform(low: f64, high: f64) -> PyResult<Density> {
    made(Uniform::new(low, high))
}

#[pyfunction]
fn uniform_box(sides: Vec<[f64; 2]>) -> PyResult<Density> {
    made(UniformBox::new(&sides))
}

#[pyfunction]
fn linear(low: f64, high: f64, at_low: f64, at_high: f64) -> PyResult<Density> {
    made(Linear::new(low, high, at_low, at_high))
}

#[pyfunction]
fn tent(low: f64, peak: f64, high: f64) -> PyResult<Density> {
    made(Tent::new(low, peak, high))
}

#[pyfunction]
fn exponential(rate: f64) -> PyResult<Density> {
    made(Exponential::new(rate))
}

#[pyfunction]
fn normal(mean: f64, sd: f64) -> PyResult<Density> {
    made(Normal::new(mean, sd))
}

#[pyfunction]
fn power(exponent: f64, low: f64, high: f64) -> PyResult<Density> {
    made(Power::new(exponent, low, high))
}

/// Another density on the line, cut to [low, high].
#[pyfunction]
fn truncated(of: &Density, low: f64, high: f64) -> PyResult<Density> {
    let density = truncate(of.0.clone(), low, high).map_err(value_error)?;
    Ok(Density(density))
}

#[pyfunction]
fn product(factors: Vec<Py<Density>>) -> PyResult<Density> {
    made(Product::new(factors.iter().map(|p| p.get().0.clone()).collect()))
}

#[pyfunction]
fn mixture(components: Vec<Py<Density>>, weights: Vec<f64>) -> PyResult<Density> {
    made(Mixture::new(components.iter().map(|p| p.get().0.clone()).collect(), weights))
}
