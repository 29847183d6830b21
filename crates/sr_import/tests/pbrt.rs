//! pbrt-v4 snippets: what they become, and what is said about them.

use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use sr_import::{LoadOptions, load_str};
use sr_scene::{
    ColorInput, Crop, Diagnostics, FilterDesc, FovAxis, Geometry, LightDesc, MaterialDesc, MaterialId,
    MicrofacetKind, Projection, Rgb, ScalarInput, SceneDesc, Severity, SphereMapping, TextureDesc,
};

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/pbrt")
}

fn read(text: &str) -> (Option<SceneDesc>, Diagnostics) {
    load_str("test.pbrt", text, &data(), &LoadOptions::default())
}

/// A scene about which there is nothing to say but why its pictures differ from pbrt's.
fn scene(text: &str) -> SceneDesc {
    let (scene, mut diagnostics) = read(text);
    diagnostics.list.retain(|d| d.severity > Severity::Note);
    assert_eq!(diagnostics.render(false), "", "{text}");
    scene.unwrap()
}

/// A world in front of a camera.
fn world(text: &str) -> SceneDesc {
    scene(&format!("Camera \"perspective\" WorldBegin {text}"))
}

/// The codes of what is wrong with a world in front of a camera.
fn codes(text: &str) -> Vec<&'static str> {
    codes_of(text, |severity| severity > Severity::Note)
}

fn codes_of(text: &str, is_meant: impl Fn(Severity) -> bool) -> Vec<&'static str> {
    let (scene, diagnostics) = read(&format!("Camera \"perspective\" WorldBegin {text}"));
    assert_eq!(scene.is_none(), diagnostics.has_errors(), "{text}");
    diagnostics.list.iter().filter(|d| is_meant(d.severity)).map(|d| d.code).collect()
}

fn material(scene: &SceneDesc, id: MaterialId) -> &MaterialDesc {
    &scene.materials[id.0 as usize]
}

/// The material of the first shape, without its sides.
fn first_material(scene: &SceneDesc) -> &MaterialDesc {
    match material(scene, scene.shapes[0].material) {
        MaterialDesc::TwoSided { front, .. } => material(scene, *front),
        other => other,
    }
}

fn grey(v: f32) -> ColorInput {
    ColorInput::Constant(Rgb::splat(v))
}

fn close(a: Rgb, b: [f32; 3], tolerance: f32) {
    assert!((a - Rgb::from(b)).abs().max_element() <= tolerance, "{a} is not {b:?}");
}

