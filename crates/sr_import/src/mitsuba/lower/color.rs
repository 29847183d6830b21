//! Colors and numbers that may be constant, spectral or textured.

use sr_scene::{ColorInput, Diagnostic, Rgb, ScalarInput, Span};

use super::Lowering;
use crate::files;
use crate::mitsuba::node::{SpectrumValue, Value};
use crate::mitsuba::props::{Props, finite_color};
use crate::values;

/// What a color is for: it decides how a spectrum is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// A factor: reflectance, transmittance, an index of refraction. Seen under D65.
    Factor,
    /// Light.
    Emission,
}

impl<'a> Lowering<'a, '_> {
    /// The color `name` of a node.
    pub(super) fn color(
        &mut self,
        props: &mut Props<'a>,
        name: &'static str,
        default: Rgb,
        role: Role,
    ) -> ColorInput {
        self.color_if_given(props, name, role).unwrap_or(ColorInput::Constant(default))
    }

    /// The color `name` of a node, if it is there and sound.
    pub(super) fn color_if_given(
        &mut self,
        props: &mut Props<'a>,
        name: &'static str,
        role: Role,
    ) -> Option<ColorInput> {
        if let Some(child) = props.child(name) {
            let node = self.resolve(child)?;
            return Some(self.texture(node, role));
        }
        let property = props.get(name)?;
        let color = match &property.value {
            Value::Float(v) => Some(glam::DVec3::splat(*v)),
            Value::Integer(v) => Some(glam::DVec3::splat(*v as f64)),
            Value::Rgb(color) => Some(*color),
            Value::Spectrum(spectrum) => self.spectrum(spectrum, role, &property.span),
            _ => props.wrong_type(property, "a color, a spectrum, a number or a texture", self.out.d),
        }?;
        finite_color(color, name, &property.span, self.out.d).map(ColorInput::Constant)
    }

    /// A color that cannot be textured.
    pub(super) fn constant_color(
        &mut self,
        props: &mut Props<'a>,
        name: &'static str,
        default: Rgb,
        role: Role,
    ) -> Rgb {
        match self.color(props, name, default, role) {
            ColorInput::Constant(color) => color,
            ColorInput::Texture(_) => {
                let message = format!("\"{name}\" of {} cannot be a texture", props.node.title());
                self.out.d.push(
                    Diagnostic::warning("mitsuba::texture-not-possible", &props.node.span, message)
                        .consequence(format!(
                            "the constant {}, {}, {} is used",
                            default.x, default.y, default.z
                        )),
                );
                default
            }
        }
    }

    /// A number that may be textured.
    pub(super) fn scalar(&mut self, props: &mut Props<'a>, name: &'static str, default: f32) -> ScalarInput {
        match self.color_if_given(props, name, Role::Factor) {
            Some(ColorInput::Texture(id)) => ScalarInput::Texture(id),
            Some(ColorInput::Constant(c)) if c.x == c.y && c.y == c.z => ScalarInput::Constant(c.x),
            Some(ColorInput::Constant(c)) => {
                ScalarInput::Constant(c.dot(Rgb::new(0.212671, 0.715160, 0.072169)))
            }
            None => ScalarInput::Constant(default),
        }
    }

    /// A spectrum as linear RGB; `None` after an error.
    pub(super) fn spectrum(&mut self, value: &SpectrumValue, role: Role, span: &Span) -> Option<glam::DVec3> {
        let convert = |f: &dyn Fn(f64) -> f64| match role {
            Role::Factor => sr_spectra::reflectance(f),
            Role::Emission => sr_spectra::emission(f),
        };
        let color = match value {
            // In Mitsuba 0.5 the same light at every wavelength is white; from 2.0 on it is equal energy.
            SpectrumValue::Uniform(v) if role == Role::Factor || self.origin.legacy => glam::DVec3::splat(*v),
            SpectrumValue::Uniform(v) => convert(&|_| *v),
            SpectrumValue::Samples(samples) => convert(&|w| sr_spectra::interpolate(samples, w)),
            SpectrumValue::File(name) => {
                let path = self.out.find(name);
                let read = files::read(&path, self.out.limits.scene_bytes)
                    .and_then(|bytes| values::spectrum_file(&String::from_utf8_lossy(&bytes)));
                match read {
                    Ok(samples) => convert(&|w| sr_spectra::interpolate(&samples, w)),
                    Err(reason) => {
                        self.out.d.push(files::error(
                            "mitsuba::bad-spectrum",
                            span,
                            "spectrum",
                            &path,
                            &reason,
                        ));
                        return None;
                    }
                }
            }
            SpectrumValue::Blackbody { temperature, scale } => {
                if *temperature <= 0.0 || temperature.is_nan() {
                    let message =
                        format!("a black body of {temperature} K: the temperature has to be positive");
                    self.out.d.push(Diagnostic::error("mitsuba::bad-value", span, message));
                    return None;
                }
                convert(&|w| scale * sr_spectra::blackbody(*temperature, w))
            }
        };
        if matches!(role, Role::Emission) && color.min_element() < 0.0 && color.max_element() > 0.0 {
            self.out.d.push(
                Diagnostic::warning("mitsuba::out-of-gamut", span, "a spectrum that sRGB cannot show")
                    .consequence("negative parts of its color are set to 0"),
            );
        }
        Some(if color.max_element() > 0.0 { color.max(glam::DVec3::ZERO) } else { color })
    }
}
