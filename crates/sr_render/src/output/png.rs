//! PNG: the image as it is to be looked at, 8 bits per channel, sRGB.

use std::io::{self, Write};
use std::path::Path;

use super::OutputError;
use super::atomic::write_then_rename;
use super::metadata::{Metadata, SOFTWARE};
use super::tone::Display;
use crate::image::RenderedImage;

/// Writes a PNG file. Metadata become international text chunks.
///
/// # Errors
/// If the file cannot be written.
pub fn write_png(
    path: &Path,
    image: &RenderedImage,
    metadata: &Metadata,
    display: Display,
) -> Result<(), OutputError> {
    write_then_rename(path, |file| encode_png(image, metadata, display, file))
}

/// Writes PNG data to `out`.
///
/// # Errors
/// If `out` does not take it.
pub fn encode_png(
    image: &RenderedImage,
    metadata: &Metadata,
    display: Display,
    out: impl Write,
) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, image.width, image.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    // A twentieth of the default's time for files that are 3 to 16 % larger: noise does not compress.
    encoder.set_compression(png::Compression::Fast);
    encoder.add_text_chunk("Software".into(), SOFTWARE.into())?;
    for (name, value) in metadata.entries() {
        encoder.add_itxt_chunk(name, value.to_string())?;
    }
    encoder.add_itxt_chunk("steradian.exposure".into(), display.exposure.to_string())?;
    encoder.add_itxt_chunk("steradian.tone".into(), display.tone.to_string())?;
    let codes: Vec<u8> = image.rgb.chunks_exact(3).flat_map(|p| display.encode([p[0], p[1], p[2]])).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&codes)?;
    writer.finish()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{Tone, Value};
    use super::*;

    #[test]
    fn pixels_and_settings_come_back() {
        let mut image = RenderedImage::black(2, 1, 4);
        image.rgb = vec![0.5, 0.0, 1.0, 0.25, f32::NAN, 9.0];
        let mut metadata = Metadata::new();
        metadata.set("scene", Value::Text("größe.xml".into()));
        metadata.set("spp", Value::Integer(4));
        let mut bytes = Vec::new();
        encode_png(&image, &metadata, Display { exposure: 1.0, tone: Tone::Srgb }, &mut bytes).unwrap();

        let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
        let mut codes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut codes).unwrap();
        assert_eq!(codes, [255, 0, 255, 188, 0, 255]);
        let texts: Vec<(String, String)> = reader
            .info()
            .utf8_text
            .iter()
            .map(|chunk| (chunk.keyword.clone(), chunk.get_text().unwrap()))
            .collect();
        for (name, value) in [("scene", "größe.xml"), ("spp", "4"), ("exposure", "1"), ("tone", "srgb")] {
            assert!(texts.contains(&(format!("steradian.{name}"), value.into())), "{name} in {texts:?}");
        }
    }
}
