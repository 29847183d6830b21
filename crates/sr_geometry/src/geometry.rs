//! The compiled geometry: flat arrays, and trees over them.

use std::ops::Range;

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;
use sr_sampling::prefetch;

use crate::bvh::{Bvh, MAX_INDEX, Met, PrimRef, Round, Tree};
use crate::curve::{CurveSet, Piece};
use crate::instance::PlacedGroup;
use crate::surface::Located;
use crate::{
    BilinearPatch, Bounds3, Cylinder, Disk, GeometryError, GeometryInput, Hit, NO_INSTANCE, Ray, Shape,
    ShapeId, Sphere, Tangents, TriangleMesh,
};

/// Bytes of triangles and positions from which [`Geometry::surfaces`] asks for them before it reads them: what a
/// second-level cache does not hold.
const PREFETCH_FROM: usize = 1 << 20;

/// Shapes, groups and instances behind one bounding volume hierarchy; read-only.
#[derive(Debug)]
pub struct Geometry {
    shapes: Vec<ShapeRecord>,
    /// Vertices and triangles of all meshes, one mesh after another.
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    spheres: Vec<Sphere>,
    disks: Vec<Disk>,
    cylinders: Vec<Cylinder>,
    patches: Vec<BilinearPatch>,
    curves: CurveSet,
    instances: Vec<PlacedGroup>,
    others: Vec<Other>,
    pub(crate) bvh: Bvh,
    pub(crate) world: Tree,
    groups: Vec<Tree>,
}

/// Where a shape is in the arrays.
#[derive(Clone, Copy, Debug)]
enum ShapeRecord {
    Mesh(MeshRecord),
    Sphere(u32),
    Disk(u32),
    Cylinder(u32),
    Patch(u32),
    Curves(u32),
}

/// Where a mesh is in the arrays. Its vertex indices count from `first_vertex`.
#[derive(Clone, Copy, Debug)]
struct MeshRecord {
    first_triangle: u32,
    triangles: u32,
    first_vertex: u32,
    /// `None`: flat shading.
    first_normal: Option<u32>,
    /// `None`: barycentric coordinates.
    first_uv: Option<u32>,
}

/// A primitive of the tree that is not a triangle.
#[derive(Clone, Copy, Debug)]
enum Other {
    Sphere { shape: ShapeId, index: u32 },
    Disk { shape: ShapeId, index: u32 },
    Cylinder { shape: ShapeId, index: u32 },
    Patch { shape: ShapeId, index: u32 },
    Curve { shape: ShapeId, piece: Piece },
    Instance(u32),
}

