//! Scene descriptions to the files of other renderers.
//!
//! In: a validated [`SceneDesc`]. Out: an [`Export`]: files by name, each of which can be written, and what they do not
//! say as the description does. They are written by [`write_files`].
//!
//! - `mitsuba`, `pbrt`, `gltf`: one folder for each format.
//! - `output`, `ply`, `pictures`: the files. `notes`: what there is to say.
//! - `bake`, `directions`: textures and lights as images. `tessellate`: shapes as triangles. `curves`: curves as text. `surfaces`: what several
//!   formats ask of materials.
//!
//! Invariant: what a format cannot say is never dropped without a diagnostic.

mod bake;
mod curves;
mod directions;
mod gltf;
mod mitsuba;
mod notes;
mod output;
mod pbrt;
mod pictures;
mod ply;
mod surfaces;
mod tessellate;
mod write;

use std::collections::HashSet;
use std::path::PathBuf;

use sr_scene::{Diagnostic, Geometry, SceneDesc, Span};

pub use output::{Content, OutputFile};
pub use write::{WriteError, write_files};

/// A format to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Mitsuba 3 XML.
    Mitsuba {
        /// May it name plugins that Steradian alone has? Mitsuba does not read such a file.
        own_plugins: bool,
    },
    /// pbrt-v4.
    Pbrt,
    /// glTF 2.0, its buffer and its images beside it.
    Gltf,
    /// glTF 2.0 in one file.
    Glb,
}

impl Target {
    /// The format that the extension of a file's name asks for.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "xml" => Some(Self::Mitsuba { own_plugins: false }),
            "pbrt" => Some(Self::Pbrt),
            "gltf" => Some(Self::Gltf),
            "glb" => Some(Self::Glb),
            _ => None,
        }
    }
}

/// A scene in another format.
#[derive(Debug)]
pub struct Export {
    /// All files; the scene itself is the last one.
    pub files: Vec<OutputFile>,
    /// What is not said as the description has it.
    pub diagnostics: Vec<Diagnostic>,
}

/// The files of a scene. `name` is that of the scene's own file; the others are in a folder of that name without its
/// extension.
pub fn export(scene: &SceneDesc, target: Target, name: &str) -> Export {
    let mut export = match target {
        Target::Mitsuba { own_plugins } => mitsuba::export(scene, own_plugins, name),
        Target::Pbrt => pbrt::export(scene, name),
        Target::Gltf => gltf::export(scene, name, false),
        Target::Glb => gltf::export(scene, name, true),
    };
    if scene.variants.len() > 1 {
        let message = format!("the scene has {} variants of its materials", scene.variants.len());
        let note = Diagnostic::warning("convert::variants", &Span::default(), message);
        export.diagnostics.push(note.consequence("the one that is shown is written"));
    }
    export
}

/// The files that the meshes and images of a scene were read from, if they have names of files.
pub fn inputs(scene: &SceneDesc) -> Vec<PathBuf> {
    let in_groups = scene.groups.iter().flat_map(|group| &group.shapes);
    let meshes = scene.shapes.iter().chain(in_groups).filter_map(|shape| match &shape.geometry {
        Geometry::Mesh(mesh) => Some(mesh.name.as_str()),
        Geometry::Curves(curves) => Some(curves.name.as_str()),
        _ => None,
    });
    let names: HashSet<&str> = meshes.chain(scene.images.iter().map(|image| image.name.as_str())).collect();
    names.into_iter().map(PathBuf::from).collect()
}
