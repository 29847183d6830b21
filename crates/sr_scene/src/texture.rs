//! Textures: colours that vary over a surface.

use glam::Affine2;

use crate::{Rgb, diagnostic::Span};

/// A function of surface coordinates.
#[derive(Clone, Debug)]
pub enum TextureDesc {
    /// An image.
    Bitmap {
        /// Index into [`crate::SceneDesc::images`].
        image: u32,
        /// Between texels.
        filter: Filter,
        /// Outside [0, 1).
        wrap: Wrap,
        /// Are 8-bit values sRGB-encoded (colours), or linear already (roughness, bump, masks)?
        srgb: bool,
        /// Applied to the surface's (u, v) first. v = 0 is then the *top* row of the image: importers turn
        /// the coordinates of formats that count from the bottom.
        to_uv: Affine2,
        /// Where it was described.
        span: Span,
    },
    /// Two colours in squares: each unit square of texture space has 2 × 2 of them, `color0` at the origin.
    Checkerboard {
        /// The colour at the origin.
        color0: Rgb,
        /// The other colour.
        color1: Rgb,
        /// Applied to the surface's (u, v) first.
        to_uv: Affine2,
        /// Where it was described.
        span: Span,
    },
}

/// What happens between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Linear between the centres of four texels.
    Bilinear,
}

/// What happens outside the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The image is tiled.
    Repeat,
    /// The image is tiled, every other tile mirrored.
    Mirror,
    /// The border texel continues.
    Clamp,
}
