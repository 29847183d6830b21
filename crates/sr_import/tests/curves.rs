//! Curves of Mitsuba and pbrt: what they become, and what is said about bad ones.

use std::path::{Path, PathBuf};

use glam::{Vec3, Vec4};
use sr_import::{LoadOptions, load_str};
use sr_scene::{CurveBasis, CurveUv, CurvesDesc, Diagnostics, Geometry, SceneDesc};

/// A file that is gone when the test is over.
struct CurveFile(PathBuf);

impl CurveFile {
    fn new(name: &str, text: &str) -> Self {
        let path = std::env::temp_dir().join(format!("sr_import-{name}-{}.txt", std::process::id()));
        std::fs::write(&path, text).unwrap();
        Self(path)
    }
}

impl Drop for CurveFile {
    fn drop(&mut self) {
        std::fs::remove_file(&self.0).unwrap();
    }
}

fn mitsuba(shape: &str) -> (Option<SceneDesc>, Diagnostics) {
    let sensor = "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor>";
    let text = format!("<scene version=\"3.0.0\">{sensor}{shape}</scene>");
    load_str("test.xml", &text, Path::new("."), &LoadOptions::default())
}

fn pbrt(world: &str) -> (Option<SceneDesc>, Diagnostics) {
    let text = format!("Camera \"perspective\" WorldBegin {world}");
    load_str("test.pbrt", &text, Path::new("."), &LoadOptions::default())
}

fn curves(scene: &SceneDesc, shape: usize) -> &CurvesDesc {
    match &scene.shapes[shape].geometry {
        Geometry::Curves(curves) => curves,
        other => panic!("{other:?}"),
    }
}

fn codes(diagnostics: &Diagnostics) -> Vec<&'static str> {
    diagnostics.list.iter().map(|d| d.code).collect()
}

/// Of Mitsuba's documentation: two curves.
const B_SPLINES: &str = "-1.0 0.1 0.1 0.5\n-0.3 1.2 1.0 0.5\n 0.3 0.3 1.1 0.5\n 1.0 1.4 1.2 0.5\n\n-1.0 5.0 2.2 1\n\
    -2.3 4.0 2.3 2\n 3.3 3.0 2.2 3\n 4.0 2.0 2.3 4\n 4.0 1.0 2.2 5\n 4.0 0.0 2.3 6\n";

#[test]
fn mitsuba_s_files() {
    let file = CurveFile::new("b-splines", B_SPLINES);
    let shape = |kind: &str| {
        format!(
            "<shape type='{kind}'><string name='filename' value='{}'/><transform name='to_world'>
             <scale value='2'/><translate x='1'/></transform>
             <float name='silhouette_sampling_weight' value='2'/></shape>",
            file.0.display()
        )
    };
    for (kind, basis) in [("bsplinecurve", CurveBasis::BSpline), ("linearcurve", CurveBasis::Linear)] {
        let (scene, said) = mitsuba(&shape(kind));
        assert_eq!(said.render(false), "");
        let scene = scene.unwrap();
        let curves = curves(&scene, 0);
        assert_eq!((curves.basis, curves.uv, &curves.firsts[..]), (basis, CurveUv::AroundAlong, &[0, 4][..]));
        assert_eq!(curves.points.len(), 10);
        // Radii stay, as Mitsuba has it.
        assert!((curves.points[1] - Vec4::new(0.4, 2.4, 2.0, 0.5)).length() < 1e-6);
        assert!((curves.points[9] - Vec4::new(9.0, 0.0, 4.6, 6.0)).length() < 1e-6);
    }
}

#[test]
fn mitsuba_s_files_have_faults() {
    for (name, text, message) in [
        ("few", "0 0 0 1\n1 0 0 1\n2 0 0 1\n", "curve 1 has 3 control points; at least 4 are needed"),
        ("nan", "0 0 0 1\n1 0 nan 1\n2 0 0 1\n3 0 0 1", "line 2: \"nan\" is no finite number"),
        ("short", "0 0 0 1\n1 0 0\n", "line 2: fewer than four numbers"),
        ("empty", "\n\n", "it has no control points"),
        ("thin", "0 0 0 -1\n1 0 0 -1\n2 0 0 -1\n3 0 0 -1\n", "curve 1 has a radius below 0"),
        ("far", "0 0 0 1\n1 0 0 1\n2 0 0 1\n3e38 0 0 1\n", "control point 3 is out of range"),
    ] {
        let file = CurveFile::new(name, text);
        let (scene, said) = mitsuba(&format!(
            "<shape type='bsplinecurve'><string name='filename' value='{}'/>
             <transform name='to_world'><scale value='10'/></transform></shape>",
            file.0.display()
        ));
        assert!(scene.is_none());
        assert_eq!(codes(&said), ["file::bad-curves"]);
        assert!(said.list[0].message.contains(message), "{}", said.list[0].message);
    }
    let (_, said) =
        mitsuba("<shape type='linearcurve'><string name='filename' value='nowhere.txt'/></shape>");
    assert_eq!(codes(&said), ["file::bad-curves"]);
    assert!(said.list[0].message.contains("there is no such file"));
    let (_, said) = mitsuba("<shape type='linearcurve'/>");
    assert_eq!(codes(&said), ["mitsuba::missing-property"]);
}

