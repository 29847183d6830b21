//! Mitsuba XML (0.5, 0.6, 2.x and 3.x), and the same as trees that Python made of a dict.
//!
//! - `xml`: text to nodes: includes, references' names, `$parameters`. Decides no meaning.
//! - `lower`: nodes to the description: plugins, defaults, units. Knows no XML.

mod attributes;
mod lower;
pub mod node;
pub mod plugins;
mod props;
mod tables;
mod transform;
mod xml;

use sr_scene::{Diagnostics, SceneDesc};

use crate::LoadOptions;
use crate::files::Directories;
pub use lower::{Origin, lower};

/// Loads a scene from text. Files are looked for in `directories`; the options' `defines` override the text's
/// `<default>`s.
pub fn load(
    name: &str,
    text: &str,
    directories: Directories,
    options: &LoadOptions,
    diagnostics: &mut Diagnostics,
) -> Option<SceneDesc> {
    let scene = xml::read(name, text, directories, options, diagnostics)?;
    let origin = Origin {
        legacy: scene.legacy,
        directories: scene.directories.into_list(),
        environment: options.environment.clone(),
        limits: options.limits,
    };
    lower(&scene.root, &origin, diagnostics)
}
