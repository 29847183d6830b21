//! A ray on its way through a tree: what it does at a node, at a leaf and at an other primitive.

use std::hint::select_unpredictable;
use std::mem::MaybeUninit;

use super::leaves::Leaf;
use super::node::kind;
use super::scan::scan;
use super::sheared::{Meets, Sheared};
use super::simd::{Eight, Lanes, Walk};
use super::slabs::Line;
use super::stack::Stack;
use super::traverse::meets_nothing;
use super::{Bvh, Form, Met, Node, NodeRef};
use crate::{Bounds3, Hit, NO_INSTANCE, Ray};

/// Of what is no triangle.
const NOWHERE: u32 = u32::MAX;

/// A ray under way. `ANY`: any hit will do, and is not told.
pub(super) struct Walker<S: Walk, const ANY: bool> {
    /// The ray in the space where it is, ready to meet what is there.
    ray: Ray,
    sheared: Sheared,
    slabs: S::Slabs,
    /// The instance by which it came there.
    instance: u32,
    /// Did it come back from there, and is not ready yet to meet what is here?
    is_back: bool,
    pub stack: Stack,
    met: bool,
    /// The closest hit so far, or the end of the ray.
    t: f32,
    b1: f32,
    b2: f32,
    /// Where the triangle that was hit is in the leaves, or [`NOWHERE`].
    place: u32,
    /// The instance that this triangle is in.
    instance_of_place: u32,
    /// What was hit if no triangle was.
    other: Hit,
}

