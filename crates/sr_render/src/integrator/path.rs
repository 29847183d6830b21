//! The path tracer: `mis(bsdf, light)` under the power heuristic at every vertex.
//!
//! Kajiya (1986); multiple importance sampling after Veach & Guibas (1995).

use glam::Vec3;
use sr_geometry::Ray;
use sr_sampling::{Cursor, Sequence, power_weight};
use sr_scene::Rgb;

use super::roulette::survive;
use super::{FIRST_DIMENSION, FirstHit, Integrator, PathLimits, PathSample, from_deltas, visible};
use crate::scene::Scene;
use crate::vertex::Vertex;

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
    #[inline]
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
            let vertex = Vertex::new(scene, &ray, &hit, surface);
            if depth == 0 {
                path.first = Some(FirstHit::new(&vertex, hit.t));
            }
            depth += 1;
            if depth >= self.limits.max_depth {
                break;
            }

            let dimension = FIRST_DIMENSION + (depth - 1) * DIMENSIONS_PER_VERTEX;
            if vertex.lobes().smooth() {
                path.li += beta * direct(scene, &vertex, dimension, u);
            }

            u.seek(dimension + 3);
            let Some(s) = vertex.sample(u.next_1d(), u.next_2d()) else { break };
            beta *= s.weight;
            eta *= s.eta;
            if depth >= self.limits.roulette_depth {
                let Some(share) = survive(beta, eta, u.next_1d()) else { break };
                beta *= share;
            }
            ray = surface.spawn_ray(s.wi);
            last = (!s.delta).then_some(Sampled { from: surface.p, pdf: s.pdf });
        }
        path
    }
}

/// Next-event estimation: light that one sampled light sends to the vertex.
#[inline]
fn direct<Q: Sequence>(scene: &Scene, vertex: &Vertex<'_>, dimension: u32, u: &mut Cursor<'_, Q>) -> Rgb {
    let from = &vertex.surface;
    let mut sum = Rgb::ZERO;
    u.seek(dimension);
    if let Some(s) = scene.lights.sample(from.p, u.next_1d(), u.next_2d(), &scene.textures) {
        let (f_cos, p_bsdf) = vertex.eval(s.wi);
        if f_cos != Rgb::ZERO && visible(scene, from, &s) {
            sum += f_cos * s.radiance * (power_weight(s.pdf, p_bsdf) / s.pdf);
        }
    }
    if scene.lights.has_deltas() {
        u.seek(dimension + 7);
        sum += from_deltas(scene, vertex, u.next_1d());
    }
    sum
}
