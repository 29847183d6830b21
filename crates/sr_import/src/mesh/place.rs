//! A mesh as it was read to a mesh in world space: transform, normals, orientation, checks.

use std::sync::Arc;

use glam::{DMat3, DMat4, Vec3};
use rayon::prelude::*;
use sr_scene::MeshDesc;

use super::subdivide::{Subdivision, subdivide};
use super::{RawMesh, normals};

/// What a scene file asks of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// To world space (or the group's).
    pub to_world: DMat4,
    /// Flat shading: vertex normals are dropped, and none are made.
    pub face_normals: bool,
    /// The other side is the front.
    pub flip_normals: bool,
    /// Edges sharper than this, in radians, stay sharp; all vertex normals are made anew.
    pub max_smooth_angle: Option<f32>,
    /// The mesh is flat by construction: its normals only tell the front.
    pub flat: bool,
    /// The mesh is the control mesh of a subdivision surface.
    pub subdivision: Option<Subdivision>,
    /// What the format takes for granted.
    pub convention: Convention,
    /// Are the mesh's colors wanted?
    pub colors: bool,
}

/// What a format takes for granted where a mesh has no normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Convention {
    /// Smooth normals are made; a mirroring transform swaps the sides.
    #[default]
    Mitsuba,
    /// It is flat; whatever the transform, the front is where the corners turn counter-clockwise in the mesh's own
    /// space. pbrt and glTF have it so.
    Flat,
}

/// What was noticed on the way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Triangles without area; they were dropped.
    pub degenerate: usize,
    /// Vertex normals that were not finite or zero; they were made from the triangles.
    pub bad_normals: usize,
}

/// Places a mesh; the error is half a sentence. A mesh that nobody else holds is changed where it is.
///
/// The front is where vertex normals point (transformed by the inverse transpose); without them it is as the
/// [`Convention`] has it.
pub fn place(
    RawMesh { mesh, fans, .. }: RawMesh,
    placement: &Placement,
) -> Result<(MeshDesc, Report), String> {
    check(&mesh)?;
    if let Some(how) = placement.subdivision {
        return placed(subdivide(&mesh, &fans, how)?, &Placement { flat: false, ..placement.clone() });
    }
    placed(Arc::unwrap_or_clone(mesh), placement)
}

