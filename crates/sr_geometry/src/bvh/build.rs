//! From primitives to a tree of 16-wide nodes.
//!
//! A node starts with one child, all its primitives, and cuts the child with the largest area in two until it has
//! sixteen: the surface area heuristic's greedy collapse of a binary tree, without making that tree.

use std::ops::Range;

use rayon::prelude::*;

use super::split::{Extent, split_middle, split_sah};
use super::{LEAF, Node, NodeRef, PrimRef, WIDE};

/// The largest number of nodes on a path from the root to a leaf.
pub(super) const MAX_DEPTH: usize = 28;

/// Subtrees of more primitives than this are built in parallel.
const PARALLEL: usize = 1 << 12;

/// What fits a leaf is cut further only if the areas of its parts sum to less than this of its own.
const WORTH_CUTTING: f32 = 1.2;

/// So many triangles fill a lowest node well. The node above is not to cut parts that small any further: many lowest nodes
/// with few leaves each would take more memory and more steps than few full ones.
const FILLS_A_NODE: usize = 5 * WIDE;

/// A tree whose leaves are still ranges of the primitives.
pub(super) struct BuiltTree {
    pub root: NodeRef,
    pub nodes: Vec<Node>,
    pub leaves: Vec<Range<usize>>,
    triangles: usize,
}

impl BuiltTree {
    fn new() -> Self {
        Self { root: NodeRef::NONE, nodes: Vec::new(), leaves: Vec::new(), triangles: 0 }
    }

    /// Makes its references those after `nodes` and `triangles` earlier ones.
    pub fn shift(&mut self, nodes: usize, triangles: usize) {
        let children = self.nodes.iter_mut().flat_map(|node| &mut node.children);
        for child in children.chain([&mut self.root]) {
            *child = child.shifted(nodes, triangles);
        }
    }

    fn append(&mut self, mut subtree: Self) -> NodeRef {
        subtree.shift(self.nodes.len(), self.triangles);
        self.nodes.append(&mut subtree.nodes);
        self.leaves.append(&mut subtree.leaves);
        self.triangles += subtree.triangles;
        subtree.root
    }
}

/// A part of the primitives that will become a child.
struct Part {
    range: Range<usize>,
    extent: Extent,
    half_area: f32,
    /// Is it better, or only possible, to leave it whole?
    done: bool,
}

impl Part {
    fn new(range: Range<usize>, extent: Extent) -> Self {
        Self { half_area: extent.bounds.half_area(), extent, done: range.len() <= 1, range }
    }
}

/// Builds the tree over at least one primitive, reordering `prims`. The result does not depend on the number of threads.
/// Its root is a node.
pub(super) fn build(prims: &mut [PrimRef]) -> BuiltTree {
    let mut tree = BuiltTree::new();
    let extent = Extent::of(prims);
    tree.root = build_subtree(prims, extent, 0, 1, &mut tree);
    if !tree.root.is_node() {
        let (node, axis) = Node::new(&[(extent.bounds.bounds(), tree.root)]);
        tree.nodes.push(node);
        tree.root = NodeRef::node(0, axis);
    }
    tree
}

/// Can these primitives be one leaf?
fn fits_leaf(prims: &[PrimRef]) -> bool {
    prims.len() == 1 || (prims.len() <= LEAF && prims.iter().all(PrimRef::is_triangle))
}

/// Appends the tree over `prims`, the primitives from `first` on, to `tree`.
fn build_subtree(
    prims: &mut [PrimRef],
    extent: Extent,
    first: usize,
    depth: usize,
    tree: &mut BuiltTree,
) -> NodeRef {
    if fits_leaf(prims) {
        if !prims[0].is_triangle() {
            return NodeRef::other(prims[0].primitive());
        }
        tree.leaves.push(first..first + prims.len());
        tree.triangles += prims.len();
        // After the triangle that is in no leaf.
        return NodeRef::leaf(1 + tree.triangles - prims.len(), prims.len());
    }
    let parts = cut(prims, extent, depth);
    let index = tree.nodes.len();
    tree.nodes.push(Node::EMPTY);
    let children = build_children(prims, &parts, first, depth, tree);
    let bounds = parts.iter().map(|part| part.extent.bounds.bounds());
    let (node, axis) = Node::new(&bounds.zip(children).collect::<Vec<_>>());
    tree.nodes[index] = node;
    NodeRef::node(index, axis)
}

fn build_children(
    prims: &mut [PrimRef],
    parts: &[Part],
    first: usize,
    depth: usize,
    tree: &mut BuiltTree,
) -> Vec<NodeRef> {
    if prims.len() <= PARALLEL {
        let build = |part: &Part| {
            let range = part.range.clone();
            let first = first + range.start;
            build_subtree(&mut prims[range], part.extent, first, depth + 1, tree)
        };
        return parts.iter().map(build).collect();
    }
    let mut slices = Vec::with_capacity(parts.len());
    let mut rest = prims;
    for part in parts {
        let (slice, tail) = rest.split_at_mut(part.range.len());
        slices.push((slice, part.extent, first + part.range.start));
        rest = tail;
    }
    let build = |(slice, extent, first)| {
        let mut subtree = BuiltTree::new();
        subtree.root = build_subtree(slice, extent, first, depth + 1, &mut subtree);
        subtree
    };
    let subtrees: Vec<BuiltTree> = slices.into_par_iter().map(build).collect();
    subtrees.into_iter().map(|subtree| tree.append(subtree)).collect()
}

/// Reorders `prims` and cuts them into at least two and at most sixteen parts, which follow one another.
fn cut(prims: &mut [PrimRef], extent: Extent, depth: usize) -> Vec<Part> {
    let mut parts = Vec::with_capacity(WIDE);
    parts.push(Part::new(0..prims.len(), extent));
    let balanced = depth + balanced_depth(prims.len()) >= MAX_DEPTH;
    // What is no triangle is a leaf by itself.
    let full = if prims[0].is_triangle() { FILLS_A_NODE } else { WIDE };
    let is_above_lowest = prims.len() > full && prims.len() <= WIDE * full;
    while parts.len() < WIDE {
        let open = parts.iter().enumerate().filter(|(_, part)| !part.done);
        let size = |part: &Part| if balanced { part.range.len() as f32 } else { part.half_area };
        let Some((widest, _)) = open.max_by(|(_, a), (_, b)| size(a).total_cmp(&size(b))) else {
            break;
        };
        let (range, extent, half_area) =
            (parts[widest].range.clone(), parts[widest].extent, parts[widest].half_area);
        let prims = &mut prims[range.clone()];
        let is_leaf = fits_leaf(prims);
        if !is_leaf && is_above_lowest && prims.len() <= full {
            parts[widest].done = true;
            continue;
        }
        let limit = if is_leaf { WORTH_CUTTING * half_area } else { f32::INFINITY };
        let by_area = if balanced { None } else { split_sah(prims, &extent, limit) };
        let Some(cut) = by_area.or_else(|| (!is_leaf).then(|| split_middle(prims, &extent))) else {
            parts[widest].done = true;
            continue;
        };
        let middle = range.start + cut.middle;
        let [left, right] = cut.parts;
        parts[widest] = Part::new(range.start..middle, left);
        parts.insert(widest + 1, Part::new(middle..range.end, right));
    }
    parts
}

/// Levels that are enough for `count` primitives if every node cuts them into sixteen parts whose sizes differ by
/// at most a factor of two: each level leaves at most an eighth of the largest part.
fn balanced_depth(count: usize) -> usize {
    1 + (usize::BITS - count.leading_zeros()).div_ceil(3) as usize
}
