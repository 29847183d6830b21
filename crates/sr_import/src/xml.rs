//! Mitsuba's XML to a tree of [`Node`]s.
//!
//! In: text. Out: the tree, with `<include>`d files spliced in, `$name` substituted, `<default>`, `<path>` and
//! `<alias>` carried out; and diagnostics about everything that is not understood. What a name *means* is not
//! decided here.
//!
//! Limits against hostile files: size, number of elements, depth of nesting and of inclusion; document type
//! definitions, and with them entities, are refused.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DMat4, DVec3};
use roxmltree::{Document, Node as Element, ParsingOptions};
use sr_scene::{Diagnostic, Diagnostics, SourceId, Span};

use crate::files;
use crate::node::{Child, Node, Property, Reference, SpectrumValue, Value, canonical_name};
use crate::transform;
use crate::values::{self, Attributes, shown};

const MAX_NODES: u32 = 16 << 20;
const MAX_DEPTH: usize = 32;
const MAX_INCLUDES: usize = 256;

/// Elements that are objects with a plugin type.
const OBJECTS: &[&str] = &[
    "scene",
    "bsdf",
    "texture",
    "shape",
    "emitter",
    "sensor",
    "film",
    "sampler",
    "rfilter",
    "integrator",
    "medium",
    "phase",
    "volume",
    "subsurface",
    "spectrum",
];
/// All elements there are, for guesses.
const ELEMENTS: &[&str] = &[
    "scene",
    "bsdf",
    "texture",
    "shape",
    "emitter",
    "sensor",
    "film",
    "sampler",
    "rfilter",
    "integrator",
    "medium",
    "phase",
    "volume",
    "subsurface",
    "spectrum",
    "float",
    "integer",
    "boolean",
    "string",
    "point",
    "vector",
    "rgb",
    "srgb",
    "color",
    "blackbody",
    "transform",
    "ref",
    "include",
    "default",
    "path",
    "alias",
];

/// A scene read from XML.
pub struct XmlScene {
    /// The `<scene>`.
    pub root: Node,
    /// Was it written for Mitsuba 0.5 or 0.6?
    pub legacy: bool,
    /// Where the files it names are looked for.
    pub directories: Vec<PathBuf>,
}

/// Reads a text. `None` if there is no tree to speak of; the reasons are then in `diagnostics`.
pub fn read(
    name: &str,
    text: &str,
    directories: Vec<PathBuf>,
    defines: &[(String, String)],
    diagnostics: &mut Diagnostics,
) -> Option<XmlScene> {
    let mut reader = Reader {
        diagnostics,
        parameters: BTreeMap::new(),
        directories,
        including: vec![PathBuf::from(name)],
        includes: 0,
        aliases: Vec::new(),
    };
    for (key, value) in defines {
        reader.parameters.insert(key.clone(), Parameter { value: value.clone(), used: false, defined: true });
    }
    let source = reader.diagnostics.sources.add(name, text);
    let mut root = Node::new("scene", "", Span { source, bytes: 0..0 });
    let document = reader.parse(source, text)?;
    let element = document.root_element();
    let span = reader.span(source, element);
    if element.tag_name().name() != "scene" {
        let tag = shown(element.tag_name().name());
        let message = format!("this is not a Mitsuba scene: the outermost element is <{tag}>, not <scene>");
        reader.push(Diagnostic::error("mitsuba::not-a-scene", &span, message));
        return None;
    }
    root.span = span;
    let legacy = reader.version(source, element);
    reader.children(source, element, &mut root, 0);
    reader.apply_aliases(&mut root);
    reader.report_unused_defines(source);
    let directories = reader.directories;
    Some(XmlScene { root, legacy, directories })
}

struct Parameter {
    value: String,
    used: bool,
    /// Given by the user rather than by a `<default>`.
    defined: bool,
}

struct Alias {
    id: String,
    new: String,
    span: Span,
}

struct Reader<'d> {
    diagnostics: &'d mut Diagnostics,
    parameters: BTreeMap<String, Parameter>,
    directories: Vec<PathBuf>,
    including: Vec<PathBuf>,
    includes: usize,
    aliases: Vec<Alias>,
}

