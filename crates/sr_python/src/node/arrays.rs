//! Numbers in bulk: vectors, placements, colors, meshes and images from lists or NumPy arrays.

use std::sync::Arc;

use glam::{DMat4, DVec3, Vec2, Vec3};
use numpy::ndarray::{Array2, ArrayD, Ix2};
use numpy::{AllowTypeChange, PyArrayLikeDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sr_import::{Node, Property, SpectrumValue, Value};
use sr_scene::{Diagnostic, Diagnostics, Image, MeshDesc, Pixels};

use super::{shown, uniform};

/// Keys of a mesh that hold arrays.
const MESH_ARRAYS: [&str; 4] = ["vertices", "faces", "normals", "uvs"];

/// Is this key read by [`mesh`]?
pub fn is_mesh_array(parent: &Node, key: &str) -> bool {
    parent.class == "shape" && parent.kind == "mesh" && MESH_ARRAYS.contains(&key)
}

/// A copy as 64-bit floats; `None` if it is not numbers in a grid.
fn numbers(value: &Bound<'_, PyAny>) -> Option<ArrayD<f64>> {
    let array = value.extract::<PyArrayLikeDyn<'_, f64, AllowTypeChange>>().ok()?;
    Some(array.as_array().to_owned())
}

/// A point, a vector or a placement.
pub fn vector_or_transform(value: &Bound<'_, PyAny>) -> PyResult<Result<Value, String>> {
    let matrix = value.getattr_opt("matrix")?;
    // NumPy makes a grid without axes of anything at all.
    let array = numbers(matrix.as_ref().unwrap_or(value)).filter(|a| a.ndim() > 0);
    Ok(match array.as_ref().map(|a| (a.shape(), a)) {
        Some(([3], a)) => Ok(Value::Vector(DVec3::new(a[0], a[1], a[2]))),
        Some(([4, 4], a)) => {
            let rows: [f64; 16] = std::array::from_fn(|i| a[[i / 4, i % 4]]);
            if rows[12..] != [0.0, 0.0, 0.0, 1.0] {
                return Ok(Err(format!("the last row of a placement is 0 0 0 1, not {:?}", &rows[12..])));
            }
            Ok(Value::Transform(DMat4::from_cols_array(&rows).transpose()))
        }
        Some((shape, _)) => {
            Err(format!("an array of shape {shape:?} is neither a vector nor a 4 × 4 placement"))
        }
        None => Err(format!("{} is no number, text, vector, placement or object", shown(value)?)),
    })
}

/// A color or spectrum, if that is what `kind` means; the inner error is a sentence.
pub fn spectrum(kind: &str, dict: &Bound<'_, PyDict>) -> PyResult<Option<Result<Value, String>>> {
    if !matches!(kind, "rgb" | "srgb" | "spectrum" | "uniform" | "blackbody") {
        return Ok(None);
    }
    let number = |key: &str| -> PyResult<Option<f64>> {
        Ok(dict.get_item(key)?.and_then(|value| value.extract::<f64>().ok()))
    };
    if kind == "blackbody" {
        let Some(temperature) = number("temperature")? else {
            return Ok(Some(Err("a \"blackbody\" needs a \"temperature\", in kelvin".into())));
        };
        let scale = number("scale")?.unwrap_or(1.0);
        return Ok(Some(Ok(Value::Spectrum(SpectrumValue::Blackbody { temperature, scale }))));
    }
    if let (Some(file), "spectrum") = (dict.get_item("filename")?, kind) {
        return Ok(Some(
            file.extract().map(|f| Value::Spectrum(SpectrumValue::File(f))).map_err(|e| e.to_string()),
        ));
    }
    let Some(value) = dict.get_item("value")? else {
        return Ok(Some(Err(format!("\"{kind}\" needs a \"value\""))));
    };
    let array = numbers(&value);
    Ok(Some(match (kind, array.as_ref().map(|a| (a.shape(), a))) {
        ("rgb" | "srgb", Some(([], a))) => Ok(Value::Rgb(DVec3::splat(a.sum()))),
        ("rgb" | "srgb", Some(([3], a))) => Ok(Value::Rgb(DVec3::new(a[0], a[1], a[2]))),
        ("spectrum" | "uniform", Some(([], a))) => Ok(uniform(a.sum())),
        ("spectrum", Some(([_, 2], a))) => Ok(Value::Spectrum(SpectrumValue::Samples(
            a.rows().into_iter().map(|row| (row[0], row[1])).collect(),
        ))),
        _ => Err(format!("{} is not the value of \"{kind}\"", shown(&value)?)),
    }))
}

/// An image: (height, width) or (height, width, 1, 3 or 4); bytes stay bytes, all else becomes 32-bit floats.
pub fn image(value: &Bound<'_, PyAny>) -> PyResult<Result<Value, String>> {
    if let Ok(bytes) = value.extract::<numpy::PyReadonlyArrayDyn<'_, u8>>() {
        let array = bytes.as_array();
        let data = array.iter().copied().collect();
        return Ok(sized(array.shape(), |channels| Pixels::U8 { channels, data }));
    }
    // Which number is white is known of bytes and of floating point.
    if let Some(dtype) = value.getattr_opt("dtype")?
        && dtype.getattr("kind")?.extract::<String>()? != "f"
    {
        return Ok(Err(format!("pixels are uint8 or floating point, not {dtype}")));
    }
    let Some(array) = numbers(value) else {
        return Ok(Err(format!("{} is not an array of pixels", shown(value)?)));
    };
    let data = array.iter().map(|&x| x as f32).collect();
    Ok(sized(array.shape(), |channels| Pixels::F32 { channels, data }))
}

