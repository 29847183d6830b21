//! Directions to lights from many points at a time.
//!
//! Pieces of lights (parallelograms, triangles of meshes, spheres, points of the image around the scene) are chosen one
//! by one, and become directions all together.

use glam::{BVec3, Vec2, Vec3};
use sr_geometry::{BATCH, Vec2s, Vec3s};
use sr_sampling::{Draw2D, PiecewiseConstant2D};
use sr_scene::Rgb;

use super::area::{Patch, Piece, sphere};
use super::environment::direction;
use super::{DeltaSample, LightId, LightSample, Lights, Target};

/// [`LightSample`]s from the points of a batch.
pub(crate) struct LightSamples {
    /// Directions.
    pub wi: Vec3s,
    /// Densities, in sr⁻¹; 0 where there is no sample.
    pub pdf: [f32; BATCH],
    /// The points on the lights, but for those infinitely far away.
    pub target: Vec3s,
    /// 1 for a light infinitely far away, else 0.
    pub is_far: [u32; BATCH],
    light: [u32; BATCH],
    uv: Vec2s,
    /// What samples are drawn from together.
    pieces: Pieces,
    /// Those that are drawn one by one.
    others: [u32; BATCH],
}

impl LightSamples {
    pub const NONE: Self = Self {
        wi: Vec3s::splat(Vec3::Z),
        pdf: [0.0; BATCH],
        target: Vec3s::splat(Vec3::ZERO),
        is_far: [0; BATCH],
        light: [0; BATCH],
        uv: Vec2s::splat(Vec2::ZERO),
        pieces: Pieces::NONE,
        others: [0; BATCH],
    };

    /// The sample from point `i`. There must be one.
    #[inline(always)]
    pub fn get(&self, i: usize) -> LightSample {
        let target = match self.is_far[i] {
            0 => Target::Point(self.target.get(i)),
            _ => Target::Infinity,
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
        set_target(&mut self.target, &mut self.is_far, i, s.target);
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
    /// 1 for a light infinitely far away, else 0.
    pub is_far: [u32; BATCH],
}

impl DeltaSamples {
    pub const NONE: Self = Self {
        wi: Vec3s::splat(Vec3::Z),
        radiance: Vec3s::splat(Rgb::ZERO),
        target: Vec3s::splat(Vec3::ZERO),
        is_far: [0; BATCH],
    };

    /// Replaces the sample from point `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, sample: Option<&DeltaSample>) {
        self.radiance.set(i, Rgb::ZERO);
        let Some(s) = sample else { return };
        self.wi.set(i, s.wi);
        self.radiance.set(i, s.radiance);
        set_target(&mut self.target, &mut self.is_far, i, s.target);
    }
}

#[inline(always)]
fn set_target(targets: &mut Vec3s, is_far: &mut [u32; BATCH], i: usize, target: Target) {
    match target {
        Target::Point(p) => {
            targets.set(i, p);
            is_far[i] = 0;
        }
        Target::Infinity => is_far[i] = 1,
    }
}

/// Pieces of lights, one for each point of a batch.
struct Pieces {
    /// How many there are of each form.
    patches: usize,
    balls: usize,
    skies: usize,
    /// A flat piece's corner, or the centre of a ball.
    corner: Vec3s,
    edges: [Vec3s; 2],
    normal: Vec3s,
    /// 1 for a triangle, 0 for a parallelogram.
    is_triangle: [u32; BATCH],
    /// Of a ball; 0 for others.
    radius: [f32; BATCH],
    /// Which points the image around the scene was chosen for, and what is drawn from it.
    at_sky: [u32; BATCH],
    draws: [Draw2D; BATCH],
    /// What the density of choosing a point of it is multiplied by. Of a flat piece, it has the inverse area in it; of
    /// the image around the scene, it is the density in the image.
    factor: [f32; BATCH],
}

impl Pieces {
    const NONE: Self = Self {
        patches: 0,
        balls: 0,
        skies: 0,
        corner: Vec3s::splat(Vec3::ZERO),
        edges: [const { Vec3s::splat(Vec3::ZERO) }; 2],
        normal: Vec3s::splat(Vec3::Z),
        is_triangle: [0; BATCH],
        radius: [0.0; BATCH],
        at_sky: [0; BATCH],
        draws: [Draw2D::NONE; BATCH],
        factor: [0.0; BATCH],
    };

    #[inline(always)]
    fn patch(&self, i: usize) -> Patch {
        Patch {
            corner: self.corner.get(i),
            edges: [self.edges[0].get(i), self.edges[1].get(i)],
            normal: self.normal.get(i),
            is_triangle: self.is_triangle[i] != 0,
        }
    }

