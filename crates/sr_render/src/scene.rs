//! The compiled scene: flat arrays and ids, read-only while rendering.
//!
//! In: a validated [`SceneDesc`]. Out: [`Scene`]. Nothing flows back.

use std::sync::Arc;

use sr_geometry::{
    BilinearPatch, CurveBasis, CurveUv, Curves, Cylinder, Disk, Geometry, GeometryError, GeometryInput, Hit,
    Instance, Ray, Shape, ShapeId, Sphere, Surface, TriangleMesh,
};
use sr_scene::{CameraDesc, CurvesDesc, Emission, MaterialId, MeshDesc, SceneDesc, Settings, ShapeDesc};
use thiserror::Error;

use crate::light::{AreaLight, Compiled, Extended, LightId, Lights, Triangle, compile_light};
use crate::material::{MaterialError, Materials};
use crate::texture::{FurtherUvs, MeshColors, RayCone, TexturePoint, Textures, footprint};

/// Why a description does not compile.
#[derive(Debug, Error)]
pub enum CompileError {
    /// Geometry that cannot be intersected.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// Materials that cannot be nested.
    #[error(transparent)]
    Material(#[from] MaterialError),
}

/// A scene, ready to be walked.
#[derive(Debug)]
pub struct Scene {
    pub(crate) camera: CameraDesc,
    settings: Settings,
    pub(crate) geometry: Geometry,
    /// Per shape: material and light.
    shapes: Vec<ShapeRecord>,
    pub(crate) materials: Materials,
    material_count: usize,
    pub(crate) textures: Textures,
    mesh_colors: MeshColors,
    further_uvs: FurtherUvs,
    /// Do textures depend on more than the first texture coordinates?
    completes_points: bool,
    texture_count: usize,
    pub(crate) lights: Lights,
}

/// What the integrator asks of a shape.
#[derive(Clone, Copy, Debug)]
struct ShapeRecord {
    material: MaterialId,
    light: Option<LightId>,
}

impl Scene {
    /// Compiles a description that [`sr_scene`] has validated. Builds on rayon's current pool.
    ///
    /// # Errors
    /// If the geometry is broken or materials nest in a way that is not supported.
    pub fn compile(desc: &SceneDesc) -> Result<Self, CompileError> {
        let groups: Vec<Vec<Shape>> =
            desc.groups.iter().map(|g| g.shapes.iter().map(input_shape).collect()).collect();
        let instances = desc
            .instances
            .iter()
            .map(|i| Instance { group: i.group, world_from_group: i.world_from_group })
            .collect();
        let input =
            GeometryInput { shapes: desc.shapes.iter().map(input_shape).collect(), groups, instances };
        let geometry = Geometry::build(input)?;
        let textures = Textures::new(&desc.textures, &desc.images);
        let materials = Materials::new(&desc.materials)?;
        let (lights, light_of_shape) = compile_lights(desc, &geometry, &textures)?;
        let world = desc.shapes.iter().zip(light_of_shape);
        let grouped = desc.groups.iter().flat_map(|g| &g.shapes).map(|shape| (shape, None));
        let shapes = world
            .chain(grouped)
            .map(|(shape, light)| ShapeRecord { material: shape.material, light })
            .collect();
        let (mesh_colors, further_uvs) = (MeshColors::new(desc), FurtherUvs::new(desc));
        Ok(Self {
            camera: desc.camera.clone(),
            settings: desc.settings.clone(),
            geometry,
            shapes,
            materials,
            material_count: desc.materials.len(),
            completes_points: textures.has_mipmaps() || !mesh_colors.is_empty() || !further_uvs.is_empty(),
            textures,
            mesh_colors,
            further_uvs,
            texture_count: desc.textures.len(),
            lights,
        })
    }

    /// What the scene file asks of the renderer.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The camera and the film's default size.
    pub fn camera(&self) -> &CameraDesc {
        &self.camera
    }

    /// The shapes.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The lights.
    pub fn lights(&self) -> &Lights {
        &self.lights
    }

