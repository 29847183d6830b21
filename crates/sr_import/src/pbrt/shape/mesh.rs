//! Triangles: in the scene's text, in PLY files, and subdivided ones.

use std::sync::Arc;

use glam::{DMat4, Vec2, Vec3};
use sr_scene::MeshDesc;

use super::super::syntax::Kind;
use super::{Form, Params, Reader};
use crate::assembly::MeshSource;
use crate::mesh::{Convention, Format, Placement, Scheme, Subdivision};

impl Reader<'_> {
    pub(super) fn triangle_mesh(&mut self, params: &mut Params) -> Vec<Form> {
        let Some(mesh) = self.mesh_of(params, "triangle mesh") else { return Vec::new() };
        params.ignore(&["faceIndices"]);
        params.unsupported(&["S"], "tangents follow the texture coordinates", &mut self.notes());
        let area = self.state.area_light.as_ref().and_then(|_| even_area(&mesh, &self.state.ctm));
        vec![Form::of_mesh(MeshSource::Memory(Arc::new(mesh)), self.placement(), area)]
    }

    pub(super) fn loop_subdivision(&mut self, params: &mut Params) -> Vec<Form> {
        let Some(mesh) = self.mesh_of(params, "subdivision surface") else { return Vec::new() };
        params.ignore(&["scheme"]);
        let levels = params.integer("levels").or_else(|| params.integer("nlevels")).unwrap_or(3);
        let levels = u32::try_from(levels).unwrap_or(0);
        let subdivision = (levels > 0).then_some(Subdivision { scheme: Scheme::Loop, levels });
        // Normals are made in any case.
        let placement = Placement { subdivision, convention: Convention::Mitsuba, ..self.placement() };
        vec![Form::of_mesh(MeshSource::Memory(Arc::new(mesh)), placement, None)]
    }

    pub(super) fn ply_mesh(&mut self, params: &mut Params) -> Vec<Form> {
        params.unsupported(&["displacement"], "the surface is smooth", &mut self.notes());
        params.ignore(&["edgelength"]);
        let Some((_, name)) = params.string("filename") else {
            let message = format!("{} needs a \"filename\"", params.title);
            self.error("pbrt::missing-parameter", &params.span, message);
            return Vec::new();
        };
        let source = MeshSource::File { path: self.out.find(&name), format: Format::Ply, flip_v: false };
        vec![Form::of_mesh(source, self.placement(), None)]
    }

    /// `P`, `N`, `uv` and `indices`.
    pub(super) fn mesh_of(&mut self, params: &mut Params, what: &str) -> Option<MeshDesc> {
        let vectors = |floats: Vec<f32>| floats.chunks_exact(3).map(Vec3::from_slice).collect::<Vec<_>>();
        let Some((_, positions)) = params.take_floats("P", &[Kind::Point3]) else {
            let message = format!("{} needs positions \"P\"", params.title);
            self.warn("pbrt::missing-parameter", &params.span, message, "the shape is left out");
            params.use_all();
            return None;
        };
        let positions = vectors(positions);
        let normals = params.take_floats("N", &[Kind::Normal]).map(|(_, v)| vectors(v)).unwrap_or_default();
        let uv_kinds = [Kind::Point2, Kind::Vector2, Kind::Float];
        let uvs = params.take_floats("uv", &uv_kinds).or_else(|| params.take_floats("st", &uv_kinds));
        let uvs = uvs.map(|(_, v)| v.chunks_exact(2).map(Vec2::from_slice).collect()).unwrap_or_default();
        let triangles = match params.take_integers("indices") {
            None if positions.len() == 3 => vec![[0, 1, 2]],
            None => {
                let message = format!("{} needs \"indices\"", params.title);
                self.warn("pbrt::missing-parameter", &params.span, message, "the shape is left out");
                params.use_all();
                return None;
            }
            // Negative ones become so large that they are refused with those beyond the vertices.
            Some((span, indices)) => {
                if indices.len() % 3 != 0 {
                    let message = format!("{} indices are no triangles", indices.len());
                    self.warn("pbrt::bad-value", &span, message, "the last ones are left out");
                }
                indices.chunks_exact(3).map(|t| [t[0] as u32, t[1] as u32, t[2] as u32]).collect()
            }
        };
        let mut mesh =
            MeshDesc { name: what.to_owned(), positions, normals, uvs, triangles, ..MeshDesc::default() };
        let count = mesh.positions.len();
        for (len, what) in [(mesh.normals.len(), "N"), (mesh.uvs.len(), "uv")] {
            if len != 0 && len != count {
                let message = format!("{len} values \"{what}\" for {count} vertices of {}", params.title);
                self.warn("pbrt::bad-value", &params.span, message, "they are ignored");
                if what == "N" { mesh.normals.clear() } else { mesh.uvs.clear() }
            }
        }
        Some(mesh)
    }
}

/// The area that all triangles have in world space; `None` if they differ.
fn even_area(mesh: &MeshDesc, ctm: &DMat4) -> Option<f32> {
    let mut areas = mesh.triangles.iter().map(|t| {
        let corner = |i: u32| mesh.positions.get(i as usize).map(|p| ctm.transform_point3(p.as_dvec3()));
        let (a, b, c) = (corner(t[0])?, corner(t[1])?, corner(t[2])?);
        Some(0.5 * (b - a).cross(c - a).length())
    });
    let first = areas.next()??;
    areas.all(|area| area.is_some_and(|area| (area - first).abs() <= 1e-3 * first)).then_some(first as f32)
}

/// The mesh moved against its normals by a part of its size.
pub(super) fn behind(mesh: &MeshDesc, placement: &Placement, part: f32) -> MeshDesc {
    let mut normals = mesh.normals.clone();
    if normals.is_empty() {
        normals = vec![Vec3::ZERO; mesh.positions.len()];
        for t in &mesh.triangles {
            let corner = |i: u32| mesh.positions.get(i as usize).copied().unwrap_or_default();
            let [a, b, c] = t.map(corner);
            let normal = (b - a).cross(c - a);
            for &i in t {
                if let Some(sum) = normals.get_mut(i as usize) {
                    *sum += normal;
                }
            }
        }
    }
    let bounds =
        mesh.positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |b, p| (b.0.min(*p), b.1.max(*p)));
    let towards_front = if placement.flip_normals { -1.0 } else { 1.0 };
    let step = part * (bounds.1 - bounds.0).length() * towards_front;
    let mut moved = mesh.clone();
    for (position, normal) in moved.positions.iter_mut().zip(&normals) {
        *position -= normal.normalize_or_zero() * step;
    }
    moved
}
