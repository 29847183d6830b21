//! The path tracer: `mis(bsdf, light)` under the power heuristic at every vertex.
//!
//! Kajiya (1986); multiple importance sampling after Veach & Guibas (1995).

use glam::Vec3;
use sr_bsdf::{AnyModel, Bsdf, BsdfSample, Mask};
use sr_geometry::{Ray, Surface};
use sr_sampling::{Cursor, Sequence, power_weight};
use sr_scene::Rgb;

use super::roulette::survive;
use super::{FIRST_DIMENSION, FirstHit, Integrator, PathLimits, PathSample, from_deltas, visible};
use crate::material::BsdfUser;
use crate::scene::Scene;
use crate::vertex::{Sight, Vertex};

/// Dimensions that a vertex uses: light choice, light (2), lobe, direction (2), roulette, delta light.
const DIMENSIONS_PER_VERTEX: u32 = 8;

/// Unidirectional path tracing with next-event estimation.
#[derive(Clone, Copy, Debug)]
pub struct PathTracer {
    /// How long paths are.
    pub limits: PathLimits,
}

/// The BSDF's part in finding what the next ray hits.
#[derive(Clone, Copy)]
struct Sampled {
    from: Vec3,
    pdf: f32,
}

impl Sampled {
    /// Weight of the BSDF's sample if light sampling finds the same with density `p_light`.
    #[inline]
    fn weight(last: Option<Self>, p_light: impl FnOnce(Vec3) -> f32) -> f32 {
        last.map_or(1.0, |s| power_weight(s.pdf, p_light(s.from)))
    }
}

impl Integrator for PathTracer {
    #[inline(always)]
    fn li<Q: Sequence>(&self, scene: &Scene, mut ray: Ray, u: &mut Cursor<'_, Q>) -> PathSample {
        let mut path = PathSample::default();
        let mut beta = Rgb::ONE;
        let mut eta = 1.0;
        // `None`: only this path can find what it hits, as from the camera or along a delta lobe.
        let mut last: Option<Sampled> = None;
        let mut depth = 0;
        loop {
            let Some(hit) = scene.geometry.intersect(&ray) else {
                if !(depth == 0 && self.limits.hide_emitters) {
                    path.li += beta
                        * match last {
                            None => scene.lights.environment(ray.direction, |_| 1.0),
                            Some(s) => scene.lights.environment_by_power(ray.direction, s.pdf),
                        };
                }
                break;
            };
            let surface = scene.geometry.surface(&ray, &hit);
            if let Some(light) = scene.light_of(hit.shape)
                && !(depth == 0 && self.limits.hide_emitters)
            {
                let le = scene.lights.emitted(light, &surface, -ray.direction, &scene.textures);
                if le != Rgb::ZERO {
                    let weight =
                        Sampled::weight(last, |from| scene.lights.pdf_of_point(light, from, &surface));
                    path.li += beta * le * weight;
                }
            }
            let first = (depth == 0).then_some((&mut path.first, hit.t));
            depth += 1;
            let ends = depth >= self.limits.max_depth;
            if ends && first.is_none() {
                break;
            }

            let (sight, side) = Sight::new(scene, &ray, &hit, &surface);
            let dimension = FIRST_DIMENSION + (depth - 1) * DIMENSIONS_PER_VERTEX;
            let mut direct = Rgb::ZERO;
            let visit = Visit {
                scene,
                surface: &surface,
                sight: &sight,
                first,
                ends,
                dimension,
                u,
                direct: &mut direct,
            };
            let next = scene.materials.with_bsdf(side, surface.uv, &scene.textures, visit);
            path.li += beta * direct;
            let Some(s) = next else { break };
            beta *= s.weight;
            eta *= s.eta;
            if depth >= self.limits.roulette_depth {
                u.seek(dimension + 6);
                let Some(share) = survive(beta, eta, u.next_1d()) else { break };
                beta *= share;
            }
            ray = surface.spawn_ray(s.wi);
            last = (!s.delta).then_some(Sampled { from: surface.p, pdf: s.pdf });
        }
        path
    }
}

/// What is done at a vertex, whatever its scattering model: light is gathered, and a direction drawn to go on.
struct Visit<'a, 'u, Q> {
    scene: &'a Scene,
    surface: &'a Surface,
    sight: &'a Sight,
    /// Where to note the first surface, and its distance.
    first: Option<(&'a mut Option<FirstHit>, f32)>,
    /// Is this the path's last vertex?
    ends: bool,
    dimension: u32,
    u: &'a mut Cursor<'u, Q>,
    /// Where to put the light that a sampled light sends to the vertex.
    direct: &'a mut Rgb,
}

impl<'m, Q: Sequence> BsdfUser<'m> for Visit<'_, '_, Q> {
    type Out = Option<BsdfSample>;

    #[inline(always)]
    fn call<B: Bsdf + Into<AnyModel<'m>>>(self, bsdf: B) -> Option<BsdfSample> {
        self.visit(&bsdf)
    }

    #[inline(never)]
    fn call_masked<B: Bsdf + Into<AnyModel<'m>>>(self, bsdf: Mask<B>) -> Option<BsdfSample> {
        self.visit(&bsdf)
    }
}

impl<Q: Sequence> Visit<'_, '_, Q> {
    #[inline(always)]
    fn visit<B: Bsdf>(self, bsdf: &B) -> Option<BsdfSample> {
        let vertex = Vertex { surface: self.surface, sight: self.sight, bsdf };
        if let Some((first, distance)) = self.first {
            *first = Some(FirstHit::new(&vertex, distance));
        }
        if self.ends {
            return None;
        }
        if vertex.lobes().smooth() {
            *self.direct = direct(self.scene, &vertex, self.dimension, self.u);
        }
        self.u.seek(self.dimension + 3);
        vertex.sample(self.u.next_1d(), self.u.next_2d())
    }
}

/// Next-event estimation: light that one sampled light sends to the vertex.
#[inline(always)]
fn direct<B: Bsdf, Q: Sequence>(
    scene: &Scene,
    vertex: &Vertex<'_, B>,
    dimension: u32,
    u: &mut Cursor<'_, Q>,
) -> Rgb {
    let from = vertex.surface;
    let mut sum = Rgb::ZERO;
    u.seek(dimension);
    if let Some(s) = scene.lights.sample(from.p, u.next_1d(), u.next_2d()) {
        let (f_cos, p_bsdf) = vertex.eval(s.wi);
        if f_cos != Rgb::ZERO && visible(scene, from, s.wi, s.target) {
            let radiance = scene.lights.radiance(&s, &scene.textures);
            sum += f_cos * radiance * (power_weight(s.pdf, p_bsdf) / s.pdf);
        }
    }
    if scene.lights.has_deltas() {
        u.seek(dimension + 7);
        sum += from_deltas(scene, vertex, u.next_1d());
    }
    sum
}
