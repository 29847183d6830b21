//! Vertices whose scattering models are of one kind, side by side, and the loops that serve them.

use glam::{Vec2, Vec3};
use sr_bsdf::{Bsdf, Mask};
use sr_geometry::{BATCH, Vec2s, Vec3s};
use sr_scene::Rgb;

use super::Step;
use super::state::{Scattered, Towards};
use crate::material::{COLORS, Input, Inputs, Recipe, RecipeUser, SCALARS};
use crate::texture::luminance;
use crate::vertex::Sight;

/// Paths that the widest vector instructions serve at a time.
const LANES: usize = 16;

/// Vertices of one kind.
pub(super) struct Bin {
    pub count: usize,
    /// Normals, and directions to where the paths came from.
    pub normal: Vec3s,
    pub wo: Vec3s,
    /// What the models are made from.
    pub colors: [Vec3s; COLORS],
    pub scalars: [[f32; BATCH]; SCALARS],
    pub opacity: [f32; BATCH],
    /// Directions to lights with an extent, and to those without.
    pub light: Vec3s,
    pub delta: Vec3s,
    /// Uniforms.
    pub u_lobe: [f32; BATCH],
    pub u: Vec2s,
    /// The models' answers.
    pub albedo: Vec3s,
    pub to_light: Towards,
    pub to_delta: Vec3s,
    pub scattered: Scattered,
}

impl Bin {
    pub const NONE: Self = Self {
        count: 0,
        normal: Vec3s::splat(Vec3::Z),
        wo: Vec3s::splat(Vec3::Z),
        colors: [const { Vec3s::splat(Rgb::ZERO) }; COLORS],
        scalars: [[0.0; BATCH]; SCALARS],
        opacity: [1.0; BATCH],
        light: Vec3s::splat(Vec3::Z),
        delta: Vec3s::splat(Vec3::Z),
        u_lobe: [0.0; BATCH],
        u: Vec2s::splat(Vec2::ZERO),
        albedo: Vec3s::splat(Rgb::ZERO),
        to_light: Towards::NONE,
        to_delta: Vec3s::splat(Rgb::ZERO),
        scattered: Scattered::NONE,
    };

    /// Whole vectors that hold all vertices. Arrays have leftovers in the lanes beyond.
    #[inline(always)]
    fn lanes(&self) -> usize {
        self.count.next_multiple_of(LANES).min(BATCH)
    }

    #[inline(always)]
    pub fn set_inputs(&mut self, k: usize, Inputs { colors, scalars, opacity }: &Inputs) {
        for (all, &color) in self.colors.iter_mut().zip(colors) {
            all.set(k, color);
        }
        for (all, &scalar) in self.scalars.iter_mut().zip(scalars) {
            all[k] = scalar;
        }
        self.opacity[k] = *opacity;
    }

    /// One of them, which a texture has.
    #[inline(always)]
    pub fn set_input(&mut self, k: usize, input: Input, value: Rgb) {
        match input {
            Input::Color(i) => self.colors[i as usize % COLORS].set(k, value.max(Rgb::ZERO)),
            Input::Scalar(i) => self.scalars[i as usize % SCALARS][k] = luminance(value),
            Input::Opacity => self.opacity[k] = luminance(value),
        }
    }

    #[inline(always)]
    fn model<R: Recipe>(&self, recipe: R, k: usize) -> Mask<R::Model> {
        let colors = [self.colors[0].get(k), self.colors[1].get(k), self.colors[2].get(k)];
        let scalars = [self.scalars[0][k], self.scalars[1][k], self.scalars[2][k]];
        let opacity = self.opacity[k];
        Mask::new(opacity, recipe.model(&Inputs { colors, scalars, opacity }))
    }

    #[inline(always)]
    fn sight(&self, k: usize) -> Sight {
        Sight::towards_viewer(self.normal.get(k), self.wo.get(k))
    }
}

/// Asks the models of a bin.
pub(super) struct Serve<'b> {
    pub bin: &'b mut Bin,
    pub step: &'b Step,
    pub has_deltas: bool,
}

impl RecipeUser for Serve<'_> {
    type Out = ();

    #[inline(always)]
    fn call<R: Recipe>(self, recipe: R) {
        let Self { bin, step, has_deltas } = self;
        let lanes = bin.lanes();
        if step.first {
            for k in 0..lanes {
                bin.albedo.set(k, bin.model(recipe, k).albedo());
            }
        }
        if step.last {
            return;
        }
        for k in 0..lanes {
            let (model, sight) = (bin.model(recipe, k), bin.sight(k));
            bin.to_light.set(k, sight.eval(&model, bin.light.get(k)));
            bin.scattered.set(k, sight.sample(&model, bin.u_lobe[k], bin.u.get(k)));
        }
        if has_deltas {
            for k in 0..lanes {
                bin.to_delta.set(k, bin.sight(k).f_cos(&bin.model(recipe, k), bin.delta.get(k)));
            }
        }
    }
}
