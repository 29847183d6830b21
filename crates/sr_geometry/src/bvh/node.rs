//! Nodes, and references to what is below them.

use super::WIDE;
use super::slots::slots;
use crate::Bounds3;

/// The largest number of triangles, of nodes or of other primitives that a [`NodeRef`] can tell apart.
pub(crate) const MAX_INDEX: usize = (1 << 28) - 1;

/// A child: a node, a leaf of 1 to 8 triangles, or one other primitive.
///
/// From the highest bit: 0, 0, the axis of the node's [`slots`] (2 bits), the node (28); 0, 1, 0, 0, the other primitive (28);
/// 1, triangles less one (3), the first of them (28).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct NodeRef(u32);

/// What a child is: see [`NodeRef::kind`].
pub(crate) mod kind {
    /// A node.
    pub const NODE: usize = 0;
    /// An other primitive, [`super::NodeRef::DONE`] or [`super::NodeRef::BACK`].
    pub const OTHER: usize = 1;
    /// A leaf.
    pub const LEAF: usize = 2;
}

impl NodeRef {
    /// No child: a triangle that no ray hits, which is always the first.
    pub const NONE: Self = Self(Self::LEAF);
    /// What lies below all children that wait for a ray: there are no more.
    pub const DONE: Self = Self(Self::LEAF - 1);
    /// What lies below the children in a placed tree: the ray goes back to the space that it came from.
    pub const BACK: Self = Self(Self::LEAF - 2);
    const LEAF: u32 = 1 << 31;
    const OTHER: u32 = 1 << 30;
    const INDEX: u32 = MAX_INDEX as u32;

    pub fn node(index: usize, axis: usize) -> Self {
        Self((axis as u32) << 28 | index as u32)
    }

    /// Up to eight triangles.
    pub fn leaf(first: usize, count: usize) -> Self {
        Self(Self::LEAF | (count as u32 - 1) << 28 | first as u32)
    }

    pub fn other(index: u32) -> Self {
        Self(Self::OTHER | index)
    }

    /// The same child where `nodes` and `triangles` precede its own.
    pub fn shifted(self, nodes: usize, triangles: usize) -> Self {
        if self.is_node() {
            Self(self.0 + nodes as u32)
        } else if self.is_leaf() && self != Self::NONE {
            Self(self.0 + triangles as u32)
        } else {
            self
        }
    }

    #[inline(always)]
    pub fn is_node(self) -> bool {
        self.0 < Self::OTHER
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 >= Self::LEAF
    }

    #[inline(always)]
    pub fn is_other(self) -> bool {
        self.kind() == kind::OTHER
    }

    /// What to do with it.
    #[inline(always)]
    pub fn kind(self) -> usize {
        let bits = (self.0 >> 30) as usize;
        // 3 is a leaf as well. Without a branch.
        bits - (bits & bits >> 1)
    }

    /// Of a node or an other primitive.
    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0 & Self::INDEX) as usize
    }

    /// The axis of a node's [`slots`].
    #[inline(always)]
    pub fn axis(self) -> u32 {
        self.0 >> 28 & 3
    }

    /// The first triangle of a leaf.
    #[inline(always)]
    pub fn first(self) -> usize {
        (self.0 & Self::INDEX) as usize
    }

    /// Triangles of a leaf.
    #[inline(always)]
    pub fn count(self) -> usize {
        (self.0 >> 28 & 7) as usize + 1
    }
}

/// Boxes of up to sixteen children, and the children. A missing child has the empty box.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// By axis: the smallest, then the largest coordinates.
    pub bounds: [[[f32; WIDE]; 2]; 3],
    pub children: [NodeRef; WIDE],
}

impl Node {
    /// Without children.
    pub const EMPTY: Self = {
        let empty = [[f32::INFINITY; WIDE], [f32::NEG_INFINITY; WIDE]];
        Self { bounds: [empty; 3], children: [NodeRef::NONE; WIDE] }
    };

    /// With at most sixteen children, each in the slot that suits its place, and the axis of the slots.
    pub fn new(children: &[(Bounds3, NodeRef)]) -> (Self, usize) {
        let mut node = Self::EMPTY;
        let (slots, axis) = slots(children);
        for (&(bounds, child), slot) in children.iter().zip(slots) {
            node.children[slot] = child;
            for axis in 0..3 {
                let [min, max] = &mut node.bounds[axis];
                (min[slot], max[slot]) = (bounds.min[axis], bounds.max[axis]);
            }
        }
        (node, axis)
    }
}
