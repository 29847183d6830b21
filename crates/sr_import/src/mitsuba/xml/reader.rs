//! Elements to nodes.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::{DMat4, DVec3};
use roxmltree::Node as Element;
use sr_scene::{Diagnostic, SourceId, Span};

use super::alias::Alias;
use super::elements::{self, Kind, ValueKind};
use super::{MAX_DEPTH, Reader, value};
use crate::mitsuba::attributes::Attributes;
use crate::mitsuba::node::{Child, Node, Property, Reference, Value, canonical_name};
use crate::mitsuba::transform;
use crate::values::shown;

/// Where the start tag of an element is.
pub fn start_tag(source: SourceId, element: Element<'_, '_>) -> Span {
    let range = element.range();
    let text = element.document().input_text();
    let inner = element.first_child().map_or(range.end, |child| child.range().start);
    let end = if inner > range.start && inner <= range.end { inner } else { range.end };
    let end = text[range.start..end].trim_end().len() + range.start;
    Span { source, bytes: range.start..end }
}

impl Reader<'_> {
    /// Reads what is inside an element into the node that it is.
    pub(super) fn children(
        &mut self,
        source: SourceId,
        parent: Element<'_, '_>,
        node: &mut Node,
        depth: usize,
    ) {
        for child in parent.children() {
            if child.is_element() {
                self.element(source, child, node, depth);
            } else if child.is_text() && child.text().is_some_and(|t| !t.trim().is_empty()) {
                let text = shown(child.text().unwrap_or("").trim());
                let span = Span { source, bytes: child.range() };
                let message = format!("text between elements: \"{text}\"");
                self.diagnostics.push(
                    Diagnostic::warning("mitsuba::stray-text", &span, message).consequence("it is ignored"),
                );
            }
        }
    }

    /// Reads one element into the node around it.
    pub(super) fn element(
        &mut self,
        source: SourceId,
        element: Element<'_, '_>,
        node: &mut Node,
        depth: usize,
    ) {
        let span = start_tag(source, element);
        if depth >= MAX_DEPTH {
            let message = format!("elements are nested more than {MAX_DEPTH} deep");
            self.diagnostics.push(Diagnostic::error("mitsuba::too-deep", &span, message));
            return;
        }
        let tag = element.tag_name().name();
        let mut attributes = self.attributes(source, element);
        let Some(kind) = elements::kind(tag) else {
            let message = format!("there is no element <{}>", shown(tag));
            self.diagnostics.push(
                Diagnostic::warning("mitsuba::unknown-element", &span, message)
                    .guess(tag, elements::names())
                    .consequence("it is ignored, with all that it contains"),
            );
            return;
        };
        let result = match kind {
            Kind::Scene => Err("a <scene> inside another element; use <include>".into()),
            Kind::Value(ValueKind::Spectrum) if element.attribute("type").is_some() => {
                self.object(source, element, &mut attributes, node, depth)
            }
            Kind::Object => self.object(source, element, &mut attributes, node, depth),
            Kind::Value(kind) => self.value(kind, &mut attributes, node, &span),
            Kind::Transform => self.transform(source, element, &mut attributes, node, &span),
            Kind::Reference => reference(&mut attributes, node, &span),
            Kind::Include => self.include(&mut attributes, node, depth),
            Kind::Default => self.default(&mut attributes),
            Kind::Path => self.path(&mut attributes, &span),
            Kind::Alias => self.alias(&mut attributes, &span),
        };
        if let Err(message) = result {
            self.diagnostics.push(Diagnostic::error("mitsuba::bad-value", &span, message));
            return;
        }
        for name in attributes.unused() {
            let message = format!("<{tag}> has no attribute \"{}\"", shown(name));
            self.diagnostics.push(
                Diagnostic::warning("mitsuba::unknown-attribute", &span, message)
                    .guess(name, ["name", "value", "type", "id", "filename", "x", "y", "z", "angle"])
                    .consequence("it is ignored"),
            );
        }
    }

    /// The attributes after substitution.
    fn attributes<'a, 'i>(&mut self, source: SourceId, element: Element<'a, 'i>) -> Attributes<'a, 'i> {
        let values = element
            .attributes()
            .map(|attribute| {
                let span = Span { source, bytes: attribute.range_value() };
                let value = self.parameters.substitute(attribute.value(), &span, self.diagnostics);
                (attribute.name(), value)
            })
            .collect();
        Attributes::new(element, values)
    }

    fn object(
        &mut self,
        source: SourceId,
        element: Element<'_, '_>,
        attributes: &mut Attributes<'_, '_>,
        parent: &mut Node,
        depth: usize,
    ) -> Result<(), String> {
        let kind = attributes.required("type")?.to_owned();
        let mut node = Node::new(element.tag_name().name(), kind, start_tag(source, element));
        node.id = attributes.text("id").map(str::to_owned);
        node.name = attributes.text("name").map(str::to_owned);
        self.names.push(HashMap::new());
        self.children(source, element, &mut node, depth + 1);
        self.names.pop();
        parent.children.push(Child::Node(node));
        Ok(())
    }

    fn value(
        &mut self,
        kind: ValueKind,
        attributes: &mut Attributes<'_, '_>,
        node: &mut Node,
        span: &Span,
    ) -> Result<(), String> {
        let value = value::read(kind, attributes)?;
        let name = attributes.required("name")?.to_owned();
        self.property(node, Property { name, value, span: span.clone() });
        Ok(())
    }

    /// Adds a property to the innermost object.
    fn property(&mut self, node: &mut Node, property: Property) {
        let places = self.names.last_mut().expect("the scene is an object");
        match places.entry(canonical_name(&property.name)) {
            Entry::Vacant(place) => {
                place.insert(node.properties.len());
                node.properties.push(property);
            }
            Entry::Occupied(place) => {
                let message = format!("\"{}\" is given twice", shown(&property.name));
                self.diagnostics.push(
                    Diagnostic::warning("mitsuba::duplicate-property", &property.span, message)
                        .consequence("the later value is used"),
                );
                node.properties[*place.get()] = property;
            }
        }
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
                Ok(step) => {
                    total = step * total;
                    if !self.legacy {
                        self.check_axis(child, &mut attributes, source);
                    }
                }
                Err(message) => {
                    let span = start_tag(source, child);
                    self.diagnostics.push(Diagnostic::error("mitsuba::bad-transform", &span, message));
                }
            }
        }
        self.property(node, Property { name, value: Value::Transform(total), span: span.clone() });
        Ok(())
    }

    /// Mitsuba 3 takes the axis of a rotation as it is, 0.6 as a direction.
    fn check_axis(&mut self, step: Element<'_, '_>, attributes: &mut Attributes<'_, '_>, source: SourceId) {
        let axis = (step.tag_name().name() == "rotate").then(|| attributes.vector(0.0));
        let Some(length) = axis.and_then(Result::ok).map(DVec3::length) else { return };
        if (length - 1.0).abs() > 1e-3 {
            let message = format!("the axis of a rotation has the length {length:.3}, not 1");
            self.diagnostics.push(
                Diagnostic::warning("mitsuba::rotation-axis", &start_tag(source, step), message)
                    .consequence("only its direction counts; Mitsuba 3 distorts what it turns"),
            );
        }
    }

    fn default(&mut self, attributes: &mut Attributes<'_, '_>) -> Result<(), String> {
        let name = attributes.required("name")?.to_owned();
        if name.is_empty() {
            return Err("a parameter needs a name".into());
        }
        self.parameters.set_default(name, attributes.required("value")?.to_owned());
        Ok(())
    }

    fn alias(&mut self, attributes: &mut Attributes<'_, '_>, span: &Span) -> Result<(), String> {
        let id = attributes.required("id")?.to_owned();
        let new = attributes.required("as")?.to_owned();
        self.aliases.push(Alias { id, new, span: span.clone() });
        Ok(())
    }
}

fn reference(attributes: &mut Attributes<'_, '_>, node: &mut Node, span: &Span) -> Result<(), String> {
    let id = attributes.required("id")?.to_owned();
    let name = attributes.text("name").map(str::to_owned);
    node.children.push(Child::Reference(Reference { id, name, span: span.clone() }));
    Ok(())
}
