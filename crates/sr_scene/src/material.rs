//! Materials: which scattering model, with which colours.

use crate::{MaterialId, Rgb, TextureId};

/// A colour, constant or textured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorInput {
    /// The same everywhere.
    Constant(Rgb),
    /// Looked up at the surface's (u, v).
    Texture(TextureId),
}

/// A number, constant or textured (then the luminance of the texture, Rec. 709 weights).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScalarInput {
    /// The same everywhere.
    Constant(f32),
    /// Looked up at the surface's (u, v).
    Texture(TextureId),
}

/// The distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MicrofacetKind {
    /// Beckmann: Gaussian slopes.
    Beckmann,
    /// GGX, also called Trowbridge–Reitz: longer tails.
    Ggx,
}

/// A scattering model and its inputs. `eta` is always interior over exterior index of refraction.
#[derive(Clone, Debug)]
pub enum MaterialDesc {
    /// Lambertian reflection, on the front only.
    Diffuse {
        /// Albedo.
        reflectance: ColorInput,
    },
    /// A smooth interface between two dielectrics.
    Dielectric {
        /// Interior over exterior index.
        eta: f32,
        /// Scales reflection; physically 1.
        specular_reflectance: ColorInput,
        /// Scales transmission; physically 1.
        specular_transmittance: ColorInput,
    },
    /// A thin plate of a dielectric: reflects, and transmits without bending.
    ThinDielectric {
        /// Interior over exterior index.
        eta: f32,
        /// Scales reflection; physically 1.
        specular_reflectance: ColorInput,
        /// Scales transmission; physically 1.
        specular_transmittance: ColorInput,
    },
    /// A rough interface between two dielectrics (Walter et al. 2007).
    RoughDielectric {
        /// Microfacet distribution.
        kind: MicrofacetKind,
        /// Roughness along the tangent and the bitangent.
        alpha: [ScalarInput; 2],
        /// Interior over exterior index.
        eta: f32,
        /// Scales reflection; physically 1.
        specular_reflectance: ColorInput,
        /// Scales transmission; physically 1.
        specular_transmittance: ColorInput,
    },
    /// A smooth metal.
    Conductor {
        /// Real part of the index over the exterior's; `None` (with `k`) is a perfect mirror.
        eta_k: Option<(ColorInput, ColorInput)>,
        /// Scales reflection; physically 1.
        specular_reflectance: ColorInput,
    },
    /// A rough metal.
    RoughConductor {
        /// Microfacet distribution.
        kind: MicrofacetKind,
        /// Roughness along the tangent and the bitangent.
        alpha: [ScalarInput; 2],
        /// Complex index; `None` reflects everything.
        eta_k: Option<(ColorInput, ColorInput)>,
        /// Scales reflection; physically 1.
        specular_reflectance: ColorInput,
    },
    /// A smooth dielectric coating over a diffuse base.
    Plastic {
        /// Interior over exterior index.
        eta: f32,
        /// Albedo of the base.
        diffuse_reflectance: ColorInput,
        /// Scales reflection; physically 1.
        specular_reflectance: ColorInput,
        /// Does the base's colour saturate by interreflection below the coating?
        nonlinear: bool,
    },
    /// A rough dielectric coating over a diffuse base.
    RoughPlastic {
        /// Microfacet distribution.
        kind: MicrofacetKind,
        /// Roughness.
        alpha: f32,
        /// Interior over exterior index.
        eta: f32,
        /// Albedo of the base.
        diffuse_reflectance: ColorInput,
        /// Scales reflection; physically 1.
        specular_reflectance: ColorInput,
        /// Does the base's colour saturate by interreflection below the coating?
        nonlinear: bool,
    },
    /// One model on each side of the surface.
    TwoSided {
        /// Seen from the side of the normal.
        front: MaterialId,
        /// Seen from the other side, with the normal flipped.
        back: MaterialId,
    },
    /// Lets light straight through where `opacity` < 1.
    Mask {
        /// 1 is opaque.
        opacity: ScalarInput,
        /// What is seen where it is opaque.
        inner: MaterialId,
    },
    /// Tilts the shading normal by a displacement texture.
    BumpMap {
        /// Displacement in scene units per unit of texture value.
        scale: f32,
        /// Displacement.
        texture: TextureId,
        /// What is tilted.
        inner: MaterialId,
    },
}
