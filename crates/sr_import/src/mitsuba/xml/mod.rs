//! Mitsuba's XML to a tree of [`Node`]s.
//!
//! In: text. Out: the tree, with `<include>`d files spliced in, `$name` substituted, `<default>`, `<path>` and
//! `<alias>` carried out; and diagnostics about everything that is not understood. What a name *means* is not
//! decided here.
//!
//! - `syntax`: text to elements. `elements`: the elements there are.
//! - `reader`: elements to nodes. `value`: the attributes of a property to its value.
//! - `parameters`, `include`, `alias`: what is carried out on the way.
//!
//! Limits against hostile files: size, number of elements, depth of nesting and of inclusion, length of an attribute
//! after substitution (64 KiB) and of all of them together (64 MiB); document type definitions, and with them
//! entities, are refused.

mod alias;
mod elements;
mod include;
mod parameters;
mod reader;
mod syntax;
mod value;

use std::collections::HashMap;

use sr_scene::{Diagnostic, Diagnostics, Span};

use crate::LoadOptions;
use crate::files::Directories;
use crate::limits::Limits;
use crate::mitsuba::node::Node;
use crate::values::shown;
use elements::Kind;
pub use elements::names_without_plugins;
use include::Includes;
use parameters::Parameters;

/// Elements nested deeper, and files included deeper, are refused.
const MAX_DEPTH: usize = 32;

/// A scene read from XML.
pub struct XmlScene {
    /// The `<scene>`.
    pub root: Node,
    /// Was it written for Mitsuba 0.5 or 0.6?
    pub legacy: bool,
    /// Where the files it names are looked for.
    pub directories: Directories,
}

/// What is known while elements are read; `reader` and `include` have its methods.
struct Reader<'d> {
    diagnostics: &'d mut Diagnostics,
    legacy: bool,
    parameters: Parameters,
    directories: Directories,
    includes: Includes,
    limits: Limits,
    aliases: Vec<alias::Alias>,
    /// For each object that is being read, the outermost first: where its properties are, by canonical name.
    names: Vec<HashMap<String, usize>>,
}

/// Reads a text. `None` if there is no tree to speak of; the reasons are then in `diagnostics`.
pub fn read(
    name: &str,
    text: &str,
    directories: Directories,
    options: &LoadOptions,
    diagnostics: &mut Diagnostics,
) -> Option<XmlScene> {
    let source = diagnostics.sources.add(name, text);
    let document = syntax::parse(source, text, options.limits.xml_nodes)
        .map_err(|diagnostic| diagnostics.push(diagnostic))
        .ok()?;
    let element = document.root_element();
    let span = reader::start_tag(source, element);
    let tag = element.tag_name().name();
    if elements::kind(tag) != Some(Kind::Scene) {
        let tag = shown(tag);
        let message = format!("this is not a Mitsuba scene: the outermost element is <{tag}>, not <scene>");
        diagnostics.push(Diagnostic::error("mitsuba::not-a-scene", &span, message));
        return None;
    }
    let legacy = is_legacy(element.attribute("version"), &span, diagnostics);
    let mut root = Node::new(tag, "", span);
    let mut reader = Reader {
        diagnostics,
        legacy,
        parameters: Parameters::new(&options.defines),
        directories,
        includes: Includes::new(name),
        limits: options.limits,
        aliases: Vec::new(),
        names: vec![HashMap::new()],
    };
    reader.children(source, element, &mut root, 0);
    let Reader { diagnostics, parameters, directories, aliases, .. } = reader;
    alias::apply(aliases, &mut root, diagnostics);
    parameters.report_unused(source, diagnostics);
    Some(XmlScene { root, legacy, directories })
}

/// Is the file's version before 2.0?
fn is_legacy(version: Option<&str>, span: &Span, diagnostics: &mut Diagnostics) -> bool {
    let major =
        version.and_then(|version| version.split('.').next()).and_then(|v| v.trim().parse::<u32>().ok());
    let doubt = match (version, major) {
        (None, _) => Some(("mitsuba::no-version", "<scene> does not say which version it is for".to_owned())),
        (Some(_), Some(0..=3)) => None,
        (Some(version), _) => Some((
            "mitsuba::unknown-version",
            format!("\"{}\" is not a version of Mitsuba's format that is known", shown(version)),
        )),
    };
    if let Some((code, message)) = doubt {
        let consequence = "it is read as version 3.0.0";
        diagnostics.push(Diagnostic::warning(code, span, message).consequence(consequence));
    }
    major.is_some_and(|major| major < 2)
}
