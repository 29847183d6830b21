//! Directions to lights from many points at a time.
//!
//! Flat pieces of lights (a parallelogram, or a triangle of a mesh) are chosen one by one, and sampled all together.

use glam::{Vec2, Vec3};
use sr_geometry::{BATCH, Vec2s, Vec3s};
use sr_scene::Rgb;

use super::area::Patch;
use super::{DeltaSample, LightId, LightSample, Lights, Target};

/// [`LightSample`]s from the points of a batch.
pub(crate) struct LightSamples {
    /// Directions.
    pub wi: Vec3s,
    /// Densities, in sr⁻¹; 0 where there is no sample.
    pub pdf: [f32; BATCH],
    /// The points on the lights, but for those infinitely far away.
    pub target: Vec3s,
    /// How far along the direction to the light shadow rays go: 1, or infinitely far.
    pub t_end: [f32; BATCH],
    light: [u32; BATCH],
    uv: Vec2s,
    /// What the samples are drawn from.
    patches: Patches,
}

impl LightSamples {
    pub const NONE: Self = Self {
        wi: Vec3s::splat(Vec3::Z),
        pdf: [0.0; BATCH],
        target: Vec3s::splat(Vec3::ZERO),
        t_end: [1.0; BATCH],
        light: [0; BATCH],
        uv: Vec2s::splat(Vec2::ZERO),
        patches: Patches::NONE,
    };

    /// The sample from point `i`. There must be one.
    #[inline(always)]
    pub fn get(&self, i: usize) -> LightSample {
        let target = match self.t_end[i] {
            f32::INFINITY => Target::Infinity,
            _ => Target::Point(self.target.get(i)),
        };
        let (wi, pdf) = (self.wi.get(i), self.pdf[i]);
        LightSample { wi, pdf, target, light: LightId(self.light[i]), uv: self.uv.get(i) }
    }

    #[inline(always)]
    fn set(&mut self, i: usize, sample: Option<&LightSample>) {
        self.pdf[i] = 0.0;
        let Some(s) = sample else { return };
        self.wi.set(i, s.wi);
        self.pdf[i] = s.pdf;
        set_target(&mut self.target, &mut self.t_end, i, s.target);
        self.light[i] = s.light.0;
        self.uv.set(i, s.uv);
    }
}

/// [`DeltaSample`]s from the points of a batch.
pub(crate) struct DeltaSamples {
    /// Directions.
    pub wi: Vec3s,
    /// Radiance over density; 0 where there is no sample.
    pub radiance: Vec3s,
    /// The points on the lights, but for those infinitely far away.
    pub target: Vec3s,
    /// As in [`LightSamples`].
    pub t_end: [f32; BATCH],
}

impl DeltaSamples {
    pub const NONE: Self = Self {
        wi: Vec3s::splat(Vec3::Z),
        radiance: Vec3s::splat(Rgb::ZERO),
        target: Vec3s::splat(Vec3::ZERO),
        t_end: [1.0; BATCH],
    };

    /// Replaces the sample from point `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, sample: Option<&DeltaSample>) {
        self.radiance.set(i, Rgb::ZERO);
        let Some(s) = sample else { return };
        self.wi.set(i, s.wi);
        self.radiance.set(i, s.radiance);
        set_target(&mut self.target, &mut self.t_end, i, s.target);
    }
}

#[inline(always)]
fn set_target(targets: &mut Vec3s, t_end: &mut [f32; BATCH], i: usize, target: Target) {
    match target {
        Target::Point(p) => {
            targets.set(i, p);
            t_end[i] = 1.0;
        }
        Target::Infinity => t_end[i] = f32::INFINITY,
    }
}

/// Flat pieces of lights, one for each point of a batch.
struct Patches {
    corner: Vec3s,
    edges: [Vec3s; 2],
    normal: Vec3s,
    /// 1 for a triangle, 0 for a parallelogram.
    is_triangle: [u32; BATCH],
    /// The density of choosing a point of it, choices among pieces and lights included, in the inverse of a square
    /// unit of length.
    pdf_area: [f32; BATCH],
    light: [u32; BATCH],
}

impl Patches {
    const NONE: Self = Self {
        corner: Vec3s::splat(Vec3::ZERO),
        edges: [const { Vec3s::splat(Vec3::ZERO) }; 2],
        normal: Vec3s::splat(Vec3::Z),
        is_triangle: [0; BATCH],
        pdf_area: [0.0; BATCH],
        light: [0; BATCH],
    };

    #[inline(always)]
    fn get(&self, i: usize) -> Patch {
        Patch {
            corner: self.corner.get(i),
            edges: [self.edges[0].get(i), self.edges[1].get(i)],
            normal: self.normal.get(i),
            is_triangle: self.is_triangle[i] != 0,
        }
    }

    #[inline(always)]
    fn set(&mut self, i: usize, patch: &Patch, pdf_area: f32, light: LightId) {
        self.corner.set(i, patch.corner);
        self.edges[0].set(i, patch.edges[0]);
        self.edges[1].set(i, patch.edges[1]);
        self.normal.set(i, patch.normal);
        self.is_triangle[i] = u32::from(patch.is_triangle);
        self.pdf_area[i] = pdf_area;
        self.light[i] = light.0;
    }
}

impl Lights {
    /// [`Lights::sample`] from each of the first `count` points, with the uniforms of the same place.
    #[inline(always)]
    pub(crate) fn sample_batch(
        &self,
        (from, count): (&Vec3s, usize),
        u_pick: &[f32; BATCH],
        u: &Vec2s,
        samples: &mut LightSamples,
    ) {
        let count = count.min(BATCH);
        let (mut others, mut other_count) = ([0_u32; BATCH], 0);
        for i in 0..count {
            let mut is_flat = false;
            if let Some((id, pmf, rest)) = self.pick(u_pick[i])
                && let Some((patch, pdf_area)) = self.patch(id, rest)
            {
                samples.patches.set(i, &patch, pmf * pdf_area, id);
                is_flat = true;
            }
            others[other_count % BATCH] = i as u32;
            other_count += usize::from(!is_flat);
        }
        for i in 0..count {
            let patches = &samples.patches;
            let s = patches.get(i).sample(patches.pdf_area[i], from.get(i), u.get(i));
            samples.wi.set(i, s.wi);
            samples.pdf[i] = s.pdf;
            samples.target.set(i, s.p);
            samples.t_end[i] = 1.0;
            samples.light[i] = samples.patches.light[i];
        }
        for &i in &others[..other_count] {
            let i = i as usize % BATCH;
            samples.set(i, self.sample(from.get(i), u_pick[i], u.get(i)).as_ref());
        }
    }
}
