//! `<alias>`: a second name of an object.

use sr_scene::{Diagnostic, Diagnostics, Span};

use crate::node::{Child, Node};
use crate::values::shown;

/// The object `id` is also called `new`.
pub struct Alias {
    pub id: String,
    pub new: String,
    pub span: Span,
}

/// An alias is an object of the new name that is a copy of the old; chains are followed in file order.
pub fn apply(aliases: Vec<Alias>, root: &mut Node, diagnostics: &mut Diagnostics) {
    for alias in aliases {
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
                diagnostics.push(Diagnostic::error("mitsuba::bad-alias", &alias.span, message));
            }
            None => {
                let message = format!("there is no object with the id \"{}\"", shown(&alias.id));
                diagnostics.push(Diagnostic::error("mitsuba::unresolved-reference", &alias.span, message));
            }
        }
    }
}
