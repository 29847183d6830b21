//! Subdivision surfaces at load: a control mesh, refined some times, its vertices then moved to the limit surface.
//!
//! In: a mesh, and which of its triangles came from one polygon. Out: a finer mesh with limit positions and limit
//! normals. Vertices at the same place are one, whatever their texture coordinates, which are interpolated linearly in
//! every face. Boundaries are cubic B-splines; there are no creases. Where three or more faces meet at an edge, its ends
//! stay where they are.

mod catmull_clark;
mod loop_scheme;
mod topology;

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;
use sr_scene::MeshDesc;

use super::normals;
use crate::limits;
use topology::{Edges, Surface};

/// How to refine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// Triangles to four triangles each (Loop 1987, with Warren's weights).
    Loop,
    /// Polygons to quadrilaterals, one for each corner (Catmull & Clark 1978).
    CatmullClark,
}

/// What a scene file asks of a control mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subdivision {
    /// The rules.
    pub scheme: Scheme,
    /// How often, at least once.
    pub levels: u32,
}

impl Subdivision {
    /// How many faces a mesh will have; the error, half a sentence, where these are too many.
    pub fn faces(&self, mesh: &MeshDesc, fans: &[u32], limit: limits::Limit) -> Result<u64, String> {
        let triangles = mesh.triangles.len() as u64;
        // The first time makes four of a triangle, and of a polygon as many as it has corners.
        let first = match self.scheme {
            Scheme::CatmullClark if !fans.is_empty() => triangles + 2 * fans.len() as u64,
            Scheme::CatmullClark => 3 * triangles,
            Scheme::Loop => 4 * triangles,
        };
        let growth = 4u64.checked_pow(self.levels.saturating_sub(1));
        growth.and_then(|growth| first.checked_mul(growth)).filter(|&faces| faces <= limit.most).ok_or_else(
            || {
                limit.refusal(format!(
                    "subdivided {} times it would have more than {limit} faces; the first time makes {first}",
                    self.levels
                ))
            },
        )
    }
}

/// Refines a mesh whose indices are valid; `fans` tells the triangles of each polygon (empty: one each). The error is half
/// a sentence.
pub fn subdivide(mesh: &MeshDesc, fans: &[u32], how: Subdivision) -> Result<MeshDesc, String> {
    let fans = if how.scheme == Scheme::CatmullClark { fans } else { &[] };
    let mut surface = welded(mesh, fans);
    for _ in 0..how.levels {
        let edges = Edges::of(&surface);
        surface = match how.scheme {
            Scheme::Loop => loop_scheme::refined(&surface, &edges),
            Scheme::CatmullClark => catmull_clark::refined(&surface, &edges),
        };
    }
    let edges = Edges::of(&surface);
    let limit = match how.scheme {
        Scheme::Loop => loop_scheme::limit(&surface, &edges),
        Scheme::CatmullClark => catmull_clark::limit(&surface, &edges),
    };
    Ok(meshed(&surface, &limit, mesh.name.clone()))
}

/// Positions and, where there is a formula, normals.
struct Limit {
    positions: Vec<DVec3>,
    /// Not normalised; zero where the normals of the faces have to do.
    normals: Vec<DVec3>,
}

/// One vertex for each place.
fn welded(mesh: &MeshDesc, fans: &[u32]) -> Surface {
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    let mut positions = Vec::new();
    let vertex_of: Vec<u32> = mesh
        .positions
        .iter()
        .map(|p| {
            // +0 and −0 are the same place
            let place = (*p + Vec3::ZERO).to_array().map(f32::to_bits);
            *known.entry(place).or_insert_with(|| {
                positions.push(p.as_dvec3());
                positions.len() as u32 - 1
            })
        })
        .collect();
    let mut surface = Surface::new(positions);
    let mut triangles = mesh.triangles.iter();
    let mut add = |polygon: &[u32]| {
        let corners: Vec<u32> = polygon.iter().map(|&i| vertex_of[i as usize]).collect();
        let degenerate = (0..corners.len()).any(|i| corners[i] == corners[(i + 1) % corners.len()]);
        if !degenerate {
            let uvs = polygon.iter().filter_map(|&i| mesh.uvs.get(i as usize).copied());
            surface.add_face(&corners, uvs);
        }
    };
    if fans.is_empty() {
        triangles.for_each(|triangle| add(triangle));
    } else {
        for &count in fans {
            let mut polygon: Vec<u32> = Vec::new();
            for triangle in triangles.by_ref().take(count as usize) {
                let new = if polygon.is_empty() { &triangle[..] } else { &triangle[2..] };
                polygon.extend(new);
            }
            add(&polygon);
        }
    }
    surface
}

