//! A batch of rays in a tree that is walked with several rays in turn finds what each of them finds alone.

mod common;

use common::{OwnedMesh, Random, soup};
use glam::{Affine3A, Mat3, Quat, Vec3};
use sr_geometry::{BATCH, Geometry, GeometryInput, Hits, Instance, NO_INSTANCE, Ray, Rays, Shape, Sphere};

/// Triangles enough for a large tree, spheres, and instances of groups that have a tree, too few triangles for one, and
/// spheres among triangles.
struct Parts {
    world: OwnedMesh,
    groups: [OwnedMesh; 3],
    spheres: Vec<Sphere>,
    placements: Vec<(u32, Affine3A)>,
}

impl Parts {
    fn new(random: &mut Random) -> Self {
        let sphere = |random: &mut Random| Sphere {
            center: random.cube(),
            radius: 0.05,
            frame: Mat3::IDENTITY,
            flip_normals: false,
        };
        let placement = |random: &mut Random, i: u32| {
            let turn = Quat::from_scaled_axis(random.cube());
            (i % 3, Affine3A::from_scale_rotation_translation(Vec3::splat(0.2), turn, random.cube()))
        };
        Self {
            world: soup(random, 20_000, 0.1),
            groups: [soup(random, 300, 0.3), soup(random, 20, 0.6), soup(random, 100, 0.3)],
            spheres: (0..50).map(|_| sphere(random)).collect(),
            placements: (0..60).map(|i| placement(random, i)).collect(),
        }
    }

    fn world(&self) -> Vec<Shape<'_>> {
        let spheres = self.spheres.iter().copied().map(Shape::Sphere);
        [self.world.shape()].into_iter().chain(spheres).collect()
    }

    fn group(&self, group: usize) -> Vec<Shape<'_>> {
        let spheres = &self.spheres[..if group == 2 { 10 } else { 0 }];
        [self.groups[group].shape()].into_iter().chain(spheres.iter().copied().map(Shape::Sphere)).collect()
    }

    fn build(&self) -> Geometry {
        let instances =
            self.placements.iter().map(|&(group, world_from_group)| Instance { group, world_from_group });
        let groups = (0..self.groups.len()).map(|group| self.group(group)).collect();
        Geometry::build(GeometryInput { shapes: self.world(), groups, instances: instances.collect() })
            .unwrap()
    }
}

fn ray(random: &mut Random, i: usize) -> Ray {
    let ray = Ray::new(random.cube(), random.direction());
    match i % 16 {
        0 => Ray { direction: Vec3::splat(f32::NAN), ..ray },
        1 => Ray { direction: Vec3::ZERO, ..ray },
        2 => Ray { t_max: 0.0, ..ray },
        3 => Ray { t_max: f32::NAN, ..ray },
        // Away from everything.
        4 => Ray::new(Vec3::splat(9.0), Vec3::ONE),
        5 => Ray::new(ray.origin, Vec3::X),
        6..10 => Ray { t_max: 0.3, ..ray },
        _ => ray,
    }
}

#[test]
fn a_batch_finds_what_its_rays_find_alone() {
    let mut random = Random(5);
    let geometry = Parts::new(&mut random).build();
    let (mut rays, mut hits, mut occluded) = (Rays::NONE, Hits::NONE, [false; BATCH]);
    let (mut found, mut missed) = (0, 0);
    for count in [0, 1, 2, 7, 8, 9, 100, BATCH, BATCH, BATCH, BATCH] {
        for i in 0..count {
            rays.set(i, &ray(&mut random, i));
        }
        geometry.intersect_batch(&rays, count, &mut hits);
        geometry.occluded_batch(&rays, count, &mut occluded);
        for (i, &occluded) in occluded[..count].iter().enumerate() {
            let ray = rays.get(i);
            assert_eq!(hits.get(i), geometry.intersect(&ray), "{ray:?}");
            assert_eq!(occluded, geometry.occluded(&ray), "{ray:?}");
            *(if occluded { &mut found } else { &mut missed }) += 1;
        }
    }
    assert!(found > 300 && missed > 300, "{found} hits, {missed} misses");
}

/// The world and every group met apart, by the ray in its space.
#[test]
fn instances_are_met_as_their_groups_are() {
    let mut random = Random(6);
    let parts = Parts::new(&mut random);
    let geometry = parts.build();
    let apart = |shapes| Geometry::build(GeometryInput { shapes, ..Default::default() }).unwrap();
    let world = apart(parts.world());
    let groups = [0, 1, 2].map(|group| apart(parts.group(group)));
    let first_shape = [0, 1, 2]
        .map(|group| parts.world().len() + (0..group).map(|before| parts.group(before).len()).sum::<usize>());
    let mut instances_hit = [0; 3];
    for i in 0..4000 {
        let ray = ray(&mut random, i);
        let mut closest = world.intersect(&ray).map(|hit| (hit.t, hit.shape.0, NO_INSTANCE));
        for (instance, &(group, world_from_group)) in (0..).zip(&parts.placements) {
            let group_from_world = world_from_group.as_daffine3().inverse();
            let in_group = Ray {
                origin: group_from_world.transform_point3(ray.origin.as_dvec3()).as_vec3(),
                direction: group_from_world.transform_vector3(ray.direction.as_dvec3()).as_vec3(),
                t_max: closest.map_or(ray.t_max, |(t, ..)| t),
            };
            if let Some(hit) = groups[group as usize].intersect(&in_group) {
                closest = Some((hit.t, hit.shape.0 + first_shape[group as usize] as u32, instance));
            }
        }
        let found = geometry.intersect(&ray).map(|hit| (hit.t, hit.shape.0, hit.instance));
        assert_eq!(found, closest, "{ray:?}");
        assert_eq!(geometry.occluded(&ray), closest.is_some(), "{ray:?}");
        if let Some((.., instance)) = closest.filter(|&(.., instance)| instance != NO_INSTANCE) {
            instances_hit[instance as usize % 3] += 1;
        }
    }
    assert!(instances_hit.iter().all(|&hits| hits > 50), "{instances_hit:?}");
}
