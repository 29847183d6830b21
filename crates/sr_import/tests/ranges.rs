//! Numbers that are too large, too small or senseless: each is said, where it stands.

use std::path::Path;

use sr_import::{LoadOptions, load_str};
use sr_scene::Severity;

const SENSOR: &str = "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor>";
/// Whatever else is said about the sun, it is day.
const NOON: &str = "<vector name=\"sun_direction\" x=\"0\" y=\"0\" z=\"1\"/>";
const SPHERE: &str = "<shape type=\"sphere\"/>";

/// What is said about a scene of `body`, a line each; all of it has a place.
fn said(body: &str) -> Vec<(Severity, String)> {
    let text = format!("<scene version=\"3.0.0\">\n{body}</scene>");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/gallery/data");
    let (scene, diagnostics) = load_str("test.xml", &text, &folder, &LoadOptions::default());
    assert_eq!(scene.is_none(), diagnostics.has_errors());
    for d in &diagnostics.list {
        assert!(!d.span.bytes.is_empty(), "{}: {} has no place", d.code, d.message);
    }
    diagnostics.list.iter().map(|d| (d.severity, format!("{}: {}", d.code, d.message))).collect()
}

/// That exactly one thing is said, and begins like this.
fn expect(severity: Severity, body: &str, start: &str) {
    let said = said(body);
    let [(found, text)] = &said[..] else { panic!("{body}: {said:?}") };
    assert!(*found == severity && text.starts_with(start), "{body}: {found} {text}");
}

fn error(body: &str, start: &str) {
    expect(Severity::Error, body, start);
}

fn warning(body: &str, start: &str) {
    expect(Severity::Warning, body, start);
}

fn shape(kind: &str, inside: &str) -> String {
    format!("{SENSOR}<shape type=\"{kind}\">{inside}</shape>")
}

fn scaled(kind: &str, by: &str) -> String {
    let transform = format!("<transform name=\"to_world\"><scale value=\"{by}\"/></transform>");
    shape(kind, &transform)
}

fn material(kind: &str, inside: &str) -> String {
    shape("sphere", &format!("<bsdf type=\"{kind}\">{inside}</bsdf>"))
}

fn sensor(kind: &str, inside: &str) -> String {
    format!("<sensor type=\"{kind}\">{inside}</sensor>{SPHERE}")
}

fn float(name: &str, value: &str) -> String {
    format!("<float name=\"{name}\" value=\"{value}\"/>")
}

fn emitter(kind: &str, inside: &str) -> String {
    format!("{SENSOR}{SPHERE}<emitter type=\"{kind}\">{inside}</emitter>")
}

#[test]
fn shapes_are_within_what_can_be_squared() {
    for kind in ["sphere", "disk", "cylinder", "rectangle", "cube", "bilinearpatch"] {
        assert_eq!(said(&scaled(kind, "1e14")), []);
        assert_eq!(said(&scaled(kind, "1e-14")), []);
        error(&scaled(kind, "1e17"), "scene::extent");
        assert!(!said(&scaled(kind, "1e-17")).is_empty(), "{kind}");
    }
    let group = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"/></shape>";
    for (by, fits) in [("1e14", true), ("1e-14", true), ("1e16", false), ("1e-16", false)] {
        let instance = format!(
            "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><scale value=\"{by}\"/>
             </transform></shape>"
        );
        assert_eq!(said(&format!("{SENSOR}{group}{instance}")).is_empty(), fits, "{by}");
    }
    let long = "<transform name=\"to_world\"><scale x=\"1e16\" y=\"1\" z=\"1\"/></transform>";
    error(&shape("disk", long), "scene::extent");
    let far = "<transform name=\"to_world\"><translate x=\"1e16\"/></transform>";
    error(&shape("sphere", far), "scene::extent");
    error(&emitter("spot", far), "scene::extent: a light at");
    error(&sensor("perspective", &format!("{}{far}", float("fov", "40"))), "scene::extent: a camera at");
}

