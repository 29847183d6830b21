//! The triangles of all leaves, without gaps: a leaf takes as many lanes as it has triangles.

use std::ops::Range;

use glam::Vec3;
use rayon::prelude::*;

use super::sheared::Triangles;
use super::simd::Eight;
use super::{NodeRef, PrimRef, WIDTH, pages};
use crate::ShapeId;

/// Coordinates of a triangle.
const SIZE: usize = 9;

/// Leaves that one task writes.
const TASK: usize = 1 << 10;

/// Triangles in the order of the leaves. The first belongs to no leaf, and no ray hits it.
#[derive(Debug)]
pub(super) struct Leaves {
    /// Leaf after leaf: by axis, then vertex, then triangle. The last leaf is followed by what completes its last row to
    /// eight lanes.
    vertices: Vec<f32>,
    /// Shapes, and triangles within their meshes.
    ids: Vec<[u32; 2]>,
}

impl Leaves {
    pub fn new() -> Self {
        Self { vertices: vec![f32::NAN; SIZE + WIDTH - 1], ids: vec![[0; 2]] }
    }

    /// Triangles in leaves.
    pub fn count(&self) -> usize {
        self.ids.len() - 1
    }

    /// Appends leaves, which follow one another in `prims` but for primitives that are no triangles.
    pub fn append(
        &mut self,
        leaves: &[Range<usize>],
        prims: &[PrimRef],
        vertices_of: impl Fn(ShapeId, u32) -> [Vec3; 3] + Sync,
    ) {
        let count: usize = leaves.iter().map(Range::len).sum();
        self.vertices.truncate(SIZE * self.ids.len());
        pages::reserve(&mut self.vertices, SIZE * count + WIDTH - 1);
        pages::reserve(&mut self.ids, count);
        let (first_vertex, first_id) = (self.vertices.len(), self.ids.len());
        self.vertices.resize(first_vertex + SIZE * count + WIDTH - 1, f32::NAN);
        self.ids.resize(first_id + count, [0; 2]);
        let (mut vertices, mut ids) = (&mut self.vertices[first_vertex..], &mut self.ids[first_id..]);
        let mut tasks = Vec::new();
        for leaves in leaves.chunks(TASK) {
            let count: usize = leaves.iter().map(Range::len).sum();
            let (of_vertices, of_ids);
            (of_vertices, vertices) = vertices.split_at_mut(SIZE * count);
            (of_ids, ids) = ids.split_at_mut(count);
            tasks.push((leaves, of_vertices, of_ids));
        }
        tasks.into_par_iter().for_each(|(leaves, mut vertices, mut ids)| {
            for leaf in leaves {
                let (of_vertices, of_ids);
                (of_vertices, vertices) = vertices.split_at_mut(SIZE * leaf.len());
                (of_ids, ids) = ids.split_at_mut(leaf.len());
                write(&prims[leaf.clone()], &vertices_of, of_vertices, of_ids);
            }
        });
    }

    /// The triangles of a reference to a leaf.
    #[inline(always)]
    pub fn leaf(&self, leaf: NodeRef) -> Leaf<'_> {
        debug_assert!(leaf.is_leaf() && leaf.first() + leaf.count() <= self.ids.len());
        // SAFETY: references to leaves are made by the builder, for leaves that are then appended.
        let vertices = unsafe { self.vertices.get_unchecked(SIZE * leaf.first()..) };
        Leaf { vertices, count: leaf.count(), first: leaf.first() }
    }

    /// Where a leaf starts. Any reference will do.
    #[inline(always)]
    pub fn place(&self, leaf: NodeRef) -> *const u8 {
        self.vertices.as_ptr().wrapping_add(SIZE * leaf.first()).cast()
    }

    /// The shape and the primitive of the triangle at a place.
    #[inline(always)]
    pub fn name(&self, place: u32) -> (ShapeId, u32) {
        let [shape, primitive] = self.ids[place as usize];
        (ShapeId(shape), primitive)
    }

    /// The triangle with this place.
    #[cfg(test)]
    pub fn id(&self, place: usize) -> [u32; 2] {
        self.ids[place]
    }

    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.vertices[..]) + size_of_val(&self.ids[..])
    }
}

fn write(
    prims: &[PrimRef],
    vertices_of: impl Fn(ShapeId, u32) -> [Vec3; 3],
    to_vertices: &mut [f32],
    to_ids: &mut [[u32; 2]],
) {
    for (lane, (prim, id)) in prims.iter().zip(to_ids).enumerate() {
        *id = [prim.shape(), prim.primitive()];
        let vertices = vertices_of(ShapeId(prim.shape()), prim.primitive());
        for (vertex, coordinates) in vertices.iter().enumerate() {
            for axis in 0..3 {
                to_vertices[(3 * axis + vertex) * prims.len() + lane] = coordinates[axis];
            }
        }
    }
}

/// Up to [`LEAF`] triangles.
#[derive(Clone, Copy)]
pub(super) struct Leaf<'a> {
    /// Theirs, and at least as many more as complete the last row to eight lanes.
    vertices: &'a [f32],
    pub count: usize,
    /// The place of the first.
    pub first: usize,
}

impl<S: Eight> Triangles<S> for Leaf<'_> {
    #[inline(always)]
    unsafe fn coordinate(&self, simd: S, vertex: usize, axis: usize) -> S::F {
        // SAFETY: by the caller's promise there is such a row, and its eight lanes are within `vertices`.
        simd.load(unsafe {
            &*self.vertices.as_ptr().add(axis * (3 * self.count)).add(vertex * self.count).cast()
        })
    }

    fn vertices(&self, lane: usize) -> [Vec3; 3] {
        let at = |vertex: usize, axis: usize| self.vertices[(3 * axis + vertex) * self.count + lane];
        [0, 1, 2].map(|vertex| Vec3::new(at(vertex, 0), at(vertex, 1), at(vertex, 2)))
    }
}
