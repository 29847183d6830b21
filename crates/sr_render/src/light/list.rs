//! All lights of a scene, and the choice among them in proportion to their power.

use glam::{Vec2, Vec3};
use sr_geometry::{Geometry, ShapeId, Surface};
use sr_sampling::{AliasTable, power_weight};
use sr_scene::Rgb;

use super::area::Piece;
use super::{
    AreaLight, ConstantEnvironment, DeltaSample, DirectionalLight, Environment, GoniometricLight,
    LightSample, PointLight, ProfileLight, Projector, SeenFrom, Sky, SpotLight, Sun,
};
use crate::texture::{Textures, luminance};

/// Index of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightId(pub u32);

/// A light with an extent: other techniques can hit it by chance.
#[derive(Clone, Debug)]
pub(crate) enum Extended {
    Area(AreaLight),
    Constant(ConstantEnvironment),
    Environment(Environment),
    Sky(Sky),
    Sun(Sun),
}

impl Extended {
    /// Radiance along `wi` of a light infinitely far away, and the density with which it is sampled from `from`, in sr⁻¹.
    #[inline(always)]
    fn seen_along(&self, from: Vec3, wi: Vec3) -> (Rgb, f32) {
        match self {
            Self::Area(_) => (Rgb::ZERO, 0.0),
            Self::Constant(constant) => (constant.radiance, constant.pdf()),
            Self::Environment(environment) => environment.seen_along(from, wi),
            Self::Sky(sky) => (sky.radiance(wi), sky.pdf(wi)),
            Self::Sun(sun) => (sun.radiance(wi), sun.pdf(wi)),
        }
    }

    /// The mean radiance, over all directions, of a light infinitely far away.
    fn mean_radiance(&self) -> Rgb {
        match self {
            Self::Area(_) => Rgb::ZERO,
            Self::Constant(constant) => constant.radiance,
            Self::Environment(environment) => environment.mean_radiance(),
            Self::Sky(sky) => sky.mean_radiance(),
            Self::Sun(sun) => sun.mean_radiance(),
        }
    }
}

/// A light without one.
#[derive(Clone, Debug)]
pub(crate) enum Delta {
    Point(PointLight),
    Directional(DirectionalLight),
    Spot(SpotLight),
    Projector(Projector),
    Goniometric(GoniometricLight),
    Profile(ProfileLight),
}

/// The lights of a scene.
///
/// Extended lights and deltas are chosen separately: a delta can only be sampled, so it never
/// competes with another technique.
#[derive(Debug)]
pub struct Lights {
    extended: Vec<Extended>,
    extended_choice: Choice,
    environments: Vec<LightId>,
    deltas: Vec<Delta>,
    delta_choice: Choice,
    /// The shapes that shine, alone: what lies behind what along a direction.
    emitters: Geometry,
    light_of_emitter: Vec<LightId>,
}

/// A choice in proportion to power.
#[derive(Debug)]
struct Choice {
    table: Option<AliasTable>,
    pmf: Vec<f32>,
}

impl Choice {
    fn new(powers: Vec<f32>) -> Self {
        let total: f64 = powers.iter().map(|&p| f64::from(p)).sum();
        let table = AliasTable::new(&powers).ok();
        let pmf = match table {
            Some(_) => powers.iter().map(|&p| (f64::from(p) / total) as f32).collect(),
            None => vec![0.0; powers.len()],
        };
        Self { table, pmf }
    }

    /// An index, its probability, and the uniform made new.
    #[inline]
    fn sample(&self, u: f32) -> Option<(usize, f32, f32)> {
        if self.pmf.len() == 1 && self.table.is_some() {
            return Some((0, 1.0, u));
        }
        let (s, rest) = self.table.as_ref()?.sample_and_reuse(u);
        Some((s.value, s.pdf, rest))
    }
}

impl Lights {
    /// `emitters` holds the shapes of the area lights; `light_of_emitter` says which light each is.
    pub(crate) fn new(
        extended: Vec<Extended>,
        deltas: Vec<Delta>,
        emitters: Geometry,
        light_of_emitter: Vec<LightId>,
        scene_radius: f32,
        textures: &Textures,
    ) -> Self {
        let flux = |radiance: Rgb| {
            4.0 * std::f32::consts::PI * std::f32::consts::PI * scene_radius * scene_radius * radiance
        };
        // What a texture with impossible values emits must not keep all others from being chosen.
        let weight = |power: Rgb| luminance(power).clamp(0.0, MOST_POWER).max(0.0);
        let extended_power = |light: &Extended| {
            weight(match light {
                Extended::Area(area) => area.power(),
                far => flux(far.mean_radiance()),
            })
        };
        let delta_power = |light: &Delta| {
            weight(match light {
                Delta::Point(point) => point.power(),
                Delta::Directional(directional) => directional.power(scene_radius),
                Delta::Spot(spot) => spot.power(),
                Delta::Projector(projector) => projector.power(textures),
                Delta::Goniometric(light) => light.power(),
                Delta::Profile(light) => light.power(),
            })
        };
        let ids = (0..extended.len() as u32).map(LightId);
        Self {
            extended_choice: Choice::new(extended.iter().map(extended_power).collect()),
            delta_choice: Choice::new(deltas.iter().map(delta_power).collect()),
            environments: ids.filter(|id| !matches!(extended[id.0 as usize], Extended::Area(_))).collect(),
            extended,
            deltas,
            emitters,
            light_of_emitter,
        }
    }

