//! Hair of Mitsuba and pbrt: what it becomes, and what is said about bad parameters.

use std::path::Path;

use sr_import::{LoadOptions, load_str};
use sr_scene::{
    ColorInput, Diagnostics, HairAbsorption, HairDesc, MaterialDesc, Rgb, ScalarInput, SceneDesc,
};

fn mitsuba(parameters: &str) -> (Option<SceneDesc>, Diagnostics) {
    let sensor = "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor>";
    let shape = format!("<shape type=\"cylinder\"><bsdf type=\"hair\">{parameters}</bsdf></shape>");
    let text = format!("<scene version=\"3.0.0\">{sensor}{shape}</scene>");
    load_str("test.xml", &text, Path::new("."), &LoadOptions::default())
}

fn pbrt(parameters: &str) -> (Option<SceneDesc>, Diagnostics) {
    let text = format!("Camera \"perspective\" WorldBegin Material \"hair\" {parameters} Shape \"cylinder\"");
    load_str("test.pbrt", &text, Path::new("."), &LoadOptions::default())
}

fn hair((scene, said): (Option<SceneDesc>, Diagnostics)) -> HairDesc {
    assert_eq!(said.render(false), "");
    let scene = scene.unwrap();
    match scene.materials[scene.shapes[0].material.0 as usize] {
        MaterialDesc::Hair(hair) => hair,
        ref other => panic!("{other:?}"),
    }
}

fn codes((_, said): (Option<SceneDesc>, Diagnostics)) -> Vec<&'static str> {
    said.list.iter().map(|d| d.code).collect()
}

const fn constant(value: f32) -> ScalarInput {
    ScalarInput::Constant(value)
}

fn pigments(eumelanin: f32, pheomelanin: f32) -> HairAbsorption {
    HairAbsorption::Pigments { eumelanin: constant(eumelanin), pheomelanin: constant(pheomelanin) }
}

#[test]
fn defaults_are_those_of_each_format() {
    let ours = hair(mitsuba(""));
    assert_eq!(ours.absorption, pigments(1.3, 0.2));
    assert!((ours.eta - 1.55 / 1.000_277).abs() < 1e-6 && !ours.along_u);
    assert_eq!((ours.beta_m, ours.beta_n, ours.alpha), (constant(0.3), constant(0.3), 2_f32.to_radians()));
    let pbrts = hair(pbrt(""));
    assert_eq!(pbrts, HairDesc { absorption: pigments(1.3, 0.0), eta: 1.55, along_u: true, ..ours });
}

#[test]
fn all_parameters() {
    let sigma_a = |color: [f32; 3]| HairAbsorption::Coefficient(ColorInput::Constant(Rgb::from(color)));
    let ours = hair(mitsuba(
        "<rgb name='sigma_a' value='1, 2, 3'/><float name='scale' value='2'/><float name='int_ior' value='1.4'/>
         <float name='ext_ior' value='1'/><float name='longitudinal_roughness' value='0.1'/>
         <float name='azimuthal_roughness' value='0.2'/><float name='scale_tilt' value='3'/>",
    ));
    let all = HairDesc {
        absorption: sigma_a([2.0, 4.0, 6.0]),
        eta: 1.4,
        beta_m: constant(0.1),
        beta_n: constant(0.2),
        alpha: 3_f32.to_radians(),
        along_u: false,
    };
    assert_eq!(ours, all);
    let pbrts = hair(pbrt(
        "\"rgb sigma_a\" [2 4 6] \"float eta\" 1.4 \"float beta_m\" 0.1 \"float beta_n\" 0.2 \"float alpha\" 3",
    ));
    assert_eq!(pbrts, HairDesc { along_u: true, ..all });
    let color = HairAbsorption::Color(ColorInput::Constant(Rgb::new(0.5, 0.25, 0.125)));
    assert_eq!(hair(mitsuba("<rgb name='color' value='0.5, 0.25, 0.125'/>")).absorption, color);
    assert_eq!(hair(pbrt("\"rgb reflectance\" [0.5 0.25 0.125]")).absorption, color);
    assert_eq!(hair(pbrt("\"rgb color\" [0.5 0.25 0.125]")).absorption, color);
    assert_eq!(hair(mitsuba("<float name='eumelanin' value='0.5'/>")).absorption, pigments(0.5, 0.2));
    assert_eq!(hair(pbrt("\"float pheomelanin\" 0.5")).absorption, pigments(0.0, 0.5));
}

#[test]
fn what_cannot_be_is_said() {
    let two = "<rgb name='sigma_a' value='1'/><float name='eumelanin' value='1'/>";
    assert_eq!(codes(mitsuba(two)), ["mitsuba::conflict"]);
    assert_eq!(codes(pbrt("\"rgb sigma_a\" [1 1 1] \"float eumelanin\" 1")), ["pbrt::conflict"]);
    for (name, value, code) in [
        ("longitudinal_roughness", "1.5", "scene::out-of-range"),
        ("azimuthal_roughness", "-1", "scene::out-of-range"),
        ("eumelanin", "-1", "scene::hair"),
        ("scale_tilt", "91", "scene::hair"),
        ("int_ior", "0", "scene::index"),
        ("roughness", "0.5", "mitsuba::unknown-property"),
    ] {
        let said = codes(mitsuba(&format!("<float name='{name}' value='{value}'/>")));
        assert_eq!(said, [code], "{name}");
    }
    assert_eq!(codes(mitsuba("<rgb name='sigma_a' value='1e9'/>")), ["scene::hair"]);
    assert_eq!(codes(pbrt("\"float beta_m\" 2")), ["scene::out-of-range"]);
    assert_eq!(codes(pbrt("\"float roughness\" 2")), ["pbrt::unknown-parameter"]);
}
