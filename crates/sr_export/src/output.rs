//! Files by name, each of which can be written.

use std::collections::HashMap;
use std::io::{self, Write};
use std::sync::Arc;

use sr_scene::{Image, MeshDesc};

use crate::{pictures, ply};

/// A file of an export.
#[derive(Debug)]
pub struct OutputFile {
    /// Where it belongs, beside the others: slashes are between folders.
    pub name: String,
    /// What is in it.
    pub content: Content,
}

/// What is in a file.
#[derive(Debug)]
pub enum Content {
    /// These bytes.
    Bytes(Vec<u8>),
    /// A mesh, as binary PLY.
    Mesh(Arc<MeshDesc>),
    /// An image: PNG if its values are bytes, else EXR. Opacity is left out.
    Image(Arc<Image>),
}

impl Content {
    /// Writes all of it.
    ///
    /// # Errors
    /// If `out` does not take it.
    pub fn write_to(&self, out: impl Write + io::Seek) -> io::Result<()> {
        let mut out = out;
        match self {
            Self::Bytes(bytes) => out.write_all(bytes),
            Self::Mesh(mesh) => ply::write(mesh, &mut out),
            Self::Image(image) => pictures::write(image, &mut out),
        }
    }
}

/// The files of an export as they grow: what is the same thing in memory is one file.
pub struct Files {
    folder: String,
    list: Vec<OutputFile>,
    /// The names of meshes and images, by their address.
    known: HashMap<usize, String>,
}

impl Files {
    /// Those of a scene of that name: meshes and images are in a folder of its stem.
    pub fn new(name: &str) -> Self {
        Self { folder: stem(name).to_owned(), list: Vec::new(), known: HashMap::new() }
    }

    /// The name of a mesh's file.
    pub fn mesh(&mut self, mesh: &Arc<MeshDesc>) -> String {
        let key = Arc::as_ptr(mesh).addr();
        if let Some(name) = self.known.get(&key) {
            return name.clone();
        }
        let name = self.fresh("mesh", &mesh.name, "ply");
        self.known.insert(key, name.clone());
        self.list.push(OutputFile { name: name.clone(), content: Content::Mesh(mesh.clone()) });
        name
    }

    /// The name of an image's file.
    pub fn image(&mut self, image: &Arc<Image>) -> String {
        let key = Arc::as_ptr(image).addr();
        if let Some(name) = self.known.get(&key) {
            return name.clone();
        }
        let name = self.fresh("image", &image.name, pictures::extension(image));
        self.known.insert(key, name.clone());
        self.list.push(OutputFile { name: name.clone(), content: Content::Image(image.clone()) });
        name
    }

    /// A file of bytes, beside the scene.
    pub fn bytes(&mut self, name: &str, bytes: Vec<u8>) {
        self.list.push(OutputFile { name: name.to_owned(), content: Content::Bytes(bytes) });
    }

    /// A file in the folder.
    pub fn bytes_in_folder(&mut self, kind: &str, origin: &str, extension: &str, bytes: Vec<u8>) -> String {
        let name = self.fresh(kind, origin, extension);
        self.bytes(&name, bytes);
        name
    }

    /// All of them, with the scene itself at the end.
    pub fn finish(mut self, name: &str, scene: Vec<u8>) -> Vec<OutputFile> {
        self.bytes(name, scene);
        self.list
    }

    /// A name that no other file has: its number, and what its origin was called.
    fn fresh(&self, kind: &str, origin: &str, extension: &str) -> String {
        let number = self.list.len() + 1;
        let file = origin.rsplit(['/', '\\']).next().unwrap_or("");
        let hint: String =
            stem(file).chars().filter(|c| c.is_ascii_alphanumeric() || "-_".contains(*c)).take(32).collect();
        let dash = if hint.is_empty() { "" } else { "-" };
        format!("{}/{kind}{number:04}{dash}{hint}.{extension}", self.folder)
    }
}

/// A name without its extension.
fn stem(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}
