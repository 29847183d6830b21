//! Shapes: meshes, spheres, disks, cylinders, patches and curves, what they are made of, and what they emit.

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};

use crate::{ColorInput, CurvesDesc, MaterialId, Rgb, diagnostic::Span};

/// A shape in the space of the list that holds it (world space for [`crate::SceneDesc::shapes`]).
#[derive(Clone, Debug)]
pub struct ShapeDesc {
    /// Its form.
    pub geometry: Geometry,
    /// What it is made of.
    pub material: MaterialId,
    /// What it emits, if it is a light.
    pub emission: Option<Emission>,
    /// Where it was described.
    pub span: Span,
}

/// The form of a shape.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Triangles.
    Mesh(Arc<MeshDesc>),
    /// A sphere. Its (u, v) are (φ / 2π, θ / π) about its own +Z.
    Sphere {
        /// Centre.
        center: Vec3,
        /// Radius, positive.
        radius: f32,
        /// Orientation of the parametrisation: world-space +X, +Y, +Z of the sphere's own frame,
        /// orthonormal; a mirrored frame is allowed and leaves the normals outward.
        frame: glam::Mat3,
        /// Do normals point inwards?
        flip_normals: bool,
    },
    /// A flat disk or ellipse: centre ± `u_axis` ± `v_axis`, normal along `u_axis` × `v_axis`.
    ///
    /// Its (u, v) are (r, φ / 2π): r = 0 at the centre and 1 on the rim, φ from `u_axis` towards `v_axis`.
    Disk {
        /// Centre.
        center: Vec3,
        /// First half-axis.
        u_axis: Vec3,
        /// Second half-axis, perpendicular to the first.
        v_axis: Vec3,
        /// Does the normal point against `u_axis` × `v_axis`?
        flip_normals: bool,
    },
    /// An open cylinder. Its (u, v) are (φ / 2π, z / `length`) in its own frame.
    Cylinder {
        /// Centre of the circle at z = 0.
        base: Vec3,
        /// World-space +X, +Y, +Z of the cylinder's own frame, orthonormal, +Z along the axis; a mirrored frame is
        /// allowed and leaves the normals outward.
        frame: glam::Mat3,
        /// Radius, positive.
        radius: f32,
        /// From one end to the other, positive.
        length: f32,
        /// Do normals point to the axis?
        flip_normals: bool,
    },
    /// The surface p(u, v) between four points that is linear in u and in v. It cannot emit.
    Patch {
        /// p(0, 0), p(1, 0), p(0, 1), p(1, 1).
        corners: [Vec3; 4],
        /// Does the normal point against ∂p/∂u × ∂p/∂v?
        flip_normals: bool,
    },
    /// Curves.
    Curves(Arc<CurvesDesc>),
}

/// A mesh has at most so many sets of texture coordinates, the first one counted.
pub const MAX_UV_SETS: u32 = 4;

/// A triangle mesh. Per-vertex arrays are empty or as long as `positions`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshDesc {
    /// What to call it in messages.
    pub name: String,
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Vertex normals, unit length; empty: flat shading.
    pub normals: Vec<Vec3>,
    /// Vertex texture coordinates; empty: barycentric coordinates of each triangle.
    pub uvs: Vec<Vec2>,
    /// Further sets of texture coordinates, for [`crate::TextureDesc::OtherUvs`].
    pub further_uvs: Vec<Vec<Vec2>>,
    /// Vertex indices, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Colours of the vertices, for [`crate::TextureDesc::MeshColor`]; may be empty.
    pub vertex_colors: Vec<Rgb>,
    /// Colours of the triangles; empty, or as long as `triangles`.
    pub face_colors: Vec<Rgb>,
}

/// Diffuse emission from the front of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance, in W sr⁻¹ m⁻² per channel.
    pub radiance: ColorInput,
}

/// Shapes that are placed by instances.
#[derive(Clone, Debug)]
pub struct GroupDesc {
    /// The shapes, in the group's space. They do not emit.
    pub shapes: Vec<ShapeDesc>,
}

/// A placement of a group.
#[derive(Clone, Debug)]
pub struct InstanceDesc {
    /// Index into [`crate::SceneDesc::groups`].
    pub group: u32,
    /// Placement; invertible.
    pub world_from_group: Affine3A,
    /// Where it was described.
    pub span: Span,
}
