//! glTF: meshes that are packed by Draco and by meshopt. The bytes are of the encoders that their authors publish: a net of
//! 3 × 3 vertices at (x, y, x y / 4), with the coordinates (x / 2, y / 2).

use std::fmt::Write;
use std::path::Path;

use glam::{Vec2, Vec3};
use sr_import::{LoadOptions, load_str};
use sr_scene::{Diagnostics, Geometry, MeshDesc, SceneDesc};

fn read(json: &str) -> (Option<SceneDesc>, Diagnostics) {
    load_str("test.gltf", json, Path::new(""), &LoadOptions::default())
}

fn codes(diagnostics: &Diagnostics) -> Vec<&'static str> {
    diagnostics.list.iter().map(|d| d.code).collect()
}

const USUAL: [&str; 2] = ["scene::no-light", "scene::no-camera"];

fn bytes(hex: &str) -> Vec<u8> {
    let digits = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).unwrap();
    (0..hex.len()).step_by(2).map(digits).collect()
}

/// A buffer of bytes as a part of a file.
fn buffer(bytes: &[u8]) -> String {
    let mut uri = String::from("data:application/octet-stream,");
    bytes.iter().for_each(|b| write!(uri, "%{b:02x}").unwrap());
    format!(r#"{{"byteLength": {}, "uri": "{uri}"}}"#, bytes.len())
}

fn mesh(scene: &SceneDesc) -> &MeshDesc {
    let Geometry::Mesh(mesh) = &scene.shapes[0].geometry else { panic!() };
    mesh
}

/// Draco's, quantized to 10 bits: positions (number 3), coordinates (1), normals (2) and colors as bytes (0).
const EDGEBREAKER: &str = "\
    445241434f0202010100000009080308010003efd31aff0111ff028840ff028840ff02884004000000010000020000ff00000102020401\
    00010103090201010001010903000200010009030003020101010103cd018d335505c901ff8bc901c7c901c7c90107a4696a23b6825d00\
    000000ff0000000000003f0000003f000000000000803f000000000000003f0000003f0000000000000000000000000000803f00000000\
    0000803f0000003f0000003f0000803f0000803f0000803f00000000000000000000803f00000000000000000000803f00000000000000\
    000000803f00000000000000000000803f00000000000000000000803f00000000000000000000803f00000000000000000000803f0000\
    0000000000000000803f00000000000000000000803f010101010380082d216102fffffff37d091d07ffffffffffffffffffffffef6102\
    61021d070aecd2677ce4b7a386ae8000000000ff030000000000000000000000000000000000400a";
const SEQUENTIAL: &str = "\
    445241434f0202010000000809010001030104030102040205040304060407060405070508070104020204010003090201010109030002\
    000903000301000002000101010135392e9103bf1d07031d0708d50f55c818e9eb8d00000000ff00000000000000000000000000003f00\
    0000000000803f00000000000000000000003f0000003f0000003f0000803f0000003f000000000000803f0000003f0000803f0000803f\
    0000803f00000000000000000000803f00000000000000000000803f00000000000000000000803f00000000000000000000803f000000\
    00000000000000803f00000000000000000000803f00000000000000000000803f00000000000000000000803f00000000000000000000\
    803f000101000b031d071fe5380304e085f81f0000fc07000001fe07e07f0000f21f008004f0ffbfff0100d07f00000400000000ff0300\
    00000000000000000000000000000000400a";

/// A file of one primitive that Draco packed, with its count of indices and the number of the positions.
fn draco(packed: &[u8], indices: usize, positions: u32) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsRequired": ["KHR_draco_mesh_compression"],
        "buffers": [{}], "bufferViews": [{{"buffer": 0, "byteLength": {}}}],
        "accessors": [{{"componentType": 5126, "count": 9, "type": "VEC3"}},
            {{"componentType": 5125, "count": {indices}, "type": "SCALAR"}},
            {{"componentType": 5126, "count": 9, "type": "VEC2"}}, {{"componentType": 5126, "count": 9, "type": "VEC3"}},
            {{"componentType": 5121, "normalized": true, "count": 9, "type": "VEC4"}}],
        "meshes": [{{"primitives": [{{"indices": 1, "attributes": {{"POSITION": 0, "TEXCOORD_0": 2, "NORMAL": 3,
            "COLOR_0": 4}}, "extensions": {{"KHR_draco_mesh_compression": {{"bufferView": 0, "attributes":
            {{"POSITION": {positions}, "TEXCOORD_0": 1, "NORMAL": 2, "COLOR_0": 0}}}}}}}}]}}], "nodes": [{{"mesh": 0}}]}}"#,
        buffer(packed),
        packed.len(),
    )
}

