//! Scenes of meshes that own their arrays, for us and for Embree alike.

use glam::{DAffine3, DQuat, DVec3, Quat, Vec3};
use sr_geometry::{Geometry, GeometryInput, Instance};

use crate::arguments::SceneName;
use crate::common::{OwnedMesh, Random, closed_box, soup};

/// Meshes in world space, or, if there are placements, in the group that they place.
pub struct Scene {
    /// The meshes.
    pub meshes: Vec<OwnedMesh>,
    /// World from group; empty: no group.
    pub placements: Vec<DAffine3>,
    /// Half the scene's size across.
    pub extent: f32,
}

impl Scene {
    /// The scene with this name.
    pub fn new(name: &SceneName) -> Self {
        let world = |meshes| Self { meshes, placements: Vec::new(), extent: 1.0 };
        match *name {
            SceneName::Box => world(walls_blocks_and_lamp()),
            SceneName::Scattered(n) => {
                // Edges shrink with the distances between triangles.
                world(vec![soup(&mut Random(7), n, 1.5 * (n as f32).cbrt().recip())])
            }
            SceneName::Mesh(n) | SceneName::Primary(n) => world(vec![bumpy_sphere(n)]),
            SceneName::Forest { instances, triangles } => {
                let extent = (instances as f32).sqrt() * 0.8;
                let placements = scattered_placements(instances, extent);
                Self { meshes: vec![bumpy_sphere(triangles)], placements, extent }
            }
        }
    }

    /// Builds our trees.
    pub fn build(&self) -> Geometry {
        let shapes = self.meshes.iter().map(OwnedMesh::shape).collect();
        let input = if self.placements.is_empty() {
            GeometryInput { shapes, ..Default::default() }
        } else {
            let place = |m: &DAffine3| Instance { group: 0, world_from_group: m.as_affine3a() };
            let instances = self.placements.iter().map(place).collect();
            GeometryInput { shapes: Vec::new(), groups: vec![shapes], instances }
        };
        Geometry::build(input).expect("benches make valid meshes")
    }

    /// Triangles that are stored.
    pub fn stored_triangles(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.triangles.len()).sum()
    }

    /// Triangles that rays meet.
    pub fn triangles(&self) -> usize {
        self.stored_triangles() * self.placements.len().max(1)
    }

    /// Bytes of the meshes' own arrays.
    pub fn mesh_bytes(&self) -> usize {
        let bytes = |mesh: &OwnedMesh| size_of_val(&mesh.positions[..]) + size_of_val(&mesh.triangles[..]);
        self.meshes.iter().map(bytes).sum()
    }
}

/// As separate meshes, as a scene file has them.
fn walls_blocks_and_lamp() -> Vec<OwnedMesh> {
    let block = |at: Vec3, half: Vec3, angle: f32| {
        closed_box(1).transformed(|p| Quat::from_rotation_y(angle) * (p * half) + at)
    };
    let mut lamp = OwnedMesh::default();
    let [a, b, c, d] =
        [(-0.25, -0.2), (0.25, -0.2), (0.25, 0.2), (-0.25, 0.2)].map(|(x, z)| Vec3::new(x, 0.98, z));
    lamp.push([a, b, c]);
    lamp.push([a, c, d]);
    let tall = block(Vec3::new(-0.33, -0.4, -0.3), Vec3::new(0.3, 0.6, 0.3), 0.3);
    let short = block(Vec3::new(0.33, -0.7, 0.3), Vec3::new(0.3, 0.3, 0.3), -0.3);
    vec![closed_box(1), tall, short, lamp]
}

/// A closed surface of about `count` triangles and radius about 0.8 with bumps of many sizes, as scans have.
fn bumpy_sphere(count: usize) -> OwnedMesh {
    let squares = ((count as f64 / 12.0).sqrt().round() as u32).max(1);
    closed_box(squares).transformed(|p| {
        let d = p.normalize();
        0.8 * d * (1.0 + bumps(2.0 * d))
    })
}

/// Sines of seven octaves.
fn bumps(p: Vec3) -> f32 {
    let (mut height, mut frequency, mut amplitude) = (0.0, 1.7, 0.15);
    for octave in 0..7 {
        let q = p * frequency + Vec3::splat(1.3 * octave as f32);
        height += amplitude * (q.x.sin() * q.y.cos() + q.y.sin() * q.z.cos() + q.z.sin() * q.x.cos());
        frequency *= 2.13;
        amplitude *= 0.48;
    }
    height
}

/// Turned about y, half to one and a half times as large, in a square of half width `extent`.
fn scattered_placements(count: usize, extent: f32) -> Vec<DAffine3> {
    let mut random = Random(5);
    let mut place = || {
        let turn = DQuat::from_rotation_y(f64::from(random.unit()) * std::f64::consts::TAU);
        let size = DVec3::splat(0.5 + f64::from(random.unit()));
        let at = random.cube() * Vec3::new(extent, 0.0, extent);
        DAffine3::from_scale_rotation_translation(size, turn, at.as_dvec3())
    };
    (0..count).map(|_| place()).collect()
}
