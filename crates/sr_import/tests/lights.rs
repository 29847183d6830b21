//! Lights in scene files: what they become, and what is said about bad ones.

use std::path::Path;

use glam::{Mat3, Vec3};
use sr_import::{LoadOptions, load_str};
use sr_scene::{ColorInput, Diagnostics, FovAxis, LightDesc, MaterialDesc, Rgb, SceneDesc, SphereMapping};

fn read(body: &str) -> (Option<SceneDesc>, Diagnostics) {
    let sensor = "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor>";
    let text = format!("<scene version=\"3.0.0\">{sensor}{body}</scene>");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/gallery/data");
    load_str("test.xml", &text, &folder, &LoadOptions::default())
}

fn lights(body: &str) -> Vec<LightDesc> {
    let (scene, diagnostics) = read(body);
    assert_eq!(diagnostics.render(false), "");
    scene.unwrap().lights
}

/// What is said about a light, in one text.
fn said(body: &str) -> String {
    let (scene, diagnostics) = read(body);
    assert_eq!(scene.is_none(), diagnostics.has_errors());
    diagnostics.list.iter().map(|d| format!("{}: {}\n", d.code, d.message)).collect()
}

#[test]
fn projectors_arrive_with_a_cameras_angles() {
    let body = "<emitter type=\"projector\"><float name=\"fov\" value=\"30\"/>
        <string name=\"fov_axis\" value=\"smaller\"/><rgb name=\"irradiance\" value=\"1 2 3\"/></emitter>";
    let [LightDesc::Projector { scale: 1.0, fov_axis: FovAxis::Smaller, fov, .. }] = lights(body)[..] else {
        panic!()
    };
    assert!((fov - 30f32.to_radians()).abs() < 1e-6);
}

#[test]
fn environments_arrive_with_their_options() {
    let body = "<emitter type=\"envmap\"><string name=\"filename\" value=\"sky-octahedral.exr\"/>
        <string name=\"mapping\" value=\"octahedral\"/><boolean name=\"mis_compensation\" value=\"true\"/>
        <shape type=\"rectangle\"><transform name=\"to_world\"><translate z=\"-2\"/></transform></shape>
        </emitter>";
    let [LightDesc::Environment { mapping, mis_compensation: true, portals, .. }] = &lights(body)[..] else {
        panic!()
    };
    assert_eq!(*mapping, SphereMapping::EqualAreaOctahedral);
    let [portal] = &portals[..] else { panic!() };
    assert_eq!((portal.corner, portal.edges), (Vec3::new(-1.0, -1.0, -2.0), [2.0 * Vec3::X, 2.0 * Vec3::Y]));
}

#[test]
fn profiles_and_goniometric_lights_arrive() {
    let body = "<emitter type=\"ies\"><string name=\"filename\" value=\"downlight.ies\"/></emitter>
        <emitter type=\"goniometric\"><string name=\"filename\" value=\"sky.exr\"/></emitter>";
    let all = lights(body);
    let [LightDesc::Profile { profile, intensity, .. }, LightDesc::Goniometric { mapping, .. }] = &all[..]
    else {
        panic!()
    };
    assert_eq!((profile.vertical.len(), profile.horizontal.len(), *intensity), (19, 3, Rgb::ONE));
    assert_eq!(*mapping, SphereMapping::LatLong);
}

/// The direction of the sun is in world space; old names of Mitsuba 0.5 mean the same.
#[test]
fn a_sunsky_is_a_sky_and_a_sun() {
    let placed = "<transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/></transform>";
    let body = format!(
        "<emitter type=\"sunsky\">{placed}<vector name=\"sunDirection\" x=\"0\" y=\"2\" z=\"0\"/>
         <float name=\"skyScale\" value=\"6\"/></emitter><emitter type=\"sun\"/>"
    );
    let all = lights(&body);
    let [
        LightDesc::Sky { turbidity, scale, sun_direction, world_from_light, .. },
        LightDesc::Sun { aperture, .. },
        LightDesc::Sun { direction, world_from_light: unturned, .. },
    ] = &all[..]
    else {
        panic!()
    };
    assert_eq!((*turbidity, *scale, *unturned), (3.0, 6.0, Mat3::IDENTITY));
    assert!(sun_direction.distance(Vec3::Z) < 1e-6 && (*world_from_light * Vec3::Z).distance(Vec3::Y) < 1e-6);
    assert!((aperture.to_degrees() - 0.5358).abs() < 1e-5 && direction.z > 0.7);
}

