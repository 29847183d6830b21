//! Groups of shapes, and instances of groups.

use glam::{Affine3A, DMat4};
use sr_scene::{Diagnostic, GroupDesc, InstanceDesc};

use super::{Lowering, key};
use crate::mitsuba::node::Node;
use crate::mitsuba::props::Props;

/// Groups inside groups.
const MAX_DEPTH: usize = 64;

/// A placement of a group within another one.
#[derive(Clone, Copy)]
pub(super) struct Inner {
    group: u32,
    outer_from_inner: DMat4,
}

impl<'a> Lowering<'a, '_> {
    /// A shape group, read once. Instances inside it are placed with it: [`Lowering::instance`].
    pub(super) fn group(&mut self, node: &'a Node) -> u32 {
        if let Some(&done) = self.groups_done.get(&key(node)) {
            return done;
        }
        let index = self.out.groups.len();
        self.out.groups.push(GroupDesc { shapes: Vec::new() });
        self.inner_groups.push(Vec::new());
        self.groups_done.insert(key(node), index as u32);
        self.open.insert(key(node));
        let mut props = Props::new(node);
        let children = self.nested(&mut props, "shape");
        if children.is_empty() {
            let message = format!("{} has no shapes", node.title());
            self.out.d.push(
                Diagnostic::warning("mitsuba::empty-group", &node.span, message)
                    .consequence("nothing is seen of its instances"),
            );
        }
        for child in children {
            match child.kind.as_str() {
                "instance" => {
                    if let Some(inner) = self.placed(child) {
                        self.inner_groups[index].push(inner);
                    }
                }
                // Shown where an instance asks for it.
                "shapegroup" => {}
                "merge" => {
                    for shape in self.merged(child) {
                        self.shape_in_group(index, shape);
                    }
                }
                _ => self.shape_in_group(index, child),
            }
        }
        props.finish(self.out.d);
        self.open.remove(&key(node));
        index as u32
    }

    fn shape_in_group(&mut self, group: usize, node: &'a Node) {
        let Some((mut shape, pending)) = self.shape(node) else { return };
        if shape.emission.take().is_some() {
            self.out.d.push(
                Diagnostic::warning(
                    "mitsuba::emitter-in-group",
                    &node.span,
                    "a shape of a group cannot emit",
                )
                .consequence("it is rendered without its emitter"),
            );
        }
        self.out.add_shape_to_group(group, shape, pending);
    }

    /// An instance of the scene itself: the group, and all that is placed inside it, at any depth.
    pub(super) fn instance(&mut self, node: &'a Node) {
        let Some(outermost) = self.placed(node) else { return };
        let mut open = vec![outermost];
        while let Some(Inner { group, outer_from_inner }) = open.pop() {
            self.placements += 1;
            let limit = self.out.limits.mitsuba_instances;
            if self.placements > limit.len() {
                if self.placements == limit.len() + 1 {
                    let what = format!("more than {limit} instances, those inside groups counted");
                    let message = limit.refusal(what);
                    self.out.d.push(Diagnostic::error("mitsuba::too-many-instances", &node.span, message));
                }
                return;
            }
            let inner = self.inner_groups[group as usize].iter();
            open.extend(inner.rev().map(|inner| Inner {
                group: inner.group,
                outer_from_inner: outer_from_inner * inner.outer_from_inner,
            }));
            if self.out.groups[group as usize].shapes.is_empty() {
                continue;
            }
            let world_from_group = Affine3A::from_mat4(outer_from_inner.as_mat4());
            self.out.instances.push(InstanceDesc { group, world_from_group, span: node.span.clone() });
        }
    }

    fn placed(&mut self, node: &'a Node) -> Option<Inner> {
        let mut props = Props::new(node);
        let outer_from_inner = props.transform("to_world", self.out.d);
        let groups = self.nested(&mut props, "shape");
        props.finish(self.out.d);
        let [group] = groups[..] else {
            let message = format!("{} needs one shape group, not {}", node.title(), groups.len());
            self.out.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
            return None;
        };
        if group.kind != "shapegroup" {
            let message = format!("an instance shows a shape group, not {}", group.title());
            self.out.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
            return None;
        }
        let is_cycle = self.open.contains(&key(group));
        if is_cycle || self.open.len() >= MAX_DEPTH {
            let message = match is_cycle {
                true => "a shape group that contains itself".into(),
                false => format!("shape groups inside one another, more than {MAX_DEPTH} deep"),
            };
            self.out.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
            return None;
        }
        Some(Inner { group: self.group(group), outer_from_inner })
    }
}
