//! KTX2 textures of Basis Universal, as KHR_texture_basisu has them: the largest level.

use std::panic::catch_unwind;

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use image::{DynamicImage, RgbImage, RgbaImage};

/// What every KTX2 file begins with.
const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

pub fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Width and height by the header.
pub fn size(bytes: &[u8]) -> Option<(u32, u32)> {
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    Some((word(20)?, word(24)?))
}

/// Is the largest level, unpacked, as large as its blocks of 4 × 4 texels of 16 bytes at most? The decoder believes the
/// header.
fn is_level_possible(bytes: &[u8], (width, height): (u32, u32)) -> bool {
    let blocks = u64::from(width.div_ceil(4)) * u64::from(height.div_ceil(4));
    let unpacked = bytes.get(96..104).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes);
    unpacked.is_some_and(|unpacked| unpacked <= 16 * blocks)
}

/// The image of a file whose size was checked; the error is half a sentence.
pub fn decode(bytes: &[u8]) -> Result<DynamicImage, String> {
    if !size(bytes).is_some_and(|size| is_level_possible(bytes, size)) {
        return Err("its header is cut off or damaged".into());
    }
    // A panic of the decoder is an error like others.
    let decoded = catch_unwind(|| {
        let texture =
            Transcoder::new(bytes).map_err(|_| "it is no texture of Basis Universal, or damaged")?;
        let (width, height) = texture.base_dimensions();
        let target = TargetFormat::Rgba32;
        if Some((width, height)) != size(bytes) || !texture.supports(target) {
            return Err("it is a texture of high dynamic range, which glTF does not have");
        }
        let texels = texture.transcode(0, target, DecodeFlags::NONE);
        Ok((width, height, texels.map_err(|_| "it is damaged")?, texture.has_alpha()))
    });
    let (width, height, rgba, has_alpha) = decoded.map_err(|_| "it breaks the decoder")??;
    let short = || "it has fewer texels than it says".to_owned();
    if has_alpha {
        return RgbaImage::from_raw(width, height, rgba).map(DynamicImage::from).ok_or_else(short);
    }
    let rgb = rgba.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
    RgbImage::from_raw(width, height, rgb).map(DynamicImage::from).ok_or_else(short)
}
