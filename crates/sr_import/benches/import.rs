//! How long a file takes to be read, and in how much memory: `cargo bench -p sr_import --bench import -- FILE …`.
//!
//! For each file: seconds, the fastest of three; megabytes of the arrays that it ends in; the most memory that the first
//! reading took beyond what the process had before (Linux), over these arrays.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use sr_import::{LoadOptions, load};
use sr_scene::{Geometry, MeshDesc, SceneDesc};

const MEGABYTE: f64 = 1e6;

fn main() {
    for name in std::env::args().skip(1).filter(|arg| !arg.starts_with('-')) {
        let before = most_memory();
        let (scene, diagnostics) = load(Path::new(&name), &LoadOptions::default());
        let after = most_memory();
        let Some(scene) = scene else {
            let _ = writeln!(std::io::stderr(), "{}", diagnostics.render(false));
            continue;
        };
        let arrays = bytes_of(&scene);
        drop(scene);
        let seconds = (0..3).map(|_| {
            let began = Instant::now();
            let _ = load(Path::new(&name), &LoadOptions::default());
            began.elapsed().as_secs_f64()
        });
        let fastest = seconds.fold(f64::INFINITY, f64::min);
        let mut out = std::io::stdout();
        // A broken pipe is the reader's wish.
        let _ = writeln!(out, "{name}: {fastest:.2} s, arrays of {:.0} MB", arrays / MEGABYTE);
        if let (Some(before), Some(after)) = (before, after) {
            let taken = after - before;
            let _ =
                writeln!(out, "  at most {:.0} MB, {:.2} of the arrays", taken / MEGABYTE, taken / arrays);
        }
    }
}

fn bytes_of(scene: &SceneDesc) -> f64 {
    let size = |mesh: &MeshDesc| {
        size_of_val(&mesh.positions[..])
            + size_of_val(&mesh.normals[..])
            + size_of_val(&mesh.uvs[..])
            + size_of_val(&mesh.vertex_colors[..])
            + size_of_val(&mesh.face_colors[..])
            + size_of_val(&mesh.triangles[..])
    };
    let shapes = scene.shapes.iter().chain(scene.groups.iter().flat_map(|group| &group.shapes));
    let meshes = shapes.filter_map(|shape| match &shape.geometry {
        Geometry::Mesh(mesh) => Some(size(mesh)),
        _ => None,
    });
    meshes.sum::<usize>() as f64
}

/// The most memory that the process has had, in bytes.
fn most_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().trim_end_matches(" kB").parse::<f64>().ok()? * 1024.0)
}