/// A compiled shape, in the space of its list.
#[derive(Clone, Copy, Debug)]
pub enum ShapeRef<'a> {
    /// A mesh, of [`Geometry::primitive_count`] triangles.
    Mesh,
    /// A sphere.
    Sphere(&'a Sphere),
    /// A disk.
    Disk(&'a Disk),
    /// An open cylinder.
    Cylinder(&'a Cylinder),
    /// A bilinear patch.
    Patch(&'a BilinearPatch),
    /// Curves, of [`Geometry::primitive_count`] segments.
    Curves,
}

impl Geometry {
    /// Copies the shapes and builds their trees, on the threads of the current Rayon pool.
    pub fn build(input: GeometryInput<'_>) -> Result<Self, GeometryError> {
        let all = || input.shapes.iter().chain(input.groups.iter().flatten());
        check_counts(all(), input.instances.len())?;
        let shapes: Vec<_> = all().collect();
        let checks = shapes.par_iter().enumerate().map(|(i, shape)| shape.validate(i as u32));
        checks.find_first(Result::is_err).unwrap_or(Ok(()))?;
        let groups = input.groups.len();
        let placed = input.instances.iter().enumerate();
        let instances =
            placed.map(|(i, instance)| PlacedGroup::new(i, instance, groups)).collect::<Result<_, _>>()?;
        let mut geometry = Self {
            shapes: Vec::new(),
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            triangles: Vec::new(),
            spheres: Vec::new(),
            disks: Vec::new(),
            cylinders: Vec::new(),
            patches: Vec::new(),
            curves: CurveSet::default(),
            instances,
            others: Vec::new(),
            bvh: Bvh::new(),
            world: Tree::EMPTY,
            groups: Vec::new(),
        };
        shapes.into_iter().for_each(|shape| geometry.store(shape));
        geometry.build_trees(&input);
        Ok(geometry)
    }

    fn store(&mut self, shape: &Shape<'_>) {
        let record = match shape {
            Shape::Mesh(mesh) => ShapeRecord::Mesh(self.store_mesh(mesh)),
            Shape::Sphere(sphere) => {
                self.spheres.push(*sphere);
                ShapeRecord::Sphere(self.spheres.len() as u32 - 1)
            }
            Shape::Disk(disk) => {
                self.disks.push(*disk);
                ShapeRecord::Disk(self.disks.len() as u32 - 1)
            }
            Shape::Cylinder(cylinder) => {
                self.cylinders.push(*cylinder);
                ShapeRecord::Cylinder(self.cylinders.len() as u32 - 1)
            }
            Shape::Patch(patch) => {
                self.patches.push(*patch);
                ShapeRecord::Patch(self.patches.len() as u32 - 1)
            }
            Shape::Curves(curves) => ShapeRecord::Curves(self.curves.store(curves)),
        };
        self.shapes.push(record);
    }

    fn store_mesh(&mut self, mesh: &TriangleMesh<'_>) -> MeshRecord {
        let record = MeshRecord {
            first_triangle: self.triangles.len() as u32,
            triangles: mesh.triangles.len() as u32,
            first_vertex: self.positions.len() as u32,
            first_normal: (!mesh.normals.is_empty()).then_some(self.normals.len() as u32),
            first_uv: (!mesh.uvs.is_empty()).then_some(self.uvs.len() as u32),
        };
        self.positions.extend_from_slice(mesh.positions);
        self.normals.extend_from_slice(mesh.normals);
        self.uvs.extend_from_slice(mesh.uvs);
        self.triangles.extend_from_slice(mesh.triangles);
        record
    }

    /// The groups' trees first: instances need their boxes.
    fn build_trees(&mut self, input: &GeometryInput<'_>) {
        let mut first = input.shapes.len();
        for group in &input.groups {
            let mut prims = self.prim_refs(first..first + group.len());
            first += group.len();
            let tree = self.build_tree(&mut prims);
            self.groups.push(tree);
        }
        let mut prims = self.prim_refs(0..input.shapes.len());
        for (i, instance) in self.instances.iter().enumerate() {
            let bounds = instance.bounds(&self.groups[instance.group as usize]);
            if !bounds.is_empty() {
                prims.push(PrimRef::new(bounds, PrimRef::OTHER, self.others.len() as u32));
                self.others.push(Other::Instance(i as u32));
            }
        }
        self.world = self.build_tree(&mut prims);
        // Batches meet the world only.
        let (mut bvh, mut world) = (std::mem::replace(&mut self.bvh, Bvh::new()), self.world);
        let vertices_of = |shape, triangle| self.triangle_vertices(shape, triangle);
        bvh.add_pieces(&mut world, &prims, vertices_of, |other| self.round_of(other));
        (self.bvh, self.world) = (bvh, world);
    }

    fn build_tree(&mut self, prims: &mut [PrimRef]) -> Tree {
        let mut bvh = std::mem::replace(&mut self.bvh, Bvh::new());
        let tree = bvh.add_tree(prims, |shape, triangle| self.triangle_vertices(shape, triangle));
        self.bvh = bvh;
        tree
    }

    /// The sphere or disk that a primitive of the tree is. Packets know no others.
    fn round_of(&self, other: u32) -> Option<Round<'_>> {
        match self.others[other as usize] {
            Other::Sphere { shape, index } => Some(Round::Sphere(shape, &self.spheres[index as usize])),
            Other::Disk { shape, index } => Some(Round::Disk(shape, &self.disks[index as usize])),
            Other::Cylinder { .. } | Other::Patch { .. } | Other::Curve { .. } | Other::Instance(_) => None,
        }
    }

    /// What the tree over these shapes is built from. Triangles without an area are left out.
    fn prim_refs(&mut self, shapes: Range<usize>) -> Vec<PrimRef> {
        let mut prims = Vec::new();
        for i in shapes {
            let shape = ShapeId(i as u32);
            let (bounds, other) = match self.shapes[i] {
                ShapeRecord::Mesh(mesh) => {
                    prims.par_extend((0..mesh.triangles).into_par_iter().filter_map(|triangle| {
                        let vertices = self.triangle_vertices(shape, triangle);
                        let bounds = vertices.into_iter().fold(Bounds3::EMPTY, Bounds3::with);
                        has_area(vertices).then_some(PrimRef::new(bounds, shape.0, triangle))
                    }));
                    continue;
                }
                ShapeRecord::Sphere(index) => {
                    (self.spheres[index as usize].bounds(), Other::Sphere { shape, index })
                }
                ShapeRecord::Disk(index) => {
                    (self.disks[index as usize].bounds(), Other::Disk { shape, index })
                }
                ShapeRecord::Cylinder(index) => {
                    (self.cylinders[index as usize].bounds(), Other::Cylinder { shape, index })
                }
                ShapeRecord::Patch(index) => {
                    (self.patches[index as usize].bounds(), Other::Patch { shape, index })
                }
                ShapeRecord::Curves(index) => {
                    for (bounds, piece) in self.curves.pieces(index) {
                        prims.push(PrimRef::new(bounds, PrimRef::OTHER, self.others.len() as u32));
                        self.others.push(Other::Curve { shape, piece });
                    }
                    continue;
                }
            };
            prims.push(PrimRef::new(bounds, PrimRef::OTHER, self.others.len() as u32));
            self.others.push(other);
        }
        prims
    }

    /// The closest hit, if any.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.bvh.intersect(&self.world, ray, |other, ray| self.meet_other(other, ray))
    }

    /// Does the ray hit anything?
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.bvh.occluded(&self.world, ray, |other, ray| self.meet_other(other, ray))
    }

    /// Out of line, so that the walk over triangles stays small.
    #[inline(never)]
    pub(crate) fn meet_other(&self, other: u32, ray: &Ray) -> Met {
        let hit =
            |shape, t, at: Vec2| Hit { t, b1: at.x, b2: at.y, shape, primitive: 0, instance: NO_INSTANCE };
        match self.others[other as usize] {
            Other::Sphere { shape, index } => {
                let met = self.spheres[index as usize].intersect(ray);
                Met::Hit(met.map(|t| hit(shape, t, Vec2::ZERO)))
            }
            Other::Disk { shape, index } => {
                let met = self.disks[index as usize].intersect(ray);
                Met::Hit(met.map(|(t, at)| hit(shape, t, at)))
            }
            Other::Cylinder { shape, index } => {
                let met = self.cylinders[index as usize].intersect(ray);
                Met::Hit(met.map(|t| hit(shape, t, Vec2::ZERO)))
            }
            Other::Patch { shape, index } => {
                let met = self.patches[index as usize].intersect(ray);
                Met::Hit(met.map(|(t, at)| hit(shape, t, at)))
            }
            Other::Curve { shape, piece } => {
                let met = self.curves.intersect(self.curves_of(shape), piece, ray);
                let primitive = piece.segment();
                Met::Hit(met.map(|(t, u)| Hit { primitive, ..hit(shape, t, Vec2::new(u, 0.0)) }))
            }
            Other::Instance(instance) => {
                let placed = &self.instances[instance as usize];
                let tree = self.groups[placed.group as usize];
                Met::Placed { tree, ray: placed.ray_in_group(ray), instance }
            }
        }
    }

    /// The box around everything; empty for an empty scene.
    pub fn bounds(&self) -> Bounds3 {
        self.world.bounds
    }

    /// Number of shapes in the world and in groups.
    pub fn shape_count(&self) -> u32 {
        self.shapes.len() as u32
    }

    /// The shape itself, in the space of its list.
    #[inline]
    pub fn shape_of(&self, shape: ShapeId) -> ShapeRef<'_> {
        match self.shapes[shape.0 as usize] {
            ShapeRecord::Mesh(_) => ShapeRef::Mesh,
            ShapeRecord::Sphere(index) => ShapeRef::Sphere(&self.spheres[index as usize]),
            ShapeRecord::Disk(index) => ShapeRef::Disk(&self.disks[index as usize]),
            ShapeRecord::Cylinder(index) => ShapeRef::Cylinder(&self.cylinders[index as usize]),
            ShapeRecord::Patch(index) => ShapeRef::Patch(&self.patches[index as usize]),
            ShapeRecord::Curves(_) => ShapeRef::Curves,
        }
    }

    /// Where curves are in the set of all.
    fn curves_of(&self, shape: ShapeId) -> u32 {
        match self.shapes[shape.0 as usize] {
            ShapeRecord::Curves(index) => index,
            other => panic!("shape {} is no curves but {other:?}", shape.0),
        }
    }

    /// The surface at a hit of curves, seen in the space of their list from close by.
    pub(crate) fn located_on_curve(&self, hit: &Hit, near: Vec3) -> Located {
        self.curves.located(self.curves_of(hit.shape), hit.primitive, hit.b1, near)
    }

    /// [`Geometry::tangents`] of curves, in the space of their list.
    pub(crate) fn tangents_of_curve(&self, hit: &Hit, near: Vec3) -> Tangents {
        self.curves.tangents(self.curves_of(hit.shape), hit.primitive, hit.b1, near)
    }

    /// Triangles of a mesh, segments of curves; 1 for other shapes.
    pub fn primitive_count(&self, shape: ShapeId) -> u32 {
        match self.shapes[shape.0 as usize] {
            ShapeRecord::Mesh(mesh) => mesh.triangles,
            ShapeRecord::Curves(index) => self.curves.segment_count(index),
            _ => 1,
        }
    }

    /// Which vertices of its mesh a triangle has; `None` if `shape` is no mesh.
    pub fn vertex_indices(&self, shape: ShapeId, triangle: u32) -> Option<[u32; 3]> {
        match &self.shapes[shape.0 as usize] {
            ShapeRecord::Mesh(mesh) => Some(self.triangles[(mesh.first_triangle + triangle) as usize]),
            _ => None,
        }
    }

    /// A triangle's vertices, in the space of its list. Panics if `shape` is no mesh.
    #[inline]
    pub fn triangle_vertices(&self, shape: ShapeId, triangle: u32) -> [Vec3; 3] {
        self.corners(shape, triangle).positions()
    }

    /// A triangle's corners. Panics if `shape` is no mesh.
    #[inline(always)]
    pub(crate) fn corners(&self, shape: ShapeId, triangle: u32) -> Corners<'_> {
        match &self.shapes[shape.0 as usize] {
            ShapeRecord::Mesh(mesh) => {
                debug_assert!(triangle < mesh.triangles);
                let indices = self.triangles[(mesh.first_triangle + triangle) as usize];
                Corners { geometry: self, mesh, indices }
            }
            other => panic!("shape {} is no mesh but {other:?}", shape.0),
        }
    }

    /// A triangle's corners; `None` if the hit is no triangle in world space.
    #[inline(always)]
    pub(crate) fn world_corners(&self, hit: &Hit) -> Option<Corners<'_>> {
        match &self.shapes[hit.shape.0 as usize] {
            ShapeRecord::Mesh(mesh) if hit.instance == NO_INSTANCE => {
                let indices = self.triangles[(mesh.first_triangle + hit.primitive) as usize];
                Some(Corners { geometry: self, mesh, indices })
            }
            _ => None,
        }
    }

    /// Are there so many triangles that their corners are not in caches?
    #[inline(always)]
    pub(crate) fn has_many_corners(&self) -> bool {
        size_of_val(&self.triangles[..]) + size_of_val(&self.positions[..]) > PREFETCH_FROM
    }

    /// Asks for the memory that [`Geometry::world_corners`] reads of a hit.
    #[inline(always)]
    pub(crate) fn prefetch_corners(&self, hit: &Hit) {
        if let ShapeRecord::Mesh(mesh) = &self.shapes[hit.shape.0 as usize] {
            prefetch(&self.triangles[(mesh.first_triangle + hit.primitive) as usize]);
        }
    }

    /// The instance with this index; `None` for [`NO_INSTANCE`].
    #[inline]
    pub(crate) fn placed(&self, instance: u32) -> Option<&PlacedGroup> {
        if instance == NO_INSTANCE { None } else { Some(&self.instances[instance as usize]) }
    }

    /// Bytes of all arrays.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.shapes[..])
            + size_of_val(&self.positions[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.uvs[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.spheres[..])
            + size_of_val(&self.disks[..])
            + size_of_val(&self.cylinders[..])
            + size_of_val(&self.patches[..])
            + self.curves.memory_bytes()
            + size_of_val(&self.instances[..])
            + size_of_val(&self.others[..])
            + self.bvh.memory_bytes()
    }
}

