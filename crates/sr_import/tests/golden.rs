//! Small files of our own: what they become, and what is said about them.

use std::path::{Path, PathBuf};

use sr_import::{LoadOptions, load, load_str};
use sr_scene::{
    ColorInput, Diagnostics, FilterDesc, FovAxis, Geometry, LightDesc, MaterialDesc, MaterialId,
    MicrofacetKind, Projection, Rgb, ScalarInput, SceneDesc, TextureDesc,
};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn read(body: &str) -> (Option<SceneDesc>, Diagnostics) {
    let text = format!("<scene version=\"3.0.0\">{body}</scene>");
    load_str("test.xml", &text, &data(""), &LoadOptions::default())
}

/// The codes of all that is said about a scene that has a sensor beside `body`.
fn codes(body: &str) -> Vec<&'static str> {
    let sensor = "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor>";
    read(&format!("{sensor}{body}")).1.list.iter().map(|d| d.code).collect()
}

#[test]
fn every_kind_of_thing_arrives() {
    let options = LoadOptions { defines: vec![("width".into(), "64".into())], ..LoadOptions::default() };
    let (scene, diagnostics) = load(&data("every_kind.xml"), &options);
    assert_eq!(diagnostics.render(false), "");
    let scene = scene.unwrap();

    let camera = &scene.camera;
    assert_eq!((camera.film.width, camera.film.height, scene.settings.spp), (64, 16, 8));
    let Projection::Perspective { fov_axis, fov, lens: Some(lens), .. } = camera.projection else { panic!() };
    assert_eq!((fov_axis, fov), (FovAxis::Smaller, 40f32.to_radians()));
    assert_eq!((lens.aperture_radius, lens.focus_distance, camera.near_clip), (0.1, 3.0, 0.01));
    assert_eq!((lens.blades, lens.blade_rotation), (0, 0.0));
    assert_eq!(camera.film.filter, FilterDesc::Gaussian { stddev: 0.5, radius: 2.0 });
    assert_eq!(camera.world_from_camera.transform_vector3(glam::Vec3::Z), glam::Vec3::NEG_Z);
    assert_eq!(scene.settings.max_depth, Some(2));

    let material = |id: MaterialId| &scene.materials[id.0 as usize];
    let MaterialDesc::TwoSided { front, back } = material(scene.shapes[0].material) else { panic!() };
    assert_eq!(front, back);
    assert!(matches!(material(*front), MaterialDesc::Diffuse { reflectance: ColorInput::Texture(_) }));
    let TextureDesc::Checkerboard { color0, color1, to_uv, .. } = &scene.textures[0] else { panic!() };
    let grey = |v: f32| ColorInput::Constant(Rgb::splat(v));
    assert_eq!((*color0, *color1), (grey(0.4), grey(0.2)));
    assert_eq!(to_uv.transform_point2(glam::Vec2::ONE), glam::Vec2::new(4.0, 2.0));
    let MaterialDesc::RoughConductor { kind, alpha, eta_k: Some((eta, _)), .. } =
        material(scene.shapes[1].material)
    else {
        panic!()
    };
    assert_eq!(*kind, MicrofacetKind::Ggx);
    assert_eq!(*alpha, [ScalarInput::Constant(0.1), ScalarInput::Constant(0.3)]);
    assert_eq!(*eta, ColorInput::Constant(Rgb::new(0.143036, 0.375307, 1.44205)));
    let MaterialDesc::Dielectric { eta, .. } = material(scene.shapes[2].material) else { panic!() };
    assert!((eta - 1.333 / 1.000277).abs() < 1e-6);

    let Geometry::Mesh(square) = &scene.shapes[0].geometry else { panic!() };
    assert_eq!(square.positions[2], glam::Vec3::new(4.0, 4.0, -1.0));
    assert!(matches!(scene.shapes[1].geometry, Geometry::Sphere { radius: 0.5, flip_normals: false, .. }));
    assert_eq!(scene.shapes[2].emission.unwrap().radiance, ColorInput::Constant(Rgb::splat(2.0)));
    assert_eq!((scene.groups.len(), scene.instances.len()), (1, 1));
    assert_eq!(scene.instances[0].world_from_group.translation, glam::Vec3A::new(3.0, 0.0, 0.0));

    let [
        LightDesc::Point { position, .. },
        LightDesc::Spot { cutoff_angle, beam_width, .. },
        LightDesc::Directional { direction, .. },
        LightDesc::Constant { radiance, .. },
    ] = &scene.lights[..]
    else {
        panic!()
    };
    assert_eq!(*position, glam::Vec3::new(0.0, 1.0, 2.0));
    assert_eq!((*cutoff_angle, *beam_width), (20f32.to_radians(), 15f32.to_radians()));
    assert_eq!(*direction, glam::Vec3::NEG_Y);
    // Equal energy in sRGB, as Mitsuba 3 has it.
    assert!((*radiance - Rgb::new(1.20479, 0.948291, 0.908916)).abs().max_element() < 0.01);
}

