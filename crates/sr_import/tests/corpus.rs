//! What fuzzing has found worth keeping (`fuzz/run.py`): each file is answered, soon, and never by a panic.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use sr_import::{LoadOptions, load};

/// Far above what any takes, below what a hang does.
const SOON: Duration = Duration::from_secs(10);

/// The files kept for a format, each under a name that importers take for that format.
fn files(format: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(format);
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() > 10, "{format}: {} files", files.len());
    files
}

fn answer(format: &str, name: impl Fn(&[u8]) -> &'static str) {
    answer_written(format, |bytes, folder| {
        let path = folder.join(name(bytes));
        std::fs::write(&path, bytes).unwrap();
        path
    });
}

/// `write` puts a case into a folder; the path is that of the scene.
fn answer_written(format: &str, write: impl Fn(&[u8], &Path) -> PathBuf) {
    let folder = std::env::temp_dir().join(format!("sr_import_corpus_{format}_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for file in files(format) {
        let path = write(&std::fs::read(&file).unwrap(), &folder);
        let began = Instant::now();
        let (scene, diagnostics) = load(&path, &LoadOptions::default());
        assert!(began.elapsed() < SOON, "{}", file.display());
        assert_eq!(scene.is_none(), diagnostics.has_errors(), "{}", file.display());
        diagnostics.render(true);
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn mitsuba() {
    answer("mitsuba", |_| "scene.xml");
}

#[test]
fn pbrt() {
    answer("pbrt", |_| "scene.pbrt");
}

#[test]
fn gltf() {
    answer("gltf", |bytes| if bytes.starts_with(b"glTF") { "scene.glb" } else { "scene.gltf" });
}

#[test]
fn ply() {
    answer("ply", |_| "mesh.ply");
}

#[test]
fn obj() {
    // As `fuzz_targets/obj.rs` has it: materials follow the first zero byte.
    answer_written("obj", |bytes, folder| {
        let mut parts = bytes.splitn(2, |&byte| byte == 0);
        let [mesh, materials] = [(); 2].map(|()| parts.next().unwrap_or_default());
        std::fs::write(folder.join("a.mtl"), materials).unwrap();
        let path = folder.join("mesh.obj");
        std::fs::write(&path, mesh).unwrap();
        path
    });
}

#[test]
fn stl() {
    answer("stl", |_| "mesh.stl");
}

/// Files that scenes name, as `fuzz_targets/referenced.rs` has them.
#[test]
fn referenced() {
    const SCENES: [(&str, &str); 5] = [
        (
            "it.serialized",
            r#"<shape type="serialized"><string name="filename" value="it.serialized"/></shape>"#,
        ),
        ("it.ies", r#"<emitter type="ies"><string name="filename" value="it.ies"/></emitter>"#),
        ("it.pfm", r#"<emitter type="envmap"><string name="filename" value="it.pfm"/></emitter>"#),
        (
            "it.spd",
            r#"<shape type="sphere"><emitter type="area"><spectrum name="radiance" filename="it.spd"/></emitter></shape>"#,
        ),
        ("it.txt", r#"<shape type="bsplinecurve"><string name="filename" value="it.txt"/></shape>"#),
    ];
    answer_written("referenced", |bytes, folder| {
        let (which, bytes) = bytes.split_first().unwrap_or((&0, &[]));
        let (name, used) = SCENES[usize::from(*which) % SCENES.len()];
        std::fs::write(folder.join(name), bytes).unwrap();
        let scene = format!(r#"<scene version="3.0.0"><sensor type="perspective"/>{used}</scene>"#);
        let path = folder.join("scene.xml");
        std::fs::write(&path, scene).unwrap();
        path
    });
}
