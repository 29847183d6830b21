//! A ray on its way through a tree: what it does at a node, at a leaf and at an other primitive.
//!
//! The ray itself is not here, but with whoever walks it: one ray is best kept at hand, many lie side by side.

use std::mem::MaybeUninit;

use super::leaves::Leaf;
use super::scan::scan;
use super::sheared::{Meets, Sheared};
use super::simd::{Eight, Lanes, Walk};
use super::slabs::Line;
use super::stack::Stack;
use super::traverse::meets_nothing;
use super::{Bvh, Form, Met, NodeRef};
use crate::{Bounds3, Hit, NO_INSTANCE, Ray};

/// Of what is no triangle.
const NOWHERE: u32 = u32::MAX;

/// A ray under way. `ANY`: any hit will do, and is not told.
#[repr(C, align(64))]
pub(super) struct Walker<const ANY: bool> {
    /// The closest hit so far, or the end of the ray.
    pub t: f32,
    b1: f32,
    b2: f32,
    /// Where the triangle that was hit is in the leaves, or [`NOWHERE`].
    place: u32,
    /// The instance that this triangle is in.
    instance_of_place: u32,
    /// The instance in whose space the ray is.
    pub instance: u32,
    /// The number of the ray.
    pub ray: usize,
    met: bool,
    /// Did it come back from an instance, and is not ready yet to meet what is outside?
    is_back: bool,
    pub stack: Stack,
    /// What was hit if no triangle was.
    other: MaybeUninit<Hit>,
}

/// What a ray does at an other primitive.
pub(super) enum Turn {
    /// It stays in its space.
    Stays,
    /// It goes on in the space of an instance, among boxes within some bounds.
    Enters(Ray, Bounds3),
}

impl<const ANY: bool> Walker<ANY> {
    /// Starts, with nothing to visit yet. `ray` is a number.
    #[inline(always)]
    pub fn start(place: &mut MaybeUninit<Self>, ray: usize, t_max: f32) -> &mut Self {
        let walker = place.as_mut_ptr();
        // SAFETY: everything is written, but for the places of the stack that are not in use, and `other`, which is read
        // only where it was written.
        unsafe {
            (&raw mut (*walker).t).write(t_max);
            (&raw mut (*walker).b1).write(0.0);
            (&raw mut (*walker).b2).write(0.0);
            (&raw mut (*walker).place).write(NOWHERE);
            (&raw mut (*walker).instance_of_place).write(NO_INSTANCE);
            (&raw mut (*walker).instance).write(NO_INSTANCE);
            (&raw mut (*walker).ray).write(ray);
            (&raw mut (*walker).met).write(false);
            (&raw mut (*walker).is_back).write(false);
            (*walker).stack.reset();
            &mut *walker
        }
    }

    /// What is to be visited next.
    #[inline(always)]
    pub fn next(&mut self) -> NodeRef {
        if ANY { self.stack.pop() } else { self.stack.pop_within(self.t) }
    }

    /// Forgets what waits beyond the closest hit.
    #[inline(always)]
    pub fn forget_beyond<S: Walk>(&mut self, simd: S) {
        if !ANY {
            self.stack.forget_beyond(simd, self.t);
        }
    }

    /// Asks for the memory of those that wait.
    #[inline(always)]
    pub fn prefetch_since<S: Walk>(&self, simd: S, bvh: &Bvh, depth: usize) {
        for &child in self.stack.since(depth) {
            bvh.prefetch(simd, child);
        }
    }

    /// Visits a node; returns what is to be visited next, which may be beyond the closest hit.
    #[inline(always)]
    pub fn visit_node<S: Walk>(&mut self, simd: S, line: &Line, bvh: &Bvh, child: NodeRef) -> NodeRef {
        simd.enter::<ANY>(line, self.t, bvh.node(child), line.flip(child.axis()), &mut self.stack)
    }

