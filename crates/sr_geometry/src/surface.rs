//! What shading needs to know of a point on a shape, and rays that leave it.

use glam::{Vec2, Vec3};

use crate::offset::{ROUNDING, offset_ray_origin};
use crate::{Geometry, Hit, Ray, ShapeId, ShapeRef};

/// A point on a surface, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point.
    pub p: Vec3,
    /// How far from `p` the surface may be, on each axis: a bound of rounding errors, also of the next ray's test.
    pub p_error: Vec3,
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
        Ray::new(offset_ray_origin(self.p, self.p_error, self.ng, direction), direction)
    }

    /// A ray that leaves the surface and ends just before `target`: whatever it hits hides the target.
    #[inline]
    pub fn spawn_ray_to(&self, target: Vec3) -> Ray {
        let origin = offset_ray_origin(self.p, self.p_error, self.ng, target - self.p);
        Ray { origin, direction: target - origin, t_max: 1.0 - SHADOW_SLACK }
    }
}

impl Geometry {
    /// The surface at a hit of `ray`.
    #[inline]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let Some(instance) = self.placed(hit.instance) else {
            return self.surface_in_group(ray, hit);
        };
        instance.surface_in_world(&self.surface_in_group(&instance.ray_in_group(ray), hit))
    }

    #[inline]
    fn surface_in_group(&self, ray: &Ray, hit: &Hit) -> Surface {
        match self.shape_of(hit.shape) {
            ShapeRef::Mesh => self.surface_of_triangle(hit.shape, hit.primitive, hit.b1, hit.b2),
            ShapeRef::Sphere(sphere) => sphere.surface(ray.at(hit.t)),
            ShapeRef::Disk(disk) => disk.surface(Vec2::new(hit.b1, hit.b2)),
        }
    }

    /// The surface at barycentric coordinates of a triangle, in the space of its list.
    #[inline]
    pub fn surface_of_triangle(&self, shape: ShapeId, triangle: u32, b1: f32, b2: f32) -> Surface {
        let [p0, p1, p2] = self.triangle_vertices(shape, triangle);
        let (e1, e2) = (p1 - p0, p2 - p0);
        let (m1, m2) = (b1 * e1, b2 * e2);
        let p = p0 + (m1 + m2);
        // Rounding here, and that of the next ray's test of a triangle of this size.
        let size = e1.abs().max(e2.abs()).max_element();
        let p_error = ROUNDING * (2.0 * p.abs() + 4.0 * (m1.abs() + m2.abs()) + 4.0 * size);
        let ng = e1.cross(e2).normalize_or_zero();
        let b0 = 1.0 - b1 - b2;
        let ns = self
            .triangle_normals(shape, triangle)
            .map_or(ng, |[n0, n1, n2]| (b0 * n0 + b1 * n1 + b2 * n2).try_normalize().unwrap_or(ng));
        let uv = self
            .triangle_uvs(shape, triangle)
            .map_or(Vec2::new(b1, b2), |[uv0, uv1, uv2]| b0 * uv0 + b1 * uv1 + b2 * uv2);
        Surface { p, p_error, ng, ns, uv }
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
        };
        instance.map_or(local, |instance| instance.tangents_in_world(&local))
    }

    fn tangents_of_triangle(&self, shape: ShapeId, triangle: u32) -> Tangents {
        let [p0, p1, p2] = self.triangle_vertices(shape, triangle);
        let (e1, e2) = (p1 - p0, p2 - p0);
        let Some([uv0, uv1, uv2]) = self.triangle_uvs(shape, triangle) else {
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
