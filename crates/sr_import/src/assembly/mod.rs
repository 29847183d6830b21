//! A scene description as it grows, whatever the format it is read from.
//!
//! In: cameras, materials, textures, lights and shapes, one by one, with the files that they name. Out: a
//! [`SceneDesc`], if nothing was an error. Files are read at the end, in parallel, each once.
//!
//! - `images`, `meshes`: what is read at the end.
//! - `camera`, `light`: what a scene without a camera is seen by, and one without lights is lit by.

mod camera;
mod images;
mod light;
mod meshes;

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use sr_scene::{
    CameraDesc, ColorInput, CurvesDesc, Diagnostic, Diagnostics, Geometry, GroupDesc, Image, InstanceDesc,
    LightDesc, MaterialDesc, MaterialId, SceneDesc, Settings, ShapeDesc, Span, TextureDesc, TextureId,
};

use crate::files;
use crate::images::Decode;
use crate::limits::Limits;
use crate::mesh::Placement;

pub use camera::{FRONT_ABOVE, default_film};
use images::ImageSlot;
pub use meshes::MeshSource;
use meshes::{PendingMesh, ShapeSlot};

/// The description as it grows.
pub struct Assembly<'d> {
    /// What there is to say.
    pub d: &'d mut Diagnostics,
    /// Where files are looked for, in this order.
    pub directories: Vec<PathBuf>,
    /// Where the image is taken from.
    pub camera: Option<CameraDesc>,
    /// Where from a scene without a camera is seen, from its middle.
    pub view_from: DVec3,
    /// What the file asks the renderer for.
    pub settings: Settings,
    /// Groups of shapes; meshes are added by [`Assembly::add_shape_to_group`].
    pub groups: Vec<GroupDesc>,
    /// Placements of groups.
    pub instances: Vec<InstanceDesc>,
    /// Lights that are not shapes.
    pub lights: Vec<LightDesc>,
    /// Names of the sets of materials that the file has.
    pub variants: Vec<String>,
    /// An image of latitude and longitude, +Y up, that the scene does not name and is lit by.
    pub environment: Option<PathBuf>,
    /// How much is taken in.
    pub limits: Limits,
    images: Vec<ImageSlot>,
    image_files: HashMap<(PathBuf, Decode), u32>,
    textures: Vec<TextureDesc>,
    materials: Vec<MaterialDesc>,
    material_spans: Vec<Span>,
    shapes: Vec<ShapeDesc>,
    meshes: Vec<PendingMesh>,
}

impl<'d> Assembly<'d> {
    /// An empty scene; files are looked for in `directories`.
    pub fn new(directories: Vec<PathBuf>, limits: Limits, d: &'d mut Diagnostics) -> Self {
        Self {
            d,
            directories,
            camera: None,
            view_from: DVec3::Z,
            settings: Settings::default(),
            groups: Vec::new(),
            instances: Vec::new(),
            lights: Vec::new(),
            variants: Vec::new(),
            environment: None,
            limits,
            images: Vec::new(),
            image_files: HashMap::new(),
            textures: Vec::new(),
            materials: Vec::new(),
            material_spans: Vec::new(),
            shapes: Vec::new(),
            meshes: Vec::new(),
        }
    }

    /// Where a file is that the scene names.
    pub fn find(&self, name: &str) -> PathBuf {
        files::find(name, &self.directories)
    }

    /// An image that is there already; its index.
    pub fn image_in_memory(&mut self, image: &Arc<Image>) -> u32 {
        self.images.push(ImageSlot::Ready(image.clone()));
        self.images.len() as u32 - 1
    }

    /// An image that is there already.
    pub fn image(&self, index: u32) -> Option<&Arc<Image>> {
        match self.images.get(index as usize)? {
            ImageSlot::Ready(image) => Some(image),
            ImageSlot::File { .. } => None,
        }
    }

