//! The whole scene.

use std::sync::Arc;

use crate::{
    CameraDesc, GroupDesc, Image, InstanceDesc, LightDesc, MaterialDesc, ShapeDesc, TextureDesc,
    diagnostic::Span,
};

/// Index into [`SceneDesc::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// Index into [`SceneDesc::textures`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u32);

/// A scene as data. Lengths are in scene units, angles in radians, colours linear RGB.
#[derive(Clone, Debug)]
pub struct SceneDesc {
    /// Where the image is taken from.
    pub camera: CameraDesc,
    /// What the file asks the renderer for; the command line and the API override it.
    pub settings: Settings,
    /// Images that textures and environments refer to; shared, never copied.
    pub images: Vec<Arc<Image>>,
    /// Textures, referred to by [`TextureId`].
    pub textures: Vec<TextureDesc>,
    /// Materials, referred to by [`MaterialId`].
    pub materials: Vec<MaterialDesc>,
    /// Where each material was described; nowhere for those beyond the end.
    pub material_spans: Vec<Span>,
    /// Shapes, each in world space.
    pub shapes: Vec<ShapeDesc>,
    /// Shapes that appear only through instances, in a space of their own.
    pub groups: Vec<GroupDesc>,
    /// Placements of groups.
    pub instances: Vec<InstanceDesc>,
    /// Lights that are not shapes: environment, point, spot, directional.
    pub lights: Vec<LightDesc>,
    /// Names of the sets of materials that the file has, of which one is shown; most files have none.
    pub variants: Vec<String>,
}

impl SceneDesc {
    /// Where a material was described.
    pub fn material_span(&self, id: MaterialId) -> Span {
        self.material_spans.get(id.0 as usize).cloned().unwrap_or_default()
    }
}

/// What a scene file asks of the integrator and the sampler.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Longest path in edges: 1 emitters only, 2 direct light; `None` is unbounded.
    pub max_depth: Option<u32>,
    /// Edges before Russian roulette may end a path; `None` never ends one by roulette.
    pub roulette_depth: Option<u32>,
    /// Samples per pixel.
    pub spp: u32,
    /// Do emitters that the camera sees directly stay black?
    pub hide_emitters: bool,
    /// Where the settings were read.
    pub span: Span,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            max_depth: None,
            roulette_depth: Some(5),
            spp: 64,
            hide_emitters: false,
            span: Span::default(),
        }
    }
}
