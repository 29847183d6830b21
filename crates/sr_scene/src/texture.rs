//! Textures: colours that vary over a surface.

use glam::Affine2;

use crate::{ColorInput, ScalarInput, diagnostic::Span};

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
        color0: ColorInput,
        /// The other colour.
        color1: ColorInput,
        /// Applied to the surface's (u, v) first.
        to_uv: Affine2,
        /// Where it was described.
        span: Span,
    },
    /// The product of two colours.
    Scale {
        /// One.
        input: ColorInput,
        /// The other.
        factor: ColorInput,
        /// Where it was described.
        span: Span,
    },
    /// Something between two colours.
    Mix {
        /// What is seen where the weight is 0.
        color0: ColorInput,
        /// What is seen where the weight is 1.
        color1: ColorInput,
        /// Brought into [0, 1].
        weight: ScalarInput,
        /// Where it was described.
        span: Span,
    },
    /// A color at another set of its mesh's texture coordinates; at the first one on what has no such set.
    OtherUvs {
        /// The color.
        input: ColorInput,
        /// 1: the first of [`crate::MeshDesc::further_uvs`]. Less than [`crate::MAX_UV_SETS`].
        set: u32,
        /// Where it was described.
        span: Span,
    },
    /// The colours of the mesh that it is on; grey (0.5) on what has none. Lights cannot have it.
    MeshColor {
        /// Which of them.
        of: MeshColorOf,
        /// What they are multiplied by.
        scale: f32,
        /// Where it was described.
        span: Span,
    },
}

/// Colours of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshColorOf {
    /// [`crate::MeshDesc::vertex_colors`], linear between vertices.
    Vertices,
    /// [`crate::MeshDesc::face_colors`].
    Faces,
}

/// What happens between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Linear between the centres of four texels.
    Bilinear,
    /// Bilinear in two copies of the image whose texels are about as large as what a pixel sees, and linear between
    /// these.
    Mipmap,
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
