//! Mitsuba's format beyond its plugins: other files, parameters, names of old; and plugins that are nearly done.

use std::path::{Path, PathBuf};

use sr_import::{LoadOptions, load, load_str};
use sr_scene::{ColorInput, Diagnostics, Geometry, LightDesc, MaterialDesc, Rgb, SceneDesc, TextureDesc};

const SENSOR: &str = "<sensor type='perspective'><float name='fov' value='40'/></sensor>";

fn read_as(version: &str, body: &str) -> (Option<SceneDesc>, Diagnostics) {
    let text = format!("<scene version='{version}'>{SENSOR}{body}</scene>");
    load_str("test.xml", &text, Path::new(""), &LoadOptions::default())
}

fn read(body: &str) -> (Option<SceneDesc>, Diagnostics) {
    read_as("3.0.0", body)
}

/// What is said: codes and consequences.
fn said(d: &Diagnostics) -> Vec<String> {
    d.list.iter().map(|d| format!("{}: {}", d.code, d.consequence.as_deref().unwrap_or(""))).collect()
}

/// The material of the only shape.
fn material(bsdf: &str) -> (MaterialDesc, Vec<String>) {
    let (scene, d) = read(&format!("<shape type='sphere'>{bsdf}</shape>"));
    let scene = scene.unwrap_or_else(|| panic!("{}", d.render(false)));
    (scene.materials[scene.shapes[0].material.0 as usize].clone(), said(&d))
}

/// A folder of its own for files, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, files: &[(&str, &str)]) -> Self {
        let path = std::env::temp_dir().join(format!("sr_import-{name}-{}", std::process::id()));
        for (file, text) in files {
            let file = path.join(file);
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(file, text).unwrap();
        }
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A triangle as high as it says.
fn triangle(height: u32) -> String {
    format!("v 0 0 0\nv 1 0 0\nv 0 {height} 0\nf 1 2 3\n")
}

fn heights(scene: &SceneDesc) -> Vec<f32> {
    let height = |geometry: &Geometry| match geometry {
        Geometry::Mesh(mesh) => mesh.positions.iter().map(|p| p.y).fold(0.0, f32::max),
        _ => 0.0,
    };
    scene.shapes.iter().map(|shape| height(&shape.geometry)).collect()
}

#[test]
fn files_are_looked_for_beside_the_scene_then_where_it_says_then_where_the_user_says() {
    let mesh = |name: &str| format!("<shape type='obj'><string name='filename' value='{name}'/></shape>");
    let scene = format!(
        "<scene version='3.0.0'><path value='said'/>{SENSOR}<include filename='parts/part.xml'/>{}{}{}</scene>",
        mesh("a.obj"),
        mesh("b.obj"),
        mesh("c.obj")
    );
    let part = format!("<scene version='3.0.0'>{}</scene>", mesh("d.obj"));
    let (one, two, three, four) = (triangle(1), triangle(2), triangle(3), triangle(4));
    let folder = Folder::new(
        "search",
        &[
            ("in/scene.xml", &scene),
            ("in/parts/part.xml", &part),
            ("in/a.obj", &one),
            ("in/said/a.obj", &two),
            ("in/said/b.obj", &two),
            ("in/parts/d.obj", &three),
            ("user/a.obj", &four),
            ("user/b.obj", &four),
            ("user/c.obj", &four),
            ("user/d.obj", &four),
        ],
    );
    let path = folder.0.join("in/scene.xml");
    let options = LoadOptions { search_paths: vec![folder.0.join("user")], ..LoadOptions::default() };
    let (scene, d) = load(&path, &options);
    assert_eq!(d.render(false), "");
    assert_eq!(heights(&scene.unwrap()), [3.0, 1.0, 2.0, 4.0]);
    let (scene, d) = load(&path, &LoadOptions::default());
    assert!(scene.is_none());
    assert_eq!(said(&d), ["file::bad-mesh: "], "{}", d.render(false));
}

