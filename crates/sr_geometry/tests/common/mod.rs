//! What the tests share: random numbers, meshes, and an intersection by brute force in `f64`.

#![allow(dead_code, reason = "each test uses a part")]

use glam::{DVec3, Vec3};
use sr_geometry::{
    BATCH, Geometry, GeometryInput, Hit, Hits, Ray, Rays, Shape, ShapeId, ShapeRef, TriangleMesh,
};

/// Uniform numbers by SplitMix64 (Steele, Lea & Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1u32 << 24) as f32
    }

    /// In [-1, 1)³.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    /// On the unit sphere.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.cube();
            if (1e-4..=1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
}

/// A mesh that owns its arrays.
#[derive(Clone, Default)]
pub struct OwnedMesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl OwnedMesh {
    pub fn shape(&self) -> Shape<'_> {
        Shape::Mesh(TriangleMesh {
            positions: &self.positions,
            triangles: &self.triangles,
            ..Default::default()
        })
    }

    pub fn build(&self) -> Geometry {
        Geometry::build(GeometryInput { shapes: vec![self.shape()], ..Default::default() }).unwrap()
    }

    pub fn push(&mut self, triangle: [Vec3; 3]) {
        let first = self.positions.len() as u32;
        self.positions.extend(triangle);
        self.triangles.push([first, first + 1, first + 2]);
    }

    pub fn transformed(&self, f: impl Fn(Vec3) -> Vec3) -> Self {
        Self { positions: self.positions.iter().map(|&p| f(p)).collect(), triangles: self.triangles.clone() }
    }
}

/// Random triangles of edge length about `size` in the cube [-1, 1]³.
pub fn soup(random: &mut Random, count: usize, size: f32) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    for _ in 0..count {
        let at = random.cube();
        mesh.push([at, at + size * random.cube(), at + size * random.cube()]);
    }
    mesh
}

/// The cube [-1, 1]³, each face of n × n quads that share their vertices, normals outwards.
pub fn closed_box(n: u32) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    let mut known = std::collections::HashMap::new();
    for axis in 0..3 {
        for side in [-1.0f32, 1.0] {
            let mut vertex = |i: u32, j: u32| {
                let at = |k: u32| 2.0 * k as f32 / n as f32 - 1.0;
                let mut p = Vec3::ZERO;
                p[axis] = side;
                p[(axis + 1) % 3] = at(i);
                p[(axis + 2) % 3] = at(j);
                *known.entry(p.to_array().map(f32::to_bits)).or_insert_with(|| {
                    mesh.positions.push(p);
                    mesh.positions.len() as u32 - 1
                })
            };
            let mut quads = Vec::new();
            for i in 0..n {
                for j in 0..n {
                    quads.push([vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
            for [a, b, c, d] in quads {
                let outwards = [[a, b, c], [a, c, d]];
                mesh.triangles.extend(if side > 0.0 {
                    outwards
                } else {
                    outwards.map(|[a, b, c]| [a, c, b])
                });
            }
        }
    }
    mesh
}

/// The closest hits, and whether there are any, of up to [`BATCH`] rays at a time.
pub fn meet_batch(geometry: &Geometry, rays: &[Ray]) -> Vec<(Option<Hit>, bool)> {
    let (mut batch, mut hits, mut occluded) = (Rays::NONE, Hits::NONE, [false; BATCH]);
    for (i, ray) in rays.iter().enumerate() {
        batch.set(i, ray);
    }
    geometry.intersect_batch(&batch, rays.len(), &mut hits);
    geometry.occluded_batch(&batch, rays.len(), &mut occluded);
    (0..rays.len()).map(|i| (hits.get(i), occluded[i])).collect()
}

/// The closest hit of a ray, and whether there is any: by itself, and as one of a batch.
pub fn meet_both(geometry: &Geometry, ray: &Ray) -> [(Option<Hit>, bool); 2] {
    [(geometry.intersect(ray), geometry.occluded(ray)), meet_batch(geometry, &[*ray])[0]]
}

/// t and barycentric coordinates of the line's meeting with the triangle's plane, in `f64`.
fn meet_plane(ray: &Ray, vertices: [Vec3; 3]) -> Option<(f64, [f64; 3])> {
    let [a, b, c] = vertices.map(|v| v.as_dvec3() - ray.origin.as_dvec3());
    let d = ray.direction.as_dvec3();
    let n = (b - a).cross(c - a);
    let area = n.dot(d);
    let of = |p: DVec3, q: DVec3| p.cross(q).dot(d) / area;
    (area != 0.0).then(|| (n.dot(a) / area, [of(b, c), of(c, a), of(a, b)]))
}

/// Panics unless `hit` is right for meshes: near a true hit, and nothing clearly hit is closer. `slack`: relative.
pub fn check_against_brute_force(geometry: &Geometry, ray: &Ray, hit: Option<Hit>, slack: f64) {
    let mut far = f64::from(ray.t_max);
    if let Some(hit) = hit {
        let (t, b) = meet_plane(ray, geometry.triangle_vertices(hit.shape, hit.primitive))
            .expect("hit an edge-on triangle");
        assert!(b.iter().all(|&b| b > -slack), "{ray:?} {hit:?}: outside the triangle, {b:?}");
        assert!((t - f64::from(hit.t)).abs() <= slack * t.abs().max(1.0), "{ray:?} {hit:?}: t should be {t}");
        far = f64::from(hit.t);
    }
    for shape in (0..geometry.shape_count()).map(ShapeId) {
        if !matches!(geometry.shape_of(shape), ShapeRef::Mesh) {
            continue;
        }
        for triangle in 0..geometry.primitive_count(shape) {
            let Some((t, b)) = meet_plane(ray, geometry.triangle_vertices(shape, triangle)) else { continue };
            let clearly = b.iter().all(|&b| b > slack) && t > slack && t < far - slack * far.abs().max(1.0);
            assert!(!clearly, "{ray:?} {hit:?}: missed {triangle} of {shape:?} at {t}, {b:?}");
        }
    }
}