#[test]
fn cameras_look_along_z_with_x_to_the_right() {
    let s = scene(
        "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100
         LookAt 1 2 3  1 2 9  0 1 0  Camera \"perspective\" \"float fov\" 60 \"float lensradius\" 0.5
         \"float focaldistance\" 4 Sampler \"halton\" \"integer pixelsamples\" 32
         Integrator \"path\" \"integer maxdepth\" 1 PixelFilter \"box\" WorldBegin",
    );
    let m = s.camera.world_from_camera;
    assert_eq!(m.transform_point3(Vec3::ZERO), Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(m.transform_vector3(Vec3::Z), Vec3::Z);
    // +X of the camera is to the left; pbrt's is to the right.
    assert_eq!(m.transform_vector3(Vec3::X), Vec3::NEG_X);
    let Projection::Perspective { fov_axis, fov, principal_point_offset, lens: Some(lens) } =
        s.camera.projection
    else {
        panic!()
    };
    // 60° are along the shorter side.
    assert_eq!((fov_axis, fov, principal_point_offset), (FovAxis::Smaller, 60f32.to_radians(), Vec2::ZERO));
    assert_eq!((lens.aperture_radius, lens.focus_distance), (0.5, 4.0));
    assert_eq!((s.settings.spp, s.settings.max_depth), (32, Some(2)));
    assert_eq!(s.camera.film.filter, FilterDesc::Box { radius: 0.5 });
}

#[test]
fn defaults_are_those_of_pbrt() {
    let s = scene("Camera \"perspective\" Film \"rgb\" WorldBegin Shape \"sphere\"");
    assert_eq!((s.camera.film.width, s.camera.film.height), (1280, 720));
    assert_eq!(s.camera.film.filter, FilterDesc::Gaussian { stddev: 0.5, radius: 1.5 });
    assert_eq!(s.settings.max_depth, Some(6));
    assert!(matches!(first_material(&s), MaterialDesc::Diffuse { reflectance } if *reflectance == grey(0.5)));
}

#[test]
fn screens_and_crops() {
    let s = scene(
        "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100
         \"float cropwindow\" [ 0.25 0.5 0 1 ] Camera \"perspective\" \"float screenwindow\" [ 0 1 0 1 ] WorldBegin",
    );
    assert_eq!(s.camera.film.crop, Some(Crop { x: 25, y: 0, width: 25, height: 100 }));
    let Projection::Perspective { fov_axis: FovAxis::X, fov, principal_point_offset, .. } =
        s.camera.projection
    else {
        panic!()
    };
    assert!((fov - 2.0 * 0.5f32.atan()).abs() < 1e-6);
    // The axis is at the left and at the bottom: at film = ½ − offset.
    assert_eq!(principal_point_offset, Vec2::new(0.5, -0.5));
    let s = scene("Film \"rgb\" \"integer pixelbounds\" [ 10 30 0 5000 ] Camera \"perspective\" WorldBegin");
    assert_eq!(s.camera.film.crop, Some(Crop { x: 10, y: 0, width: 20, height: 720 }));
    let s = scene(
        "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100
         Camera \"orthographic\" \"float screenwindow\" [ -4 4 -2 2 ] WorldBegin",
    );
    let m = s.camera.world_from_camera;
    assert_eq!(s.camera.projection, Projection::Orthographic);
    assert_eq!(m.transform_vector3(Vec3::X), Vec3::new(-4.0, 0.0, 0.0));
    assert_eq!(m.transform_vector3(Vec3::Y), Vec3::new(0.0, 4.0, 0.0));
    let s = scene("Camera \"spherical\" \"string mapping\" \"equirectangular\" WorldBegin");
    // The left edge of pbrt's image is +X, and a quarter of it +Z.
    assert_eq!(s.camera.world_from_camera.transform_vector3(Vec3::NEG_Z), Vec3::X);
    assert_eq!(s.camera.world_from_camera.transform_vector3(Vec3::X), Vec3::Z);
}

#[test]
fn transforms_attributes_and_coordinate_systems() {
    let s = world(
        "Translate 1 0 0 CoordinateSystem \"here\" AttributeBegin Scale 2 2 2 Rotate 90 0 0 1 Translate 1 0 0
         Shape \"sphere\" \"float radius\" 0.5 AttributeEnd Shape \"sphere\"
         TransformBegin Identity CoordSysTransform \"here\" ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 5 0 1 ]
         Shape \"sphere\" TransformEnd Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 7 8 9 1 ] Shape \"sphere\"",
    );
    let spheres: Vec<(Vec3, f32)> = s
        .shapes
        .iter()
        .map(|shape| match shape.geometry {
            Geometry::Sphere { center, radius, .. } => (center, radius),
            _ => panic!(),
        })
        .collect();
    assert!((spheres[0].0 - Vec3::new(1.0, 2.0, 0.0)).length() < 1e-6 && (spheres[0].1 - 1.0).abs() < 1e-6);
    assert_eq!(spheres[1].0, Vec3::X);
    assert_eq!(spheres[2].0, Vec3::new(1.0, 5.0, 0.0));
    assert_eq!(spheres[3].0, Vec3::new(7.0, 8.0, 9.0));
}

#[test]
fn meshes_keep_their_front_under_mirrors_and_turn_it_when_asked() {
    let mesh = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]";
    let normal = |s: &SceneDesc| {
        let Geometry::Mesh(mesh) = &s.shapes[0].geometry else { panic!() };
        assert!(mesh.normals.is_empty());
        let [a, b, c] = mesh.triangles[0].map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).normalize()
    };
    assert_eq!(normal(&world(mesh)), Vec3::Z);
    assert_eq!(normal(&world(&format!("Scale -1 1 1 {mesh}"))), Vec3::Z);
    assert_eq!(normal(&world(&format!("ReverseOrientation {mesh}"))), Vec3::NEG_Z);
}