impl Reader<'_> {
    fn push(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// The start tag of an element.
    fn span(&self, source: SourceId, element: Element<'_, '_>) -> Span {
        let range = element.range();
        let text = element.document().input_text();
        let inner = element.first_child().map_or(range.end, |child| child.range().start);
        let end = if inner > range.start && inner <= range.end { inner } else { range.end };
        let end = text[range.start..end].trim_end().len() + range.start;
        Span { source, bytes: range.start..end }
    }

    fn parse<'t>(&mut self, source: SourceId, text: &'t str) -> Option<Document<'t>> {
        let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, entity_resolver: None };
        match Document::parse_with_options(text, options) {
            Ok(document) => Some(document),
            Err(error) => {
                self.push(syntax_error(source, text, &error));
                None
            }
        }
    }

    /// Is the file's version before 2.0?
    fn version(&mut self, source: SourceId, element: Element<'_, '_>) -> bool {
        let span = self.span(source, element);
        let Some(version) = element.attribute("version") else {
            self.push(
                Diagnostic::warning(
                    "mitsuba::no-version",
                    &span,
                    "<scene> does not say which version it is for",
                )
                .consequence("it is read as version 3.0.0"),
            );
            return false;
        };
        let major = version.split('.').next().and_then(|v| v.trim().parse::<u32>().ok());
        if major.is_none_or(|m| m > 3) {
            let message =
                format!("\"{}\" is not a version of Mitsuba's format that is known", shown(version));
            self.push(
                Diagnostic::warning("mitsuba::unknown-version", &span, message)
                    .consequence("it is read as version 3.0.0"),
            );
        }
        major.is_some_and(|m| m < 2)
    }

    /// The attributes after substitution.
    fn attributes<'a, 'i>(&mut self, source: SourceId, element: Element<'a, 'i>) -> Attributes<'a, 'i> {
        let values = element
            .attributes()
            .map(|attribute| {
                let span = Span { source, bytes: attribute.range_value() };
                (attribute.name(), self.substitute(attribute.value(), &span))
            })
            .collect();
        Attributes::new(element, values)
    }

    /// Replaces each `$name` by its parameter.
    fn substitute(&mut self, text: &str, span: &Span) -> String {
        if !text.contains('$') {
            return text.to_owned();
        }
        let mut out = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            out.push_str(&rest[..at]);
            let name = &rest[at + 1..];
            // The longest parameter that fits, so that "$res" does not hide "$resx".
            let known = self.parameters.iter_mut().filter(|(key, _)| name.starts_with(key.as_str()));
            if let Some((key, parameter)) = known.max_by_key(|(key, _)| key.len()) {
                parameter.used = true;
                out.push_str(&parameter.value);
                rest = &name[key.len()..];
            } else {
                let end = name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len());
                let (name, after) = name.split_at(end);
                let message = format!("no value for the parameter \"${}\"", shown(name));
                let keys: Vec<&str> = self.parameters.keys().map(String::as_str).collect();
                let diagnostic = Diagnostic::error("mitsuba::undefined-parameter", span, message)
                    .guess(name, keys)
                    .consequence("give it by a <default> before its use, or as a definition");
                self.diagnostics.push(diagnostic);
                rest = after;
            }
        }
        out.push_str(rest);
        out
    }

    fn children(&mut self, source: SourceId, parent: Element<'_, '_>, node: &mut Node, depth: usize) {
        for child in parent.children() {
            if child.is_element() {
                self.element(source, child, node, depth);
            } else if child.is_text() && child.text().is_some_and(|t| !t.trim().is_empty()) {
                let text = shown(child.text().unwrap_or("").trim());
                let span = Span { source, bytes: child.range() };
                self.push(
                    Diagnostic::warning(
                        "mitsuba::stray-text",
                        &span,
                        format!("text between elements: \"{text}\""),
                    )
                    .consequence("it is ignored"),
                );
            }
        }
    }

    fn element(&mut self, source: SourceId, element: Element<'_, '_>, node: &mut Node, depth: usize) {
        let span = self.span(source, element);
        if depth >= MAX_DEPTH {
            let message = format!("elements are nested more than {MAX_DEPTH} deep");
            self.push(Diagnostic::error("mitsuba::too-deep", &span, message));
            return;
        }
        let tag = element.tag_name().name();
        let mut attributes = self.attributes(source, element);
        let result = match tag {
            "spectrum" if element.attribute("type").is_none() => {
                self.value(tag, &mut attributes, node, &span)
            }
            _ if OBJECTS.contains(&tag) => self.object(source, element, &mut attributes, node, depth),
            "ref" => reference(&mut attributes, node, &span),
            "transform" => self.transform(source, element, &mut attributes, node, &span),
            "default" => self.default(&mut attributes),
            "include" => self.include(&mut attributes, node, depth),
            "path" => self.path(&mut attributes, &span),
            "alias" => self.alias(&mut attributes, &span),
            _ => self.value(tag, &mut attributes, node, &span),
        };
        if let Err(message) = result {
            self.push(Diagnostic::error("mitsuba::bad-value", &span, message));
            return;
        }
        let unused: Vec<String> = attributes.unused().map(str::to_owned).collect();
        for name in unused {
            let message = format!("<{tag}> has no attribute \"{}\"", shown(&name));
            self.push(
                Diagnostic::warning("mitsuba::unknown-attribute", &span, message)
                    .guess(&name, ["name", "value", "type", "id", "filename", "x", "y", "z", "angle"])
                    .consequence("it is ignored"),
            );
        }
    }

    fn object(
        &mut self,
        source: SourceId,
        element: Element<'_, '_>,
        attributes: &mut Attributes<'_, '_>,
        parent: &mut Node,
        depth: usize,
    ) -> Result<(), String> {
        let class = element.tag_name().name();
        if class == "scene" {
            return Err("a <scene> inside another element; use <include>".into());
        }
        let kind = attributes.required("type")?.to_owned();
        let mut node = Node::new(class, kind, self.span(source, element));
        node.id = attributes.text("id").map(str::to_owned);
        node.name = attributes.text("name").map(str::to_owned);
        self.children(source, element, &mut node, depth + 1);
        parent.children.push(Child::Node(node));
        Ok(())
    }

    fn transform(
        &mut self,
        source: SourceId,
        element: Element<'_, '_>,
        attributes: &mut Attributes<'_, '_>,
        node: &mut Node,
        span: &Span,
    ) -> Result<(), String> {
        let name = attributes.required("name")?.to_owned();
        let mut total = DMat4::IDENTITY;
        for child in element.children().filter(Element::is_element) {
            let mut attributes = self.attributes(source, child);
            match transform::step(child, &mut attributes) {
                Ok(step) => total = step * total,
                Err(message) => {
                    let span = self.span(source, child);
                    self.push(Diagnostic::error("mitsuba::bad-transform", &span, message));
                }
            }
        }
        node.properties.push(Property { name, value: Value::Transform(total), span: span.clone() });
        Ok(())
    }

    /// A plain value.
    fn value(
        &mut self,
        tag: &str,
        attributes: &mut Attributes<'_, '_>,
        node: &mut Node,
        span: &Span,
    ) -> Result<(), String> {
        let value = match tag {
            "float" => Value::Float(values::number(attributes.required("value")?)?),
            "integer" => {
                let text = attributes.required("value")?.trim().to_owned();
                Value::Integer(text.parse().map_err(|_| format!("\"{}\" is not an integer", shown(&text)))?)
            }
            "boolean" => match attributes.required("value")?.trim().to_ascii_lowercase().as_str() {
                "true" => Value::Boolean(true),
                "false" => Value::Boolean(false),
                other => return Err(format!("\"{}\" is neither true nor false", shown(other))),
            },
            "string" => Value::String(attributes.required("value")?.to_owned()),
            "point" | "vector" => Value::Vector(attributes.vector(0.0)?),
            "rgb" | "srgb" | "color" => Value::Rgb(color(tag, attributes.required("value")?)?),
            "spectrum" => Value::Spectrum(spectrum(attributes)?),
            "blackbody" => {
                let temperature = attributes.required("temperature")?;
                // Mitsuba 0.5 allows a unit: "5000K".
                let temperature = values::number(temperature.trim().trim_end_matches(['K', 'k']))?;
                let scale = attributes.number("scale")?.unwrap_or(1.0);
                Value::Spectrum(SpectrumValue::Blackbody { temperature, scale })
            }
            _ => {
                let message = format!("there is no element <{}>", shown(tag));
                self.push(
                    Diagnostic::warning("mitsuba::unknown-element", span, message)
                        .guess(tag, ELEMENTS.iter().copied())
                        .consequence("it is ignored, with all that it contains"),
                );
                // Its attributes mean nothing to us either.
                let names: Vec<String> = attributes.unused().map(str::to_owned).collect();
                for name in names {
                    attributes.text(&name);
                }
                return Ok(());
            }
        };
        let name = attributes.required("name")?.to_owned();
        if let Some(before) =
            node.properties.iter().position(|p| canonical_name(&p.name) == canonical_name(&name))
        {
            self.push(
                Diagnostic::warning(
                    "mitsuba::duplicate-property",
                    span,
                    format!("\"{name}\" is given twice"),
                )
                .consequence("the later value is used"),
            );
            node.properties.remove(before);
        }
        node.properties.push(Property { name, value, span: span.clone() });
        Ok(())
    }

    fn default(&mut self, attributes: &mut Attributes<'_, '_>) -> Result<(), String> {
        let name = attributes.required("name")?.to_owned();
        if name.is_empty() {
            return Err("a parameter needs a name".into());
        }
        let value = attributes.required("value")?.to_owned();
        self.parameters.entry(name).or_insert(Parameter { value, used: false, defined: false });
        Ok(())
    }

    fn path(&mut self, attributes: &mut Attributes<'_, '_>, span: &Span) -> Result<(), String> {
        let name = attributes.required("value")?.to_owned();
        let directory = files::find(&name, &self.directories);
        if directory.is_dir() {
            self.directories.push(directory);
        } else {
            self.push(
                Diagnostic::warning(
                    "mitsuba::bad-path",
                    span,
                    format!("\"{}\" is not a directory", shown(&name)),
                )
                .consequence("no file is looked for there"),
            );
        }
        Ok(())
    }

    fn alias(&mut self, attributes: &mut Attributes<'_, '_>, span: &Span) -> Result<(), String> {
        let id = attributes.required("id")?.to_owned();
        let new = attributes.required("as")?.to_owned();
        self.aliases.push(Alias { id, new, span: span.clone() });
        Ok(())
    }

    /// An alias is an object of the new name that is a copy of the old; chains are followed in file order.
    fn apply_aliases(&mut self, root: &mut Node) {
        for alias in std::mem::take(&mut self.aliases) {
            let found = root.children.iter().find_map(|child| match child {
                Child::Node(node) if node.id.as_deref() == Some(&alias.id) => Some(node.clone()),
                _ => None,
            });
            match found {
                // Shapes, emitters and sensors are there by being listed: a copy would double them.
                Some(node) if ["bsdf", "texture", "medium", "spectrum"].contains(&node.class.as_str()) => {
                    root.children.push(Child::Node(Node { id: Some(alias.new), ..node }));
                }
                Some(node) => {
                    let message = format!("an alias of {} is not supported", node.title());
                    self.push(Diagnostic::error("mitsuba::bad-alias", &alias.span, message));
                }
                None => {
                    let message = format!("there is no object with the id \"{}\"", shown(&alias.id));
                    self.push(Diagnostic::error("mitsuba::unresolved-reference", &alias.span, message));
                }
            }
        }
    }

    fn include(
        &mut self,
        attributes: &mut Attributes<'_, '_>,
        node: &mut Node,
        depth: usize,
    ) -> Result<(), String> {
        let name = attributes.required("filename")?.to_owned();
        let path = files::find(&name, &self.directories);
        self.includes += 1;
        if self.including.contains(&path) {
            return Err(format!("{} includes itself", path.display()));
        }
        if self.including.len() > MAX_DEPTH || self.includes > MAX_INCLUDES {
            return Err(format!(
                "more than {MAX_INCLUDES} files are included, or more than {MAX_DEPTH} within another"
            ));
        }
        let text =
            read_text(&path).map_err(|reason| format!("cannot include {}: {reason}", path.display()))?;
        let source = self.diagnostics.sources.add(path.display().to_string(), &*text);
        let Some(document) = self.parse(source, &text) else { return Ok(()) };
        if let Some(parent) = path.parent().map(Path::to_owned)
            && !self.directories.contains(&parent)
        {
            self.directories.push(parent);
        }
        self.including.push(path);
        let root = document.root_element();
        if root.tag_name().name() == "scene" {
            self.children(source, root, node, depth + 1);
        } else {
            self.element(source, root, node, depth + 1);
        }
        self.including.pop();
        Ok(())
    }

    fn report_unused_defines(&mut self, source: SourceId) {
        let unused: Vec<String> = self
            .parameters
            .iter()
            .filter(|(_, p)| p.defined && !p.used)
            .map(|(key, _)| key.clone())
            .collect();
        for key in unused {
            let names: Vec<&str> =
                self.parameters.iter().filter(|(_, p)| !p.defined).map(|(name, _)| name.as_str()).collect();
            let diagnostic = Diagnostic::warning(
                "mitsuba::unused-definition",
                &Span { source, bytes: 0..0 },
                format!("the scene does not use the parameter \"{}\"", shown(&key)),
            )
            .guess(&key, names)
            .consequence("its definition has no effect");
            self.diagnostics.push(diagnostic);
        }
    }
}

