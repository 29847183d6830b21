//! What is known of the paths of a batch: of each path, and of the vertex at which it is.

use glam::{Vec2, Vec3};
use sr_bsdf::BsdfSample;
use sr_geometry::{BATCH, Hits, Rays, Surfaces, Vec2s, Vec3s};
use sr_sampling::{Cursor, SampleId, Sequence};
use sr_scene::Rgb;

use super::super::CameraRays;
use super::bin::Bin;
use super::lookups::Lookups;
use super::queues::Queues;
use crate::light::{DeltaSamples, LightSamples};
use crate::texture::RayCone;

/// Paths on their way. They lie close together; one that ends makes room for the last one.
pub(super) struct Paths<Q> {
    /// How many there are.
    pub count: usize,
    /// The next edges.
    pub rays: Rays,
    /// Throughputs.
    pub beta: Vec3s,
    /// Index of refraction where the path is, over that at the camera.
    pub eta: [f32; BATCH],
    /// Where the rays come from.
    pub from: Vec3s,
    /// The densities, in sr⁻¹, with which the rays were drawn; infinite where nothing else could have found what they
    /// hit: from the camera, and along delta lobes.
    pub pdf: [f32; BATCH],
    /// Widths of the rays where they start: [`RayCone::width`].
    width: [f32; BATCH],
    /// [`RayCone::spread`].
    spread: f32,
    /// Which of the batch's samples each is.
    pub slot: [u32; BATCH],
    pixel: [u32; BATCH],
    index: [u32; BATCH],
    sequence: [Q; BATCH],
}

impl<Q: Sequence> Paths<Q> {
    /// No paths.
    pub fn none(sequence: Q) -> Self {
        Self {
            count: 0,
            rays: Rays::NONE,
            beta: Vec3s::splat(Rgb::ONE),
            eta: [1.0; BATCH],
            from: Vec3s::splat(Vec3::ZERO),
            pdf: [f32::INFINITY; BATCH],
            width: [0.0; BATCH],
            spread: 0.0,
            slot: [0; BATCH],
            pixel: [0; BATCH],
            index: [0; BATCH],
            sequence: [sequence; BATCH],
        }
    }

    /// Starts a path along each camera ray.
    #[inline(always)]
    pub fn start(&mut self, camera: &CameraRays<Q>) {
        self.count = camera.count;
        self.spread = camera.cone.spread;
        for i in 0..camera.count.min(BATCH) {
            self.rays.set(i, &camera.rays.get(i));
            self.beta.set(i, Rgb::ONE);
            (self.eta[i], self.pdf[i], self.width[i]) = (1.0, f32::INFINITY, camera.cone.width);
            (self.slot[i], self.pixel[i], self.index[i]) = (i as u32, camera.pixel[i], camera.index[i]);
            self.sequence[i] = camera.sequence[i];
        }
    }

    /// How wide a ray is.
    #[inline(always)]
    pub fn cone(&self, i: usize) -> RayCone {
        RayCone { width: self.width[i], spread: self.spread }
    }

    /// How wide the rays are that go on from `distances`; `pdf` is infinite for those along delta lobes.
    #[inline(always)]
    pub fn widen(&mut self, distances: &[f32; BATCH], pdf: &[f32; BATCH]) {
        for i in 0..self.count.min(BATCH) {
            self.width[i] = self.cone(i).after(distances[i], pdf[i] == f32::INFINITY).width;
        }
    }

    /// The uniforms of one path, from a dimension on.
    #[inline(always)]
    pub fn cursor(&self, i: usize, dimension: u32) -> Cursor<'_, Q> {
        let at = SampleId { pixel: self.pixel[i], index: self.index[i] };
        Cursor::new(&self.sequence[i], at).at(dimension)
    }

    /// One dimension of all paths.
    #[inline(always)]
    pub fn uniforms_1d(&self, dimension: u32, u: &mut [f32; BATCH]) {
        for i in 0..self.count.min(BATCH) {
            u[i] = self.cursor(i, dimension).next_1d();
        }
    }

    /// Two dimensions of all paths.
    #[inline(always)]
    pub fn uniforms_2d(&self, dimension: u32, u: &mut Vec2s) {
        for i in 0..self.count.min(BATCH) {
            u.set(i, self.cursor(i, dimension).next_2d());
        }
    }

    /// Puts the last path in the place of path `i`, which has ended.
    #[inline(always)]
    pub fn end(&mut self, i: usize) {
        self.count -= 1;
        let last = self.count;
        self.rays.set(i, &self.rays.get(last));
        self.beta.set(i, self.beta.get(last));
        self.from.set(i, self.from.get(last));
        (self.eta[i], self.pdf[i], self.width[i]) = (self.eta[last], self.pdf[last], self.width[last]);
        (self.slot[i], self.pixel[i], self.index[i]) = (self.slot[last], self.pixel[last], self.index[last]);
        self.sequence[i] = self.sequence[last];
    }
}

