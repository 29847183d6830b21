//! Mitsuba 3 XML.
//!
//! In: a description. Out: a scene of elements that refer to one another by ids, with meshes as PLY files and images beside
//! it. Descriptions are in Mitsuba's conventions but for the plugins that Steradian alone has.

mod camera;
mod light;
mod material;
mod shape;
mod texture;
mod xml;

use std::collections::HashMap;

use sr_scene::{MaterialId, SceneDesc, Span, TextureId};

use crate::Export;
use crate::bake::Baker;
use crate::notes::Notes;
use crate::output::Files;
use xml::Xml;

/// A scene as it is written.
struct Writer<'a> {
    scene: &'a SceneDesc,
    /// May plugins be named that Mitsuba does not have?
    own_plugins: bool,
    baker: Baker<'a>,
    files: Files,
    notes: Notes,
    /// Textures and materials, each after those that it refers to.
    definitions: Xml,
    materials: HashMap<MaterialId, String>,
    textures: HashMap<TextureId, String>,
}

/// Writes a scene.
pub fn export(scene: &SceneDesc, own_plugins: bool, name: &str) -> Export {
    let mut writer = Writer {
        scene,
        own_plugins,
        baker: Baker::new(scene),
        files: Files::new(name),
        notes: Notes::default(),
        definitions: Xml::inside(1),
        materials: HashMap::new(),
        textures: HashMap::new(),
    };
    let mut head = Xml::inside(1);
    writer.integrator(&mut head);
    writer.sensor(&mut head);
    let mut world = Xml::inside(1);
    writer.lights(&mut world);
    writer.groups(&mut world);
    for shape in &scene.shapes {
        writer.shape(&mut world, shape);
    }
    writer.instances(&mut world);
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<scene version=\"3.0.0\">\n");
    head.append(&writer.definitions);
    head.append(&world);
    text.push_str(&head.into_text());
    text.push_str("</scene>\n");
    Export { files: writer.files.finish(name, text.into_bytes()), diagnostics: writer.notes.finish() }
}

impl Writer<'_> {
    /// Says that Mitsuba has no such thing, unless our own may be written; may it?
    fn own(&mut self, what: &str, span: &Span, instead: &str) -> bool {
        if !self.own_plugins {
            self.notes.push("convert::approximated", span, format!("Mitsuba 3 has no {what}"), instead);
        }
        self.own_plugins
    }
}
