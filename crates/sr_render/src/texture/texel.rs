//! Texels: reading them, and between them.

use std::sync::LazyLock;

use sr_sampling::prefetch;
use sr_scene::{Image, Pixels, Rgb};

use super::Cells;

/// What 8-bit codes mean: of linear images, and of those encoded as sRGB (IEC 61966-2-1).
pub(super) static DECODED: LazyLock<[[f32; 256]; 2]> = LazyLock::new(|| {
    let srgb = |code| {
        let c = code as f64 / 255.0;
        (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
    };
    [std::array::from_fn(|code| code as f32 / 255.0), std::array::from_fn(srgb)]
});

/// One texel, linear; grey images give equal channels, alpha is ignored.
#[inline]
pub(crate) fn texel(image: &Image, srgb: bool, x: u32, y: u32) -> Rgb {
    let at = y as usize * image.width as usize + x as usize;
    match &image.pixels {
        Pixels::U8 { channels, data } => decoded(data, *channels, &DECODED[usize::from(srgb)], at),
        Pixels::F32 { channels, data } => rgb(data, *channels, at),
    }
}

/// Asks for the memory of a texel, which must be inside the image.
#[inline(always)]
pub(crate) fn prefetch_texel(image: &Image, x: u32, y: u32) {
    let at = y as usize * image.width as usize + x as usize;
    match &image.pixels {
        Pixels::U8 { channels, data } => prefetch(&data[at * usize::from(*channels)]),
        Pixels::F32 { channels, data } => prefetch(&data[at * usize::from(*channels)]),
    }
}

/// Between four texels, which must be inside the image.
#[inline]
pub(crate) fn bilinear(image: &Image, srgb: bool, cells: &Cells) -> Rgb {
    let Cells { columns, rows, t } = cells;
    let [x0, x1] = columns.map(|x| x as usize);
    let [row0, row1] = rows.map(|y| y as usize * image.width as usize);
    let [a, b, c, d] = match &image.pixels {
        Pixels::U8 { channels, data } => {
            let table = &DECODED[usize::from(srgb)];
            [row0 + x0, row0 + x1, row1 + x0, row1 + x1].map(|at| decoded(data, *channels, table, at))
        }
        Pixels::F32 { channels, data } => {
            [row0 + x0, row0 + x1, row1 + x0, row1 + x1].map(|at| rgb(data, *channels, at))
        }
    };
    a.lerp(b, t.x).lerp(c.lerp(d, t.x), t.y)
}

#[inline(always)]
fn decoded(data: &[u8], channels: u8, table: &[f32; 256], at: usize) -> Rgb {
    let at = at * usize::from(channels);
    // without a branch on what differs from image to image
    let colored = usize::from(channels >= 3);
    let codes = [data[at], data[at + colored], data[at + 2 * colored]];
    Rgb::from_array(codes.map(|code| table[usize::from(code)]))
}

#[inline(always)]
fn rgb(data: &[f32], channels: u8, at: usize) -> Rgb {
    let at = at * usize::from(channels);
    if channels < 3 { Rgb::splat(data[at]) } else { Rgb::from_slice(&data[at..at + 3]) }
}
