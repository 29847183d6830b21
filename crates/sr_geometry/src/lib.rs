//! Shapes and the rays that meet them.
//!
//! In: [`GeometryInput`], borrowed triangle meshes, spheres, disks, cylinders, bilinear patches and curves in world space and in
//! groups that [`Instance`]s place. Out: [`Geometry`], flat arrays behind one 16-wide bounding volume hierarchy, which answers
//! [`Geometry::intersect`] (closest [`Hit`]), [`Geometry::occluded`] (any hit) and [`Geometry::surface`]
//! (position with its error bound, normals, texture coordinates), for one ray or for a batch of [`Rays`]. No material
//! and no light is known here.
//!
//! Invariants:
//! - Triangles are watertight: a ray through a shared edge or vertex hits at least one of its triangles.
//! - [`Surface::spawn_ray`] leaves the surface by a bound of the rounding errors there, not by a global epsilon.
//! - The same input gives the same tree, hence the same hits, for any number of threads.
//!
//! Coordinates are `f32`. Sizes and distances between 1e-12 and 1e12 are in the range where nothing overflows.
//!
//! Reading order: `ray`, `shape`, `geometry`, `surface`, `batch`, then `bvh`.

mod batch;
mod bounds;
mod bvh;
mod curve;
mod cylinder;
mod disk;
mod geometry;
mod instance;
mod offset;
mod patch;
mod ray;
mod shape;
mod sphere;
mod surface;

pub use batch::{BATCH, Hits, Rays, Surfaces, Vec2s, Vec3s};
pub use bounds::Bounds3;
pub use curve::{CurveBasis, CurveUv, Curves, CurvesError};
pub use cylinder::Cylinder;
pub use geometry::{Geometry, ShapeRef};
pub use patch::BilinearPatch;
pub use ray::{Hit, NO_INSTANCE, Ray, ShapeId};
pub use shape::{Disk, GeometryError, GeometryInput, Instance, MeshError, Shape, Sphere, TriangleMesh};
pub use surface::{Surface, Tangents};
