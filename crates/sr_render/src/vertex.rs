//! A path's vertex on a surface: where it is, which way it faces, how it scatters.
//!
//! In: a ray and its hit. Out: a [`Sight`], and with a scattering model a [`Vertex`], which speaks world-space
//! directions to the integrator and local ones to the BSDF.

use glam::{Vec2, Vec3};
use sr_bsdf::{AnyBsdf, Bsdf, BsdfSample, Lobes};
use sr_geometry::{Hit, Ray, Surface};
use sr_scene::Rgb;

use crate::material::{Face, Place, Room};
use crate::scene::Scene;
use crate::texture::TexturePoint;

/// An orthonormal frame with `n` as its +Z; left-handed behind surfaces whose tangents matter.
#[derive(Clone, Copy, Debug)]
struct Frame {
    s: Vec3,
    t: Vec3,
    n: Vec3,
}

impl Frame {
    /// Any tangents (Duff et al. 2017).
    #[inline(always)]
    fn about(n: Vec3) -> Self {
        let (s, t) = n.any_orthonormal_pair();
        Self { s, t, n }
    }

    /// The tangent as close to `dpdu` as can be.
    fn along(n: Vec3, dpdu: Vec3) -> Self {
        match (dpdu - n * n.dot(dpdu)).try_normalize() {
            Some(s) => Self { s, t: n.cross(s), n },
            None => Self::about(n),
        }
    }

    #[inline(always)]
    fn to_local(self, w: Vec3) -> Vec3 {
        Vec3::new(w.dot(self.s), w.dot(self.t), w.dot(self.n))
    }

    #[inline(always)]
    fn to_world(self, w: Vec3) -> Vec3 {
        self.s * w.x + self.t * w.y + self.n * w.z
    }
}

/// How a surface point is seen from where the path came from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    frame: Frame,
    /// Towards where the path came from, in the frame.
    wo: Vec3,
}

impl Sight {
    /// Of a hit, seen along `ray`, and the scattering model of the side of the material that is seen;
    /// `at` is where its textures are looked up, and a blend is made in `room`.
    #[inline]
    pub fn with_model<'a>(
        scene: &'a Scene,
        ray: &Ray,
        hit: &Hit,
        surface: &Surface,
        at: TexturePoint,
        room: &'a mut Room<'a>,
    ) -> (Self, AnyBsdf<'a>) {
        let (wo, normal) = (-ray.direction, surface.ns);
        let Face { side, turn, .. } =
            scene.materials.face(scene.material_of(hit.shape), wo.dot(normal) < 0.0);
        let side = scene.materials.side(side);
        let (mut frame, mut tangents) = (Frame::about(normal * turn), [Vec3::ZERO; 2]);
        if side.needs_tangents {
            let world = scene.geometry.tangents(surface, hit);
            // The back is the front's mirror image: the tangents stay.
            frame = Frame { n: normal * turn, ..Frame::along(normal, world.dpdu) };
            tangents = [world.dpdu, world.dpdv].map(|w| frame.to_local(w));
        }
        let place = Place { textures: &scene.textures, at, wo: frame.to_local(wo), tangents };
        (Self { wo: place.wo, frame }, scene.materials.bsdf(side, &place, room))
    }

    /// Of a surface with normal `n` whose model does not tell the tangent from the bitangent, seen from where `wo`
    /// points, in world space.
    #[inline(always)]
    pub fn towards_viewer(n: Vec3, wo: Vec3) -> Self {
        let frame = Frame::about(n);
        Self { wo: frame.to_local(wo), frame }
    }

    /// f · |cos θ| and the density with which `bsdf` samples `wi`, a direction in world space.
    #[inline(always)]
    pub fn eval<B: Bsdf>(&self, bsdf: &B, wi: Vec3) -> (Rgb, f32) {
        let local = self.frame.to_local(wi);
        (bsdf.eval(self.wo, local) * local.z.abs(), bsdf.pdf(self.wo, local))
    }

    /// f · |cos θ| for a direction in world space.
    #[inline(always)]
    pub fn f_cos<B: Bsdf>(&self, bsdf: &B, wi: Vec3) -> Rgb {
        let local = self.frame.to_local(wi);
        bsdf.eval(self.wo, local) * local.z.abs()
    }

    /// A direction in world space, as `bsdf` samples it.
    #[inline(always)]
    pub fn sample<B: Bsdf>(&self, bsdf: &B, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let mut s = bsdf.sample(self.wo, u_lobe, u)?;
        s.wi = self.frame.to_world(s.wi);
        Some(s)
    }
}

/// A surface point with its scattering model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<'a, B> {
    pub surface: &'a Surface,
    pub sight: &'a Sight,
    pub bsdf: &'a B,
}

impl<B: Bsdf> Vertex<'_, B> {
    #[inline]
    pub fn lobes(&self) -> Lobes {
        self.bsdf.lobes()
    }

    /// [`Sight::eval`].
    #[inline(always)]
    pub fn eval(&self, wi: Vec3) -> (Rgb, f32) {
        self.sight.eval(self.bsdf, wi)
    }

    /// [`Sight::f_cos`].
    #[inline(always)]
    pub fn f_cos(&self, wi: Vec3) -> Rgb {
        self.sight.f_cos(self.bsdf, wi)
    }

    /// [`Sight::sample`].
    #[inline(always)]
    pub fn sample(&self, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        self.sight.sample(self.bsdf, u_lobe, u)
    }

    /// The cosine of a world-space direction with the shading normal.
    #[inline]
    pub fn cos(&self, wi: Vec3) -> f32 {
        wi.dot(self.sight.frame.n)
    }

    /// A local direction in world space.
    #[inline]
    pub fn world_from_local(&self, local: Vec3) -> Vec3 {
        self.sight.frame.to_world(local)
    }
}

impl Vertex<'_, AnyBsdf<'_>> {
    /// The shading normal, on the viewer's side of a two-sided material, with its bumps.
    pub fn normal(&self) -> Vec3 {
        self.sight.frame.to_world(self.bsdf.normal())
    }
}
