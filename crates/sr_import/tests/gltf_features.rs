//! glTF: what bends, repeats and replaces meshes, and what extensions make of materials; small files of our own.

use std::fmt::Write;
use std::path::Path;

use glam::{Vec2, Vec3};
use sr_import::{LoadOptions, load_str};
use sr_scene::{
    ColorInput, Diagnostics, Geometry, LightDesc, MaterialDesc, MeshDesc, MetallicRoughnessDesc, Pixels, Rgb,
    ScalarInput, SceneDesc, TextureDesc,
};

fn read(json: &str) -> (Option<SceneDesc>, Diagnostics) {
    load_str("test.gltf", json, Path::new(""), &LoadOptions::default())
}

fn codes(diagnostics: &Diagnostics) -> Vec<&'static str> {
    diagnostics.list.iter().map(|d| d.code).collect()
}

/// A data URI of bytes.
fn uri(bytes: &[u8]) -> String {
    let mut out = String::from("data:application/octet-stream,");
    bytes.iter().for_each(|b| write!(out, "%{b:02x}").unwrap());
    out
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// A triangle at (0, 0, 0), (1, 0, 0), (0, 1, 0) as accessor 0; `arrays` are the views from 1 on.
fn file(arrays: &[Vec<u8>], accessors: &str, rest: &str) -> String {
    let mut bytes = floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    let mut views = String::from(r#"{"buffer": 0, "byteLength": 36}"#);
    for array in arrays {
        let (start, length) = (bytes.len(), array.len());
        write!(views, r#", {{"buffer": 0, "byteOffset": {start}, "byteLength": {length}}}"#).unwrap();
        bytes.extend(array);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}, "uri": "{}"}}], "bufferViews": [{views}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}{accessors}], {rest}}}"#,
        bytes.len(),
        uri(&bytes)
    )
}

fn mesh(scene: &SceneDesc) -> &MeshDesc {
    let Geometry::Mesh(mesh) = &scene.shapes[0].geometry else { panic!() };
    mesh
}

const USUAL: [&str; 2] = ["scene::no-light", "scene::no-camera"];

