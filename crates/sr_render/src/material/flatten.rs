//! Descriptions' trees to [`Side`]s.

use sr_bsdf::{MAX_PARTS, MAX_STEPS};
use sr_scene::{ColorInput, MaterialDesc, MaterialId, Rgb, ScalarInput};

use super::kind::Kind;
use super::parts::{Factor, ModelSource, NormalSource, PartSource, Parts, StepSource, TiltSource};
use super::tables::{MAX_TABLES, Orders, Tables};
use super::{Face, Materials, Queue, Side, Sources};

/// More in one material than is done.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MaterialError {
    /// Too many models, or frames within frames.
    #[error("a material has {count} {what}; at most {most} are possible")]
    TooMany {
        /// The material.
        material: MaterialId,
        /// What there is too much of.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there can be.
        most: usize,
    },
    /// Too many that have to be tabulated first.
    #[error(
        "this is one more than {MAX_TABLES} different rough coatings and materials with \"multiscatter\""
    )]
    TooManyTables {
        /// The material.
        material: MaterialId,
    },
}

impl MaterialError {
    /// Which material it is about.
    pub fn material(&self) -> MaterialId {
        match self {
            Self::TooMany { material, .. } | Self::TooManyTables { material } => *material,
        }
    }
}

/// A surface: what it is seen from the front, and from behind if that differs from the front unturned.
#[derive(Clone)]
struct Material {
    /// Used on both sides, with directions as they are, if there is no `back`.
    front: Unfinished,
    back: Option<Unfinished>,
}

/// A side in the making.
#[derive(Clone, Default)]
struct Unfinished {
    parts: Vec<UnfinishedPart>,
    has_holes: bool,
}

/// A model in the making.
#[derive(Clone)]
struct UnfinishedPart {
    factors: Vec<Factor>,
    /// Is it made for the front, but seen from behind?
    is_mirrored: bool,
    /// In the mirror, if there is one; outermost first.
    tilts: Vec<TiltSource>,
    model: ModelSource,
}

impl From<ModelSource> for Material {
    fn from(model: ModelSource) -> Self {
        let part = UnfinishedPart { factors: Vec::new(), is_mirrored: false, tilts: Vec::new(), model };
        Self { front: Unfinished { parts: vec![part], has_holes: false }, back: None }
    }
}

impl Material {
    fn with_sides(mut self, change: impl Fn(&mut Unfinished)) -> Self {
        change(&mut self.front);
        self.back.as_mut().map(change);
        self
    }

    fn tilted(self, tilt: TiltSource) -> Self {
        self.with_sides(|side| {
            for part in &mut side.parts {
                part.tilts.insert(0, TiltSource { is_mirrored: part.is_mirrored, ..tilt });
            }
        })
    }
}

impl Unfinished {
    fn times(mut self, factor: Factor) -> Self {
        self.parts.iter_mut().for_each(|part| part.factors.push(factor));
        self
    }

    fn and(mut self, other: Self) -> Self {
        self.parts.extend(other.parts);
        Self { has_holes: self.has_holes || other.has_holes, ..self }
    }

    /// Without the parts that are never seen.
    fn pruned(mut self) -> Self {
        let is_zero = |factor: &Factor| match factor.weight {
            ScalarInput::Constant(weight) => {
                if factor.is_rest {
                    weight >= 1.0
                } else {
                    weight <= 0.0
                }
            }
            ScalarInput::Texture(_) => false,
        };
        self.parts.retain(|part| !part.factors.iter().any(is_zero));
        self
    }

    /// The only model, of a common kind in the surface's own frame, and its opacity, if that is all there is.
    fn single(&self) -> Option<(u32, Sources, Option<ScalarInput>)> {
        let [UnfinishedPart { factors, tilts, model: ModelSource::Common { kind, sources }, .. }] =
            &self.parts[..]
        else {
            return None;
        };
        let opacity = match factors[..] {
            [] => None,
            [Factor { weight, is_rest: false }] => Some(weight),
            _ => return None,
        };
        tilts.is_empty().then_some((*kind, *sources, opacity))
    }
}

