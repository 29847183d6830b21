//! Numbers that are worked out from those of an image: decoded, scaled, inverted, averaged, and their roots.

use sr_scene::Pixels;

use crate::values::srgb_to_linear;

/// How 8-bit and 16-bit values stand for linear ones. Floating point is linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    Linear,
    Srgb,
    /// A power; its bits, so that it can be compared.
    Gamma(u32),
}

impl Encoding {
    /// A linear value is one of the file's to this power.
    pub fn gamma(power: f32) -> Self {
        Self::Gamma(power.to_bits())
    }

    fn decode(self, value: f32) -> f32 {
        match self {
            Self::Linear => value,
            Self::Srgb => srgb_to_linear(f64::from(value)) as f32,
            Self::Gamma(bits) => value.powf(f32::from_bits(bits)),
        }
    }
}

/// What becomes of each texel: `offset + factor · value`, not below 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TexelMap {
    encoding: Encoding,
    /// One number for each texel: the mean of its colors, or its opacity where the image has one.
    is_scalar: bool,
    /// The bits of two numbers, so that they can be compared.
    offset: u32,
    factor: u32,
    /// Is the square root taken last?
    root: bool,
}

impl TexelMap {
    /// Linear values, three for each texel or one.
    pub fn new(encoding: Encoding, is_scalar: bool) -> Self {
        Self { encoding, is_scalar, offset: 0.0f32.to_bits(), factor: 1.0f32.to_bits(), root: false }
    }

    /// Times a number.
    pub fn scaled(self, by: f32) -> Self {
        let times = |bits: u32| (f32::from_bits(bits) * by).to_bits();
        Self { offset: times(self.offset), factor: times(self.factor), ..self }
    }

    /// One less the values, if `invert`.
    pub fn inverted(self, invert: bool) -> Self {
        if !invert {
            return self;
        }
        let (offset, factor) = (f32::from_bits(self.offset), f32::from_bits(self.factor));
        Self { offset: (1.0 - offset).to_bits(), factor: (-factor).to_bits(), ..self }
    }

    /// The square roots of the values.
    pub fn rooted(self) -> Self {
        Self { root: true, ..self }
    }

    /// Works out an image. `is_encoded`: is its data what `encoding` speaks about?
    pub(super) fn apply(self, pixels: Pixels, is_encoded: bool) -> Pixels {
        let encoding = if is_encoded { self.encoding } else { Encoding::Linear };
        let (channels, data) = match pixels {
            Pixels::U8 { channels, data } => {
                (usize::from(channels), data.iter().map(|&v| f32::from(v) / 255.0).collect())
            }
            Pixels::F32 { channels, data } => (usize::from(channels), data),
        };
        let finished = |value: f32| {
            let value = (f32::from_bits(self.offset) + f32::from_bits(self.factor) * value).max(0.0);
            if self.root { value.sqrt() } else { value }
        };
        if !self.is_scalar {
            let texels = data.chunks_exact(channels).flat_map(|texel| match *texel {
                [grey] => [grey; 3],
                _ => [texel[0], texel[1], texel[2]],
            });
            let data = texels.map(|v| finished(encoding.decode(v))).collect();
            return Pixels::F32 { channels: 3, data };
        }
        let is_transparent = channels == 4 && data.iter().skip(3).step_by(4).any(|&alpha| alpha != 1.0);
        let data = data.chunks_exact(channels).map(|texel| {
            finished(match texel {
                [_, _, _, alpha] if is_transparent => *alpha,
                [r, g, b, ..] => [r, g, b].into_iter().map(|&v| encoding.decode(v)).sum::<f32>() / 3.0,
                _ => encoding.decode(texel[0]),
            })
        });
        Pixels::F32 { channels: 1, data: data.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apply(map: TexelMap, channels: u8, data: &[u8]) -> Vec<f32> {
        match map.apply(Pixels::U8 { channels, data: data.to_vec() }, true) {
            Pixels::F32 { data, .. } => data,
            Pixels::U8 { .. } => panic!("floating point was expected"),
        }
    }

    #[test]
    fn numbers_are_worked_out_in_order() {
        let map = TexelMap::new(Encoding::Linear, true);
        assert_eq!(apply(map.scaled(0.5), 3, &[255, 0, 255]), [1.0 / 3.0]);
        assert_eq!(apply(map.scaled(0.25).inverted(true), 1, &[255]), [0.75]);
        assert_eq!(apply(map.scaled(0.25).rooted(), 1, &[255]), [0.5]);
        let squared = apply(TexelMap::new(Encoding::gamma(2.0), true), 1, &[51]);
        assert!((squared[0] - 0.04).abs() < 1e-6);
    }

    #[test]
    fn opacity_goes_before_color_where_it_says_something() {
        let map = TexelMap::new(Encoding::Linear, true);
        assert_eq!(apply(map, 4, &[255, 255, 255, 0, 0, 0, 0, 255]), [0.0, 1.0]);
        assert_eq!(apply(map, 4, &[255, 255, 255, 255, 0, 0, 0, 255]), [1.0, 0.0]);
        assert_eq!(apply(TexelMap::new(Encoding::Linear, false), 4, &[255, 0, 0, 9]), [1.0, 0.0, 0.0]);
    }
}
