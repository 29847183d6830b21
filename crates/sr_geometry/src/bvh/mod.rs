//! One 16-wide bounding volume hierarchy for triangles, spheres, disks and instances.
//!
//! In: [`PrimRef`]s, a box and an identity each. Out: [`Bvh`], flat arrays of nodes and of leaves of up to eight
//! triangles, and a [`Tree`] per call. `build` decides the tree and `slots` where a node's children go. A `walker` is a ray
//! on its way: `traverse` walks one, `stream` several in turn. `scan` meets the triangles of trees that are not worth a
//! node, `packet` meets small trees with a ray in each lane; `dispatch` chooses the instruction set. Several trees (the
//! world's and the groups') share the arrays.
//!
//! Invariant: every tree is at most [`MAX_DEPTH`] nodes deep, so the traversal stack cannot overflow.

mod batch;
mod build;
mod dispatch;
mod leaves;
mod node;
mod packet;
mod pages;
mod pieces;
mod prepare;
mod prim;
mod scan;
mod sheared;
mod simd;
mod slabs;
mod slots;
mod split;
mod stack;
mod stream;
#[cfg(test)]
mod tests;
mod traverse;
mod walker;

use glam::Vec3;
use rayon::prelude::*;

use crate::{Bounds3, Disk, Hit, NO_INSTANCE, Ray, ShapeId, Sphere};
use simd::Kernel;

use build::MAX_DEPTH;
use leaves::Leaves;
pub(crate) use node::MAX_INDEX;
use node::{Node, NodeRef};
use pieces::Pieces;
use prim::Lanes;
pub(crate) use prim::PrimRef;

/// Triangles that are met at a time in a leaf.
pub(crate) const WIDTH: usize = 8;

/// The most triangles of a leaf.
const LEAF: usize = WIDTH;

/// Children of a node, and triangles of a block that is scanned.
const WIDE: usize = 16;

/// Up to this many triangles get no tree: meeting all of them is faster (see docs/performance.md).
const FEW: usize = 64;

/// Packets meet all of up to this many triangles, and of up to this many spheres and disks (see docs/performance.md).
const FEW_FLATS: usize = 64;
const FEW_ROUNDS: usize = 64;

/// Bytes of nodes and leaves from which traversal prefetches: what a second-level cache surely does not hold.
const PREFETCH_FROM: usize = 1 << 20;

/// A primitive that is neither a triangle nor an instance.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Round<'a> {
    Sphere(ShapeId, &'a Sphere),
    Disk(ShapeId, &'a Disk),
}

/// What a ray meets at a primitive that is not a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Met {
    /// A hit before the ray's end, if there is any.
    Hit(Option<Hit>),
    /// A tree in another space, of triangles and what leads to a `Hit`.
    Placed {
        tree: Tree,
        /// The same ray there, with the same t.
        ray: Ray,
        /// The instance of hits.
        instance: u32,
    },
}

/// Up to [`WIDE`] triangles, transposed. Missing ones have NaN vertices, which no ray hits.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct TriangleBlock {
    /// By vertex, then axis.
    vertices: [[[f32; WIDE]; 3]; 3],
    shape: [u32; WIDE],
    primitive: [u32; WIDE],
}

impl TriangleBlock {
    fn new(prims: &[PrimRef], vertices_of: impl Fn(ShapeId, u32) -> [Vec3; 3]) -> Self {
        let mut block = Self { vertices: [[[f32::NAN; WIDE]; 3]; 3], shape: [0; WIDE], primitive: [0; WIDE] };
        for (lane, prim) in prims.iter().enumerate() {
            let vertices = vertices_of(ShapeId(prim.shape()), prim.primitive());
            for (of_block, vertex) in block.vertices.iter_mut().zip(vertices) {
                for axis in 0..3 {
                    of_block[axis][lane] = vertex[axis];
                }
            }
            block.shape[lane] = prim.shape();
            block.primitive[lane] = prim.primitive();
        }
        block
    }

    /// The vertices of one of the triangles.
    fn triangle(&self, lane: usize) -> [Vec3; 3] {
        self.vertices.map(|vertex| Vec3::from_array(vertex.map(|axis| axis[lane % WIDE])))
    }

    /// The hit of one of the triangles.
    #[inline(always)]
    fn hit(&self, lane: usize, t: f32, [b1, b2]: [f32; 2]) -> Hit {
        let (shape, primitive) = (ShapeId(self.shape[lane % WIDE]), self.primitive[lane % WIDE]);
        Hit { t, b1, b2, shape, primitive, instance: NO_INSTANCE }
    }
}

