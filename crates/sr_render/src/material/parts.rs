//! What no loop serves: several models in one place, frames within frames, holes in holes, uncommon models.
//!
//! In: a side's [`PartSource`]s, and the [`Place`] of a hit. Out: an [`AnyBsdf`] by value. Nothing is allocated per hit.

use std::ops::Range;

use glam::Vec3;
use sr_bsdf::{AnyBsdf, AnyModel, Blend, Part, Step, Tilt};
use sr_scene::{ColorInput, Rgb, ScalarInput, TextureId, Tilting};

use super::uncommon::Uncommon;
use super::{MakeAny, Materials, Room, Side, Sources};
use crate::texture::{TexturePoint, Textures};

/// Where a model is made: what its inputs and frames depend on.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub textures: &'a Textures,
    /// Where the textures are looked up.
    pub at: TexturePoint,
    /// Towards the viewer, in the surface's frame.
    pub wo: Vec3,
    /// ∂p/∂u and ∂p/∂v in that frame, if the side asks for them.
    pub tangents: [Vec3; 2],
}

/// One model of a side.
#[derive(Clone, Debug)]
pub(super) struct PartSource {
    /// Into [`Parts::factors`]: their product is the part's share of the surface.
    pub factors: Range<usize>,
    /// Into [`Parts::steps`]: from the surface's frame to the model's, outermost first.
    pub steps: Range<usize>,
    pub model: ModelSource,
}

/// What a model is made from.
#[derive(Clone, Copy, Debug)]
pub(super) enum ModelSource {
    /// Of a kind that may also have a loop of its own.
    Common {
        kind: u32,
        sources: Sources,
    },
    Uncommon(Uncommon),
}

/// A factor of a share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factor {
    pub weight: ScalarInput,
    /// Is it 1 − weight?
    pub is_rest: bool,
}

/// What leads from a frame into one inside it.
#[derive(Clone, Copy, Debug)]
pub(super) enum StepSource {
    Mirror,
    Tilt(TiltSource),
}

/// A tilt of the shading normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct TiltSource {
    pub normal: NormalSource,
    pub tilting: Tilting,
    /// Is it inside a mirror that was outside it? Then the normal tilts the other way.
    pub is_mirrored: bool,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum NormalSource {
    /// That of a surface displaced along its normal (Blinn 1978).
    Bump { scale: f32, texture: TextureId },
    /// (n + 1) / 2.
    Map(ColorInput),
}

/// The parts of all sides.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub parts: Vec<PartSource>,
    pub factors: Vec<Factor>,
    pub steps: Vec<StepSource>,
}

impl Place<'_> {
    pub fn color(&self, input: ColorInput) -> Rgb {
        self.textures.color(input, self.at)
    }

    pub fn scalar(&self, input: ScalarInput) -> f32 {
        self.textures.scalar(input, self.at)
    }
}

impl Factor {
    fn value(&self, place: &Place) -> f32 {
        // NaN, which a texture may hold, is 0.
        let weight = place.scalar(self.weight).clamp(0.0, 1.0).max(0.0);
        if self.is_rest { 1.0 - weight } else { weight }
    }
}

impl TiltSource {
    fn tilt(&self, place: &Place) -> Tilt {
        let normal = match self.normal {
            NormalSource::Bump { scale, texture } => {
                let slope = scale * place.textures.gradient(texture, place.at);
                let [u, v] = place.tangents;
                let normal = u.with_z(slope.x).cross(v.with_z(slope.y));
                if normal.z < 0.0 { -normal } else { normal }
            }
            NormalSource::Map(color) => {
                let normal = 2.0 * place.color(color) - Vec3::ONE;
                let is_turned = self.tilting.along_v && place.tangents[1].y < 0.0;
                if is_turned { Vec3::new(normal.x, -normal.y, normal.z) } else { normal }
            }
        };
        let turned = |n: Vec3| Vec3::new(-n.x, -n.y, n.z);
        let normal = if self.is_mirrored { turned(normal) } else { normal };
        // A normal that faces away from the viewer is turned about the untilted one (Schüßler et al. 2017).
        let is_invalid = self.tilting.flip_invalid_normals && place.wo.z * place.wo.dot(normal) <= 0.0;
        let tilt = Tilt::about(if is_invalid { turned(normal) } else { normal });
        if self.tilting.shadows { tilt.with_shadows() } else { tilt }
    }
}

impl StepSource {
    /// The step, after which the place is seen from inside.
    fn step(&self, place: &mut Place) -> Step {
        let step = match self {
            StepSource::Mirror => Step::Mirror,
            StepSource::Tilt(source) => Step::Tilt(source.tilt(place)),
        };
        place.wo = step.inward(place.wo);
        place.tangents = place.tangents.map(|t| step.inward(t));
        step
    }
}

impl Materials {
    /// The models of a side that has parts.
    #[inline(never)]
    pub(super) fn blend<'a>(&'a self, side: &Side, place: &Place, room: &'a mut Room<'a>) -> AnyBsdf<'a> {
        let Parts { parts, factors, steps } = &self.parts;
        let parts = &parts[side.parts.clone()];
        if let [only] = parts
            && only.factors.is_empty()
            && only.steps.is_empty()
        {
            return AnyBsdf::Solid(self.model(&only.model, place));
        }
        let part = |part: &PartSource| {
            let share = factors[part.factors.clone()].iter().map(|factor| factor.value(place)).product();
            let mut inside = *place;
            let steps = steps[part.steps.clone()].iter().map(|step| step.step(&mut inside));
            Part::new(share, steps, self.model(&part.model, place))
        };
        AnyBsdf::Blended(room.insert(Blend::new(parts.iter().map(part), side.has_holes)))
    }

    fn model(&self, source: &ModelSource, place: &Place) -> AnyModel<'_> {
        match source {
            ModelSource::Common { kind, sources } => {
                let inputs = sources.look_up(&place.at, place.textures);
                self.with_recipe(*kind, MakeAny { inputs })
            }
            ModelSource::Uncommon(uncommon) => uncommon.model(place, &self.tables),
        }
    }
}