#[test]
fn indices_and_roughness_are_those_of_something() {
    for kind in ["dielectric", "thindielectric", "roughdielectric", "plastic", "roughplastic"] {
        error(&material(kind, &float("int_ior", "1e20")), "scene::index: a relative index of refraction");
        error(&material(kind, &float("ext_ior", "0")), "scene::index: \"ext_ior\"");
        error(&material(kind, &float("int_ior", "-1")), "scene::index: \"int_ior\"");
    }
    error(&material("roughconductor", &float("alpha", "1e30")), "scene::alpha");
    let complex = "<rgb name=\"eta\" value=\"1e17\"/><rgb name=\"k\" value=\"1\"/>";
    error(&material("conductor", complex), "scene::index: eta");
    error(&material("principled", &float("specular", "-2")), "mitsuba::bad-value: \"specular\"");
    error(&material("roughdiffuse", &float("alpha", "-1")), "mitsuba::bad-value: \"alpha\"");
    let bump = format!("{}<texture type=\"checkerboard\"/><bsdf type=\"diffuse\"/>", float("scale", "1e38"));
    error(&material("bumpmap", &bump), "scene::bump-scale");
    let tilted = |color: &str| {
        material("normalmap", &format!("<rgb name=\"normalmap\" value=\"{color}\"/><bsdf type=\"diffuse\"/>"))
    };
    assert_eq!(said(&tilted("0.5 0.5 1")), []);
    warning(&tilted("0.5 0.5 0"), "scene::normal-map");
    warning(&tilted("0.5 0.5 0.5"), "scene::normal-map");
    error(&tilted("0.5 0.5 9"), "scene::normal-map");
}

#[test]
fn textures_are_seen_and_have_what_they_show() {
    let flat = "<texture type=\"checkerboard\" name=\"reflectance\"><transform name=\"to_uv\">
        <scale x=\"0\" y=\"1\"/></transform></texture>";
    warning(&material("diffuse", flat), "scene::bad-transform");
    error(&material("diffuse", &flat.replace("\"0\"", "\"1e9\"")), "scene::bad-transform");
    let colors = "<texture type=\"mesh_attribute\" name=\"reflectance\">
        <string name=\"name\" value=\"vertex_color\"/></texture>";
    warning(&material("diffuse", colors), "scene::no-mesh-color: the material asks for colors of vertices");
    let inside = format!("<bsdf type=\"twosided\"><bsdf type=\"diffuse\">{colors}</bsdf></bsdf>");
    warning(&shape("cube", &inside), "scene::no-mesh-color");
}

#[test]
fn cameras_see_something() {
    let fov = |value: &str| sensor("perspective", &float("fov", value));
    assert_eq!(said(&fov("0.001")), []);
    error(&fov("1e-30"), "scene::field-of-view");
    error(&fov("180"), "scene::field-of-view: an angle of view of 180°: at least");
    let fixed = float("fov", "40");
    let far = float("principal_point_offset_x", "1e30");
    error(&sensor("perspective", &format!("{fixed}{far}")), "scene::principal-point");
    let wide = float("aperture_radius", "1e30");
    error(&sensor("thinlens", &format!("{fixed}{wide}")), "scene::aperture");
    let film = "<film type=\"hdrfilm\"><rfilter type=\"box\"/><rfilter type=\"tent\"/></film>";
    warning(&sensor("perspective", &format!("{fixed}{film}")), "mitsuba::wrong-nesting");
}

#[test]
fn lights_shine_from_somewhere_at_some_time() {
    for (name, value) in [("month", "13"), ("day", "0"), ("year", "100000")] {
        let wrong = format!("<integer name=\"{name}\" value=\"{value}\"/>") + NOON;
        error(&emitter("sunsky", &wrong), &format!("mitsuba::bad-value: \"{name}\""));
    }
    for (name, value) in [("hour", "25"), ("latitude", "91"), ("longitude", "1e9"), ("timezone", "99")] {
        error(&emitter("sky", &(float(name, value) + NOON)), &format!("mitsuba::bad-value: \"{name}\""));
    }
    error(&emitter("sun", &(float("sun_aperture", "1e-3") + NOON)), "scene::sun");
    let spot = format!("{}{}", float("cutoff_angle", "20"), float("beam_width", "30"));
    error(&emitter("spot", &spot), "scene::spot: cutoff angle 20°, beam width 30°: 0 ≤");
    error(&emitter("point", "<rgb name=\"intensity\" value=\"3e38\"/>"), "scene::bad-color");
}

#[test]
fn nothing_is_said_to_be_nothing() {
    let group = "<shape type=\"shapegroup\" id=\"g\"/><shape type=\"instance\"><ref id=\"g\"/></shape>";
    warning(&format!("{SENSOR}{SPHERE}{group}"), "mitsuba::empty-group");
    let smooth = float("max_smooth_angle", "-900");
    warning(&shape("cube", &smooth), "mitsuba::bad-value: \"max_smooth_angle\"");
}