#[test]
fn shapes() {
    let s = world(
        "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 2 3 0 ] \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]
         \"normal N\" [ 0 0 1 0 0 1 0 0 1 0 0 1 ] \"point2 uv\" [ 0 0 1 0 1 1 0 1 ]
         Shape \"disk\" \"float radius\" 2 \"float height\" 3 Shape \"cylinder\" \"float zmin\" 0 \"float zmax\" 4
         Shape \"loopsubdiv\" \"integer levels\" 1 \"integer indices\" [ 0 1 2 0 2 3 0 3 1 1 3 2 ]
         \"point3 P\" [ 0 0 0 1 0 0 0 1 0 0 0 1 ]
         Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 1 ]
         Shape \"plymesh\" \"string filename\" \"square.ply\" Shape \"plymesh\" \"string filename\" \"square.ply.gz\"",
    );
    let Geometry::Mesh(mesh) = &s.shapes[0].geometry else { panic!() };
    assert_eq!((mesh.positions.len(), mesh.normals.len(), mesh.uvs[2]), (4, 4, Vec2::ONE));
    let Geometry::Disk { center, u_axis, v_axis, flip_normals } = s.shapes[1].geometry else { panic!() };
    assert_eq!((center, u_axis, v_axis), (Vec3::new(0.0, 0.0, 3.0), 2.0 * Vec3::X, 2.0 * Vec3::Y));
    assert!(!flip_normals);
    let Geometry::Cylinder { base, radius, length, .. } = s.shapes[2].geometry else { panic!() };
    assert_eq!((base, radius, length), (Vec3::ZERO, 1.0, 4.0));
    let Geometry::Mesh(mesh) = &s.shapes[3].geometry else { panic!() };
    assert_eq!((mesh.triangles.len(), mesh.normals.len()), (16, mesh.positions.len()));
    let Geometry::Patch { corners, .. } = s.shapes[4].geometry else { panic!() };
    assert_eq!(corners[3], Vec3::ONE);
    for shape in &s.shapes[5..] {
        let Geometry::Mesh(mesh) = &shape.geometry else { panic!() };
        assert_eq!(mesh.triangles.len(), 2);
    }
    let s = world(
        "Shape \"bilinearmesh\" \"point2 uv\" [ 0 0 2 0 0 2 2 2 ] \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]",
    );
    let Geometry::Mesh(mesh) = &s.shapes[0].geometry else { panic!() };
    assert_eq!((mesh.triangles.len(), mesh.uvs[3]), (2, Vec2::splat(2.0)));
}

/// Areas of what is left of shapes, and of what they become by stretching, to the tolerance of 128 columns; normals point out.
#[test]
fn parts_of_quadrics_are_triangles() {
    use std::f32::consts::PI;
    // The surface of the spheroid with the half-axes 1, 1 and 2.
    let spheroid = 2.0 * PI * (1.0 + 2.0 / 0.75f32.sqrt() * 0.75f32.sqrt().asin());
    for (text, area) in [
        ("Shape \"sphere\" \"float radius\" 2 \"float zmin\" 0 \"float zmax\" 1", 4.0 * PI),
        ("Shape \"sphere\" \"float radius\" 2 \"float phimax\" 90", 4.0 * PI),
        ("Scale 1 1 2 Shape \"sphere\"", spheroid),
        ("Scale 1 1 -2 Shape \"sphere\"", spheroid),
        ("Shape \"disk\" \"float radius\" 2 \"float innerradius\" 1 \"float phimax\" 180", 1.5 * PI),
        ("Shape \"cylinder\" \"float zmin\" 0 \"float zmax\" 3 \"float phimax\" 180", 3.0 * PI),
    ] {
        let s = world(text);
        let Geometry::Mesh(mesh) = &s.shapes[0].geometry else { panic!("{text}") };
        let mut sum = 0.0;
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            let cross = (b - a).cross(c - a);
            sum += 0.5 * cross.length();
            let normal = mesh.normals[triangle[0] as usize];
            assert!(cross.dot(normal) > 0.0, "{text}: a triangle against its normal");
            let out =
                if text.contains("disk") { Vec3::Z } else { (a + b + c) / 3.0 * Vec3::new(1.0, 1.0, 0.01) };
            assert!(normal.dot(out) > 0.0, "{text}: {normal} at {a}");
        }
        assert!((sum / area - 1.0).abs() < 2e-3, "{text}: {sum}, not {area}");
    }
    // What is whole, if only by its numbers, keeps its form.
    let whole = "\"float radius\" 2 \"float zmin\" -2 \"float zmax\" 5 \"float phimax\" 360";
    let s = world(&format!("Scale 3 3 3 Shape \"sphere\" {whole}"));
    assert!(matches!(s.shapes[0].geometry, Geometry::Sphere { radius: 6.0, .. }));
    assert_eq!(codes("Shape \"sphere\" \"float radius\" -1 \"float zmin\" 0.5").len(), 1);
}

