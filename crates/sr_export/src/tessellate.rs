//! Shapes as triangles.

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DVec3, DVec4, Vec2, Vec3};
use sr_scene::{CurveBasis, CurveUv, CurvesDesc, Geometry, MeshDesc};

/// A shape as a mesh, and what it is called if it was none.
pub fn mesh(geometry: &Geometry) -> (Arc<MeshDesc>, Option<&'static str>) {
    let (made, name) = match geometry {
        Geometry::Mesh(mesh) => return (mesh.clone(), None),
        Geometry::Sphere { center, radius, frame, flip_normals } => {
            let point = |u: f32, v: f32| {
                let (theta, phi) = (PI * v, TAU * u);
                // Exactly at the poles.
                let across = if v == 0.0 || v == 1.0 { 0.0 } else { theta.sin() };
                let out = *frame * Vec3::new(across * phi.cos(), across * phi.sin(), theta.cos());
                (*center + *radius * out, out)
            };
            let inward = frame.determinant() > 0.0;
            (grid((128, 64), inward, *flip_normals, point), "sphere")
        }
        Geometry::Disk { center, u_axis, v_axis, flip_normals } => {
            let normal = u_axis.cross(*v_axis).normalize_or(Vec3::Z);
            let point = |u: f32, v: f32| {
                let (sin, cos) = (TAU * v).sin_cos();
                (*center + u * (cos * *u_axis + sin * *v_axis), normal)
            };
            (grid((8, 128), false, *flip_normals, point), "disk")
        }
        Geometry::Cylinder { base, frame, radius, length, flip_normals } => {
            let point = |u: f32, v: f32| {
                let (sin, cos) = (TAU * u).sin_cos();
                let out = *frame * Vec3::new(cos, sin, 0.0);
                (*base + *radius * out + v * *length * frame.z_axis, out)
            };
            let inward = frame.determinant() < 0.0;
            (grid((128, 8), inward, *flip_normals, point), "cylinder")
        }
        Geometry::Curves(curves) => (tubes(curves), "curve"),
        Geometry::Patch { corners: [p00, p10, p01, p11], flip_normals } => {
            let point = |u: f32, v: f32| {
                let du = (*p10 - *p00).lerp(*p11 - *p01, v);
                let dv = (*p01 - *p00).lerp(*p11 - *p10, u);
                (p00.lerp(*p10, u).lerp(p01.lerp(*p11, u), v), du.cross(dv).normalize_or_zero())
            };
            (grid((32, 32), false, *flip_normals, point), "bilinear patch")
        }
    };
    (Arc::new(MeshDesc { name: name.into(), ..made }), Some(name))
}

/// More segments than this are cut more coarsely.
const MANY_SEGMENTS: usize = 1 << 16;

/// Tubes around curves, without what closes the ends of linear ones.
fn tubes(curves: &CurvesDesc) -> MeshDesc {
    let is_along = curves.uv == CurveUv::AlongAround;
    let cubics: Vec<[DVec4; 4]> = curves.curves().flat_map(|curve| curves.basis.cubics(curve)).collect();
    let (rows, columns) = if cubics.len() > MANY_SEGMENTS { (2, 4) } else { (6, 12) };
    let rows = if curves.basis == CurveBasis::Linear { 1 } else { rows };
    let mut mesh = MeshDesc::default();
    for (segment, [a, b, c, d]) in cubics.iter().enumerate() {
        let first = mesh.positions.len() as u32;
        for row in 0..=rows {
            let u = f64::from(row) / f64::from(rows);
            let (ab, bc, cd) = (a.lerp(*b, u), b.lerp(*c, u), c.lerp(*d, u));
            let (abc, bcd) = (ab.lerp(bc, u), bc.lerp(cd, u));
            let (at, chord) = (abc.lerp(bcd, u), (*d - *a).truncate().normalize_or(DVec3::Z));
            let axis = (bcd - abc).truncate().try_normalize().unwrap_or(chord);
            let up = (DVec3::Z - axis * axis.z).try_normalize().unwrap_or(DVec3::Y);
            let across = up.cross(axis);
            for column in 0..=columns {
                let turn = f64::from(column) / f64::from(columns);
                let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
                let out = cos * across + sin * up;
                mesh.positions.push((at.truncate() + at.w.max(0.0) * out).as_vec3());
                mesh.normals.push(out.as_vec3());
                let whole = (segment as f64 + u) / cubics.len() as f64;
                let (u, v) = if is_along { (u, turn) } else { (turn, whole) };
                mesh.uvs.push(Vec2::new(u as f32, v as f32));
            }
        }
        let stride = columns + 1;
        for i in (0..rows).flat_map(|row| (0..columns).map(move |column| first + row * stride + column)) {
            let (a, b, c, d) = (i, i + 1, i + stride, i + stride + 1);
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    mesh
}

/// A surface over (u, v): `point` has the position and the normal. `inward`: do the normals point against
/// ∂p/∂u × ∂p/∂v? `flip`: does the shape show its other side?
fn grid(
    (columns, rows): (u32, u32),
    inward: bool,
    flip: bool,
    point: impl Fn(f32, f32) -> (Vec3, Vec3),
) -> MeshDesc {
    let mut mesh = MeshDesc::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let (u, v) = (column as f32 / columns as f32, row as f32 / rows as f32);
            // The seam is closed to the last bit.
            let (position, normal) = point(u, v);
            mesh.positions.push(position);
            mesh.normals.push(if flip { -normal } else { normal });
            mesh.uvs.push(Vec2::new(u, v));
        }
    }
    let has_area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize].as_dvec3());
        (b - a).cross(c - a).length_squared() > 0.0
    };
    let stride = columns + 1;
    for row in 0..rows {
        for column in 0..columns {
            let a = row * stride + column;
            let (b, c, d) = (a + 1, a + stride, a + stride + 1);
            for t in [[a, b, d], [a, d, c]] {
                let t = if inward ^ flip { [t[0], t[2], t[1]] } else { t };
                if has_area(&t) {
                    mesh.triangles.push(t);
                }
            }
        }
    }
    mesh
}

