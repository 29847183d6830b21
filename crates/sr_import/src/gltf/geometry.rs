//! A primitive's triangles: strips and fans taken apart, attributes read, v turned upwards.

use std::sync::Arc;

use glam::{DMat4, Vec2, Vec3};
use sr_scene::{MAX_UV_SETS, MeshDesc, Span};

use super::document::Document;
use super::draco::Unpacked;
use super::json::Value;
use super::material::Surface;
use super::texture::Sets;

/// Mesh, primitive, and the node if it bends the mesh.
pub type Key = (usize, usize, Option<usize>);

/// A primitive, read.
#[derive(Clone)]
pub struct Part {
    pub mesh: Arc<MeshDesc>,
    pub surface: Surface,
    pub span: Span,
}

/// What a node makes of its mesh.
#[derive(Clone, Copy, Default)]
pub struct Bend<'a> {
    /// The node, if it bends its mesh at all.
    pub node: Option<usize>,
    /// The node's own weights of the morph targets.
    pub weights: Option<&'a Value>,
    /// Where each joint puts what it holds.
    pub joints: Option<&'a [DMat4]>,
}

const TRIANGLES: usize = 4;
const STRIP: usize = 5;
const FAN: usize = 6;

impl Document<'_, '_> {
    /// The primitives of a mesh.
    pub fn parts(&mut self, index: usize, mesh: &Value, bend: Bend<'_>) -> Vec<Part> {
        let primitives = mesh.get("primitives").map_or(&[][..], Value::list);
        let name = mesh.get("name").and_then(Value::text).map(crate::values::shown);
        let name = name.unwrap_or_else(|| format!("meshes[{index}]"));
        let weights = bend.weights.or_else(|| mesh.get("weights"));
        let mut parts = Vec::new();
        for (at, primitive) in primitives.iter().enumerate() {
            let key = (index, at, bend.node);
            if !self.meshes.contains_key(&key) {
                let part = self.primitive(primitive, &name, weights, bend.joints);
                self.meshes.insert(key, part);
            }
            parts.extend(self.meshes[&key].clone());
        }
        parts
    }

    fn primitive(
        &mut self,
        primitive: &Value,
        name: &str,
        weights: Option<&Value>,
        joints: Option<&[DMat4]>,
    ) -> Option<Part> {
        let mode = primitive.get("mode").map_or(Some(TRIANGLES), Value::index);
        if !matches!(mode, Some(TRIANGLES | STRIP | FAN)) {
            let message = "points and lines are not shown";
            self.warn_once("gltf::primitive-mode", &primitive.span, message, "they are left out");
            return None;
        }
        let attributes = primitive.get("attributes")?;
        let Some(position) = attributes.get("POSITION") else {
            let message = "the primitive has no positions";
            self.warn("gltf::no-positions", &primitive.span, message, "it is left out");
            return None;
        };
        let packed = match self.unpack(primitive) {
            Some(None) => return None,
            packed => packed.flatten(),
        };
        let packed = packed.as_ref();
        let mut mesh = MeshDesc { name: name.to_owned(), ..MeshDesc::default() };
        mesh.positions =
            self.attribute(packed, "POSITION", position, &[3])?.of(0.0).map(Vec3::from).collect();
        let count = mesh.positions.len();
        if let Some(normal) = attributes.get("NORMAL") {
            mesh.normals = self.attribute(packed, "NORMAL", normal, &[3])?.of(0.0).map(Vec3::from).collect();
        }
        if let Some(color) = attributes.get("COLOR_0") {
            let rows = self.attribute(packed, "COLOR_0", color, &[3, 4])?;
            if rows.width == 4 && rows.iter().any(|row| row[3] != 1.0) {
                let message = "the opacity of vertices is not shown";
                self.warn_once("gltf::vertex-opacity", &color.span, message, "their colors are");
            }
            mesh.vertex_colors = rows.of(1.0).map(|c| Vec3::from_array(c).max(Vec3::ZERO)).collect();
        }
        let surface = self.surface(self.material_of(primitive), !mesh.vertex_colors.is_empty());
        let uvs = self.uvs(primitive, attributes, packed, &surface.sets)?;
        let mut uvs = uvs.into_iter();
        mesh.uvs = uvs.next().unwrap_or_default();
        mesh.further_uvs = uvs.collect();
        if let Some(targets) = primitive.get("targets") {
            self.morph(targets.list(), weights, &mut mesh);
        }
        if let Some(joints) = joints {
            self.skin(attributes, packed, joints, &mut mesh);
        }
        if let Some(packed) = packed {
            mesh.triangles = packed.triangles.clone();
            return Some(Part { mesh: Arc::new(mesh), surface, span: primitive.span.clone() });
        }
        let corners = match primitive.get("indices") {
            Some(indices) => self.indices(indices)?,
            None => (0..count as u32).collect(),
        };
        mesh.triangles = match mode {
            Some(STRIP) => strip(&corners),
            Some(FAN) => corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]).collect(),
            _ => corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        };
        Some(Part { mesh: Arc::new(mesh), surface, span: primitive.span.clone() })
    }

    /// The sets of texture coordinates that a material takes; empty where the primitive does not have them.
    fn uvs(
        &mut self,
        primitive: &Value,
        attributes: &Value,
        packed: Option<&Unpacked>,
        sets: &Sets,
    ) -> Option<Vec<Vec<Vec2>>> {
        let mut all = Vec::new();
        for (at, set) in sets.used.iter().take(MAX_UV_SETS as usize).enumerate() {
            let name = format!("TEXCOORD_{set}");
            let Some(uv) = attributes.get(&name) else {
                if sets.any {
                    let message = format!("the primitive has no {name}, which its textures take");
                    let instead = if at == 0 { "each triangle has its own" } else { "another set is used" };
                    self.warn("gltf::no-coordinates", &primitive.span, message, instead);
                }
                all.push(Vec::new());
                continue;
            };
            let rows = self.attribute(packed, &name, uv, &[2])?;
            all.push(rows.of(0.0).map(|[u, v]| Vec2::new(u, 1.0 - v)).collect());
        }
        Some(all)
    }
}

/// The front of every other triangle of a strip is turned.
fn strip(corners: &[u32]) -> Vec<[u32; 3]> {
    let turned = |(at, t): (usize, &[u32])| if at % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
    corners.windows(3).enumerate().map(turned).collect()
}
