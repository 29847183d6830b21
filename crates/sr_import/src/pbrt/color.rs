//! Parameters with a color: RGB, spectra, black bodies.

use glam::{DVec2, DVec3};
use sr_scene::{Diagnostic, Rgb, Span};

use super::Reader;
use super::params::Params;
use super::syntax::{Kind, Values};
use crate::color_space::{ColorSpace, xyz_of};
use crate::files;
use crate::values::{self, shown};
use sr_spectra::{Samples, Smooth};

/// All types that a color can be declared with.
const KINDS: &[Kind] = &[Kind::Rgb, Kind::Spectrum, Kind::Blackbody, Kind::Float];

/// η and k of brass in linear RGB: the integrals of the spectra that pbrt calls `metal-CuZn`.
const BRASS: [[f64; 3]; 2] = [[0.51977, 0.48851, 1.04201], [4.33058, 2.54811, 1.59189]];

/// A function of the wavelength, as it was written.
#[derive(Clone, Debug)]
pub enum Curve {
    /// In the color space that is in force.
    Rgb(DVec3),
    /// In linear sRGB, whatever color space is in force.
    Srgb(DVec3),
    /// The same at all wavelengths.
    Constant(f64),
    Samples(Samples),
    /// In K.
    Blackbody(f64),
    /// A light of this chromaticity x, y.
    Light([f64; 2]),
}

impl Curve {
    /// As a reflectance, a transmittance or an index.
    pub fn surface(&self, space: ColorSpace) -> DVec3 {
        match self {
            Self::Rgb(color) => space.surface_to_srgb(*color),
            Self::Srgb(color) => *color,
            Self::Constant(v) => DVec3::splat(*v),
            Self::Samples(samples) => sr_spectra::reflectance(|w| sr_spectra::interpolate(samples, w)),
            Self::Blackbody(_) | Self::Light(_) => self.light(space),
        }
    }

    /// Over wavelengths in nm, as an index; colors as smooth spectra. `None`: a light's.
    pub fn spectrum(&self, space: ColorSpace) -> Option<impl Fn(f64) -> f64> {
        let smooth = match self {
            Self::Rgb(_) | Self::Srgb(_) => Smooth::unbounded(self.surface(space).max(DVec3::ZERO)),
            Self::Constant(value) => Smooth::Grey(*value),
            Self::Samples(_) => Smooth::Grey(0.0),
            Self::Blackbody(_) | Self::Light(_) => return None,
        };
        Some(move |w| match self {
            Self::Samples(samples) => sr_spectra::interpolate(samples, w),
            _ => smooth.at(w),
        })
    }

    /// As a light. Spectra have the luminance 1, as pbrt-v4 scales them, RGB colors have their own.
    pub fn light(&self, space: ColorSpace) -> DVec3 {
        let color = match self {
            Self::Rgb(color) => Some(space.light_to_srgb(*color)),
            Self::Srgb(color) => Some(*color),
            Self::Constant(_) => sr_spectra::color_of_light(|_| 1.0),
            Self::Samples(samples) => sr_spectra::color_of_light(|w| sr_spectra::interpolate(samples, w)),
            Self::Blackbody(kelvin) => sr_spectra::color_of_light(|w| sr_spectra::blackbody(*kelvin, w)),
            Self::Light(xy) => Some(sr_spectra::rgb_from_xyz(xyz_of(DVec2::from(*xy)))),
        };
        color.unwrap_or(DVec3::ZERO)
    }
}

