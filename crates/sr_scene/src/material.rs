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
    /// GGX whose masking and shadowing are correlated by height (pbrt's); [`Self::Ggx`] takes them as independent.
    GgxCorrelated,
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
        /// Is the light that bounces between facets added? For constant, isotropic roughness only.
        multiscatter: bool,
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
        /// Is the light that bounces between facets added? For constant, isotropic roughness only.
        multiscatter: bool,
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
        /// Does the coating lose nothing: is what it does not reflect let in?
        multiscatter: bool,
    },
    /// Rough diffuse reflection that preserves energy (Portsmouth, Kutz & Hill 2025).
    Eon {
        /// Albedo of the facets.
        reflectance: ColorInput,
        /// In [0, 1]; 0 is Lambertian.
        roughness: ScalarInput,
    },
    /// Rough diffuse reflection (Oren & Nayar 1994, the qualitative model).
    OrenNayar {
        /// Albedo of the facets.
        reflectance: ColorInput,
        /// Standard deviation of the facets' angle, in radians.
        sigma: ScalarInput,
    },
    /// Diffuse reflection and transmission.
    DiffuseTransmission {
        /// Fraction of light reflected.
        reflectance: ColorInput,
        /// Fraction of light transmitted.
        transmittance: ColorInput,
    },
    /// A metal under a dielectric coat.
    CoatedConductor {
        /// Microfacet distribution of both.
        kind: MicrofacetKind,
        /// Roughness of the coat; 0 is smooth.
        coat_alpha: f32,
        /// Index of the coat over the exterior's, at least 1.
        eta: f32,
        /// Roughness of the metal.
        alpha: f32,
        /// Complex index of the metal over the exterior's; `None` reflects everything.
        eta_k: Option<(ColorInput, ColorInput)>,
        /// Scales what the metal reflects; physically 1.
        specular_reflectance: ColorInput,
        /// How often light may meet the metal, 1 to 16 times; it is then lost, and so is what bounces between facets. `None`:
        /// nothing is lost.
        bounces: Option<u32>,
    },
    /// Burley's model with transmission.
    Principled(PrincipledDesc),
    /// Burley's model of a thin surface.
    PrincipledThin(PrincipledThinDesc),
    /// The metallic-roughness material of glTF 2.0.
    MetallicRoughness(MetallicRoughnessDesc),
    /// Hair and fur.
    Hair(HairDesc),
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
    /// Two materials in one place.
    Blend {
        /// The share of `materials[1]`; the rest is `materials[0]`. Brought into [0, 1].
        weight: ScalarInput,
        /// What is mixed.
        materials: [MaterialId; 2],
    },
    /// Tilts the shading normal by a displacement texture.
    BumpMap {
        /// Displacement in scene units per unit of texture value.
        scale: f32,
        /// Displacement.
        texture: TextureId,
        /// What tilting is like.
        tilting: Tilting,
        /// What is tilted.
        inner: MaterialId,
    },
    /// Tilts the shading normal to one that a texture holds.
    NormalMap {
        /// (n + 1) / 2, n in the frame of the tangent, the bitangent and the shading normal.
        normal: ColorInput,
        /// What tilting is like.
        tilting: Tilting,
        /// What is tilted.
        inner: MaterialId,
    },
}

/// What is done besides tilting a normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tilting {
    /// Are normals that face away from the viewer turned about the untilted one, so that nothing is black?
    pub flip_invalid_normals: bool,
    /// Is light at grazing angles dimmed, as the bumps' shadows would?
    pub shadows: bool,
    /// Of a normal map: is its bitangent on the side to which v grows, also where texture coordinates are mirrored, as in
    /// glTF? Otherwise it is the shading normal's cross product with the tangent, as in Mitsuba and pbrt.
    pub along_v: bool,
}

impl Default for Tilting {
    /// As Mitsuba does.
    fn default() -> Self {
        Self { flip_invalid_normals: true, shadows: true, along_v: false }
    }
}

