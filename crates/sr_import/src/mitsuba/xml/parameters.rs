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

/// An attribute that is longer after substitution is refused: parameters that hold others can double at each step.
const MAX_LENGTH: usize = 1 << 16;
/// All substituted attributes of a scene together, in bytes.
const MAX_TOTAL: usize = 1 << 26;

/// The parameters known so far.
pub struct Parameters {
    known: BTreeMap<String, Parameter>,
    /// How many more bytes may be substituted.
    left: usize,
}

impl Parameters {
    /// Those that the user gives, by name and value.
    pub fn new(defines: &[(String, String)]) -> Self {
        let parameter = |value: &String| Parameter { value: value.clone(), used: false, defined: true };
        let known = defines.iter().map(|(name, value)| (name.clone(), parameter(value))).collect();
        Self { known, left: MAX_TOTAL }
    }

    /// Gives a parameter its value, unless it has one.
    pub fn set_default(&mut self, name: String, value: String) {
        self.known.entry(name).or_insert(Parameter { value, used: false, defined: false });
    }

    /// Replaces each `$name` by its parameter. A text that gets too long is an error, and empty from then on.
    pub fn substitute(&mut self, text: &str, span: &Span, diagnostics: &mut Diagnostics) -> String {
        if !text.contains('$') {
            return text.to_owned();
        }
        let room = MAX_LENGTH.min(self.left);
        let mut out = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            out.push_str(&rest[..at]);
            let name = &rest[at + 1..];
            // The longest parameter that fits, so that "$res" does not hide "$resx".
            let known = self.known.iter_mut().filter(|(key, _)| name.starts_with(key.as_str()));
            if let Some((key, parameter)) = known.max_by_key(|(key, _)| key.len()) {
                parameter.used = true;
                rest = &name[key.len()..];
                if out.len() + parameter.value.len() > room {
                    diagnostics.push(too_long(text, span, self.left));
                    return String::new();
                }
                out.push_str(&parameter.value);
            } else {
                let end = name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len());
                let (name, after) = name.split_at(end);
                let message = format!("no value for the parameter \"${}\"", shown(name));
                diagnostics.push(
                    Diagnostic::error("mitsuba::undefined-parameter", span, message)
                        .guess(name, self.known.keys().map(String::as_str))
                        .consequence("give it by a <default> before its use, or as a definition"),
                );
                rest = after;
            }
        }
        out.push_str(rest);
        self.left = self.left.saturating_sub(out.len());
        out
    }

    /// Warns of what the user gave in vain.
    pub fn report_unused(&self, source: SourceId, diagnostics: &mut Diagnostics) {
        for (name, _) in self.known.iter().filter(|(_, p)| p.defined && !p.used) {
            let others = self.known.iter().filter(|(_, p)| !p.defined).map(|(name, _)| name.as_str());
            let message = format!("the scene does not use the parameter \"{}\"", shown(name));
            diagnostics.push(
                Diagnostic::warning("mitsuba::unused-definition", &Span { source, bytes: 0..0 }, message)
                    .guess(name, others)
                    .consequence("its definition has no effect"),
            );
        }
    }
}

fn too_long(text: &str, span: &Span, left: usize) -> Diagnostic {
    let text = shown(text);
    let (message, remedy) = if left < MAX_LENGTH {
        let message = format!("the values of parameters add up to more than {} MiB of text", MAX_TOTAL >> 20);
        (message, "use parameters less often, or give them shorter values")
    } else {
        let message = format!("\"{text}\" is longer than {} KiB with its parameters", MAX_LENGTH >> 10);
        (message, "give its parameters shorter values, and do not build them from one another over and over")
    };
    Diagnostic::error("mitsuba::parameter-too-long", span, message).consequence(remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn substitute(parameters: &mut Parameters, text: &str) -> (String, Vec<Diagnostic>) {
        let mut diagnostics = Diagnostics::default();
        let out = parameters.substitute(text, &Span::default(), &mut diagnostics);
        (out, diagnostics.list)
    }

    #[test]
    fn the_longest_name_is_meant() {
        let mut parameters = Parameters::new(&[("res".into(), "1".into()), ("resx".into(), "2".into())]);
        assert_eq!(substitute(&mut parameters, "a$resx-$res,$resy").0, "a2-1,1y");
    }

    #[test]
    fn an_attribute_may_fill_its_room_but_no_more() {
        let half = "x".repeat(MAX_LENGTH / 2);
        let mut parameters = Parameters::new(&[("half".into(), half)]);
        let (full, none) = substitute(&mut parameters, "$half$half");
        assert_eq!((full.len(), none.len()), (MAX_LENGTH, 0));
        let (nothing, list) = substitute(&mut parameters, "a$half$half");
        assert_eq!((nothing.as_str(), list.len()), ("", 1));
        assert!(list[0].message.contains("\"a$half$half\" is longer than 64 KiB"), "{}", list[0].message);
    }

    #[test]
    fn attributes_share_one_room() {
        let mut parameters = Parameters::new(&[("all".into(), "x".repeat(MAX_LENGTH))]);
        for _ in 0..MAX_TOTAL / MAX_LENGTH {
            assert!(substitute(&mut parameters, "$all").1.is_empty());
        }
        let (nothing, list) = substitute(&mut parameters, "$all");
        assert!(nothing.is_empty() && list[0].message.contains("more than 64 MiB"));
    }
}