/// The numbers of the triangles' corners, by where they are, however the vertices are counted.
fn check_net(mesh: &MeshDesc, tolerance: f32) {
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (9, 8));
    for (at, p) in mesh.positions.iter().enumerate() {
        let cell = p.truncate().round();
        let position = cell.extend(0.25 * cell.x * cell.y);
        assert!(p.distance(position) < tolerance, "{p}");
        assert_eq!(mesh.uvs[at], Vec2::new(0.5 * cell.x, 1.0 - 0.5 * cell.y));
    }
    let cell = |corner: &u32| mesh.positions[*corner as usize].truncate().round();
    for t in &mesh.triangles {
        let [a, b, c] = [cell(&t[0]), cell(&t[1]), cell(&t[2])];
        assert_eq!((b - a).perp_dot(c - a), 1.0, "{t:?}");
    }
    let area: f32 = mesh.triangles.iter().map(|_| 0.5).sum();
    assert_eq!(area, 4.0);
}

#[test]
fn draco_by_both_of_its_methods() {
    for packed in [EDGEBREAKER, SEQUENTIAL] {
        let (scene, diagnostics) = read(&draco(&bytes(packed), 24, 3));
        // Colors of opacity 255 alone say nothing about opacity.
        assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
        let scene = scene.unwrap();
        check_net(mesh(&scene), 2e-3);
        assert_eq!(mesh(&scene).normals, [Vec3::Z; 9]);
        let has_color = |green: f32| mesh(&scene).vertex_colors.contains(&Vec3::new(1.0, 0.0, green));
        assert!(has_color(0.0) && has_color(204.0 / 255.0), "{:?}", mesh(&scene).vertex_colors);
    }
}

#[test]
fn draco_that_is_broken_is_an_error() {
    let good = bytes(EDGEBREAKER);
    let fails = |json: &str, words: &str| {
        let (scene, diagnostics) = read(json);
        assert!(scene.is_none());
        let text = diagnostics.render(false);
        assert!(codes(&diagnostics).contains(&"gltf::draco") && text.contains(words), "{text}");
    };
    fails(&draco(&good, 3, 3), "over the caller's ceiling of 1");
    fails(&draco(&good, 24, 9), "no attribute 9");
    fails(&draco(&good, 24, 1), "has 2 numbers for each vertex");
    fails(&draco(&good[..100], 24, 3), "cannot be read");
    fails(&draco(b"DRACO", 24, 3), "cannot be read");
    // Whatever becomes of a changed byte, it is a mesh or an error.
    for at in 0..good.len() {
        for change in [1, 0x80, 0xff] {
            let mut broken = good.clone();
            broken[at] ^= change;
            let (scene, diagnostics) = read(&draco(&broken, 24, 3));
            assert!(scene.is_some() || !diagnostics.list.is_empty(), "byte {at}");
        }
    }
}

const POSITIONS: &str = "a00000013cf3c000ffffffffffff013bef80007e7f7e7f7e000001030c0000ffff01030800007e00000100f0\
    c000ffffff0100ef00007c7d7e0000000000000000000000000000000000000000000000000000000000000000";
const TRIANGLES: &str = "e1fe1e100e4e1e120e0f06007687566778a9866589689801690000";
const INDICES: &str = "d1000408060c02060408060c02020408060c02060408060c0200000000";
/// (0.6, 0, 0.8), and in the middle (0, 0, -1).
const NORMALS: &str =
    "a00100f0000092910100f00000fefd00000000000000000000000000000000000000000000000000000000000036007f00";
const COORDINATES: &str = "a0000133cf0000403f403f400001092480000001030000004000010008000000000000000000000000\
    0000000000000000000000000000000000f2000000f2";
/// No turn, and a quarter of one about Z.
const ROTATIONS: &str = "a001100000000130000000fe00000000011000000000000000000000000000000000000000000000000000\
    000000000000000000ff7f";

