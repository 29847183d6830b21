//! Scene files of other renderers to scene descriptions.
//!
//! In: Mitsuba XML (0.5, 0.6, 2.x and 3.x), pbrt-v4 files, glTF 2.0 (.gltf and .glb), OBJ, PLY, STL, or a tree of [`Node`]s that Python made of a dict. Out: a
//! [`SceneDesc`] and [`Diagnostics`]. The description is there exactly if no diagnostic is an error.
//!
//! - `mitsuba`, `pbrt`, `gltf`: one folder for each format: text to the calls of an `Assembly`. `format`: which one it is.
//! - `mesh_file`: a mesh as a scene of its own.
//! - `assembly`: what all formats share: a description as it grows.
//! - `mesh`, `curves`, `images`, `jpeg`, `ies`: the files that scenes name, read in parallel, each once.
//!
//! Invariant: no input makes this crate panic, loop for ever or use memory without bound; and nothing a file
//! asks for is dropped without a diagnostic.

mod assembly;
mod color_space;
mod curves;
mod files;
mod format;
mod gltf;
mod ies;
mod images;
mod jpeg;
mod limits;
mod look_at;
mod mesh;
mod mesh_file;
mod mitsuba;
mod pbrt;
mod pfm;
mod support;
mod values;

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use sr_scene::{Diagnostic, Diagnostics, SceneDesc, Span};

pub use limits::{Limit, Limits};
pub use mitsuba::Origin;
pub use mitsuba::node::{Child, Node, OtherName, Property, Reference, SpectrumValue, Value};
pub use mitsuba::plugins;
pub use mitsuba::plugins::table as mitsuba_support_table;
pub use pbrt::support_table as pbrt_support_table;

/// How to load a scene file.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Values of `$name` parameters; they override the file's `<default>`s.
    pub defines: Vec<(String, String)>,
    /// Where files are looked for that are neither beside the scene nor where it says, in this order.
    pub search_paths: Vec<PathBuf>,
    /// An image of latitude and longitude, +Y up, that is put around the scene.
    pub environment: Option<PathBuf>,
    /// Which of the file's variants of materials is shown; that which the file shows by itself, if none is named.
    pub variant: Option<String>,
    /// How much is taken in.
    pub limits: Limits,
}

/// Loads a scene file.
pub fn load(path: &Path, options: &LoadOptions) -> (Option<SceneDesc>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let name = path.display().to_string();
    if let Some(kind) = mesh_file::Kind::of(path) {
        let scene = mesh_file::load(path, kind, options, &mut diagnostics);
        return (only_with_variant(scene, options, &mut diagnostics), diagnostics);
    }
    let directory = path.parent().unwrap_or(Path::new("")).to_owned();
    let directories = files::Directories::new(directory, &options.search_paths);
    let limits = &options.limits;
    let loaded = match format::Format::of_name(&name) {
        format::Format::Pbrt => pbrt::Text::read(path, limits.scene_bytes)
            .map(|text| pbrt::load(&name, text, directories.into_list(), options, &mut diagnostics)),
        format::Format::Mitsuba => files::read_text(path, limits.scene_bytes).map(|text| {
            load_content(&name, text.into_bytes().into(), directories, options, &mut diagnostics)
        }),
        format::Format::Gltf => files::read(path, limits.file_bytes)
            .map(|bytes| gltf::load(&name, bytes, directories.into_list(), options, &mut diagnostics)),
    };
    match loaded {
        Ok(scene) => (only_with_variant(scene, options, &mut diagnostics), diagnostics),
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
    let directories = files::Directories::new(directory.to_owned(), &options.search_paths);
    let scene = load_content(name, text.as_bytes().into(), directories, options, &mut diagnostics);
    (only_with_variant(scene, options, &mut diagnostics), diagnostics)
}

/// A scene of a format that knows no variants is an error where one is asked for.
fn only_with_variant(
    scene: Option<SceneDesc>,
    options: &LoadOptions,
    diagnostics: &mut Diagnostics,
) -> Option<SceneDesc> {
    match (&scene, &options.variant) {
        (Some(found), Some(variant)) if found.variants.is_empty() => {
            diagnostics.push(gltf::variant::unknown(variant, &[], &Span::default()));
            None
        }
        _ => scene,
    }
}

/// Lowers a tree that was not read from XML. `diagnostics` holds the sources that its spans point into.
pub fn from_node(root: &Node, origin: &Origin, diagnostics: &mut Diagnostics) -> Option<SceneDesc> {
    mitsuba::lower(root, origin, diagnostics)
}

/// The extensions of glTF, and what becomes of each: "done", "approximated: …" or "reported: …".
pub fn gltf_extensions() -> Vec<(&'static str, String)> {
    gltf::extensions::EXTENSIONS.iter().map(|(name, support)| (*name, support.to_string())).collect()
}

fn load_content(
    name: &str,
    content: Cow<'_, [u8]>,
    directories: files::Directories,
    options: &LoadOptions,
    diagnostics: &mut Diagnostics,
) -> Option<SceneDesc> {
    if format::Format::of_name(name) == format::Format::Gltf {
        return gltf::load(name, content.into_owned(), directories.into_list(), options, diagnostics);
    }
    // Text that is UTF-8 already is not copied.
    let text = match content {
        Cow::Borrowed(bytes) => String::from_utf8_lossy(bytes),
        Cow::Owned(bytes) => String::from_utf8(bytes)
            .unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned())
            .into(),
    };
    match format::Format::of_text(name, &text) {
        format::Format::Mitsuba => mitsuba::load(name, &text, directories, options, diagnostics),
        format::Format::Pbrt => {
            let text = pbrt::Text::of(text.into_owned());
            pbrt::load(name, text, directories.into_list(), options, diagnostics)
        }
        format::Format::Gltf => {
            let bytes = text.into_owned().into_bytes();
            gltf::load(name, bytes, directories.into_list(), options, diagnostics)
        }
    }
}