#[test]
fn pbrt_and_gltf_files_are_looked_for_where_the_user_says() {
    let gltf = "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],
        \"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],
        \"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],
        \"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"uri\":\"a.bin\",\"byteLength\":36}]}";
    let corners: Vec<u8> =
        [0.0f32, 0., 0., 1., 0., 0., 0., 5., 0.].into_iter().flat_map(f32::to_le_bytes).collect();
    let pbrt = "WorldBegin\nInclude \"part.pbrt\"\n";
    let folder = Folder::new(
        "search-others",
        &[
            ("in/a.gltf", gltf),
            ("in/a.pbrt", pbrt),
            ("user/part.pbrt", "Shape \"sphere\"\n"),
            ("user/a.bin", ""),
        ],
    );
    std::fs::write(folder.0.join("user/a.bin"), corners).unwrap();
    let options = LoadOptions { search_paths: vec![folder.0.join("user")], ..LoadOptions::default() };
    for name in ["in/a.gltf", "in/a.pbrt"] {
        let path = folder.0.join(name);
        assert_eq!(load(&path, &options).0.expect(name).shapes.len(), 1);
        assert!(load(&path, &LoadOptions::default()).0.is_none(), "{name}");
    }
}

#[test]
fn parameters_have_defaults_that_the_user_overrides() {
    let text = "<scene version='3.0.0'><default name='r' value='2'/><default name='kind' value='sphere'/>
        <shape type='$kind'><float name='radius' value='$r'/></shape></scene>";
    let radius = |defines: &[(&str, &str)]| {
        let defines = defines.iter().map(|(n, v)| (n.to_string(), v.to_string())).collect();
        let options = LoadOptions { defines, ..LoadOptions::default() };
        let (scene, d) = load_str("a.xml", text, Path::new(""), &options);
        let Geometry::Sphere { radius, .. } = scene.unwrap().shapes[0].geometry else { panic!() };
        (radius, d.list.iter().map(|d| d.code).filter(|code| code.starts_with("mitsuba")).collect::<Vec<_>>())
    };
    assert_eq!(radius(&[]), (2.0, vec![]));
    assert_eq!(radius(&[("r", "3.5")]), (3.5, vec![]));
    assert_eq!(radius(&[("radius", "3")]).1, ["mitsuba::unused-definition"]);
}

#[test]
fn emitters_can_be_hidden_also_inside_other_integrators() {
    for (integrator, hidden) in [
        ("<integrator type='path'/>", false),
        ("<integrator type='path'><boolean name='hide_emitters' value='true'/></integrator>", true),
        ("<integrator type='direct'><boolean name='hideEmitters' value='true'/></integrator>", true),
        (
            "<integrator type='moment'><integrator type='path'><boolean name='hide_emitters' value='true'/>
             </integrator></integrator>",
            true,
        ),
    ] {
        let (scene, _) = read(&format!("{integrator}<shape type='sphere'/>"));
        assert_eq!(scene.unwrap().settings.hide_emitters, hidden, "{integrator}");
    }
}

#[test]
fn integrators_that_converge_to_the_same_are_not_said_and_others_are() {
    let of = |kind: &str| {
        let depth = "<integer name='max_depth' value='7'/>";
        let (scene, d) =
            read(&format!("<integrator type='{kind}'>{depth}</integrator><shape type='sphere'/>"));
        (scene.unwrap().settings.max_depth, said(&d))
    };
    for kind in ["path", "volpath", "volpathmis", "ptracer", "prb", "bdpt"] {
        assert_eq!(of(kind), (Some(7), vec![]), "{kind}");
    }
    let path_is_used = "mitsuba::unsupported-plugin: the integrator \"path\" is used".to_owned();
    assert_eq!(of("depth").1, [path_is_used]);
    let inside = "<integrator type='aov'><string name='aovs' value='d:depth'/><integrator type='path'>
        <integer name='max_depth' value='3'/></integrator></integrator><shape type='sphere'/>";
    let (scene, d) = read(inside);
    assert_eq!(scene.unwrap().settings.max_depth, Some(3));
    let consequence = "the image of integrator \"path\" is, with its errors";
    assert_eq!(said(&d), [format!("mitsuba::unsupported-output: {consequence}")]);
}

