//! Looking parameters up, with a note of those that were asked for: what nobody asks for is reported.

use std::collections::HashSet;

use glam::DVec3;
use sr_scene::{Diagnostic, Diagnostics, Severity, SourceId, Span};

use super::syntax::{Kind, Parameter, Values};
use crate::values::shown;

/// Different messages that are shown.
const MAX_NOTES: usize = 1000;

/// Diagnostics that are said once each, however often their reason occurs.
pub struct Notes<'d> {
    /// Where they go.
    pub list: &'d mut Diagnostics,
    /// The messages so far.
    pub said: &'d mut HashSet<String>,
}

impl Notes<'_> {
    /// Adds one, if its message is new. Of warnings there is an end.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if self.is_full() && diagnostic.severity < Severity::Error {
            if !self.said.insert(String::new()) {
                return;
            }
            let message = format!("more than {MAX_NOTES} different warnings");
            let note = Diagnostic::warning("pbrt::too-many-warnings", &diagnostic.span, message);
            self.list.push(note.consequence("those that follow are not shown"));
        } else if self.said.insert(diagnostic.message.clone()) {
            self.list.push(diagnostic);
        }
    }

    /// Are warnings that follow not shown?
    pub fn is_full(&self) -> bool {
        self.said.len() >= MAX_NOTES
    }
}

/// The parameters of one directive, those of `Attribute` for it last.
#[derive(Clone, Debug)]
pub struct Params {
    /// What messages call the directive: `Shape "sphere"`.
    pub title: String,
    /// The directive's keyword and type.
    pub span: Span,
    list: Vec<Entry>,
    asked: Vec<&'static str>,
}

#[derive(Clone, Debug)]
struct Entry {
    parameter: Parameter,
    source: SourceId,
    used: bool,
    /// It is one of many directives' `Attribute`: not every one has a use for it.
    inherited: bool,
}

impl Params {
    /// `inherited` stands behind the directive's own.
    pub fn new(title: String, span: Span, list: Vec<Parameter>, inherited: &[(Parameter, SourceId)]) -> Self {
        let source = span.source;
        let own =
            list.into_iter().map(|parameter| Entry { parameter, source, used: false, inherited: false });
        let inherited = inherited.iter().map(|(parameter, source)| Entry {
            parameter: parameter.clone(),
            source: *source,
            used: false,
            inherited: true,
        });
        Self { title, span, list: own.chain(inherited).collect(), asked: Vec::new() }
    }

    /// The first parameter of this name and of one of these types, as messages show it and as it is.
    pub fn find(&mut self, name: &'static str, kinds: &[Kind]) -> Option<(Span, &mut Parameter)> {
        self.asked.push(name);
        let is_it = |e: &&mut Entry| e.parameter.name == name && kinds.contains(&e.parameter.kind);
        let entry = self.list.iter_mut().find(is_it)?;
        entry.used = true;
        let span = Span { source: entry.source, bytes: entry.parameter.bytes.clone() };
        Some((span, &mut entry.parameter))
    }

    /// Is there a parameter of this name, whatever its type?
    pub fn has(&mut self, name: &'static str) -> bool {
        self.asked.push(name);
        self.list.iter().any(|e| e.parameter.name == name)
    }

    /// The first number.
    pub fn float(&mut self, name: &'static str) -> Option<f32> {
        match self.find(name, &[Kind::Float, Kind::Integer])?.1.values {
            Values::Floats(ref values) => values.first().copied(),
            Values::Integers(ref values) => values.first().map(|&v| v as f32),
            _ => None,
        }
    }

    /// All numbers; they are taken out.
    pub fn take_floats(&mut self, name: &'static str, kinds: &[Kind]) -> Option<(Span, Vec<f32>)> {
        let (span, parameter) = self.find(name, kinds)?;
        match &mut parameter.values {
            Values::Floats(values) => Some((span, std::mem::take(values))),
            _ => None,
        }
    }

    /// All whole numbers; they are taken out.
    pub fn take_integers(&mut self, name: &'static str) -> Option<(Span, Vec<i32>)> {
        let (span, parameter) = self.find(name, &[Kind::Integer])?;
        match &mut parameter.values {
            Values::Integers(values) => Some((span, std::mem::take(values))),
            _ => None,
        }
    }