#[test]
fn morph_targets_stand_as_their_weights_say() {
    let up = floats(&[0., 0., 2., 0., 0., 0., 0., 0., 0.]);
    let right = floats(&[0., 0., 0., 4., 0., 0., 0., 0., 0.]);
    let accessors = r#", {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3"}"#;
    let json = |node: &str| {
        let rest = format!(
            r#""meshes": [{{"weights": [0.5, 0.25], "primitives": [{{"attributes": {{"POSITION": 0}},
            "targets": [{{"POSITION": 1}}, {{"POSITION": 2}}]}}]}}], "nodes": [{{"mesh": 0{node}}}]"#
        );
        file(&[up.clone(), right.clone()], accessors, &rest)
    };
    let (scene, diagnostics) = read(&json(""));
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
    let positions = [Vec3::Z, Vec3::new(2.0, 0.0, 0.0), Vec3::Y];
    assert_eq!(mesh(&scene.unwrap()).positions, positions);
    // A node's own weights go before the mesh's.
    let (scene, _) = read(&json(r#", "weights": [1, 0]"#));
    assert_eq!(mesh(&scene.unwrap()).positions, [2.0 * Vec3::Z, Vec3::X, Vec3::Y]);
}

#[test]
fn skins_move_vertices_with_their_joints() {
    let joints = vec![0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0];
    let weights = floats(&[0.5, 0.5, 0., 0., 1., 0., 0., 0., 1., 0., 0., 0.]);
    // The second joint was bound at x = 1.
    let mut bind = glam::Mat4::IDENTITY.to_cols_array().to_vec();
    bind.extend(glam::Mat4::from_translation(Vec3::NEG_X).to_cols_array());
    let accessors = r#", {"bufferView": 1, "componentType": 5121, "count": 3, "type": "VEC4"},
        {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC4"},
        {"bufferView": 3, "componentType": 5126, "count": 2, "type": "MAT4"}"#;
    let rest = r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": 3}],
        "nodes": [{"mesh": 0, "skin": 0, "translation": [9, 9, 9]}, {"children": [2]}, {"translation": [1, 0, 2]}]"#;
    let (scene, diagnostics) = read(&file(&[joints, weights, floats(&bind)], accessors, rest));
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
    // The node's own place does not count. The second joint has moved up by 2 since.
    let positions = [Vec3::Z, Vec3::new(1.0, 0.0, 2.0), Vec3::Y];
    assert_eq!(mesh(&scene.unwrap()).positions, positions);
}

#[test]
fn sparse_accessors_replace_rows() {
    let arrays = [vec![2u8, 0], floats(&[0., 3., 0.])];
    let accessors = r#", {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 1,
        "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 2}}}"#;
    let rest = r#""meshes": [{"primitives": [{"attributes": {"POSITION": 1}}]}], "nodes": [{"mesh": 0}]"#;
    let json = file(&arrays, accessors, rest);
    let (scene, diagnostics) = read(&json);
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
    assert_eq!(mesh(&scene.unwrap()).positions, [Vec3::ZERO, Vec3::X, 3.0 * Vec3::Y]);
    let arrays = [vec![3u8, 0], floats(&[0., 3., 0.])];
    let (_, diagnostics) = read(&file(&arrays, accessors, rest));
    assert!(codes(&diagnostics).contains(&"gltf::bad-accessor"));
}

#[test]
fn instances_of_a_mesh() {
    let moved = floats(&[1., 0., 0., 0., 2., 0.]);
    let scaled = floats(&[1., 1., 1., 3., 3., 3.]);
    let accessors = r#", {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"},
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}"#;
    let rest = r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0,
        "translation": [0, 0, 1], "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1,
        "SCALE": 2}}}}]"#;
    let (scene, diagnostics) = read(&file(&[moved, scaled], accessors, rest));
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
    let scene = scene.unwrap();
    assert_eq!(scene.instances.len(), 2);
    let placed = |at: usize| scene.instances[at].world_from_group.transform_point3(Vec3::X);
    assert_eq!((placed(0), placed(1)), (Vec3::new(2.0, 0.0, 1.0), Vec3::new(3.0, 2.0, 1.0)));
}

/// The scene of a triangle of a material, with images of one texel: the first is red 51, green 102, blue 255, alpha 128.
fn covered(material: &str) -> (SceneDesc, Diagnostics) {
    let image =
        uri(b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n\x33\x66\xff\x80");
    let rest = format!(
        r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "material": 0}}]}}], "nodes": [{{"mesh": 0}}],
        "images": [{{"uri": "{image}"}}], "textures": [{{"source": 0}}], "materials": [{material}]"#
    );
    let coordinates = floats(&[0., 0., 1., 0., 0., 1.]);
    let accessors = r#", {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}"#;
    let (scene, diagnostics) = read(&file(&[coordinates], accessors, &rest));
    let scene = scene.unwrap_or_else(|| panic!("{}", diagnostics.render(false)));
    (scene, diagnostics)
}

fn metallic_roughness(scene: &SceneDesc) -> MetallicRoughnessDesc {
    let found = scene.materials.iter().find_map(|material| match material {
        MaterialDesc::MetallicRoughness(m) => Some(*m),
        _ => None,
    });
    found.expect("a metallic-roughness material")
}

