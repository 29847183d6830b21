//! Faces of any number of corners, the edges between them, and what is around a vertex.

use std::ops::Range;

use glam::{DVec3, Vec2};
use rayon::prelude::*;

/// Rings of more faces are not followed: their normals come from the faces.
const MAX_RING: usize = 256;

/// Polygons over shared vertices.
pub struct Surface {
    pub positions: Vec<DVec3>,
    /// Where each face's corners start; one more than there are faces.
    starts: Vec<u32>,
    pub corners: Vec<u32>,
    /// Texture coordinates of each corner, or none.
    pub uvs: Vec<Vec2>,
}

impl Surface {
    /// Vertices without faces.
    pub fn new(positions: Vec<DVec3>) -> Self {
        Self { positions, starts: vec![0], corners: Vec::new(), uvs: Vec::new() }
    }

    pub fn add_face(&mut self, corners: &[u32], uvs: impl IntoIterator<Item = Vec2>) {
        self.corners.extend_from_slice(corners);
        self.uvs.extend(uvs);
        self.starts.push(self.corners.len() as u32);
    }

    pub fn face_count(&self) -> usize {
        self.starts.len() - 1
    }

    pub fn range(&self, face: usize) -> Range<usize> {
        self.starts[face] as usize..self.starts[face + 1] as usize
    }

    pub fn face(&self, face: usize) -> &[u32] {
        &self.corners[self.range(face)]
    }

    /// Texture coordinates of a face's corners; none if there are none at all.
    pub fn face_uvs(&self, face: usize) -> &[Vec2] {
        if self.uvs.is_empty() { &[] } else { &self.uvs[self.range(face)] }
    }

    /// The mean of a face's corners.
    pub fn middle(&self, face: usize) -> DVec3 {
        let corners = self.face(face);
        corners.iter().map(|&i| self.positions[i as usize]).sum::<DVec3>() / corners.len() as f64
    }
}

/// An edge.
pub struct Edge {
    /// Its ends.
    pub ends: [u32; 2],
    /// The first and the last face at it.
    pub faces: [u32; 2],
    /// How many faces are at it.
    pub count: u32,
}

impl Edge {
    /// Has the surface an end here, or a seam of more than two faces?
    pub fn is_boundary(&self) -> bool {
        self.count != 2
    }
}

/// All edges, and which follow each corner.
pub struct Edges {
    pub list: Vec<Edge>,
    /// Per corner of the surface: the edge to the next corner of its face.
    pub after: Vec<u32>,
}

impl Edges {
    pub fn of(surface: &Surface) -> Self {
        // Both ends, the corner where it begins, its face: sides of one edge are neighbours once these are sorted.
        let mut sides: Vec<[u32; 4]> = Vec::with_capacity(surface.corners.len());
        for face in 0..surface.face_count() {
            let (range, corners) = (surface.range(face), surface.face(face));
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                sides.push([a.min(b), a.max(b), (range.start + i) as u32, face as u32]);
            }
        }
        sides.par_sort_unstable();
        let mut edges = Self { list: Vec::new(), after: vec![0; sides.len()] };
        for sides in sides.chunk_by(|x, y| x[..2] == y[..2]) {
            let [low, high, corner, face] = sides[0];
            let start = surface.corners[corner as usize];
            let ends = [start, if start == low { high } else { low }];
            let last = sides[sides.len() - 1][3];
            sides.iter().for_each(|side| edges.after[side[2] as usize] = edges.list.len() as u32);
            edges.list.push(Edge { ends, faces: [face, last], count: sides.len() as u32 });
        }
        edges
    }

    /// What each vertex has around it.
    pub fn surroundings(&self, surface: &Surface) -> Vec<Around> {
        let mut around = vec![Around::default(); surface.positions.len()];
        for edge in &self.list {
            let [a, b] = edge.ends.map(|i| i as usize);
            for (at, other) in [(a, b), (b, a)] {
                let neighbour = surface.positions[other];
                around[at].valence += 1;
                around[at].neighbours += neighbour;
                if edge.is_boundary() {
                    around[at].boundary_edges += 1;
                    around[at].on_boundary += neighbour;
                }
            }
        }
        around
    }
}

/// Sums over what is around a vertex.
#[derive(Clone, Copy, Default)]
pub struct Around {
    /// Edges at the vertex.
    pub valence: u32,
    /// Sum of their other ends.
    pub neighbours: DVec3,
    pub boundary_edges: u32,
    /// Sum of the other ends of these.
    pub on_boundary: DVec3,
}

impl Around {
    /// The vertex rule of a boundary: `outer` of each neighbour on it. `None` inside; a corner where boundaries meet stays.
    pub fn boundary_rule(&self, p: DVec3, outer: f64) -> Option<DVec3> {
        match self.boundary_edges {
            0 if self.valence > 0 => None,
            2 => Some((1.0 - 2.0 * outer) * p + outer * self.on_boundary),
            _ => Some(p),
        }
    }
}

/// The faces around each vertex.
pub struct Rings {
    starts: Vec<u32>,
    /// Places in [`Surface::corners`], vertex after vertex, and their faces.
    corners: Vec<(u32, u32)>,
}

impl Rings {
    pub fn of(surface: &Surface) -> Self {
        let mut starts = vec![0u32; surface.positions.len() + 1];
        surface.corners.iter().for_each(|&v| starts[v as usize + 1] += 1);
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut corners = vec![(0, 0); surface.corners.len()];
        for face in 0..surface.face_count() {
            for corner in surface.range(face) {
                let slot = &mut next[surface.corners[corner] as usize];
                corners[*slot as usize] = (corner as u32, face as u32);
                *slot += 1;
            }
        }
        Self { starts, corners }
    }

    /// The neighbours of an inner vertex counter-clockwise, each with the corner that follows it in the face between it
    /// and the next neighbour; `None` if they do not make one ring.
    pub fn around(&self, surface: &Surface, vertex: usize) -> Option<Vec<(u32, u32)>> {
        let own = &self.corners[self.starts[vertex] as usize..self.starts[vertex + 1] as usize];
        if own.len() < 3 || own.len() > MAX_RING {
            return None;
        }
        // in each face: the corner after the vertex, the one after that, and the one before the vertex
        let spans: Vec<[u32; 3]> = own
            .iter()
            .map(|&(corner, face)| {
                let (range, corners) = (surface.range(face as usize), surface.face(face as usize));
                let at = corner as usize - range.start;
                [1, 2, corners.len() - 1].map(|step| corners[(at + step) % corners.len()])
            })
            .collect();
        let mut ring = Vec::with_capacity(spans.len());
        let mut at = spans[0];
        for _ in 0..spans.len() {
            ring.push((at[0], at[1]));
            at = *spans.iter().find(|span| span[0] == at[2])?;
        }
        (at == spans[0]).then_some(ring)
    }
}