fn placed(mut mesh: MeshDesc, placement: &Placement) -> Result<(MeshDesc, Report), String> {
    let Placement { to_world, .. } = *placement;
    let linear = DMat3::from_mat4(to_world);
    let to_world = |p: &mut Vec3| *p = to_world.transform_point3(p.as_dvec3()).as_vec3();
    mesh.positions.par_iter_mut().with_min_len(SIDE_BY_SIDE).for_each(to_world);
    if let Some(vertex) = position(&mesh.positions, |p| !p.is_finite()) {
        return Err(format!("vertex {vertex} is out of range after its transform"));
    }
    let mut report = Report::default();
    if !placement.colors {
        mesh.vertex_colors = Vec::new();
        mesh.face_colors = Vec::new();
    }
    let stays_flat = placement.flat || (placement.convention == Convention::Flat && mesh.normals.is_empty());
    let is_flat = placement.face_normals || stays_flat;
    let keeps_normals =
        !mesh.normals.is_empty() && !placement.face_normals && placement.max_smooth_angle.is_none();
    let keeps_front = keeps_normals || placement.convention == Convention::Flat;
    let mirrored = keeps_front && linear.determinant() < 0.0;
    report.degenerate = drop_degenerate(&mut mesh);
    if mirrored != placement.flip_normals {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    if is_flat {
        // Flat shading needs no normals.
        mesh.normals = Vec::new();
    } else if let Some(angle) = placement.max_smooth_angle {
        mesh.normals = Vec::new();
        normals::crease(&mut mesh, angle);
    } else if mesh.normals.is_empty() {
        mesh.normals = normals::smooth(&mesh.positions, &mesh.triangles);
    } else {
        // The cofactor matrix is the inverse transpose up to the determinant, whose sign is put back.
        let side = if placement.flip_normals {
            -linear.determinant().signum()
        } else {
            linear.determinant().signum()
        };
        let cofactor = cofactor(linear) * side;
        let turn = |n: &mut Vec3| *n = (cofactor * n.as_dvec3()).normalize_or_zero().as_vec3();
        mesh.normals.par_iter_mut().with_min_len(SIDE_BY_SIDE).for_each(turn);
        repair(&mut mesh, &mut report);
    }
    // Vertices that no triangle uses have no normal; any unit vector keeps the arrays well-formed.
    mesh.normals.iter_mut().filter(|n| **n == Vec3::ZERO).for_each(|n| *n = Vec3::Z);
    Ok((mesh, report))
}

/// As many elements are worth a thread.
const SIDE_BY_SIDE: usize = 1 << 14;

/// The first element of which this is so. Whole blocks are looked at without a branch: mostly it is so of none.
fn position<T: Sync>(array: &[T], is_so: impl Fn(&T) -> bool + Sync + Send) -> Option<usize> {
    array.par_chunks(SIDE_BY_SIDE).enumerate().find_map_first(|(block, elements)| {
        let any = elements.iter().fold(false, |any, element| any | is_so(element));
        let at = if any { elements.iter().position(&is_so) } else { None };
        at.map(|at| block * SIDE_BY_SIDE + at)
    })
}

/// Leaves triangles without area out; how many there were.
fn drop_degenerate(mesh: &mut MeshDesc) -> usize {
    let positions = &mesh.positions;
    let has_area = |t: &[u32; 3]| has_area(t.map(|i| positions[i as usize]));
    if position(&mesh.triangles, |t| !has_area(t)).is_none() {
        return 0;
    }
    let before = mesh.triangles.len();
    let stays: Vec<bool> = mesh.triangles.iter().map(has_area).collect();
    let mut each = stays.iter();
    mesh.triangles.retain(|_| each.next() == Some(&true));
    let mut each = stays.iter();
    mesh.face_colors.retain(|_| each.next() == Some(&true));
    before - mesh.triangles.len()
}

fn check(mesh: &MeshDesc) -> Result<(), String> {
    let n = mesh.positions.len();
    let further = mesh.further_uvs.iter().map(|set| (set.len(), "texture coordinates"));
    let arrays = [
        (mesh.normals.len(), "normals"),
        (mesh.uvs.len(), "texture coordinates"),
        (mesh.vertex_colors.len(), "colors"),
    ];
    for (len, what) in arrays.into_iter().chain(further) {
        if len != 0 && len != n {
            return Err(format!("it has {len} {what} for {n} vertices"));
        }
    }
    let colors = mesh.vertex_colors.iter().chain(&mesh.face_colors);
    if colors.into_iter().any(|c| !(c.is_finite() && c.min_element() >= 0.0)) {
        return Err("it has a color with negative or infinite parts".into());
    }
    if let Some(vertex) = position(&mesh.positions, |p| !p.is_finite()) {
        return Err(format!("vertex {vertex} is {}, which is not finite", mesh.positions[vertex]));
    }
    let sets = [&mesh.uvs].into_iter().chain(&mesh.further_uvs);
    if let Some(vertex) = sets.into_iter().find_map(|set| position(set, |uv| !uv.is_finite())) {
        return Err(format!("the texture coordinates of vertex {vertex} are not finite"));
    }
    if let Some(at) = position(&mesh.triangles, |t| t.iter().any(|&i| i as usize >= n)) {
        return Err(format!(
            "triangle {at} uses the vertices {:?}, but there are only {n}",
            mesh.triangles[at]
        ));
    }
    Ok(())
}

fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    // Angles that are far wider than what rounding makes of none need no closer look.
    let (x, y) = (b - a, c - a);
    let (cross, most) = (x.cross(y).length_squared(), x.length_squared() * y.length_squared());
    if cross > 1e-10 * most && most > f32::MIN_POSITIVE && most < f32::MAX {
        return true;
    }
    let [a, b, c] = [a, b, c].map(|p| p.as_dvec3());
    (b - a).cross(c - a).length_squared() > 0.0
}

