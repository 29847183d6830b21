//! From radiance to the display: exposure, tone curve, sRGB encoding.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use crate::image::luminance;

/// A curve that brings radiance into [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// None: what is above 1 is clipped.
    #[default]
    Srgb,
    /// L / (1 + L) on luminance (Reinhard et al. 2002, "Photographic tone reproduction for digital images",
    /// eq. 3), then clipped.
    Reinhard,
    /// x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) on each channel: Narkowicz's fit of the ACES curve
    /// (K. Narkowicz 2015, "ACES filmic tone mapping curve").
    Filmic,
}

/// How an image is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// In stops: radiance is multiplied by 2^exposure.
    pub exposure: f32,
    /// The curve.
    pub tone: Tone,
}

/// There is no tone curve of that name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no tone curve {name:?}; there are srgb, reinhard and filmic")]
pub struct UnknownTone {
    /// The name given.
    pub name: String,
}

impl Tone {
    /// Every curve.
    pub const ALL: [Self; 3] = [Self::Srgb, Self::Reinhard, Self::Filmic];

    /// Its name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::Reinhard => "reinhard",
            Self::Filmic => "filmic",
        }
    }

    fn apply(self, rgb: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Srgb => rgb,
            Self::Reinhard => {
                let scale = 1.0 / (1.0 + luminance(rgb.map(f64::from)) as f32);
                rgb.map(|x| x * scale)
            }
            Self::Filmic => rgb.map(|x| x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)),
        }
    }
}

impl fmt::Display for Tone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Tone {
    type Err = UnknownTone;

    fn from_str(name: &str) -> Result<Self, UnknownTone> {
        Self::ALL
            .into_iter()
            .find(|tone| tone.name() == name)
            .ok_or_else(|| UnknownTone { name: name.to_owned() })
    }
}

impl Display {
    /// The 8-bit sRGB code of linear RGB radiance. NaN and negative values show as black, infinite as white.
    pub fn encode(self, rgb: [f32; 3]) -> [u8; 3] {
        let exposed = rgb.map(|x| (x * self.exposure.exp2()).clamp(0.0, 1e8));
        self.tone.apply(exposed.map(|x| if x.is_nan() { 0.0 } else { x })).map(srgb_code)
    }
}

/// IEC 61966-2-1, rounded to 8 bits.
fn srgb_code(linear: f32) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(tone: Tone, exposure: f32, value: f32) -> u8 {
        Display { exposure, tone }.encode([value; 3])[1]
    }

    #[test]
    fn known_codes() {
        assert_eq!(grey(Tone::Srgb, 0.0, 0.5), 188);
        assert_eq!(grey(Tone::Srgb, 1.0, 0.25), 188);
        assert_eq!(grey(Tone::Srgb, 0.0, 0.001), 3);
        assert_eq!(grey(Tone::Reinhard, 0.0, 1.0), 188);
        // (2.51 + 0.03) / (2.43 + 0.59 + 0.14) = 0.8038, encoded 0.9082
        assert_eq!(grey(Tone::Filmic, 0.0, 1.0), 232);
    }

    #[test]
    fn curves_rise_and_bear_anything() {
        for tone in Tone::ALL {
            let codes: Vec<u8> = (0..200).map(|i| grey(tone, 0.0, 0.05 * i as f32)).collect();
            assert!(codes.is_sorted(), "{tone} falls");
            assert_eq!(grey(tone, 0.0, f32::NAN), 0, "{tone}");
            assert_eq!(grey(tone, 0.0, -1.0), 0, "{tone}");
            assert_eq!(grey(tone, 0.0, f32::INFINITY), 255, "{tone}");
            assert_eq!(tone.name().parse(), Ok(tone));
        }
        assert!("agx".parse::<Tone>().unwrap_err().to_string().contains("filmic"));
    }
}