#[test]
fn what_curves_cannot_do_is_said() {
    let file = CurveFile::new("long", "0 0 0 1 7\n1 0 0 1\n");
    let (scene, said) = mitsuba(&format!(
        "<shape type='linearcurve'><string name='filename' value='{}'/><emitter type='area'/></shape>",
        file.0.display()
    ));
    assert_eq!(codes(&said), ["file::curves", "mitsuba::emitting-curves"]);
    assert!(said.list[0].message.ends_with("line 1 has more than four numbers"));
    assert!(scene.unwrap().shapes[0].emission.is_none());
    let (scene, said) = pbrt(
        "AttributeBegin AreaLightSource \"diffuse\" Shape \"curve\" \"string type\" \"cylinder\"
         \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] AttributeEnd",
    );
    assert_eq!(codes(&said), ["pbrt::emitting-curves"]);
    assert!(scene.unwrap().shapes[0].emission.is_none());
}

/// All are cubic Bézier splines, whose width is linear from end to end.
#[test]
fn pbrt_s_curves() {
    let points = "\"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 5 0 0 6 0 0]";
    for (parameters, segments, from, to) in [
        ("", 2, 0.0, 6.0),
        ("\"string basis\" \"bspline\"", 4, 1.0, 5.0),
        ("\"integer degree\" 2", 3, 0.0, 6.0),
        ("\"integer degree\" 2 \"string basis\" \"bspline\"", 5, 0.5, 5.5),
    ] {
        let (scene, said) = pbrt(&format!(
            "Scale 2 2 2 Shape \"curve\" {points} {parameters} \"string type\" \"cylinder\" \"integer splitdepth\" 4
             \"float width0\" 0.5 \"float width1\" 0.25"
        ));
        assert_eq!(said.render(false), "");
        let scene = scene.unwrap();
        let curves = curves(&scene, 0);
        assert_eq!((curves.basis, curves.uv), (CurveBasis::Bezier, CurveUv::AlongAround));
        assert_eq!((&curves.firsts[..], curves.points.len()), (&[0][..], 3 * segments + 1));
        for (i, p) in curves.points.iter().enumerate() {
            let u = i as f32 / (3 * segments) as f32;
            let expected = Vec3::X * 2.0 * (from + (to - from) * u);
            assert!((*p - expected.extend(0.5 - 0.25 * u)).length() < 1e-5, "{parameters}: {p}");
        }
    }
}

/// Strands of one material are one shape; those of another, and of an object, are not.
#[test]
fn pbrt_s_strands_are_gathered() {
    let strand = "Shape \"curve\" \"string type\" \"cylinder\" \"float width\" 0.1 \
        \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]\n";
    let (scene, said) = pbrt(&format!(
        "{strand}{strand}{strand}Material \"diffuse\" {strand}{strand}ObjectBegin \"a\" {strand}{strand}ObjectEnd
         ObjectInstance \"a\" Shape \"sphere\" {strand}"
    ));
    assert_eq!(said.render(false), "");
    let scene = scene.unwrap();
    let firsts: Vec<Vec<u32>> = scene
        .shapes
        .iter()
        .chain(&scene.groups[0].shapes)
        .filter_map(|shape| match &shape.geometry {
            Geometry::Curves(curves) => Some(curves.firsts.clone()),
            _ => None,
        })
        .collect();
    assert_eq!(firsts, [vec![0, 4, 8], vec![0, 4], vec![0], vec![0, 4]]);
}

#[test]
fn pbrt_s_curves_have_faults() {
    let points = "\"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]";
    let round = "\"string type\" \"cylinder\"";
    for (parameters, code) in [
        (format!("{round} \"point3 P\" [0 0 0 1 0 0 2 0 0]"), "pbrt::bad-value"),
        (format!("{round} \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0]"), "pbrt::bad-value"),
        (round.to_owned(), "pbrt::bad-value"),
        (format!("{round} {points} \"integer degree\" 4"), "pbrt::bad-value"),
        (format!("{round} {points} \"float width\" -1"), "pbrt::bad-value"),
        (format!("{round} {points} \"string basis\" \"hermite\""), "pbrt::unknown-value"),
        (format!("{round} {points} \"normal N\" [0 0 1 0 0 1]"), "pbrt::unsupported-parameter"),
        (format!("{round} {points} \"float radius\" 1"), "pbrt::unknown-parameter"),
        (points.to_owned(), "pbrt::flat-curve"),
    ] {
        let (scene, said) = pbrt(&format!("Shape \"curve\" {parameters} Shape \"sphere\""));
        assert_eq!(codes(&said), [code], "{parameters}");
        let left_out = said.list[0].consequence.as_deref() == Some("the shape is left out");
        assert_eq!(left_out, scene.unwrap().shapes.len() == 1, "{parameters}");
    }
    let (_, said) = pbrt(&format!("Scale 1 2 1 Shape \"curve\" {round} {points}"));
    assert_eq!(codes(&said), ["pbrt::curve-transform"]);
}