    /// An image to be read; its index. The same file, decoded alike, is the same image.
    pub fn image_file(&mut self, name: &str, decode: Decode, span: &Span) -> u32 {
        let path = self.find(name);
        *self.image_files.entry((path, decode)).or_insert_with_key(|(path, decode)| {
            self.images.push(ImageSlot::File { path: path.clone(), decode: *decode, span: span.clone() });
            self.images.len() as u32 - 1
        })
    }

    /// A texture, and how to use it.
    pub fn add_texture(&mut self, texture: TextureDesc) -> ColorInput {
        self.textures.push(texture);
        ColorInput::Texture(TextureId(self.textures.len() as u32 - 1))
    }

    /// A material, described at `span`.
    pub fn add_material(&mut self, desc: MaterialDesc, span: &Span) -> MaterialId {
        self.materials.push(desc);
        self.material_spans.push(span.clone());
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// Makes a material the same as another one.
    pub fn copy_material(&mut self, from: MaterialId, to: MaterialId) {
        self.materials[to.0 as usize] = self.materials[from.0 as usize].clone();
        self.material_spans[to.0 as usize] = self.material_spans[from.0 as usize].clone();
    }

    /// A shape of the scene itself. With a `mesh`, its geometry is read and placed at the end.
    pub fn add_shape(&mut self, shape: ShapeDesc, mesh: Option<(MeshSource, Placement)>) {
        self.add_pending(mesh, ShapeSlot::Scene(self.shapes.len()), &shape.span);
        self.shapes.push(shape);
    }

    /// A shape of `self.groups[group]`.
    pub fn add_shape_to_group(
        &mut self,
        group: usize,
        shape: ShapeDesc,
        mesh: Option<(MeshSource, Placement)>,
    ) {
        self.add_pending(mesh, ShapeSlot::Group(group, self.groups[group].shapes.len()), &shape.span);
        self.groups[group].shapes.push(shape);
    }

    /// Adds curves to the last shape of the scene or of a group, if that is curves of this kind and material, or else as
    /// a shape.
    pub fn add_curve(&mut self, group: Option<usize>, curves: CurvesDesc, material: MaterialId, span: &Span) {
        let shapes = match group {
            Some(group) => &mut self.groups[group].shapes,
            None => &mut self.shapes,
        };
        if let Some(ShapeDesc { geometry: Geometry::Curves(last), material: same, .. }) = shapes.last_mut()
            && *same == material
            && (last.basis, last.uv) == (curves.basis, curves.uv)
        {
            let last = Arc::make_mut(last);
            let first = last.points.len() as u32;
            last.points.extend(curves.points);
            last.firsts.extend(curves.firsts.iter().map(|at| first + at));
            return;
        }
        let geometry = Geometry::Curves(Arc::new(curves));
        shapes.push(ShapeDesc { geometry, material, emission: None, span: span.clone() });
    }

    fn add_pending(&mut self, mesh: Option<(MeshSource, Placement)>, shape: ShapeSlot, span: &Span) {
        if let Some((source, placement)) = mesh {
            self.meshes.push(PendingMesh { shape, source, placement, span: span.clone() });
        }
    }

    /// Reads what is still to be read, and validates. `span` is the scene's own.
    pub fn finish(mut self, span: &Span) -> Option<SceneDesc> {
        self.load_meshes(span);
        self.surround(span);
        let images = self.load_images();
        let camera = match self.camera.take() {
            Some(camera) => camera,
            None => {
                self.d.push(
                    Diagnostic::warning("scene::no-camera", span, "the scene has no camera")
                        .consequence(format!("a camera that sees the whole scene {} is used", self.view())),
                );
                self.default_camera(span)
            }
        };
        let scene = SceneDesc {
            camera,
            settings: self.settings,
            images,
            textures: self.textures,
            materials: self.materials,
            material_spans: self.material_spans,
            shapes: self.shapes,
            groups: self.groups,
            instances: self.instances,
            lights: self.lights,
            variants: self.variants,
        };
        if self.d.has_errors() {
            return None;
        }
        let found = sr_scene::validate(&scene);
        self.d.list.extend(found);
        (!self.d.has_errors()).then_some(scene)
    }
}