    /// The textures.
    pub fn textures(&self) -> &Textures {
        &self.textures
    }

    /// How many materials there are.
    pub fn material_count(&self) -> usize {
        self.material_count
    }

    /// How many textures there are.
    pub fn texture_count(&self) -> usize {
        self.texture_count
    }

    /// Bytes of geometry and textures.
    pub fn memory_bytes(&self) -> usize {
        self.geometry.memory_bytes()
            + self.textures.memory_bytes()
            + self.mesh_colors.memory_bytes()
            + self.further_uvs.memory_bytes()
    }

    /// Where textures are looked up at a hit of a ray.
    #[inline(always)]
    pub(crate) fn texture_point(&self, ray: &Ray, hit: &Hit, cone: RayCone) -> TexturePoint {
        let mut at = self.geometry.uv(ray, hit).into();
        if self.completes_points {
            self.complete(&mut at, ray, hit, cone);
        }
        at
    }

    /// What few scenes' textures depend on.
    #[inline(never)]
    fn complete(&self, at: &mut TexturePoint, ray: &Ray, hit: &Hit, cone: RayCone) {
        if self.textures.has_mipmaps() && cone.width >= 0.0 {
            at.footprint = footprint(&self.geometry, ray, hit, cone.at(hit.t));
        }
        if !self.mesh_colors.is_empty() {
            [at.vertex_color, at.face_color] = self.mesh_colors.at(&self.geometry, hit);
        }
        if !self.further_uvs.is_empty() {
            at.further_uvs = self.further_uvs.at(&self.geometry, hit, at.uv);
        }
    }

    /// The surface of an emitter, with the texture coordinates that its emission is looked up at.
    #[inline]
    pub(crate) fn emitter(&self, surface: Surface, light: LightId, hit: &Hit) -> Surface {
        if self.further_uvs.is_empty() {
            return surface;
        }
        let Some(set) = self.lights.other_set(light, &self.textures) else { return surface };
        let mut at = TexturePoint::from(surface.uv);
        at.further_uvs = self.further_uvs.at(&self.geometry, hit, at.uv);
        Surface { uv: at.at_set(set).uv, ..surface }
    }

    #[inline]
    pub(crate) fn material_of(&self, ShapeId(shape): ShapeId) -> MaterialId {
        self.shapes[shape as usize].material
    }

    #[inline]
    pub(crate) fn light_of(&self, ShapeId(shape): ShapeId) -> Option<LightId> {
        self.shapes[shape as usize].light
    }
}

fn input_shape(shape: &ShapeDesc) -> Shape<'_> {
    match &shape.geometry {
        sr_scene::Geometry::Mesh(mesh) => Shape::Mesh(input_mesh(mesh)),
        &sr_scene::Geometry::Sphere { center, radius, frame, flip_normals } => {
            Shape::Sphere(Sphere { center, radius, frame, flip_normals })
        }
        &sr_scene::Geometry::Disk { center, u_axis, v_axis, flip_normals } => {
            Shape::Disk(Disk { center, u_axis, v_axis, flip_normals })
        }
        &sr_scene::Geometry::Cylinder { base, frame, radius, length, flip_normals } => {
            Shape::Cylinder(Cylinder { base, frame, radius, length, flip_normals })
        }
        &sr_scene::Geometry::Patch { corners, flip_normals } => {
            Shape::Patch(BilinearPatch { corners, flip_normals })
        }
        sr_scene::Geometry::Curves(curves) => Shape::Curves(input_curves(curves)),
    }
}

fn input_curves(curves: &CurvesDesc) -> Curves<'_> {
    let basis = match curves.basis {
        sr_scene::CurveBasis::Linear => CurveBasis::Linear,
        sr_scene::CurveBasis::BSpline => CurveBasis::BSpline,
        sr_scene::CurveBasis::Bezier => CurveBasis::Bezier,
    };
    let uv = match curves.uv {
        sr_scene::CurveUv::AroundAlong => CurveUv::AroundAlong,
        sr_scene::CurveUv::AlongAround => CurveUv::AlongAround,
    };
    Curves { basis, uv, points: &curves.points, firsts: &curves.firsts }
}