    /// How many lights there are.
    pub fn count(&self) -> usize {
        self.extended.len() + self.deltas.len()
    }

    /// Lights with an extent.
    pub fn extended_ids(&self) -> impl Iterator<Item = LightId> {
        (0..self.extended.len() as u32).map(LightId)
    }

    /// What kind of light one with an extent is.
    pub fn kind(&self, LightId(id): LightId) -> &'static str {
        match &self.extended[id as usize] {
            Extended::Area(_) => "area",
            Extended::Constant(_) => "constant",
            Extended::Environment(_) => "environment",
            Extended::Sky(_) => "sky",
            Extended::Sun(_) => "sun",
        }
    }

    /// Is there a light with an extent?
    pub fn has_extended(&self) -> bool {
        !self.extended.is_empty()
    }

    /// Is there a light infinitely far away that has an extent?
    pub fn has_environment(&self) -> bool {
        !self.environments.is_empty()
    }

    /// Does sampling the lights with an extent make use of the uniform that chooses?
    pub(crate) fn must_pick(&self) -> bool {
        match &self.extended[..] {
            [Extended::Area(area)] => area.must_pick(),
            [_] => false,
            _ => true,
        }
    }

    /// Chooses a light with an extent: which, its probability, and the uniform made new.
    #[inline(always)]
    pub(super) fn pick(&self, u_pick: f32) -> Option<(LightId, f32, f32)> {
        let (index, pmf, rest) = self.extended_choice.sample(u_pick)?;
        Some((LightId(index as u32), pmf, rest))
    }

    /// A piece of a light that shines alike everywhere, or of the image around the scene; `None` for other lights.
    #[inline(always)]
    pub(super) fn piece(&self, id: LightId, from: Vec3, u_pick: f32) -> Option<Piece> {
        match &self.extended[id.0 as usize] {
            Extended::Area(area) => area.piece(from, u_pick),
            Extended::Environment(sky) if self.environments.len() == 1 && sky.is_plain() => Some(Piece::Sky),
            _ => None,
        }
    }

    /// The image around the scene, if there is one, of latitudes and longitudes, and no other light is around it.
    #[inline(always)]
    pub(super) fn sky(&self) -> Option<&Environment> {
        match &self.environments[..] {
            &[LightId(id)] => match &self.extended[id as usize] {
                Extended::Environment(sky) if sky.is_plain() => Some(sky),
                _ => None,
            },
            _ => None,
        }
    }

    /// Is there a light that only light sampling can find?
    pub fn has_deltas(&self) -> bool {
        !self.deltas.is_empty()
    }

    /// Draws a direction from `from` to one extended light, chosen by `u_pick`. The density is that of
    /// reaching this light: choice times direction.
    #[inline(always)]
    pub fn sample(&self, from: Vec3, u_pick: f32, u: Vec2) -> Option<LightSample> {
        let (id, pmf, u_pick) = self.pick(u_pick)?;
        let mut s = self.sample_one(id, from, u_pick, u)?;
        s.pdf *= pmf;
        Some(s)
    }

    /// Draws a direction from `from` to a given extended light.
    #[inline(always)]
    pub(crate) fn sample_one(&self, id: LightId, from: Vec3, u_pick: f32, u: Vec2) -> Option<LightSample> {
        match &self.extended[id.0 as usize] {
            Extended::Area(area) => area.sample(id, from, u_pick, u),
            Extended::Constant(constant) => constant.sample(id, u),
            Extended::Environment(environment) => environment.sample(id, from, u),
            Extended::Sky(sky) => sky.sample(id, u),
            Extended::Sun(sun) => sun.sample(id, u),
        }
    }

    /// Radiance that arrives along a sampled direction if nothing is in between.
    #[inline]
    pub fn radiance(&self, s: &LightSample, textures: &Textures) -> Rgb {
        match &self.extended[s.light.0 as usize] {
            Extended::Area(area) => area.radiance(s, textures),
            Extended::Constant(constant) => constant.radiance,
            Extended::Environment(environment) => environment.radiance_at(s.uv),
            Extended::Sky(sky) => sky.radiance(s.wi),
            Extended::Sun(sun) => sun.radiance(s.wi),
        }
    }

    /// Light arriving at `from` from one delta light, over the probability of choosing it.
    #[inline]
    pub fn sample_delta(&self, from: Vec3, u_pick: f32, textures: &Textures) -> Option<DeltaSample> {
        let (index, pmf, _) = self.delta_choice.sample(u_pick)?;
        let mut s = match &self.deltas[index] {
            Delta::Point(point) => point.sample(from)?,
            Delta::Directional(directional) => directional.sample(),
            Delta::Spot(spot) => spot.sample(from, textures)?,
            Delta::Projector(projector) => projector.sample(from, textures)?,
            Delta::Goniometric(light) => light.sample(from)?,
            Delta::Profile(light) => light.sample(from)?,
        };
        s.radiance /= pmf;
        Some(s)
    }

    /// The set of texture coordinates that an area light's radiance is looked up at, if it is not the first one.
    pub fn other_set(&self, id: LightId, textures: &Textures) -> Option<u8> {
        match &self.extended[id.0 as usize] {
            Extended::Area(area) => textures.other_set(area.emission()),
            _ => None,
        }
    }

    /// Radiance that a point of an area light emits towards `w`.
    #[inline]
    pub fn emitted(&self, id: LightId, surface: &Surface, w: Vec3, textures: &Textures) -> Rgb {
        match &self.extended[id.0 as usize] {
            Extended::Area(area) => area.emitted(surface.ng, surface.uv, w, textures),
            _ => Rgb::ZERO,
        }
    }

    /// The density, in sr⁻¹, with which `sample` reaches the point `surface` of an area light, on triangle `primitive`
    /// of its mesh.
    #[inline]
    pub fn pdf_of_point(&self, id: LightId, from: Vec3, surface: &Surface, primitive: u32) -> f32 {
        match &self.extended[id.0 as usize] {
            Extended::Area(area) => self.pmf(id) * area.pdf(from, surface.p, surface.ng, primitive),
            _ => 0.0,
        }
    }

    /// The probability that `sample` chooses a light.
    #[inline]
    pub fn pmf(&self, id: LightId) -> f32 {
        self.extended_choice.pmf[id.0 as usize]
    }

    /// Radiance of all environments along `wi`, each multiplied by `weight` of the density with which
    /// `sample` draws `wi` from it at `from`.
    #[inline]
    pub fn environment(&self, from: Vec3, wi: Vec3, weight: impl Fn(f32) -> f32) -> Rgb {
        let mut sum = Rgb::ZERO;
        for &id in &self.environments {
            let (radiance, pdf) = self.extended[id.0 as usize].seen_along(from, wi);
            sum += radiance * weight(self.pmf(id) * pdf);
        }
        sum
    }

    /// [`Lights::environment`] under the power heuristic against one other technique.
    #[inline]
    pub(crate) fn environment_by_power(&self, from: Vec3, wi: Vec3, other_pdf: f32) -> Rgb {
        self.environment(from, wi, |p_light| power_weight(other_pdf, p_light))
    }

    /// The density over directions of one light, or of all, as seen from a point.
    pub fn seen_from(&self, from: Vec3, only: Option<LightId>) -> SeenFrom<'_> {
        SeenFrom::new(self, from, only)
    }

    /// The whole density, in sr⁻¹, of drawing direction `wi`: every light along it counts, also one behind another.
    pub(crate) fn pdf_of_direction(&self, from: Vec3, wi: Vec3, only: Option<LightId>) -> f32 {
        let counts = |id: LightId| only.is_none_or(|o| o == id);
        let weight = |id: LightId| if only.is_some() { 1.0 } else { self.pmf(id) };
        let mut sum = 0.0;
        for &id in self.environments.iter().filter(|&&id| counts(id)) {
            sum += weight(id) * self.extended[id.0 as usize].seen_along(from, wi).1;
        }
        let mut ray = sr_geometry::Ray { origin: from, direction: wi, t_max: f32::INFINITY };
        for _ in 0..MAX_CROSSINGS {
            let Some(hit) = self.emitters.intersect(&ray) else { break };
            let surface = self.emitters.surface(&ray, &hit);
            let ShapeId(shape) = hit.shape;
            let id = self.light_of_emitter[shape as usize];
            if let Extended::Area(area) = &self.extended[id.0 as usize]
                && counts(id)
            {
                sum += weight(id) * area.pdf(from, surface.p, surface.ng, hit.primitive);
            }
            ray = surface.spawn_ray(wi);
        }
        sum
    }
}

/// Lights of more power are chosen as if they had this: sums of it are finite.
const MOST_POWER: f32 = 1e30;

/// More emitting layers than this along one direction are not counted: no scene has them, and a
/// broken mesh must not hang the renderer.
const MAX_CROSSINGS: usize = 4096;
