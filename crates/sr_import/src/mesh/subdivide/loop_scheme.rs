//! Loop's scheme for triangles (Loop 1987), with the weights of Warren 1995, as in pbrt.

use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;

use super::topology::{Edges, Rings, Surface};
use super::{Limit, mean};

/// What each neighbour weighs in the rule of an inner vertex.
fn beta(valence: u32) -> f64 {
    if valence == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * f64::from(valence)) }
}

/// Each triangle as four.
pub fn refined(surface: &Surface, edges: &Edges) -> Surface {
    let old = &surface.positions;
    let mut positions: Vec<DVec3> = edges
        .surroundings(surface)
        .iter()
        .zip(old)
        .map(|(around, &p)| {
            let inner = |p| {
                let beta = beta(around.valence);
                (1.0 - f64::from(around.valence) * beta) * p + beta * around.neighbours
            };
            around.boundary_rule(p, 0.125).unwrap_or_else(|| inner(p))
        })
        .collect();
    let first_edge = positions.len() as u32;
    positions.extend(edges.list.iter().map(|edge| {
        let [a, b] = edge.ends.map(|i| old[i as usize]);
        if edge.is_boundary() {
            return 0.5 * (a + b);
        }
        // the corners of its two triangles that are not its ends
        let opposite: DVec3 = edge
            .faces
            .iter()
            .flat_map(|&face| surface.face(face as usize))
            .filter(|i| !edge.ends.contains(i))
            .map(|&i| old[i as usize])
            .sum();
        0.375 * (a + b) + 0.125 * opposite
    }));
    let mut out = Surface::new(positions);
    for face in 0..surface.face_count() {
        let (&[a, b, c], range) =
            (surface.face(face).first_chunk().expect("a triangle"), surface.range(face));
        let [ab, bc, ca] = [0, 1, 2].map(|i| first_edge + edges.after[range.start + i]);
        let uvs = surface.face_uvs(face);
        let faces = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        if uvs.is_empty() {
            faces.iter().for_each(|corners| out.add_face(corners, []));
            continue;
        }
        let [ua, ub, uc] = [uvs[0], uvs[1], uvs[2]];
        let [uab, ubc, uca] = [mean(&[ua, ub]), mean(&[ub, uc]), mean(&[uc, ua])];
        let uvs = [[ua, uab, uca], [uab, ub, ubc], [uca, ubc, uc], [uab, ubc, uca]];
        faces.iter().zip(uvs).for_each(|(corners, uvs)| out.add_face(corners, uvs));
    }
    out
}

/// Where the vertices end, and the normals of inner ones: the left eigenvectors of the refinement.
pub fn limit(surface: &Surface, edges: &Edges) -> Limit {
    let rings = Rings::of(surface);
    let around = edges.surroundings(surface);
    let old = &surface.positions;
    let inner = |i: usize| {
        let n = f64::from(around[i].valence);
        let gamma = 1.0 / (n + 3.0 / (8.0 * beta(around[i].valence)));
        (1.0 - n * gamma) * old[i] + gamma * around[i].neighbours
    };
    let positions = (0..old.len())
        .into_par_iter()
        .map(|i| around[i].boundary_rule(old[i], 1.0 / 6.0).unwrap_or_else(|| inner(i)))
        .collect();
    let normal = |i: usize| {
        let ring = rings.around(surface, i).filter(|_| around[i].boundary_edges == 0)?;
        let (mut along, mut across) = (DVec3::ZERO, DVec3::ZERO);
        for (k, &(neighbour, _)) in ring.iter().enumerate() {
            let (sin, cos) = (TAU * k as f64 / ring.len() as f64).sin_cos();
            along += cos * old[neighbour as usize];
            across += sin * old[neighbour as usize];
        }
        Some(along.cross(across))
    };
    let normals = (0..old.len()).into_par_iter().map(|i| normal(i).unwrap_or(DVec3::ZERO)).collect();
    Limit { positions, normals }
}
