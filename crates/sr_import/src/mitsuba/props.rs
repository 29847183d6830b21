//! Reading a node's properties by name, so that what nobody asked for can be reported.

use glam::{DMat4, DVec3};
use sr_scene::{Diagnostic, Diagnostics, Span};

use crate::mitsuba::node::{Child, Node, Property, Value, canonical_name};
use crate::values::shown;

/// A node being read. Names are given in today's spelling and match every generation's.
pub struct Props<'a> {
    /// The node.
    pub node: &'a Node,
    names: Vec<String>,
    used: Vec<bool>,
    child_used: Vec<bool>,
    asked: Vec<&'static str>,
}

impl<'a> Props<'a> {
    /// Starts reading.
    pub fn new(node: &'a Node) -> Self {
        Self {
            node,
            names: node.properties.iter().map(|p| canonical_name(&p.name)).collect(),
            used: vec![false; node.properties.len()],
            child_used: vec![false; node.children.len()],
            asked: Vec::new(),
        }
    }

    /// The property of this name, whatever its type.
    pub fn get(&mut self, name: &'static str) -> Option<&'a Property> {
        self.asked.push(name);
        let at = self.names.iter().position(|n| n == name)?;
        self.used[at] = true;
        Some(&self.node.properties[at])
    }

    /// Is there a property or child of this name?
    pub fn has(&self, name: &str) -> bool {
        let named = |n: &Option<String>| n.as_deref().is_some_and(|n| canonical_name(n) == name);
        self.names.iter().any(|n| n == name)
            || self.node.children.iter().any(|child| match child {
                Child::Node(node) => named(&node.name),
                Child::Reference(reference) => named(&reference.name),
            })
    }

    /// A number, within f32's range.
    pub fn float(&mut self, name: &'static str, d: &mut Diagnostics) -> Option<f32> {
        let property = self.get(name)?;
        let value = match property.value {
            Value::Float(v) => v,
            Value::Integer(v) => v as f64,
            _ => return self.wrong_type(property, "a number", d),
        };
        finite(value, property, d)
    }

    /// A whole number.
    pub fn integer(&mut self, name: &'static str, d: &mut Diagnostics) -> Option<i64> {
        let property = self.get(name)?;
        match property.value {
            Value::Integer(v) => Some(v),
            Value::Float(v) if v.fract() == 0.0 && v.abs() < 1e15 => Some(v as i64),
            _ => self.wrong_type(property, "an integer", d),
        }
    }

    /// True or false.
    pub fn boolean(&mut self, name: &'static str, d: &mut Diagnostics) -> Option<bool> {
        let property = self.get(name)?;
        match property.value {
            Value::Boolean(v) => Some(v),
            _ => self.wrong_type(property, "a boolean", d),
        }
    }

    /// Text.
    pub fn string(&mut self, name: &'static str, d: &mut Diagnostics) -> Option<(&'a str, &'a Span)> {
        let property = self.get(name)?;
        match &property.value {
            Value::String(v) => Some((v, &property.span)),
            _ => self.wrong_type(property, "a string", d),
        }
    }

    /// A point or a vector.
    pub fn vector(&mut self, name: &'static str, d: &mut Diagnostics) -> Option<DVec3> {
        let property = self.get(name)?;
        match property.value {
            Value::Vector(v) if v.is_finite() => Some(v),
            _ => self.wrong_type(property, "a point or a vector", d),
        }
    }

    /// A transform; the identity if there is none.
    pub fn transform(&mut self, name: &'static str, d: &mut Diagnostics) -> DMat4 {
        let Some(property) = self.get(name) else { return DMat4::IDENTITY };
        match property.value {
            Value::Transform(m) if m.is_finite() && m.as_mat4().is_finite() => m,
            Value::Transform(_) => {
                d.push(Diagnostic::error(
                    "mitsuba::bad-transform",
                    &property.span,
                    "a transform that is not finite",
                ));
                DMat4::IDENTITY
            }
            _ => self.wrong_type(property, "a transform", d).unwrap_or(DMat4::IDENTITY),
        }
    }

    /// The child that is the property `name`.
    pub fn child(&mut self, name: &'static str) -> Option<&'a Child> {
        self.asked.push(name);
        let at = self.node.children.iter().position(|child| {
            let own = match child {
                Child::Node(node) => &node.name,
                Child::Reference(reference) => &reference.name,
            };
            own.as_deref().is_some_and(|n| canonical_name(n) == name)
        })?;
        self.child_used[at] = true;
        Some(&self.node.children[at])
    }

    /// The children that `wanted` accepts and that were not taken before.
    pub fn take_children(&mut self, mut wanted: impl FnMut(&'a Child) -> bool) -> Vec<&'a Child> {
        let mut taken = Vec::new();
        for (child, used) in self.node.children.iter().zip(&mut self.child_used) {
            if !*used && wanted(child) {
                *used = true;
                taken.push(child);
            }
        }
        taken
    }

    /// Nothing of this node is to be reported any more: something was said about the whole of it.
    pub fn use_all(&mut self) {
        self.used.fill(true);
        self.child_used.fill(true);
    }

    /// Names that may be there and change nothing in the picture.
    pub fn ignore(&mut self, names: &[&'static str]) {
        for name in names {
            self.get(name);
        }
    }

    /// Names that are known, and are reported with this consequence.
    pub fn unsupported(&mut self, names: &[&'static str], consequence: &str, d: &mut Diagnostics) {
        for name in names {
            if let Some(property) = self.get(name) {
                let message = format!("\"{name}\" of {} is not supported", self.node.title());
                d.push(
                    Diagnostic::warning("mitsuba::unsupported-property", &property.span, message)
                        .consequence(consequence),
                );
            }
        }
    }

    /// Reports a value of the wrong type.
    pub fn wrong_type<T>(&self, property: &Property, expected: &str, d: &mut Diagnostics) -> Option<T> {
        let message = format!(
            "\"{}\" of {} has to be {expected}, not {}",
            property.name,
            self.node.title(),
            property.value.type_name()
        );
        d.push(Diagnostic::error("mitsuba::wrong-type", &property.span, message));
        None
    }

    /// Ends reading: what nobody asked for is reported.
    pub fn finish(self, d: &mut Diagnostics) {
        let title = self.node.title();
        for (property, _) in self.node.properties.iter().zip(&self.used).filter(|(_, used)| !**used) {
            d.push(
                Diagnostic::warning(
                    "mitsuba::unknown-property",
                    &property.span,
                    format!("{title} has no property \"{}\"", shown(&property.name)),
                )
                .guess(&canonical_name(&property.name), self.asked.iter().copied())
                .consequence("it is ignored"),
            );
        }
        for (child, _) in self.node.children.iter().zip(&self.child_used).filter(|(_, used)| !**used) {
            let (what, name, span) = match child {
                Child::Node(node) => (node.title(), &node.name, &node.span),
                Child::Reference(r) => (format!("the reference to \"{}\"", shown(&r.id)), &r.name, &r.span),
            };
            let mut diagnostic =
                Diagnostic::warning("mitsuba::unused-child", span, format!("{title} has no use for {what}"));
            if let Some(name) = name {
                diagnostic = diagnostic.guess(&canonical_name(name), self.asked.iter().copied());
            }
            d.push(diagnostic.consequence("it is ignored"));
        }
    }
}

fn finite(value: f64, property: &Property, d: &mut Diagnostics) -> Option<f32> {
    let narrow = value as f32;
    if narrow.is_finite() {
        return Some(narrow);
    }
    let message =
        format!("\"{}\" is {value}, which is not a finite number in single precision", property.name);
    d.push(Diagnostic::error("mitsuba::not-finite", &property.span, message));
    None
}

/// A color in single precision, or an error if it does not fit.
pub fn finite_color(value: DVec3, property: &str, span: &Span, d: &mut Diagnostics) -> Option<sr_scene::Rgb> {
    let narrow = value.as_vec3();
    if narrow.is_finite() {
        return Some(narrow);
    }
    d.push(Diagnostic::error("mitsuba::not-finite", span, format!("\"{property}\" is not a finite color")));
    None
}
