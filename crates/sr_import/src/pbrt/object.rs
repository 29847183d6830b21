//! Objects, which are groups, and their instances.

use glam::Affine3A;
use sr_scene::{GroupDesc, InstanceDesc, Span};

use super::Reader;
use super::params::Notes;
use super::state::Saved;
use crate::values::shown;

impl Reader<'_> {
    pub(super) fn object_begin(&mut self, name: &str, span: Span) {
        if self.object.is_some() {
            self.error("pbrt::unbalanced", &span, "an object begins inside another one");
            return;
        }
        let group = self.out.groups.len();
        self.out.groups.push(GroupDesc { shapes: Vec::new() });
        if self.objects.insert(name.to_owned(), group).is_some() {
            let message = format!("the object \"{}\" is described twice", shown(name));
            self.warn("pbrt::duplicate-name", &span, message, "instances after this show the second one");
        }
        self.object = Some(group);
        self.save(Saved::Object(Box::new(self.state.clone()), span));
    }

    pub(super) fn object_instance(&mut self, name: &str, span: &Span) {
        if self.object.is_some() {
            self.error("pbrt::unbalanced", span, "an instance inside of an object");
            return;
        }
        let Some(&group) = self.objects.get(name) else {
            let message = format!("there is no object \"{}\"", shown(name));
            let mut notes = Notes { list: self.out.d, said: &mut self.said };
            Self::unresolved(&mut notes, span, message, name, self.objects.keys(), "nothing is shown here");
            return;
        };
        let limit = self.out.limits.pbrt_instances;
        if self.out.instances.len() >= limit.len() {
            let message = limit.refusal(format!("more than {limit} instances"));
            self.error("pbrt::too-many-instances", span, message);
            self.is_broken = true;
            return;
        }
        if self.out.groups[group].shapes.is_empty() {
            return;
        }
        let world_from_group = Affine3A::from_mat4(self.state.ctm.as_mat4());
        self.out.instances.push(InstanceDesc { group: group as u32, world_from_group, span: span.clone() });
    }
}
