//! Texels: reading them, and between them.

use std::sync::LazyLock;

use glam::Vec2;
use sr_sampling::prefetch;
use sr_scene::{Image, Pixels, Rgb, Wrap};

/// What 8-bit codes mean: of linear images, and of those encoded as sRGB (IEC 61966-2-1).
pub(super) static DECODED: LazyLock<[[f32; 256]; 2]> = LazyLock::new(|| {
    let srgb = |code| {
        let c = code as f64 / 255.0;
        (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
    };
    [std::array::from_fn(|code| code as f32 / 255.0), std::array::from_fn(srgb)]
});

/// The integer cell of a coordinate, kept away from the ends of `i32`. (`floor` is a library call without SSE 4.1.)
#[inline]
pub(crate) fn to_cell(x: f32) -> i32 {
    let towards_zero = x.clamp(-1e9, 1e9) as i32;
    towards_zero - i32::from(towards_zero as f32 > x)
}

#[inline]
pub(super) fn wrapped(i: i32, size: u32, wrap: Wrap) -> u32 {
    if (i as u32) < size { i as u32 } else { wrapped_around(i, size, wrap) }
}

/// Rare: out of line.
#[cold]
fn wrapped_around(i: i32, size: u32, wrap: Wrap) -> u32 {
    let n = size as i32;
    (match wrap {
        Wrap::Repeat => i.rem_euclid(n),
        Wrap::Clamp => i.clamp(0, n - 1),
        Wrap::Mirror => {
            let tile = i.div_euclid(n);
            let within = i.rem_euclid(n);
            if tile % 2 == 0 { within } else { n - 1 - within }
        }
    }) as u32
}

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

/// Between four texels, of two columns and two rows, which must be inside the image: bilinear, by the fractions `t`.
#[inline]
pub(crate) fn bilinear(image: &Image, srgb: bool, [x0, x1]: [u32; 2], [y0, y1]: [u32; 2], t: Vec2) -> Rgb {
    let (x0, x1) = (x0 as usize, x1 as usize);
    let (row0, row1) = (y0 as usize * image.width as usize, y1 as usize * image.width as usize);
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
    if channels < 3 {
        return Rgb::splat(table[usize::from(data[at])]);
    }
    let codes = &data[at..at + 3];
    Rgb::new(table[usize::from(codes[0])], table[usize::from(codes[1])], table[usize::from(codes[2])])
}

#[inline(always)]
fn rgb(data: &[f32], channels: u8, at: usize) -> Rgb {
    let at = at * usize::from(channels);
    if channels < 3 { Rgb::splat(data[at]) } else { Rgb::from_slice(&data[at..at + 3]) }
}
