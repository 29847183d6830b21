//! `$name` in attributes, and what it stands for.

use std::collections::BTreeMap;

use sr_scene::{Diagnostic, Diagnostics, SourceId, Span};

use crate::values::shown;

struct Parameter {
    value: String,
    used: bool,
    /// Given by the user rather than by a `<default>`.
    defined: bool,
}

/// The parameters known so far.
pub struct Parameters(BTreeMap<String, Parameter>);

impl Parameters {
    /// Those that the user gives, by name and value.
    pub fn new(defines: &[(String, String)]) -> Self {
        let parameter = |value: &String| Parameter { value: value.clone(), used: false, defined: true };
        Self(defines.iter().map(|(name, value)| (name.clone(), parameter(value))).collect())
    }

    /// Gives a parameter its value, unless it has one.
    pub fn set_default(&mut self, name: String, value: String) {
        self.0.entry(name).or_insert(Parameter { value, used: false, defined: false });
    }

    /// Replaces each `$name` by its parameter.
    pub fn substitute(&mut self, text: &str, span: &Span, diagnostics: &mut Diagnostics) -> String {
        let mut out = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            out.push_str(&rest[..at]);
            let name = &rest[at + 1..];
            // The longest parameter that fits, so that "$res" does not hide "$resx".
            let known = self.0.iter_mut().filter(|(key, _)| name.starts_with(key.as_str()));
            if let Some((key, parameter)) = known.max_by_key(|(key, _)| key.len()) {
                parameter.used = true;
                out.push_str(&parameter.value);
                rest = &name[key.len()..];
            } else {
                let end = name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len());
                let (name, after) = name.split_at(end);
                let message = format!("no value for the parameter \"${}\"", shown(name));
                diagnostics.push(
                    Diagnostic::error("mitsuba::undefined-parameter", span, message)
                        .guess(name, self.0.keys().map(String::as_str))
                        .consequence("give it by a <default> before its use, or as a definition"),
                );
                rest = after;
            }
        }
        out.push_str(rest);
        out
    }

    /// Warns of what the user gave in vain.
    pub fn report_unused(&self, source: SourceId, diagnostics: &mut Diagnostics) {
        for (name, _) in self.0.iter().filter(|(_, p)| p.defined && !p.used) {
            let others = self.0.iter().filter(|(_, p)| !p.defined).map(|(name, _)| name.as_str());
            let message = format!("the scene does not use the parameter \"{}\"", shown(name));
            diagnostics.push(
                Diagnostic::warning("mitsuba::unused-definition", &Span { source, bytes: 0..0 }, message)
                    .guess(name, others)
                    .consequence("its definition has no effect"),
            );
        }
    }
}