#[test]
fn mistakes_are_reported_with_place_guess_and_consequence() {
    let (scene, diagnostics) = load(&data("mistakes.xml"), &LoadOptions::default());
    assert!(scene.is_none());
    let folder = data("").display().to_string();
    let text: String =
        diagnostics.list.iter().map(|d| diagnostics.one_line(d).replace(&folder, "") + "\n").collect();
    let golden = std::fs::read_to_string(data("mistakes.txt")).unwrap_or_default();
    assert_eq!(text, golden, "\n{text}");
}

#[test]
fn bad_files_are_one_clear_error_each() {
    for (body, code) in [
        ("<shape type=\"obj\"><string name=\"filename\" value=\".\"/></shape>", "file::bad-mesh"),
        ("<shape type=\"ply\"><string name=\"filename\" value=\"/dev/zero\"/></shape>", "file::bad-mesh"),
        ("<include filename=\"absent.xml\"/>", "mitsuba::bad-value"),
        (
            "<emitter type=\"envmap\"><string name=\"filename\" value=\"mistakes.xml\"/></emitter>",
            "file::bad-image",
        ),
        ("<bsdf type=\"twosided\"><bsdf type=\"dielectric\"/></bsdf>", "scene::twosided-transmission"),
        ("<bsdf type=\"mask\" id=\"a\"><ref id=\"a\"/></bsdf>", "mitsuba::cycle"),
        ("<shape type=\"sphere\"><rgb name=\"radius\" value=\"1\"/></shape>", "mitsuba::wrong-type"),
        ("<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>", "scene::sphere"),
    ] {
        assert_eq!(codes(body), [code], "{body}");
    }
    let film = |w: &str| {
        let (_, d) = read(&format!(
            "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><film type=\"hdrfilm\">\
             <integer name=\"width\" value=\"{w}\"/><integer name=\"height\" value=\"60000\"/></film></sensor>"
        ));
        d.list.iter().map(|d| d.code).collect::<Vec<_>>()
    };
    assert_eq!(film("60000"), ["scene::film-size"]);
    assert_eq!(film("-1"), ["scene::film-size"]);
    let (scene, diagnostics) = load(&data(""), &LoadOptions::default());
    assert!(scene.is_none());
    assert!(diagnostics.list[0].message.contains("it is a directory"), "{}", diagnostics.list[0].message);
}

#[test]
fn shapes_without_area_are_left_out_unless_nothing_else_is_there() {
    let flat = "<shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"0\"/></transform></shape>";
    let (scene, d) = read(&format!("{flat}<shape type=\"sphere\"/>"));
    assert_eq!(scene.unwrap().shapes.len(), 1);
    assert_eq!(d.list[0].code, "scene::degenerate-triangles");
    let (scene, d) = read(flat);
    assert!(scene.is_none());
    assert!(d.list.iter().any(|d| d.code == "scene::nothing-left"));
}

#[test]
fn both_generations_agree() {
    let body = |width: &str, world: &str, ior: &str| {
        format!(
            "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor><shape type=\"rectangle\">\
             <transform name=\"{world}\"><translate x=\"1\"/></transform><bsdf type=\"dielectric\">\
             <float name=\"{ior}\" value=\"1.5\"/></bsdf></shape>{width}"
        )
    };
    let text = |version: &str, body: String| format!("<scene version=\"{version}\">{body}</scene>");
    let load = |text: String| load_str("a.xml", &text, Path::new(""), &LoadOptions::default());
    let (old, d) = load(text("0.5.0", body("", "toWorld", "intIOR")));
    assert!(d.list.is_empty(), "{}", d.render(false));
    let (new, _) = load(text("3.0.0", body("", "to_world", "int_ior")));
    let strip = |s: Option<SceneDesc>| {
        let s = s.unwrap();
        format!("{:?} {:?}", s.shapes[0].geometry, s.materials)
    };
    assert_eq!(strip(old), strip(new));
}

#[test]
fn a_uniform_light_of_mitsuba_0_5_is_white() {
    let text = "<scene version=\"0.6.0\"><emitter type=\"constant\"><spectrum name=\"radiance\" value=\"2\"/></emitter></scene>";
    let scene = load_str("a.xml", text, Path::new(""), &LoadOptions::default()).0.unwrap();
    assert!(matches!(scene.lights[0], LightDesc::Constant { radiance, .. } if radiance == Rgb::splat(2.0)));
}
