//! Catmull and Clark's scheme for polygons (Catmull & Clark 1978); limits by Halstead, Kass & DeRose 1993.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::topology::{Edges, Rings, Surface};
use super::{Limit, mean};

/// Each polygon as a quadrilateral for each of its corners.
pub fn refined(surface: &Surface, edges: &Edges) -> Surface {
    let old = &surface.positions;
    let middles: Vec<DVec3> = (0..surface.face_count()).map(|face| surface.middle(face)).collect();
    let mut of_faces = vec![DVec3::ZERO; old.len()];
    for (face, middle) in middles.iter().enumerate() {
        surface.face(face).iter().for_each(|&i| of_faces[i as usize] += *middle);
    }
    let mut positions: Vec<DVec3> = edges
        .surroundings(surface)
        .iter()
        .zip(old)
        .zip(of_faces)
        .map(|((around, &p), of_faces)| {
            let inner = |p: DVec3| {
                // (Q + 2 R + (n − 3) p) / n, R being the mean of the edges' middles
                let n = f64::from(around.valence);
                let (q, r) = (of_faces / n, 0.5 * (p + around.neighbours / n));
                (q + 2.0 * r + (n - 3.0) * p) / n
            };
            around.boundary_rule(p, 0.125).unwrap_or_else(|| inner(p))
        })
        .collect();
    let first_edge = positions.len() as u32;
    positions.extend(edges.list.iter().map(|edge| {
        let ends: DVec3 = edge.ends.iter().map(|&i| old[i as usize]).sum();
        if edge.is_boundary() {
            return 0.5 * ends;
        }
        let faces: DVec3 = edge.faces.iter().map(|&face| middles[face as usize]).sum();
        0.25 * (ends + faces)
    }));
    let first_face = positions.len() as u32;
    positions.extend(middles);
    let mut out = Surface::new(positions);
    for face in 0..surface.face_count() {
        let (corners, uvs) = (surface.face(face), surface.face_uvs(face));
        let (first, n) = (surface.range(face).start, corners.len());
        for i in 0..n {
            let before = (i + n - 1) % n;
            let [to, from] = [i, before].map(|k| first_edge + edges.after[first + k]);
            let quad = [corners[i], to, first_face + face as u32, from];
            if uvs.is_empty() {
                out.add_face(&quad, []);
            } else {
                let [to, from] = [(i + 1) % n, before].map(|k| mean(&[uvs[i], uvs[k]]));
                out.add_face(&quad, [uvs[i], to, mean(uvs), from]);
            }
        }
    }
    out
}

/// Where the vertices of quadrilaterals end, and the normals of inner ones.
pub fn limit(surface: &Surface, edges: &Edges) -> Limit {
    let rings = Rings::of(surface);
    let around = edges.surroundings(surface);
    let old = &surface.positions;
    let mut opposite = vec![DVec3::ZERO; old.len()];
    for face in 0..surface.face_count() {
        let corners = surface.face(face);
        for (i, &vertex) in corners.iter().enumerate() {
            opposite[vertex as usize] += old[corners[(i + 2) % corners.len()] as usize];
        }
    }
    let inner = |i: usize| {
        let n = f64::from(around[i].valence);
        (n * n * old[i] + 4.0 * around[i].neighbours + opposite[i]) / (n * (n + 5.0))
    };
    let positions = (0..old.len())
        .into_par_iter()
        .map(|i| around[i].boundary_rule(old[i], 1.0 / 6.0).unwrap_or_else(|| inner(i)))
        .collect();
    let normal = |i: usize| {
        let ring = rings.around(surface, i).filter(|_| around[i].boundary_edges == 0)?;
        let n = ring.len();
        let turn = |k: usize| TAU * k as f64 / n as f64;
        let cos = turn(1).cos();
        let of_edges = 1.0 + cos + (PI / n as f64).cos() * (2.0 * (9.0 + cos)).sqrt();
        let (mut along, mut across) = (DVec3::ZERO, DVec3::ZERO);
        for (k, &(edge, face)) in ring.iter().enumerate() {
            let (edge, face) = (old[edge as usize], old[face as usize]);
            along += of_edges * turn(k).cos() * edge + (turn(k).cos() + turn(k + 1).cos()) * face;
            across += of_edges * turn(k).sin() * edge + (turn(k).sin() + turn(k + 1).sin()) * face;
        }
        Some(along.cross(across))
    };
    let normals = (0..old.len()).into_par_iter().map(|i| normal(i).unwrap_or(DVec3::ZERO)).collect();
    Limit { positions, normals }
}
