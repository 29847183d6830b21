//! Images of albedos below coats: what becomes of each texel's spectrum by all the bounces between base and coat.

use std::sync::LazyLock;

use glam::DVec3;
use sr_scene::Pixels;
use sr_spectra::Smooth;

use crate::values::{linear_to_srgb, srgb_to_linear};

/// Colors at which spectra are solved for, along each axis, evenly spaced as sRGB encodes them.
const NODES: usize = 17;

static SPECTRA: LazyLock<Vec<Smooth>> = LazyLock::new(|| {
    let linear = |i: usize| srgb_to_linear(i as f64 / (NODES - 1) as f64);
    let node = |i: usize| DVec3::new(linear(i % NODES), linear(i / NODES % NODES), linear(i / NODES / NODES));
    (0..NODES.pow(3)).map(|i| Smooth::reflectance(node(i))).collect()
});

/// A base below a coat that takes light away, and a clear coat over which the same is to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BelowCoat {
    /// What is left of light that crosses the coat once each way.
    pub through: f32,
    /// Of diffuse light from the base, how much returns to it.
    pub returned: f32,
    /// The same below the clear coat.
    pub returned_clear: f32,
    /// How often light meets the base.
    pub meetings: i32,
}

impl BelowCoat {
    /// What leaves the base upwards, all bounces counted, of light from outside.
    fn bounced(&self, albedo: f64) -> f64 {
        let left = albedo * f64::from(self.returned);
        f64::from(self.through) * albedo * (1.0 - left.powi(self.meetings)) / (1.0 - left)
    }

    /// The albedo below the clear coat that comes to the same.
    fn clear(&self, spectrum: &Smooth) -> DVec3 {
        let bounced = spectrum.map(|albedo| self.bounced(albedo)).max(DVec3::ZERO);
        (bounced / (1.0 + bounced * f64::from(self.returned_clear))).min(DVec3::ONE)
    }

    /// The same of a color.
    pub fn clear_albedo(&self, albedo: DVec3) -> DVec3 {
        self.clear(&Smooth::reflectance(albedo))
    }

    /// The same of each texel; bytes are sRGB-encoded and stay so.
    pub(super) fn apply(&self, mut pixels: Pixels) -> Pixels {
        let encoded = |color: DVec3| color.map(linear_to_srgb);
        let table: Vec<DVec3> = SPECTRA.iter().map(|spectrum| encoded(self.clear(spectrum))).collect();
        match &mut pixels {
            Pixels::U8 { channels, data } => {
                for texel in data.chunks_exact_mut((*channels).into()) {
                    let color = lookup(&table, rgb(texel).map(|v| f64::from(v) / 255.0));
                    write(texel, color.map(|v| (v * 255.0).round() as u8));
                }
            }
            Pixels::F32 { channels, data } => {
                for texel in data.chunks_exact_mut((*channels).into()) {
                    let linear = rgb(texel).map(|v| linear_to_srgb(f64::from(v).clamp(0.0, 1.0)));
                    write(texel, lookup(&table, linear).map(|v| srgb_to_linear(v) as f32));
                }
            }
        }
        pixels
    }
}

/// Bits, so that images can be looked up by what becomes of them.
impl Eq for BelowCoat {}

impl std::hash::Hash for BelowCoat {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        [self.through, self.returned, self.returned_clear].map(f32::to_bits).hash(state);
        self.meetings.hash(state);
    }
}

/// Three colors, also of a grey texel.
fn rgb<T: Copy>(texel: &[T]) -> [T; 3] {
    match *texel {
        [r, g, b, ..] => [r, g, b],
        _ => [texel[0]; 3],
    }
}

fn write<T: Copy>(texel: &mut [T], color: [T; 3]) {
    let len = if texel.len() >= 3 { 3 } else { 1 };
    texel[..len].copy_from_slice(&color[..len]);
}

/// Between the eight nodes around an encoded color, linearly along each axis.
fn lookup(table: &[DVec3], encoded: [f64; 3]) -> [f64; 3] {
    let at = encoded.map(|v| v * (NODES - 1) as f64);
    let low = at.map(|v| (v as usize).min(NODES - 2));
    let [x, y, z] = [0, 1, 2].map(|axis| at[axis] - low[axis] as f64);
    let first = low[0] + NODES * (low[1] + NODES * low[2]);
    let edge = |i: usize| table[i].lerp(table[i + 1], x);
    let face = |i: usize| edge(i).lerp(edge(i + NODES), y);
    face(first).lerp(face(first + NODES * NODES), z).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    const COAT: BelowCoat = BelowCoat { through: 0.97, returned: 0.57, returned_clear: 0.596, meetings: 5 };

    /// Each texel is what its color alone would be.
    #[test]
    fn texels_are_as_colors() {
        let colors = [[200_u8, 120, 30], [255, 255, 255], [0, 0, 0], [90, 91, 89], [13, 240, 200]];
        let pixels = Pixels::U8 { channels: 3, data: colors.concat() };
        let Pixels::U8 { data, .. } = COAT.apply(pixels) else { panic!() };
        for (got, color) in data.chunks_exact(3).zip(colors) {
            let linear = DVec3::from(color.map(|v| srgb_to_linear(f64::from(v) / 255.0)));
            let expected = COAT.clear_albedo(linear).map(linear_to_srgb) * 255.0;
            for (got, expected) in got.iter().zip(expected.to_array()) {
                assert!((f64::from(*got) - expected).abs() < 2.0, "{color:?}: {got}, not {expected}");
            }
        }
    }

    #[test]
    fn grey_images_stay_grey_and_opacity_stays() {
        let grey = COAT.apply(Pixels::U8 { channels: 1, data: vec![0, 128, 255] });
        let Pixels::U8 { channels: 1, data } = grey else { panic!("{grey:?}") };
        assert!(data[0] == 0 && data[1] < 128 && data[2] < 255, "{data:?}");
        let Pixels::F32 { data, .. } =
            COAT.apply(Pixels::F32 { channels: 4, data: vec![2.0, 0.5, 0.1, 0.25] })
        else {
            panic!()
        };
        assert!(data[3] == 0.25 && data.iter().all(|v| (0.0..=1.0).contains(v)), "{data:?}");
    }
}
