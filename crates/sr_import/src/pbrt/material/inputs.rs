//! What materials are made from: albedos, indices, roughness.

use glam::DVec3;
use sr_scene::{ColorInput, Rgb, ScalarInput, Span};

use super::{Curve, FloatTexture, GREY, Params, Reader, is_smooth};
use crate::pbrt::color::known;
use crate::pbrt::syntax::Kind;

impl Reader<'_> {
    /// A color of at most 1.
    pub(super) fn albedo(&mut self, params: &mut Params, name: &'static str, default: Rgb) -> ColorInput {
        match self.color_or_texture(params, name) {
            Some(ColorInput::Constant(color)) => {
                if color.max_element() > 1.0 {
                    let message = format!("\"{name}\" of {} is above 1", params.title);
                    self.warn("pbrt::bad-value", &params.span, message, "1 is used there, as in pbrt");
                }
                self.note_saturated(color, &params.span);
                ColorInput::Constant(color.min(Rgb::ONE))
            }
            Some(texture) => texture,
            None => ColorInput::Constant(default),
        }
    }

    /// Says that light has a spectrum in pbrt, if that shows: a color reflects much of one primary and little of another.
    fn note_saturated(&mut self, color: Rgb, span: &Span) {
        if color.max_element() > 0.2 && color.min_element() < 0.2 * color.max_element() {
            let message =
                "light has a spectrum in pbrt, and is red, green and blue here: this color is saturated";
            self.note(
                "pbrt::spectral-color",
                span,
                message,
                "light that bounces off it differs by some percent",
            );
        }
    }

    /// An index of refraction; one that depends on the wavelength is that of yellow light.
    pub(super) fn eta(&mut self, params: &mut Params, name: &'static str, default: f32) -> f32 {
        let textured = match self.float_or_texture(params, name) {
            Some(FloatTexture::Constant(eta)) => return self.sound_eta(eta, params, default),
            Some(_) => true,
            None => false,
        };
        if textured {
            let message = format!("\"{name}\" of {} cannot be a texture", params.title);
            self.warn("pbrt::texture-not-possible", &params.span, message, &format!("{default} is used"));
            return default;
        }
        let Some((span, curve)) = self.curve(params, name) else { return default };
        let eta = match curve {
            Curve::Constant(eta) => eta as f32,
            other => {
                let message = "dispersion is not supported";
                self.warn("pbrt::dispersion", &span, message, "one index is used for all colors");
                other.surface(self.state.color_space).y as f32
            }
        };
        self.sound_eta(eta, params, default)
    }

    fn sound_eta(&mut self, eta: f32, params: &Params, default: f32) -> f32 {
        if eta > 0.0 && eta.is_finite() {
            return eta;
        }
        let message = format!("an index of refraction of {eta} of {}", params.title);
        self.warn("pbrt::bad-value", &params.span, message, "the default is used");
        default
    }

    /// α along the tangent and the bitangent, from `names` for u, for v, and for both.
    pub(super) fn alpha(
        &mut self,
        params: &mut Params,
        names: [&'static str; 3],
        default: f32,
    ) -> [ScalarInput; 2] {
        let remap = params.boolean("remaproughness").unwrap_or(true);
        let both = self.float_or_texture(params, names[2]).unwrap_or(FloatTexture::Constant(default));
        let span = params.span.clone();
        [names[0], names[1]]
            .map(|name| {
                let own = self.float_or_texture(params, name).unwrap_or_else(|| both.clone());
                if let FloatTexture::Constant(roughness) = own
                    && roughness < 0.0
                {
                    let message = format!("a roughness of {roughness} of {}", params.title);
                    self.warn("pbrt::bad-value", &span, message, "0 is used");
                }
                match remap {
                    true => self.as_root(own, &span),
                    false => self.as_scalar(own),
                }
            })
            .map(|alpha| match alpha {
                // A little more than nothing, where only one of the two directions is smooth.
                ScalarInput::Constant(alpha) => ScalarInput::Constant(alpha.max(1e-4)),
                texture => texture,
            })
    }

    /// One number for models that know no other; `None` is smooth.
    pub(super) fn constant_alpha(&mut self, alpha: [ScalarInput; 2], params: &Params) -> Option<f32> {
        /// Instead of a texture.
        const TEXTURED: f32 = 0.2;
        if is_smooth(&alpha) {
            return None;
        }
        match alpha {
            [ScalarInput::Constant(u), ScalarInput::Constant(v)] => {
                if u != v {
                    let message =
                        format!("the roughness of {} cannot differ between directions", params.title);
                    self.warn("pbrt::anisotropy", &params.span, message, "the geometric mean is used");
                }
                Some((u * v).sqrt())
            }
            _ => {
                let message = format!("the roughness of {} cannot be a texture", params.title);
                let consequence = format!("alpha = {TEXTURED} is used");
                self.warn("pbrt::texture-not-possible", &params.span, message, &consequence);
                Some(TEXTURED)
            }
        }
    }

    /// The complex index of a metal, copper by default, and what scales its reflection. With a `reflectance`, the index
    /// that has it at a right angle. `above`: the index of what is on the metal.
    pub(super) fn complex_index(
        &mut self,
        params: &mut Params,
        [eta, k]: [&'static str; 2],
        above: f32,
    ) -> (Option<(ColorInput, ColorInput)>, ColorInput) {
        let one = ColorInput::Constant(Rgb::ONE);
        if params.has("reflectance") {
            return match self.albedo(params, "reflectance", GREY) {
                // pbrt: η = 1, k = 2 √r / √(1 − r).
                ColorInput::Constant(r) => {
                    let r = r.min(Rgb::splat(0.9999));
                    let k = 2.0 * (r / (1.0 - r)).map(f32::sqrt);
                    (Some((one, ColorInput::Constant(k))), one)
                }
                texture => {
                    let message = format!("the texture of \"reflectance\" of {}", params.title);
                    self.warn("pbrt::reflectance", &params.span, message, "it is the same at all angles");
                    (None, texture)
                }
            };
        }
        let mut input = |name, default: &str| match self.textured(params, name) {
            Some(texture) => Err(texture),
            None => {
                let curve = self.curve(params, name).map(|(_, curve)| curve);
                if let Some(Curve::Rgb(color)) = curve
                    && color.min_element() < 0.0
                {
                    let message = format!("negative parts of \"{name}\" of {}", params.title);
                    self.warn("pbrt::bad-value", &params.span, message, "0 is used there");
                }
                Ok(curve.or_else(|| known(default)))
            }
        };
        let (eta, k) = (input(eta, "metal-Cu-eta"), input(k, "metal-Cu-k"));
        let space = self.state.color_space;
        if let (Ok(Some(eta)), Ok(Some(k))) = (&eta, &k)
            && let (Some(eta), Some(k)) = (eta.spectrum(space), k.spectrum(space))
        {
            let message =
                "light has a spectrum in pbrt, and is red, green and blue here: so is what metals reflect";
            self.note("pbrt::spectral-metal", &params.span, message, "at an angle it differs by up to 1 %");
            let (eta, k) = sr_spectra::metal(eta, k, above.into());
            let constant = |color: DVec3| ColorInput::Constant(color.as_vec3());
            return (Some((constant(eta), constant(k))), one);
        }
        let constant = |curve: Option<Curve>| match curve {
            Some(curve) => ColorInput::Constant(curve.surface(space).max(DVec3::ZERO).as_vec3()),
            None => one,
        };
        let input =
            |result: Result<Option<Curve>, ColorInput>| result.map_or_else(|texture| texture, constant);
        (Some((input(eta), input(k))), one)
    }

    /// The texture that `name` names, if it names one.
    fn textured(&mut self, params: &mut Params, name: &'static str) -> Option<ColorInput> {
        params.find(name, &[Kind::Texture])?;
        self.color_or_texture(params, name)
    }
}
