//! Principled materials: numbers that have a range.

use super::Check;
use crate::diagnostic::{Diagnostic, Span};
use crate::{MetallicRoughnessDesc, PrincipledDesc, PrincipledThinDesc, ScalarInput};

impl Check<'_> {
    pub(super) fn principled(&mut self, p: &PrincipledDesc, span: &Span) {
        self.albedo(&p.base_color, "base_color", span);
        self.eta(p.eta, span);
        let units = [
            (&p.roughness, "roughness"),
            (&p.anisotropic, "anisotropic"),
            (&p.metallic, "metallic"),
            (&p.spec_trans, "spec_trans"),
            (&p.spec_tint, "spec_tint"),
            (&p.sheen, "sheen"),
            (&p.sheen_tint, "sheen_tint"),
            (&p.flatness, "flatness"),
            (&p.clearcoat, "clearcoat"),
            (&p.clearcoat_gloss, "clearcoat_gloss"),
        ];
        for (input, name) in units {
            self.within(input, name, 1.0, span);
        }
        self.rates(&p.rates, span);
    }

    pub(super) fn principled_thin(&mut self, p: &PrincipledThinDesc, span: &Span) {
        self.albedo(&p.base_color, "base_color", span);
        match p.eta {
            ScalarInput::Constant(eta) => self.eta(eta, span),
            ScalarInput::Texture(id) => self.texture_id(id, span),
        }
        let units = [
            (&p.roughness, "roughness"),
            (&p.anisotropic, "anisotropic"),
            (&p.spec_trans, "spec_trans"),
            (&p.spec_tint, "spec_tint"),
            (&p.sheen, "sheen"),
            (&p.sheen_tint, "sheen_tint"),
            (&p.flatness, "flatness"),
        ];
        for (input, name) in units {
            self.within(input, name, 1.0, span);
        }
        self.within(&p.diff_trans, "diff_trans", 2.0, span);
        self.rates(&p.rates, span);
    }

    pub(super) fn metallic_roughness(&mut self, m: &MetallicRoughnessDesc, span: &Span) {
        self.albedo(&m.base_color, "base_color", span);
        self.color_input(&m.specular_color, "specular_color", span);
        self.albedo(&m.sheen_color, "sheen_color", span);
        self.albedo(&m.diffuse_transmission_color, "diffuse_transmission_color", span);
        let units = [
            (&m.metallic, "metallic"),
            (&m.roughness, "roughness"),
            (&m.specular, "specular"),
            (&m.clearcoat, "clearcoat"),
            (&m.clearcoat_roughness, "clearcoat_roughness"),
            (&m.sheen_roughness, "sheen_roughness"),
            (&m.transmission, "transmission"),
            (&m.diffuse_transmission, "diffuse_transmission"),
            (&m.anisotropy, "anisotropy"),
        ];
        for (input, name) in units {
            self.within(input, name, 1.0, span);
        }
        self.dense_index(m.ior, "an index of refraction", span);
        if !m.anisotropy_rotation.is_finite() {
            self.error("scene::not-finite", span, "anisotropy_rotation is not finite");
        }
    }

    /// A number that models bring into [0, most].
    pub(super) fn within(&mut self, input: &ScalarInput, what: &str, most: f32, span: &Span) {
        match *input {
            ScalarInput::Constant(value) if !value.is_finite() => {
                self.error("scene::not-finite", span, format!("{what} is not finite"));
            }
            ScalarInput::Constant(value) if !(0.0..=most).contains(&value) => {
                let message = format!("{what} is {value}, not between 0 and {most}");
                self.found.push(
                    Diagnostic::warning("scene::out-of-range", span, message)
                        .consequence(format!("{} is used", value.clamp(0.0, most))),
                );
            }
            ScalarInput::Constant(_) => {}
            ScalarInput::Texture(id) => self.texture_id(id, span),
        }
    }

    fn rates(&mut self, rates: &[f32], span: &Span) {
        let is_bad = |rate: &f32| !(*rate >= 0.0 && rate.is_finite());
        if rates.iter().any(is_bad) || rates.iter().all(|&rate| rate == 0.0) {
            let message = "sampling rates have to be finite, not negative, and not all 0";
            self.error("scene::sampling-rates", span, message);
        }
    }
}