#[test]
fn textures_take_the_coordinates_that_they_name() {
    let (first, second) = (floats(&[0., 0., 1., 0., 0., 1.]), floats(&[0.5, 0.25, 0.5, 0.5, 0.75, 1.0]));
    let accessors = r#", {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
        {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"}"#;
    let image =
        uri(b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n\x33\x66\xff\x80");
    let with = |attributes: &str, material: &str| {
        let rest = format!(
            r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, {attributes}}}, "material": 0}}]}}],
            "nodes": [{{"mesh": 0}}], "images": [{{"uri": "{image}"}}], "textures": [{{"source": 0}}],
            "materials": [{material}]"#
        );
        let (scene, diagnostics) = read(&file(&[first.clone(), second.clone()], accessors, &rest));
        (scene.unwrap_or_else(|| panic!("{}", diagnostics.render(false))), diagnostics)
    };
    let both = r#""TEXCOORD_0": 1, "TEXCOORD_1": 2"#;
    let (scene, diagnostics) = with(
        both,
        r#"{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0, "texCoord": 1}}"#,
    );
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
    let upright = |uvs: &[f32]| -> Vec<Vec2> { uvs.chunks(2).map(|c| Vec2::new(c[0], 1.0 - c[1])).collect() };
    let (first, second) = (upright(&[0., 0., 1., 0., 0., 1.]), upright(&[0.5, 0.25, 0.5, 0.5, 0.75, 1.0]));
    assert_eq!(mesh(&scene).uvs, first);
    assert_eq!(mesh(&scene).further_uvs[..], *std::slice::from_ref(&second));
    let ColorInput::Texture(emitted) = scene.shapes[0].emission.unwrap().radiance else { panic!() };
    assert!(matches!(scene.textures[emitted.0 as usize], TextureDesc::OtherUvs { set: 1, .. }));
    let ColorInput::Texture(base) = metallic_roughness(&scene).base_color else { panic!() };
    assert!(matches!(scene.textures[base.0 as usize], TextureDesc::Bitmap { .. }));
    // Tangents follow the coordinates of the normals, which become the first; a transform may name another set.
    let (scene, diagnostics) = with(
        both,
        r#"{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 0, "texCoord": 0,
        "extensions": {"KHR_texture_transform": {"texCoord": 1}}}}"#,
    );
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
    assert_eq!((&mesh(&scene).uvs, &mesh(&scene).further_uvs[..]), (&second, &[first][..]));
    let ColorInput::Texture(base) = metallic_roughness(&scene).base_color else { panic!() };
    assert!(matches!(scene.textures[base.0 as usize], TextureDesc::OtherUvs { set: 1, .. }));
    // One set only, which need not be the first.
    let base = r#"{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}}}"#;
    let (scene, _) = with(both, base);
    assert_eq!((&mesh(&scene).uvs, mesh(&scene).further_uvs.len()), (&second, 0));
    let (_, diagnostics) = with(r#""TEXCOORD_0": 1"#, base);
    assert!(codes(&diagnostics).contains(&"gltf::no-coordinates"));
}

#[test]
fn variants_choose_materials() {
    let rest = |second: &str| {
        format!(
            r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 0, "extensions":
            {{"KHR_materials_variants": {{"mappings": [{{"material": 1, "variants": [0, 2]}}]}}}}}}]}}],
            "nodes": [{{"mesh": 0}}], "materials": [{{"pbrMetallicRoughness": {{"baseColorFactor": [1, 0, 0, 1]}}}},
            {{"pbrMetallicRoughness": {{"baseColorFactor": [0, 0, 1, 1]}}}}], "extensions": {{"KHR_materials_variants":
            {{"variants": [{{"name": "blue"}}, {{"name": "{second}"}}, {{"name": "also blue"}}]}}}}"#
        )
    };
    let with = |variant: Option<&str>| {
        let options = LoadOptions { variant: variant.map(str::to_owned), ..LoadOptions::default() };
        load_str("test.gltf", &file(&[], "", &rest("red")), Path::new(""), &options)
    };
    let (red, blue) = (Rgb::X, Rgb::Z);
    for (variant, color) in [(None, red), (Some("blue"), blue), (Some("red"), red), (Some("also blue"), blue)]
    {
        let (scene, diagnostics) = with(variant);
        assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
        let scene = scene.unwrap();
        assert_eq!(metallic_roughness(&scene).base_color, ColorInput::Constant(color), "{variant:?}");
        assert_eq!(scene.variants, ["blue", "red", "also blue"]);
    }
    let (scene, diagnostics) = with(Some("bleu"));
    assert!(scene.is_none());
    let error = &diagnostics.list[0];
    assert_eq!(error.code, "scene::unknown-variant");
    let message = "no variant is called \"bleu\": there are \"blue\", \"red\", \"also blue\"";
    assert_eq!(error.message, message);
    assert_eq!(error.hint.as_deref(), Some("did you mean \"blue\"?"));
    let options = LoadOptions { variant: Some("blue".into()), ..LoadOptions::default() };
    let (scene, diagnostics) = load_str("a.xml", "<scene version=\"3.0.0\"/>", Path::new(""), &options);
    assert!(scene.is_none());
    assert!(diagnostics.list.iter().any(|d| d.message.ends_with("the scene has no variants")));
}