/// Replaces normals that have no direction, and those that their vertex's triangles do not use are left.
fn repair(mesh: &mut MeshDesc, report: &mut Report) {
    let broken = |n: &Vec3| !n.is_finite() || *n == Vec3::ZERO;
    if !mesh.normals.iter().any(broken) {
        return;
    }
    let smooth = normals::smooth(&mesh.positions, &mesh.triangles);
    for (normal, smooth) in mesh.normals.iter_mut().zip(smooth).filter(|(n, _)| broken(n)) {
        *normal = smooth;
        report.bad_normals += usize::from(smooth != Vec3::ZERO);
    }
}

fn cofactor(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::mesh::primitives;

    fn placement(to_world: DMat4) -> Placement {
        Placement {
            to_world,
            face_normals: false,
            flip_normals: false,
            max_smooth_angle: None,
            flat: false,
            subdivision: None,
            convention: Convention::Mitsuba,
            colors: true,
        }
    }

    fn raw_placed(mesh: &MeshDesc, placement: &Placement) -> Result<(MeshDesc, Report), String> {
        place(
            RawMesh { mesh: std::sync::Arc::new(mesh.clone()), fans: [].into(), textures: [].into() },
            placement,
        )
    }

    fn geometric(mesh: &MeshDesc, t: usize) -> Vec3 {
        let [a, b, c] = mesh.triangles[t].map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).normalize()
    }

    #[test]
    fn a_mirrored_mesh_keeps_the_front_that_its_normals_tell() {
        let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let (cube, _) = placed(primitives::cube(), &placement(mirror)).unwrap();
        for t in 0..12 {
            assert!(geometric(&cube, t).dot(cube.positions[cube.triangles[t][0] as usize]) > 0.0);
        }
        // Without normals the front of Mitsuba's mesh files turns with the corners.
        let file = MeshDesc { normals: Vec::new(), ..primitives::rectangle() };
        let (square, _) = placed(file, &placement(mirror)).unwrap();
        assert_eq!(geometric(&square, 0), Vec3::NEG_Z);
        // Elsewhere the front stays the front.
        let flat = Placement { convention: Convention::Flat, ..placement(mirror) };
        let (square, _) = placed(primitives::rectangle(), &flat).unwrap();
        assert_eq!(geometric(&square, 0), Vec3::Z);
        assert!(square.normals.is_empty());
    }

    #[test]
    fn normals_stay_perpendicular_under_shear_and_scale() {
        let shear =
            DMat4::from_cols_array(&[1., 0., 0., 0., 2., 3., 0., 0., 0., 0., -0.5, 0., 0., 0., 0., 1.]);
        let (cube, report) = placed(primitives::cube(), &placement(shear)).unwrap();
        assert_eq!(report, Report::default());
        for (t, corners) in cube.triangles.iter().enumerate() {
            assert!((geometric(&cube, t) - cube.normals[corners[0] as usize]).length() < 1e-6);
        }
    }

    #[test]
    fn flipping_turns_corners_and_normals() {
        let flip = Placement { flip_normals: true, ..placement(DMat4::IDENTITY) };
        let (cube, _) = placed(primitives::cube(), &flip).unwrap();
        assert_eq!(geometric(&cube, 0), Vec3::Y);
        assert_eq!(cube.normals[0], Vec3::Y);
    }

    #[test]
    fn bad_meshes() {
        let mut mesh = primitives::rectangle();
        mesh.triangles.push([0, 0, 1]);
        assert_eq!(raw_placed(&mesh, &placement(DMat4::IDENTITY)).unwrap().1.degenerate, 1);
        mesh.triangles.push([0, 1, 4]);
        assert!(raw_placed(&mesh, &placement(DMat4::IDENTITY)).unwrap_err().contains("triangle 3"));
        mesh.triangles.pop();
        mesh.positions[2].y = f32::NAN;
        assert!(raw_placed(&mesh, &placement(DMat4::IDENTITY)).unwrap_err().contains("vertex 2"));
    }
}
