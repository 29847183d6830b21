//! Placed groups: rays into the group's space, surfaces out of it. Transforms are `f64`, so that a point comes back
//! to where it was but for one rounding.

use glam::{DAffine3, Vec3};

use crate::bvh::Tree;
use crate::offset::ROUNDING;
use crate::surface::Located;
use crate::{Bounds3, GeometryError, Instance, Ray, Tangents};

/// An [`Instance`] and its inverse.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedGroup {
    pub group: u32,
    world_from_group: DAffine3,
    group_from_world: DAffine3,
}

impl PlacedGroup {
    /// `index` is the number used in messages.
    pub fn new(index: usize, instance: &Instance, groups: usize) -> Result<Self, GeometryError> {
        let group = instance.group;
        if group as usize >= groups {
            return Err(GeometryError::GroupOutOfRange { instance: index, group, groups });
        }
        let world_from_group = instance.world_from_group.as_daffine3();
        let group_from_world = world_from_group.inverse();
        if !(world_from_group.is_finite() && group_from_world.is_finite()) {
            return Err(GeometryError::SingularInstance { instance: index });
        }
        Ok(Self { group, world_from_group, group_from_world })
    }

    /// The box of the placed tree, in the world.
    pub fn bounds(&self, tree: &Tree) -> Bounds3 {
        tree.bounds.transformed(&self.world_from_group)
    }

    /// The same ray, with the same t, in the group's space.
    pub fn ray_in_group(&self, ray: &Ray) -> Ray {
        Ray {
            origin: self.group_from_world.transform_point3(ray.origin.as_dvec3()).as_vec3(),
            direction: self.group_from_world.transform_vector3(ray.direction.as_dvec3()).as_vec3(),
            t_max: ray.t_max,
        }
    }

    /// Normals stay on the side of the surface on which they were, also where the placement mirrors.
    pub fn located_in_world(&self, surface: &Located) -> Located {
        let p = self.world_from_group.transform_point3(surface.p.as_dvec3()).as_vec3();
        let matrix = self.world_from_group.matrix3;
        let magnitude = |v: Vec3| -> Vec3 {
            let v = v.as_dvec3();
            (matrix.x_axis.abs() * v.x + matrix.y_axis.abs() * v.y + matrix.z_axis.abs() * v.z).as_vec3()
        };
        let normal =
            |n: Vec3| (self.group_from_world.matrix3.transpose() * n.as_dvec3()).normalize().as_vec3();
        Located {
            p,
            // The next ray's origin is rounded once more on its way back into the group.
            p_error: magnitude(surface.p_error + 2.0 * ROUNDING * surface.p.abs()) + 2.0 * ROUNDING * p.abs(),
            ng: normal(surface.ng),
            ns: normal(surface.ns),
            uv: surface.uv,
        }
    }

    pub fn tangents_in_world(&self, tangents: &Tangents) -> Tangents {
        let vector = |v: Vec3| self.world_from_group.transform_vector3(v.as_dvec3()).as_vec3();
        Tangents { dpdu: vector(tangents.dpdu), dpdv: vector(tangents.dpdv) }
    }

    /// A world-space point in the group's space.
    pub fn point_in_group(&self, p: Vec3) -> Vec3 {
        self.group_from_world.transform_point3(p.as_dvec3()).as_vec3()
    }
}
