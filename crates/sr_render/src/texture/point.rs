//! Where a texture is looked up: texture coordinates, and what else a lookup may depend on.
//!
//! In: a ray, its hit, and how wide the ray is there. Out: a [`TexturePoint`].

use glam::{Vec2, Vec3};
use sr_geometry::{Geometry, Hit, Ray, ShapeId};
use sr_scene::{Geometry as Form, MAX_UV_SETS, Rgb, SceneDesc, TextureDesc};

/// A point of a surface, as textures see it.
#[derive(Clone, Copy, Debug)]
pub struct TexturePoint {
    /// Texture coordinates.
    pub uv: Vec2,
    /// About how wide the surface is, in (u, v), that is seen through a pixel; 0 if that does not matter.
    pub footprint: f32,
    /// The mesh's colour there, if it has colours at its vertices.
    pub vertex_color: Rgb,
    /// The mesh's colour there, if it has colours of faces.
    pub face_color: Rgb,
    /// The mesh's further sets of texture coordinates there; `uv` for those that it does not have.
    pub further_uvs: [Vec2; 3],
}

/// How many sets of texture coordinates there are besides the first.
const FURTHER_SETS: usize = 3;
const _: () = assert!(FURTHER_SETS + 1 == MAX_UV_SETS as usize);

impl TexturePoint {
    /// Texture coordinates 0, and nothing else.
    pub const ORIGIN: Self = Self {
        uv: Vec2::ZERO,
        footprint: 0.0,
        vertex_color: NO_COLOR,
        face_color: NO_COLOR,
        further_uvs: [Vec2::ZERO; FURTHER_SETS],
    };

    /// The same point with another set's coordinates for the first.
    #[inline]
    pub fn at_set(self, set: u8) -> Self {
        let uv = usize::from(set).checked_sub(1).and_then(|at| self.further_uvs.get(at));
        Self { uv: uv.copied().unwrap_or(self.uv), ..self }
    }
}

/// What is shown where a mesh has no colours.
const NO_COLOR: Rgb = Rgb::splat(0.5);

impl From<Vec2> for TexturePoint {
    #[inline(always)]
    fn from(uv: Vec2) -> Self {
        Self { uv, further_uvs: [uv; FURTHER_SETS], ..Self::ORIGIN }
    }
}

/// How wide a ray is: the width of a pixel, along paths that only mirrors and panes have bent
/// (Akenine-Möller et al. 2021, "Improved shader and texture level of detail using ray cones", without the
/// curvature of mirrors).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCone {
    /// Where the ray starts; negative once light was scattered, when nothing is known.
    pub width: f32,
    /// Growth with the distance.
    pub spread: f32,
}

impl RayCone {
    /// A ray without a width.
    pub const LINE: Self = Self { width: 0.0, spread: 0.0 };

    /// The ray that goes on from a distance: along a delta lobe, or after light was scattered.
    #[inline(always)]
    pub fn after(self, distance: f32, is_delta: bool) -> Self {
        let known = is_delta && self.width >= 0.0;
        Self { width: if known { self.at(distance) } else { -1.0 }, ..self }
    }

    /// The width at a distance.
    #[inline(always)]
    pub fn at(self, distance: f32) -> f32 {
        self.width + self.spread * distance
    }
}

/// The footprint in (u, v) of a ray of some width at what it hits; 0 if there is none.
pub(crate) fn footprint(geometry: &Geometry, ray: &Ray, hit: &Hit, width: f32) -> f32 {
    let surface = geometry.surface(ray, hit);
    let tangents = geometry.tangents(&surface, hit);
    let cos = surface.ng.dot(ray.direction).abs() / ray.direction.length();
    let area_per_uv = tangents.dpdu.cross(tangents.dpdv).length();
    let footprint = width / (cos * area_per_uv.sqrt());
    if footprint > 0.0 { footprint.min(1e9) } else { 0.0 }
}

/// The colours of meshes, if any texture shows them.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshColors {
    /// Per shape, where its colours of vertices and of faces start.
    first: Vec<[Option<u32>; 2]>,
    colors: Vec<Rgb>,
}

