//! JPEG files to pixels, byte for byte as libjpeg decodes them.
//!
//! In: a file's bytes, which may mean harm. Out: gray or RGB pixels.
//!
//! Other renderers decode with libjpeg, so a decoder that rounds differently shows as colors that are off. Mostly
//! it is chroma of half the resolution: libjpeg's `h2v2_fancy_upsample` rounds (9a + 3b + 3c + d) / 16 once, up
//! and down by turns; to round each direction, and halves always up, adds a quarter of a level to Cb and Cr.

use image::{DynamicImage, GrayImage, RgbImage};
use libjpeg_turbo_rs::{DecodeLimits, Decoder, FrameHeader, JpegError, PixelFormat};

use crate::images::damaged;
use crate::limits::Limit;

/// More scans are refused: a few bytes can ask for one more pass over all pixels. Real files have some ten.
const MAX_SCANS: usize = 100;
/// Room for the coefficients of a progressive file, the planes, and the pixels.
const MAX_BYTES_PER_TEXEL: u64 = 16;

/// Whether a file begins as JPEG files do.
pub fn is_jpeg(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xff, 0xd8, 0xff])
}

/// Decodes a file of at most `limit` pixels; the error is half a sentence. A file that was cut is an error.
pub fn decode(bytes: &[u8], limit: Limit) -> Result<DynamicImage, String> {
    let limits = DecodeLimits {
        max_pixels: limit.most,
        max_scans: MAX_SCANS,
        max_memory: Some(limit.most.saturating_mul(MAX_BYTES_PER_TEXEL)),
        ..DecodeLimits::default()
    };
    let mut decoder = Decoder::new_with_limits(bytes, limits).map_err(|e| not_decoded(e, limit))?;
    let format = output_format(decoder.header())?;
    decoder.set_output_format(format);
    let image = decoder.decode_image().map_err(|e| not_decoded(e, limit))?;
    let (width, height) = (image.width as u32, image.height as u32);
    let pixels = match format {
        PixelFormat::Grayscale => GrayImage::from_raw(width, height, image.data).map(DynamicImage::from),
        _ => RgbImage::from_raw(width, height, image.data).map(DynamicImage::from),
    };
    pixels.ok_or_else(|| "it has fewer pixels than its header says".into())
}

fn not_decoded(error: JpegError, limit: Limit) -> String {
    match error {
        JpegError::LimitExceeded { .. } => limit.refusal(error),
        JpegError::Unsupported(_) | JpegError::AllocationFailed { .. } => error.to_string(),
        _ => damaged(&error.to_string()),
    }
}

/// Refuses what is not read, and what the decoder would not survive.
fn output_format(header: &FrameHeader) -> Result<PixelFormat, String> {
    if header.width == 0 || header.height == 0 {
        return Err("it has no pixels".into());
    }
    if header.precision != 8 {
        return Err(format!("it has {} bits per sample; only 8 are read", header.precision));
    }
    let sampling: Vec<_> =
        header.components.iter().map(|c| (c.horizontal_sampling, c.vertical_sampling)).collect();
    match sampling[..] {
        [_] => Ok(PixelFormat::Grayscale),
        [_, _, _] => Ok(PixelFormat::Rgb),
        // CMYK and YCCK. The decoder divides the first sampling factors by the second ones.
        [c, m, y, k] if c == k && m == y && c.0 % m.0 == 0 && c.1 % m.1 == 0 => Ok(PixelFormat::Rgb),
        [_, _, _, _] => Err("its four components are sampled in a way that is not read".into()),
        _ => Err(format!("it has {} components; 1, 3 and 4 are read", sampling.len())),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::decode;
    use crate::limits::Limit;

    /// Pictures, each with what libjpeg-turbo 3.2.0 decoded (by way of Pillow 13.0.0) in a PNG beside it.
    const PICTURES: [&str; 8] = ["420", "422", "444", "gray", "progressive", "restarts", "rgb", "cmyk"];

    fn read(name: &str) -> Vec<u8> {
        std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/jpeg").join(name)).unwrap()
    }

    #[test]
    fn pixels_are_those_of_libjpeg() {
        for name in PICTURES {
            let ours = decode(&read(&format!("{name}.jpg")), Limit::fixed(1 << 20)).unwrap();
            let theirs = image::load_from_memory(&read(&format!("{name}.png"))).unwrap();
            assert_eq!(ours.color(), theirs.color(), "{name}");
            let differences: Vec<i32> = std::iter::zip(ours.as_bytes(), theirs.as_bytes())
                .map(|(&ours, &theirs)| i32::from(ours) - i32::from(theirs))
                .collect();
            assert_eq!(differences.len(), theirs.as_bytes().len(), "{name}");
            let mean = f64::from(differences.iter().sum::<i32>()) / differences.len() as f64;
            let largest = differences.iter().map(|d| d.abs()).max().unwrap();
            assert_eq!(largest, 0, "{name}: {mean:+.3} on average, at most {largest}");
        }
    }

    #[test]
    fn harmful_files_are_refused() {
        let good = read("420.jpg");
        assert!(decode(&good, Limit::fixed(61 * 43)).is_ok());
        assert!(decode(&good, Limit::fixed(61 * 43 - 1)).is_err(), "larger than allowed");
        for end in 0..good.len() - 2 {
            assert!(decode(&good[..end], Limit::fixed(1 << 20)).is_err(), "cut after {end} bytes");
        }
        for name in PICTURES {
            let good = read(&format!("{name}.jpg"));
            for at in 0..good.len().min(700) {
                for value in [0, 1, 2, 17, 127, 128, 255, good[at] ^ 1] {
                    let mut bad = good.clone();
                    bad[at] = value;
                    // Whatever comes, it must not panic.
                    decode(&bad, Limit::fixed(1 << 16)).ok();
                }
            }
        }
    }
}
