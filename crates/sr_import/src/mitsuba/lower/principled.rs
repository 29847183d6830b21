//! BSDFs with many parameters, coated ones, and rough diffuse ones.

use std::f32::consts::FRAC_1_SQRT_2;

use sr_scene::{
    Diagnostic, MaterialDesc, MetallicRoughnessDesc, PrincipledDesc, PrincipledThinDesc, Rgb, ScalarInput,
};

use super::Lowering;
use super::material::GREY;
use crate::mitsuba::props::Props;

impl<'a> Lowering<'a, '_> {
    pub(super) fn principled(&mut self, props: &mut Props<'a>) -> MaterialDesc {
        let mut unit = |name, default| self.scalar(props, name, default);
        let (roughness, anisotropic) = (unit("roughness", 0.5), unit("anisotropic", 0.0));
        let (metallic, spec_trans) = (unit("metallic", 0.0), unit("spec_trans", 0.0));
        let (spec_tint, flatness) = (unit("spec_tint", 0.0), unit("flatness", 0.0));
        let (sheen, sheen_tint) = (unit("sheen", 0.0), unit("sheen_tint", 0.0));
        let (clearcoat, clearcoat_gloss) = (unit("clearcoat", 0.0), unit("clearcoat_gloss", 0.0));
        MaterialDesc::Principled(PrincipledDesc {
            base_color: self.factor(props, "base_color", GREY),
            roughness,
            anisotropic,
            metallic,
            spec_trans,
            eta: self.principled_eta(props, spec_trans != ScalarInput::Constant(0.0)),
            spec_tint,
            sheen,
            sheen_tint,
            flatness,
            clearcoat,
            clearcoat_gloss,
            rates: [
                self.rate(props, "diffuse_reflectance_sampling_rate"),
                self.rate(props, "main_specular_sampling_rate"),
                self.rate(props, "clearcoat_sampling_rate"),
            ],
        })
    }

    pub(super) fn principled_thin(&mut self, props: &mut Props<'a>) -> MaterialDesc {
        MaterialDesc::PrincipledThin(PrincipledThinDesc {
            base_color: self.factor(props, "base_color", GREY),
            roughness: self.scalar(props, "roughness", 0.5),
            anisotropic: self.scalar(props, "anisotropic", 0.0),
            spec_trans: self.scalar(props, "spec_trans", 0.0),
            eta: self.scalar(props, "eta", 1.5),
            spec_tint: self.scalar(props, "spec_tint", 0.0),
            sheen: self.scalar(props, "sheen", 0.0),
            sheen_tint: self.scalar(props, "sheen_tint", 0.0),
            flatness: self.scalar(props, "flatness", 0.0),
            diff_trans: self.scalar(props, "diff_trans", 0.0),
            rates: [
                self.rate(props, "specular_reflectance_sampling_rate"),
                self.rate(props, "specular_transmittance_sampling_rate"),
                self.rate(props, "diffuse_reflectance_sampling_rate"),
                self.rate(props, "diffuse_transmittance_sampling_rate"),
            ],
        })
    }

    /// glTF's names and defaults, in the style of the others; the angle is in degrees.
    pub(super) fn metallic_roughness(&mut self, props: &mut Props<'a>) -> MaterialDesc {
        MaterialDesc::MetallicRoughness(MetallicRoughnessDesc {
            base_color: self.factor(props, "base_color", Rgb::ONE),
            metallic: self.scalar(props, "metallic", 1.0),
            roughness: self.scalar(props, "roughness", 1.0),
            specular: self.scalar(props, "specular", 1.0),
            specular_color: self.factor(props, "specular_color", Rgb::ONE),
            ior: props.float("ior", self.out.d).unwrap_or(1.5),
            clearcoat: self.scalar(props, "clearcoat", 0.0),
            clearcoat_roughness: self.scalar(props, "clearcoat_roughness", 0.0),
            sheen_color: self.factor(props, "sheen_color", Rgb::ZERO),
            sheen_roughness: self.scalar(props, "sheen_roughness", 0.0),
            transmission: self.scalar(props, "transmission", 0.0),
            thin: props.boolean("thin", self.out.d).unwrap_or(true),
            diffuse_transmission: self.scalar(props, "diffuse_transmission", 0.0),
            diffuse_transmission_color: self.factor(props, "diffuse_transmission_color", Rgb::ONE),
            anisotropy: self.scalar(props, "anisotropy", 0.0),
            anisotropy_rotation: props.float("anisotropy_rotation", self.out.d).unwrap_or(0.0).to_radians(),
        })
    }

    /// `alpha` is a slope's root mean square, as in Mitsuba 0.6, which found σ = α / √2 to fit.
    pub(super) fn rough_diffuse(&mut self, props: &mut Props<'a>) -> MaterialDesc {
        props.ignore(&["use_fast_approx"]);
        let alpha = self.constant_alpha(props, "alpha", 0.2);
        let alpha = self.in_range("alpha", alpha.into(), 0.0..=f64::MAX, props.node) as f32;
        let sigma = ScalarInput::Constant(alpha * FRAC_1_SQRT_2);
        MaterialDesc::OrenNayar { reflectance: self.factor(props, "reflectance", GREY), sigma }
    }

    /// A plastic that loses nothing; smooth, as it is by default, plastic never does.
    pub(super) fn coated_diffuse(&mut self, props: &mut Props<'a>) -> MaterialDesc {
        let kind = self.distribution(props);
        let alpha = self.constant_alpha(props, "alpha", 0.0);
        let eta = self.eta(props, "bk7");
        let diffuse_reflectance = self.factor(props, "diffuse_reflectance", GREY);
        let specular_reflectance = self.factor(props, "specular_reflectance", Rgb::ONE);
        if alpha == 0.0 {
            return MaterialDesc::Plastic { eta, diffuse_reflectance, specular_reflectance, nonlinear: true };
        }
        MaterialDesc::RoughPlastic {
            kind,
            alpha,
            eta,
            diffuse_reflectance,
            specular_reflectance,
            nonlinear: true,
            multiscatter: true,
        }
    }

    pub(super) fn coated_conductor(&mut self, props: &mut Props<'a>) -> MaterialDesc {
        let bounces = props.integer("bounces", self.out.d).map(|n| n.clamp(0, u32::MAX.into()) as u32);
        MaterialDesc::CoatedConductor {
            kind: self.distribution(props),
            coat_alpha: self.constant_alpha(props, "coat_alpha", 0.0),
            eta: self.eta(props, "bk7"),
            alpha: self.constant_alpha(props, "alpha", 0.1),
            eta_k: self.eta_k(props),
            specular_reflectance: self.factor(props, "specular_reflectance", Rgb::ONE),
            bounces,
        }
    }

    fn rate(&mut self, props: &mut Props<'a>, name: &'static str) -> f32 {
        props.float(name, self.out.d).unwrap_or(1.0)
    }

    /// `eta`, or `specular`, which stands for it; media that do not bend light at all cannot transmit.
    fn principled_eta(&mut self, props: &mut Props<'a>, transmits: bool) -> f32 {
        let (eta, specular) = (props.float("eta", self.out.d), props.float("specular", self.out.d));
        if eta.is_some() && specular.is_some() {
            let message = format!("{} has both \"eta\" and \"specular\"", props.node.title());
            self.out.d.push(
                Diagnostic::warning("mitsuba::conflict", &props.node.span, message)
                    .consequence("\"eta\" is used"),
            );
        }
        match (eta, specular.unwrap_or(0.5)) {
            (Some(eta), _) if transmits && eta == 1.0 => 1.001,
            (Some(eta), _) => eta,
            // R₀ = 0.08 specular.
            (None, specular) => {
                let specular = self.in_range("specular", specular.into(), 0.0..=10.0, props.node) as f32;
                let specular = if transmits && specular == 0.0 { 1e-3 } else { specular };
                2.0 / (1.0 - (0.08 * specular).sqrt()) - 1.0
            }
        }
    }
}
