//! What shading needs to know of a point on a shape, and rays that leave it.

use glam::{BVec3, Vec2, Vec3};

use crate::geometry::Corners;
use crate::offset::{ROUNDING, clearance};
use crate::{BATCH, Geometry, Hit, Hits, NO_INSTANCE, Ray, Rays, ShapeId, ShapeRef, Surfaces};

/// A point on a surface, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point.
    pub p: Vec3,
    /// How far along the normal a ray starts that leaves the surface: a bound of rounding errors, also of the next
    /// ray's test.
    pub clearance: f32,
    /// Unit geometric normal, on the front.
    pub ng: Vec3,
    /// Unit shading normal, interpolated between vertices that have normals, else `ng`. As the file gives it: not
    /// turned towards any ray, nor to the side of `ng`.
    pub ns: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
}

/// Derivatives of position by texture coordinates, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangents {
    /// ∂p/∂u.
    pub dpdu: Vec3,
    /// ∂p/∂v.
    pub dpdv: Vec3,
}

/// A ray to a point ends before it by this part of its length, so that a surface there does not hide it.
const SHADOW_SLACK: f32 = 1e-4;

impl Surface {
    /// A ray without an end that leaves the surface to the side to which `direction` points.
    #[inline]
    pub fn spawn_ray(&self, direction: Vec3) -> Ray {
        Ray::new(self.origin_towards(direction), direction)
    }

    /// A ray that leaves the surface and ends just before `target`: whatever it hits hides the target.
    #[inline]
    pub fn spawn_ray_to(&self, target: Vec3) -> Ray {
        let origin = self.origin_towards(target - self.p);
        Ray { origin, direction: target - origin, t_max: 1.0 - SHADOW_SLACK }
    }

    #[inline]
    fn origin_towards(&self, direction: Vec3) -> Vec3 {
        self.p + self.ng * self.clearance.copysign(direction.dot(self.ng))
    }
}

/// A [`Surface`] whose error is still known on each axis, so that it can be moved to another space.
#[derive(Clone, Copy)]
pub(crate) struct Located {
    pub p: Vec3,
    /// How far from `p` the surface may be, on each axis: a bound of rounding errors, also of the next ray's test.
    pub p_error: Vec3,
    pub ng: Vec3,
    pub ns: Vec3,
    pub uv: Vec2,
}

impl Located {
    /// At barycentric coordinates of a triangle, which are its texture coordinates.
    #[inline(always)]
    fn on_flat_triangle([p0, p1, p2]: [Vec3; 3], b1: f32, b2: f32) -> Self {
        let (e1, e2) = (p1 - p0, p2 - p0);
        let (m1, m2) = (b1 * e1, b2 * e2);
        let p = p0 + (m1 + m2);
        // Rounding here, and that of the next ray's test of a triangle of this size.
        let size = e1.abs().max(e2.abs()).max_element();
        let p_error = ROUNDING * (2.0 * p.abs() + 4.0 * (m1.abs() + m2.abs()) + 4.0 * size);
        // Edges of any size, so that their product neither overflows nor vanishes.
        let per_size = 1.0 / size;
        let ng = (e1 * per_size).cross(e2 * per_size).normalize_or_zero();
        Self { p, p_error, ng, ns: ng, uv: Vec2::new(b1, b2) }
    }

    #[inline(always)]
    pub fn surface(self) -> Surface {
        let Self { p, p_error, ng, ns, uv } = self;
        Surface { p, clearance: clearance(p, p_error, ng), ng, ns, uv }
    }
}

/// Zero if the normals cancel.
#[inline(always)]
fn interpolated_normal([n0, n1, n2]: [Vec3; 3], b1: f32, b2: f32) -> Vec3 {
    ((1.0 - b1 - b2) * n0 + b1 * n1 + b2 * n2).normalize_or_zero()
}