#[test]
fn light_around_a_scene() {
    // Sides of one texel, sRGB 188, which is half: red, green and so on; the last is four times as bright, by its opacity.
    let side = |r: u8, g: u8, b: u8, a: u8| {
        let mut bytes = b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n".to_vec();
        bytes.extend([r, g, b, a]);
        format!(r#"{{"uri": "{}"}}"#, uri(&bytes))
    };
    let sides = [side(255, 0, 0, 255), side(0, 255, 0, 255), side(0, 0, 255, 255)];
    let sides =
        [&sides[..], &[side(255, 255, 0, 255), side(0, 255, 255, 255), side(255, 255, 255, 64)]].concat();
    let json = |faces: &str| {
        let rest = format!(
            r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}], "nodes": [{{"mesh": 0}}],
            "images": [{}], "scenes": [{{"nodes": [0], "extensions": {{"EXT_lights_image_based": {{"light": 0}}}}}}],
            "extensions": {{"EXT_lights_image_based": {{"lights": [{{"intensity": 2, "rotation": [0, 1, 0, 0],
            "specularImageSize": 1, "specularImages": [{faces}]}}]}}}}"#,
            sides.join(",")
        );
        file(&[], "", &rest)
    };
    let (scene, diagnostics) = read(&json("[0, 1, 2, 3, 4, 5]"));
    assert_eq!(codes(&diagnostics), ["scene::no-camera"], "{}", diagnostics.render(false));
    let scene = scene.unwrap();
    let LightDesc::Environment { image, scale: 2.0, world_from_light, .. } = &scene.lights[0] else {
        panic!()
    };
    assert!((*world_from_light * Vec3::X).distance(Vec3::NEG_X) < 1e-6);
    let image = &scene.images[*image as usize];
    let Pixels::F32 { data, .. } = &image.pixels else { panic!() };
    // Latitude and longitude: rows up and down; columns between -Z and +X, +X and +Z, and so on.
    assert_eq!((image.width, image.height), (4, 2));
    assert_eq!((&data[..3], &data[12..15]), (&[0.0, 0.0, 1.0][..], &[1.0, 1.0, 0.0][..]));
    let (scene, diagnostics) = read(&json("[0, 1, 2]"));
    assert!(scene.is_some());
    assert!(codes(&diagnostics).contains(&"gltf::image-based-light"));
    let (scene, _) = read(&json("[0, 1, 2, 3, 4, 9]"));
    assert!(scene.is_none());
}

/// A triangle with a texture of an image, and what an image's extension or the file says besides.
fn textured(images: &str, textures: &str, rest: &str) -> String {
    let coordinates = floats(&[0., 0., 1., 0., 0., 1.]);
    let accessors = r#", {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}"#;
    let rest = format!(
        r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "material": 0}}]}}],
        "nodes": [{{"mesh": 0}}], "materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}}}}],
        "images": [{images}], "textures": [{textures}]{rest}"#
    );
    file(&[coordinates], accessors, &rest)
}