/// The first thousand or so are fine, the next ones coarse, and then they are whole.
#[test]
fn many_parts_of_quadrics_become_coarse() {
    let s = world(&"Shape \"sphere\" \"float phimax\" 350 ".repeat(200));
    let triangles = |shape: usize| match &s.shapes[shape].geometry {
        Geometry::Mesh(mesh) => mesh.triangles.len(),
        other => panic!("{other:?}"),
    };
    assert!(triangles(0) > 15_000 && triangles(199) < 1_100, "{}, {}", triangles(0), triangles(199));
}

#[test]
fn negative_roughness_and_indices_are_said() {
    for text in ["\"float roughness\" -0.1", "\"rgb eta\" [ -1 1 1 ]", "\"rgb k\" [ 3 -3 3 ]"] {
        assert_eq!(codes(&format!("Material \"conductor\" {text}")), ["pbrt::bad-value"], "{text}");
    }
}

#[test]
fn coats_that_cannot_be_are_said() {
    for text in ["\"float eta\" 0.5", "\"float thickness\" -5", "\"integer maxdepth\" 0"] {
        assert_eq!(codes(&format!("Material \"coateddiffuse\" {text}")), ["pbrt::bad-value"], "{text}");
    }
}

/// Each reason once.
#[test]
fn why_pictures_differ_from_pbrt_s_is_noted() {
    let noted = |materials: &[&str]| {
        let text: String = materials.iter().map(|m| format!("Material {m} ")).collect();
        codes_of(&text, |severity| severity == Severity::Note)
    };
    let red = "\"diffuse\" \"rgb reflectance\" [ 0.63 0.06 0.05 ]";
    let gold = "\"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"";
    let coat = "\"coateddiffuse\" \"float roughness\" 0.2";
    assert_eq!(noted(&[red, red]), ["pbrt::spectral-color"]);
    assert_eq!(noted(&[gold, coat, gold]), ["pbrt::spectral-metal", "pbrt::layers"]);
    assert_eq!(noted(&["\"coatedconductor\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]"]), ["pbrt::layers"]);
    for exact in [
        "\"diffuse\" \"rgb reflectance\" [ 0.6 0.5 0.3 ]",
        "\"diffuse\" \"rgb reflectance\" [ 0.1 0.01 0.01 ]",
        "\"conductor\" \"rgb reflectance\" [ 0.9 0.8 0.6 ]",
        "\"coateddiffuse\" \"float roughness\" 0",
        "\"dielectric\"",
    ] {
        assert_eq!(noted(&[exact]), [""; 0], "{exact}");
    }
}

#[test]
fn files_may_begin_with_a_mark() {
    let (scene, diagnostics) = read("\u{feff}Camera \"perspective\" WorldBegin Shape \"sphere\"");
    assert!(diagnostics.list.is_empty() && scene.is_some_and(|s| s.shapes.len() == 1));
}