fn sized(shape: &[usize], pixels: impl FnOnce(u8) -> Pixels) -> Result<Value, String> {
    let wrong = || format!("an image has shape (height, width) or (height, width, 1, 3 or 4), not {shape:?}");
    let (height, width, channels) = match *shape {
        [height, width] => (height, width, 1),
        [height, width, channels @ (1 | 3 | 4)] => (height, width, channels as u8),
        _ => return Err(wrong()),
    };
    let (Ok(width), Ok(height)) = (u32::try_from(width), u32::try_from(height)) else { return Err(wrong()) };
    if width == 0 || height == 0 {
        return Err(wrong());
    }
    Ok(Value::Image(Arc::new(Image { name: "array".into(), width, height, pixels: pixels(channels) })))
}

/// Reads the arrays of a mesh into a property of `node`.
pub fn mesh(dict: &Bound<'_, PyDict>, node: &mut Node, diagnostics: &mut Diagnostics) -> PyResult<()> {
    match read_mesh(dict)? {
        Ok(mesh) => {
            let value = Value::Mesh(Arc::new(mesh));
            node.properties.push(Property { name: "mesh".into(), value, span: node.span.clone() });
        }
        Err(message) => diagnostics.push(Diagnostic::error("dict::bad-mesh", &node.span, message)),
    }
    Ok(())
}

fn read_mesh(dict: &Bound<'_, PyDict>) -> PyResult<Result<MeshDesc, String>> {
    let mut arrays: [Option<Array2<f64>>; 4] = [const { None }; 4];
    for ((key, columns), array) in MESH_ARRAYS.into_iter().zip([3, 3, 3, 2]).zip(&mut arrays) {
        let Some(value) = dict.get_item(key)?.filter(|value| !value.is_none()) else { continue };
        let grid = numbers(&value).and_then(|a| a.into_dimensionality::<Ix2>().ok());
        match grid.filter(|grid| grid.ncols() == columns) {
            Some(grid) => *array = Some(grid),
            None => return Ok(Err(format!("\"{key}\" has to be an array of shape (n, {columns})"))),
        }
    }
    let [vertices, faces, normals, uvs] = arrays;
    let (Some(vertices), Some(faces)) = (vertices, faces) else {
        return Ok(Err("a mesh needs \"vertices\", (n, 3), and \"faces\", (m, 3)".into()));
    };
    let count = vertices.nrows();
    for (key, array) in [("normals", &normals), ("uvs", &uvs)] {
        if let Some(rows) = array.as_ref().map(Array2::nrows).filter(|&rows| rows != count) {
            return Ok(Err(format!("{rows} \"{key}\" for {count} \"vertices\"")));
        }
    }
    let mut triangles = Vec::with_capacity(faces.nrows());
    for face in faces.rows() {
        for &index in face {
            if !(index >= 0.0 && index < count as f64 && index.fract() == 0.0) {
                return Ok(Err(format!(
                    "\"faces\" has the index {index}; there are vertices 0 to {}",
                    count - 1
                )));
            }
        }
        triangles.push([face[0] as u32, face[1] as u32, face[2] as u32]);
    }
    let triples = |array: Option<Array2<f64>>| -> Vec<Vec3> {
        array.map_or_else(Vec::new, |a| {
            a.rows().into_iter().map(|r| DVec3::new(r[0], r[1], r[2]).as_vec3()).collect()
        })
    };
    let pairs = uvs.map_or_else(Vec::new, |a| {
        a.rows().into_iter().map(|r| Vec2::new(r[0] as f32, r[1] as f32)).collect()
    });
    Ok(Ok(MeshDesc {
        name: "mesh".into(),
        positions: triples(Some(vertices)),
        normals: triples(normals),
        uvs: pairs,
        triangles,
        ..MeshDesc::default()
    }))
}
