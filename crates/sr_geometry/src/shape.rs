//! What geometry is built from: borrowed shapes, groups and instances, and what can be wrong with them.

use glam::{Affine3A, Mat3, Vec2, Vec3};

use crate::{BilinearPatch, Bounds3, Curves, CurvesError, Cylinder};

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
    /// An open cylinder.
    Cylinder(Cylinder),
    /// A bilinear patch.
    Patch(BilinearPatch),
    /// Curves.
    Curves(Curves<'a>),
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

/// What is wrong with a [`GeometryInput`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// A mesh's arrays do not fit together, or hold what is not finite.
    #[error("shape {shape}: {error}")]
    Mesh {
        /// Which, as [`crate::ShapeId`] counts.
        shape: u32,
        /// Why.
        error: MeshError,
    },
    /// A sphere without a positive radius, or not finite.
    #[error(
        "shape {shape}: a sphere of radius {radius} at {center}; expected a positive radius and finite numbers"
    )]
    Sphere {
        /// Which, as [`crate::ShapeId`] counts.
        shape: u32,
        /// Its centre.
        center: Vec3,
        /// Its radius.
        radius: f32,
    },
    /// A disk whose half-axes are zero, not perpendicular, or not finite.
    #[error(
        "shape {shape}: a disk with half-axes {u_axis} and {v_axis}; expected finite and perpendicular ones"
    )]
    Disk {
        /// Which, as [`crate::ShapeId`] counts.
        shape: u32,
        /// Its first half-axis.
        u_axis: Vec3,
        /// Its second half-axis.
        v_axis: Vec3,
    },
    /// A cylinder without a positive radius and length, or not finite.
    #[error(
        "shape {shape}: a cylinder of radius {radius} and length {length}; expected positive and finite numbers"
    )]
    Cylinder {
        /// Which, as [`crate::ShapeId`] counts.
        shape: u32,
        /// Its radius.
        radius: f32,
        /// Its length.
        length: f32,
    },
    /// A bilinear patch without area, or not finite.
    #[error(
        "shape {shape}: a bilinear patch between {corners:?}; expected finite points that are not on a line"
    )]
    Patch {
        /// Which, as [`crate::ShapeId`] counts.
        shape: u32,
        /// Its corners.
        corners: [Vec3; 4],
    },
    /// Curves whose arrays do not fit together, or hold what cannot be.
    #[error("shape {shape}: {error}")]
    Curves {
        /// Which, as [`crate::ShapeId`] counts.
        shape: u32,
        /// Why.
        error: CurvesError,
    },
    /// An instance of a group that is not there.
    #[error("instance {instance} places group {group}, but there are only {groups}")]
    GroupOutOfRange {
        /// Which instance.
        instance: usize,
        /// The group it asks for.
        group: u32,
        /// Number of groups.
        groups: usize,
    },
    /// An instance that flattens its group, or is not finite.
    #[error("instance {instance}: its transform cannot be inverted")]
    SingularInstance {
        /// Which instance.
        instance: usize,
    },
    /// More of something than indices of 32 bits can tell apart.
    #[error("{count} {what}; at most {limit} are supported")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many.
        count: usize,
        /// How many may be.
        limit: usize,
    },
}

/// What is wrong with a [`TriangleMesh`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A NaN or an infinity.
    #[error("{what} {vertex} is not finite")]
    NotFinite {
        /// In which array.
        what: &'static str,
        /// Where in it.
        vertex: usize,
    },
    /// A per-vertex array that is neither empty nor as long as the positions.
    #[error("{count} {what}s for {vertices} vertices; expected none or as many")]
    Count {
        /// Which array.
        what: &'static str,
        /// Its length.
        count: usize,
        /// Number of positions.
        vertices: usize,
    },
    /// A triangle of a vertex that is not there.
    #[error("triangle {triangle} uses vertex {index}, but there are only {vertices}")]
    VertexOutOfRange {
        /// Which triangle.
        triangle: usize,
        /// The vertex it asks for.
        index: u32,
        /// Number of positions.
        vertices: usize,
    },
}

impl Shape<'_> {
    /// Checks everything that later code relies on; `shape` is the number used in messages.
    pub(crate) fn validate(&self, shape: u32) -> Result<(), GeometryError> {
        match self {
            Shape::Mesh(mesh) => mesh.validate().map_err(|error| GeometryError::Mesh { shape, error }),
            Shape::Sphere(s) => {
                let frame = s.frame.to_cols_array();
                let finite =
                    s.center.is_finite() && s.radius.is_finite() && frame.iter().all(|x| x.is_finite());
                let ok = finite && s.radius > 0.0;
                ok.then_some(()).ok_or(GeometryError::Sphere { shape, center: s.center, radius: s.radius })
            }
            Shape::Disk(d) => {
                let (u, v) = (d.u_axis.length(), d.v_axis.length());
                let finite = d.center.is_finite() && u.is_finite() && v.is_finite();
                let ok = finite && u > 0.0 && v > 0.0 && d.u_axis.dot(d.v_axis).abs() <= 1e-3 * u * v;
                ok.then_some(()).ok_or(GeometryError::Disk { shape, u_axis: d.u_axis, v_axis: d.v_axis })
            }
            Shape::Cylinder(c) => {
                let (radius, length) = (c.radius, c.length);
                let finite = c.base.is_finite() && c.frame.is_finite() && (radius + length).is_finite();
                let ok = finite && radius > 0.0 && length > 0.0;
                ok.then_some(()).ok_or(GeometryError::Cylinder { shape, radius, length })
            }
            Shape::Patch(p) => {
                let [p00, p10, p01, p11] = p.corners.map(|p| p.as_dvec3());
                let area = (p11 - p00).cross(p01 - p10).length() + (p10 - p00).cross(p01 - p00).length();
                let ok = p.corners.iter().all(|p| p.is_finite()) && area > 0.0;
                ok.then_some(()).ok_or(GeometryError::Patch { shape, corners: p.corners })
            }
            Shape::Curves(curves) => {
                curves.validate().map_err(|error| GeometryError::Curves { shape, error })
            }
        }
    }
}

impl TriangleMesh<'_> {
    fn validate(&self) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        for (what, count) in [("normal", self.normals.len()), ("texture coordinate", self.uvs.len())] {
            if count != 0 && count != vertices {
                return Err(MeshError::Count { what, count, vertices });
            }
        }
        let not_finite = [
            ("vertex", self.positions.iter().position(|p| !p.is_finite())),
            ("normal", self.normals.iter().position(|n| !n.is_finite())),
            ("texture coordinate", self.uvs.iter().position(|uv| !uv.is_finite())),
        ];
        for (what, found) in not_finite {
            if let Some(vertex) = found {
                return Err(MeshError::NotFinite { what, vertex });
            }
        }
        for (triangle, indices) in self.triangles.iter().enumerate() {
            if let Some(&index) = indices.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::VertexOutOfRange { triangle, index, vertices });
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