    /// Visits a leaf; is anything hit there? `BRANCHES`: guesses whether the ray passes through a triangle, instead of
    /// waiting for the answer. `ray` is asked for only in doubt.
    #[inline(always)]
    pub fn visit_leaf<S: Walk, const BRANCHES: bool>(
        &mut self,
        simd: S,
        sheared: &Sheared,
        leaf: &Leaf<'_>,
        ray: impl Fn() -> Ray,
    ) -> bool {
        let eight = simd.eight();
        let seen = sheared.project_leaf(eight, leaf);
        if BRANCHES && eight.bits(seen.inside) == 0 {
            return false;
        }
        let t_max = eight.splat(self.t);
        let meets = sheared.meet(eight, leaf, &seen, t_max, ray);
        let met = eight.bits(meets.hit) != 0;
        if ANY {
            self.met |= met;
            self.stack.clear_if(met);
            return met;
        }
        if met {
            self.met = true;
            self.keep_closest(eight, leaf, &meets);
        }
        met
    }

    /// Keeps the closest of a leaf's hits, of which there are some.
    #[inline(always)]
    fn keep_closest<E: Eight>(&mut self, eight: E, leaf: &Leaf<'_>, meets: &Meets<E>) {
        let t = eight.select(meets.hit, meets.t, eight.splat(f32::INFINITY));
        self.t = eight.least(t);
        let at = eight.bits(eight.and(meets.hit, eight.le(t, eight.splat(self.t))));
        let lane = at.trailing_zeros() as usize;
        [self.b1, self.b2] = [eight.extract(meets.b[0], lane), eight.extract(meets.b[1], lane)];
        self.place = (leaf.first + lane) as u32;
        self.instance_of_place = self.instance;
    }

    /// Visits a primitive that is not a triangle: meets it, or enters the tree that it places, of which it pushes the
    /// root. `ray` is where the walker is.
    #[inline(always)]
    pub fn visit_other<S: Walk>(
        &mut self,
        simd: S,
        bvh: &Bvh,
        ray: &Ray,
        other: u32,
        meet_other: impl Fn(u32, &Ray) -> Met,
    ) -> Turn {
        let (hit, instance) = match meet_other(other, &Ray { t_max: self.t, ..*ray }) {
            Met::Hit(hit) => (hit, self.instance),
            Met::Placed { ray, .. } if meets_nothing(&ray) => return Turn::Stays,
            Met::Placed { tree, ray, instance } => match tree.form {
                Form::Nodes(root) => {
                    debug_assert_eq!(self.instance, NO_INSTANCE, "groups hold no instances");
                    self.stack.push(NodeRef::BACK);
                    self.stack.push(root);
                    (self.instance, self.is_back) = (instance, false);
                    return Turn::Enters(ray, tree.bounds);
                }
                Form::Few(few) => {
                    let mut hit = Hit::none_before(self.t);
                    let met = scan::<_, ANY>(simd, bvh.few(few), &ray, &mut hit);
                    (met.then_some(hit), instance)
                }
            },
        };
        if let Some(hit) = hit {
            debug_assert!(ANY || (hit.t > 0.0 && hit.t < self.t), "an any hit need not say where it is");
            (self.met, self.t, self.place) = (true, hit.t, NOWHERE);
            self.other.write(Hit { instance, ..hit });
            if ANY {
                self.stack.clear_if(true);
            }
        }
        Turn::Stays
    }

    /// Goes back to where the ray came from.
    #[inline(always)]
    pub fn go_back(&mut self) {
        (self.instance, self.is_back) = (NO_INSTANCE, true);
    }

    /// Is the ray back from an instance, and must be made ready now that it will meet a node or a leaf?
    #[inline(always)]
    pub fn arrives(&mut self, next: NodeRef) -> bool {
        let arrives = self.is_back && !next.is_other();
        self.is_back &= !arrives;
        arrives
    }

    /// What was hit.
    #[inline(always)]
    pub fn hit(&self, bvh: &Bvh) -> Option<Hit> {
        if !self.met {
            return None;
        }
        if ANY {
            return Some(Hit::none_before(self.t));
        }
        if self.place == NOWHERE {
            // SAFETY: if something was hit which is no triangle, it was written.
            return Some(unsafe { self.other.assume_init() });
        }
        let (shape, primitive) = bvh.leaves.name(self.place);
        Some(Hit { t: self.t, b1: self.b1, b2: self.b2, shape, primitive, instance: self.instance_of_place })
    }
}
