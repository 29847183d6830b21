//! pbrt-v4.
//!
//! In: a description. Out: a scene in pbrt's directives, with meshes as PLY files and images beside it. World space stays as
//! it is; pbrt's camera space is left-handed, so that the camera alone is mirrored.

mod camera;
mod light;
mod material;
mod shape;
mod text;
mod texture;

use std::collections::{HashMap, HashSet};

use sr_scene::SceneDesc;

use crate::Export;
use crate::bake::Baker;
use crate::notes::Notes;
use crate::output::Files;
use text::Text;

/// A scene as it is written.
struct Writer<'a> {
    scene: &'a SceneDesc,
    baker: Baker<'a>,
    files: Files,
    notes: Notes,
    /// Textures and materials, each after those that it refers to.
    definitions: Text,
    materials: HashMap<material::Key, String>,
    textures: HashMap<texture::Key, String>,
    /// Bump maps that are scaled, by their names.
    bumps: HashSet<String>,
}

/// Writes a scene.
pub fn export(scene: &SceneDesc, name: &str) -> Export {
    let mut writer = Writer {
        scene,
        baker: Baker::new(scene),
        files: Files::new(name),
        notes: Notes::default(),
        definitions: Text::default(),
        materials: HashMap::new(),
        textures: HashMap::new(),
        bumps: HashSet::new(),
    };
    let mut head = Text::default();
    writer.options(&mut head, name);
    writer.camera(&mut head);
    head.line("WorldBegin");
    let mut world = Text::default();
    writer.lights(&mut world);
    writer.groups(&mut world);
    for shape in &scene.shapes {
        writer.shape(&mut world, shape);
    }
    writer.instances(&mut world);
    head.append(&writer.definitions);
    head.append(&world);
    Export { files: writer.files.finish(name, head.into_bytes()), diagnostics: writer.notes.finish() }
}
