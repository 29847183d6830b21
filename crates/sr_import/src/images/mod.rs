//! Image files to [`Image`]s.
//!
//! - `below_coat`: albedos below pbrt's coats.
//! - `texels`: numbers that are worked out from those of a file.

mod below_coat;
mod texels;

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageError, ImageFormat, ImageReader};
use sr_scene::{Image, Pixels};

use crate::files;
use crate::jpeg;
use crate::limits::{Limit, Limits};
use crate::pfm;
use crate::values::srgb_to_linear;
pub use below_coat::BelowCoat;
pub use texels::{Encoding, TexelMap};

/// What a file that Git LFS has not fetched begins with.
const LFS_POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// What the values of a file mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Decode {
    /// Colors: 8-bit values stay as they are, 16-bit ones are sRGB-decoded.
    Color,
    /// Numbers: roughness, bumps, masks. No value is changed.
    Raw,
    /// Radiance: everything is made linear floating point.
    Linear,
    /// Numbers that are worked out from those of the file.
    Texels(TexelMap),
    /// Colors, as [`Decode::Color`], below a coat.
    BelowCoat(BelowCoat),
}

/// Reads a file; the error is half a sentence.
pub fn load(path: &Path, decode: Decode, limits: &Limits) -> Result<Image, String> {
    decode_bytes(path, &files::read(path, limits.file_bytes)?, decode, limits.image_texels)
}

/// Decodes what a file, or a part of one, holds, if its texels are no more than the `limit`; `path` is what messages call it.
pub fn decode_bytes(path: &Path, bytes: &[u8], decode: Decode, limit: Limit) -> Result<Image, String> {
    let linear = |pixels| match decode {
        Decode::Texels(map) => map.apply(pixels, false),
        Decode::BelowCoat(coat) => coat.apply(pixels),
        _ => pixels,
    };
    let (width, height, pixels) = if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        let (width, height, pixels) = open_exr(bytes, limit)?;
        (width, height, linear(pixels))
    } else if pfm::is_pfm(bytes) {
        let (width, height, pixels) = pfm::decode(bytes, limit)?;
        (width, height, linear(pixels))
    } else {
        let image =
            if jpeg::is_jpeg(bytes) { jpeg::decode(bytes, limit)? } else { open_other(path, bytes, limit)? };
        (image.width(), image.height(), convert(image, decode))
    };
    Ok(Image { name: path.display().to_string(), width, height, pixels })
}

/// How many texels an image has by its header; 0 if that cannot be read, as the image cannot then.
pub fn texels(path: &Path, bytes: &[u8]) -> u64 {
    let size = if pfm::is_pfm(bytes) {
        // Floats of at least one channel.
        return bytes.len() as u64 / 4;
    } else if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).ok();
        meta.and_then(|meta| meta.headers.first().map(|h| (h.layer_size.x() as u64, h.layer_size.y() as u64)))
    } else {
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().ok();
        let size = reader.and_then(|mut reader| {
            if reader.format().is_none() {
                reader.set_format(ImageFormat::from_path(path).ok()?);
            }
            reader.into_dimensions().ok()
        });
        size.map(|(width, height)| (width.into(), height.into()))
    };
    size.map_or(0, |(width, height): (u64, u64)| width.saturating_mul(height))
}

fn open_other(path: &Path, bytes: &[u8], limit: Limit) -> Result<DynamicImage, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
    if reader.format().is_none() {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        // TGA has no magic number: its name has to do.
        if extension != "tga" || bytes.starts_with(LFS_POINTER) {
            return Err(no_image(&extension, bytes));
        }
        reader.set_format(ImageFormat::Tga);
    }
    let mut limits = image::Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(1 << 20), Some(1 << 20));
    limits.max_alloc = Some(limit.most.saturating_mul(16));
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(not_decoded)?;
    let (width, height) = image::ImageDecoder::dimensions(&decoder);
    check_size(u64::from(width), u64::from(height), limit)?;
    DynamicImage::from_decoder(decoder).map_err(not_decoded)
}

/// Says what a file of no known format is instead.
fn no_image(extension: &str, bytes: &[u8]) -> String {
    if bytes.starts_with(LFS_POINTER) {
        return "it is a pointer of Git LFS, not the image; fetch the image with `git lfs pull`".into();
    }
    let known = ImageFormat::from_extension(extension).is_some();
    let named = if known { format!("it is named .{extension} but is none: ") } else { String::new() };
    let start: String = String::from_utf8_lossy(&bytes[..bytes.len().min(24)]).escape_debug().collect();
    format!(
        "{named}its format is not known (PNG, JPEG, BMP, TGA, HDR, PFM, PNM, WebP, TIFF and OpenEXR are); \
         it begins with \"{start}\""
    )
}

fn not_decoded(error: ImageError) -> String {
    match error {
        ImageError::Decoding(_) | ImageError::IoError(_) => damaged(&error.to_string()),
        _ => error.to_string(),
    }
}

/// What to say, and to do, about a file that its decoder gave up on.
pub fn damaged(reason: &str) -> String {
    format!("it is cut off or damaged ({reason}); fetch or save it again")
}

fn check_size(width: u64, height: u64, limit: Limit) -> Result<(), String> {
    match width.checked_mul(height) {
        Some(0) => Err("it has no pixels".into()),
        Some(n) if n <= limit.most => Ok(()),
        _ => Err(limit.refusal(format!("it has {width} × {height} pixels; at most {limit} are read"))),
    }
}