impl Corners<'_> {
    /// The interpolated normal, if there are normals and they do not cancel.
    #[inline(always)]
    fn shading_normal(&self, b1: f32, b2: f32) -> Option<Vec3> {
        let n = interpolated_normal(self.normals()?, b1, b2);
        (n != Vec3::ZERO).then_some(n)
    }

    /// Texture coordinates; barycentric ones if there are none.
    #[inline(always)]
    fn uv(&self, b1: f32, b2: f32) -> Vec2 {
        match self.uvs() {
            Some([uv0, uv1, uv2]) => (1.0 - b1 - b2) * uv0 + b1 * uv1 + b2 * uv2,
            None => Vec2::new(b1, b2),
        }
    }
}

impl Geometry {
    /// The surface at a hit of `ray`.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        match self.shape_of(hit.shape) {
            ShapeRef::Mesh if hit.instance == NO_INSTANCE => {
                self.located_on_triangle(hit.shape, hit.primitive, hit.b1, hit.b2).surface()
            }
            _ => self.surface_of_other(ray, hit),
        }
    }

    /// Out of line, so that the way over triangles stays small.
    #[inline(never)]
    fn surface_of_other(&self, ray: &Ray, hit: &Hit) -> Surface {
        let instance = self.placed(hit.instance);
        let located = match self.shape_of(hit.shape) {
            ShapeRef::Mesh => self.located_on_triangle(hit.shape, hit.primitive, hit.b1, hit.b2),
            ShapeRef::Sphere(sphere) => {
                let ray = instance.map_or(*ray, |instance| instance.ray_in_group(ray));
                sphere.located(ray.at(hit.t))
            }
            ShapeRef::Disk(disk) => disk.located(Vec2::new(hit.b1, hit.b2)),
            ShapeRef::Cylinder(cylinder) => {
                let ray = instance.map_or(*ray, |instance| instance.ray_in_group(ray));
                cylinder.located(ray.at(hit.t))
            }
            ShapeRef::Patch(patch) => patch.located(Vec2::new(hit.b1, hit.b2)),
            ShapeRef::Curves => {
                let ray = instance.map_or(*ray, |instance| instance.ray_in_group(ray));
                self.located_on_curve(hit, ray.at(hit.t))
            }
        };
        instance.map_or(located, |instance| instance.located_in_world(&located)).surface()
    }

    /// The surface at barycentric coordinates of a triangle, in the space of its list.
    pub fn surface_of_triangle(&self, shape: ShapeId, triangle: u32, b1: f32, b2: f32) -> Surface {
        self.located_on_triangle(shape, triangle, b1, b2).surface()
    }

    #[inline(always)]
    fn located_on_triangle(&self, shape: ShapeId, triangle: u32, b1: f32, b2: f32) -> Located {
        let corners = self.corners(shape, triangle);
        let flat = Located::on_flat_triangle(corners.positions(), b1, b2);
        Located { ns: corners.shading_normal(b1, b2).unwrap_or(flat.ng), uv: corners.uv(b1, b2), ..flat }
    }

    /// Texture coordinates of a hit of `ray`.
    #[inline]
    pub fn uv(&self, ray: &Ray, hit: &Hit) -> Vec2 {
        match self.shape_of(hit.shape) {
            ShapeRef::Mesh => self.corners(hit.shape, hit.primitive).uv(hit.b1, hit.b2),
            _ => self.surface_of_other(ray, hit).uv,
        }
    }

    /// The surfaces at the hits of the first `count` rays, which must all have hit something.
    #[inline(always)]
    pub fn surfaces(&self, rays: &Rays, hits: &Hits, count: usize, surfaces: &mut Surfaces) {
        let count = count.min(BATCH);
        let (mut is_smooth, mut any_smooth) = ([0_u32; BATCH], false);
        // Those that are no triangles in world space.
        let (mut others, mut other_count) = ([0_u32; BATCH], 0);
        if self.has_many_corners() {
            for i in 0..count {
                self.prefetch_corners(&hits.at(i));
            }
            for i in 0..count {
                if let Some(corners) = self.world_corners(&hits.at(i)) {
                    corners.prefetch();
                }
            }
        }
        for i in 0..count {
            let hit = hits.at(i);
            let Some(corners) = self.world_corners(&hit) else {
                others[other_count] = i as u32;
                other_count += 1;
                continue;
            };
            for (of_batch, position) in surfaces.corners.iter_mut().zip(corners.positions()) {
                of_batch.set(i, position);
            }
            if let Some(of_corners) = corners.normals() {
                for (of_batch, normal) in surfaces.normals.iter_mut().zip(of_corners) {
                    of_batch.set(i, normal);
                }
                (is_smooth[i], any_smooth) = (1, true);
            }
        }
        for i in 0..count {
            let [p0, p1, p2] = &surfaces.corners;
            let corners = [p0.get(i), p1.get(i), p2.get(i)];
            surfaces.set(i, &Located::on_flat_triangle(corners, hits.b1[i], hits.b2[i]).surface());
        }
        if any_smooth {
            for i in 0..count {
                let [n0, n1, n2] = &surfaces.normals;
                let normals = [n0.get(i), n1.get(i), n2.get(i)];
                let smooth = interpolated_normal(normals, hits.b1[i], hits.b2[i]);
                let is_smooth = BVec3::splat(is_smooth[i] != 0 && smooth != Vec3::ZERO);
                surfaces.ns.set(i, Vec3::select(is_smooth, smooth, surfaces.ng.get(i)));
            }
        }
        for &i in &others[..other_count] {
            let i = i as usize;
            surfaces.set(i, &self.surface_of_other(&rays.get(i), &hits.at(i)));
        }
    }

    /// Derivatives of position by texture coordinates at a surface and its hit. Not orthogonal, and of any length;
    /// where the texture coordinates of a triangle are degenerate, some unit tangents.
    pub fn tangents(&self, surface: &Surface, hit: &Hit) -> Tangents {
        let instance = self.placed(hit.instance);
        let local = match self.shape_of(hit.shape) {
            ShapeRef::Mesh => self.tangents_of_triangle(hit.shape, hit.primitive),
            ShapeRef::Sphere(sphere) => {
                sphere.tangents(instance.map_or(surface.p, |instance| instance.point_in_group(surface.p)))
            }
            ShapeRef::Disk(disk) => disk.tangents(Vec2::new(hit.b1, hit.b2)),
            ShapeRef::Cylinder(cylinder) => {
                cylinder.tangents(instance.map_or(surface.p, |instance| instance.point_in_group(surface.p)))
            }
            ShapeRef::Patch(patch) => patch.tangents(Vec2::new(hit.b1, hit.b2)),
            ShapeRef::Curves => {
                let near = instance.map_or(surface.p, |instance| instance.point_in_group(surface.p));
                self.tangents_of_curve(hit, near)
            }
        };
        instance.map_or(local, |instance| instance.tangents_in_world(&local))
    }

    fn tangents_of_triangle(&self, shape: ShapeId, triangle: u32) -> Tangents {
        let corners = self.corners(shape, triangle);
        let [p0, p1, p2] = corners.positions();
        let (e1, e2) = (p1 - p0, p2 - p0);
        let Some([uv0, uv1, uv2]) = corners.uvs() else {
            return Tangents { dpdu: e1, dpdv: e2 };
        };
        let (d1, d2) = (uv1 - uv0, uv2 - uv0);
        let inv_det = 1.0 / d1.perp_dot(d2);
        if !inv_det.is_finite() {
            let (dpdu, dpdv) = e1.cross(e2).try_normalize().unwrap_or(Vec3::Z).any_orthonormal_pair();
            return Tangents { dpdu, dpdv };
        }
        Tangents { dpdu: inv_det * (d2.y * e1 - d1.y * e2), dpdv: inv_det * (d1.x * e2 - d2.x * e1) }
    }
}