impl Reader<'_> {
    /// The reflectance, transmittance or index `name`.
    pub(super) fn surface_color(&mut self, params: &mut Params, name: &'static str) -> Option<Rgb> {
        let (span, curve) = self.curve(params, name)?;
        let color = curve.surface(self.state.color_space);
        Some(self.in_gamut(color, &span))
    }

    /// The light `name`.
    pub(super) fn light_color(&mut self, params: &mut Params, name: &'static str) -> Option<Rgb> {
        let (span, curve) = self.curve(params, name)?;
        let color = curve.light(self.state.color_space);
        Some(self.in_gamut(color, &span))
    }

    /// The white of the color space in force, as a light.
    pub(super) fn white_light(&self) -> Rgb {
        self.state.color_space.light_to_srgb(DVec3::ONE).as_vec3()
    }

    fn in_gamut(&mut self, color: DVec3, span: &Span) -> Rgb {
        if color.min_element() < -1e-3 * color.abs().max_element() {
            let message = "a color that sRGB cannot show";
            self.warn("pbrt::out-of-gamut", span, message, "its negative parts are set to 0");
        }
        color.max(DVec3::ZERO).as_vec3()
    }

    /// The function of the wavelength `name`; `None` if there is none, or after an error.
    pub(super) fn curve(&mut self, params: &mut Params, name: &'static str) -> Option<(Span, Curve)> {
        let (span, parameter) = params.find(name, KINDS)?;
        let (kind, values) = (parameter.kind, parameter.values.clone());
        let result = match (kind, values) {
            (Kind::Rgb, Values::Floats(v)) => rgb(&v).map(Curve::Rgb),
            (Kind::Blackbody, Values::Floats(v)) => match v.first() {
                Some(&kelvin) if kelvin > 0.0 => Ok(Curve::Blackbody(kelvin.into())),
                _ => Err("a black body needs a positive temperature".to_owned()),
            },
            (_, Values::Floats(v)) => sampled(&v),
            (_, Values::Strings(names)) => match names.first() {
                Some(text) => return self.named_curve(text, span),
                None => Err("a spectrum without a name or values".to_owned()),
            },
            _ => Err("this is not a color".to_owned()),
        };
        match result {
            Ok(curve) => Some((span, curve)),
            Err(message) => {
                self.error("pbrt::bad-value", &span, message);
                None
            }
        }
    }

    fn named_curve(&mut self, name: &str, span: Span) -> Option<(Span, Curve)> {
        if let Some(curve) = known(name) {
            return Some((span, curve));
        }
        let path = self.out.find(name);
        let looks_like_a_file = name.contains(['.', '/', '\\']);
        if !looks_like_a_file && !path.exists() {
            let message = format!("no spectrum is known by the name of \"{}\"", shown(name));
            let names = sr_spectra::GLASSES.iter().map(|(known, _)| *known);
            let metals = ["metal-Ag-eta", "metal-Al-eta", "metal-Au-eta", "metal-Cu-eta", "stdillum-D65"];
            let note = Diagnostic::warning("pbrt::unknown-value", &span, message)
                .guess(name, names.chain(metals))
                .consequence("it is taken as 1 at all wavelengths");
            self.notes().push(note);
            return Some((span, Curve::Constant(1.0)));
        }
        let read = files::read(&path, self.out.limits.scene_bytes)
            .and_then(|bytes| values::spectrum_file(&String::from_utf8_lossy(&bytes)));
        match read {
            Ok(samples) => Some((span, Curve::Samples(samples))),
            Err(reason) => {
                let error = files::error("file::bad-spectrum", &span, "spectrum", &path, &reason);
                self.notes().push(error);
                None
            }
        }
    }
}

/// The spectra that pbrt-v4 has names for.
pub(super) fn known(name: &str) -> Option<Curve> {
    if let Some(xy) = sr_spectra::illuminant(name) {
        return Some(Curve::Light(xy));
    }
    if let Some(index) = sr_spectra::glass(name) {
        return Some(Curve::Constant(index));
    }
    let (metal, part) = name.strip_prefix("metal-")?.rsplit_once('-')?;
    let part = ["eta", "k"].iter().position(|p| *p == part)?;
    if metal == "CuZn" {
        return Some(Curve::Srgb(DVec3::from(BRASS[part])));
    }
    let (eta, k) = sr_spectra::named_metal(metal)?;
    Some(Curve::Samples(if part == 0 { eta } else { k }))
}

fn rgb(v: &[f32]) -> Result<DVec3, String> {
    match *v {
        [r, g, b] => Ok(DVec3::new(r.into(), g.into(), b.into())),
        _ => Err(format!("a color has three numbers, not {}", v.len())),
    }
}

/// Pairs of a wavelength and a value, or one value for all.
fn sampled(v: &[f32]) -> Result<Curve, String> {
    if let [value] = *v {
        return Ok(Curve::Constant(value.into()));
    }
    if !v.len().is_multiple_of(2) {
        return Err("a spectrum is pairs of a wavelength and a value".into());
    }
    let pairs = v.chunks_exact(2).map(|pair| (f64::from(pair[0]), f64::from(pair[1]))).collect();
    values::increasing(pairs).map(Curve::Samples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names() {
        assert!(matches!(known("metal-Ag-eta"), Some(Curve::Samples(_))));
        assert!(matches!(known("metal-CuZn-k"), Some(Curve::Srgb(_))));
        assert!(matches!(known("glass-BK7"), Some(Curve::Constant(v)) if (v - 1.5168).abs() < 1e-9));
        assert!(known("metal-Xx-eta").is_none() && known("metal").is_none());
        let d65 = known("stdillum-D65").unwrap().light(ColorSpace::Srgb);
        assert!((d65 - 1.0).abs().max_element() < 3e-3, "{d65}");
    }

    #[test]
    fn lights_have_the_luminance_one() {
        let luminance = DVec3::new(0.212671, 0.715160, 0.072169);
        for curve in [Curve::Blackbody(2700.0), Curve::Constant(7.0), Curve::Light([0.44758, 0.40745])] {
            let light = curve.light(ColorSpace::Srgb);
            assert!((light.dot(luminance) - 1.0).abs() < 1e-3, "{curve:?}: {light}");
        }
    }
}
