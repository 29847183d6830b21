//! Loading as a job: a file or a dictionary in, a compiled scene and diagnostics out.

use std::path::PathBuf;
use std::time::Instant;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use sr_import::{LoadOptions, Origin};
use sr_render::CompileError;
use sr_scene::{Diagnostic, Diagnostics, Effect, SceneDesc, Span};

use crate::job::Job;
use crate::limits::{self, Named};
use crate::node;
use crate::scene::Scene;

/// A scene being loaded.
#[pyclass(frozen, module = "steradian._internal")]
pub struct LoadJob(Job<Loaded>);

struct Loaded {
    scene: Option<Scene>,
    diagnostics: Diagnostics,
    seconds: f64,
}

/// What a diagnostic says, by name.
pub type Fields<'py> = Bound<'py, PyDict>;

#[pymethods]
impl LoadJob {
    /// Waits at most `seconds`; is it done?
    fn wait(&self, py: Python<'_>, seconds: f64) -> PyResult<bool> {
        self.0.wait(py, seconds)
    }

    /// The scene if there is one, the diagnostics, their text for people, and the seconds that it took. Once.
    fn result<'py>(
        &self,
        py: Python<'py>,
        color: bool,
    ) -> PyResult<(Option<Scene>, Vec<Fields<'py>>, String, f64)> {
        let Loaded { scene, diagnostics, seconds } = self.0.take()?;
        let list = diagnostics.list.iter().map(|d| fields(py, d, &diagnostics)).collect::<PyResult<_>>()?;
        Ok((scene, list, diagnostics.render(color), seconds))
    }
}

/// Starts to load a file; `defines` override the file's own defaults; `environment` is an image to be put around the scene,
/// `variant` one of the file's sets of materials; `threads` of 0 are all.
#[pyfunction]
pub fn load_file(
    path: PathBuf,
    defines: Vec<(String, String)>,
    search_paths: Vec<PathBuf>,
    environment: Option<PathBuf>,
    variant: Option<String>,
    limits: Named,
    threads: usize,
) -> PyResult<LoadJob> {
    let options =
        LoadOptions { defines, search_paths, environment, variant, limits: limits::limits(limits)? };
    let job = Job::start(threads, move || {
        let start = Instant::now();
        let (desc, diagnostics) = sr_import::load(&path, &options);
        Ok(compiled(desc, diagnostics, start))
    })?;
    Ok(LoadJob(job))
}

/// Starts to load a dictionary; files that it names are looked for in the current folder, then in `search_paths`.
#[pyfunction]
pub fn load_dict(
    dict: &Bound<'_, PyDict>,
    search_paths: Vec<PathBuf>,
    environment: Option<PathBuf>,
    limits: Named,
    threads: usize,
) -> PyResult<LoadJob> {
    let start = Instant::now();
    let (node, mut diagnostics) = node::from_dict(dict)?;
    let directories = std::iter::once(PathBuf::new()).chain(search_paths).collect();
    let origin = Origin { legacy: false, directories, environment, limits: limits::limits(limits)? };
    let job = Job::start(threads, move || {
        let desc = match diagnostics.has_errors() {
            true => None,
            false => sr_import::from_node(&node, &origin, &mut diagnostics),
        };
        Ok(compiled(desc, diagnostics, start))
    })?;
    Ok(LoadJob(job))
}

/// Compiles what was imported.
fn compiled(desc: Option<SceneDesc>, mut diagnostics: Diagnostics, start: Instant) -> Loaded {
    let scene = desc.and_then(|desc| match sr_render::Scene::compile(&desc) {
        Ok(scene) => Some(Scene::new(&desc, scene)),
        Err(error) => {
            let span = match &error {
                CompileError::Material(error) => desc.material_span(error.material()),
                CompileError::Geometry(_) => Span::default(),
            };
            diagnostics.push(Diagnostic::error("scene::compile", &span, error.to_string()));
            None
        }
    });
    Loaded { scene, diagnostics, seconds: start.elapsed().as_secs_f64() }
}

/// A diagnostic, by the names of its parts.
pub fn fields<'py>(py: Python<'py>, diagnostic: &Diagnostic, all: &Diagnostics) -> PyResult<Fields<'py>> {
    let Diagnostic { severity, code, message, span, hint, consequence } = diagnostic;
    let has_place = span.bytes.end > 0;
    let (line, column) = if has_place { all.sources.line_column(span) } else { (0, 0) };
    let dict = PyDict::new(py);
    dict.set_item("severity", severity.to_string())?;
    dict.set_item("code", code)?;
    dict.set_item("message", message)?;
    dict.set_item("source", all.sources.get(span.source).0)?;
    dict.set_item("line", line)?;
    dict.set_item("column", column)?;
    dict.set_item("hint", hint)?;
    dict.set_item("consequence", consequence)?;
    let effect = diagnostic.effect().map(|effect| match effect {
        Effect::Approximated => "approximated",
        Effect::Ignored => "ignored",
    });
    dict.set_item("effect", effect)?;
    dict.set_item("text", all.one_line(diagnostic))?;
    Ok(dict)
}
