//! A Python dictionary as the importer's tree.
//!
//! In: `{"type": …, …}`, nested. Out: a [`Node`] whose spans name the place in the dictionary, as in
//! `scene["box"]["bsdf"]`, and diagnostics for what cannot be a scene. What names mean is the importer's business.

mod arrays;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use sr_import::{Child, Node, Property, Reference, SpectrumValue, Value, plugins};
use sr_scene::{Diagnostic, Diagnostics, Span};

/// Deeper nesting is a dictionary that holds itself, or a mistake.
const MAX_DEPTH: usize = 64;

/// The tree of a dictionary; errors are in the diagnostics.
pub fn from_dict(dict: &Bound<'_, PyDict>) -> PyResult<(Node, Diagnostics)> {
    let mut reader = Reader { diagnostics: Diagnostics::default(), objects: 0 };
    let span = reader.place("scene");
    let kind = reader.kind(dict, &span)?.unwrap_or_else(|| "scene".into());
    if kind != "scene" {
        reader.error(&span, "not-a-scene", format!("the outermost type has to be \"scene\", not \"{kind}\""));
    }
    let node = reader.object(dict, "scene", "scene", "scene", span, 0)?;
    Ok((node, reader.diagnostics))
}

/// More objects are refused: what is used in many places is meant to be a "ref", for each use of a dictionary is a copy.
const MAX_OBJECTS: usize = 1 << 17;

struct Reader {
    diagnostics: Diagnostics,
    objects: usize,
}

impl Reader {
    /// A span that names a place in the dictionary.
    fn place(&mut self, path: &str) -> Span {
        Span { source: self.diagnostics.sources.add(path, ""), bytes: 0..0 }
    }

    fn error(&mut self, span: &Span, code: &'static str, message: String) {
        self.diagnostics.push(Diagnostic::error(code, span, message));
    }

    /// The value of `type`.
    fn kind(&mut self, dict: &Bound<'_, PyDict>, span: &Span) -> PyResult<Option<String>> {
        let kind = dict.get_item("type")?.and_then(|kind| kind.extract::<String>().ok());
        if kind.is_none() {
            self.error(span, "dict::no-type", "an object needs a \"type\", such as \"sphere\"".into());
        }
        Ok(kind)
    }

    fn object(
        &mut self,
        dict: &Bound<'_, PyDict>,
        class: &str,
        kind: &str,
        path: &str,
        span: Span,
        depth: usize,
    ) -> PyResult<Node> {
        let mut node = Node::new(class, if class == "scene" { "" } else { kind }, span);
        for (key, value) in dict {
            let Ok(key) = key.extract::<String>() else {
                let span = node.span.clone();
                self.error(&span, "dict::bad-key", format!("keys are text, not {}", shown(&key)?));
                continue;
            };
            match key.as_str() {
                "type" => {}
                "id" => node.id = value.extract().ok(),
                _ => self.entry(&mut node, &key, &value, path, depth)?,
            }
        }
        if node.class == "shape" && node.kind == "mesh" {
            arrays::mesh(dict, &mut node, &mut self.diagnostics)?;
        }
        Ok(node)
    }

    /// One key and its value, into `parent`.
    fn entry(
        &mut self,
        parent: &mut Node,
        key: &str,
        value: &Bound<'_, PyAny>,
        path: &str,
        depth: usize,
    ) -> PyResult<()> {
        if arrays::is_mesh_array(parent, key) {
            return Ok(());
        }
        let path = format!("{path}[{key:?}]");
        let span = self.place(&path);
        let Ok(dict) = value.cast::<PyDict>() else {
            match self.value(parent, key, value)? {
                Ok(value) => parent.properties.push(Property { name: key.into(), value, span }),
                Err(message) => self.error(&span, "dict::bad-value", message),
            }
            return Ok(());
        };
        if depth == MAX_DEPTH {
            self.error(&span, "dict::too-deep", format!("more than {MAX_DEPTH} objects inside one another"));
            return Ok(());
        }
        let Some(kind) = self.kind(dict, &span)? else { return Ok(()) };
        let name = (parent.class != "scene").then(|| key.to_owned());
        if kind == "ref" {
            match dict.get_item("id")?.and_then(|id| id.extract::<String>().ok()) {
                Some(id) => parent.children.push(Child::Reference(Reference { id, name, span })),
                None => self.error(&span, "dict::no-id", "a \"ref\" needs the \"id\" of an object".into()),
            }
            return Ok(());
        }
        if let Some(value) = arrays::spectrum(&kind, dict)? {
            match value {
                Ok(value) => parent.properties.push(Property { name: key.into(), value, span }),
                Err(message) => self.error(&span, "dict::bad-color", message),
            }
            return Ok(());
        }
        self.objects += 1;
        if self.objects > MAX_OBJECTS {
            if self.objects == MAX_OBJECTS + 1 {
                let message = format!(
                    "more than {MAX_OBJECTS} objects, each use of a dictionary counted: {{\"type\": \"ref\", \"id\": …}} shares one"
                );
                self.error(&span, "dict::too-many", message);
            }
            return Ok(());
        }
        if kind == "scene" {
            self.error(&span, "dict::nested-scene", "a scene cannot be inside a scene".into());
            return Ok(());
        }
        let Some(class) = plugins::class_of(&kind) else {
            self.diagnostics.push(
                Diagnostic::error("dict::unknown-type", &span, format!("there is no type \"{kind}\""))
                    .guess(&kind, plugins::all()),
            );
            return Ok(());
        };
        let mut child = self.object(dict, class, &kind, &path, span, depth + 1)?;
        if parent.class == "scene" {
            child.id.get_or_insert_with(|| key.to_owned());
        }
        child.name = name;
        parent.children.push(Child::Node(child));
        Ok(())
    }

    /// A value that is not an object; the inner error is a sentence.
    fn value(&self, parent: &Node, key: &str, value: &Bound<'_, PyAny>) -> PyResult<Result<Value, String>> {
        if let Ok(text) = value.cast::<PyString>() {
            return Ok(Ok(Value::String(text.to_string())));
        }
        if let Ok(truth) = value.extract::<bool>() {
            return Ok(Ok(Value::Boolean(truth)));
        }
        if let Ok(integer) = value.extract::<i64>() {
            return Ok(Ok(Value::Integer(integer)));
        }
        if let Ok(number) = value.extract::<f64>() {
            return Ok(Ok(Value::Float(number)));
        }
        if let Ok(path) = value.extract::<std::path::PathBuf>() {
            return Ok(Ok(Value::String(path.to_string_lossy().into_owned())));
        }
        if matches!((parent.class.as_str(), key), ("texture", "data") | ("emitter", "data" | "bitmap")) {
            return arrays::image(value);
        }
        arrays::vector_or_transform(value)
    }
}

/// `repr()`, cut short.
fn shown(value: &Bound<'_, PyAny>) -> PyResult<String> {
    const LONGEST: usize = 60;
    let text = value.repr()?.to_string();
    Ok(match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    })
}

/// A spectrum that is the same everywhere.
fn uniform(value: f64) -> Value {
    Value::Spectrum(SpectrumValue::Uniform(value))
}
