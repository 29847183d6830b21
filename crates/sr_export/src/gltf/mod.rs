//! glTF 2.0.
//!
//! In: a description. Out: JSON with one buffer, beside it or in one .glb with it. Everything is triangles and
//! metallic-roughness materials with the KHR extensions; images are PNG. There are no film, no integrator and no environment.

mod buffer;
mod json;
mod material;
mod node;
mod texture;

use std::collections::{BTreeSet, HashMap, HashSet};

use sr_scene::{ColorInput, MaterialId, SceneDesc};

use crate::Export;
use crate::bake::Baker;
use crate::notes::Notes;
use crate::output::Files;
use buffer::Buffer;
use json::Json;

/// A scene as it is written.
struct Writer<'a> {
    scene: &'a SceneDesc,
    baker: Baker<'a>,
    files: Files,
    notes: Notes,
    is_binary: bool,
    buffer: Buffer,
    extensions: BTreeSet<&'static str>,
    nodes: Vec<Json>,
    /// Does the camera mirror what it sees, as pbrt's do? Then all but the camera, which is the first node, is mirrored.
    is_mirrored: bool,
    meshes: Vec<Json>,
    materials: Vec<Json>,
    textures: Vec<Json>,
    samplers: Vec<Json>,
    images: Vec<Json>,
    cameras: Vec<Json>,
    lights: Vec<Json>,
    /// Materials by what they are and what their shape emits, by its bits.
    known_materials: HashMap<(MaterialId, Option<String>), usize>,
    known_textures: HashMap<String, usize>,
    /// The attributes and indices of meshes, by their address.
    known_meshes: HashMap<usize, Attributes>,
    /// Materials whose base is the colors of the mesh.
    colored: HashSet<MaterialId>,
    /// Meshes that were made here, kept so that no other one gets their address.
    made: Vec<std::sync::Arc<sr_scene::MeshDesc>>,
}

/// The accessors of a mesh.
#[derive(Clone)]
struct Attributes {
    positions: usize,
    normals: Option<usize>,
    uvs: Option<usize>,
    further_uvs: Vec<usize>,
    colors: Option<usize>,
    indices: usize,
}

/// What a shape emits, as a key.
fn emission_key(emission: Option<ColorInput>) -> Option<String> {
    emission.map(|input| format!("{input:?}"))
}

/// Writes a scene.
pub fn export(scene: &SceneDesc, name: &str, is_binary: bool) -> Export {
    let mut writer = Writer {
        scene,
        baker: Baker::new(scene),
        files: Files::new(name),
        notes: Notes::default(),
        is_binary,
        buffer: Buffer::default(),
        extensions: BTreeSet::new(),
        nodes: Vec::new(),
        is_mirrored: scene.camera.world_from_camera.determinant() < 0.0,
        meshes: Vec::new(),
        materials: Vec::new(),
        textures: Vec::new(),
        samplers: Vec::new(),
        images: Vec::new(),
        cameras: Vec::new(),
        lights: Vec::new(),
        known_materials: HashMap::new(),
        known_textures: HashMap::new(),
        known_meshes: HashMap::new(),
        colored: HashSet::new(),
        made: Vec::new(),
    };
    writer.camera();
    writer.all_lights();
    writer.shapes();
    writer.finish(name)
}

/// What a scene is scaled by that only a mirror shows right: glTF's cameras cannot mirror.
const MIRROR: glam::Vec3 = glam::Vec3::new(-1.0, 1.0, 1.0);

impl Writer<'_> {
    fn finish(mut self, name: &str) -> Export {
        let bytes = std::mem::take(&mut self.buffer.bytes);
        let (views, accessors) = self.buffer.take_lists();
        let generator = concat!("steradian ", env!("CARGO_PKG_VERSION"));
        let asset = vec![("version", Json::text("2.0")), ("generator", Json::text(generator))];
        let mut root = vec![("asset", Json::Object(asset))];
        let names =
            |set: &BTreeSet<&'static str>| set.iter().map(|name| Json::text(name)).collect::<Vec<_>>();
        let mut add = |name: &'static str, list: Vec<Json>| {
            // The format has no empty lists.
            if !list.is_empty() {
                root.push((name, Json::List(list)));
            }
        };
        add("extensionsUsed", names(&self.extensions));
        let mut roots: Vec<Json> = (0..self.nodes.len()).map(Json::Integer).collect();
        if self.is_mirrored && roots.len() > 1 {
            let scale = ("scale", Json::numbers(&MIRROR.to_array()));
            let all = ("children", Json::List(roots.split_off(1)));
            roots.push(Json::Integer(self.nodes.len()));
            self.nodes.push(Json::Object(vec![scale, all]));
        }
        let mut scene = Vec::new();
        if !roots.is_empty() {
            scene.push(("nodes", Json::List(roots)));
        }
        add("scenes", vec![Json::Object(scene)]);
        add("nodes", self.nodes);
        add("cameras", self.cameras);
        add("meshes", self.meshes);
        add("materials", self.materials);
        add("textures", self.textures);
        add("samplers", self.samplers);
        add("images", self.images);
        add("accessors", accessors);
        add("bufferViews", views);
        if !self.lights.is_empty() {
            let lights = Json::Object(vec![("lights", Json::List(self.lights))]);
            root.push(("extensions", Json::Object(vec![("KHR_lights_punctual", lights)])));
        }
        root.push(("scene", Json::Integer(0)));
        if !bytes.is_empty() {
            let mut buffer = vec![("byteLength", Json::Integer(bytes.len()))];
            if !self.is_binary {
                let file = self.files.bytes_in_folder("buffer", "", "bin", bytes.clone());
                buffer.push(("uri", Json::Text(uri(&file))));
            }
            root.push(("buffers", Json::List(vec![Json::Object(buffer)])));
        }
        let mut text = String::new();
        Json::Object(root).write(&mut text, 0);
        let content = if self.is_binary { packed(text, &bytes) } else { text.into_bytes() };
        Export { files: self.files.finish(name, content), diagnostics: self.notes.finish() }
    }
}

/// A .glb file: a header, and two chunks that are multiples of four bytes.
fn packed(mut text: String, bytes: &[u8]) -> Vec<u8> {
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let word = |length: usize| u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes();
    let buffer_length = if bytes.is_empty() { 0 } else { 8 + bytes.len() };
    let mut out = Vec::with_capacity(20 + text.len() + buffer_length);
    out.extend(b"glTF");
    out.extend(word(2));
    out.extend(word(20 + text.len() + buffer_length));
    out.extend(word(text.len()));
    out.extend(b"JSON");
    out.extend(text.as_bytes());
    if !bytes.is_empty() {
        out.extend(word(bytes.len()));
        out.extend(b"BIN\0");
        out.extend(bytes);
    }
    out
}

/// A relative URI: what is special in URIs is escaped.
fn uri(file: &str) -> String {
    let mut out = String::new();
    for byte in file.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' | b'/' => {
                out.push(byte.into())
            }
            _ => out.push_str(&format!("%{byte:02X}")),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_are_aligned_and_lengths_are_whole() {
        let file = packed("{\"a\": 1}x".into(), &[1, 2, 3, 4]);
        assert_eq!(file.len() % 4, 0);
        assert_eq!(u32::from_le_bytes([file[8], file[9], file[10], file[11]]) as usize, file.len());
        assert_eq!(&file[16..20], b"JSON");
        assert_eq!(uri("a b/ü.bin"), "a%20b/%C3%BC.bin");
    }
}
