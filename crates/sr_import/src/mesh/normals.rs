//! Vertex normals from triangles.

use glam::Vec3;
use rayon::prelude::*;
use sr_scene::MeshDesc;

/// Triangles whose angles are worked out in parallel before they are summed up in order.
const BLOCK: usize = 1 << 16;

/// Each vertex's mean of the normals of its triangles, weighted by the triangle's angle there
/// (Thürmer & Wüthrich 1998), as Mitsuba does; zero where no triangle is.
pub fn smooth(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    let mut known = Vec::with_capacity(BLOCK.min(triangles.len()));
    for block in triangles.chunks(BLOCK) {
        let corners = block.par_iter().map(|t| normal_and_angles(t.map(|i| positions[i as usize])));
        corners.collect_into_vec(&mut known);
        for (triangle, known) in block.iter().zip(&known) {
            let Some((normal, angles)) = known else { continue };
            for (&index, &angle) in triangle.iter().zip(angles) {
                normals[index as usize] += *normal * angle;
            }
        }
    }
    normals.into_iter().map(Vec3::normalize_or_zero).collect()
}

/// Rebuilds normals so that edges sharper than `max_angle` (radians) stay sharp: the triangles around a
/// vertex are put into groups of like normals, and each group gets a vertex of its own.
pub fn crease(mesh: &mut MeshDesc, max_angle: f32) {
    /// Groups a vertex can have: a cone's tip would otherwise be compared with each of its triangles.
    const MAX_GROUPS: usize = 64;
    let threshold = max_angle.cos();
    // For each original vertex, the groups made so far: the first normal, and the new vertex.
    let mut groups: Vec<Vec<(Vec3, u32)>> = vec![Vec::new(); mesh.positions.len()];
    let mut source: Vec<u32> = Vec::new();
    let mut sums: Vec<Vec3> = Vec::new();
    for triangle in &mut mesh.triangles {
        let corners = triangle.map(|i| mesh.positions[i as usize]);
        let (normal, angles) = normal_and_angles(corners).unwrap_or((Vec3::ZERO, [0.0; 3]));
        for (index, angle) in triangle.iter_mut().zip(angles) {
            let known = &mut groups[*index as usize];
            let vertex = match known.iter().find(|(first, _)| first.dot(normal) >= threshold) {
                Some(&(_, vertex)) => vertex,
                None => {
                    let vertex = source.len() as u32;
                    if known.len() < MAX_GROUPS {
                        known.push((normal, vertex));
                    }
                    source.push(*index);
                    sums.push(Vec3::ZERO);
                    vertex
                }
            };
            sums[vertex as usize] += normal * angle;
            *index = vertex;
        }
    }
    mesh.positions = source.iter().map(|&i| mesh.positions[i as usize]).collect();
    if !mesh.uvs.is_empty() {
        mesh.uvs = source.iter().map(|&i| mesh.uvs[i as usize]).collect();
    }
    for set in &mut mesh.further_uvs {
        *set = source.iter().filter_map(|&i| set.get(i as usize)).copied().collect();
    }
    if !mesh.vertex_colors.is_empty() {
        mesh.vertex_colors = source.iter().map(|&i| mesh.vertex_colors[i as usize]).collect();
    }
    mesh.normals = sums.into_iter().map(Vec3::normalize_or_zero).collect();
}

/// `None` for a triangle without area.
fn normal_and_angles([a, b, c]: [Vec3; 3]) -> Option<(Vec3, [f32; 3])> {
    let normal = (b - a).as_dvec3().cross((c - a).as_dvec3()).try_normalize()?.as_vec3();
    let angle = |at: Vec3, p: Vec3, q: Vec3| (p - at).as_dvec3().angle_between((q - at).as_dvec3()) as f32;
    let angles = [angle(a, b, c), angle(b, c, a), angle(c, a, b)];
    angles.iter().all(|a| a.is_finite()).then_some((normal, angles))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles of a square in the xy-plane and one in the xz-plane, sharing an edge.
    fn folded() -> MeshDesc {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1., 1., 0.), Vec3::Y, Vec3::Z];
        MeshDesc { positions, triangles: vec![[0, 1, 2], [0, 2, 3], [0, 1, 4]], ..MeshDesc::default() }
    }

    /// Mitsuba 3.9.1 gives these normals for the same mesh.
    #[test]
    fn smooth_normals_agree_with_mitsuba() {
        let mesh = folded();
        let normals = smooth(&mesh.positions, &mesh.triangles);
        let expected = [
            Vec3::new(0., -0.70710677, 0.70710677),
            Vec3::new(0., -0.4472136, 0.8944272),
            Vec3::Z,
            Vec3::Z,
            Vec3::NEG_Y,
        ];
        for (got, want) in normals.iter().zip(expected) {
            assert!((*got - want).length() < 1e-6, "{got} is not {want}");
        }
    }

    #[test]
    fn creases_split_vertices() {
        let mut mesh = folded();
        crease(&mut mesh, 0.5);
        assert_eq!(mesh.positions.len(), 7);
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            let flat = (b - a).cross(c - a).normalize();
            assert!(t.iter().all(|&i| (mesh.normals[i as usize] - flat).length() < 1e-6));
        }
        let mut mesh = folded();
        crease(&mut mesh, 2.0);
        assert_eq!(mesh.positions.len(), 5);
    }
}