#[test]
fn what_is_wrong_is_said() {
    let env = |inner: &str| {
        format!("<emitter type=\"envmap\"><string name=\"filename\" value=\"sky.exr\"/>{inner}</emitter>")
    };
    let sky = |inner: &str| format!("<emitter type=\"sunsky\">{inner}</emitter>");
    for (body, says) in [
        (env("<string name=\"mapping\" value=\"octahedral\"/>"), "an octahedral map is square"),
        (env("<string name=\"mapping\" value=\"octohedral\"/>"), "\"octohedral\" is not a mapping"),
        (env("<float name=\"scale\" value=\"-1\"/>"), "an environment's scale of -1"),
        (env("<shape type=\"sphere\"/>"), "sphere"),
        (
            env(
                "<shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"0\"/></transform></shape>",
            ),
            "portal has no area",
        ),
        (
            env(
                "<transform name=\"to_world\"><matrix value=\"1 1 0 0 0 1 0 0 0 0 1 0 0 0 0 1\"/></transform>",
            ),
            "more than a rotation and a scale",
        ),
        (sky("<float name=\"turbidity\" value=\"0.5\"/>"), "a turbidity of 0.5"),
        (sky("<float name=\"turbidity\" value=\"nan\"/>"), "not a finite number"),
        (sky("<float name=\"sun_aperture\" value=\"0\"/>"), "the sun fills an angle of 0°"),
        (sky("<rgb name=\"albedo\" value=\"2 0 0\"/>"), "albedo is above 1"),
        (sky("<vector name=\"sun_direction\" x=\"0\" y=\"0\" z=\"0\"/>"), "cannot be zero"),
        (sky("<vector name=\"sun_direction\" x=\"0\" y=\"0\" z=\"-1\"/>"), "below the horizon"),
        (sky("<integer name=\"year\" value=\"99999999999\"/>"), "-4000 to 10000 is possible"),
        (
            "<emitter type=\"projector\"><float name=\"fov\" value=\"180\"/></emitter>".into(),
            "an angle of view of 180°",
        ),
        ("<emitter type=\"ies\"/>".into(), "needs a \"filename\""),
        (
            "<emitter type=\"ies\"><string name=\"filename\" value=\"slide.exr\"/></emitter>".into(),
            "it is no IES file",
        ),
        (
            "<emitter type=\"ies\"><string name=\"filename\" value=\"none.ies\"/></emitter>".into(),
            "there is no such file",
        ),
        ("<emitter type=\"goniometric\"/>".into(), "needs a \"filename\""),
        (
            "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"0\"/></emitter>".into(),
            "0 ≤ beam ≤ cutoff",
        ),
        ("<emitter type=\"sunskie\"/>".into(), "sunskie"),
    ] {
        let text = said(&body);
        assert!(text.contains(says), "{body}: {text}");
    }
}

#[test]
fn what_lights_cannot_be_is_said() {
    let placed_twice = "<emitter type=\"point\"><point name=\"position\" y=\"2\"/>
        <transform name=\"to_world\"><translate y=\"5\"/></transform></emitter>";
    assert!(said(placed_twice).starts_with("mitsuba::conflict: "), "{}", said(placed_twice));
    let blinding = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"3e38\"/></emitter>";
    assert!(said(blinding).starts_with("scene::bad-color: "), "{}", said(blinding));
}

/// As in Mitsuba: a light that is given a material has it, and one that is not reflects nothing.
#[test]
fn lights_without_a_material_are_black() {
    let reflects = |emitter: &str, bsdf: &str| {
        let (scene, _) = read(&format!("<shape type=\"rectangle\">{emitter}{bsdf}</shape>"));
        let scene = scene.unwrap();
        match scene.materials[scene.shapes[0].material.0 as usize] {
            MaterialDesc::Diffuse { reflectance: ColorInput::Constant(color) } => color,
            ref other => panic!("{other:?}"),
        }
    };
    let (emitter, bsdf) = ("<emitter type=\"area\"/>", "<bsdf type=\"diffuse\"/>");
    assert_eq!(reflects(emitter, ""), Rgb::ZERO);
    assert_eq!(reflects(emitter, bsdf), Rgb::splat(0.5));
    assert_eq!(reflects("", ""), Rgb::splat(0.5));
}

#[test]
fn materials_and_textures_that_lack_something_say_so_once() {
    let ball = |bsdf: &str| said(&format!("<shape type=\"sphere\">{bsdf}</shape>"));
    let no_map = ball("<bsdf type=\"normalmap\"><bsdf type=\"diffuse\"/></bsdf>");
    assert_eq!(no_map.lines().count(), 1, "{no_map}");
    assert!(no_map.starts_with("mitsuba::wrong-nesting: "), "{no_map}");
    let two = "<texture type=\"checkerboard\"/><texture type=\"mix\"/>";
    for inputs in ["", two] {
        let scale = format!("<texture name=\"reflectance\" type=\"scale\">{inputs}</texture>");
        let said = ball(&format!("<bsdf type=\"diffuse\">{scale}</bsdf>"));
        assert!(said.starts_with("mitsuba::wrong-nesting: "), "{said}");
    }
    let smooth = ball("<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0\"/></bsdf>");
    assert_eq!(smooth.lines().count(), 1, "{smooth}");
}
