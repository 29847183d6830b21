//! `<include>` and `<path>`: other files, and where they are.

use std::path::PathBuf;

use sr_scene::{Diagnostic, Span};

use super::elements::{self, Kind};
use super::{MAX_DEPTH, Reader, syntax};
use crate::files;
use crate::mitsuba::attributes::Attributes;
use crate::mitsuba::node::Node;
use crate::values::shown;

/// The files that are being read.
pub struct Includes {
    /// The outermost first.
    open: Vec<PathBuf>,
    /// How many have been included so far.
    count: usize,
}

impl Includes {
    /// Only the scene itself is being read.
    pub fn new(scene: &str) -> Self {
        Self { open: vec![PathBuf::from(scene)], count: 0 }
    }
}

impl Reader<'_> {
    /// Reads another file as if its elements stood here.
    pub(super) fn include(
        &mut self,
        attributes: &mut Attributes<'_, '_>,
        node: &mut Node,
        depth: usize,
    ) -> Result<(), String> {
        let path = self.directories.find(attributes.required("filename")?);
        self.includes.count += 1;
        if self.includes.open.contains(&path) {
            return Err(format!("{} includes itself", path.display()));
        }
        let limit = self.limits.mitsuba_includes;
        if self.includes.count > limit.len() {
            return Err(limit.refusal(format!("more than {limit} files are included")));
        }
        if self.includes.open.len() > MAX_DEPTH {
            return Err(format!("more than {MAX_DEPTH} files are included within one another"));
        }
        let text = files::read_text(&path, self.limits.scene_bytes)
            .map_err(|reason| format!("cannot include {}: {reason}", path.display()))?;
        let source = self.diagnostics.sources.add(path.display().to_string(), &*text);
        let document = match syntax::parse(source, &text, self.limits.xml_nodes) {
            Ok(document) => document,
            Err(diagnostic) => {
                self.diagnostics.push(diagnostic);
                return Ok(());
            }
        };
        if let Some(parent) = path.parent() {
            self.directories.add(parent.to_owned());
        }
        self.includes.open.push(path);
        let root = document.root_element();
        if elements::kind(root.tag_name().name()) == Some(Kind::Scene) {
            self.children(source, root, node, depth + 1);
        } else {
            self.element(source, root, node, depth + 1);
        }
        self.includes.open.pop();
        Ok(())
    }

    /// Adds a directory to look for files in.
    pub(super) fn path(&mut self, attributes: &mut Attributes<'_, '_>, span: &Span) -> Result<(), String> {
        let name = attributes.required("value")?;
        let directory = self.directories.find(name);
        if directory.is_dir() {
            self.directories.add(directory);
        } else {
            let message = format!("\"{}\" is not a directory", shown(name));
            self.diagnostics.push(
                Diagnostic::warning("mitsuba::bad-path", span, message)
                    .consequence("no file is looked for there"),
            );
        }
        Ok(())
    }
}