#[test]
fn objects_are_groups_and_may_not_emit() {
    let s = world(
        "Translate 1 0 0 ObjectBegin \"a\" Shape \"sphere\" ObjectEnd Translate 0 1 0 ObjectInstance \"a\"
         Identity ObjectInstance \"a\"",
    );
    assert_eq!((s.shapes.len(), s.groups.len(), s.groups[0].shapes.len()), (0, 1, 1));
    // The transform of the object's own shapes is theirs, and the instance's comes before it.
    assert!(matches!(s.groups[0].shapes[0].geometry, Geometry::Sphere { center: Vec3::X, .. }));
    assert_eq!(s.instances[0].world_from_group.translation.to_array(), [1.0, 1.0, 0.0]);
    assert_eq!(s.instances[1].world_from_group.translation.to_array(), [0.0; 3]);
    assert_eq!(
        codes(
            "AreaLightSource \"diffuse\" ObjectBegin \"a\" Shape \"sphere\" ObjectEnd ObjectInstance \"a\""
        ),
        ["pbrt::light-in-object"]
    );
    assert_eq!(codes("ObjectInstance \"b\""), ["pbrt::unresolved-name"]);
    assert_eq!(codes("ObjectBegin \"a\" ObjectBegin \"b\" ObjectEnd ObjectEnd"), ["pbrt::unbalanced"; 2]);
}

#[test]
fn materials() {
    let first = |text: &str| {
        let s = world(&format!("{text} Shape \"sphere\""));
        format!("{:?}", first_material(&s))
    };
    let is = |text: &str, parts: &[&str]| {
        let found = first(text);
        for part in parts {
            assert!(found.contains(part), "{text}: {found} has no {part}");
        }
    };
    is("Material \"diffuse\" \"rgb reflectance\" [ 0.1 0.2 0.3 ]", &["Diffuse", "Vec3(0.1, 0.2, 0.3)"]);
    is("Material \"coateddiffuse\"", &["Plastic", "eta: 1.5", "nonlinear: true"]);
    // Roughness is remapped to its root.
    is("Material \"coateddiffuse\" \"float roughness\" 0.25", &["RoughPlastic", "Ggx", "alpha: 0.5"]);
    let raw = "\"bool remaproughness\" false";
    is(
        &format!("Material \"conductor\" \"float roughness\" 0.25 {raw}"),
        &["RoughConductor", "Constant(0.25)"],
    );
    is("Material \"conductor\"", &["Conductor", "eta_k: Some"]);
    is("Material \"dielectric\" \"float eta\" 1.3", &["Dielectric", "eta: 1.3"]);
    is("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"", &["eta: 1.5168"]);
    is(
        "Material \"dielectric\" \"float uroughness\" 0.04 \"float vroughness\" 0.16",
        &["RoughDielectric", "Constant(0.2)", "Constant(0.4)"],
    );
    is("Material \"thindielectric\"", &["ThinDielectric"]);
    is("Material \"diffusetransmission\" \"float scale\" 2", &["DiffuseTransmission", "Vec3(0.5, 0.5, 0.5)"]);
    is("Material \"interface\"", &["Mask", "Constant(0.0)"]);
    is(
        "Material \"coatedconductor\" \"float interface.roughness\" 0 \"float conductor.roughness\" 0.01",
        &["CoatedConductor", "coat_alpha: 0.0", "alpha: 0.1", "eta: 1.5"],
    );
    // An RGB index is a smooth spectrum: its mean is kept, and what it reflects at a right angle.
    is(
        "Material \"conductor\" \"rgb eta\" [ 1 1 1 ] \"rgb k\" [ 4 4 4 ]",
        &["Vec3(1.0, 1.0, 1.0)", "Vec3(4.0, 4"],
    );
    is("Material \"conductor\" \"rgb eta\" [ 1 2 3 ] \"rgb k\" [ 4 5 6 ]", &["Vec3(1.000", "Vec3(3.86"]);
    is(
        "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" \"dielectric\"
         Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.25",
        &["Blend", "Constant(0.25)"],
    );
}

#[test]
fn materials_may_be_described_after_they_are_named() {
    let s = world(
        "NamedMaterial \"a\" Shape \"sphere\" Shape \"sphere\"
         MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0.25 0.25 0.25 ]",
    );
    assert_eq!(s.shapes[0].material, s.shapes[1].material);
    assert!(
        matches!(first_material(&s), MaterialDesc::Diffuse { reflectance } if *reflectance == grey(0.25))
    );
    let cycle = "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"a\" ] Shape \"sphere\"";
    assert!(codes(cycle).contains(&"scene::material-cycle"));
}

