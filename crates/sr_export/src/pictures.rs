//! Images as files: bytes as PNG, floats as EXR. Opacity is left out: textures do not use it.

use std::io::{self, Seek, Write};

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, Error, FlatSamples, Image as ExrImage, Layer,
    LayerAttributes, LineOrder, SmallVec, WritableImage,
};
use sr_scene::{Image, Pixels};

/// What the name of an image's file ends with.
pub fn extension(image: &Image) -> &'static str {
    match image.pixels {
        Pixels::U8 { .. } => "png",
        Pixels::F32 { .. } => "exr",
    }
}

/// Writes an image in its own format.
pub fn write(image: &Image, out: &mut (impl Write + Seek)) -> io::Result<()> {
    match &image.pixels {
        Pixels::U8 { channels, data } => {
            let codes = opaque(data, *channels);
            let color = if *channels == 1 { png::ColorType::Grayscale } else { png::ColorType::Rgb };
            write_png(image.width, image.height, color, &codes, out)
        }
        Pixels::F32 { channels, data } => {
            let values = opaque(data, *channels);
            let names: &[&str] = if *channels == 1 { &["Y"] } else { &["R", "G", "B"] };
            let mut list = SmallVec::new();
            for (c, name) in names.iter().enumerate() {
                let plane: Vec<f32> = values.iter().skip(c).step_by(names.len()).copied().collect();
                list.push(AnyChannel::new(*name, FlatSamples::F32(plane)));
            }
            let encoding = Encoding {
                compression: Compression::ZIP16,
                blocks: Blocks::ScanLines,
                line_order: LineOrder::Increasing,
            };
            let size = (image.width as usize, image.height as usize);
            let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(list));
            ExrImage::from_layer(layer).write().to_buffered(out).map_err(|error| match error {
                Error::Io(io) => io,
                other => io::Error::other(other),
            })
        }
    }
}

/// Writes bytes as PNG, without a word about what they mean.
pub fn write_png(
    width: u32,
    height: u32,
    color: png::ColorType,
    codes: &[u8],
    out: impl Write,
) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(codes)?;
    writer.finish()?;
    Ok(())
}

/// The values without the fourth of each texel.
fn opaque<T: Copy>(data: &[T], channels: u8) -> std::borrow::Cow<'_, [T]> {
    match channels {
        4 => data.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect::<Vec<_>>().into(),
        _ => data.into(),
    }
}
