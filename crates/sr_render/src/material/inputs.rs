//! What models of common kinds are made from, and where it comes from: constants and textures.

use sr_scene::{ColorInput, Rgb, ScalarInput, TextureId};

use crate::texture::{TexturePoint, Textures, luminance};

/// The most colours that a model takes.
pub(crate) const COLORS: usize = 3;
/// The most numbers that a model takes.
pub(crate) const SCALARS: usize = 3;

/// What a model is made from. What it does not take is 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inputs {
    pub colors: [Rgb; COLORS],
    pub scalars: [f32; SCALARS],
    /// How much of the surface is there: no part of the model.
    pub opacity: f32,
}

/// One of [`Inputs`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Input {
    Color(u8),
    Scalar(u8),
    Opacity,
}

/// An input that a texture has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Textured {
    pub input: Input,
    pub texture: TextureId,
}

impl Inputs {
    /// Takes what a texture shows: as a colour, of which what is negative is black, or as a number, the luminance.
    #[inline(always)]
    pub fn set(&mut self, input: Input, value: Rgb) {
        match input {
            Input::Color(i) => self.colors[i as usize % COLORS] = value.max(Rgb::ZERO),
            Input::Scalar(i) => self.scalars[i as usize % SCALARS] = luminance(value),
            Input::Opacity => self.opacity = luminance(value),
        }
    }
}

/// Where the colours and numbers of a model come from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sources {
    pub colors: [ColorInput; COLORS],
    pub scalars: [ScalarInput; SCALARS],
}

impl Sources {
    /// Those beyond what is given are 0.
    pub fn new(colors: &[ColorInput], scalars: &[ScalarInput]) -> Self {
        let mut sources = Self {
            colors: [ColorInput::Constant(Rgb::ZERO); COLORS],
            scalars: [ScalarInput::Constant(0.0); SCALARS],
        };
        sources.colors[..colors.len()].copy_from_slice(colors);
        sources.scalars[..scalars.len()].copy_from_slice(scalars);
        sources
    }

    /// What is the same everywhere, and what textures have, which is 0 in the former.
    pub fn split(&self, opacity: ScalarInput) -> (Inputs, Box<[Textured]>) {
        let mut textured = Vec::new();
        let mut color = |i, source| match source {
            ColorInput::Constant(color) => color,
            ColorInput::Texture(texture) => {
                textured.push(Textured { input: Input::Color(i), texture });
                Rgb::ZERO
            }
        };
        let [a, b, c] = self.colors;
        let colors = [color(0, a), color(1, b), color(2, c)];
        let mut scalar = |input, source| match source {
            ScalarInput::Constant(scalar) => scalar,
            ScalarInput::Texture(texture) => {
                textured.push(Textured { input, texture });
                0.0
            }
        };
        let [a, b, c] = self.scalars;
        let scalars = [scalar(Input::Scalar(0), a), scalar(Input::Scalar(1), b), scalar(Input::Scalar(2), c)];
        let opacity = scalar(Input::Opacity, opacity);
        (Inputs { colors, scalars, opacity }, textured.into())
    }

    /// All of them at a point, nothing being a hole.
    pub fn look_up(&self, at: &TexturePoint, textures: &Textures) -> Inputs {
        Inputs {
            colors: self.colors.map(|color| textures.color(color, *at)),
            scalars: self.scalars.map(|scalar| textures.scalar(scalar, *at)),
            opacity: 1.0,
        }
    }
}