/// The mesh with the texture coordinates that ours has where it has none: (0, 0), (1, 0), (0, 1) in each triangle.
pub fn with_uvs(mesh: &Arc<MeshDesc>) -> Arc<MeshDesc> {
    if !mesh.uvs.is_empty() {
        return mesh.clone();
    }
    let corners = || mesh.triangles.iter().flatten().map(|&i| i as usize);
    let pick = |values: &[Vec3]| match values.is_empty() {
        true => Vec::new(),
        false => corners().map(|i| values.get(i).copied().unwrap_or_default()).collect(),
    };
    let count = mesh.triangles.len() as u32;
    Arc::new(MeshDesc {
        name: mesh.name.clone(),
        positions: pick(&mesh.positions),
        normals: pick(&mesh.normals),
        uvs: mesh.triangles.iter().flat_map(|_| [Vec2::ZERO, Vec2::X, Vec2::Y]).collect(),
        triangles: (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        further_uvs: Vec::new(),
        vertex_colors: pick(&mesh.vertex_colors),
        face_colors: mesh.face_colors.clone(),
    })
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Vec4};

    use super::*;

    fn volume(mesh: &MeshDesc) -> f32 {
        mesh.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    fn curve(uv: CurveUv) -> Geometry {
        let points = (0..14).map(|i| Vec4::new(i as f32, (i % 2) as f32, 0.0, 0.1)).collect();
        let (name, basis, firsts) = (String::new(), CurveBasis::BSpline, vec![0, 7]);
        Geometry::Curves(Arc::new(CurvesDesc { name, basis, uv, points, firsts }))
    }

    /// The front is where normals point, whatever frame and flip.
    #[test]
    fn triangles_face_along_their_normals() {
        for mirror in [1.0, -1.0] {
            for flip_normals in [false, true] {
                let frame = Mat3::from_cols(Vec3::X * mirror, Vec3::Y, Vec3::Z);
                let shapes = [
                    Geometry::Sphere { center: Vec3::ONE, radius: 2.0, frame, flip_normals },
                    Geometry::Cylinder { base: Vec3::ONE, frame, radius: 2.0, length: 3.0, flip_normals },
                    Geometry::Disk { center: Vec3::ONE, u_axis: frame.x_axis, v_axis: Vec3::Y, flip_normals },
                    Geometry::Patch { corners: [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE], flip_normals },
                    curve(CurveUv::AlongAround),
                    curve(CurveUv::AroundAlong),
                ];
                for shape in shapes {
                    let (mesh, name) = mesh(&shape);
                    assert!(mesh.triangles.len() > 500, "{name:?}");
                    for t in &mesh.triangles {
                        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                        let n = (b - a).cross(c - a);
                        assert!(n.dot(mesh.normals[t[0] as usize]) > 0.0, "{name:?} {mirror} {flip_normals}");
                    }
                }
            }
        }
        let sphere =
            Geometry::Sphere { center: Vec3::ZERO, radius: 1.0, frame: Mat3::IDENTITY, flip_normals: false };
        assert!((volume(&mesh(&sphere).0) / (4.0 / 3.0 * PI) - 1.0).abs() < 3e-3);
    }
}