#[test]
fn metals_have_the_color_that_their_spectra_have() {
    let s = world(
        "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" Shape \"sphere\"",
    );
    let MaterialDesc::Conductor { eta_k: Some((ColorInput::Constant(eta), ColorInput::Constant(k))), .. } =
        first_material(&s)
    else {
        panic!()
    };
    let reflected = |n: f32, k: f32| ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
    let gold = Rgb::new(reflected(eta.x, k.x), reflected(eta.y, k.y), reflected(eta.z, k.z));
    close(gold, [0.95, 0.79, 0.37], 0.06);
}

#[test]
fn textures() {
    let s = world(
        "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"../jpeg/420.png\" \"float uscale\" 2
         \"float vdelta\" 0.25 \"string wrap\" \"clamp\" \"string filter\" \"point\"
         Texture \"half\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.5
         Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"../jpeg/420.png\" \"string encoding\" \"linear\"
         Texture \"bump\" \"float\" \"scale\" \"texture tex\" \"r\" \"float scale\" 3
         Texture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 1 0 ]
         Texture \"m\" \"spectrum\" \"mix\" \"texture tex1\" \"c\" \"rgb tex2\" [ 0 0 1 ] \"float amount\" 0.25
         Texture \"b\" \"spectrum\" \"bilerp\" \"rgb v00\" [ 1 0 0 ]
         Material \"dielectric\" \"texture roughness\" \"r\" \"texture displacement\" \"bump\" Shape \"sphere\"
         Material \"diffuse\" \"texture reflectance\" \"half\" Shape \"sphere\" \"texture alpha\" \"r\"",
    );
    let TextureDesc::Bitmap { to_uv, wrap, filter, srgb: true, .. } = &s.textures[0] else { panic!() };
    assert_eq!(format!("{wrap:?} {filter:?}"), "Clamp Nearest");
    // pbrt's t counts from the bottom of the image.
    assert_eq!(to_uv.transform_point2(Vec2::new(0.5, 0.25)), Vec2::new(1.0, 0.5));
    let factor =
        |texture: &TextureDesc| matches!(texture, TextureDesc::Scale { factor, .. } if *factor == grey(0.5));
    assert!(s.textures.iter().any(factor));
    // The image as colors, as numbers, as their roots, as bumps, and the four corners.
    assert_eq!(s.images.len(), 5);
    let checker = s.textures.iter().find_map(|t| match t {
        TextureDesc::Checkerboard { to_uv, color0, .. } => Some((to_uv.transform_point2(Vec2::ONE), *color0)),
        _ => None,
    });
    assert_eq!(checker, Some((Vec2::new(4.0, 0.5), ColorInput::Constant(Rgb::X))));
    let MaterialDesc::BumpMap { scale: 1.0, inner, .. } = first_material(&s) else { panic!() };
    let MaterialDesc::RoughDielectric {
        kind: MicrofacetKind::GgxCorrelated,
        alpha: [ScalarInput::Texture(_), _],
        ..
    } = material(&s, *inner)
    else {
        panic!()
    };
    let masked = material(&s, s.shapes[1].material);
    assert!(matches!(masked, MaterialDesc::Mask { opacity: ScalarInput::Texture(_), .. }), "{masked:?}");
}