/// One tree within a [`Bvh`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tree {
    form: Form,
    /// What packets meet, in [`Bvh::pieces`]: once more all of the tree, if it is small.
    pieces: Option<u32>,
    pub bounds: Bounds3,
}

/// How a tree is stored.
#[derive(Clone, Copy, Debug)]
enum Form {
    /// Below a node.
    Nodes(NodeRef),
    /// Without nodes.
    Few(Few),
}

/// As `count` triangles in wide blocks from `first` on; `extent` is the longest side of their box.
#[derive(Clone, Copy, Debug)]
struct Few {
    first: u32,
    count: u32,
    extent: f32,
}

impl Tree {
    /// The tree without primitives.
    pub const EMPTY: Self = Self {
        form: Form::Few(Few { first: 0, count: 0, extent: 0.0 }),
        pieces: None,
        bounds: Bounds3::EMPTY,
    };
}

/// The arrays that all trees share.
#[derive(Debug)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    leaves: Leaves,
    few: Vec<TriangleBlock>,
    pieces: Vec<Pieces>,
    kernel: Kernel,
    /// Is the tree so large that memory is worth asking for ahead of need?
    prefetches: bool,
}

impl Bvh {
    pub fn new() -> Self {
        let kernel = Kernel::detect();
        Self {
            nodes: Vec::new(),
            leaves: Leaves::new(),
            few: Vec::new(),
            pieces: Vec::new(),
            kernel,
            prefetches: false,
        }
    }

    /// Builds a tree over `prims`, which it reorders. `vertices_of` fetches a triangle's vertices.
    pub fn add_tree(
        &mut self,
        prims: &mut [PrimRef],
        vertices_of: impl Fn(ShapeId, u32) -> [Vec3; 3] + Sync,
    ) -> Tree {
        let bounds = prims.par_iter().map(PrimRef::lanes).reduce(|| Lanes::EMPTY, Lanes::union).bounds();
        if prims.len() <= FEW && prims.iter().all(PrimRef::is_triangle) {
            let (first, count) = (self.few.len() as u32, prims.len() as u32);
            let form = Form::Few(Few { first, count, extent: bounds.extent().max_element() });
            self.few.extend(prims.chunks(WIDE).map(|prims| TriangleBlock::new(prims, &vertices_of)));
            return Tree { form, pieces: None, bounds };
        }
        let (nodes, triangles) = (self.nodes.len(), self.leaves.count());
        let mut tree = build::build(prims);
        tree.shift(nodes, triangles);
        pages::reserve(&mut self.nodes, tree.nodes.len());
        self.nodes.append(&mut tree.nodes);
        self.leaves.append(&tree.leaves, prims, vertices_of);
        self.prefetches = self.memory_bytes() > PREFETCH_FROM;
        Tree { form: Form::Nodes(tree.root), pieces: None, bounds }
    }

    /// Makes a tree that was built from `prims` ready for packets, if it is fit for them. `round_of` tells what those
    /// are that are no triangles; `None`: instances.
    pub fn add_pieces<'a>(
        &mut self,
        tree: &mut Tree,
        prims: &[PrimRef],
        vertices_of: impl Fn(ShapeId, u32) -> [Vec3; 3],
        round_of: impl Fn(u32) -> Option<Round<'a>>,
    ) {
        let flats = prims.iter().filter(|p| p.is_triangle()).count();
        if flats > FEW_FLATS || prims.len() - flats > FEW_ROUNDS {
            return;
        }
        if let Some(pieces) = Pieces::new(prims, vertices_of, round_of) {
            tree.pieces = Some(self.pieces.len() as u32);
            self.pieces.push(pieces);
        }
    }

    /// The blocks of few triangles, the number of these, and the longest side of their box.
    #[inline(always)]
    fn few(&self, Few { first, count, extent }: Few) -> (&[TriangleBlock], usize, f32) {
        let count = count as usize;
        (&self.few[first as usize..][..count.div_ceil(WIDE)], count, extent)
    }

    /// Bytes of nodes and triangles.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
            + self.leaves.memory_bytes()
            + size_of_val(&self.few[..])
            + self.pieces.iter().map(Pieces::memory_bytes).sum::<usize>()
    }
}
