//! Properties that glTF 2.0 does not know: most are slips of the keyboard.

use std::collections::HashSet;

use sr_scene::{Diagnostic, Diagnostics};

use super::json::Value;
use crate::values::shown;

/// Of every object.
const EVERYWHERE: &[&str] = &["name", "extensions", "extras"];

const ROOT: &[&str] = &[
    "accessors",
    "animations",
    "asset",
    "buffers",
    "bufferViews",
    "cameras",
    "extensionsRequired",
    "extensionsUsed",
    "images",
    "materials",
    "meshes",
    "nodes",
    "samplers",
    "scene",
    "scenes",
    "skins",
    "textures",
];

/// The objects of the lists at the top, and what they may have.
const LISTS: &[(&str, &[&str])] = &[
    (
        "accessors",
        &["bufferView", "byteOffset", "componentType", "normalized", "count", "type", "max", "min", "sparse"],
    ),
    ("buffers", &["uri", "byteLength"]),
    ("bufferViews", &["buffer", "byteOffset", "byteLength", "byteStride", "target"]),
    ("cameras", &["orthographic", "perspective", "type"]),
    ("images", &["uri", "mimeType", "bufferView"]),
    (
        "materials",
        &[
            "pbrMetallicRoughness",
            "normalTexture",
            "occlusionTexture",
            "emissiveTexture",
            "emissiveFactor",
            "alphaMode",
            "alphaCutoff",
            "doubleSided",
        ],
    ),
    ("meshes", &["primitives", "weights"]),
    (
        "nodes",
        &["camera", "children", "skin", "matrix", "mesh", "rotation", "scale", "translation", "weights"],
    ),
    ("samplers", &["magFilter", "minFilter", "wrapS", "wrapT"]),
    ("scenes", &["nodes"]),
    ("skins", &["inverseBindMatrices", "skeleton", "joints"]),
    ("textures", &["sampler", "source"]),
];

/// Objects in these, by the list's name and the property's.
const INNER: &[(&str, &str, &[&str])] = &[
    (
        "materials",
        "pbrMetallicRoughness",
        &[
            "baseColorFactor",
            "baseColorTexture",
            "metallicFactor",
            "roughnessFactor",
            "metallicRoughnessTexture",
        ],
    ),
    ("materials", "normalTexture", &["index", "texCoord", "scale"]),
    ("materials", "emissiveTexture", &["index", "texCoord"]),
    ("meshes", "primitives", &["attributes", "indices", "material", "mode", "targets"]),
];

/// Says each unknown property once, where it is first.
pub fn report(root: &Value, d: &mut Diagnostics) {
    let mut said = HashSet::new();
    check(root, ROOT, &mut said, d);
    for (list, names) in LISTS {
        for item in root.get(list).map_or(&[][..], Value::list) {
            check(item, names, &mut said, d);
            for (_, property, names) in INNER.iter().filter(|(of, ..)| of == list) {
                let Some(inner) = item.get(property) else { continue };
                check(inner, names, &mut said, d);
                inner.list().iter().for_each(|inner| check(inner, names, &mut said, d));
            }
        }
    }
}

fn check<'v>(object: &'v Value, names: &[&str], said: &mut HashSet<&'v str>, d: &mut Diagnostics) {
    for (name, value) in object.members() {
        let is_known = names.iter().chain(EVERYWHERE).any(|known| known == name);
        if is_known || !said.insert(name) {
            continue;
        }
        let message = format!("glTF 2.0 has no property \"{}\" here", shown(name));
        d.push(
            Diagnostic::warning("gltf::unknown-property", &value.span, message)
                .guess(name, names.iter().copied())
                .consequence("it is ignored"),
        );
    }
}