/// What a principled material is made from. Numbers are in [0, 1] unless it says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledDesc {
    /// Of the diffuse base, of metals, of tints.
    pub base_color: ColorInput,
    /// Its square is α.
    pub roughness: ScalarInput,
    /// Stretches highlights along the tangent.
    pub anisotropic: ScalarInput,
    /// From dielectric to metal.
    pub metallic: ScalarInput,
    /// From a diffuse base to a refracting interface.
    pub spec_trans: ScalarInput,
    /// Interior over exterior index.
    pub eta: f32,
    /// Tints the dielectric reflection.
    pub spec_tint: ScalarInput,
    /// Brightens grazing angles.
    pub sheen: ScalarInput,
    /// Tints the sheen.
    pub sheen_tint: ScalarInput,
    /// From the diffuse base to a stand-in for scattering below the surface.
    pub flatness: ScalarInput,
    /// A second reflection.
    pub clearcoat: ScalarInput,
    /// How sharp that is.
    pub clearcoat_gloss: ScalarInput,
    /// How often diffuse base, main reflection and clear coat are sampled, relatively; not negative.
    pub rates: [f32; 3],
}

/// What a thin principled material is made from. Numbers are in [0, 1] unless it says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledThinDesc {
    /// Of the diffuse base, of what is transmitted, of tints.
    pub base_color: ColorInput,
    /// Its square is α.
    pub roughness: ScalarInput,
    /// Stretches highlights along the tangent.
    pub anisotropic: ScalarInput,
    /// From a diffuse surface to a pane.
    pub spec_trans: ScalarInput,
    /// Interior over exterior index, positive.
    pub eta: ScalarInput,
    /// Tints reflection.
    pub spec_tint: ScalarInput,
    /// Brightens grazing angles.
    pub sheen: ScalarInput,
    /// Tints the sheen.
    pub sheen_tint: ScalarInput,
    /// From the diffuse base to a stand-in for scattering below the surface.
    pub flatness: ScalarInput,
    /// Of the diffuse light, how much passes: in [0, 2], 2 being all.
    pub diff_trans: ScalarInput,
    /// How often specular reflection and transmission, diffuse reflection and transmission are sampled, relatively.
    pub rates: [f32; 4],
}

/// What a metallic-roughness material is made from. Numbers are in [0, 1] unless it says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetallicRoughnessDesc {
    /// Of the base, of metals, of what is transmitted.
    pub base_color: ColorInput,
    /// From dielectric to metal.
    pub metallic: ScalarInput,
    /// Its square is α.
    pub roughness: ScalarInput,
    /// Strength of the dielectric reflection.
    pub specular: ScalarInput,
    /// Its colour; may exceed 1.
    pub specular_color: ColorInput,
    /// Index of refraction, at least 1.
    pub ior: f32,
    /// Strength of a coat.
    pub clearcoat: ScalarInput,
    /// Its roughness.
    pub clearcoat_roughness: ScalarInput,
    /// Colour of a layer of fibres.
    pub sheen_color: ColorInput,
    /// Its roughness.
    pub sheen_roughness: ScalarInput,
    /// Of the dielectric's base, how much transmits.
    pub transmission: ScalarInput,
    /// Is it a thin sheet, which does not bend light?
    pub thin: bool,
    /// Of a thin sheet's diffuse light, how much comes out on the other side.
    pub diffuse_transmission: ScalarInput,
    /// Its colour there.
    pub diffuse_transmission_color: ColorInput,
    /// Stretches highlights.
    pub anisotropy: ScalarInput,
    /// Along which direction from the tangent, in radians.
    pub anisotropy_rotation: f32,
}

/// Hair and fur (Chiang, Bitterli, Tappan & Burley 2016).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairDesc {
    /// What the fibre absorbs.
    pub absorption: HairAbsorption,
    /// Index of refraction of the fibre over that around it.
    pub eta: f32,
    /// Roughness along the fibre, in [0, 1].
    pub beta_m: ScalarInput,
    /// Roughness around the fibre, in [0, 1].
    pub beta_n: ScalarInput,
    /// How far the scales on the fibre are tilted, in radians.
    pub alpha: f32,
    /// Does the fibre run along ∂p/∂u, as pbrt's? Else across it and the normal, as Mitsuba's.
    pub along_u: bool,
}

/// What hair absorbs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HairAbsorption {
    /// On a way as long as the radius.
    Coefficient(ColorInput),
    /// As much as gives it this color, where light scatters often.
    Color(ColorInput),
    /// What pigments of these concentrations do.
    Pigments {
        /// Of brown and black hair.
        eumelanin: ScalarInput,
        /// Of red hair.
        pheomelanin: ScalarInput,
    },
}