/// The vertices at which the paths of a batch are. Arrays hold leftovers where a path has ended.
pub(super) struct Vertices {
    pub hits: Hits,
    pub surfaces: Surfaces,
    /// Shading normals, turned to the viewer where a surface has two sides.
    pub normal: Vec3s,
    /// Albedos of Lambertian surfaces.
    pub albedo: Vec3s,
    /// Those at which textures are looked up.
    pub lookups: Lookups,
    /// Which loop serves which vertex.
    pub queues: Queues,
    /// Those of one kind, side by side.
    pub bin: Bin,
    /// Samples of the lights with an extent, and of those without.
    pub lights: LightSamples,
    pub deltas: DeltaSamples,
    pub to_light: Towards,
    pub to_delta: Towards,
    /// Uniforms for the choice among lobes.
    pub u_lobe: [f32; BATCH],
    pub shadow: Shadow,
    pub scattered: Scattered,
}

impl Vertices {
    pub const NONE: Self = Self {
        hits: Hits::NONE,
        surfaces: Surfaces::NONE,
        normal: Vec3s::splat(Vec3::Z),
        albedo: Vec3s::splat(Rgb::ZERO),
        lookups: Lookups::NONE,
        queues: Queues::EMPTY,
        bin: Bin::NONE,
        lights: LightSamples::NONE,
        deltas: DeltaSamples::NONE,
        to_light: Towards::NONE,
        to_delta: Towards::NONE,
        u_lobe: [0.0; BATCH],
        shadow: Shadow::NONE,
        scattered: Scattered::NONE,
    };
}

/// The scattering models' answers for directions towards lights.
pub(super) struct Towards {
    /// f · |cos θ|.
    pub f_cos: Vec3s,
    /// The density, in sr⁻¹, with which the model would have sampled the direction.
    pub pdf: [f32; BATCH],
}

impl Towards {
    pub const NONE: Self = Self { f_cos: Vec3s::splat(Rgb::ZERO), pdf: [0.0; BATCH] };

    /// Replaces one of them.
    #[inline(always)]
    pub fn set(&mut self, i: usize, (f_cos, pdf): (Rgb, f32)) {
        self.f_cos.set(i, f_cos);
        self.pdf[i] = pdf;
    }
}

/// Light on its way to vertices, and the rays that find out whether it arrives.
pub(super) struct Shadow {
    /// What each path would gain, over the light's radiance.
    pub arriving: Vec3s,
    /// The vertices for which it matters, and then those at which it arrives.
    pub list: List,
    /// Shadow rays, in the order of the list.
    pub rays: Rays,
    pub occluded: [bool; BATCH],
}

impl Shadow {
    const NONE: Self = Self {
        arriving: Vec3s::splat(Rgb::ZERO),
        list: List::EMPTY,
        rays: Rays::NONE,
        occluded: [false; BATCH],
    };
}

/// The directions in which paths go on: the fields of [`sr_bsdf::BsdfSample`].
pub(super) struct Scattered {
    pub wi: Vec3s,
    /// Zero where a path ends.
    pub weight: Vec3s,
    /// Infinite for a delta lobe.
    pub pdf: [f32; BATCH],
    pub eta: [f32; BATCH],
    /// Uniforms for the directions.
    pub u: Vec2s,
}

impl Scattered {
    pub const NONE: Self = Self {
        wi: Vec3s::splat(Vec3::Z),
        weight: Vec3s::splat(Rgb::ZERO),
        pdf: [0.0; BATCH],
        eta: [1.0; BATCH],
        u: Vec2s::splat(Vec2::ZERO),
    };

    /// Replaces one of them.
    #[inline(always)]
    pub fn set(&mut self, i: usize, sample: Option<BsdfSample>) {
        match sample {
            Some(s) => {
                self.wi.set(i, s.wi);
                self.weight.set(i, s.weight);
                self.pdf[i] = if s.delta { f32::INFINITY } else { s.pdf };
                self.eta[i] = s.eta;
            }
            None => {
                self.wi.set(i, Vec3::Z);
                self.weight.set(i, Rgb::ZERO);
                self.pdf[i] = 0.0;
                self.eta[i] = 1.0;
            }
        }
    }

    /// Replaces one of them by one of others.
    #[inline(always)]
    pub fn copy(&mut self, i: usize, from: &Self, k: usize) {
        self.wi.set(i, from.wi.get(k));
        self.weight.set(i, from.weight.get(k));
        (self.pdf[i], self.eta[i]) = (from.pdf[k], from.eta[k]);
    }
}

/// Some of the paths of a batch.
pub(super) struct List {
    indices: [u32; BATCH],
    count: usize,
}

impl List {
    pub const EMPTY: Self = Self { indices: [0; BATCH], count: 0 };

    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds `i` if `condition`, without a branch. At most [`BATCH`] calls may follow [`List::clear`].
    #[inline(always)]
    pub fn push_if(&mut self, condition: bool, i: usize) {
        self.indices[self.count % BATCH] = i as u32;
        self.count += usize::from(condition);
    }

    pub fn len(&self) -> usize {
        self.count
    }

    /// The `k`-th, in a way that shows compilers that it is below [`BATCH`].
    #[inline(always)]
    pub fn get(&self, k: usize) -> usize {
        self.indices[k] as usize % BATCH
    }

    /// Keeps those whose number in the list fulfils a condition.
    #[inline(always)]
    pub fn keep(&mut self, condition: impl Fn(usize) -> bool) {
        let count = self.count.min(BATCH);
        self.count = 0;
        for k in 0..count {
            self.push_if(condition(k), self.indices[k] as usize);
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = usize> {
        self.indices[..self.count].iter().map(|&i| i as usize % BATCH)
    }
}
