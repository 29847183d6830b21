//! Materials: what each one holds, and how they are nested.

use super::Check;
use crate::diagnostic::{Diagnostic, Span};
use crate::{ColorInput, MaterialDesc, MaterialId, Rgb, ScalarInput};

/// Relative indices of refraction; beyond, the cosines of what is refracted are rounding errors.
const INDICES: std::ops::RangeInclusive<f32> = 1e-3..=1e3;
/// Parts of a metal's index.
const LARGEST_COMPLEX_INDEX: f32 = 1e4;
/// At 1, facets point everywhere; beyond this nothing changes any more.
const ROUGHEST: f32 = 100.0;
/// More bounces below a coat hold nothing.
const MOST_BOUNCES: u32 = 16;
/// A displacement this steep turns every normal into the surface.
const STEEPEST: f32 = 1e6;

/// Materials nested deeper than this are an error.
const MAX_MATERIAL_DEPTH: usize = 8;

impl Check<'_> {
    /// Ids in range, no cycle, nothing where it cannot be. False if the material cannot be looked into.
    pub(super) fn nesting(&mut self, id: MaterialId, span: &Span, depth: usize) -> bool {
        let Some(material) = self.scene.materials.get(id.0 as usize) else {
            self.error("scene::bad-id", span, format!("there is no material {}", id.0));
            return false;
        };
        if depth > MAX_MATERIAL_DEPTH {
            self.error(
                "scene::material-cycle",
                span,
                "this material contains itself, or is nested too deeply",
            );
            return false;
        }
        match *material {
            MaterialDesc::TwoSided { front, back } => {
                let sides = if front == back { vec![front] } else { vec![front, back] };
                for side in sides {
                    if !self.nesting(side, span, depth + 1) {
                        return false;
                    }
                    if depth == 0 && self.transmits(side) {
                        let message = "a two-sided material cannot hold one that transmits light";
                        self.error("scene::twosided-transmission", span, message);
                    }
                }
                true
            }
            MaterialDesc::Blend { materials, .. } => {
                materials.into_iter().all(|inner| self.nesting(inner, span, depth + 1))
            }
            MaterialDesc::Mask { inner, .. }
            | MaterialDesc::BumpMap { inner, .. }
            | MaterialDesc::NormalMap { inner, .. } => self.nesting(inner, span, depth + 1),
            _ => true,
        }
    }

    fn transmits(&self, id: MaterialId) -> bool {
        match self.scene.materials.get(id.0 as usize) {
            Some(
                MaterialDesc::Dielectric { .. }
                | MaterialDesc::ThinDielectric { .. }
                | MaterialDesc::RoughDielectric { .. }
                | MaterialDesc::DiffuseTransmission { .. }
                | MaterialDesc::PrincipledThin(_)
                | MaterialDesc::Hair(_)
                | MaterialDesc::Mask { .. },
            ) => true,
            Some(MaterialDesc::MetallicRoughness(m)) => m.transmission != ScalarInput::Constant(0.0),
            Some(MaterialDesc::Principled(p)) => p.spec_trans != ScalarInput::Constant(0.0),
            Some(MaterialDesc::BumpMap { inner, .. } | MaterialDesc::NormalMap { inner, .. }) => {
                self.transmits(*inner)
            }
            Some(MaterialDesc::Blend { materials, .. }) => {
                materials.iter().any(|inner| self.transmits(*inner))
            }
            _ => false,
        }
    }

    pub(super) fn material(&mut self, material: &MaterialDesc, span: &Span) {
        match material {
            MaterialDesc::Diffuse { reflectance } => self.albedo(reflectance, "reflectance", span),
            MaterialDesc::Dielectric { eta, specular_reflectance, specular_transmittance }
            | MaterialDesc::ThinDielectric { eta, specular_reflectance, specular_transmittance } => {
                self.eta(*eta, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
                self.albedo(specular_transmittance, "specular_transmittance", span);
            }
            MaterialDesc::RoughDielectric {
                alpha,
                eta,
                specular_reflectance,
                specular_transmittance,
                multiscatter,
                ..
            } => {
                self.multiscatter(*multiscatter, alpha, span);
                alpha.iter().for_each(|a| self.alpha(a, span));
                self.eta(*eta, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
                self.albedo(specular_transmittance, "specular_transmittance", span);
            }
            MaterialDesc::Conductor { eta_k, specular_reflectance } => {
                self.complex_index(eta_k, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
            }
            MaterialDesc::RoughConductor { alpha, eta_k, specular_reflectance, multiscatter, .. } => {
                self.multiscatter(*multiscatter, alpha, span);
                alpha.iter().for_each(|a| self.alpha(a, span));
                self.complex_index(eta_k, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
            }
            MaterialDesc::Plastic { eta, diffuse_reflectance, specular_reflectance, .. } => {
                self.eta(*eta, span);
                self.albedo(diffuse_reflectance, "diffuse_reflectance", span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
            }
            MaterialDesc::RoughPlastic { alpha, eta, diffuse_reflectance, specular_reflectance, .. } => {
                self.alpha(&ScalarInput::Constant(*alpha), span);
                self.eta(*eta, span);
                self.albedo(diffuse_reflectance, "diffuse_reflectance", span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
            }
            MaterialDesc::Eon { reflectance, roughness } => {
                self.albedo(reflectance, "reflectance", span);
                self.within(roughness, "roughness", 1.0, span);
            }
            MaterialDesc::OrenNayar { reflectance, sigma } => {
                self.albedo(reflectance, "reflectance", span);
                self.within(sigma, "sigma", std::f32::consts::FRAC_PI_2, span);
            }
            MaterialDesc::DiffuseTransmission { reflectance, transmittance } => {
                self.albedo(reflectance, "reflectance", span);
                self.albedo(transmittance, "transmittance", span);
            }
            MaterialDesc::CoatedConductor {
                coat_alpha,
                eta,
                alpha,
                eta_k,
                specular_reflectance,
                bounces,
                ..
            } => {
                if *coat_alpha != 0.0 {
                    self.alpha(&ScalarInput::Constant(*coat_alpha), span);
                }
                self.alpha(&ScalarInput::Constant(*alpha), span);
                self.dense_index(*eta, "a relative index of refraction of a coat", span);
                self.complex_index(eta_k, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
                if let Some(bounces) = bounces
                    && !(1..=MOST_BOUNCES).contains(bounces)
                {
                    let message =
                        format!("{bounces} bounces below a coat: from 1 to {MOST_BOUNCES} are possible");
                    self.found.push(Diagnostic::error("scene::bounces", span, message));
                }
            }
            MaterialDesc::Principled(principled) => self.principled(principled, span),
            MaterialDesc::PrincipledThin(thin) => self.principled_thin(thin, span),
            MaterialDesc::MetallicRoughness(m) => self.metallic_roughness(m, span),
            MaterialDesc::Hair(hair) => self.hair(hair, span),
            MaterialDesc::TwoSided { .. } => {}
            MaterialDesc::Mask { opacity, .. } => self.share(opacity, "scene::opacity", "an opacity", span),
            MaterialDesc::Blend { weight, .. } => self.share(weight, "scene::blend-weight", "a weight", span),
            MaterialDesc::NormalMap { normal, .. } => self.normal_map(normal, span),
            MaterialDesc::BumpMap { scale, texture, .. } => {
                self.texture_id(*texture, span);
                if !(scale.abs() <= STEEPEST) {
                    let message = format!(
                        "the scale of a bump map is {scale}: -{STEEPEST:e} to {STEEPEST:e} is possible"
                    );
                    self.error("scene::bump-scale", span, message);
                }
            }
        }
    }

    /// A number between 0 and 1.
    fn share(&mut self, input: &ScalarInput, code: &'static str, what: &str, span: &Span) {
        match *input {
            ScalarInput::Constant(value) if !(0.0..=1.0).contains(&value) => {
                self.error(code, span, format!("{what} of {value} is not between 0 and 1"));
            }
            ScalarInput::Constant(_) => {}
            ScalarInput::Texture(id) => self.texture_id(id, span),
        }
    }

    pub(super) fn albedo(&mut self, input: &ColorInput, what: &str, span: &Span) {
        self.color_input(input, what, span);
        if let ColorInput::Constant(color) = *input
            && color.max_element() > 1.0
            && color.is_finite()
        {
            let message =
                format!("{what} is {}, {}, {}: more than 1 creates energy", color.x, color.y, color.z);
            self.found.push(
                Diagnostic::warning("scene::energy", span, message)
                    .consequence("it is rendered as it is; paths may not end without a depth limit"),
            );
        }
    }

    fn alpha(&mut self, input: &ScalarInput, span: &Span) {
        match *input {
            ScalarInput::Constant(alpha) if !(alpha > 0.0 && alpha <= ROUGHEST) => {
                let message =
                    format!("a roughness alpha of {alpha}: more than 0 and at most {ROUGHEST} is possible");
                self.error("scene::alpha", span, message);
            }
            ScalarInput::Constant(_) => {}
            ScalarInput::Texture(id) => self.texture_id(id, span),
        }
    }

    pub(super) fn eta(&mut self, eta: f32, span: &Span) {
        if !INDICES.contains(&eta) {
            let (low, high) = (INDICES.start(), INDICES.end());
            let message = format!("a relative index of refraction of {eta}: {low} to {high} is possible");
            self.error("scene::index", span, message);
        }
    }

    /// An index of something that is denser than what is around it.
    pub(super) fn dense_index(&mut self, eta: f32, what: &str, span: &Span) {
        let high = INDICES.end();
        if !(1.0..=*high).contains(&eta) {
            self.error("scene::index", span, format!("{what} of {eta}: 1 to {high} is possible"));
        }
    }

    fn normal_map(&mut self, normal: &ColorInput, span: &Span) {
        match *normal {
            ColorInput::Texture(id) => self.texture_id(id, span),
            // Any color is some direction, but only one above the surface is a normal.
            ColorInput::Constant(color) => {
                let normal = 2.0 * color - Rgb::ONE;
                let length = normal.length();
                if !(length <= 2.0) {
                    let message = format!(
                        "a normal map of the color {}, {}, {}: parts of 0 to 1 are possible",
                        color.x, color.y, color.z
                    );
                    self.error("scene::normal-map", span, message);
                } else if !(normal.z > 1e-3 * length) {
                    let message = format!(
                        "a normal map of the color {}, {}, {}, which is no normal above the surface",
                        color.x, color.y, color.z
                    );
                    self.found.push(
                        Diagnostic::warning("scene::normal-map", span, message)
                            .consequence("the surface is shaded as if it were seen from inside or edge-on"),
                    );
                }
            }
        }
    }

    /// Light that bounces between facets is tabulated, for one roughness.
    fn multiscatter(&mut self, is_wanted: bool, alpha: &[ScalarInput; 2], span: &Span) {
        let is_possible = matches!(alpha, [ScalarInput::Constant(x), ScalarInput::Constant(y)] if x == y);
        if is_wanted && !is_possible {
            let message = "multiscatter needs a roughness that is constant and the same in all directions";
            self.found.push(
                Diagnostic::warning("scene::multiscatter", span, message)
                    .consequence("light that bounces between facets is lost"),
            );
        }
    }

    fn complex_index(&mut self, eta_k: &Option<(ColorInput, ColorInput)>, span: &Span) {
        if let Some((eta, k)) = eta_k {
            for (input, what) in [(eta, "eta"), (k, "k")] {
                self.color_input(input, what, span);
                if let ColorInput::Constant(color) = *input
                    && color.max_element() > LARGEST_COMPLEX_INDEX
                {
                    let message = format!(
                        "{what} is {}, {}, {}: up to {LARGEST_COMPLEX_INDEX} is possible",
                        color.x, color.y, color.z
                    );
                    self.error("scene::index", span, message);
                }
            }
        }
    }
}
