//! OBJ with its materials, PLY with its colors, and STL, as scenes of their own; environments around them.

use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use sr_import::{LoadOptions, load, load_str};
use sr_scene::{
    ColorInput, Diagnostics, Geometry, LightDesc, MaterialDesc, MaterialId, MeshDesc, Rgb, ScalarInput,
    SceneDesc, TextureDesc, Wrap,
};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh").join(name)
}

fn read(name: &str) -> (Option<SceneDesc>, Diagnostics) {
    load(&data(name), &LoadOptions::default())
}

fn codes(diagnostics: &Diagnostics) -> Vec<&'static str> {
    diagnostics.list.iter().map(|d| d.code).collect()
}

fn mesh(scene: &SceneDesc, shape: usize) -> &MeshDesc {
    let Geometry::Mesh(mesh) = &scene.shapes[shape].geometry else { panic!() };
    mesh
}

fn material(scene: &SceneDesc, id: MaterialId) -> &MaterialDesc {
    &scene.materials[id.0 as usize]
}

/// What is below a shape's sides.
fn front(scene: &SceneDesc, id: MaterialId) -> &MaterialDesc {
    let MaterialDesc::TwoSided { front, .. } = material(scene, id) else { panic!("one side") };
    material(scene, *front)
}

#[test]
fn an_obj_is_a_shape_for_each_material() {
    let (scene, diagnostics) = read("covered.obj");
    let statements: Vec<(&str, &str)> =
        diagnostics.list.iter().map(|d| (d.code, d.message.as_str())).collect();
    let text = format!("{statements:#?}");
    for part in [
        "the option \\\"-mm\\\" of an image is not done",
        "\\\"map_ns\\\" is not done",
        "\\\"1e39\\\" is too large",
        "\\\"nan\\\" is not a finite number",
        "there is no image none.png",
        "there is no material \\\"cot\\\"",
        "none.mtl: there is no such file",
    ] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    assert_eq!(statements.len(), 9, "{text}");
    let place = diagnostics.list.iter().find(|d| d.message.contains("-mm")).unwrap();
    assert_eq!(diagnostics.sources.line_column(&place.span), (7, 1));
    let scene = scene.unwrap();
    assert_eq!(scene.shapes.len(), 6);
    assert_eq!(mesh(&scene, 0).triangles.len(), 2);
    // Smooth normals are those of the whole.
    assert_eq!(mesh(&scene, 1).positions[2], Vec3::Y);
    // The coat, with a mask.
    let MaterialDesc::Mask { opacity: ScalarInput::Texture(mask), inner } =
        material(&scene, scene.shapes[0].material)
    else {
        panic!()
    };
    let MaterialDesc::RoughPlastic { alpha, diffuse_reflectance, specular_reflectance, .. } =
        front(&scene, *inner)
    else {
        panic!()
    };
    assert!((alpha - 0.1).abs() < 1e-6);
    assert_eq!(*diffuse_reflectance, ColorInput::Constant(Rgb::new(0.5, 0.25, 0.0)));
    assert_eq!(*specular_reflectance, ColorInput::Constant(Rgb::splat(0.5)));
    let TextureDesc::Scale { input: ColorInput::Texture(image), factor, .. } =
        &scene.textures[mask.0 as usize]
    else {
        panic!()
    };
    assert_eq!(*factor, ColorInput::Constant(Rgb::splat(0.75)));
    let TextureDesc::Bitmap { to_uv, wrap: Wrap::Clamp, srgb: false, .. } = &scene.textures[image.0 as usize]
    else {
        panic!()
    };
    assert_eq!(to_uv.transform_point2(Vec2::new(0.25, 0.0)), Vec2::new(1.0, 1.0));
    // The metal, by its narrow highlight a mirror; the glass; the lamp; the last by its roughness.
    assert!(matches!(front(&scene, scene.shapes[1].material), MaterialDesc::Conductor { .. }));
    let MaterialDesc::Dielectric { eta: 1.33, specular_transmittance, .. } =
        material(&scene, scene.shapes[2].material)
    else {
        panic!()
    };
    assert_eq!(*specular_transmittance, ColorInput::Constant(Rgb::new(0.5, 1.0, 1.0)));
    let emission = scene.shapes[3].emission.unwrap();
    assert_eq!(emission.radiance, ColorInput::Constant(Rgb::new(5.0, 4.0, 3.0)));
    let MaterialDesc::MetallicRoughness(m) = front(&scene, scene.shapes[4].material) else { panic!() };
    assert_eq!((m.roughness, m.metallic), (ScalarInput::Constant(0.25), ScalarInput::Constant(1.0)));
    assert_eq!(m.clearcoat, ScalarInput::Constant(0.5));
    // A lamp is light enough.
    assert!(scene.lights.is_empty());
}

#[test]
fn a_ply_shows_its_colors() {
    let (scene, diagnostics) = read("colors.ply");
    assert_eq!(codes(&diagnostics), ["scene::no-light", "scene::no-camera"]);
    let scene = scene.unwrap();
    let colors = &mesh(&scene, 0).vertex_colors;
    assert_eq!(colors[0], Vec3::X);
    assert!((colors[1].y - 0.503).abs() < 1e-3, "sRGB-encoded: {}", colors[1].y);
    assert!(matches!(scene.textures[..], [TextureDesc::MeshColor { .. }]));
}