/// Triangles, with a vertex for each pair of a place and texture coordinates.
fn meshed(surface: &Surface, limit: &Limit, name: String) -> MeshDesc {
    let positions: Vec<Vec3> = limit.positions.iter().map(|p| p.as_vec3()).collect();
    let mut triangles = Vec::new();
    for face in 0..surface.face_count() {
        super::fan(surface.face(face), &mut triangles);
    }
    let of_faces = normals::smooth(&positions, &triangles);
    let normals: Vec<Vec3> = limit
        .normals
        .iter()
        .zip(of_faces)
        .map(|(n, of_faces)| n.try_normalize().map_or(of_faces, DVec3::as_vec3))
        .collect();
    let mut mesh = MeshDesc { name, positions, normals, triangles, ..MeshDesc::default() };
    if surface.uvs.is_empty() {
        return mesh;
    }
    // Place, texture coordinates, corner: those of one vertex are neighbours once these are sorted.
    let each = surface.corners.iter().zip(&surface.uvs).zip(0..);
    let mut pairs: Vec<[u32; 4]> =
        each.map(|((&vertex, uv), corner)| [vertex, uv.x.to_bits(), uv.y.to_bits(), corner]).collect();
    pairs.par_sort_unstable();
    let mut source = Vec::new();
    let mut corners = vec![0; pairs.len()];
    for same in pairs.chunk_by(|x, y| x[..3] == y[..3]) {
        let [vertex, u, v, _] = same[0];
        same.iter().for_each(|pair| corners[pair[3] as usize] = source.len() as u32);
        source.push(vertex);
        mesh.uvs.push(Vec2::new(f32::from_bits(u), f32::from_bits(v)));
    }
    drop(pairs);
    mesh.triangles.clear();
    for face in 0..surface.face_count() {
        super::fan(&corners[surface.range(face)], &mut mesh.triangles);
    }
    mesh.positions = source.iter().map(|&i| mesh.positions[i as usize]).collect();
    mesh.normals = source.iter().map(|&i| mesh.normals[i as usize]).collect();
    mesh
}