#[test]
fn files_of_0_6_are_read_with_their_names() {
    let body = "<film type='ldrfilm'/><transform name='toWorld'>
        <lookAt origin='0, 0, 5' target='0, 0, 0' up='0, 1, 0'/></transform>";
    let scene = format!(
        "<scene version='0.6.0'><sensor type='perspective'><float name='fov' value='40'/>{body}</sensor>
         <bsdf type='plastic' id='red'><srgb name='diffuseReflectance' value='#ff0000'/></bsdf>
         <shape type='sphere'><ref id='red'/></shape>
         <emitter type='constant'><spectrum name='radiance' value='400:2 700:2'/></emitter></scene>"
    );
    let (scene, d) = load_str("a.xml", &scene, Path::new(""), &LoadOptions::default());
    assert_eq!(d.render(false), "");
    let scene = scene.unwrap();
    assert_eq!(scene.camera.world_from_camera.w_axis.z, 5.0);
    let MaterialDesc::Plastic { diffuse_reflectance, .. } =
        &scene.materials[scene.shapes[0].material.0 as usize]
    else {
        panic!()
    };
    assert_eq!(*diffuse_reflectance, ColorInput::Constant(Rgb::X));
    assert!(matches!(scene.lights[0], LightDesc::Constant { radiance, .. } if radiance.y > 1.5));
}

#[test]
fn what_0_6_had_and_is_gone_is_said() {
    let (_, d) =
        read_as("0.6.0", "<shape type='sphere'><bsdf type='phong'/></shape><emitter type='sunsky'/>");
    assert_eq!(
        said(&d),
        [
            "mitsuba::unsupported-plugin: a two-sided diffuse surface of reflectance 0.5 is shown instead",
            "mitsuba::sky-axis: up is +Z, as Mitsuba 3 reads it, turned by \"to_world\"",
        ]
    );
}

#[test]
fn polarization_is_said_and_what_it_does_to_plain_light_is_done() {
    let no = |consequence: &str| vec![format!("mitsuba::no-polarization: {consequence}")];
    for (kind, share, consequence) in [
        ("polarizer", 0.5, "half of the light passes"),
        ("circular", 0.5, "half of the light passes"),
        ("retarder", 1.0, "all light passes"),
    ] {
        let (desc, said) = material(&format!("<bsdf type='{kind}'><float name='theta' value='30'/></bsdf>"));
        let zero = ColorInput::Constant(Rgb::ZERO);
        let passes = ColorInput::Constant(Rgb::splat(share));
        let MaterialDesc::ThinDielectric { eta, specular_reflectance, specular_transmittance } = desc else {
            panic!("{kind}")
        };
        assert_eq!((eta, specular_reflectance, specular_transmittance), (1.0, zero, passes));
        assert_eq!(said, no(consequence), "{kind}");
    }
    let (desc, said) = material("<bsdf type='pplastic'><float name='alpha' value='0.3'/></bsdf>");
    assert!(matches!(desc, MaterialDesc::RoughPlastic { alpha: 0.3, nonlinear: false, .. }));
    assert_eq!(said, no("a roughplastic is shown instead, which is 6 to 9 % brighter"));
}