    pub fn integer(&mut self, name: &'static str) -> Option<i32> {
        match &self.find(name, &[Kind::Integer])?.1.values {
            Values::Integers(values) => values.first().copied(),
            _ => None,
        }
    }

    pub fn boolean(&mut self, name: &'static str) -> Option<bool> {
        match &self.find(name, &[Kind::Bool])?.1.values {
            Values::Bools(values) => values.first().copied(),
            _ => None,
        }
    }

    pub fn string(&mut self, name: &'static str) -> Option<(Span, String)> {
        let (span, parameter) = self.find(name, &[Kind::String])?;
        match &parameter.values {
            Values::Strings(values) => Some((span, values.first()?.clone())),
            _ => None,
        }
    }

    /// All strings.
    pub fn strings(&mut self, name: &'static str) -> Vec<String> {
        match self.find(name, &[Kind::String]) {
            Some((_, Parameter { values: Values::Strings(values), .. })) => values.clone(),
            _ => Vec::new(),
        }
    }

    /// The first point or vector.
    pub fn vector(&mut self, name: &'static str) -> Option<DVec3> {
        match &self.find(name, &[Kind::Point3, Kind::Vector3, Kind::Normal])?.1.values {
            Values::Floats(values) => values.first_chunk().map(|&v: &[f32; 3]| DVec3::from(v.map(f64::from))),
            _ => None,
        }
    }

    /// A string out of a list; the first of the list where there is none, or another one.
    pub fn choice(&mut self, name: &'static str, known: &[&'static str], notes: &mut Notes) -> &'static str {
        let Some((span, text)) = self.string(name) else { return known[0] };
        known.iter().find(|word| **word == text).copied().unwrap_or_else(|| {
            let message = format!("\"{}\" is not a \"{name}\" that is supported", shown(&text));
            notes.push(
                Diagnostic::warning("pbrt::unknown-value", &span, message)
                    .guess(&text, known.iter().copied())
                    .consequence(format!("\"{}\" is used", known[0])),
            );
            known[0]
        })
    }

    /// Names that may be there and change nothing in the picture.
    pub fn ignore(&mut self, names: &[&'static str]) {
        for name in names {
            self.use_all_of(name);
        }
    }

    /// Names that are known, and are reported with this consequence.
    pub fn unsupported(&mut self, names: &[&'static str], consequence: &str, notes: &mut Notes) {
        for name in names {
            let Some(span) = self.use_all_of(name) else { continue };
            let message = format!("\"{name}\" of {} is not supported", self.title);
            notes.push(
                Diagnostic::warning("pbrt::unsupported-parameter", &span, message).consequence(consequence),
            );
        }
    }

    fn use_all_of(&mut self, name: &'static str) -> Option<Span> {
        self.asked.push(name);
        let mut first = None;
        for entry in self.list.iter_mut().filter(|e| e.parameter.name == name) {
            entry.used = true;
            let span = Span { source: entry.source, bytes: entry.parameter.bytes.clone() };
            first.get_or_insert(span);
        }
        first
    }

    /// Nothing of these parameters is to be reported: something was said about all of them.
    pub fn use_all(&mut self) {
        self.list.iter_mut().for_each(|e| e.used = true);
    }

    /// Ends reading: what nobody asked for is reported.
    pub fn finish(self, notes: &mut Notes) {
        for Entry { parameter, source, .. } in self.list.iter().filter(|e| !e.used && !e.inherited) {
            let Parameter { name, kind, bytes, .. } = parameter;
            let is_known = self.asked.iter().any(|asked| asked == name);
            let message = match is_known {
                true => format!(
                    "\"{}\" of {} cannot be a {}, or is given twice",
                    shown(name),
                    self.title,
                    kind.name()
                ),
                false => format!("{} has no parameter \"{}\"", self.title, shown(name)),
            };
            let span = Span { source: *source, bytes: bytes.clone() };
            notes.push(
                Diagnostic::warning("pbrt::unknown-parameter", &span, message)
                    .guess(name, self.asked.iter().copied())
                    .consequence("it is ignored"),
            );
        }
    }
}
