//! Shapes, cameras and films: what their elements become, and what is said about bad ones.

use std::path::Path;

use sr_import::{LoadOptions, load_str};
use sr_scene::{Crop, Diagnostics, FilterDesc, Geometry, Lens, Projection, SceneDesc};

const SENSOR: &str = "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor>";

fn read(body: &str) -> (Option<SceneDesc>, Diagnostics) {
    let text = format!("<scene version=\"3.0.0\">{body}</scene>");
    load_str("test.xml", &text, Path::new(env!("CARGO_MANIFEST_DIR")), &LoadOptions::default())
}

fn shapes(body: &str) -> SceneDesc {
    let (scene, diagnostics) = read(&format!("{SENSOR}{body}"));
    assert_eq!(diagnostics.render(false), "");
    scene.unwrap()
}

/// The codes of all that is said.
fn codes(body: &str) -> Vec<&'static str> {
    read(body).1.list.iter().map(|d| d.code).collect()
}

#[test]
fn a_cylinder_is_placed_as_mitsuba_places_it() {
    let scene = shapes(
        "<shape type='cylinder'><point name='p0' x='1' y='2' z='3'/><point name='p1' x='1' y='4' z='3'/>
         <float name='radius' value='0.5'/>
         <transform name='to_world'><scale value='2'/></transform></shape>",
    );
    let Geometry::Cylinder { base, frame, radius, length, flip_normals } = scene.shapes[0].geometry else {
        panic!()
    };
    assert_eq!((base.to_array(), radius, length, flip_normals), ([2.0, 4.0, 6.0], 1.0, 4.0, false));
    assert_eq!((frame.z_axis, frame.x_axis), (glam::Vec3::Y, glam::Vec3::X));
    let codes = codes(&format!(
        "{SENSOR}<shape type='cylinder'><transform name='to_world'><scale x='2'/></transform></shape>"
    ));
    assert_eq!(codes, ["mitsuba::cylinder-transform"]);
}

#[test]
fn shapes_without_extent_are_errors() {
    for (shape, code) in [
        ("<shape type='cylinder'><point name='p1' x='0'/></shape>", "scene::cylinder"),
        ("<shape type='cylinder'><float name='radius' value='-1'/></shape>", "scene::cylinder"),
        (
            "<shape type='cylinder'><transform name='to_world'><scale value='0'/></transform></shape>",
            "scene::cylinder",
        ),
        (
            "<shape type='bilinearpatch'><transform name='to_world'><scale value='0'/></transform></shape>",
            "scene::patch",
        ),
        ("<shape type='sphere'><float name='radius' value='0'/></shape>", "scene::sphere"),
        ("<shape type='disk'><transform name='to_world'><scale x='0'/></transform></shape>", "scene::disk"),
    ] {
        assert!(codes(&format!("{SENSOR}{shape}")).contains(&code), "{shape}");
    }
}

#[test]
fn a_patch_does_not_emit() {
    let (scene, said) = read(&format!("{SENSOR}<shape type='bilinearpatch'><emitter type='area'/></shape>"));
    assert_eq!(said.list[0].code, "mitsuba::emitting-patch");
    assert!(scene.unwrap().shapes[0].emission.is_none());
}

#[test]
fn groups_inside_groups_are_placed_one_by_one() {
    let move_x = |x: i32| format!("<transform name='to_world'><translate x='{x}'/></transform>");
    let scene = shapes(&format!(
        "<shape type='shapegroup' id='one'><shape type='sphere'/></shape>
         <shape type='shapegroup' id='two'><shape type='disk'/>
           <shape type='instance'><ref id='one'/>{}</shape>
           <shape type='instance'><ref id='one'/>{}</shape></shape>
         <shape type='instance'><ref id='two'/><transform name='to_world'><scale value='2'/></transform></shape>
         <shape type='instance'><ref id='two'/></shape>",
        move_x(1),
        move_x(5),
    ));
    let mut found: Vec<(usize, f32)> = scene
        .instances
        .iter()
        .map(|i| {
            let is_sphere =
                matches!(scene.groups[i.group as usize].shapes[0].geometry, Geometry::Sphere { .. });
            (usize::from(is_sphere), i.world_from_group.translation.x)
        })
        .collect();
    found.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(found, [(0, 0.0), (0, 0.0), (1, 1.0), (1, 2.0), (1, 5.0), (1, 10.0)]);
}