#[test]
fn webp_goes_before_the_image_for_others() {
    // Two texels of (200, 100, 50), lossless.
    let webp = "UklGRh4AAABXRUJQVlA4TBEAAAAvAQAAAAdQsiJXpv+BiOh/AAA=";
    let images = format!(r#"{{"uri": "absent.png"}}, {{"uri": "data:image/webp;base64,{webp}"}}"#);
    let texture = r#"{"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}"#;
    let (scene, diagnostics) = read(&textured(&images, texture, ""));
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
    let image = &scene.unwrap().images[0];
    let Pixels::U8 { channels: 3, data } = &image.pixels else { panic!() };
    assert_eq!((image.width, image.height, &data[..3]), (2, 1, &[200, 100, 50][..]));
}

#[test]
fn images_have_a_budget_by_their_headers() {
    // Each has 2^28 texels by its header; three have more than are allowed, and none is there.
    let image = format!(r#"{{"uri": "{}"}}"#, uri(b"P5 16384 16384 255\n"));
    let textures = r#"{"source": 0}, {"source": 1}, {"source": 2}"#;
    let (scene, diagnostics) = read(&textured(&vec![image; 3].join(","), textures, ""));
    assert!(scene.is_none());
    let over = diagnostics.list.iter().filter(|d| d.message.contains("more than 536870912 pixels"));
    assert_eq!(over.count(), 1, "{}", diagnostics.render(false));
}

#[test]
fn quantized_attributes() {
    let positions: Vec<u8> =
        [0i16, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let normals = [0i8, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0].map(i8::cast_unsigned).to_vec();
    let coordinates = [0u8, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0].to_vec();
    let accessors = r#", {"bufferView": 1, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3"},
        {"bufferView": 2, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
        {"bufferView": 3, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC2"}"#;
    let rest = r#""extensionsRequired": ["KHR_mesh_quantization"], "meshes": [{"primitives": [{"attributes":
        {"POSITION": 1, "NORMAL": 2, "TEXCOORD_0": 3}}]}], "nodes": [{"mesh": 0, "scale": [2, 2, 2]}]"#;
    let json = file(&[positions, normals, coordinates], accessors, rest);
    // Rows begin at multiples of four bytes, or of eight.
    let json = json.replace(r#""byteLength": 24}"#, r#""byteLength": 24, "byteStride": 8}"#);
    let json = json.replace(r#""byteLength": 12}"#, r#""byteLength": 12, "byteStride": 4}"#);
    let (scene, diagnostics) = read(&json);
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
    let scene = scene.unwrap();
    assert_eq!(mesh(&scene).positions, [Vec3::ZERO, 2.0 * Vec3::X, -2.0 * Vec3::Y]);
    assert_eq!(mesh(&scene).normals, [Vec3::Z; 3]);
    assert_eq!(mesh(&scene).uvs, [Vec2::Y, Vec2::ONE, Vec2::ZERO]);
}

#[test]
fn metadata_says_nothing_about_the_picture() {
    let packets = r#""extensionsUsed": ["KHR_xmp_json_ld"], "extensions": {"KHR_xmp_json_ld": {"packets":
        [{"@context": {"dc": "http://purl.org/dc/elements/1.1/"}, "dc:title": "A triangle"}]}},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0, "extensions":
        {"KHR_xmp_json_ld": {"packet": 0}}}]"#;
    let (scene, diagnostics) = read(&file(&[], "", packets));
    assert!(scene.is_some());
    assert_eq!(codes(&diagnostics), USUAL, "{}", diagnostics.render(false));
}

#[test]
fn coats_with_normals_of_their_own_are_said() {
    let with = |normal: &str, coat: &str| {
        let material = format!(
            r#"{{{normal} "extensions": {{"KHR_materials_clearcoat": {{"clearcoatFactor": 1 {coat}}}}}}}"#
        );
        codes(&covered(&material).1).contains(&"gltf::clearcoat-normal")
    };
    let (base, coat) = (r#""normalTexture": {"index": 0},"#, r#", "clearcoatNormalTexture": {"index": 0}"#);
    assert!(!with("", "") && !with(base, coat));
    assert!(with(base, "") && with("", coat));
    assert!(with(base, r#", "clearcoatNormalTexture": {"index": 0, "scale": 0.5}"#));
}

#[test]
fn specular_glossiness_with_a_factor_and_a_texture() {
    let (scene, diagnostics) = covered(
        r#"{"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.5, 0.25, 1, 1],
        "specularFactor": [0.04, 0.08, 0.02], "glossinessFactor": 0.5, "specularGlossinessTexture": {"index": 0}}}}"#,
    );
    assert_eq!(codes(&diagnostics), ["gltf::specular-glossiness", "scene::no-light", "scene::no-camera"]);
    let m = metallic_roughness(&scene);
    assert_eq!(m.base_color, ColorInput::Constant(Rgb::new(0.5, 0.25, 1.0)));
    assert_eq!(m.metallic, ScalarInput::Constant(0.0));
    // 1 - 0.5 · 128/255, of alpha.
    let bytes = scene.images.iter().find_map(|image| match &image.pixels {
        Pixels::U8 { channels: 1, data } => Some(data.clone()),
        _ => None,
    });
    assert_eq!(bytes, Some(vec![191]));
}

