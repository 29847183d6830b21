//! Compiled materials: a description's tree, flattened to one or two sides, each a kind of model with its inputs.
//!
//! In: descriptions. Out, per hit: the side that is seen, and an [`AnyBsdf`] by value, its textures looked up; or, for
//! whoever serves many hits at a time, the queue of each, and what `kind` makes of those in it. No ray, no light.
//!
//! There are two tiers. Common kinds (`kind`) have a loop of their own, compiled for each instruction set, and few inputs.
//! Everything else (`parts`: uncommon models, blends, tilted normals, holes in holes) is made and asked one by one.

mod flatten;
mod inputs;
mod kind;
mod model;
mod parts;
mod tables;
mod uncommon;

use std::ops::Range;

use sr_bsdf::{AnyBsdf, AnyModel, Blend, Mask, RoughCoat};
use sr_scene::{MaterialId, Rgb};

use crate::texture::{TexturePoint, Textures};
pub use flatten::MaterialError;
use inputs::Sources;
pub(crate) use inputs::{COLORS, Input, Inputs, SCALARS, Textured};
use kind::Kind;
pub(crate) use kind::{Recipe, RecipeUser};
use parts::Parts;
pub(crate) use parts::Place;
use tables::Tables;

/// All materials of a scene.
#[derive(Clone, Debug)]
pub struct Materials {
    /// Per material: what it is seen from the front, and from behind.
    faces: Vec<[Face; 2]>,
    sides: Vec<Side>,
    kinds: Vec<Kind>,
    coats: Vec<RoughCoat>,
    parts: Parts,
    tables: Tables,
}

/// A material as it is seen from the front or from behind: what is asked of every hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub side: u32,
    pub queue: Queue,
    /// −1 if the normal is turned to the viewer, else 1.
    pub turn: f32,
    /// The reflectance of a side of [`Queue::LAMBERT`], unless a texture has it.
    pub albedo: Rgb,
    /// Has a texture the reflectance of a side of [`Queue::LAMBERT`]?
    pub has_picture: bool,
}

/// One side of a surface: a model of a common kind, perhaps with holes, or parts.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    /// Of a model of a common kind; `None` for parts.
    kind: Option<u32>,
    /// Its inputs, as far as they are the same everywhere.
    pub constant: Inputs,
    /// Those that textures have.
    pub textured: Box<[Textured]>,
    /// Which parts it has, if that is what it has; perhaps none, where all is a hole.
    parts: Range<usize>,
    /// Do the parts leave holes?
    has_holes: bool,
    /// Does a model or a tilt tell the tangent from the bitangent?
    pub needs_tangents: bool,
}

/// Which loop serves a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Queue(pub u32);

impl Queue {
    /// Lambertian, without holes or bumps.
    pub const LAMBERT: Self = Self(0);
    /// One by one: parts, tangents that matter, and kinds beyond [`Queue::COUNT`].
    pub const SINGLE: Self = Self(1);
    /// How many there are at most; those above the first two are a kind each.
    pub const COUNT: usize = 64;

    /// That of a kind.
    fn of_kind(kind: u32) -> Self {
        if kind as usize + 2 < Self::COUNT { Self(kind + 2) } else { Self::SINGLE }
    }

    /// The kind that it serves, if that is one.
    pub fn kind(self) -> Option<u32> {
        self.0.checked_sub(2)
    }
}

/// Where a blend lies while it is asked: it takes some 2 KB, too many to be handed on by value.
pub(crate) type Room<'a> = Option<Blend<'a>>;

impl Materials {
    /// What is seen of a material from the front, or from behind.
    #[inline(always)]
    pub(crate) fn face(&self, MaterialId(material): MaterialId, from_behind: bool) -> Face {
        self.faces[material as usize][usize::from(from_behind)]
    }

    /// A side, by the number in its [`Face`].
    #[inline(always)]
    pub(crate) fn side(&self, side: u32) -> &Side {
        &self.sides[side as usize]
    }

    /// How many queues there are.
    pub(crate) fn queue_count(&self) -> usize {
        (self.kinds.len() + 2).min(Queue::COUNT)
    }

    /// The scattering model of one side; in `room`, if it needs any.
    #[inline]
    pub(crate) fn bsdf<'a>(&'a self, side: &Side, place: &Place, room: &'a mut Room<'a>) -> AnyBsdf<'a> {
        let Some(kind) = side.kind else { return self.blend(side, place, room) };
        let inputs = side.inputs(&place.at, place.textures);
        let model = self.with_recipe(kind, MakeAny { inputs });
        match inputs.opacity {
            1.0 => AnyBsdf::Solid(model),
            opacity => AnyBsdf::Masked(Mask::new(opacity, model)),
        }
    }
}

/// Makes a model, by value.
struct MakeAny {
    inputs: Inputs,
}

impl RecipeUser for MakeAny {
    type Out = AnyModel<'static>;

    #[inline(always)]
    fn call<R: Recipe>(self, recipe: R) -> AnyModel<'static> {
        recipe.model(&self.inputs).into()
    }
}

impl Side {
    /// The colours and numbers of the model at a point.
    pub(crate) fn inputs(&self, at: &TexturePoint, textures: &Textures) -> Inputs {
        let mut inputs = self.constant;
        for &Textured { input, texture } in &self.textured {
            inputs.set(input, textures.lookup(texture, at));
        }
        inputs
    }
}