    #[inline(always)]
    fn set_patch(&mut self, i: usize, patch: &Patch, pdf_area: f32) {
        self.patches += 1;
        self.corner.set(i, patch.corner);
        self.edges[0].set(i, patch.edges[0]);
        self.edges[1].set(i, patch.edges[1]);
        self.normal.set(i, patch.normal);
        self.is_triangle[i] = u32::from(patch.is_triangle);
        (self.radius[i], self.factor[i]) = (0.0, pdf_area);
    }

    #[inline(always)]
    fn set_ball(&mut self, i: usize, center: Vec3, radius: f32, pmf: f32) {
        self.balls += 1;
        self.corner.set(i, center);
        (self.radius[i], self.factor[i]) = (radius, pmf);
    }

    #[inline(always)]
    fn set_sky(&mut self, i: usize, pmf: f32) {
        self.at_sky[self.skies % BATCH] = i as u32;
        self.skies += 1;
        (self.radius[i], self.factor[i]) = (0.0, pmf);
    }

    /// Draws points of the image around the scene for those that it was chosen for: all take each step together, for
    /// most of their time is waiting for memory.
    #[inline(always)]
    fn draw_sky(&mut self, table: &PiecewiseConstant2D, u: &Vec2s, uv: &mut Vec2s) {
        let count = self.skies.min(BATCH);
        for k in 0..count {
            self.draws[k] = table.begin(u.get(self.at_sky[k] as usize % BATCH));
        }
        for k in 0..count {
            table.proceed(&mut self.draws[k], u.get(self.at_sky[k] as usize % BATCH));
        }
        for k in 0..count {
            let i = self.at_sky[k] as usize % BATCH;
            let s = table.finish(self.draws[k], u.get(i));
            uv.set(i, s.value);
            self.factor[i] *= s.pdf;
        }
    }
}

impl LightSamples {
    /// Takes the piece of a light for point `i`.
    #[inline(always)]
    fn take(&mut self, i: usize, piece: &Piece, pmf: f32, LightId(light): LightId) {
        self.light[i] = light;
        self.is_far[i] = 0;
        match piece {
            Piece::Patch(patch, pdf_area) => self.pieces.set_patch(i, patch, pmf * pdf_area),
            Piece::Ball { center, radius } => self.pieces.set_ball(i, *center, *radius, pmf),
            Piece::Sky => {
                self.pieces.set_sky(i, pmf);
                self.is_far[i] = 1;
            }
        }
    }
}

impl Lights {
    /// Asks for the memory that the radiance of sample `i` will be read from.
    #[inline(always)]
    pub(crate) fn prefetch_radiance(&self, samples: &LightSamples, i: usize) {
        if let Some(sky) = self.sky()
            && samples.is_far[i] != 0
        {
            sky.prefetch_radiance(samples.uv.get(i));
        }
    }

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
        let mut other_count = 0;
        (samples.pieces.patches, samples.pieces.balls, samples.pieces.skies) = (0, 0, 0);
        for i in 0..count {
            let mut is_piece = false;
            if let Some((id, pmf, rest)) = self.pick(u_pick[i])
                && let Some(piece) = self.piece(id, from.get(i), rest)
            {
                samples.take(i, &piece, pmf, id);
                is_piece = true;
            }
            samples.others[other_count % BATCH] = i as u32;
            other_count += usize::from(!is_piece);
        }
        let LightSamples { wi, pdf, target, is_far, uv, pieces, .. } = samples;
        if pieces.patches > 0 {
            for i in 0..count {
                let seen = pieces.patch(i).sample(pieces.factor[i], from.get(i), u.get(i));
                wi.set(i, seen.wi);
                pdf[i] = seen.pdf;
                target.set(i, seen.p);
            }
        }
        if pieces.balls > 0 {
            for i in 0..count {
                let (center, radius) = (pieces.corner.get(i), pieces.radius[i]);
                let seen = sphere::sample_cone(center, radius, from.get(i), u.get(i));
                let is_ball = radius > 0.0;
                wi.set(i, Vec3::select(BVec3::splat(is_ball), seen.wi, wi.get(i)));
                pdf[i] = if is_ball { seen.pdf * pieces.factor[i] } else { pdf[i] };
                target.set(i, Vec3::select(BVec3::splat(is_ball), seen.p, target.get(i)));
            }
        }
        if let Some(sky) = self.sky()
            && let Some(table) = sky.plain_table()
            && pieces.skies > 0
        {
            pieces.draw_sky(table, u, uv);
            let axes = sky.world_from_light();
            for i in 0..count {
                let (towards, pdf_towards) = direction(&axes, uv.get(i), pieces.factor[i]);
                let is_sky = is_far[i] != 0;
                wi.set(i, Vec3::select(BVec3::splat(is_sky), towards, wi.get(i)));
                pdf[i] = if is_sky { pdf_towards } else { pdf[i] };
            }
        }
        for k in 0..other_count.min(BATCH) {
            let i = samples.others[k] as usize % BATCH;
            samples.set(i, self.sample(from.get(i), u_pick[i], u.get(i)).as_ref());
        }
    }
}
