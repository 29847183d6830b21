//! Path tracing with any strategy: the teaching version, and the instrument.
//!
//! At each vertex a strategy has one or more techniques, each a density over directions.
//!
//! - A technique that covers the surface draws a direction ω from its mixture p = Σ aᵢ pᵢ and divides by
//!   that same sum. The path goes on along the first such technique; further ones look only for light.
//! - A technique of `light` alone cannot: it samples a point on a light, and the path goes on along `bsdf`.
//! - Several techniques share the light that they all can find, by the strategy's heuristic.
//!
//! Where a surface has delta lobes, half of the samples of a technique without `bsdf` are drawn by it.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::{Vec2, Vec3};
use sr_bsdf::AnyBsdf;
use sr_geometry::{BATCH, Hit, Ray, Surface};
use sr_sampling::warp::{CosineHemisphere, UniformHemisphere, UniformSphere};
use sr_sampling::{Cursor, Distribution, Mixture, Sample, Sequence, SolidAngle};
use sr_scene::Rgb;

use super::roulette::survive;
use super::{
    CameraRays, FIRST_DIMENSION, FirstHit, Integrator, PathLimits, PathSample, from_deltas, visible,
};
use crate::light::SeenFrom;
use crate::material::Room;
use crate::scene::Scene;
use crate::strategy::{Basic, Density, MAX_TECHNIQUES, Strategy};
use crate::texture::RayCone;
use crate::vertex::{Sight, Vertex};

/// Dimensions of one technique: lobe or light, direction (2), and one to spare.
const DIMENSIONS_PER_TECHNIQUE: u32 = 4;
/// All techniques, roulette, delta light, and two to spare.
const DIMENSIONS_PER_VERTEX: u32 = DIMENSIONS_PER_TECHNIQUE * MAX_TECHNIQUES as u32 + 4;

/// Unidirectional path tracing with an arbitrary [`Strategy`].
#[derive(Clone, Debug)]
pub struct StrategyTracer {
    /// How long paths are.
    pub limits: PathLimits,
    /// How directions are chosen.
    pub strategy: Strategy,
}