/// The corners of a triangle.
pub(crate) struct Corners<'a> {
    geometry: &'a Geometry,
    mesh: &'a MeshRecord,
    indices: [u32; 3],
}

impl Corners<'_> {
    /// Asks for the memory that the other functions read.
    #[inline(always)]
    pub fn prefetch(&self) {
        let Self { geometry, mesh, indices } = self;
        for i in indices {
            prefetch(&geometry.positions[(mesh.first_vertex + i) as usize]);
            if let Some(first) = mesh.first_normal {
                prefetch(&geometry.normals[(first + i) as usize]);
            }
            if let Some(first) = mesh.first_uv {
                prefetch(&geometry.uvs[(first + i) as usize]);
            }
        }
    }

    /// Positions, in the space of the mesh's list.
    #[inline(always)]
    pub fn positions(&self) -> [Vec3; 3] {
        self.indices.map(|i| self.geometry.positions[(self.mesh.first_vertex + i) as usize])
    }

    /// Normals, if the mesh has any.
    #[inline(always)]
    pub fn normals(&self) -> Option<[Vec3; 3]> {
        let first = self.mesh.first_normal?;
        Some(self.indices.map(|i| self.geometry.normals[(first + i) as usize]))
    }

    /// Texture coordinates, if the mesh has any.
    #[inline(always)]
    pub fn uvs(&self) -> Option<[Vec2; 3]> {
        let first = self.mesh.first_uv?;
        Some(self.indices.map(|i| self.geometry.uvs[(first + i) as usize]))
    }
}

/// Refuses what indices of 32 bits cannot tell apart.
fn check_counts<'a>(
    shapes: impl Iterator<Item = &'a Shape<'a>>,
    instances: usize,
) -> Result<(), GeometryError> {
    let (mut count, mut triangles, mut vertices, mut pieces) = (0, 0, 0, 0);
    for shape in shapes {
        count += 1;
        if let Shape::Mesh(mesh) = shape {
            triangles += mesh.triangles.len();
            vertices += mesh.positions.len();
        }
        if let Shape::Curves(curves) = shape {
            pieces += curves.most_pieces();
        }
    }
    let counts = [
        ("triangles", triangles),
        ("vertices", vertices),
        ("shapes, instances and pieces of curves", count + instances + pieces),
    ];
    match counts.into_iter().find(|&(_, count)| count > MAX_INDEX) {
        Some((what, count)) => Err(GeometryError::TooMany { what, count, limit: MAX_INDEX }),
        None => Ok(()),
    }
}

/// Is the triangle more than a line or a point? Edges and their products are (nearly) exact in `f64`.
fn has_area(vertices: [Vec3; 3]) -> bool {
    let [a, b, c] = vertices.map(|v| v.as_dvec3());
    (b - a).cross(c - a) != DVec3::ZERO
}