/// As MeshLab writes them.
#[test]
fn a_ply_shows_the_texture_that_it_names() {
    let (scene, diagnostics) = read("textured.ply");
    let said: Vec<_> = diagnostics.list.iter().filter(|d| d.code == "ply::texture").collect();
    assert_eq!(said.len(), 2, "{}", diagnostics.render(false));
    assert!(said[0].message.ends_with("it names 2 textures, the second is second.png"));
    assert_eq!(said[1].consequence.as_deref(), Some("its colors are not shown: the texture is"));
    let scene = scene.unwrap();
    let MaterialDesc::Diffuse { reflectance: ColorInput::Texture(id) } =
        front(&scene, scene.shapes[0].material)
    else {
        panic!("no texture")
    };
    let TextureDesc::Bitmap { image, wrap: Wrap::Repeat, srgb: true, to_uv, .. } =
        &scene.textures[id.0 as usize]
    else {
        panic!("no image")
    };
    assert!(scene.images[*image as usize].name.ends_with("mask image.pgm"));
    assert_eq!(to_uv.transform_point2(Vec2::ZERO), Vec2::Y, "v is upwards");
}

#[test]
fn a_ply_without_what_its_texture_needs_says_so() {
    let text = std::fs::read_to_string(data("textured.ply")).unwrap();
    let path = std::env::temp_dir().join(format!("sr_import-texture-{}.ply", std::process::id()));
    for (from, to, consequence) in [
        (
            "property float s\nproperty float t",
            "property float a\nproperty float b",
            "the texture is not shown",
        ),
        ("mask image.pgm", "none.pgm", "it is shown without its texture"),
    ] {
        std::fs::write(&path, text.replace(from, to)).unwrap();
        let (scene, diagnostics) = load(&path, &LoadOptions::default());
        let said: Vec<_> = diagnostics.list.iter().filter(|d| d.code == "ply::texture").collect();
        assert_eq!(said.len(), 1, "{}", diagnostics.render(false));
        assert_eq!(said[0].consequence.as_deref(), Some(consequence));
        assert!(matches!(scene.unwrap().textures[..], [TextureDesc::MeshColor { .. }]));
    }
    std::fs::remove_file(path).unwrap();
}

#[test]
fn too_many_files_of_materials_are_said() {
    let path = std::env::temp_dir().join(format!("sr_import-libraries-{}.obj", std::process::id()));
    let names: String = (0..258).map(|i| format!("mtllib {i}.mtl\n")).collect();
    std::fs::write(&path, names + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let (scene, diagnostics) = load(&path, &LoadOptions::default());
    std::fs::remove_file(path).unwrap();
    assert!(scene.is_some());
    let said: Vec<_> = diagnostics.list.iter().filter(|d| d.code == "obj::no-library").collect();
    assert_eq!(said.len(), 257);
    assert_eq!(said[256].message, "more than 256 files of materials are named, \"256.mtl\" after these");
}

#[test]
fn an_stl_stands_upright_with_sharp_edges() {
    let (scene, diagnostics) = read("box.stl");
    assert_eq!(codes(&diagnostics), ["scene::no-light", "scene::no-camera"]);
    let scene = scene.unwrap();
    let mesh = mesh(&scene, 0);
    assert_eq!(mesh.triangles.len(), 12);
    // Z is up in the file.
    let top = mesh.positions.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
    assert!((top - 2.0).abs() < 1e-6, "{top}");
    assert!(mesh.normals.iter().all(|n| n.abs().max_element() > 0.999), "{:?}", mesh.normals);
}

#[test]
fn an_environment_is_put_around_any_scene() {
    let options = LoadOptions { environment: Some(data("mask image.pgm")), ..LoadOptions::default() };
    let (scene, diagnostics) = load(&data("box.stl"), &options);
    assert_eq!(codes(&diagnostics), ["scene::no-camera"]);
    assert!(matches!(scene.unwrap().lights[..], [LightDesc::Environment { .. }]));
    let xml = |light: &str| {
        format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"cube\"/>{light}</scene>"
        )
    };
    let pbrt = |light: &str| format!("Camera \"perspective\" WorldBegin Shape \"sphere\" {light}\n");
    for (name, plain, lit, own) in [
        (
            "a.xml",
            xml(""),
            xml("<emitter type=\"point\"/>"),
            xml("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>"),
        ),
        (
            "a.pbrt",
            pbrt(""),
            pbrt("LightSource \"point\""),
            pbrt("LightSource \"infinite\" \"rgb L\" [1 1 1]"),
        ),
    ] {
        for (text, lights, said) in [(plain, 1, false), (lit, 2, false), (own, 2, true)] {
            let (scene, diagnostics) = load_str(name, &text, Path::new(""), &options);
            let found = codes(&diagnostics).contains(&"scene::two-environments");
            assert_eq!(found, said, "{text}: {}", diagnostics.render(false));
            assert_eq!(scene.unwrap().lights.len(), lights, "{text}");
        }
    }
    let options = LoadOptions { environment: Some("none.hdr".into()), ..LoadOptions::default() };
    let (scene, diagnostics) = load(&data("box.stl"), &options);
    assert!(scene.is_none() && codes(&diagnostics).contains(&"file::bad-image"));
}
