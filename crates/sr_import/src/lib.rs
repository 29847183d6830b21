//! Scene files of other renderers to scene descriptions.
//!
//! In: Mitsuba XML (0.5, 0.6, 2.x and 3.x), or a tree of [`Node`]s that Python made of a dict. Out: a
//! [`SceneDesc`] and [`Diagnostics`]. The description is there exactly if no diagnostic is an error.
//!
//! - `xml`: text to nodes: includes, references' names, `$parameters`. Decides no meaning.
//! - `lower`: nodes to the description: plugins, defaults, units. Knows no XML.
//! - `mesh`, `images`, `jpeg`, `ies`: the files that scenes name, read in parallel, each once.
//!
//! Invariant: no input makes this crate panic, loop for ever or use memory without bound; and nothing a file
//! asks for is dropped without a diagnostic.

mod files;
mod ies;
mod images;
mod jpeg;
mod lower;
mod mesh;
mod node;
mod pfm;
mod props;
mod spectrum;
mod tables;
mod transform;
mod values;
mod xml;

use std::path::{Path, PathBuf};

use sr_scene::{Diagnostic, Diagnostics, SceneDesc, Span};

pub use lower::Origin;
pub use node::{Child, Node, OtherName, Property, Reference, SpectrumValue, Value};

/// How to load a scene file.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Values of `$name` parameters; they override the file's `<default>`s.
    pub defines: Vec<(String, String)>,
    /// Where files are looked for that are not beside the scene.
    pub search_paths: Vec<PathBuf>,
}

/// Loads a scene file.
pub fn load(path: &Path, options: &LoadOptions) -> (Option<SceneDesc>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let name = path.display().to_string();
    match xml::read_text(path) {
        Ok(text) => {
            let directory = path.parent().unwrap_or(Path::new("")).to_owned();
            let scene = load_text(&name, &text, directory, options, &mut diagnostics);
            (scene, diagnostics)
        }
        Err(reason) => {
            let source = diagnostics.sources.add(name.as_str(), "");
            let message = format!("cannot read the scene {name}: {reason}");
            diagnostics.push(Diagnostic::error("scene::cannot-read", &Span { source, bytes: 0..0 }, message));
            (None, diagnostics)
        }
    }
}

/// Loads a scene from text. `name` is what messages call it; files are looked for in `directory` first.
pub fn load_str(
    name: &str,
    text: &str,
    directory: &Path,
    options: &LoadOptions,
) -> (Option<SceneDesc>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let scene = load_text(name, text, directory.to_owned(), options, &mut diagnostics);
    (scene, diagnostics)
}

/// Lowers a tree that was not read from XML. `diagnostics` holds the sources that its spans point into.
pub fn from_node(root: &Node, origin: &Origin, diagnostics: &mut Diagnostics) -> Option<SceneDesc> {
    lower::lower(root, origin, diagnostics)
}

fn load_text(
    name: &str,
    text: &str,
    directory: PathBuf,
    options: &LoadOptions,
    diagnostics: &mut Diagnostics,
) -> Option<SceneDesc> {
    let directories = std::iter::once(directory).chain(options.search_paths.iter().cloned()).collect();
    let scene = xml::read(name, text, directories, &options.defines, diagnostics)?;
    let origin = Origin { legacy: scene.legacy, directories: scene.directories };
    lower::lower(&scene.root, &origin, diagnostics)
}