/// A file whose views are packed by meshopt; `mode` is of the indices.
fn meshopt(indices: &[u8], mode: &str, positions: &[u8]) -> String {
    let views: [(&[u8], &str, usize, usize, &str); 5] = [
        (positions, "ATTRIBUTES", 9, 12, "NONE"),
        (indices, mode, 24, 2, "NONE"),
        (&bytes(NORMALS), "ATTRIBUTES", 9, 4, "OCTAHEDRAL"),
        (&bytes(COORDINATES), "ATTRIBUTES", 9, 8, "EXPONENTIAL"),
        (&bytes(ROTATIONS), "ATTRIBUTES", 2, 8, "QUATERNION"),
    ];
    let (mut all, mut list) = (Vec::new(), Vec::new());
    for (bytes, mode, count, stride, filter) in views {
        let (start, length) = (all.len(), bytes.len());
        list.push(format!(
            r#"{{"buffer": 1, "byteLength": {}, "extensions": {{"EXT_meshopt_compression": {{"buffer": 0,
            "byteOffset": {start}, "byteLength": {length}, "byteStride": {stride}, "count": {count}, "mode": "{mode}",
            "filter": "{filter}"}}}}}}"#,
            count * stride
        ));
        all.extend(bytes);
    }
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsRequired": ["EXT_meshopt_compression"],
        "buffers": [{}, {{"byteLength": 999, "extensions": {{"EXT_meshopt_compression": {{"fallback": true}}}}}}],
        "bufferViews": [{}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 9, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5123, "count": 24, "type": "SCALAR"}},
            {{"bufferView": 2, "componentType": 5120, "normalized": true, "count": 9, "type": "VEC3"}},
            {{"bufferView": 3, "componentType": 5126, "count": 9, "type": "VEC2"}},
            {{"bufferView": 4, "componentType": 5122, "normalized": true, "count": 2, "type": "VEC4"}}],
        "meshes": [{{"primitives": [{{"indices": 1, "attributes": {{"POSITION": 0, "NORMAL": 2, "TEXCOORD_0": 3}}}}]}}],
        "nodes": [{{"mesh": 0}}, {{"mesh": 0, "extensions": {{"EXT_mesh_gpu_instancing": {{"attributes":
            {{"ROTATION": 4}}}}}}}}]}}"#,
        buffer(&all),
        list.join(",")
    )
}

#[test]
fn meshopt_by_all_of_its_modes_and_filters() {
    for (indices, mode) in [(TRIANGLES, "TRIANGLES"), (INDICES, "INDICES")] {
        let (scene, diagnostics) = read(&meshopt(&bytes(indices), mode, &bytes(POSITIONS)));
        assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
        let scene = scene.unwrap();
        let Geometry::Mesh(mesh) = &scene.groups[0].shapes[0].geometry else { panic!() };
        check_net(mesh, 0.0_f32.next_up());
        for (at, normal) in mesh.normals.iter().enumerate() {
            let expected = if at == 4 { Vec3::NEG_Z } else { Vec3::new(0.6, 0.0, 0.8) };
            assert!(normal.distance(expected) < 0.01, "{normal}");
        }
        assert_eq!(scene.instances.len(), 3);
        let x = |at: usize| scene.instances[at].world_from_group.transform_vector3(Vec3::X);
        assert!(x(1).distance(Vec3::X) < 1e-4 && x(2).distance(Vec3::Y) < 1e-4, "{} {}", x(1), x(2));
    }
}

#[test]
fn meshopt_that_is_broken_is_an_error() {
    let (triangles, positions) = (bytes(TRIANGLES), bytes(POSITIONS));
    let fails = |json: &str, words: &str| {
        let (scene, diagnostics) = read(json);
        assert!(scene.is_none());
        let text = diagnostics.render(false);
        assert!(codes(&diagnostics).contains(&"gltf::meshopt") && text.contains(words), "{text}");
    };
    let good = meshopt(&triangles, "TRIANGLES", &positions);
    fails(&meshopt(&triangles, "INDICES", &positions), "begins with the byte 0xe1");
    fails(&meshopt(&triangles, "STRIPS", &positions), "its mode \"STRIPS\"");
    fails(&meshopt(&triangles[..20], "TRIANGLES", &positions), "");
    fails(&meshopt(&triangles, "TRIANGLES", &positions[..40]), "it is cut off");
    fails(&meshopt(&triangles, "TRIANGLES", &[&[0xa1], &positions[1..]].concat()), "version 1 of the codec");
    fails(&good.replace("OCTAHEDRAL", "CUBE"), "its filter \"CUBE\"");
    fails(&good.replace(r#""count": 9, "mode""#, r#""count": 900000, "mode""#), "are too few for 900000");
    fails(&good.replace(r#""count": 9, "mode""#, r#""count": 4000000000, "mode""#), "too many numbers");
    fails(&good.replace(r#""byteStride": 12"#, r#""byteStride": 13"#), "a stride of 13");
    fails(&good.replace(r#""buffer": 0,"#, r#""buffer": 7,"#), "");
    for (at, change) in (0..triangles.len()).flat_map(|at| [(at, 1), (at, 0x40), (at, 0xff)]) {
        let mut broken = triangles.clone();
        broken[at] ^= change;
        let (scene, diagnostics) = read(&meshopt(&broken, "TRIANGLES", &positions));
        assert!(scene.is_some() || !diagnostics.list.is_empty(), "byte {at}");
    }
}
