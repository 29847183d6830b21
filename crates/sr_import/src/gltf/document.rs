//! A file as its parts ask for one another: by indices, some of them wrong.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use sr_scene::{Diagnostic, Span};

use super::json::Value;
use super::{container, geometry, image, material};
use crate::assembly::Assembly;

/// A file, and the scene that it becomes.
pub struct Document<'v, 'd> {
    pub root: &'v Value,
    pub out: Assembly<'d>,
    binary: Option<Rc<[u8]>>,
    buffers: HashMap<usize, Option<Rc<[u8]>>>,
    /// Buffer views whose bytes were packed.
    unpacked: HashMap<usize, Option<Rc<[u8]>>>,
    /// How many numbers may still be read from buffers: accessors may share bytes, so that a small file can ask for any
    /// amount.
    pub budget: usize,
    pub images: image::Images,
    pub materials: HashMap<material::Key, material::Surface>,
    pub meshes: HashMap<geometry::Key, Option<geometry::Part>>,
    /// Which of the variants of the materials is shown.
    pub variant: Option<usize>,
    /// Does a surface emit more than white does, by KHR_materials_emissive_strength?
    pub strong_emission: bool,
    /// Codes and places of what was said already.
    said: HashSet<(&'static str, usize)>,
}

impl<'v, 'd> Document<'v, 'd> {
    pub fn new(root: &'v Value, binary: Option<Vec<u8>>, out: Assembly<'d>) -> Self {
        let limits = out.limits;
        Self {
            root,
            out,
            binary: binary.map(Rc::from),
            buffers: HashMap::new(),
            unpacked: HashMap::new(),
            budget: limits.gltf_numbers.len(),
            images: image::Images::new(limits.gltf_texels),
            materials: HashMap::new(),
            meshes: HashMap::new(),
            variant: None,
            strong_emission: false,
            said: HashSet::new(),
        }
    }

    /// A part of the scene is not as the file asks; once for each place.
    pub fn warn(&mut self, code: &'static str, span: &Span, message: impl Into<String>, consequence: &str) {
        if self.said.insert((code, span.bytes.start)) {
            self.out.d.push(Diagnostic::warning(code, span, message).consequence(consequence));
        }
    }

    /// The same, but once for all places.
    pub fn warn_once(
        &mut self,
        code: &'static str,
        span: &Span,
        message: impl Into<String>,
        consequence: &str,
    ) {
        if self.said.insert((code, usize::MAX)) {
            self.out.d.push(Diagnostic::warning(code, span, message).consequence(consequence));
        }
    }

    /// A part of the scene cannot be made.
    pub fn error(&mut self, code: &'static str, span: &Span, message: impl Into<String>) {
        if self.said.insert((code, span.bytes.start)) {
            self.out.d.push(Diagnostic::error(code, span, message));
        }
    }

    /// The element of a top-level list that an index means; `None` with an error if there is none.
    pub fn item(&mut self, list: &'static str, index: &Value) -> Option<&'v Value> {
        let items = self.root.get(list).map_or(&[][..], Value::list);
        let found = index.index().and_then(|i| items.get(i));
        if found.is_none() {
            let message = format!("this is none of the {} {list}, which are counted from 0", items.len());
            self.error("gltf::bad-index", &index.span, message);
        }
        found
    }

    /// A number, or `default` where there is none.
    pub fn number(&mut self, object: &Value, name: &str, default: f64) -> f64 {
        let Some(value) = object.get(name) else { return default };
        value.number().unwrap_or_else(|| {
            let message = format!("\"{name}\" is no number");
            self.warn("gltf::wrong-type", &value.span, message, &format!("{default} is used"));
            default
        })
    }

    /// A list of numbers, or `default` where there is none.
    pub fn numbers<const N: usize>(&mut self, object: &Value, name: &str, default: [f64; N]) -> [f64; N] {
        let Some(value) = object.get(name) else { return default };
        value.numbers().unwrap_or_else(|| {
            let message = format!("\"{name}\" is no list of {N} numbers");
            self.warn("gltf::wrong-type", &value.span, message, &format!("{default:?} is used"));
            default
        })
    }

    /// The bytes of a buffer.
    pub fn buffer(&mut self, index: &Value) -> Option<Rc<[u8]>> {
        let buffer = self.item("buffers", index)?;
        let key = index.index()?;
        if let Some(done) = self.buffers.get(&key) {
            return done.clone();
        }
        let read = match (buffer.get("uri").and_then(Value::text), &self.binary) {
            (Some(uri), _) => {
                let limit = self.out.limits.file_bytes;
                container::fetch(uri, |name| self.out.find(name), limit).map(Rc::from)
            }
            (None, Some(binary)) if key == 0 => Ok(binary.clone()),
            (None, _) => Err("it names no file".into()),
        };
        let needed = buffer.get("byteLength").and_then(Value::index).unwrap_or(0);
        let read = read.and_then(|bytes: Rc<[u8]>| match bytes.len() {
            length if length < needed => Err(format!("it has {length} bytes and not {needed}")),
            _ => Ok(bytes),
        });
        let bytes = read.map_err(|reason| {
            self.error("gltf::bad-buffer", &buffer.span, format!("cannot read the buffer {key}: {reason}"));
        });
        self.buffers.insert(key, bytes.clone().ok());
        bytes.ok()
    }

    /// The bytes of a buffer view, as buffer, first byte and length, and its stride.
    pub fn view(&mut self, index: &Value) -> Option<View> {
        let view = self.item("bufferViews", index)?;
        if let Some(packed) = view.extension("EXT_meshopt_compression") {
            return self.unpacked(index.index()?, packed);
        }
        let Some(buffer) = view.get("buffer") else {
            self.error("gltf::bad-view", &view.span, "the buffer view names no buffer");
            return None;
        };
        let bytes = self.buffer(buffer)?;
        let whole = |name| view.get(name).map_or(Some(0), Value::index);
        let range = whole("byteOffset").zip(whole("byteLength")).and_then(|(start, length)| {
            let end = start.checked_add(length)?;
            (end <= bytes.len()).then_some((start, length))
        });
        let Some((start, length)) = range else {
            let message = format!("the buffer view goes beyond the {} bytes of its buffer", bytes.len());
            self.error("gltf::bad-view", &view.span, message);
            return None;
        };
        Some(View { bytes, start, length, stride: whole("byteStride").filter(|&stride| stride > 0) })
    }

    /// The same of a view whose bytes are packed; each is unpacked once.
    fn unpacked(&mut self, key: usize, packed: &Value) -> Option<View> {
        if !self.unpacked.contains_key(&key) {
            let bytes = self.meshopt(packed).map_err(|reason| {
                let message = format!("the buffer view that meshopt packed cannot be read: {reason}");
                self.error("gltf::meshopt", &packed.span, message);
            });
            self.unpacked.insert(key, bytes.ok().map(Rc::from));
        }
        let bytes = self.unpacked.get(&key)?.clone()?;
        let stride = packed.get("byteStride").and_then(Value::index);
        Some(View { start: 0, length: bytes.len(), bytes, stride })
    }
}

/// A part of a buffer.
pub struct View {
    bytes: Rc<[u8]>,
    start: usize,
    length: usize,
    pub stride: Option<usize>,
}

impl View {
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[self.start..self.start + self.length]
    }
}