#[test]
fn extensions_of_materials() {
    let with = |extension: &str| {
        let (scene, diagnostics) = covered(&format!(r#"{{"extensions": {{{extension}}}}}"#));
        assert_eq!(codes(&diagnostics), USUAL, "{extension}: {}", diagnostics.render(false));
        metallic_roughness(&scene)
    };
    let number = ScalarInput::Constant;
    let color = |r, g, b| ColorInput::Constant(Rgb::new(r, g, b));
    let m = with(r#""KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25}"#);
    assert_eq!((m.clearcoat, m.clearcoat_roughness), (number(0.5), number(0.25)));
    let m = with(r#""KHR_materials_sheen": {"sheenColorFactor": [1, 0.5, 0], "sheenRoughnessFactor": 0.75}"#);
    assert_eq!((m.sheen_color, m.sheen_roughness), (color(1.0, 0.5, 0.0), number(0.75)));
    let m = with(r#""KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [2, 1, 0]}"#);
    assert_eq!((m.specular, m.specular_color), (number(0.5), color(2.0, 1.0, 0.0)));
    assert_eq!(with(r#""KHR_materials_ior": {"ior": 1.75}"#).ior, 1.75);
    let m = with(r#""KHR_materials_transmission": {"transmissionFactor": 0.5}"#);
    assert_eq!((m.transmission, m.thin), (number(0.5), true));
    let m = with(r#""KHR_materials_volume": {"thicknessFactor": 1}"#);
    assert!(!m.thin);
    let m = with(
        r#""KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5,
        "diffuseTransmissionColorFactor": [1, 0.5, 0]}"#,
    );
    assert_eq!((m.diffuse_transmission, m.diffuse_transmission_color), (number(0.5), color(1.0, 0.5, 0.0)));
    let m = with(r#""KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1.25}"#);
    assert_eq!((m.anisotropy, m.anisotropy_rotation), (number(0.5), 1.25));
    let (_, diagnostics) = covered(
        r#"{"extensions": {"KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1,
        "attenuationColor": [0.25, 1, 1]}}}"#,
    );
    assert!(codes(&diagnostics).contains(&"gltf::attenuation"));
    let (scene, diagnostics) = covered(
        r#"{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1]}, "extensions": {"KHR_materials_unlit": {}}}"#,
    );
    assert!(codes(&diagnostics).contains(&"gltf::unlit"));
    assert_eq!(scene.shapes[0].emission.unwrap().radiance, color(1.0, 0.5, 0.0));
    for (name, code) in [
        ("KHR_materials_iridescence", "gltf::extension"),
        ("KHR_materials_dispersion", "gltf::extension"),
        ("KHR_materials_shine", "gltf::unknown-extension"),
    ] {
        let (_, diagnostics) = covered(&format!(r#"{{"extensions": {{"{name}": {{}}}}}}"#));
        assert!(codes(&diagnostics).contains(&code), "{name}");
    }
}

#[test]
fn properties_that_gltf_does_not_know_are_said_once() {
    let (_, diagnostics) = covered(
        r#"{"alphamode": "MASK", "extras": {"anything": 1}, "pbrMetallicRoughness": {"roughness": 0.5}},
        {"alphamode": "MASK"}"#,
    );
    let found: Vec<_> = diagnostics.list.iter().filter(|d| d.code == "gltf::unknown-property").collect();
    assert_eq!(found.len(), 2, "{}", diagnostics.render(false));
    assert_eq!(found[0].hint.as_deref(), Some("did you mean \"alphaMode\"?"));
}
