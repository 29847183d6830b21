//! Mitsuba's built-in meshes.

use glam::{Vec2, Vec3};
use sr_scene::MeshDesc;

/// The square [-1, 1]² at z = 0, facing +Z, with (u, v) from (0, 0) at (-1, -1) to (1, 1).
pub fn rectangle() -> MeshDesc {
    let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let positions = uvs.iter().map(|uv| (2.0 * *uv - 1.0).extend(0.0)).collect();
    MeshDesc {
        name: "rectangle".into(),
        positions,
        normals: Vec::new(),
        uvs,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..MeshDesc::default()
    }
}

/// The cube [-1, 1]³, facing outwards, each face with the whole of [0, 1]² as its (u, v).
///
/// Corners and coordinates are those of Mitsuba 3.9.1's `cube` (read with `mi.traverse`).
pub fn cube() -> MeshDesc {
    // The normal, then the corners with (u, v) = (0, 1), (1, 1), (1, 0), (0, 0).
    const FACES: [(Vec3, [[i8; 3]; 4]); 6] = [
        (Vec3::NEG_Y, [[1, -1, -1], [1, -1, 1], [-1, -1, 1], [-1, -1, -1]]),
        (Vec3::Y, [[1, 1, -1], [-1, 1, -1], [-1, 1, 1], [1, 1, 1]]),
        (Vec3::X, [[1, -1, -1], [1, 1, -1], [1, 1, 1], [1, -1, 1]]),
        (Vec3::Z, [[1, -1, 1], [1, 1, 1], [-1, 1, 1], [-1, -1, 1]]),
        (Vec3::NEG_X, [[-1, -1, 1], [-1, 1, 1], [-1, 1, -1], [-1, -1, -1]]),
        (Vec3::NEG_Z, [[1, 1, -1], [1, -1, -1], [-1, -1, -1], [-1, 1, -1]]),
    ];
    let mut mesh = MeshDesc { name: "cube".into(), ..MeshDesc::default() };
    for (normal, corners) in FACES {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners.map(|[x, y, z]| Vec3::new(x.into(), y.into(), z.into())));
        mesh.normals.extend([normal; 4]);
        mesh.uvs.extend([Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO]);
        mesh.triangles.extend([[first, first + 1, first + 2], [first + 3, first, first + 2]]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_face_along_their_normals() {
        let cube = cube();
        for t in &cube.triangles {
            let [a, b, c] = t.map(|i| cube.positions[i as usize]);
            let normal = (b - a).cross(c - a).normalize();
            assert_eq!(normal, cube.normals[t[0] as usize]);
            assert!(normal.dot(a) > 0.0);
        }
        let square = rectangle();
        for t in &square.triangles {
            let [a, b, c] = t.map(|i| square.positions[i as usize]);
            assert_eq!((b - a).cross(c - a).normalize(), Vec3::Z);
        }
    }
}