/// The text of a scene file.
pub fn read_text(path: &Path) -> Result<String, String> {
    let bytes = files::read(path, files::MAX_SCENE_BYTES)?;
    let text = String::from_utf8(bytes)
        .map_err(|e| format!("byte {} is not UTF-8 text", e.utf8_error().valid_up_to()))?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

fn reference(attributes: &mut Attributes<'_, '_>, node: &mut Node, span: &Span) -> Result<(), String> {
    let id = attributes.required("id")?.to_owned();
    let name = attributes.text("name").map(str::to_owned);
    node.children.push(Child::Reference(Reference { id, name, span: span.clone() }));
    Ok(())
}

fn color(tag: &str, text: &str) -> Result<DVec3, String> {
    let (value, encoded) = if text.trim_start().starts_with('#') {
        (values::hex_color(text)?, true)
    } else {
        let value = match values::numbers(text)?[..] {
            [v] => DVec3::splat(v),
            [r, g, b] => DVec3::new(r, g, b),
            ref other => {
                return Err(format!("a color has three numbers (or one for all), not {}", other.len()));
            }
        };
        (value, tag == "srgb")
    };
    Ok(if encoded { value.map(values::srgb_to_linear) } else { value })
}

fn spectrum(attributes: &mut Attributes<'_, '_>) -> Result<SpectrumValue, String> {
    if let Some(file) = attributes.text("filename") {
        return Ok(SpectrumValue::File(file.to_owned()));
    }
    let text = attributes.required("value")?;
    if text.contains(':') {
        return Ok(SpectrumValue::Samples(values::spectrum_pairs(text)?));
    }
    Ok(SpectrumValue::Uniform(values::number(text)?))
}

fn syntax_error(source: SourceId, text: &str, error: &roxmltree::Error) -> Diagnostic {
    use roxmltree::Error;
    let whole = Span { source, bytes: 0..0 };
    let end = Span { source, bytes: last_character(text)..text.len() };
    match error {
        Error::UnexpectedEndOfStream | Error::UnclosedRootNode => Diagnostic::error(
            "xml::truncated",
            &end,
            "the file ends in the middle of an element: it is truncated",
        ),
        Error::NoRootNode => Diagnostic::error("xml::syntax", &whole, "this is not XML: there is no element"),
        Error::DtdDetected => {
            let message = "a document type definition (<!DOCTYPE …>) is not accepted";
            Diagnostic::error("xml::dtd", &whole, message).consequence("remove it: scenes do not need one")
        }
        Error::NodesLimitReached | Error::AttributesLimitReached | Error::NamespacesLimitReached => {
            Diagnostic::error("xml::too-large", &whole, format!("more than {MAX_NODES} XML nodes"))
        }
        other => {
            let position = other.pos();
            let start = offset(text, position.row as usize, position.col as usize);
            let bytes = start..text[start..].chars().next().map_or(start, |c| start + c.len_utf8());
            // The end of the text is where a cut shows first.
            if text[start..].trim().is_empty() {
                return Diagnostic::error(
                    "xml::truncated",
                    &end,
                    "the file ends in the middle of an element: it is truncated",
                );
            }
            Diagnostic::error(
                "xml::syntax",
                &Span { source, bytes },
                format!("this is not well-formed XML: {other}"),
            )
        }
    }
}

fn last_character(text: &str) -> usize {
    text.char_indices().last().map_or(0, |(at, _)| at)
}

/// The byte at a one-based line and column (in characters).
fn offset(text: &str, row: usize, column: usize) -> usize {
    let line_start =
        if row <= 1 { 0 } else { text.match_indices('\n').nth(row - 2).map_or(text.len(), |(at, _)| at + 1) };
    text[line_start..]
        .char_indices()
        .nth(column.saturating_sub(1))
        .map_or(text.len(), |(at, _)| line_start + at)
}
