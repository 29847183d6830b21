//! `<alias>`: a second name of an object.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use sr_scene::{Diagnostic, Diagnostics, Span};

use crate::mitsuba::node::{Child, Node, OtherName};
use crate::values::shown;

/// The object `id` is also called `new`.
pub struct Alias {
    pub id: String,
    pub new: String,
    pub span: Span,
}

/// Gives each object its other names; chains are followed in file order. Nothing is copied: a few bytes of alias
/// must not cost as much as the object.
pub fn apply(aliases: Vec<Alias>, root: &mut Node, diagnostics: &mut Diagnostics) {
    if aliases.is_empty() {
        return;
    }
    let mut places = HashMap::new();
    for (at, child) in root.children.iter().enumerate() {
        if let Child::Node(Node { id: Some(id), .. }) = child {
            places.entry(id.clone()).or_insert(at);
        }
    }
    for Alias { id, new, span } in aliases {
        let at = places.get(&id).copied();
        let Some((at, Child::Node(node))) = at.and_then(|at| Some((at, root.children.get_mut(at)?))) else {
            let message = format!("there is no object with the id \"{}\"", shown(&id));
            diagnostics.push(Diagnostic::error("mitsuba::unresolved-reference", &span, message));
            continue;
        };
        // Shapes, emitters and sensors are there by being listed: nothing refers to them.
        if !["bsdf", "texture", "medium", "spectrum"].contains(&node.class.as_str()) {
            let message = format!("an alias of {} is not supported", node.title());
            diagnostics.push(Diagnostic::error("mitsuba::bad-alias", &span, message));
            continue;
        }
        if let Entry::Vacant(place) = places.entry(new.clone()) {
            place.insert(at);
        }
        node.other_names.push(OtherName { id: new, span });
    }
}
