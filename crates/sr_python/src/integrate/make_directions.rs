//! Making densities over directions and disks, and moved ones.

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use sr_integrate::distributions::{
    Affine, AreaLight, Cone, Cosine, Disk, VisibleNormals, VonMisesFisher, Zonal,
    spherical_rectangle as rectangle, spherical_triangle as triangle,
};

use super::density::Density;
use super::make::made;
use crate::names::value_error;

/// Adds the functions of this file to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(disk, module)?)?;
    module.add_function(wrap_pyfunction!(uniform_sphere, module)?)?;
    module.add_function(wrap_pyfunction!(uniform_hemisphere, module)?)?;
    module.add_function(wrap_pyfunction!(cosine_hemisphere, module)?)?;
    module.add_function(wrap_pyfunction!(cone, module)?)?;
    module.add_function(wrap_pyfunction!(von_mises_fisher, module)?)?;
    module.add_function(wrap_pyfunction!(visible_normals, module)?)?;
    module.add_function(wrap_pyfunction!(area_light, module)?)?;
    module.add_function(wrap_pyfunction!(spherical_triangle, module)?)?;
    module.add_function(wrap_pyfunction!(spherical_rectangle, module)?)?;
    module.add_function(wrap_pyfunction!(affine, module)?)?;
    Ok(())
}

type Vector = [f64; 3];

#[pyfunction]
fn disk(radius: f64) -> PyResult<Density> {
    made(Disk::new(radius))
}

#[pyfunction]
fn uniform_sphere() -> PyResult<Density> {
    made(Zonal::new(Cone::SPHERE, [0.0, 0.0, 1.0]))
}

#[pyfunction]
fn uniform_hemisphere(axis: Vector) -> PyResult<Density> {
    made(Zonal::new(Cone::HEMISPHERE, axis))
}

#[pyfunction]
fn cosine_hemisphere(axis: Vector) -> PyResult<Density> {
    made(Zonal::new(Cosine, axis))
}

#[pyfunction]
fn cone(axis: Vector, angle: f64) -> PyResult<Density> {
    made(Zonal::new(Cone::new(angle).map_err(value_error)?, axis))
}

#[pyfunction]
fn von_mises_fisher(mean_direction: Vector, kappa: f64) -> PyResult<Density> {
    made(Zonal::new(VonMisesFisher::new(kappa).map_err(value_error)?, mean_direction))
}

#[pyfunction]
fn visible_normals(wo: Vector, alpha: [f64; 2]) -> PyResult<Density> {
    made(VisibleNormals::new(wo, alpha))
}

#[pyfunction]
fn area_light(corner: Vector, edge1: Vector, edge2: Vector, seen_from: Vector) -> PyResult<Density> {
    made(AreaLight::new(corner, [edge1, edge2], seen_from))
}

#[pyfunction]
fn spherical_triangle(a: Vector, b: Vector, c: Vector) -> PyResult<Density> {
    made(triangle(a, b, c))
}

#[pyfunction]
fn spherical_rectangle(corner: Vector, edge1: Vector, edge2: Vector, seen_from: Vector) -> PyResult<Density> {
    made(rectangle(corner, [edge1, edge2], seen_from))
}

/// A y + b, y from another density; `matrix` row after row.
#[pyfunction]
fn affine(
    of: &Density,
    matrix: PyReadonlyArray1<'_, f64>,
    offset: PyReadonlyArray1<'_, f64>,
) -> PyResult<Density> {
    made(Affine::new(of.0.clone(), matrix.as_array().to_vec(), offset.as_array().to_vec()))
}
