//! Scene files that other people made. They are not part of the project: they lie in `../shared/scenes` beside
//! it, or where `STERADIAN_SCENES` says. Without them these tests fail under CI, and say that they did not run
//! elsewhere.

use std::path::{Path, PathBuf};

use sr_import::{LoadOptions, load};
use sr_scene::{Geometry, SceneDesc, Severity};

fn scenes() -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    let folder = std::env::var_os("STERADIAN_SCENES").map_or(default, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var_os("CI").is_none(), "no scenes in {}: set STERADIAN_SCENES", folder.display());
    eprintln!("not run: no scenes in {}", folder.display());
    None
}

fn triangles(scene: &SceneDesc) -> usize {
    let count = |shape: &sr_scene::ShapeDesc| match &shape.geometry {
        Geometry::Mesh(mesh) => mesh.triangles.len(),
        _ => 0,
    };
    scene.shapes.iter().map(count).sum()
}

const ZERO_AREA: &str = "scene::degenerate-triangles";

/// Name, shapes, triangles, lights without a shape, longest path, warnings by code.
type Expected = (&'static str, usize, usize, usize, Option<u32>, &'static [&'static str]);

const SIX: [Expected; 6] = [
    ("cornell-box", 8, 36, 0, Some(30), &[]),
    ("veach-mis", 9, 52, 0, Some(2), &[]),
    ("veach-bidir", 14, 11544, 0, Some(7), &[]),
    ("veach-ajar", 22, 382628, 0, Some(13), &[ZERO_AREA]),
    ("living-room", 65, 142973, 1, Some(65), &[ZERO_AREA]),
    ("staircase", 755, 262508, 0, Some(65), &[ZERO_AREA]),
];

#[test]
fn the_six_scenes_load() {
    let Some(folder) = scenes() else { return };
    for (name, shapes, count, lights, depth, codes) in SIX {
        let (scene, diagnostics) = load(&folder.join(name).join("scene.xml"), &LoadOptions::default());
        let found: Vec<&str> = diagnostics.list.iter().map(|d| d.code).collect();
        assert_eq!(found, codes, "{name}\n{}", diagnostics.render(false));
        let scene = scene.expect("a scene without errors");
        eprintln!(
            "{name}: {} shapes, {} triangles, depth {:?}",
            scene.shapes.len(),
            triangles(&scene),
            scene.settings.max_depth
        );
        assert_eq!(
            (scene.shapes.len(), triangles(&scene), scene.lights.len()),
            (shapes, count, lights),
            "{name}"
        );
        assert_eq!(scene.settings.max_depth, depth, "{name}");
    }
}

/// Files of Mitsuba's suite that do not load, the code of their first error, and why that is right.
const NOT_SCENES: [(&str, &str, &str); 14] = [
    ("docs/scenes/bsdf_hair_blonde.xml", "file::bad-curves", "material_hair.m3hair is not in the suite"),
    ("docs/scenes/bsdf_hair_brown.xml", "file::bad-curves", "material_hair.m3hair is not in the suite"),
    ("docs/scenes/include/matpreview.xml", UNRESOLVED, "a part: it shows the BSDF of who includes it"),
    ("docs/scenes/include/matpreview_no_rr.xml", UNRESOLVED, "a part: it shows the BSDF of who includes it"),
    ("docs/scenes/include/matpreview_stokes.xml", UNRESOLVED, "a part: it shows the BSDF of who includes it"),
    ("docs/scenes/include/sampler_scene.xml", UNRESOLVED, "a part: it has the sampler of who includes it"),
    (
        "docs/scenes/principled_blend_creation/scene_light.xml",
        "file::bad-image",
        "studio.exr is not in the suite",
    ),
    (
        "docs/scenes/principled_blend_creation/scene_studio.xml",
        "file::bad-image",
        "studio.exr is not in the suite",
    ),
    (
        "docs/scenes/sensor_orthographic_2.xml",
        "file::bad-mesh",
        "meshes/cbox/cbox_*.obj are called otherwise there",
    ),
    ("scenes/cbox/fragments/shapes.xml", UNRESOLVED, "a part: it has the materials of who includes it"),
    ("scenes/matpreview/matpreview.xml", "file::bad-image", "envmap.exr is not in the suite"),
    (
        "tests/participating_media/include/test-scene-base-no-bg.xml",
        "mitsuba::undefined-parameter",
        "a part: who includes it says which integrator",
    ),
    (
        "tests/participating_media/include/test-scene-base.xml",
        "mitsuba::undefined-parameter",
        "a part: who includes it says which integrator",
    ),
    (
        "tests/various_shapes/test_various_shapes_path.xml",
        "file::bad-mesh",
        "rectangle_normals_uv.{obj,ply,serialized} are not in the suite",
    ),
];

const UNRESOLVED: &str = "mitsuba::unresolved-reference";

#[test]
fn the_suite_of_mitsuba_loads_but_for_parts_and_what_is_missing() {
    let Some(folder) = scenes() else { return };
    let folder = folder.join("mitsuba-suite");
    let mut files = Vec::new();
    collect(&folder, "xml", &mut files);
    assert!(files.len() > 130, "only {} files: no evidence", files.len());
    let search_paths = ["common", "docs/scenes", "tests/participating_media"].map(|part| folder.join(part));
    let mut failed = Vec::new();
    for file in &files {
        let asks_for_spp = std::fs::read_to_string(file).expect("a readable file").contains("$spp");
        let defines = if asks_for_spp { vec![("spp".to_owned(), "4".to_owned())] } else { Vec::new() };
        let (scene, diagnostics) = load(
            file,
            &LoadOptions { defines, search_paths: search_paths.to_vec(), ..LoadOptions::default() },
        );
        assert_eq!(scene.is_none(), diagnostics.has_errors(), "{}", file.display());
        assert!(!diagnostics.render(true).is_empty() || diagnostics.list.is_empty());
        if scene.is_none() {
            let first = diagnostics.list.iter().find(|d| d.severity == Severity::Error).expect("an error");
            let name = file.strip_prefix(&folder).expect("in the folder").display().to_string();
            failed.push((name, first.code));
        }
    }
    failed.sort();
    let expected: Vec<_> = NOT_SCENES.iter().map(|&(name, code, _)| (name.to_owned(), code)).collect();
    assert_eq!(failed, expected);
}

/// Name, shapes, triangles, lights without a shape, longest path, warnings by code.
const PBRT: [Expected; 21] = [
    ("living-room/scene", 65, 142973, 1, Some(66), &[ZERO_AREA]),
    ("cornell-box/scene", 8, 36, 0, Some(66), &[]),
    ("coffee/scene", 23, 235047, 0, Some(18), &[ZERO_AREA]),
    ("staircase/scene", 755, 262508, 0, Some(66), &[ZERO_AREA]),
    ("killeroos/killeroo-simple", 5, 66532, 0, Some(6), &[]),
    ("killeroos/killeroo-moving", 5, 66532, 0, Some(6), &["pbrt::motion"]),
    ("killeroos/killeroo-coated-gold", 5, 532230, 1, Some(6), &[]),
    ("killeroos/killeroo-gold", 5, 532230, 1, Some(6), &[]),
    ("killeroos/geometry/killeroo", 1, 33264, 0, Some(6), &["scene::no-camera"]),
    ("veach-ajar/scene", 22, 382628, 0, Some(14), &[ZERO_AREA]),
    ("veach-mis/scene", 9, 52, 0, Some(4), &[]),
    ("veach-mis-pbrt/veach-mis-colorized", 10, 12, 0, Some(6), &[]),
    ("veach-mis-pbrt/veach-mis", 10, 12, 0, Some(6), &[]),
    ("veach-bidir/scene", 14, 11544, 0, Some(8), &[]),
    ("cornell-box-variants/smallpt", 8, 10, 0, Some(6), &[]),
    ("cornell-box-variants/cornell-box-silver", 8, 32, 0, Some(6), &[]),
    ("cornell-box-variants/cornell-box-specular", 8, 22, 0, Some(6), &[]),
    ("cornell-box-variants/cornell-box", 8, 32, 0, Some(6), &[]),
    ("cornell-box-variants/cornell-box-volume", 8, 32, 0, Some(21), &["pbrt::unsupported-medium"]),
    ("cornell-box-variants/volumetric-caustic", 7, 12, 0, Some(11), &["pbrt::unsupported-medium"]),
    ("volumetric-caustic/scene", 8, 14, 0, Some(8), &["pbrt::unsupported-medium"]),
];

#[test]
fn the_scenes_of_pbrt_load() {
    let Some(folder) = scenes() else { return };
    for (name, shapes, count, lights, depth, codes) in PBRT {
        let (scene, diagnostics) = load(&folder.join(format!("{name}.pbrt")), &LoadOptions::default());
        let wrong = diagnostics.list.iter().filter(|d| d.severity > Severity::Note);
        let found: Vec<&str> = wrong.map(|d| d.code).collect();
        assert_eq!(found, codes, "{name}\n{}", diagnostics.render(false));
        let scene = scene.expect("a scene without errors");
        assert_eq!(
            (scene.shapes.len(), triangles(&scene), scene.lights.len()),
            (shapes, count, lights),
            "{name}"
        );
        assert_eq!(scene.settings.max_depth, depth, "{name}");
    }
    let mut files = Vec::new();
    collect(&folder, "pbrt", &mut files);
    assert!(files.len() > 20, "only {} files: no evidence", files.len());
    for file in files {
        let (scene, diagnostics) = load(&file, &LoadOptions::default());
        assert!(scene.is_some(), "{}\n{}", file.display(), diagnostics.render(false));
    }
}

fn collect(folder: &Path, extension: &str, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a readable folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, extension, files);
        } else if path.extension().is_some_and(|e| e == extension) {
            files.push(path);
        }
    }
}