impl MeshColors {
    /// Those of all meshes of a scene, in the order of its shapes; none if no texture shows them.
    pub fn new(desc: &SceneDesc) -> Self {
        let mut all = Self::default();
        if !desc.textures.iter().any(|t| matches!(t, TextureDesc::MeshColor { .. })) {
            return all;
        }
        let mut add = |colors: &[Rgb]| {
            let first = all.colors.len() as u32;
            all.colors.extend_from_slice(colors);
            (!colors.is_empty()).then_some(first)
        };
        for shape in desc.shapes.iter().chain(desc.groups.iter().flat_map(|group| &group.shapes)) {
            all.first.push(match &shape.geometry {
                Form::Mesh(mesh) => [add(&mesh.vertex_colors), add(&mesh.face_colors)],
                _ => [None, None],
            });
        }
        all
    }

    /// Are there none?
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    /// Colours of vertices and of the face, at a hit.
    pub fn at(&self, geometry: &Geometry, hit: &Hit) -> [Rgb; 2] {
        let ShapeId(shape) = hit.shape;
        let [vertices, faces] = self.first[shape as usize];
        let of_vertices = vertices.and_then(|first| {
            let indices = geometry.vertex_indices(hit.shape, hit.primitive)?;
            let [a, b, c] = indices.map(|i| self.colors[(first + i) as usize]);
            Some(a * (1.0 - hit.b1 - hit.b2) + b * hit.b1 + c * hit.b2)
        });
        let of_face = faces.map(|first| self.colors[(first + hit.primitive) as usize]);
        // Barycentric coordinates are rounded: no color becomes negative by that.
        [of_vertices.map_or(NO_COLOR, |c| c.max(Vec3::ZERO)), of_face.unwrap_or(NO_COLOR)]
    }

    /// Bytes of the colours.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.first[..]) + size_of_val(&self.colors[..])
    }
}

/// The further sets of texture coordinates of meshes, if any texture is looked up at one.
#[derive(Clone, Debug, Default)]
pub(crate) struct FurtherUvs {
    /// Per shape, where its sets start.
    first: Vec<[Option<u32>; FURTHER_SETS]>,
    uvs: Vec<Vec2>,
}

impl FurtherUvs {
    /// Those of all meshes of a scene, in the order of its shapes; none if no texture is looked up at them.
    pub fn new(desc: &SceneDesc) -> Self {
        let mut all = Self::default();
        if !desc.textures.iter().any(|t| matches!(t, TextureDesc::OtherUvs { .. })) {
            return all;
        }
        for shape in desc.shapes.iter().chain(desc.groups.iter().flat_map(|group| &group.shapes)) {
            let sets = match &shape.geometry {
                Form::Mesh(mesh) => &mesh.further_uvs[..],
                _ => &[],
            };
            let mut first = [None; FURTHER_SETS];
            for (first, set) in first.iter_mut().zip(sets).filter(|(_, set)| !set.is_empty()) {
                *first = Some(all.uvs.len() as u32);
                all.uvs.extend_from_slice(set);
            }
            all.first.push(first);
        }
        all
    }

    /// Are there none?
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    /// Of each set the coordinates at a hit; `uv` of those that the shape does not have.
    pub fn at(&self, geometry: &Geometry, hit: &Hit, uv: Vec2) -> [Vec2; FURTHER_SETS] {
        let ShapeId(shape) = hit.shape;
        self.first[shape as usize].map(|first| {
            let corners = first.and_then(|first| {
                let indices = geometry.vertex_indices(hit.shape, hit.primitive)?;
                Some(indices.map(|i| self.uvs[(first + i) as usize]))
            });
            corners.map_or(uv, |[a, b, c]| a * (1.0 - hit.b1 - hit.b2) + b * hit.b1 + c * hit.b2)
        })
    }

    /// Bytes of the coordinates.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.first[..]) + size_of_val(&self.uvs[..])
    }
}