/// The mean of texture coordinates.
fn mean(uvs: &[Vec2]) -> Vec2 {
    uvs.iter().sum::<Vec2>() / uvs.len() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn how(scheme: Scheme, levels: u32) -> Subdivision {
        Subdivision { scheme, levels }
    }

    /// A cube of six quadrilaterals.
    fn cube() -> (MeshDesc, Vec<u32>) {
        let mut mesh = MeshDesc::default();
        for i in 0..8 {
            let side = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
            mesh.positions.push(Vec3::new(side(1), side(2), side(4)));
        }
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            super::super::fan(&face, &mut mesh.triangles);
        }
        (mesh, vec![2; 6])
    }

    fn octahedron() -> MeshDesc {
        let positions = vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        let triangles =
            vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        MeshDesc { positions, triangles, ..MeshDesc::default() }
    }

    /// A bent strip with boundaries, of 2 × 3 quadrilaterals.
    fn strip() -> (MeshDesc, Vec<u32>) {
        let mut mesh = MeshDesc::default();
        for j in 0..4u32 {
            for i in 0..3u32 {
                let (x, y) = (i as f32, j as f32);
                mesh.positions.push(Vec3::new(x, y, 0.3 * x * x - 0.2 * y * x));
                mesh.uvs.push(Vec2::new(x / 2.0, y / 3.0));
            }
        }
        for j in 0..3u32 {
            for i in 0..2u32 {
                let a = j * 3 + i;
                super::super::fan(&[a, a + 1, a + 4, a + 3], &mut mesh.triangles);
            }
        }
        (mesh, vec![2; 6])
    }

    /// The limit of a vertex does not depend on how often the mesh was refined before: every vertex of a coarse result
    /// is one of the finer result, with the same normal where there is a formula for it.
    #[test]
    fn vertices_and_normals_are_those_of_the_limit() {
        let (cube, of_cube) = cube();
        let (strip, of_strip) = strip();
        for (mesh, fans, scheme, is_closed) in [
            (octahedron(), vec![], Scheme::Loop, true),
            (cube.clone(), of_cube.clone(), Scheme::Loop, true),
            (cube, of_cube, Scheme::CatmullClark, true),
            (strip.clone(), of_strip.clone(), Scheme::Loop, false),
            (strip, of_strip, Scheme::CatmullClark, false),
        ] {
            let coarse = subdivide(&mesh, &fans, how(scheme, 1)).unwrap();
            let fine = subdivide(&mesh, &fans, how(scheme, 3)).unwrap();
            for (p, n) in coarse.positions.iter().zip(&coarse.normals) {
                let distance = |i: &usize| fine.positions[*i].distance(*p);
                let nearest =
                    (0..fine.positions.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
                assert!(distance(&nearest) < 1e-6, "{scheme:?}: {p} is {} away", distance(&nearest));
                if is_closed {
                    assert!(fine.normals[nearest].distance(*n) < 1e-5, "{scheme:?}: normal at {p}");
                }
            }
        }
    }

    #[test]
    fn limit_normals_are_perpendicular_to_a_fine_surface() {
        for scheme in [Scheme::Loop, Scheme::CatmullClark] {
            let (cube, fans) = cube();
            let fine = subdivide(&cube, &fans, how(scheme, 5)).unwrap();
            let of_faces = normals::smooth(&fine.positions, &fine.triangles);
            for (n, of_faces) in fine.normals.iter().zip(of_faces) {
                assert!(n.dot(of_faces) > 0.999, "{scheme:?}: {n} and {of_faces}");
            }
        }
    }

    #[test]
    fn faces_are_counted() {
        let (cube, fans) = cube();
        assert_eq!(subdivide(&cube, &fans, how(Scheme::Loop, 2)).unwrap().triangles.len(), 12 * 16);
        let quads = subdivide(&cube, &fans, how(Scheme::CatmullClark, 2)).unwrap();
        assert_eq!(quads.triangles.len(), 2 * 24 * 4);
        // closed: as many vertices as Euler's formula has
        assert_eq!(quads.positions.len(), 24 * 4 + 2);
        for (scheme, levels) in [(Scheme::Loop, 2), (Scheme::CatmullClark, 2)] {
            let counted = how(scheme, levels).faces(&cube, &fans, limits::Limit::fixed(1 << 20)).unwrap();
            let made = subdivide(&cube, &fans, how(scheme, levels)).unwrap().triangles.len() as u64;
            assert_eq!(counted * if scheme == Scheme::Loop { 1 } else { 2 }, made);
        }
        let too_many = how(Scheme::CatmullClark, 10).faces(&cube, &fans, limits::Limit::fixed(1 << 20));
        assert!(too_many.unwrap_err().contains("10 times"));
        assert!(how(Scheme::Loop, u32::MAX).faces(&cube, &fans, limits::Limit::fixed(1 << 20)).is_err());
    }

    #[test]
    fn a_regular_grid_is_a_bicubic_spline() {
        // Interior limit points of Catmull & Clark's regular meshes are those of the uniform bicubic B-spline: of z = x²,
        // x² + 1/3 (second moment of the cubic B-spline), for unit spacing.
        let n = 6u32;
        let mut mesh = MeshDesc::default();
        for j in 0..n {
            for i in 0..n {
                mesh.positions.push(Vec3::new(i as f32, j as f32, (i * i) as f32));
            }
        }
        let mut fans = Vec::new();
        for j in 0..n - 1 {
            for i in 0..n - 1 {
                let a = j * n + i;
                super::super::fan(&[a, a + 1, a + n + 1, a + n], &mut mesh.triangles);
                fans.push(2);
            }
        }
        let fine = subdivide(&mesh, &fans, how(Scheme::CatmullClark, 3)).unwrap();
        let mut checked = 0;
        for (p, normal) in fine.positions.iter().zip(&fine.normals) {
            if p.x > 1.0 && p.x < 4.0 && p.y > 1.0 && p.y < 4.0 {
                assert!((p.z - p.x * p.x - 1.0 / 3.0).abs() < 1e-5, "{p}");
                let expected = Vec3::new(-2.0 * p.x, 0.0, 1.0).normalize();
                assert!((*normal - expected).length() < 1e-5, "{normal} at {p}");
                checked += 1;
            }
        }
        assert!(checked > 400, "{checked}");
    }

    #[test]
    fn boundaries_are_splines_and_texture_coordinates_stay_linear() {
        let (mesh, fans) = strip();
        for scheme in [Scheme::Loop, Scheme::CatmullClark] {
            let fine = subdivide(&mesh, &fans, how(scheme, 2)).unwrap();
            assert_eq!(fine.uvs.len(), fine.positions.len());
            // the limit of the boundary vertex (0, 1, 0): 1/6, 2/3, 1/6 of it and its neighbours on the boundary
            assert!(fine.positions.iter().any(|p| p.distance(Vec3::new(0.0, 1.0, 0.0)) < 1e-6));
            // texture coordinates of the unmoved grid
            for uv in &fine.uvs {
                let on_grid = *uv * Vec2::new(8.0, 12.0);
                assert!((on_grid - on_grid.round()).length() < 1e-5, "{uv}");
            }
        }
    }

    #[test]
    fn odd_meshes_do_not_panic() {
        let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        let positions =
            vec![p(0., 0., 0.), p(1., 0., 0.), p(0., 1., 0.), p(0., 0., 1.), p(0., -1., 0.), p(5., 5., 5.)];
        // three triangles at one edge, one without area, one twice
        let triangles = vec![[0, 1, 2], [0, 1, 3], [1, 0, 4], [0, 0, 1], [0, 1, 2]];
        let mesh = MeshDesc { positions, triangles, ..MeshDesc::default() };
        for scheme in [Scheme::Loop, Scheme::CatmullClark] {
            for mesh in [&mesh, &MeshDesc::default()] {
                let fine = subdivide(mesh, &[], how(scheme, 2)).unwrap();
                assert!(fine.positions.iter().all(|p| p.is_finite()));
                assert!(fine.normals.iter().all(|n| n.is_finite()));
            }
        }
    }
}
