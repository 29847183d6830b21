//! Limits: what is beyond one is refused with its name, and with a higher one it loads.

use std::path::{Path, PathBuf};

use sr_import::{Limits, LoadOptions, load};
use sr_scene::{Diagnostics, SceneDesc};

fn scene(path: &Path, name: &str, most: u64) -> (Option<SceneDesc>, Diagnostics) {
    let mut limits = Limits::default();
    limits.set(name, most).unwrap();
    load(path, &LoadOptions { limits, ..LoadOptions::default() })
}

/// Files of a folder that is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn of(files: &[(&str, &[u8])]) -> Self {
        let folder = std::env::temp_dir().join(format!("sr_import-limits-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for (name, bytes) in files {
            std::fs::write(folder.join(name), bytes).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

const HEAD: &str = r#"<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"/>"#;
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n";
const STL: &str = "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nfacet\nvertex 1 0 0\n\
    vertex 1 1 0\nvertex 0 1 0\nendfacet\nendsolid\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n";
const CURVES: &str = "0 0 0 .1\n1 0 0 .1\n2 0 0 .1\n3 1 0 .1\n";
const PBRT: &str = "Camera \"perspective\" WorldBegin LightSource \"infinite\" Include \"ball.pbrt\" Include \"ball.pbrt\"\n\
    ObjectBegin \"o\" Shape \"sphere\" ObjectEnd ObjectInstance \"o\" ObjectInstance \"o\"\n";
const BALL: &str = "Shape \"sphere\" # ball\n";
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [2, 0, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}, "emissiveFactor": [1, 1, 1]}],
    "textures": [{"source": 0}], "images": [{"uri": "four.png"}],
    "extensionsUsed": ["KHR_materials_emissive_strength"],
    "buffers": [{"byteLength": 60, "uri": "mesh.bin"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}]}"#;

fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(4, 4, image::Rgb([9; 3]))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

fn gz(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

fn xml(body: &str) -> String {
    format!("{HEAD}{body}</scene>")
}

#[test]
fn what_is_beyond_a_limit_is_refused_by_name_and_loads_with_a_higher_one() {
    let file = |kind: &str, name: &str| {
        format!(r#"<shape type="{kind}"><string name="filename" value="{name}"/></shape>"#)
    };
    let image = r#"<shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
        <string name="filename" value="four.png"/></texture></bsdf></shape>"#;
    let group = r#"<shape type="shapegroup" id="g"><shape type="sphere"/></shape>
        <shape type="instance"><ref id="g"/></shape><shape type="instance"><ref id="g"/></shape>"#;
    let included = r#"<include filename="ball.xml"/><include filename="ball.xml"/>"#;
    let subdivided = "Camera \"perspective\" WorldBegin LightSource \"infinite\" Shape \"loopsubdiv\" \
        \"integer levels\" 1 \"integer indices\" [ 0 1 2 ] \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]\n";
    let corners: Vec<u8> = [0f32, 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 1.]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let (mesh, packed, curves) = (file("obj", "a.obj"), file("obj", "b.obj"), file("bsplinecurve", "a.txt"));
    let folder = Folder::of(&[
        ("a.obj", OBJ.as_bytes()),
        ("b.obj", &gz(OBJ.as_bytes())),
        ("a.stl", STL.as_bytes()),
        ("a.ply", PLY.as_bytes()),
        ("a.txt", CURVES.as_bytes()),
        ("mesh.xml", xml(&mesh).as_bytes()),
        ("packed.xml", xml(&packed).as_bytes()),
        ("curves.xml", xml(&curves).as_bytes()),
        ("image.xml", xml(image).as_bytes()),
        ("group.xml", xml(group).as_bytes()),
        ("include.xml", xml(included).as_bytes()),
        ("ball.xml", br#"<scene version="3.0.0"><shape type="sphere"/></scene>"#),
        ("four.png", &png()),
        ("a.pbrt", PBRT.as_bytes()),
        ("ball.pbrt", BALL.as_bytes()),
        ("fine.pbrt", subdivided.as_bytes()),
        ("a.gltf", GLTF.as_bytes()),
        ("mesh.bin", &corners),
    ]);
    // The highest limit that is too low for the file.
    for (name, limit, too_low) in [
        ("a.obj", "file_bytes", OBJ.len() - 1),
        ("mesh.xml", "file_bytes", OBJ.len() - 1),
        ("image.xml", "file_bytes", png().len() - 1),
        ("a.gltf", "file_bytes", GLTF.len() - 1),
        ("mesh.xml", "scene_bytes", xml(&mesh).len() - 1),
        ("a.pbrt", "scene_bytes", PBRT.len() - 1),
        ("a.gltf", "scene_bytes", GLTF.len() - 1),
        ("packed.xml", "unpacked_bytes", OBJ.len() - 1),
        ("a.pbrt", "included_bytes", 2 * BALL.len() - 1),
        ("include.xml", "mitsuba_includes", 1),
        ("a.pbrt", "pbrt_includes", 1),
        ("image.xml", "image_texels", 15),
        ("a.gltf", "image_texels", 15),
        ("a.obj", "mesh_elements", 3),
        ("a.ply", "mesh_elements", 3),
        ("a.stl", "mesh_elements", 1),
        ("curves.xml", "mesh_elements", 3),
        ("fine.pbrt", "subdivided_faces", 3),
        ("group.xml", "mitsuba_instances", 1),
        ("a.pbrt", "pbrt_instances", 1),
        ("mesh.xml", "xml_nodes", 4),
        ("a.gltf", "gltf_values", 60),
        ("a.gltf", "gltf_numbers", 14),
        ("a.gltf", "gltf_triangles", 1),
        ("a.gltf", "gltf_texels", 15),
    ] {
        let path = folder.path(name);
        let (_, diagnostics) = scene(&path, limit, too_low as u64);
        let text = diagnostics.render(false);
        assert!(diagnostics.has_errors(), "{name} loads with {limit} = {too_low}\n{text}");
        assert!(
            text.contains(&format!("(--limit {limit}=N or limits={{\"{limit}\": N}} raises this limit)")),
            "{text}"
        );
        let (found, diagnostics) = scene(&path, limit, 2 * too_low as u64 + 2);
        assert!(found.is_some(), "{name} with {limit}: {}", diagnostics.render(false));
    }
}

/// After a change of the limits, put there what this prints.
#[test]
fn the_documentation_has_all_limits() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/import.md");
    let table = Limits::table();
    assert!(std::fs::read_to_string(page).unwrap().contains(&table), "docs/import.md lacks this:\n{table}");
}
