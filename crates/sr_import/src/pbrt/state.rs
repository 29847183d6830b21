//! The graphics state: what is in force where a shape, a light or a material is described.

use std::rc::Rc;

use glam::DMat4;
use sr_scene::{MaterialId, SourceId, Span};

use super::light::AreaLight;
use super::syntax::Parameter;
use crate::color_space::ColorSpace;

/// Parameters that `Attribute` sets for all directives of a kind, with where they are.
pub type Inherited = Rc<Vec<(Parameter, SourceId)>>;

/// What `AttributeBegin` keeps.
#[derive(Clone)]
pub struct State {
    /// The current transform: at the first of two times, for what moves.
    pub ctm: DMat4,
    /// At the second one.
    pub end_ctm: DMat4,
    /// Which of the two do transforms change?
    pub active: Active,
    pub reverse_orientation: bool,
    pub material: Option<MaterialId>,
    /// The `AreaLightSource` that shapes get.
    pub area_light: Option<Rc<AreaLight>>,
    pub color_space: ColorSpace,
    pub attributes: Attributes,
}

/// Which transforms are changed: what `ActiveTransform` says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Active {
    Start,
    End,
    All,
}

/// `Attribute` by kind.
#[derive(Clone, Default)]
pub struct Attributes {
    pub shape: Inherited,
    pub light: Inherited,
    pub material: Inherited,
    pub medium: Inherited,
    pub texture: Inherited,
}

impl Default for State {
    fn default() -> Self {
        Self {
            ctm: DMat4::IDENTITY,
            end_ctm: DMat4::IDENTITY,
            active: Active::All,
            reverse_orientation: false,
            material: None,
            area_light: None,
            color_space: ColorSpace::Srgb,
            attributes: Attributes::default(),
        }
    }
}

/// What a `…Begin` put aside.
pub enum Saved {
    /// `AttributeBegin`, where.
    Attribute(Box<State>, Span),
    /// `TransformBegin` of older files.
    Transform(Box<([DMat4; 2], Active)>, Span),
    /// `ObjectBegin`.
    Object(Box<State>, Span),
}