fn input_mesh(mesh: &Arc<MeshDesc>) -> TriangleMesh<'_> {
    TriangleMesh {
        positions: &mesh.positions,
        normals: &mesh.normals,
        uvs: &mesh.uvs,
        triangles: &mesh.triangles,
    }
}

/// The lights, and which of them each world shape is.
fn compile_lights(
    desc: &SceneDesc,
    geometry: &Geometry,
    textures: &Textures,
) -> Result<(Lights, Vec<Option<LightId>>), GeometryError> {
    let (mut extended, mut deltas, mut emitters) = (Vec::new(), Vec::new(), Vec::new());
    let mut light_of_emitter = Vec::new();
    let mut light_of_shape = vec![None; desc.shapes.len()];
    for (index, shape) in desc.shapes.iter().enumerate() {
        let Some(emission) = shape.emission else { continue };
        let Some(light) = area_light(geometry, ShapeId(index as u32), shape, emission, textures) else {
            continue;
        };
        let id = LightId(extended.len() as u32);
        extended.push(Extended::Area(light));
        light_of_shape[index] = Some(id);
        light_of_emitter.push(id);
        emitters.push(input_shape(shape));
    }
    for light in &desc.lights {
        match compile_light(light, desc) {
            Compiled::Extended(light) => extended.push(light),
            Compiled::Delta(light) => deltas.push(light),
        }
    }
    let emitters = Geometry::build(GeometryInput { shapes: emitters, ..GeometryInput::default() })?;
    let bounds = geometry.bounds();
    let radius = if bounds.is_empty() { 1.0 } else { 0.5 * (bounds.max - bounds.min).length() };
    Ok((Lights::new(extended, deltas, emitters, light_of_emitter, radius, textures), light_of_shape))
}

/// The area light of a shape; `None` if it has no area.
fn area_light(
    geometry: &Geometry,
    id: ShapeId,
    shape: &ShapeDesc,
    emission: Emission,
    textures: &Textures,
) -> Option<AreaLight> {
    match &shape.geometry {
        sr_scene::Geometry::Mesh(mesh) => {
            let further = textures
                .other_set(emission.radiance)
                .and_then(|set| mesh.further_uvs.get(usize::from(set) - 1));
            let set = further.filter(|set| !set.is_empty()).unwrap_or(&mesh.uvs);
            let corners = (0..mesh.triangles.len() as u32).map(|primitive| {
                let positions = geometry.triangle_vertices(id, primitive);
                let of = mesh.triangles[primitive as usize].map(|i| i as usize);
                let uvs = if set.is_empty() {
                    [glam::Vec2::ZERO, glam::Vec2::X, glam::Vec2::Y]
                } else {
                    of.map(|i| set[i])
                };
                Triangle::new(positions, uvs)
            });
            AreaLight::mesh(corners.collect(), emission.radiance, textures)
        }
        &sr_scene::Geometry::Sphere { center, radius, frame, flip_normals } => {
            Some(AreaLight::sphere(center, radius, frame, flip_normals, emission.radiance, textures))
        }
        &sr_scene::Geometry::Disk { center, u_axis, v_axis, flip_normals } => {
            let facing = u_axis.as_dvec3().cross(v_axis.as_dvec3()).normalize_or_zero().as_vec3();
            let normal = if flip_normals { -facing } else { facing };
            Some(AreaLight::disk(center, u_axis, v_axis, normal, emission.radiance, textures))
        }
        &sr_scene::Geometry::Cylinder { base, frame, radius, length, flip_normals } => {
            let sides = Cylinder { base, frame, radius, length, flip_normals };
            Some(AreaLight::cylinder(sides, emission.radiance, textures))
        }
        // Refused when the scene was validated.
        sr_scene::Geometry::Patch { .. } | sr_scene::Geometry::Curves(_) => None,
    }
}
