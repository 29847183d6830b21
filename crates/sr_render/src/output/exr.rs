//! OpenEXR: every layer of the image in one part, 32-bit float, ZIP, settings in the header.
//!
//! | channels | content |
//! | --- | --- |
//! | `R G B` | mean radiance, linear, BT.709 primaries |
//! | `stderr.R` … | standard error of that mean |
//! | `albedo.R` …, `normal.X` … | means at the first hit |
//! | `depth.Z` | mean distance to the first hit; infinite where there is none |
//! | `alpha.A` | fraction of samples that hit something; not the `A` of `R G B`, which viewers would divide by |

use std::io;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, Error, FlatSamples, Image, Layer,
    LayerAttributes, LineOrder, SmallVec, Text, WritableImage,
};

use super::OutputError;
use super::atomic::write_then_rename;
use super::metadata::{Metadata, SOFTWARE, Value};
use crate::image::RenderedImage;

/// Writes an OpenEXR file.
///
/// # Errors
/// If the file cannot be written.
pub fn write_exr(path: &Path, image: &RenderedImage, metadata: &Metadata) -> Result<(), OutputError> {
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (image.width as usize, image.height as usize);
    let layer = Layer::new(size, attributes(metadata), encoding, AnyChannels::sort(channels(image)));
    let file = Image::from_layer(layer);
    write_then_rename(path, |out| {
        file.write().to_buffered(out).map_err(|error| match error {
            Error::Io(io) => io,
            other => io::Error::other(other),
        })
    })
}

fn channels(image: &RenderedImage) -> SmallVec<[AnyChannel<FlatSamples>; 4]> {
    const RGB: [&str; 3] = ["R", "G", "B"];
    let triples: [(&str, [&str; 3], &[f32]); 4] = [
        ("", RGB, &image.rgb),
        ("stderr.", RGB, &image.stderr),
        ("albedo.", RGB, &image.albedo),
        ("normal.", ["X", "Y", "Z"], &image.normal),
    ];
    let mut channels = SmallVec::new();
    for (layer, names, data) in triples {
        for (c, name) in names.into_iter().enumerate() {
            let plane: Vec<f32> = data.iter().skip(c).step_by(3).copied().collect();
            channels.push(AnyChannel::new(text(&format!("{layer}{name}")), FlatSamples::F32(plane)));
        }
    }
    for (name, data) in [("depth.Z", &image.depth), ("alpha.A", &image.alpha)] {
        channels.push(AnyChannel::new(text(name), FlatSamples::F32(data.clone())));
    }
    channels
}

fn attributes(metadata: &Metadata) -> LayerAttributes {
    let mut attributes =
        LayerAttributes { software_name: Some(text(SOFTWARE)), ..LayerAttributes::default() };
    for (name, value) in metadata.entries() {
        let value = match value {
            Value::Text(words) => AttributeValue::Text(text(words)),
            Value::Real(real) => AttributeValue::F64(*real),
            Value::Integer(integer) => match i32::try_from(*integer) {
                Ok(small) => AttributeValue::I32(small),
                Err(_) => AttributeValue::Text(text(&integer.to_string())),
            },
        };
        attributes.other.insert(text(&name), value);
    }
    attributes
}

/// EXR strings are bytes; ours are UTF-8.
fn text(words: &str) -> Text {
    Text::from_bytes_unchecked(words.as_bytes().into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{ReadChannels, ReadLayers, read};

    #[test]
    fn layers_and_settings_come_back() {
        let mut image = RenderedImage::black(3, 2, 16);
        for (i, value) in image.rgb.iter_mut().enumerate() {
            *value = i as f32;
        }
        image.depth[4] = 7.5;
        let mut metadata = Metadata::new();
        metadata.set("spp", Value::Integer(16));
        metadata.set("seed", Value::Integer(1 << 40));
        metadata.set("seconds", Value::Real(0.1));
        metadata.set("scene", Value::Text("größe.xml".into()));
        let path = std::env::temp_dir().join(format!("steradian-layers-{}.exr", std::process::id()));
        write_exr(&path, &image, &metadata).unwrap();
        let file = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_file(&path)
            .unwrap();
        std::fs::remove_file(&path).unwrap();

        let channel = |name: &str| -> Vec<f32> {
            let list = &file.layer_data.channel_data.list;
            let found = list.iter().find(|c| c.name == text(name));
            found.unwrap_or_else(|| panic!("no {name}")).sample_data.values_as_f32().collect()
        };
        assert_eq!(file.layer_data.channel_data.list.len(), 14);
        assert_eq!(channel("G"), [1.0, 4.0, 7.0, 10.0, 13.0, 16.0]);
        assert_eq!(channel("depth.Z")[4], 7.5);
        assert_eq!(channel("stderr.B"), [f32::INFINITY; 6]);
        let other = &file.layer_data.attributes.other;
        assert_eq!(other[&text("steradian.spp")], AttributeValue::I32(16));
        assert_eq!(other[&text("steradian.seed")], AttributeValue::Text(text("1099511627776")));
        assert_eq!(other[&text("steradian.seconds")], AttributeValue::F64(0.1));
        assert_eq!(other[&text("steradian.scene")], AttributeValue::Text(text("größe.xml")));
    }
}
