//! Films and images as Python sees them.

use numpy::ndarray::{Dim, Dimension, Ix2, Ix3};
use numpy::{PyArray, PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use sr_render::{FilmError, RenderedImage};

/// Accumulated samples. Never changes once Python has it.
#[pyclass(frozen, module = "steradian._internal")]
pub struct Film(pub sr_render::Film);

/// Means, errors and features.
#[pyclass(frozen, module = "steradian._internal")]
pub struct Image(pub RenderedImage);

/// What Python raises for a film that cannot be.
pub fn film_error(error: FilmError) -> PyErr {
    match error {
        FilmError::Memory { .. } => PyMemoryError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}

#[pymethods]
impl Film {
    fn size(&self) -> (u32, u32) {
        self.0.size()
    }

    fn spp(&self) -> u32 {
        self.0.spp()
    }

    fn ranges(&self) -> Vec<(u32, u32)> {
        self.0.ranges().into_iter().map(|range| (range.start, range.end)).collect()
    }

    fn rejected_samples(&self) -> u64 {
        self.0.rejected_samples()
    }

    fn image(&self, py: Python<'_>) -> Image {
        Image(py.detach(|| self.0.image()))
    }

    /// A new film with the samples of both.
    fn merged(&self, py: Python<'_>, other: &Film) -> PyResult<Film> {
        py.detach(|| {
            let mut film = self.0.clone();
            film.merge(other.0.clone()).map_err(film_error)?;
            Ok(Film(film))
        })
    }
}

#[pymethods]
impl Image {
    fn rgb<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray<f32, Ix3>>> {
        self.triples(py, &self.0.rgb)
    }

    fn stderr<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray<f32, Ix3>>> {
        self.triples(py, &self.0.stderr)
    }

    fn albedo<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray<f32, Ix3>>> {
        self.triples(py, &self.0.albedo)
    }

    fn normal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray<f32, Ix3>>> {
        self.triples(py, &self.0.normal)
    }

    fn depth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray<f32, Ix2>>> {
        self.singles(py, &self.0.depth)
    }

    fn alpha<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray<f32, Ix2>>> {
        self.singles(py, &self.0.alpha)
    }

    fn mean(&self) -> (f64, f64, f64) {
        self.0.mean().into()
    }

    fn mean_stderr(&self) -> (f64, f64, f64) {
        self.0.mean_stderr().into()
    }

    fn mean_relative_error(&self) -> f64 {
        self.0.mean_relative_error()
    }
}

impl Image {
    fn triples<'py>(&self, py: Python<'py>, data: &[f32]) -> PyResult<Bound<'py, PyArray<f32, Ix3>>> {
        read_only(py, data, Dim([self.0.height as usize, self.0.width as usize, 3]))
    }

    fn singles<'py>(&self, py: Python<'py>, data: &[f32]) -> PyResult<Bound<'py, PyArray<f32, Ix2>>> {
        read_only(py, data, Dim([self.0.height as usize, self.0.width as usize]))
    }
}

fn read_only<'py, D: Dimension>(
    py: Python<'py>,
    data: &[f32],
    shape: D,
) -> PyResult<Bound<'py, PyArray<f32, D>>> {
    let array = PyArray1::from_slice(py, data).reshape(shape)?;
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

/// Raises ValueError for a film that is too large or empty.
#[pyfunction]
pub fn check_film_size(width: u32, height: u32) -> PyResult<()> {
    sr_render::Film::new(width, height).map(drop).map_err(film_error)
}

/// The memory, in bytes, that a render of this size needs for its film at least: the sum so far, the pass under
/// way, and the finished image.
#[pyfunction]
pub fn film_bytes(width: u32, height: u32) -> u64 {
    const SUMS_PER_PIXEL: u64 = 32;
    const IMAGE_PER_PIXEL: u64 = 14;
    u64::from(width) * u64::from(height) * 4 * (2 * SUMS_PER_PIXEL + IMAGE_PER_PIXEL)
}