#[test]
fn lights_say_what_their_rgb_values_say_and_spectra_have_the_luminance_one() {
    let s = world(
        "LightSource \"point\" \"rgb I\" [ 1 2 3 ] \"float scale\" 2 \"point3 from\" [ 1 0 0 ]
         LightSource \"distant\" \"blackbody L\" 6504 \"point3 from\" [ 0 0 5 ] \"point3 to\" [ 0 0 0 ]
         LightSource \"infinite\" \"spectrum L\" \"stdillum-A\" \"float illuminance\" 3.14159265
         LightSource \"point\" \"float power\" 12.5663706
         LightSource \"spot\" \"rgb I\" [ 1 1 1 ] \"float coneangle\" 40 \"float conedeltaangle\" 10",
    );
    let luminance = Rgb::new(0.2126, 0.7152, 0.0722);
    let LightDesc::Point { intensity, position, .. } = &s.lights[0] else { panic!() };
    assert_eq!((*intensity, *position), (Rgb::new(2.0, 4.0, 6.0), Vec3::X));
    let LightDesc::Directional { direction, irradiance, .. } = &s.lights[1] else { panic!() };
    assert_eq!(*direction, Vec3::NEG_Z);
    close(*irradiance, [1.0; 3], 0.05);
    let LightDesc::Constant { radiance, .. } = &s.lights[2] else { panic!() };
    assert!(
        (radiance.dot(luminance) - 1.0).abs() < 1e-3 && radiance.x > 1.5 && radiance.z < 0.4,
        "{radiance}"
    );
    let LightDesc::Point { intensity, .. } = &s.lights[3] else { panic!() };
    close(*intensity, [1.0; 3], 1e-6);
    let LightDesc::Profile { profile, .. } = &s.lights[4] else { panic!() };
    assert_eq!(profile.candelas[1], 1.0);
    assert!((profile.vertical.last().unwrap() - 40f32.to_radians()).abs() < 1e-6);
}

#[test]
fn environments_are_octahedral_and_turn_with_the_transform() {
    let s = world(
        "Rotate 90 1 0 0 LightSource \"infinite\" \"string filename\" \"octahedral.pfm\" \"float scale\" 2",
    );
    let LightDesc::Environment { mapping, scale, world_from_light, .. } = &s.lights[0] else { panic!() };
    assert_eq!((*mapping, *scale), (SphereMapping::EqualAreaOctahedral, 2.0));
    assert!((*world_from_light * Vec3::Y - Vec3::Z).length() < 1e-6);
    let portal = "\"point3 portal\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]";
    assert_eq!(codes(&format!("LightSource \"infinite\" {portal}")), ["pbrt::portal"]);
}

#[test]
fn shapes_emit_what_the_light_source_says() {
    let light = "AreaLightSource \"diffuse\" \"rgb L\" [ 2 3 4 ] \"float scale\" 2";
    let s = world(&format!("{light} Shape \"sphere\" AttributeBegin AttributeEnd"));
    assert_eq!(s.shapes[0].emission.unwrap().radiance, ColorInput::Constant(Rgb::new(4.0, 6.0, 8.0)));
    let s = world(&format!("AttributeBegin {light} AttributeEnd Shape \"sphere\""));
    assert!(s.shapes[0].emission.is_none());
    // 4 π² of a sphere of radius 1, both sides of it.
    let s = world("AreaLightSource \"diffuse\" \"float power\" 39.478418 Shape \"sphere\"");
    let ColorInput::Constant(radiance) = s.shapes[0].emission.unwrap().radiance else { panic!() };
    close(radiance, [1.0; 3], 1e-4);
    let s = world(&format!("{light} \"bool twosided\" true Shape \"disk\""));
    let facing: Vec<bool> = s
        .shapes
        .iter()
        .map(|shape| matches!(shape.geometry, Geometry::Disk { flip_normals, .. } if flip_normals))
        .collect();
    assert_eq!(facing, [true, false]);
}

#[test]
fn exposure_scales_light() {
    let film = "Film \"rgb\" \"float iso\" 200 \"float exposuretime\" 0.25";
    let s = scene(&format!(
        "{film} Camera \"perspective\" WorldBegin LightSource \"infinite\" \"rgb L\" [ 4 4 4 ]"
    ));
    assert!(matches!(s.lights[0], LightDesc::Constant { radiance, .. } if radiance == Rgb::splat(2.0)));
}

#[test]
fn color_spaces_and_attributes() {
    let s = world(
        "ColorSpace \"rec2020\" Attribute \"shape\" \"float radius\" 3 Attribute \"material\" \"rgb reflectance\" [ 1 1 1 ]
         Material \"diffuse\" Shape \"sphere\" LightSource \"point\" \"rgb I\" [ 1 1 1 ]",
    );
    assert!(matches!(s.shapes[0].geometry, Geometry::Sphere { radius: 3.0, .. }));
    let MaterialDesc::Diffuse { reflectance: ColorInput::Constant(color) } = first_material(&s) else {
        panic!()
    };
    close(*color, [1.0; 3], 1e-5);
    let LightDesc::Point { intensity, .. } = &s.lights[0] else { panic!() };
    close(*intensity, [1.0; 3], 1e-4);
}

