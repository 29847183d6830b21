//! What all targets do: a file of these bytes is loaded, and what is said about it is rendered.

use std::path::Path;

use sr_import::LoadOptions;

/// Loads `name` in a folder of its own, in which `others` lie as well.
///
/// # Panics
/// If the importer does, or breaks its promise: a scene exactly where there is no error.
pub fn load(name: &str, bytes: &[u8], others: &[(&str, &[u8])]) {
    thread_local! {
        static FOLDER: tempfile::TempDir = tempfile::tempdir().expect("a folder for files");
    }
    FOLDER.with(|folder| {
        for (name, bytes) in others.iter().chain([&(name, bytes)]) {
            std::fs::write(folder.path().join(name), bytes).expect("a file in it");
        }
        check(&folder.path().join(name));
    });
}

fn check(path: &Path) {
    let mut options = LoadOptions::default();
    // A million faces, which are loaded in a second, take these builds, with all their checks, twenty times as long.
    options.limits.set("subdivided_faces", 1 << 16).expect("a limit of this name");
    let (scene, diagnostics) = sr_import::load(path, &options);
    assert_eq!(scene.is_none(), diagnostics.has_errors(), "{}", diagnostics.render(false));
    diagnostics.render(true);
}