impl Materials {
    /// Flattens descriptions, which have been validated. Tables are made on rayon's current pool.
    ///
    /// # Errors
    /// If a material has too many models or frames.
    pub fn new(descs: &[MaterialDesc]) -> Result<Self, MaterialError> {
        let mut all = Self {
            faces: Vec::with_capacity(descs.len()),
            sides: Vec::new(),
            kinds: Vec::new(),
            coats: Vec::new(),
            parts: Parts::default(),
            tables: Tables::default(),
        };
        let mut orders = Orders::default();
        for id in 0..descs.len() {
            let Material { front, back } = all.flatten(descs, MaterialId(id as u32), &mut orders);
            if orders.len() > MAX_TABLES {
                return Err(MaterialError::TooManyTables { material: MaterialId(id as u32) });
            }
            let front = all.add(front, id as u32)?;
            let back = back.map_or(Ok(front), |back| all.add(back, id as u32))?;
            all.faces.push([front, back]);
        }
        (all.coats, all.tables) = orders.make();
        Ok(all)
    }

    fn add(&mut self, side: Unfinished, material: u32) -> Result<Face, MaterialError> {
        let is_turned = !side.parts.is_empty() && side.parts.iter().all(|part| part.is_mirrored);
        let face = match side.single() {
            Some((kind, sources, opacity)) => self.add_common(kind, sources, opacity),
            None => self.add_parts(side.pruned(), is_turned, material)?,
        };
        Ok(Face { turn: if is_turned { -1.0 } else { 1.0 }, ..face })
    }

    fn add_common(&mut self, kind: u32, sources: Sources, opacity: Option<ScalarInput>) -> Face {
        let needs_tangents = is_anisotropic(&self.kinds, kind, &sources);
        let queue = if needs_tangents {
            Queue::SINGLE
        } else if self.kinds[kind as usize] == Kind::Diffuse && opacity.is_none() {
            Queue::LAMBERT
        } else {
            Queue::of_kind(kind)
        };
        let (constant, textured) = sources.split(opacity.unwrap_or(ScalarInput::Constant(1.0)));
        let (parts, has_holes) = (0..0, false);
        self.sides.push(Side { kind: Some(kind), constant, textured, parts, has_holes, needs_tangents });
        let (albedo, has_picture) = match sources.colors[0] {
            ColorInput::Constant(albedo) => (albedo, false),
            ColorInput::Texture(_) => (Rgb::ZERO, queue == Queue::LAMBERT),
        };
        Face { side: self.sides.len() as u32 - 1, queue, turn: 1.0, albedo, has_picture }
    }

    /// `is_turned`: is the normal turned to the viewer already, so that parts need no mirror?
    fn add_parts(&mut self, side: Unfinished, is_turned: bool, material: u32) -> Result<Face, MaterialError> {
        let at_most = |most, what, count| {
            if count > most {
                Err(MaterialError::TooMany { material: MaterialId(material), what, count, most })
            } else {
                Ok(())
            }
        };
        at_most(MAX_PARTS, "models in one place", side.parts.len())?;
        let mut needs_tangents = false;
        let first = self.parts.parts.len();
        for UnfinishedPart { factors, is_mirrored, tilts, model } in side.parts {
            needs_tangents |= !tilts.is_empty() || is_anisotropic_model(&self.kinds, &model);
            let mirror = (is_mirrored && !is_turned).then_some(StepSource::Mirror);
            let steps = mirror.into_iter().chain(tilts.into_iter().map(StepSource::Tilt));
            let (factors_start, steps_start) = (self.parts.factors.len(), self.parts.steps.len());
            self.parts.factors.extend(factors);
            self.parts.steps.extend(steps);
            at_most(MAX_STEPS, "frames within one another", self.parts.steps.len() - steps_start)?;
            self.parts.parts.push(PartSource {
                factors: factors_start..self.parts.factors.len(),
                steps: steps_start..self.parts.steps.len(),
                model,
            });
        }
        let (constant, textured) = Sources::new(&[], &[]).split(ScalarInput::Constant(1.0));
        let (parts, has_holes) = (first..self.parts.parts.len(), side.has_holes);
        self.sides.push(Side { kind: None, constant, textured, parts, has_holes, needs_tangents });
        let side = self.sides.len() as u32 - 1;
        Ok(Face { side, queue: Queue::SINGLE, turn: 1.0, albedo: Rgb::ZERO, has_picture: false })
    }