/// One of the basic densities at a vertex, over world-space directions.
#[derive(Clone, Copy, Debug)]
enum Component<'a> {
    Uniform(&'a Vertex<'a, AnyBsdf<'a>>),
    Cosine(&'a Vertex<'a, AnyBsdf<'a>>),
    Bsdf(&'a Vertex<'a, AnyBsdf<'a>>),
    Light(SeenFrom<'a>),
}

impl Distribution for Component<'_> {
    type Measure = SolidAngle;
    type Uniform = (f32, Vec2);

    fn sample(&self, (u_lobe, u): (f32, Vec2)) -> Option<Sample<SolidAngle>> {
        let local = |vertex: &Vertex<'_, AnyBsdf<'_>>, s: Sample<SolidAngle>| {
            let value = vertex.world_from_local(s.value);
            Some(Sample { value, pdf: s.pdf })
        };
        match self {
            Component::Uniform(v) if v.lobes().transmission => local(v, UniformSphere.sample(u)?),
            Component::Uniform(v) => local(v, UniformHemisphere.sample(u)?),
            Component::Cosine(v) => {
                let Sample { value, pdf } = CosineHemisphere.sample(u)?;
                match v.lobes().transmission {
                    true if u_lobe < 0.5 => local(v, Sample { value: -value, pdf: 0.5 * pdf }),
                    true => local(v, Sample { value, pdf: 0.5 * pdf }),
                    false => local(v, Sample { value, pdf }),
                }
            }
            Component::Bsdf(v) => {
                let s = v.sample(u_lobe, u)?;
                (!s.delta).then_some(Sample { value: s.wi, pdf: s.pdf })
            }
            Component::Light(lights) => lights.sample((u_lobe, u)),
        }
    }

    fn pdf(&self, wi: Vec3) -> f32 {
        match self {
            Component::Uniform(v) if v.lobes().transmission => UniformSphere.pdf(wi),
            Component::Uniform(v) => UniformHemisphere.pdf(Vec3::Z * v.cos(wi)),
            Component::Cosine(v) if v.lobes().transmission => {
                0.5 * CosineHemisphere.pdf(Vec3::Z * v.cos(wi).abs())
            }
            Component::Cosine(v) => CosineHemisphere.pdf(Vec3::Z * v.cos(wi)),
            Component::Bsdf(v) => v.eval(wi).1,
            Component::Light(lights) => lights.pdf(wi),
        }
    }
}

/// A technique at a vertex.
type Technique<'a> = Mixture<Component<'a>, [(f32, Component<'a>); 4]>;

fn technique<'a>(scene: &'a Scene, vertex: &'a Vertex<'a, AnyBsdf<'a>>, density: Density) -> Technique<'a> {
    let component = |basic| match basic {
        Basic::Uniform => Component::Uniform(vertex),
        Basic::Cosine => Component::Cosine(vertex),
        Basic::Bsdf => Component::Bsdf(vertex),
        Basic::Light => Component::Light(scene.lights.seen_from(vertex.surface.p, None)),
    };
    Mixture::new(Basic::ALL.map(|basic| (density.weight(basic), component(basic))))
        .expect("a Density's weights sum to 1")
}

/// The direction that a path goes on in.
struct Step {
    wi: Vec3,
    weight: Rgb,
    eta: f32,
    delta: bool,
}

/// Draws a direction, delta lobes included.
///
/// The component is picked by what is then used again for the direction: one well-spread pair for both.
fn draw(
    technique: &Technique<'_>,
    vertex: &Vertex<'_, AnyBsdf<'_>>,
    (u_lobe, u): (f32, Vec2),
) -> Option<Step> {
    let (&(probability, component), u_left) = technique.pick_and_reuse(u.x);
    let u = Vec2::new(u_left, u.y);
    let mut eta = 1.0;
    let wi = if let Component::Bsdf(_) = component {
        let s = vertex.sample(u_lobe, u)?;
        if s.delta {
            return Some(Step { wi: s.wi, weight: s.weight / probability, eta: s.eta, delta: true });
        }
        eta = s.eta;
        s.wi
    } else {
        component.sample((u_lobe, u))?.value
    };
    let pdf = technique.pdf(wi);
    let weight = vertex.f_cos(wi) / pdf;
    (pdf > 0.0 && pdf.is_finite()).then_some(Step { wi, weight, eta, delta: false })
}

/// How much of the light that the next ray hits belongs to the path.
#[derive(Clone, Copy)]
enum Share {
    /// All: nothing else can find it.
    All,
    /// None: light sampling finds it.
    Nothing,
    /// What the heuristic leaves to technique `index`.
    Technique { from: Vec3, index: usize, densities: [f32; MAX_TECHNIQUES] },
}

impl Integrator for StrategyTracer {
    type Workspace<Q: Sequence> = ();

    fn workspace<Q: Sequence>(&self, _sequence: Q) {}

    fn trace<Q: Sequence>(
        &self,
        scene: &Scene,
        rays: &CameraRays<Q>,
        (): &mut (),
        samples: &mut [PathSample; BATCH],
        cancel: &AtomicBool,
    ) {
        for (i, sample) in samples[..rays.count].iter_mut().enumerate() {
            *sample = self.li(scene, (rays.rays.get(i), rays.cone), &mut rays.cursor(i), cancel);
        }
    }
}

impl StrategyTracer {
    fn li<Q: Sequence>(
        &self,
        scene: &Scene,
        (mut ray, mut cone): (Ray, RayCone),
        u: &mut Cursor<'_, Q>,
        cancel: &AtomicBool,
    ) -> PathSample {
        let mut path = PathSample::default();
        let mut beta = Rgb::ONE;
        let mut eta = 1.0;
        let mut share = if self.limits.hide_emitters { Share::Nothing } else { Share::All };
        let mut depth = 0;
        loop {
            let mut room = Room::None;
            let at = (&ray, cone, share);
            let Some((le, arrival)) = self.arrive(scene, at, (&mut path, beta), depth == 0, &mut room) else {
                break;
            };
            let vertex = arrival.vertex();
            path.li += beta * le;
            depth += 1;
            if depth >= self.limits.max_depth || cancel.load(Ordering::Relaxed) {
                break;
            }
            let dimension = FIRST_DIMENSION.wrapping_add((depth - 1).wrapping_mul(DIMENSIONS_PER_VERTEX));
            let Some((step, next_share)) = self.scatter(scene, &vertex, dimension, u, &mut path.li, beta)
            else {
                break;
            };
            beta *= step.weight;
            eta *= step.eta;
            if self.limits.plays_roulette(depth) {
                u.seek(dimension + DIMENSIONS_PER_VERTEX - 4);
                let Some(factor) = survive(beta, eta, u.next_1d()) else { break };
                beta *= factor;
            }
            if beta == Rgb::ZERO {
                break;
            }
            cone = cone.after(ray.origin.distance(vertex.surface.p), step.delta);
            ray = vertex.surface.spawn_ray(step.wi);
            share = next_share;
        }
        path
    }
}

/// A surface that a path has come to.
struct Arrival<'a> {
    surface: Surface,
    sight: Sight,
    bsdf: AnyBsdf<'a>,
}

impl<'a> Arrival<'a> {
    fn new(scene: &'a Scene, ray: &Ray, hit: &Hit, cone: RayCone, room: &'a mut Room<'a>) -> Self {
        let surface = scene.geometry.surface(ray, hit);
        let point = scene.texture_point(ray, hit, cone);
        let (sight, bsdf) = Sight::with_model(scene, ray, hit, &surface, point, room);
        Self { surface, sight, bsdf }
    }

    fn vertex(&self) -> Vertex<'_, AnyBsdf<'a>> {
        Vertex { surface: &self.surface, sight: &self.sight, bsdf: &self.bsdf }
    }
}

impl StrategyTracer {
    /// Follows a ray to its end: the light found there, weighted, and the vertex. A ray that leaves the
    /// scene adds the environment to `path`.
    fn arrive<'a>(
        &self,
        scene: &'a Scene,
        (ray, cone, share): (&Ray, RayCone, Share),
        (path, beta): (&mut PathSample, Rgb),
        is_first: bool,
        room: &'a mut Room<'a>,
    ) -> Option<(Rgb, Arrival<'a>)> {
        let Some(hit) = scene.geometry.intersect(ray) else {
            path.li += beta * self.environment(scene, ray, share);
            return None;
        };
        let arrival = Arrival::new(scene, ray, &hit, cone, room);
        if is_first {
            path.first = Some(FirstHit::new(&arrival.vertex(), hit.t));
        }
        Some((self.emission(scene, ray, &hit, &arrival.surface, share), arrival))
    }

    /// Light from around the scene along a ray that hit nothing, as far as it belongs to the technique that drew the ray.
    fn environment(&self, scene: &Scene, ray: &Ray, share: Share) -> Rgb {
        let from = match share {
            Share::Technique { from, .. } => from,
            Share::All | Share::Nothing => ray.origin,
        };
        scene.lights.environment(from, ray.direction, |p_light| self.weight(share, p_light))
    }

    /// Light emitted by what a ray hit, as far as it belongs to the technique that drew the ray.
    fn emission(&self, scene: &Scene, ray: &Ray, hit: &Hit, surface: &Surface, share: Share) -> Rgb {
        let Some(light) = scene.light_of(hit.shape) else { return Rgb::ZERO };
        let p_light = match share {
            Share::Technique { from, .. } => scene.lights.pdf_of_point(light, from, surface, hit.primitive),
            Share::All | Share::Nothing => 0.0,
        };
        let surface = scene.emitter(*surface, light, hit);
        scene.lights.emitted(light, &surface, -ray.direction, &scene.textures) * self.weight(share, p_light)
    }

    fn weight(&self, share: Share, p_light: f32) -> f32 {
        match share {
            Share::All => 1.0,
            Share::Nothing => 0.0,
            Share::Technique { index, densities, .. } => self.technique_weight(index, densities, p_light),
        }
    }

    /// The heuristic's weight of technique `index`, where those of `light` alone have density `p_light`.
    fn technique_weight(&self, index: usize, mut densities: [f32; MAX_TECHNIQUES], p_light: f32) -> f32 {
        let techniques = self.strategy.techniques();
        for (density, technique) in densities.iter_mut().zip(techniques) {
            if !technique.covers_surface() {
                *density = p_light;
            }
        }
        self.strategy.heuristic().weight(densities[index], &densities[..techniques.len()])
    }

    /// Takes all samples at a vertex: adds the light found by those that do not go on to `li`, and
    /// returns the one that does.
    fn scatter<Q: Sequence>(
        &self,
        scene: &Scene,
        vertex: &Vertex<'_, AnyBsdf<'_>>,
        dimension: u32,
        u: &Cursor<'_, Q>,
        li: &mut Rgb,
        beta: Rgb,
    ) -> Option<(Step, Share)> {
        let uniforms = |slot: usize| {
            let mut u = u.at(dimension + DIMENSIONS_PER_TECHNIQUE * slot as u32);
            (u.next_1d(), u.next_2d())
        };
        let bsdf_alone = technique(scene, vertex, Density::single(Basic::Bsdf));
        if !vertex.lobes().smooth() {
            return Some((draw(&bsdf_alone, vertex, uniforms(0))?, Share::All));
        }

        let densities_given = self.strategy.techniques();
        let main = densities_given.iter().position(Density::covers_surface);
        let at_vertex: [Technique<'_>; MAX_TECHNIQUES] =
            std::array::from_fn(|i| match densities_given.get(i) {
                Some(density) if vertex.lobes().delta => technique(scene, vertex, density.with_bsdf()),
                Some(&density) => technique(scene, vertex, density),
                None => bsdf_alone,
            });
        let densities = |wi: Vec3| {
            let mut all = [0.0; MAX_TECHNIQUES];
            for ((p, technique), given) in all.iter_mut().zip(&at_vertex).zip(densities_given) {
                if given.covers_surface() {
                    *p = technique.pdf(wi);
                }
            }
            all
        };

        for (index, given) in densities_given.iter().enumerate() {
            if Some(index) == main {
                continue;
            }
            let (u_lobe, u_direction) = uniforms(index);
            if given.covers_surface() {
                let Some(step) = draw(&at_vertex[index], vertex, (u_lobe, u_direction)) else {
                    continue;
                };
                if step.delta || step.weight == Rgb::ZERO {
                    continue;
                }
                let share = Share::Technique { from: vertex.surface.p, index, densities: densities(step.wi) };
                *li +=
                    beta * step.weight * self.light_along(scene, &vertex.surface.spawn_ray(step.wi), share);
            } else if let Some(s) = scene.lights.sample(vertex.surface.p, u_lobe, u_direction) {
                let f_cos = vertex.f_cos(s.wi);
                if f_cos != Rgb::ZERO && visible(scene, vertex.surface, s.wi, s.target) {
                    let weight = self.technique_weight(index, densities(s.wi), s.pdf);
                    let radiance = scene.lights.radiance(&s, &scene.textures);
                    *li += beta * f_cos * radiance * (weight / s.pdf);
                }
            }
        }
        if scene.lights.has_deltas() {
            let mut u = u.at(dimension + DIMENSIONS_PER_VERTEX - 3);
            *li += beta * from_deltas(scene, vertex, u.next_1d());
        }

        let step = match main {
            Some(index) => draw(&at_vertex[index], vertex, uniforms(index))?,
            None => draw(&bsdf_alone, vertex, uniforms(MAX_TECHNIQUES - 1))?,
        };
        let share = match main {
            _ if step.delta => Share::All,
            Some(index) => Share::Technique { from: vertex.surface.p, index, densities: densities(step.wi) },
            None => Share::Nothing,
        };
        Some((step, share))
    }

    /// Light found at the end of a ray that does not go on.
    fn light_along(&self, scene: &Scene, ray: &Ray, share: Share) -> Rgb {
        match scene.geometry.intersect(ray) {
            None => self.environment(scene, ray, share),
            Some(hit) => self.emission(scene, ray, &hit, &scene.geometry.surface(ray, &hit), share),
        }
    }
}
