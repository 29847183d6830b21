//! glTF 2.0: `.gltf` and `.glb`.
//!
//! - `json`, `container`: a file to values with places, and bytes. Decide no meaning.
//! - `document`: indices followed, values of the wrong kind said, buffers read once.
//! - `accessor`: numbers out of buffers. `draco`, `meshopt`: the same out of packed streams. `geometry`: a primitive's triangles; `morph`, `skin`: as they stand at time 0.
//! - `image`, `texture`, `material`: what surfaces look like; `variant`: which of them. `camera`, `light`, `environment`, `node`: where everything stands.
//! - `extensions`: which of them are done, and what is said about the others. `properties`: those that glTF does not know.

mod accessor;
mod camera;
mod container;
mod document;
mod draco;
mod environment;
pub mod extensions;
mod geometry;
mod image;
mod json;
mod light;
mod material;
mod meshopt;
mod morph;
mod node;
mod properties;
mod skin;
mod specular_glossiness;
mod texture;
pub mod variant;

use std::path::PathBuf;

use sr_scene::{Diagnostic, Diagnostics, SceneDesc, Span};

use crate::LoadOptions;
use crate::assembly::Assembly;
use document::Document;

/// The version that a file needs, if it is not 2; one that says none may be anything.
fn other_version(root: &json::Value) -> Option<&str> {
    let asset = root.get("asset")?;
    let version = asset.get("minVersion").or(asset.get("version"))?.text()?;
    (version != "2" && !version.starts_with("2.")).then_some(version)
}

/// Loads a scene from the bytes of a file. `name` is what messages call it.
pub fn load(
    name: &str,
    bytes: Vec<u8>,
    directories: Vec<PathBuf>,
    options: &LoadOptions,
    d: &mut Diagnostics,
) -> Option<SceneDesc> {
    let limits = options.limits;
    let container = match container::read(bytes, limits.scene_bytes) {
        Ok(container) => container,
        Err(reason) => {
            let source = d.sources.add(name, "");
            let message = format!("cannot read the scene {name}: {reason}");
            d.push(Diagnostic::error("scene::cannot-read", &Span { source, bytes: 0..0 }, message));
            return None;
        }
    };
    let source = d.sources.add(name, container.json.as_str());
    let root = match json::parse(&container.json, source, limits.gltf_values) {
        Ok(root) => root,
        Err((at, reason)) => {
            let span = Span { source, bytes: at..(at + 1).min(container.json.len()) };
            d.push(Diagnostic::error("gltf::syntax", &span, format!("this is no JSON: {reason}")));
            return None;
        }
    };
    drop(container.json);
    let span = Span { source, bytes: 0..0 };
    if let Some(version) = other_version(&root) {
        let message = format!("it is of version {version} of glTF; version 2 is read");
        d.push(Diagnostic::error("gltf::version", &span, message));
        return None;
    }
    let mut document = Document::new(&root, container.binary, Assembly::new(directories, limits, d));
    document.out.environment.clone_from(&options.environment);
    document.choose_variant(options.variant.as_deref(), &span);
    extensions::report(&root, document.out.d);
    properties::report(&root, document.out.d);
    document.scene();
    document.out.view_from = crate::assembly::FRONT_ABOVE;
    // Surfaces that glow no brighter than white are labels and lamps' covers, made to be seen under a sky.
    let strong = document.strong_emission;
    document.out.light_if_dark(strong, &span);
    document.out.finish(&span)
}
