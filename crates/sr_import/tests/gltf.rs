//! glTF: small files of our own, and the models that others made (see `real_scenes.rs` for where these lie).

use std::fmt::Write;
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use sr_import::{LoadOptions, gltf_extensions, load, load_str};
use sr_scene::{
    ColorInput, Diagnostics, Geometry, LightDesc, MaterialDesc, MeshDesc, Pixels, Projection, Rgb,
    ScalarInput, SceneDesc, Severity, SpotFalloff, TextureDesc,
};

fn read(json: &str) -> (Option<SceneDesc>, Diagnostics) {
    load_str("test.gltf", json, Path::new(""), &LoadOptions::default())
}

fn codes(diagnostics: &Diagnostics) -> Vec<&'static str> {
    diagnostics.list.iter().map(|d| d.code).collect()
}

/// A data URI of bytes.
fn uri(bytes: &[u8]) -> String {
    let mut out = String::from("data:application/octet-stream,");
    bytes.iter().for_each(|b| write!(out, "%{b:02x}").unwrap());
    out
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// A square of four corners in the order of a strip, its coordinates, and what else a test says about the file.
fn square(primitive: &str, node: &str, rest: &str) -> String {
    let mut bytes = floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.]);
    bytes.extend(floats(&[0., 1., 1., 1., 0., 0., 1., 0.]));
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 80, "uri": "{}"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 32}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "mode": 5{primitive}}}]}}],
        "nodes": [{{"mesh": 0{node}}}]{rest}}}"#,
        uri(&bytes)
    )
}

fn mesh(scene: &SceneDesc, shape: usize) -> &MeshDesc {
    let Geometry::Mesh(mesh) = &scene.shapes[shape].geometry else { panic!() };
    mesh
}