#[test]
fn groups_that_hold_themselves_or_too_much_are_errors() {
    let cycle = "<shape type='shapegroup' id='a'><shape type='instance'><ref id='a'/></shape></shape>
         <shape type='instance'><ref id='a'/></shape>";
    assert_eq!(codes(&format!("{SENSOR}{cycle}")), ["mitsuba::wrong-nesting"]);
    // each group shows the one before twice: 2³⁰ spheres, or nothing 2³⁰ times
    for innermost in ["<shape type='sphere'/>", ""] {
        let mut body = format!("{SENSOR}<shape type='shapegroup' id='g0'>{innermost}</shape>");
        for i in 1..=30 {
            let shown = format!("<shape type='instance'><ref id='g{}'/></shape>", i - 1);
            body += &format!("<shape type='shapegroup' id='g{i}'>{shown}{shown}</shape>");
        }
        body += &"<shape type='instance'><ref id='g30'/></shape>".repeat(3);
        let found = codes(&body);
        assert_eq!(found.contains(&"mitsuba::empty-group"), innermost.is_empty());
        assert_eq!(*found.last().unwrap(), "mitsuba::too-many-instances");
        assert!(found.len() <= 2);
    }
    // the outermost first, so that reading it leads down to the innermost
    let mut body = format!("{SENSOR}<shape type='instance'><ref id='g5000'/></shape>");
    for i in (1..=5000).rev() {
        body += &format!(
            "<shape type='shapegroup' id='g{i}'><shape type='instance'><ref id='g{}'/></shape></shape>",
            i - 1
        );
    }
    body += "<shape type='shapegroup' id='g0'><shape type='sphere'/></shape>";
    assert!(codes(&body).contains(&"mitsuba::wrong-nesting"));
}

#[test]
fn meshes_are_subdivided() {
    let cube = |extra: &str| shapes(&format!("<shape type='cube'>{extra}</shape>")).shapes.remove(0).geometry;
    let Geometry::Mesh(mesh) = cube("<integer name='subdivide' value='2'/>") else { panic!() };
    assert_eq!(mesh.triangles.len(), 12 * 16);
    assert_eq!(mesh.normals.len(), mesh.positions.len());
    let Geometry::Mesh(mesh) =
        cube("<integer name='subdivide' value='1'/><string name='scheme' value='catmull_clark'/>")
    else {
        panic!()
    };
    assert_eq!(mesh.triangles.len(), 2 * 36);
    for (extra, code) in [
        ("<integer name='subdivide' value='40'/>", "file::bad-mesh"),
        ("<integer name='subdivide' value='-1'/>", "mitsuba::bad-value"),
        ("<string name='scheme' value='lop'/>", "mitsuba::unknown-value"),
    ] {
        assert_eq!(codes(&format!("{SENSOR}<shape type='cube'>{extra}</shape>")), [code], "{extra}");
    }
}

fn sensor(kind: &str, inside: &str) -> String {
    format!("<sensor type='{kind}'><float name='fov' value='40'/>{inside}</sensor>")
}

#[test]
fn cameras_of_every_kind() {
    let camera = |text: &str| {
        let (scene, diagnostics) = read(text);
        assert_eq!(diagnostics.render(false), "");
        scene.unwrap().camera
    };
    let lens = "<float name='aperture_radius' value='0.2'/><float name='focus_distance' value='3'/>
        <integer name='blades' value='5'/><float name='blade_rotation' value='90'/>";
    let Projection::Perspective { lens: Some(lens), .. } = camera(&sensor("thinlens", lens)).projection
    else {
        panic!()
    };
    let expected = Lens {
        aperture_radius: 0.2,
        focus_distance: 3.0,
        blades: 5,
        blade_rotation: std::f32::consts::FRAC_PI_2,
    };
    assert_eq!(lens, expected);
    assert_eq!(camera("<sensor type='orthographic'/>").projection, Projection::Orthographic);
    assert_eq!(camera("<sensor type='spherical'/>").projection, Projection::Spherical);
}