#[test]
fn other_files_are_read_where_they_are_named() {
    let s = world("Include \"sphere.pbrt\" Translate 1 0 0 Import \"sphere.pbrt\"");
    assert_eq!(s.shapes.len(), 2);
    assert_eq!(codes("Include \"absent.pbrt\""), ["pbrt::include"]);
    let (scene, diagnostics) = sr_import::load(&data().join("ouroboros.pbrt"), &LoadOptions::default());
    assert!(scene.is_none());
    assert!(diagnostics.list[0].message.contains("includes itself"), "{}", diagnostics.render(false));
}

#[test]
fn what_is_not_done_is_said() {
    for (text, code) in [
        ("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"", "pbrt::unsupported-medium"),
        ("Shape \"paraboloid\" \"float radius\" 1", "pbrt::unsupported-shape"),
        ("Material \"subsurface\" \"float mfp\" 1", "pbrt::unsupported-material"),
        ("Material \"measured\" \"string filename\" \"a.bsdf\"", "pbrt::unsupported-material"),
        ("Texture \"t\" \"float\" \"fbm\" \"integer octaves\" 3", "pbrt::unsupported-texture"),
        ("Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3", "pbrt::unsupported-texture"),
        (
            "Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" \"planar\"",
            "pbrt::unsupported-mapping",
        ),
        ("Shape \"sphere\" \"float raduis\" 2", "pbrt::unknown-parameter"),
        ("Shape \"sphere\" \"integer radius\" 2 \"float radius\" 2", "pbrt::unknown-parameter"),
        ("LightSource \"sun\"", "pbrt::unsupported-light"),
        ("NamedMaterial \"x\"", "pbrt::unresolved-name"),
        ("Material \"diffuse\" \"texture reflectance\" \"x\"", "pbrt::unresolved-name"),
        ("CoordSysTransform \"x\"", "pbrt::unresolved-name"),
        ("Material \"diffuse\" \"rgb reflectance\" [ 2 0 0 ]", "pbrt::bad-value"),
        ("ActiveTransform EndTime Translate 1 0 0 Shape \"sphere\"", "pbrt::motion"),
        ("ColorSpace \"sRGB\"", "pbrt::unknown-value"),
        ("Option \"bool disablepixeljitter\" true", "pbrt::unsupported-option"),
        ("LightSource \"infinite\" \"spectrum L\" \"metal-Agg-eta\"", "pbrt::unknown-value"),
    ] {
        assert_eq!(codes(text), [code], "{text}");
    }
    let film = |film: &str| {
        let (_, d) = read(&format!("Film \"rgb\" {film} Camera \"perspective\" WorldBegin"));
        d.list.iter().map(|d| d.code).collect::<Vec<_>>()
    };
    assert_eq!(film("\"string sensor\" \"canon_eos_100d\""), ["pbrt::sensor"]);
    assert_eq!(film("\"float whitebalance\" 5000"), ["pbrt::sensor"]);
    let said: Vec<_> = read("WorldBegin Shape \"sphere\"").1.list.iter().map(|d| d.code).collect();
    assert_eq!(said, ["scene::no-camera"]);
}

#[test]
fn a_mistake_is_shown_with_its_place_a_guess_and_what_happens() {
    let (_, d) = read("Camera \"perspective\"\nWorldBegin\nShape \"sphere\" \"float raduis\" 2\n");
    assert_eq!(
        d.one_line(&d.list[0]),
        "test.pbrt:3:16: warning[pbrt::unknown-parameter]: Shape \"sphere\" has no parameter \"raduis\"; did you mean \
         \"radius\"?; it is ignored"
    );
}

/// After a change of the lists, put there what this prints.
#[test]
fn the_documentation_says_what_becomes_of_everything() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/import.md");
    let page = std::fs::read_to_string(path).unwrap();
    let table = sr_import::pbrt_support_table();
    assert!(table.lines().count() > 40, "no table, no evidence");
    assert!(page.contains(&table), "docs/import.md lacks this:\n{table}");
}
