//! Writing images.

use std::path::{Path, PathBuf};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sr_render::output::{Display, Format, Metadata, OutputError, Value};

use crate::image::Image;
use crate::names::value_error;

/// A value of the metadata, tried in this order.
#[derive(FromPyObject)]
pub enum MetadataValue {
    Text(String),
    Integer(i64),
    /// A whole number beyond 63 bits.
    Large(u64),
    Real(f64),
}

fn metadata(values: Vec<(String, MetadataValue)>) -> Metadata {
    let mut metadata = Metadata::new();
    for (name, value) in values {
        let value = match value {
            MetadataValue::Text(text) => Value::Text(text),
            MetadataValue::Integer(integer) => Value::Integer(integer),
            MetadataValue::Large(large) => Value::Text(large.to_string()),
            MetadataValue::Real(real) => Value::Real(real),
        };
        metadata.set(&name, value);
    }
    metadata
}

fn display(exposure: f32, tone: &str) -> PyResult<Display> {
    if !exposure.is_finite() {
        return Err(PyValueError::new_err(format!("the exposure is a number of stops, not {exposure}")));
    }
    Ok(Display { exposure, tone: tone.parse().map_err(value_error)? })
}

/// As Python raises it.
pub fn output_error(error: OutputError) -> PyErr {
    match error {
        OutputError::UnknownFormat { .. } => value_error(error),
        // The kind of error decides Python's class, such as PermissionError; the message is ours.
        OutputError::Io { ref source, .. } => {
            PyErr::from(std::io::Error::new(source.kind(), error.to_string()))
        }
    }
}

/// Raises ValueError unless the name's extension is that of a format.
#[pyfunction]
pub fn check_format(path: PathBuf) -> PyResult<()> {
    Format::of(&path).map(drop).map_err(output_error)
}

/// Writes a file in the format that its name asks for.
#[pyfunction]
pub fn write_image(
    py: Python<'_>,
    path: PathBuf,
    image: &Image,
    metadata_values: Vec<(String, MetadataValue)>,
    exposure: f32,
    tone: &str,
) -> PyResult<()> {
    let display = display(exposure, tone)?;
    let metadata = metadata(metadata_values);
    py.detach(|| sr_render::output::write(Path::new(&path), &image.0, &metadata, display))
        .map_err(output_error)
}

/// PNG data.
#[pyfunction]
pub fn encode_png<'py>(
    py: Python<'py>,
    image: &Image,
    metadata_values: Vec<(String, MetadataValue)>,
    exposure: f32,
    tone: &str,
) -> PyResult<Bound<'py, PyBytes>> {
    let display = display(exposure, tone)?;
    let metadata = metadata(metadata_values);
    let mut bytes = Vec::new();
    py.detach(|| sr_render::output::encode_png(&image.0, &metadata, display, &mut bytes))?;
    Ok(PyBytes::new(py, &bytes))
}