#[test]
fn bad_cameras_are_errors() {
    for (text, code) in [
        (sensor("thinlens", "<integer name='blades' value='2'/>"), "scene::aperture"),
        (sensor("thinlens", "<float name='aperture_radius' value='-2'/>"), "scene::aperture"),
        (sensor("perspective", "<float name='near_clip' value='0'/>"), "scene::clip"),
        (sensor("perspective", "<float name='far_clip' value='0.001'/>"), "scene::clip"),
        (
            sensor("perspective", "<transform name='to_world'><scale z='0'/></transform>"),
            "scene::bad-transform",
        ),
        (
            "<sensor type='perspective'><float name='fov' value='180'/></sensor>".into(),
            "scene::field-of-view",
        ),
    ] {
        assert!(codes(&text).contains(&code), "{text}: {:?}", codes(&text));
    }
}

fn film(inside: &str) -> String {
    sensor("perspective", &format!("<film type='hdrfilm'>{inside}</film>"))
}

#[test]
fn filters_and_crops() {
    let of = |inside: &str| {
        let (scene, diagnostics) = read(&film(inside));
        assert_eq!(diagnostics.render(false), "");
        scene.unwrap().camera.film
    };
    for (kind, expected) in [
        ("mitchell", FilterDesc::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 }),
        ("catmullrom", FilterDesc::CatmullRom),
        ("lanczos", FilterDesc::Lanczos { lobes: 3 }),
        ("blackmanharris", FilterDesc::BlackmanHarris { radius: 1.5 }),
    ] {
        assert_eq!(of(&format!("<rfilter type='{kind}'/>")).filter, expected);
    }
    let bc = "<rfilter type='mitchell'><float name='B' value='0'/><float name='C' value='0.5'/></rfilter>";
    assert_eq!(of(bc).filter, FilterDesc::Mitchell { b: 0.0, c: 0.5 });
    let crop = "<integer name='width' value='100'/><integer name='height' value='50'/>
        <integer name='crop_offset_x' value='10'/><integer name='crop_width' value='20'/>";
    assert_eq!(of(crop).crop, Some(Crop { x: 10, y: 0, width: 20, height: 50 }));
    assert_eq!(of(crop).image_size(), (20, 50));
    assert_eq!(of("").crop, None);
}

#[test]
fn bad_films_are_errors() {
    for (inside, code) in [
        ("<integer name='width' value='0'/>", "scene::film-size"),
        ("<integer name='width' value='-3'/>", "scene::film-size"),
        ("<integer name='width' value='1000000000'/>", "scene::film-size"),
        ("<integer name='width' value='99999999999'/>", "scene::film-size"),
        ("<integer name='crop_width' value='0'/>", "scene::film-size"),
        (
            "<integer name='crop_offset_x' value='700'/><integer name='crop_width' value='300'/>",
            "scene::crop",
        ),
        ("<rfilter type='box'><float name='radius' value='0'/></rfilter>", "scene::filter"),
        ("<rfilter type='tent'><float name='radius' value='1e30'/></rfilter>", "scene::filter"),
        ("<rfilter type='gaussian'><float name='stddev' value='-1'/></rfilter>", "scene::filter"),
        ("<rfilter type='lanczos'><integer name='lobes' value='0'/></rfilter>", "scene::filter"),
        ("<rfilter type='lanczos'><integer name='lobes' value='1000000'/></rfilter>", "scene::filter"),
        ("<rfilter type='mitchell'><float name='B' value='1e9'/></rfilter>", "scene::filter"),
        ("<rfilter type='blackmanharris'><float name='radius' value='-1'/></rfilter>", "scene::filter"),
    ] {
        assert!(codes(&film(inside)).contains(&code), "{inside}: {:?}", codes(&film(inside)));
    }
    // a huge film of which little is rendered
    let huge = "<integer name='width' value='1000000'/><integer name='height' value='1000000'/>
        <integer name='crop_width' value='64'/><integer name='crop_height' value='64'/>";
    assert!(read(&film(huge)).0.is_some());
}
