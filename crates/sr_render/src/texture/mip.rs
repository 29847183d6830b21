//! Smaller copies of an image, each half as wide as the one before (Williams 1983).
//!
//! In: an image. Out: [`Pyramid`]. Copies have the form of the image: eight bits stay eight bits, so that all copies together
//! take a third of its memory.

use sr_scene::{Image, Pixels, Rgb};

use super::texel::{DECODED, texel};

/// The copies of an image, from half its size down to one texel.
#[derive(Clone, Debug)]
pub(super) struct Pyramid {
    levels: Vec<Image>,
}

impl Pyramid {
    /// Copies of an image that is sRGB-encoded or not.
    pub fn new(image: &Image, srgb: bool) -> Self {
        let mut linear = Linear::of(image, srgb);
        let mut levels = Vec::new();
        while linear.width > 1 || linear.height > 1 {
            linear = linear.halved();
            levels.push(linear.encoded(image, srgb));
        }
        Self { levels }
    }

    pub fn levels(&self) -> impl Iterator<Item = &Image> {
        self.levels.iter()
    }

    /// What is seen through a footprint of so many texels of `base`: `of` looks an image up.
    #[inline]
    pub fn lookup(&self, base: &Image, texels: f32, of: impl Fn(&Image) -> Rgb) -> Rgb {
        // also where the footprint is no number
        let level = if texels > 1.0 { texels.log2().min(self.levels.len() as f32) } else { 0.0 };
        let at = |level: usize| if level == 0 { base } else { &self.levels[level - 1] };
        let (finer, t) = (level as usize, level.fract());
        let color = of(at(finer));
        if t == 0.0 { color } else { color.lerp(of(at(finer + 1)), t) }
    }
}

/// An image as it is averaged.
struct Linear {
    width: u32,
    height: u32,
    data: Vec<Rgb>,
}

impl Linear {
    fn of(image: &Image, srgb: bool) -> Self {
        let (width, height) = (image.width, image.height);
        let data = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self { width, height, data: data.map(|(x, y)| texel(image, srgb, x, y)).collect() }
    }

    /// Half as wide and high, rounded down: each texel is the mean of what it covers, so that the image's mean stays.
    fn halved(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let (columns, rows) = (covers(self.width, width), covers(self.height, height));
        let mut data = Vec::with_capacity(width as usize * height as usize);
        for (first_row, of_rows) in &rows {
            for (first_column, of_columns) in &columns {
                let mut sum = Rgb::ZERO;
                for (y, row_weight) in (*first_row..).zip(of_rows) {
                    for (x, weight) in (*first_column..).zip(of_columns) {
                        sum += self.data[(y * self.width + x) as usize] * (row_weight * weight);
                    }
                }
                data.push(sum);
            }
        }
        Self { width, height, data }
    }

    /// In the form of `like`; alpha, which no lookup reads, is left out.
    fn encoded(&self, like: &Image, srgb: bool) -> Image {
        let is_grey = |channels: u8| channels < 3;
        let parts = |channels: u8| {
            let count = if is_grey(channels) { 1 } else { 3 };
            self.data.iter().flat_map(move |c| c.to_array().into_iter().take(count))
        };
        let channels = |channels: u8| if is_grey(channels) { 1 } else { 3 };
        let pixels = match &like.pixels {
            Pixels::U8 { channels: c, .. } => Pixels::U8 {
                channels: channels(*c),
                data: parts(*c).map(|v| nearest_code(v, &DECODED[usize::from(srgb)])).collect(),
            },
            Pixels::F32 { channels: c, .. } => {
                Pixels::F32 { channels: channels(*c), data: parts(*c).collect() }
            }
        };
        Image { name: like.name.clone(), width: self.width, height: self.height, pixels }
    }
}

/// Per texel of `to`, the first of `from` that it covers, and what each of those weighs.
fn covers(from: u32, to: u32) -> Vec<(u32, Vec<f32>)> {
    let per = f64::from(from) / f64::from(to);
    (0..to)
        .map(|i| {
            let (start, end) = (f64::from(i) * per, f64::from(i + 1) * per);
            let last = (end.ceil() as u32).min(from);
            let weight = |x: u32| {
                let covered = end.min(f64::from(x + 1)) - start.max(f64::from(x));
                (covered.max(0.0) / per) as f32
            };
            (start as u32, (start as u32..last).map(weight).collect())
        })
        .collect()
}

/// The code whose value is nearest, in a table that rises.
fn nearest_code(value: f32, decoded: &[f32; 256]) -> u8 {
    let above = decoded.partition_point(|&v| v < value).clamp(1, 255);
    (if value - decoded[above - 1] < decoded[above] - value { above - 1 } else { above }) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, code: impl Fn(u32, u32) -> u8) -> Image {
        let data =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| code(x, y)).collect();
        Image { name: "t".into(), width, height, pixels: Pixels::U8 { channels: 1, data } }
    }

    #[test]
    fn levels_halve_and_keep_the_mean_and_the_form() {
        let base = image(13, 6, |x, y| ((x * 7 + y * 31) % 200) as u8);
        let pyramid = Pyramid::new(&base, false);
        let sizes: Vec<_> = pyramid.levels().map(|l| (l.width, l.height)).collect();
        assert_eq!(sizes, [(6, 3), (3, 1), (1, 1)]);
        let mean = |image: &Image| {
            let texels = (0..image.height).flat_map(|y| (0..image.width).map(move |x| (x, y)));
            texels.map(|(x, y)| texel(image, false, x, y).x).sum::<f32>()
                / (image.width * image.height) as f32
        };
        for level in pyramid.levels() {
            assert!(matches!(&level.pixels, Pixels::U8 { channels: 1, .. }));
            assert!((mean(level) - mean(&base)).abs() < 0.5 / 255.0, "{} and {}", mean(level), mean(&base));
        }
    }

    #[test]
    fn srgb_is_averaged_as_light() {
        // half black, half white: code 188 shows half the light
        let pyramid = Pyramid::new(&image(2, 2, |x, _| if x == 0 { 0 } else { 255 }), true);
        let Pixels::U8 { data, .. } = &pyramid.levels[0].pixels else { panic!() };
        assert_eq!(data[..], [188]);
    }

    #[test]
    fn footprints_choose_levels() {
        let base = image(8, 8, |_, _| 0);
        let pyramid = Pyramid::new(&base, false);
        let width = |texels: f32| pyramid.lookup(&base, texels, |image| Rgb::splat(image.width as f32)).x;
        for (texels, expected) in
            [(0.0, 8.0), (1.0, 8.0), (2.0, 4.0), (4.0, 2.0), (8.0, 1.0), (1e30, 1.0), (f32::NAN, 8.0)]
        {
            assert_eq!(width(texels), expected, "{texels} texels");
        }
        assert!((width(8f32.sqrt()) - 3.0).abs() < 1e-5, "between two");
        let single = image(1, 1, |_, _| 9);
        let pyramid = Pyramid::new(&single, false);
        assert_eq!(pyramid.lookup(&single, 99.0, |image| Rgb::splat(image.width as f32)).x, 1.0);
    }
}
