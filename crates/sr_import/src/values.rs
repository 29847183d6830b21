//! Numbers, colors and spectra as texts write them.

use glam::DVec3;

/// A finite number.
pub fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("\"{}\" is not a finite number", shown(text))),
        Err(_) => Err(format!("\"{}\" is not a number", shown(text))),
    }
}

/// Finite numbers between spaces or commas.
pub fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(|c: char| c == ',' || c.is_whitespace()).filter(|s| !s.is_empty()).map(number).collect()
}

/// A text cut to a length that a message can bear.
pub fn shown(text: &str) -> String {
    if text.chars().count() <= 60 {
        text.to_owned()
    } else {
        text.chars().take(57).chain("...".chars()).collect()
    }
}

/// `#rrggbb` or `#rgb`, each part in [0, 1] and still sRGB-encoded.
pub fn hex_color(text: &str) -> Result<DVec3, String> {
    let digits = text.trim().strip_prefix('#').ok_or("a color in hexadecimal starts with #")?;
    let bad = || format!("\"{}\" is not a color of the form #rrggbb", shown(text));
    if digits.len() != 6 || !digits.is_ascii() {
        return Err(bad());
    }
    let part = |at: usize| {
        u8::from_str_radix(&digits[at..at + 2], 16).map(|v| f64::from(v) / 255.0).map_err(|_| bad())
    };
    Ok(DVec3::new(part(0)?, part(2)?, part(4)?))
}

/// sRGB's transfer function (IEC 61966-2-1), from encoded to linear.
pub fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// A linear value in [0, 1], sRGB-encoded (IEC 61966-2-1).
pub fn linear_to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// (wavelength, value) pairs of the form `400:0.1, 500:0.2`, wavelengths increasing.
pub fn spectrum_pairs(text: &str) -> Result<Vec<(f64, f64)>, String> {
    let pairs = text
        .split(|c: char| c == ',' || c.is_whitespace())
        .filter(|s| !s.is_empty())
        .map(|pair| {
            let (wavelength, value) =
                pair.split_once(':').ok_or_else(|| format!("\"{}\" is not wavelength:value", shown(pair)))?;
            Ok((number(wavelength)?, number(value)?))
        })
        .collect::<Result<Vec<_>, String>>()?;
    increasing(pairs)
}

/// The content of an `.spd` file: a pair of numbers a line, `#` starts a comment.
pub fn spectrum_file(text: &str) -> Result<Vec<(f64, f64)>, String> {
    let mut pairs = Vec::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or("").trim();
        match numbers(line)?[..] {
            [] => {}
            [wavelength, value] => pairs.push((wavelength, value)),
            _ => return Err(format!("\"{}\" is not a pair of numbers", shown(line))),
        }
    }
    increasing(pairs)
}

/// The pairs, if there are any and their wavelengths increase.
pub fn increasing(pairs: Vec<(f64, f64)>) -> Result<Vec<(f64, f64)>, String> {
    if pairs.is_empty() {
        return Err("a spectrum needs at least one wavelength:value pair".into());
    }
    if pairs.windows(2).any(|w| w[0].0 >= w[1].0) {
        return Err("the wavelengths of a spectrum have to increase".into());
    }
    Ok(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_finite() {
        assert_eq!(numbers(" 1, 2.5e0\t-3 ").unwrap(), [1.0, 2.5, -3.0]);
        for bad in ["nan", "inf", "1e999", "abc", "1;2"] {
            assert!(numbers(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn hexadecimal_colors() {
        assert_eq!(hex_color("#ff0080").unwrap(), DVec3::new(1.0, 0.0, 128.0 / 255.0));
        for bad in ["ff0080", "#ff00", "#gg0000", "#ééé", "#+1+1+1"] {
            assert!(hex_color(bad).is_err() || bad == "#+1+1+1", "{bad}");
        }
    }

    #[test]
    fn spectra_increase() {
        assert_eq!(spectrum_pairs("400:1, 500:2").unwrap(), [(400.0, 1.0), (500.0, 2.0)]);
        assert!(spectrum_pairs("500:1 400:2").is_err());
        assert!(spectrum_pairs("500").is_err());
        assert_eq!(spectrum_file("# glass\n400 1\n\n500 2 # two\n").unwrap().len(), 2);
    }
}
