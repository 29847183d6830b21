//! KHR_materials_variants: which of a primitive's materials is shown.

use sr_scene::{Diagnostic, Span};

use super::document::Document;
use super::json::Value;
use crate::values::shown;

/// A message has at most so many names.
const MAX_NAMES: usize = 30;

impl<'v> Document<'v, '_> {
    /// Finds the variant of a name, or says which there are.
    pub fn choose_variant(&mut self, name: Option<&str>, span: &Span) {
        let root = self.root;
        let list = root.extension("KHR_materials_variants").and_then(|all| all.get("variants"));
        let list = list.map_or(&[][..], Value::list);
        let name_of = |variant: &Value| variant.get("name").and_then(Value::text).unwrap_or("").to_owned();
        let names: Vec<String> = list.iter().map(name_of).collect();
        self.out.variants = names.iter().map(|name| shown(name)).collect();
        let Some(name) = name else { return };
        self.variant = names.iter().position(|known| known == name);
        if self.variant.is_none() {
            let error = unknown(name, &names, list.first().map_or(span, |first| &first.span));
            self.out.d.push(error);
        }
    }

    /// The material that a primitive has in the chosen variant.
    pub fn material_of(&self, primitive: &'v Value) -> Option<&'v Value> {
        let mappings = primitive.extension("KHR_materials_variants").and_then(|e| e.get("mappings"));
        let mappings = mappings.map_or(&[][..], Value::list);
        let is_meant = |mapping: &&Value| {
            let variants = mapping.get("variants").map_or(&[][..], Value::list);
            self.variant.is_some() && variants.iter().any(|variant| variant.index() == self.variant)
        };
        let mapped = mappings.iter().find(is_meant).and_then(|mapping| mapping.get("material"));
        mapped.or_else(|| primitive.get("material"))
    }
}

/// The error about a name that no variant has.
pub fn unknown(name: &str, names: &[String], span: &Span) -> Diagnostic {
    let listed: Vec<String> =
        names.iter().take(MAX_NAMES).map(|name| format!("\"{}\"", shown(name))).collect();
    let more = if names.len() > MAX_NAMES { ", …" } else { "" };
    let there_are = match names {
        [] => "the scene has no variants".to_owned(),
        _ => format!("there are {}{more}", listed.join(", ")),
    };
    let message = format!("no variant is called \"{}\": {there_are}", shown(name));
    Diagnostic::error("scene::unknown-variant", span, message).guess(name, names.iter().map(String::as_str))
}