    fn flatten(
        &mut self,
        descs: &[MaterialDesc],
        MaterialId(id): MaterialId,
        orders: &mut Orders,
    ) -> Material {
        match descs[id as usize] {
            MaterialDesc::TwoSided { front, back } => {
                let (front, back) = (self.flatten(descs, front, orders), self.flatten(descs, back, orders));
                let mut back = back.front;
                back.parts.iter_mut().for_each(|part| part.is_mirrored = true);
                Material { front: front.front, back: Some(back) }
            }
            MaterialDesc::Mask { opacity, inner } => self.flatten(descs, inner, orders).with_sides(|side| {
                let factor = Factor { weight: opacity, is_rest: false };
                *side = Unfinished { has_holes: true, ..std::mem::take(side).times(factor) };
            }),
            MaterialDesc::Blend { weight, materials } => {
                let [first, second] = materials.map(|id| self.flatten(descs, id, orders));
                let blend = |first: Unfinished, second: Unfinished| {
                    let second = second.times(Factor { weight, is_rest: false });
                    first.times(Factor { weight, is_rest: true }).and(second)
                };
                let has_back = first.back.is_some() || second.back.is_some();
                let back_of = |m: &Material| m.back.clone().unwrap_or_else(|| m.front.clone());
                let back = has_back.then(|| blend(back_of(&first), back_of(&second)));
                Material { front: blend(first.front, second.front), back }
            }
            MaterialDesc::BumpMap { scale, texture, tilting, inner } => {
                let normal = NormalSource::Bump { scale, texture };
                self.flatten(descs, inner, orders).tilted(TiltSource { normal, tilting, is_mirrored: false })
            }
            MaterialDesc::NormalMap { normal, tilting, inner } => {
                let normal = NormalSource::Map(normal);
                self.flatten(descs, inner, orders).tilted(TiltSource { normal, tilting, is_mirrored: false })
            }
            ref plain => self.model_source(plain, orders).into(),
        }
    }
}

fn is_anisotropic(kinds: &[Kind], kind: u32, sources: &Sources) -> bool {
    let is_rough = matches!(kinds[kind as usize], Kind::RoughConductor { .. } | Kind::RoughDielectric { .. });
    is_rough && sources.scalars[0] != sources.scalars[1]
}

fn is_anisotropic_model(kinds: &[Kind], model: &ModelSource) -> bool {
    match model {
        ModelSource::Common { kind, sources } => is_anisotropic(kinds, *kind, sources),
        ModelSource::Uncommon(uncommon) => uncommon.is_anisotropic(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF: ScalarInput = ScalarInput::Constant(0.5);

    fn white() -> MaterialDesc {
        MaterialDesc::Diffuse { reflectance: ColorInput::Constant(Rgb::ONE) }
    }

    fn twosided(id: u32) -> MaterialDesc {
        MaterialDesc::TwoSided { front: MaterialId(id), back: MaterialId(id) }
    }

    #[test]
    fn what_is_common_has_no_parts() {
        let mask = MaterialDesc::Mask { opacity: HALF, inner: MaterialId(0) };
        let all = Materials::new(&[white(), twosided(0), mask, twosided(1)]).unwrap();
        assert!(all.sides.iter().all(|side| side.parts.is_empty()));
        let [front, back] = all.faces[3];
        assert_eq!((front.queue, back.queue), (Queue::LAMBERT, Queue::LAMBERT));
        assert_eq!((front.turn, back.turn), (1.0, -1.0));
    }

    #[test]
    fn masks_in_masks_multiply() {
        let mask = |inner| MaterialDesc::Mask { opacity: HALF, inner: MaterialId(inner) };
        let all = Materials::new(&[white(), mask(0), mask(1)]).unwrap();
        let side = all.side(all.faces[2][0].side);
        assert!(side.has_holes && side.parts.len() == 1);
        assert_eq!(all.parts.parts[side.parts.start].factors.len(), 2);
    }

    /// Behind, one part is mirrored and the other is as it is.
    #[test]
    fn a_blend_of_one_side_and_two() {
        let blend = MaterialDesc::Blend { weight: HALF, materials: [MaterialId(0), MaterialId(1)] };
        let all = Materials::new(&[white(), twosided(0), blend]).unwrap();
        let [front, back] = all.faces[2];
        assert_eq!((front.turn, back.turn), (1.0, 1.0));
        let steps = |face: Face| {
            all.parts.parts[all.side(face.side).parts.clone()]
                .iter()
                .map(|p| p.steps.len())
                .collect::<Vec<_>>()
        };
        assert_eq!((steps(front), steps(back)), (vec![0, 0], vec![0, 1]));
    }

    #[test]
    fn there_is_an_end_to_nesting() {
        let mut descs = vec![white()];
        for id in 0..4 {
            descs.push(MaterialDesc::Blend { weight: HALF, materials: [MaterialId(id), MaterialId(id)] });
        }
        assert!(matches!(
            Materials::new(&descs),
            Err(MaterialError::TooMany { material: MaterialId(4), count: 16, .. })
        ));
    }
}
