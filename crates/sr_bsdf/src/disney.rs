//! Pieces that the principled models share (Burley 2012, "Physically Based Shading at Disney", and 2015, "Extending the
//! Disney BRDF to a BSDF with Integrated Subsurface Scattering"), as Mitsuba 3 puts them together.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::{Vec2, Vec3};

use crate::{Ggx, Microfacet, Rgb};

/// Rec. 709 weights, to the digits that Mitsuba has.
const LUMINANCE: Rgb = Rgb::new(0.212_671, 0.715_160, 0.072_169);

/// GGX normals of a roughness and an anisotropy in [0, 1].
pub(crate) fn distribution(roughness: f32, anisotropic: f32) -> Microfacet<Ggx> {
    let alpha = roughness * roughness;
    let aspect = (1.0 - 0.9 * anisotropic).sqrt();
    Microfacet::new(Ggx, (alpha / aspect).max(1e-3), (alpha * aspect).max(1e-3))
}

/// (1 − cos θ)⁵, Schlick's weight.
#[inline(always)]
pub(crate) fn schlick_weight(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    (m * m) * (m * m) * m
}

/// Schlick's approximation of Fresnel's equations, from the side where the index is 1; with η < 1 at the refracted angle.
#[inline(always)]
pub(crate) fn schlick(r0: Rgb, cos: f32, eta: f32) -> Rgb {
    let cos = if eta > 1.0 { cos } else { (1.0 - (1.0 - cos * cos) / (eta * eta)).max(0.0).sqrt() };
    r0.lerp(Rgb::ONE, schlick_weight(cos))
}

/// A colour of luminance 1 with the hue of another; white for black.
#[inline(always)]
pub(crate) fn tint(color: Rgb) -> Rgb {
    let luminance = color.dot(LUMINANCE);
    if luminance > 0.0 { color / luminance } else { Rgb::ONE }
}

/// The reflectance of a dielectric at normal incidence.
#[inline(always)]
pub(crate) fn r0(eta: f32) -> f32 {
    ((eta - 1.0) / (eta + 1.0)).powi(2)
}

/// What lies under the gloss: diffuse reflection, retro-reflection, a flatter stand-in for scattering below the surface,
/// and sheen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Base {
    pub color: Rgb,
    pub roughness: f32,
    pub flatness: f32,
    /// Sheen, tinted.
    pub sheen: Rgb,
}

impl Base {
    pub fn new(color: Rgb, roughness: f32, flatness: f32, sheen: f32, sheen_tint: f32) -> Self {
        Self { color, roughness, flatness, sheen: sheen * Rgb::ONE.lerp(tint(color), sheen_tint) }
    }

    /// f without sheen, and the sheen; at cosines of `wo` and `wi` with the normal, and of either with the half vector.
    #[inline(always)]
    pub fn eval(&self, cos_o: f32, cos_i: f32, cos_d: f32) -> (Rgb, Rgb) {
        let (o, i) = (schlick_weight(cos_o), schlick_weight(cos_i));
        let diffuse = (1.0 - 0.5 * i) * (1.0 - 0.5 * o);
        let rr = 2.0 * self.roughness * cos_d * cos_d;
        let retro = rr * (o + i + o * i * (rr - 1.0));
        let flat90 = 0.5 * rr;
        let flat = (1.0 + (flat90 - 1.0) * o) * (1.0 + (flat90 - 1.0) * i);
        let below = 1.25 * (flat * (1.0 / (cos_o + cos_i) - 0.5) + 0.5);
        let scale = diffuse + retro + self.flatness * (below - diffuse - retro);
        (self.color * (scale * FRAC_1_PI), self.sheen * schlick_weight(cos_d))
    }
}

/// Normals of the clear coat: GTR with γ = 1, whose tails are longer than those of GGX.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClearcoatNormals {
    alpha2: f32,
}

impl ClearcoatNormals {
    pub fn new(gloss: f32) -> Self {
        let alpha = 0.1 + (0.001 - 0.1) * gloss;
        Self { alpha2: alpha * alpha }
    }

    #[inline(always)]
    pub fn d(&self, m: Vec3) -> f32 {
        if m.z <= 0.0 {
            return 0.0;
        }
        let sin2 = m.x * m.x + m.y * m.y;
        (self.alpha2 - 1.0) / (PI * self.alpha2.ln() * (sin2 + self.alpha2 * m.z * m.z))
    }

    /// The density of normals, D cos θ, in sr⁻¹.
    #[inline(always)]
    pub fn pdf(&self, m: Vec3) -> f32 {
        m.z.max(0.0) * self.d(m)
    }

    pub fn sample(&self, u: Vec2) -> Vec3 {
        let cos2 = ((1.0 - self.alpha2.powf(1.0 - u.y)) / (1.0 - self.alpha2)).clamp(0.0, 1.0);
        let (sin_phi, cos_phi) = (TAU * u.x).sin_cos();
        let sin = (1.0 - cos2).sqrt();
        Vec3::new(sin * cos_phi, sin * sin_phi, cos2.sqrt())
    }

    /// Smith's G₁ of GGX with α = 0.25, whatever the gloss.
    #[inline(always)]
    pub fn g1(cos: f32) -> f32 {
        2.0 * cos / (cos + (cos * cos + 0.0625 * (1.0 - cos * cos).max(0.0)).sqrt())
    }
}
