//! Many rays at a time: arrays of components, so that one instruction serves several of them.
//!
//! In: [`Rays`]. Out: [`Hits`], whether rays are occluded, and [`Surfaces`]. Each ray's answer depends on that ray
//! alone, not on its neighbours, nor on its place.
//!
//! Arrays have a fixed, equal length, so that compilers see that an index which is in one is in all, and turn plain
//! loops over them into vector instructions.

use glam::{Vec2, Vec3};

use crate::{Geometry, Hit, NO_INSTANCE, Ray, ShapeId, Surface};

/// The most rays of a batch.
pub const BATCH: usize = 256;

/// Points or directions.
#[derive(Clone, Debug)]
pub struct Vec3s {
    /// First components.
    pub x: [f32; BATCH],
    /// Second components.
    pub y: [f32; BATCH],
    /// Third components.
    pub z: [f32; BATCH],
}

impl Vec3s {
    /// The same vector everywhere.
    pub const fn splat(v: Vec3) -> Self {
        Self { x: [v.x; BATCH], y: [v.y; BATCH], z: [v.z; BATCH] }
    }

    /// One of them.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Vec3 {
        Vec3::new(self.x[i], self.y[i], self.z[i])
    }

    /// Replaces one of them.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Vec3) {
        (self.x[i], self.y[i], self.z[i]) = (v.x, v.y, v.z);
    }
}

/// Texture coordinates.
#[derive(Clone, Debug)]
pub struct Vec2s {
    /// First components.
    pub x: [f32; BATCH],
    /// Second components.
    pub y: [f32; BATCH],
}

impl Vec2s {
    /// The same vector everywhere.
    pub const fn splat(v: Vec2) -> Self {
        Self { x: [v.x; BATCH], y: [v.y; BATCH] }
    }

    /// One of them.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Vec2 {
        Vec2::new(self.x[i], self.y[i])
    }

    /// Replaces one of them.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Vec2) {
        (self.x[i], self.y[i]) = (v.x, v.y);
    }
}

/// A batch of [`Ray`]s.
#[derive(Clone, Debug)]
pub struct Rays {
    /// Where they start.
    pub origin: Vec3s,
    /// Where they go.
    pub direction: Vec3s,
    /// Where they end, exclusive.
    pub t_max: [f32; BATCH],
}

impl Rays {
    /// Rays that hit nothing.
    pub const NONE: Self =
        Self { origin: Vec3s::splat(Vec3::ZERO), direction: Vec3s::splat(Vec3::ZERO), t_max: [0.0; BATCH] };

    /// One of them.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Ray {
        Ray { origin: self.origin.get(i), direction: self.direction.get(i), t_max: self.t_max[i] }
    }

    /// Replaces one of them.
    #[inline(always)]
    pub fn set(&mut self, i: usize, ray: &Ray) {
        self.origin.set(i, ray.origin);
        self.direction.set(i, ray.direction);
        self.t_max[i] = ray.t_max;
    }
}

/// What a batch of rays hits: the fields of [`Hit`].
#[derive(Clone, Debug)]
pub struct Hits {
    /// Ray parameters; infinite for a ray that hits nothing, whose other fields mean nothing.
    pub t: [f32; BATCH],
    /// First coordinates on the primitives.
    pub b1: [f32; BATCH],
    /// Second coordinates on the primitives.
    pub b2: [f32; BATCH],
    /// Shapes.
    pub shape: [u32; BATCH],
    /// Triangles within their meshes.
    pub primitive: [u32; BATCH],
    /// Instances, or [`NO_INSTANCE`].
    pub instance: [u32; BATCH],
}

impl Hits {
    /// No hits.
    pub const NONE: Self = Self {
        t: [f32::INFINITY; BATCH],
        b1: [0.0; BATCH],
        b2: [0.0; BATCH],
        shape: [0; BATCH],
        primitive: [0; BATCH],
        instance: [NO_INSTANCE; BATCH],
    };

    /// One of them.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Option<Hit> {
        (self.t[i] < f32::INFINITY).then(|| self.at(i))
    }

    /// One of them; the ray must have hit something.
    #[inline(always)]
    pub fn at(&self, i: usize) -> Hit {
        Hit {
            t: self.t[i],
            b1: self.b1[i],
            b2: self.b2[i],
            shape: ShapeId(self.shape[i]),
            primitive: self.primitive[i],
            instance: self.instance[i],
        }
    }

    /// Replaces one of them.
    #[inline(always)]
    pub fn set(&mut self, i: usize, hit: Option<&Hit>) {
        self.t[i] = f32::INFINITY;
        if let Some(hit) = hit {
            (self.t[i], self.b1[i], self.b2[i]) = (hit.t, hit.b1, hit.b2);
            (self.shape[i], self.primitive[i], self.instance[i]) = (hit.shape.0, hit.primitive, hit.instance);
        }
    }
}

/// Points on surfaces: the fields of [`Surface`] but for the texture coordinates, which few surfaces need.
#[derive(Clone, Debug)]
pub struct Surfaces {
    /// The points.
    pub p: Vec3s,
    /// How far rays start along the normal.
    pub clearance: [f32; BATCH],
    /// Geometric normals.
    pub ng: Vec3s,
    /// Shading normals.
    pub ns: Vec3s,
    /// The triangles that the points are on: positions and normals of their corners.
    pub(crate) corners: [Vec3s; 3],
    pub(crate) normals: [Vec3s; 3],
}

impl Surfaces {
    /// The origin, everywhere.
    pub const NONE: Self = Self {
        p: Vec3s::splat(Vec3::ZERO),
        clearance: [0.0; BATCH],
        ng: Vec3s::splat(Vec3::Z),
        ns: Vec3s::splat(Vec3::Z),
        corners: [const { Vec3s::splat(Vec3::ZERO) }; 3],
        normals: [const { Vec3s::splat(Vec3::ZERO) }; 3],
    };

    /// One of them, with the texture coordinates that [`Geometry::uv`] knows.
    #[inline(always)]
    pub fn get(&self, i: usize, uv: Vec2) -> Surface {
        Surface { p: self.p.get(i), clearance: self.clearance[i], ng: self.ng.get(i), ns: self.ns.get(i), uv }
    }

    /// Replaces one of them.
    #[inline(always)]
    pub fn set(&mut self, i: usize, surface: &Surface) {
        self.p.set(i, surface.p);
        self.clearance[i] = surface.clearance;
        self.ng.set(i, surface.ng);
        self.ns.set(i, surface.ns);
    }
}

impl Geometry {
    /// The closest hits of the first `count` rays. What `hits` holds beyond them is left open.
    pub fn intersect_batch(&self, rays: &Rays, count: usize, hits: &mut Hits) {
        let meet_other = |other, ray: &_| self.meet_other(other, ray);
        self.bvh.intersect_batch(&self.world, (rays, count), meet_other, hits);
    }

    /// Which of the first `count` rays hit anything? What `occluded` holds beyond them is left open.
    pub fn occluded_batch(&self, rays: &Rays, count: usize, occluded: &mut [bool; BATCH]) {
        let meet_other = |other, ray: &_| self.meet_other(other, ray);
        self.bvh.occluded_batch(&self.world, (rays, count), meet_other, occluded);
    }
}