const CAMERA: &str = r#", "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 2}}],
    "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 3, "color": [1, 0.5, 0], "range": 7},
        {"type": "directional", "intensity": 2},
        {"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.4}}]}}"#;

#[test]
fn other_versions_are_refused() {
    for (version, is_read) in [("2.0", true), ("2.1", true), ("1.0", false), ("3.0", false)] {
        let (scene, diagnostics) = read(&square("", "", "").replace("2.0", version));
        assert_eq!(scene.is_some(), is_read, "{version}");
        assert!(is_read || codes(&diagnostics) == ["gltf::version"], "{version}: {:?}", codes(&diagnostics));
    }
}

#[test]
fn a_strip_with_a_default_camera_and_light() {
    let (scene, diagnostics) = read(&square("", r#", "translation": [0, 0, 2], "scale": [-2, 1, 1]"#, ""));
    assert_eq!(codes(&diagnostics), ["scene::no-light", "scene::no-camera"]);
    let scene = scene.unwrap();
    let mesh = mesh(&scene, 0);
    assert_eq!(mesh.positions[3], Vec3::new(-2.0, 1.0, 2.0));
    // The front stays the front, whatever the node mirrors; v = 0 is the bottom of the image.
    assert_eq!(mesh.triangles, [[0, 2, 1], [2, 3, 1]]);
    assert_eq!((mesh.uvs[0], mesh.uvs[3]), (Vec2::ZERO, Vec2::ONE));
    assert!(mesh.normals.is_empty());
    assert!(matches!(scene.lights[..], [LightDesc::Environment { .. }]));
}

#[test]
fn cameras_and_lights_look_along_minus_z() {
    let node = r#", "camera": 0, "translation": [1, 2, 3], "children": [1, 2, 3]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}}, {"extensions": {"KHR_lights_punctual": {"light": 1}}},
        {"extensions": {"KHR_lights_punctual": {"light": 2}}"#;
    let (scene, diagnostics) = read(&square("", node, CAMERA));
    assert_eq!(diagnostics.render(false), "");
    let scene = scene.unwrap();
    let camera = &scene.camera;
    assert_eq!(camera.world_from_camera.transform_vector3(Vec3::Z), Vec3::NEG_Z);
    assert_eq!(camera.world_from_camera.transform_vector3(Vec3::X), Vec3::NEG_X);
    assert_eq!(camera.world_from_camera.transform_point3(Vec3::ZERO), Vec3::new(1.0, 2.0, 3.0));
    assert!(matches!(camera.projection, Projection::Perspective { fov: 0.5, .. }));
    assert_eq!(camera.film.width, 2 * camera.film.height);
    let [
        LightDesc::Point { position, intensity, range: 7.0, .. },
        LightDesc::Directional { direction, irradiance, .. },
        LightDesc::Spot {
            world_from_light,
            cutoff_angle: 0.4,
            beam_width: 0.2,
            falloff: SpotFalloff::SquaredCosine,
            ..
        },
    ] = &scene.lights[..]
    else {
        panic!("{:?}", scene.lights)
    };
    assert_eq!((*position, *intensity), (Vec3::new(1.0, 2.0, 3.0), Rgb::new(3.0, 1.5, 0.0)));
    assert_eq!((*direction, *irradiance), (Vec3::NEG_Z, Rgb::splat(2.0)));
    assert!((world_from_light.transform_vector3(Vec3::Z) - Vec3::NEG_Z).length() < 1e-6);
}

#[test]
fn materials_are_as_the_file_says() {
    let rest = r#", "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 0.75], "metallicFactor": 0.5,
            "roughnessFactor": 0.25}, "alphaMode": "BLEND", "emissiveFactor": [1, 0, 0], "extensions": {
        "KHR_materials_emissive_strength": {"emissiveStrength": 4}, "KHR_materials_ior": {"ior": 1.2},
        "KHR_materials_sheen": {"sheenColorFactor": [0, 1, 0]}, "KHR_materials_clearcoat": {"clearcoatFactor": 0.5},
        "KHR_materials_iridescence": {}, "KHR_materials_coat": {}}}]"#;
    let (scene, diagnostics) = read(&square(r#", "material": 0"#, "", rest));
    let found = codes(&diagnostics);
    assert_eq!(found, ["gltf::unknown-extension", "gltf::extension", "scene::no-camera"]);
    let scene = scene.unwrap();
    let shape = &scene.shapes[0];
    assert_eq!(shape.emission.unwrap().radiance, ColorInput::Constant(Rgb::new(4.0, 0.0, 0.0)));
    let material = |id: sr_scene::MaterialId| &scene.materials[id.0 as usize];
    let MaterialDesc::Mask { opacity: ScalarInput::Constant(0.75), inner } = material(shape.material) else {
        panic!()
    };
    let MaterialDesc::TwoSided { front, .. } = material(*inner) else { panic!() };
    let MaterialDesc::MetallicRoughness(m) = material(*front) else { panic!() };
    assert_eq!(m.base_color, ColorInput::Constant(Rgb::new(0.5, 0.25, 1.0)));
    assert_eq!((m.metallic, m.roughness), (ScalarInput::Constant(0.5), ScalarInput::Constant(0.25)));
    assert_eq!((m.ior, m.clearcoat), (1.2, ScalarInput::Constant(0.5)));
    assert_eq!(m.sheen_color, ColorInput::Constant(Rgb::Y));
}

#[test]
fn channels_of_textures_become_images_of_their_own() {
    // A picture of 1 × 1 texel of the portable kind: red 51, green 102, blue 255.
    let image = uri(b"P6 1 1 255\n\x33\x66\xff");
    let rest = format!(
        r#", "images": [{{"uri": "{image}"}}], "textures": [{{"source": 0}}], "materials": [{{"pbrMetallicRoughness": {{
        "metallicRoughnessTexture": {{"index": 0, "extensions": {{"KHR_texture_transform": {{"offset": [0.5, 0.25],
        "scale": [2, 3]}}}}}}}}, "emissiveFactor": [1, 1, 1], "emissiveTexture": {{"index": 0}}}}]"#
    );
    let (scene, diagnostics) = read(&square(r#", "material": 0"#, "", &rest));
    // A surface that only glows is no light.
    assert_eq!(codes(&diagnostics), ["scene::no-light", "scene::no-camera"], "{}", diagnostics.render(false));
    let scene = scene.unwrap();
    let bytes: Vec<&[u8]> = scene.images[..3]
        .iter()
        .map(|image| match &image.pixels {
            Pixels::U8 { data, .. } => &data[..],
            Pixels::F32 { .. } => panic!(),
        })
        .collect();
    assert_eq!(bytes, [&[255u8][..], &[102], &[51, 102, 255]]);
    let TextureDesc::Bitmap { to_uv, srgb: false, .. } = &scene.textures[0] else { panic!() };
    assert_eq!(to_uv.transform_point2(Vec2::new(1.0, 1.0)), Vec2::new(2.5, 0.25));
    assert_eq!(to_uv.transform_point2(Vec2::new(0.0, 0.0)), Vec2::new(0.5, 3.25));
}

#[test]
fn a_mesh_of_several_nodes_is_kept_once() {
    let node = r#"}, {"mesh": 0, "translation": [2, 0, 0]"#;
    let (scene, _) = read(&square("", node, ""));
    let scene = scene.unwrap();
    assert_eq!((scene.shapes.len(), scene.groups.len(), scene.instances.len()), (0, 1, 2));
    assert_eq!(scene.instances[1].world_from_group.translation, Vec3::new(2.0, 0.0, 0.0).into());
}

#[test]
fn hostile_files_are_errors_or_warnings() {
    let nodes = r#", "children": [0, 1]}, {"children": [0]"#;
    let scene = r#", "scene": 0, "scenes": [{"nodes": [0]}]"#;
    assert!(codes(&read(&square("", nodes, scene)).1).contains(&"gltf::node-cycle"));
    let replaced = |from: &str, to: &str| {
        let text = square("", "", "");
        assert!(text.contains(from), "{from}");
        codes(&read(&text.replace(from, to)).1)
    };
    for (from, to, code) in [
        ("\"count\": 4, \"type\": \"VEC3\"", "\"count\": 1e9, \"type\": \"VEC3\"", "gltf::bad-accessor"),
        ("\"bufferView\": 0, ", "", "scene::nothing-left"),
        ("\"bufferView\": 0", "\"bufferView\": 7", "gltf::bad-index"),
        ("\"byteLength\": 48", "\"byteLength\": 4800", "gltf::bad-view"),
        ("\"byteLength\": 80", "\"byteLength\": 81", "gltf::bad-buffer"),
        ("5126", "1", "gltf::bad-accessor"),
        ("\"POSITION\": 0", "\"POSITION\": 1", "gltf::bad-accessor"),
        ("\"mode\": 5", "\"mode\": 5, \"indices\": 1", "gltf::bad-accessor"),
        ("\"mode\": 5", "\"mode\": 0", "gltf::primitive-mode"),
        ("\"mesh\": 0", "\"mesh\": 1e300", "gltf::bad-index"),
    ] {
        let found = replaced(from, to);
        assert!(found.contains(&code), "{to}: {found:?}");
    }
    assert_eq!(codes(&read("{\"a\": [1, 2").1), ["gltf::syntax"]);
}

#[test]
fn the_list_of_extensions_is_sorted() {
    assert!(gltf_extensions().is_sorted_by_key(|(name, _)| *name));
}

#[test]
fn the_page_has_the_list_of_extensions() {
    let mut table = String::from("| extension | here | how it differs |\n| --- | --- | --- |\n");
    for (name, support) in gltf_extensions() {
        let (here, how) = support.split_once(": ").unwrap_or((&support, ""));
        writeln!(table, "| `{name}` | {here} | {how} |").unwrap();
    }
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/import.md");
    let page = std::fs::read_to_string(page).expect("the page");
    assert!(page.contains(&table), "docs/import.md lacks this:\n{table}");
}

#[test]
fn a_mesh_file_is_a_scene() {
    let square = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/pbrt/square.ply");
    let (scene, diagnostics) = load(&square, &LoadOptions::default());
    assert_eq!(codes(&diagnostics), ["scene::no-light", "scene::no-camera"]);
    assert_eq!(scene.unwrap().shapes.len(), 1);
    let (scene, diagnostics) = load(Path::new("none.obj"), &LoadOptions::default());
    assert!(scene.is_none() && codes(&diagnostics).contains(&"file::bad-mesh"));
}

fn models() -> Vec<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    let folder = std::env::var_os("STERADIAN_SCENES").map_or(default, PathBuf::from).join("gltf");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        assert!(std::env::var_os("CI").is_none(), "no models in {}", folder.display());
        eprintln!("not run: no models in {}", folder.display());
        return Vec::new();
    };
    let files = entries.flatten().filter(|e| e.path().is_dir());
    let files = files.flat_map(|e| std::fs::read_dir(e.path()).unwrap().flatten());
    let is_model = |path: &PathBuf| path.extension().is_some_and(|e| e == "gltf" || e == "glb");
    let mut models: Vec<PathBuf> = files.map(|e| e.path()).filter(is_model).collect();
    models.sort();
    models
}

#[test]
fn the_models_load() {
    let models = models();
    assert!(models.is_empty() || models.len() > 20, "only {} models: no evidence", models.len());
    for model in models {
        let (scene, diagnostics) = load(&model, &LoadOptions::default());
        let name = model.file_name().unwrap().to_str().unwrap();
        eprintln!("{name}: {:?}", codes(&diagnostics));
        let errors = diagnostics.list.iter().filter(|d| d.severity == Severity::Error).count();
        assert!(scene.is_some() && errors == 0, "{name}\n{}", diagnostics.render(false));
    }
}