#[test]
fn merged_shapes_are_its_shapes() {
    let inner =
        "<shape type='merge'><shape type='disk'/><shape type='merge'><shape type='sphere'/></shape></shape>";
    let (scene, d) = read(&format!("<shape type='merge'>{inner}<shape type='sphere'/></shape>"));
    assert_eq!((scene.unwrap().shapes.len(), d.render(false).as_str()), (3, ""));
    let group = format!("<shape type='shapegroup' id='g'>{inner}</shape>");
    let (scene, _) = read(&format!("{group}<shape type='instance'><ref id='g'/></shape>"));
    assert_eq!(scene.unwrap().groups[0].shapes.len(), 2);
    let (scene, _) = read("<shape type='merge' id='m'><shape type='sphere'/><ref id='m'/></shape>");
    assert_eq!(scene.unwrap().shapes.len(), 1);
}

#[test]
fn area_emitters_may_be_described_elsewhere() {
    let emitter = "<emitter type='area' id='glow'><rgb name='radiance' value='1 2 3'/></emitter>";
    let (scene, d) = read(&format!("<shape type='sphere'><ref id='glow'/></shape>{emitter}"));
    let emission = scene.unwrap().shapes[0].emission.unwrap();
    assert_eq!(emission.radiance, ColorInput::Constant(Rgb::new(1.0, 2.0, 3.0)));
    assert_eq!(d.render(false), "");
    let (_, d) = read(&format!("<shape type='sphere'/>{emitter}"));
    assert_eq!(said(&d), ["mitsuba::unused-child: it lights nothing"]);
}

#[test]
fn constants_may_be_raw() {
    for (value, expected) in [
        ("<float name='value' value='0.25'/>", Rgb::splat(0.25)),
        ("<vector name='value' value='0.1 0.2 0.3'/>", Rgb::new(0.1, 0.2, 0.3)),
    ] {
        let texture = format!("<texture type='rawconstant' name='reflectance'>{value}</texture>");
        let (desc, said) = material(&format!("<bsdf type='diffuse'>{texture}</bsdf>"));
        let MaterialDesc::Diffuse { reflectance } = desc else { panic!() };
        assert_eq!(reflectance, ColorInput::Constant(expected));
        assert_eq!(said, [""; 0]);
    }
}

#[test]
fn axes_of_rotations_are_directions_which_is_said() {
    let rotate = |y: &str| {
        format!(
            "<shape type='cube'><transform name='to_world'><rotate y='{y}' z='0.8' angle='90'/></transform></shape>"
        )
    };
    let (_, d) = read(&rotate("0.6"));
    assert_eq!(d.render(false), "");
    let (scene, d) = read(&rotate("0.8"));
    let distortion = "only its direction counts; Mitsuba 3 distorts what it turns";
    assert_eq!(said(&d), [format!("mitsuba::rotation-axis: {distortion}")]);
    let Geometry::Mesh(cube) = &scene.unwrap().shapes[0].geometry else { panic!() };
    assert!(cube.positions.iter().all(|p| (p.length() - 3f32.sqrt()).abs() < 1e-5));
    assert_eq!(said(&read_as("0.6.0", &rotate("0.8")).1), [""; 0]);
}

#[test]
fn colors_of_vertices_under_mitsubas_names() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float color_0\nproperty float color_1\nproperty float color_2\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n";
    let folder = Folder::new("colors", &[("a.ply", ply)]);
    let body = format!(
        "<scene version='3.0.0'>{SENSOR}<shape type='ply'><string name='filename' value='a.ply'/>
         <bsdf type='diffuse'><texture type='mesh_attribute' name='reflectance'>
         <string name='name' value='vertex_color'/></texture></bsdf></shape></scene>"
    );
    let (scene, d) = load_str("a.xml", &body, &folder.0, &LoadOptions::default());
    assert_eq!(d.render(false), "");
    let scene = scene.unwrap();
    assert!(matches!(scene.textures[0], TextureDesc::MeshColor { .. }));
    let Geometry::Mesh(mesh) = &scene.shapes[0].geometry else { panic!() };
    assert_eq!(mesh.vertex_colors, [Rgb::X, Rgb::Y, Rgb::Z]);
}