impl<S: Walk, const ANY: bool> Walker<S, ANY> {
    /// Starts at the root of a tree.
    #[inline(always)]
    pub fn start<'p>(
        place: &'p mut MaybeUninit<Self>,
        simd: S,
        root: NodeRef,
        (ray, sheared, line): (&Ray, &Sheared, &Line),
    ) -> &'p mut Self {
        let walker = place.as_mut_ptr();
        // SAFETY: everything is written, but for the places of the stack that are not in use.
        unsafe {
            (&raw mut (*walker).ray).write(*ray);
            (&raw mut (*walker).sheared).write(*sheared);
            (&raw mut (*walker).slabs).write(simd.slabs(line));
            (&raw mut (*walker).instance).write(NO_INSTANCE);
            (&raw mut (*walker).is_back).write(false);
            (&raw mut (*walker).met).write(false);
            (&raw mut (*walker).t).write(ray.t_max);
            (&raw mut (*walker).b1).write(0.0);
            (&raw mut (*walker).b2).write(0.0);
            (&raw mut (*walker).place).write(NOWHERE);
            (&raw mut (*walker).instance_of_place).write(NO_INSTANCE);
            (&raw mut (*walker).other).write(Hit::none_before(ray.t_max));
            (*walker).stack.reset(root);
            &mut *walker
        }
    }

    /// What is to be visited next.
    #[inline(always)]
    pub fn next(&mut self) -> NodeRef {
        self.stack.pop_within(self.t)
    }

    /// As `next`, where nothing that is beyond the closest hit waits any more. Without a branch; asks for its memory.
    #[inline(always)]
    pub fn next_of_many(&mut self, simd: S, bvh: &Bvh) -> NodeRef {
        let next = self.stack.pop();
        if bvh.prefetches {
            bvh.prefetch(simd, next);
        }
        next
    }

    /// Forgets what waits beyond the closest hit.
    #[inline(always)]
    pub fn forget_beyond(&mut self, simd: S) {
        if !ANY {
            self.stack.forget_beyond(simd, self.t);
        }
    }

    /// Asks for the memory of those that wait.
    #[inline(always)]
    pub fn prefetch_since(&self, simd: S, bvh: &Bvh, depth: usize) {
        for &child in self.stack.since(depth) {
            bvh.prefetch(simd, child);
        }
    }

    #[inline(always)]
    pub fn visit_node(&mut self, simd: S, node: &Node) {
        simd.enter(&self.slabs, node, &mut self.stack);
    }

    /// `NARROW`: the leaf has at most [`super::NARROW`] triangles. `BRANCHES`: guesses whether there is a hit, instead of
    /// waiting for the answer.
    #[inline(always)]
    pub fn visit_leaf<const NARROW: bool, const BRANCHES: bool>(&mut self, simd: S, leaf: &Leaf<'_>) {
        let seen = match NARROW {
            true => simd.project_narrow(&self.sheared, leaf),
            false => self.sheared.project_leaf(simd.eight(), leaf),
        };
        let eight = simd.eight();
        let t_max = eight.splat(self.t);
        let meets = self.sheared.meet(eight, (&self.ray, leaf), &seen, t_max);
        let met = eight.bits(meets.hit) != 0;
        if BRANCHES && !met {
            return;
        }
        self.met |= met;
        if ANY {
            self.stack.clear_if(met);
            return;
        }
        self.keep_closest(eight, leaf, &meets);
        simd.shorten(&mut self.slabs, self.t);
    }

    /// Keeps the closest of a leaf's hits, if there are any. Without a branch.
    #[inline(always)]
    fn keep_closest<E: Eight>(&mut self, eight: E, leaf: &Leaf<'_>, meets: &Meets<E>) {
        let t = eight.select(meets.hit, meets.t, eight.splat(f32::INFINITY));
        let least = eight.least(t);
        let at = eight.bits(eight.and(meets.hit, eight.le(t, eight.splat(least))));
        // No lane if there is no hit.
        let lane = at.trailing_zeros() as usize;
        let [b1, b2] = [eight.extract(meets.b[0], lane), eight.extract(meets.b[1], lane)];
        let any = at != 0;
        self.t = select_unpredictable(any, least, self.t);
        self.b1 = select_unpredictable(any, b1, self.b1);
        self.b2 = select_unpredictable(any, b2, self.b2);
        self.place = select_unpredictable(any, (leaf.first + lane) as u32, self.place);
        self.instance_of_place = select_unpredictable(any, self.instance, self.instance_of_place);
    }

    /// Visits a primitive that is not a triangle: meets it, or enters the tree that it places, of which it pushes the
    /// root.
    #[inline(always)]
    pub fn visit_other(&mut self, simd: S, bvh: &Bvh, other: u32, meet_other: impl Fn(u32, &Ray) -> Met) {
        let (hit, instance) = match meet_other(other, &Ray { t_max: self.t, ..self.ray }) {
            Met::Hit(hit) => (hit, self.instance),
            Met::Placed { ray, .. } if meets_nothing(&ray) => return,
            Met::Placed { tree, ray, instance } => match tree.form {
                Form::Nodes(root) => {
                    debug_assert_eq!(self.instance, NO_INSTANCE, "groups hold no instances");
                    self.stack.push(NodeRef::BACK);
                    self.stack.push(root);
                    return self.move_to(simd, &ray, &tree.bounds, instance);
                }
                Form::Few(few) => {
                    let mut hit = Hit::none_before(self.t);
                    let met = scan::<_, ANY>(simd, bvh.few(few), &ray, &mut hit);
                    (met.then_some(hit), instance)
                }
            },
        };
        let Some(hit) = hit else { return };
        debug_assert!(ANY || (hit.t > 0.0 && hit.t < self.t), "an any hit need not say where it is");
        (self.met, self.t, self.place, self.other) = (true, hit.t, NOWHERE, Hit { instance, ..hit });
        if ANY {
            self.stack.clear_if(true);
        } else {
            simd.shorten(&mut self.slabs, hit.t);
        }
    }

    /// Goes back to where the ray, which is given again, came from.
    #[inline(always)]
    pub fn go_back(&mut self, ray: &Ray) {
        (self.ray, self.instance, self.is_back) = (*ray, NO_INSTANCE, true);
    }

    /// What is to be visited after a primitive that is not a triangle. A ray that is back within `bounds` is made ready
    /// only if it will meet a node or a leaf there.
    #[inline(always)]
    pub fn next_after_other(&mut self, simd: S, bounds: &Bounds3) -> NodeRef {
        let next = self.next();
        if self.is_back && next.kind() != kind::OTHER {
            self.move_to(simd, &Ray { t_max: self.t, ..self.ray }, bounds, NO_INSTANCE);
        }
        next
    }

    #[inline(always)]
    fn move_to(&mut self, simd: S, ray: &Ray, bounds: &Bounds3, instance: u32) {
        self.sheared = Sheared::new(ray.origin, ray.direction);
        self.slabs = simd.slabs(&Line::new(ray.origin, ray.direction, ray.t_max, bounds));
        (self.ray, self.instance, self.is_back) = (*ray, instance, false);
    }

    /// What was hit.
    #[inline(always)]
    pub fn hit(&self, bvh: &Bvh) -> Option<Hit> {
        if !self.met {
            return None;
        }
        if ANY || self.place == NOWHERE {
            return Some(self.other);
        }
        let (shape, primitive) = bvh.leaves.name(self.place);
        Some(Hit { t: self.t, b1: self.b1, b2: self.b2, shape, primitive, instance: self.instance_of_place })
    }
}
