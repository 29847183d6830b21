//! What geometry is built from: borrowed shapes, groups and instances, and what can be wrong with them.

use glam::{Affine3A, Mat3, Vec2, Vec3};

use crate::Bounds3;

/// A triangle mesh, borrowed. Per-vertex slices are empty or as long as `positions`.
#[derive(Clone, Copy, Debug, Default)]
pub struct TriangleMesh<'a> {
    /// Vertex positions.
    pub positions: &'a [Vec3],
    /// Vertex normals; empty: flat shading.
    pub normals: &'a [Vec3],
    /// Vertex texture coordinates; empty: barycentric coordinates of each triangle.
    pub uvs: &'a [Vec2],
    /// Vertex indices, counter-clockwise seen from the front.
    pub triangles: &'a [[u32; 3]],
}

/// A sphere. Its (u, v) are (φ / 2π, θ / π) about its own +Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub center: Vec3,
    /// Radius, positive.
    pub radius: f32,
    /// Orthonormal: +X, +Y, +Z of the sphere's own frame.
    pub frame: Mat3,
    /// Do normals point inwards?
    pub flip_normals: bool,
}

/// A flat disk or ellipse: centre ± `u_axis` ± `v_axis`, normal along `u_axis` × `v_axis`.
/// Its (u, v) are (r, φ / 2π), r = 1 on the rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// Centre.
    pub center: Vec3,
    /// First half-axis.
    pub u_axis: Vec3,
    /// Second half-axis, perpendicular to the first.
    pub v_axis: Vec3,
    /// Does the normal point against `u_axis` × `v_axis`?
    pub flip_normals: bool,
}

/// A shape in the space of the list that holds it.
#[derive(Clone, Copy, Debug)]
pub enum Shape<'a> {
    /// Triangles.
    Mesh(TriangleMesh<'a>),
    /// A sphere.
    Sphere(Sphere),
    /// A disk.
    Disk(Disk),
}

/// A placement of a group.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// Index into [`GeometryInput::groups`].
    pub group: u32,
    /// Placement; invertible. Scales need not be uniform and may mirror.
    pub world_from_group: Affine3A,
}

/// Everything that [`crate::Geometry::build`] needs.
#[derive(Clone, Debug, Default)]
pub struct GeometryInput<'a> {
    /// Shapes in world space.
    pub shapes: Vec<Shape<'a>>,
    /// Shapes that instances place, each list in its own space.
    pub groups: Vec<Vec<Shape<'a>>>,
    /// Placements of groups in the world.
    pub instances: Vec<Instance>,
}

/// What is wrong with a [`GeometryInput`]. Shapes are counted as [`crate::ShapeId`] counts them.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum GeometryError {
    #[error("shape {shape}: vertex {vertex} is {value}, which is not finite")]
    NonFiniteVertex { shape: u32, vertex: usize, value: Vec3 },
    #[error("shape {shape}: {what} {vertex} is not finite")]
    NonFiniteAttribute { shape: u32, what: &'static str, vertex: usize },
    #[error("shape {shape}: triangle {triangle} uses vertex {index}, but there are only {vertices}")]
    VertexOutOfRange { shape: u32, triangle: usize, index: u32, vertices: usize },
    #[error("shape {shape}: {count} {what} for {vertices} vertices; expected none or as many")]
    AttributeCount { shape: u32, what: &'static str, count: usize, vertices: usize },
    #[error(
        "shape {shape}: a sphere of radius {radius} at {center}; expected a positive radius and finite numbers"
    )]
    BadSphere { shape: u32, center: Vec3, radius: f32 },
    #[error(
        "shape {shape}: a disk with half-axes {u_axis} and {v_axis}; expected finite and perpendicular ones"
    )]
    BadDisk { shape: u32, u_axis: Vec3, v_axis: Vec3 },
    #[error("instance {instance} places group {group}, but there are only {groups}")]
    GroupOutOfRange { instance: usize, group: u32, groups: usize },
    #[error("instance {instance}: its transform cannot be inverted")]
    SingularInstance { instance: usize },
    #[error("{count} {what}; at most {limit} are supported")]
    TooMany { what: &'static str, count: usize, limit: usize },
}

impl Shape<'_> {
    /// Checks everything that later code relies on; `shape` is the number used in messages.
    pub(crate) fn validate(&self, shape: u32) -> Result<(), GeometryError> {
        match self {
            Shape::Mesh(mesh) => mesh.validate(shape),
            Shape::Sphere(s) => {
                let frame = s.frame.to_cols_array();
                let finite =
                    s.center.is_finite() && s.radius.is_finite() && frame.iter().all(|x| x.is_finite());
                let ok = finite && s.radius > 0.0;
                ok.then_some(()).ok_or(GeometryError::BadSphere { shape, center: s.center, radius: s.radius })
            }
            Shape::Disk(d) => {
                let (u, v) = (d.u_axis.length(), d.v_axis.length());
                let finite = d.center.is_finite() && u.is_finite() && v.is_finite();
                let ok = finite && u > 0.0 && v > 0.0 && d.u_axis.dot(d.v_axis).abs() <= 1e-3 * u * v;
                ok.then_some(()).ok_or(GeometryError::BadDisk { shape, u_axis: d.u_axis, v_axis: d.v_axis })
            }
        }
    }
}

impl TriangleMesh<'_> {
    fn validate(&self, shape: u32) -> Result<(), GeometryError> {
        let vertices = self.positions.len();
        if let Some((vertex, &value)) = self.positions.iter().enumerate().find(|(_, p)| !p.is_finite()) {
            return Err(GeometryError::NonFiniteVertex { shape, vertex, value });
        }
        for (what, count) in [("normals", self.normals.len()), ("texture coordinates", self.uvs.len())] {
            if count != 0 && count != vertices {
                return Err(GeometryError::AttributeCount { shape, what, count, vertices });
            }
        }
        if let Some(vertex) = self.normals.iter().position(|n| !n.is_finite()) {
            return Err(GeometryError::NonFiniteAttribute { shape, what: "normal", vertex });
        }
        if let Some(vertex) = self.uvs.iter().position(|uv| !uv.is_finite()) {
            return Err(GeometryError::NonFiniteAttribute { shape, what: "texture coordinate", vertex });
        }
        for (triangle, indices) in self.triangles.iter().enumerate() {
            if let Some(&index) = indices.iter().find(|&&i| i as usize >= vertices) {
                return Err(GeometryError::VertexOutOfRange { shape, triangle, index, vertices });
            }
        }
        Ok(())
    }
}

impl Disk {
    pub(crate) fn bounds(&self) -> Bounds3 {
        let half = (self.u_axis * self.u_axis + self.v_axis * self.v_axis).map(f32::sqrt);
        Bounds3 { min: self.center - half, max: self.center + half }.padded()
    }
}

impl Sphere {
    pub(crate) fn bounds(&self) -> Bounds3 {
        Bounds3 { min: self.center - self.radius, max: self.center + self.radius }.padded()
    }
}
