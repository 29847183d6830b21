//! Converting as a job: a file or a dictionary in, files of another format and diagnostics out.

use std::path::{Path, PathBuf};
use std::time::Instant;

use pyo3::exceptions::{PyFileExistsError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sr_export::{Target, WriteError};
use sr_import::{LoadOptions, Origin};
use sr_scene::{Diagnostics, SceneDesc};

use crate::job::Job;
use crate::limits::{self, Named};
use crate::load::{Fields, fields};
use crate::{node, output};

/// A scene being converted.
#[pyclass(frozen, module = "steradian._internal")]
pub struct ConvertJob(Job<Converted>);

struct Converted {
    /// Those written, the scene last; `None` if there was none.
    files: Option<Vec<PathBuf>>,
    diagnostics: Diagnostics,
    seconds: f64,
}

/// The files, the diagnostics, their text for people, and the seconds that it took.
type Outcome<'py> = (Option<Vec<PathBuf>>, Vec<Fields<'py>>, String, f64);

#[pymethods]
impl ConvertJob {
    /// Waits at most `seconds`; is it done?
    fn wait(&self, py: Python<'_>, seconds: f64) -> PyResult<bool> {
        self.0.wait(py, seconds)
    }

    /// The files if there was a scene, the diagnostics, their text for people, and the seconds that it took. Once.
    fn result<'py>(&self, py: Python<'py>, color: bool) -> PyResult<Outcome<'py>> {
        let Converted { files, diagnostics, seconds } = self.0.take()?;
        let list = diagnostics.list.iter().map(|d| fields(py, d, &diagnostics)).collect::<PyResult<_>>()?;
        Ok((files, list, diagnostics.render(color), seconds))
    }
}

/// Where to, and how.
struct Request {
    out: PathBuf,
    own_plugins: bool,
    overwrite: bool,
}

/// Starts to convert a file; `defines` override the file's own defaults; `variant` is one of the file's sets of
/// materials; `threads` of 0 are all.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn convert_file(
    path: PathBuf,
    defines: Vec<(String, String)>,
    search_paths: Vec<PathBuf>,
    variant: Option<String>,
    limits: Named,
    out: PathBuf,
    own_plugins: bool,
    overwrite: bool,
    threads: usize,
) -> PyResult<ConvertJob> {
    target_of(&out)?;
    let request = Request { out, own_plugins, overwrite };
    let options =
        LoadOptions { defines, search_paths, environment: None, variant, limits: limits::limits(limits)? };
    let job = Job::start(threads, move || {
        let start = Instant::now();
        let (scene, diagnostics) = sr_import::load(&path, &options);
        written(scene, diagnostics, &request, start)
    })?;
    Ok(ConvertJob(job))
}

/// Starts to convert a dictionary; files that it names are looked for in the current folder, then in `search_paths`.
#[pyfunction]
pub fn convert_dict(
    dict: &Bound<'_, PyDict>,
    search_paths: Vec<PathBuf>,
    limits: Named,
    out: PathBuf,
    own_plugins: bool,
    overwrite: bool,
    threads: usize,
) -> PyResult<ConvertJob> {
    target_of(&out)?;
    let start = Instant::now();
    let (node, mut diagnostics) = node::from_dict(dict)?;
    let directories = std::iter::once(PathBuf::new()).chain(search_paths).collect();
    let origin = Origin { legacy: false, directories, environment: None, limits: limits::limits(limits)? };
    let request = Request { out, own_plugins, overwrite };
    let job = Job::start(threads, move || {
        let scene = match diagnostics.has_errors() {
            true => None,
            false => sr_import::from_node(&node, &origin, &mut diagnostics),
        };
        written(scene, diagnostics, &request, start)
    })?;
    Ok(ConvertJob(job))
}

/// Raises ValueError unless the name's extension is that of a format.
#[pyfunction]
pub fn check_target(path: PathBuf) -> PyResult<()> {
    target_of(&path).map(drop)
}

fn target_of(path: &Path) -> PyResult<Target> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    Target::of_extension(extension).ok_or_else(|| {
        PyValueError::new_err(format!(
            "cannot tell the format of {}: the name must end in .xml, .pbrt, .gltf or .glb",
            path.display()
        ))
    })
}

fn written(
    scene: Option<SceneDesc>,
    mut diagnostics: Diagnostics,
    request: &Request,
    start: Instant,
) -> PyResult<Converted> {
    let Request { out, own_plugins, overwrite } = request;
    let target = match target_of(out)? {
        Target::Mitsuba { .. } => Target::Mitsuba { own_plugins: *own_plugins },
        other => other,
    };
    let name = out.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| PyValueError::new_err(format!("{} is no name", out.display())))?;
    let folder = out.parent().unwrap_or(Path::new(""));
    let files = match scene {
        None => None,
        Some(scene) => {
            let sources = (0..diagnostics.sources.len())
                .map(|index| diagnostics.sources.get(sr_scene::SourceId(index as u32)).0);
            let mut inputs: Vec<PathBuf> = sources.map(PathBuf::from).collect();
            inputs.extend(sr_export::inputs(&scene));
            let export = sr_export::export(&scene, target, name);
            diagnostics.list.extend(export.diagnostics);
            let paths = sr_export::write_files(&export.files, folder, &inputs, *overwrite);
            Some(paths.map_err(write_error)?)
        }
    };
    Ok(Converted { files, diagnostics, seconds: start.elapsed().as_secs_f64() })
}

fn write_error(error: WriteError) -> PyErr {
    match error {
        WriteError::Output(error) => output::output_error(error),
        WriteError::Exists { .. } => PyFileExistsError::new_err(error.to_string()),
        WriteError::Input { .. } => PyValueError::new_err(error.to_string()),
        WriteError::Folder { .. } => PyOSError::new_err(error.to_string()),
    }
}