fn convert(image: DynamicImage, decode: Decode) -> Pixels {
    use DynamicImage as D;
    let channels: u8 = match image.color().channel_count() {
        1 => 1,
        // Grey with alpha is kept as RGBA: two channels are not among the forms of an image.
        2 | 4 => 4,
        _ => 3,
    };
    let bytes = matches!(image, D::ImageLuma8(_) | D::ImageLumaA8(_) | D::ImageRgb8(_) | D::ImageRgba8(_));
    if bytes {
        let data = match channels {
            1 => image.into_luma8().into_raw(),
            3 => image.into_rgb8().into_raw(),
            _ => image.into_rgba8().into_raw(),
        };
        return match decode {
            Decode::Linear => Pixels::F32 { channels, data: linear_bytes(&data, channels) },
            Decode::Color | Decode::Raw => Pixels::U8 { channels, data },
            Decode::Texels(map) => map.apply(Pixels::U8 { channels, data }, true),
            Decode::BelowCoat(coat) => coat.apply(Pixels::U8 { channels, data }),
        };
    }
    let float = matches!(image, D::ImageRgb32F(_) | D::ImageRgba32F(_));
    let mut data = match channels {
        1 => image.into_luma16().into_raw().iter().map(|&v| f32::from(v) / 65535.0).collect(),
        3 => image.into_rgb32f().into_raw(),
        _ => image.into_rgba32f().into_raw(),
    };
    if !float && matches!(decode, Decode::Color | Decode::Linear | Decode::BelowCoat(_)) {
        for texel in data.chunks_exact_mut(channels.into()) {
            texel.iter_mut().take(3).for_each(|v| *v = srgb_to_linear(f64::from(*v)) as f32);
        }
    }
    let pixels = Pixels::F32 { channels, data };
    match decode {
        Decode::Texels(map) => map.apply(pixels, !float),
        Decode::BelowCoat(coat) => coat.apply(pixels),
        _ => pixels,
    }
}

fn linear_bytes(data: &[u8], channels: u8) -> Vec<f32> {
    let table: Vec<f32> = (0..256).map(|v| srgb_to_linear(f64::from(v) / 255.0) as f32).collect();
    data.iter()
        .enumerate()
        .map(
            |(i, &v)| {
                if i % usize::from(channels) == 3 { f32::from(v) / 255.0 } else { table[usize::from(v)] }
            },
        )
        .collect()
}

fn exr_not_decoded(error: exr::error::Error) -> String {
    match error {
        exr::error::Error::Invalid(_) | exr::error::Error::Io(_) => damaged(&error.to_string()),
        _ => error.to_string(),
    }
}

fn open_exr(bytes: &[u8], limit: Limit) -> Result<(u32, u32, Pixels), String> {
    use exr::prelude::*;
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(exr_not_decoded)?;
    for header in &meta.headers {
        check_size(header.layer_size.x() as u64, header.layer_size.y() as u64, limit)?;
        if header.deep {
            return Err("it has deep data".into());
        }
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(exr_not_decoded)?;
    let layer = image.layer_data;
    let channel = |names: &[&str]| {
        layer.channel_data.list.iter().find(|c| {
            let name = c.name.to_string();
            let last = name.rsplit('.').next().unwrap_or("").to_owned();
            names.iter().any(|n| last.eq_ignore_ascii_case(n))
        })
    };
    let picked = match (channel(&["R", "red"]), channel(&["G", "green"]), channel(&["B", "blue"])) {
        (Some(r), Some(g), Some(b)) => vec![r, g, b],
        _ => {
            let luminance = channel(&["Y"]).or_else(|| layer.channel_data.list.first());
            vec![luminance.ok_or("it has no channels")?]
        }
    };
    if picked.iter().any(|c| c.sampling != Vec2(1, 1)) {
        return Err("its color channels are subsampled".into());
    }
    let count = layer.size.area();
    let channels = picked.len();
    let mut data = vec![0.0; count * channels];
    for (offset, channel) in picked.iter().enumerate() {
        for (slot, value) in
            data.iter_mut().skip(offset).step_by(channels).zip(channel.sample_data.values_as_f32())
        {
            *slot = value;
        }
    }
    Ok((layer.size.x() as u32, layer.size.y() as u32, Pixels::F32 { channels: channels as u8, data }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_are_no_images_are_told_from_cut_ones() {
        let limit = Limits::default().image_texels;
        let open = |name: &str, bytes: &[u8]| open_other(Path::new(name), bytes, limit).unwrap_err();
        let text = open("a.jpg", b"<html>\n");
        assert!(text.contains("named .jpg but is none") && text.contains("\"<html>\\n\""), "{text}");
        assert!(open("a.txt", b"\xff\xfe").starts_with("its format is not known"));
        for name in ["a.png", "a.exr", "a.tga"] {
            let text = open(name, b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
            assert!(text.contains("git lfs pull"), "{text}");
        }
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/jpeg");
        let [png, jpg] = ["420.png", "420.jpg"].map(|name| std::fs::read(folder.join(name)).unwrap());
        let mut exr = Cursor::new(Vec::new());
        let black = exr::prelude::SpecificChannels::rgb(|_| (0.0f32, 0.0f32, 0.0f32));
        exr::prelude::WritableImage::write(&exr::prelude::Image::from_channels((9, 9), black))
            .to_buffered(&mut exr)
            .unwrap();
        let exr = exr.into_inner();
        for cut in [
            open("a.png", &png[..png.len() / 2]),
            jpeg::decode(&jpg[..jpg.len() / 2], limit).unwrap_err(),
            open_exr(&exr[..exr.len() / 2], limit).unwrap_err(),
            open_exr(&exr[..40], limit).unwrap_err(),
        ] {
            assert!(cut.starts_with("it is cut off or damaged ("), "{cut}");
        }
    }
}
