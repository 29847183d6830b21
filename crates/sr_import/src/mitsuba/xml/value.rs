//! The attributes of a value element to a [`Value`].

use glam::DVec3;

use super::elements::ValueKind;
use crate::mitsuba::attributes::Attributes;
use crate::mitsuba::node::{SpectrumValue, Value};
use crate::values::{self, shown};

/// Reads a value; `Err` is a sentence.
pub fn read(kind: ValueKind, attributes: &mut Attributes<'_, '_>) -> Result<Value, String> {
    Ok(match kind {
        ValueKind::Float => Value::Float(values::number(attributes.required("value")?)?),
        ValueKind::Integer => {
            let text = attributes.required("value")?.trim();
            Value::Integer(text.parse().map_err(|_| format!("\"{}\" is not an integer", shown(text)))?)
        }
        ValueKind::Boolean => match attributes.required("value")?.trim().to_ascii_lowercase().as_str() {
            "true" => Value::Boolean(true),
            "false" => Value::Boolean(false),
            other => return Err(format!("\"{}\" is neither true nor false", shown(other))),
        },
        ValueKind::String => Value::String(attributes.required("value")?.to_owned()),
        ValueKind::Vector => Value::Vector(attributes.vector(0.0)?),
        ValueKind::Rgb => Value::Rgb(color(attributes.required("value")?, |linear| linear)?),
        ValueKind::Srgb => {
            Value::Rgb(color(attributes.required("value")?, |encoded| encoded.map(values::srgb_to_linear))?)
        }
        ValueKind::Spectrum => Value::Spectrum(spectrum(attributes)?),
        ValueKind::Blackbody => {
            let temperature = attributes.required("temperature")?;
            // Mitsuba 0.5 allows a unit: "5000K".
            let temperature = values::number(temperature.trim().trim_end_matches(['K', 'k']))?;
            let scale = attributes.number("scale")?.unwrap_or(1.0);
            Value::Spectrum(SpectrumValue::Blackbody { temperature, scale })
        }
    })
}

/// A color in hexadecimal, which is always sRGB, or one of numbers, which `linear` makes linear.
fn color(text: &str, linear: impl Fn(DVec3) -> DVec3) -> Result<DVec3, String> {
    if text.trim_start().starts_with('#') {
        return Ok(values::hex_color(text)?.map(values::srgb_to_linear));
    }
    match values::numbers(text)?[..] {
        [v] => Ok(linear(DVec3::splat(v))),
        [r, g, b] => Ok(linear(DVec3::new(r, g, b))),
        ref other => Err(format!("a color has three numbers (or one for all), not {}", other.len())),
    }
}

fn spectrum(attributes: &mut Attributes<'_, '_>) -> Result<SpectrumValue, String> {
    if let Some(file) = attributes.text("filename") {
        return Ok(SpectrumValue::File(file.to_owned()));
    }
    let text = attributes.required("value")?;
    if text.contains(':') {
        return Ok(SpectrumValue::Samples(values::spectrum_pairs(text)?));
    }
    Ok(SpectrumValue::Uniform(values::number(text)?))
}
