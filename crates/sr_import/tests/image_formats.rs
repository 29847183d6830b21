//! Small images in every format that textures are read from, made here, and what becomes of them.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{ExtendedColorType, ImageFormat};
use sr_import::{LoadOptions, load_str};
use sr_scene::{Image, Pixels};

/// A folder of its own, removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("steradian-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Writes a file and reads it as a texture.
    fn read(&self, name: &str, bytes: &[u8], raw: bool) -> Result<Image, String> {
        std::fs::write(self.0.join(name), bytes).unwrap();
        let text = format!(
            "<scene version='3.0.0'><sensor type='perspective'><float name='fov' value='40'/></sensor>
             <bsdf type='diffuse'><texture type='bitmap' name='reflectance'>
               <string name='filename' value='{name}'/><boolean name='raw' value='{raw}'/>
             </texture></bsdf></scene>"
        );
        let (scene, said) = load_str("test.xml", &text, Path::new(&self.0), &LoadOptions::default());
        match scene {
            Some(scene) => Ok((*scene.images[0]).clone()),
            None => Err(said.render(false)),
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn bytes(image: &Image) -> (u8, &[u8]) {
    match &image.pixels {
        Pixels::U8 { channels, data } => (*channels, data),
        Pixels::F32 { .. } => panic!("eight bits were to stay eight bits"),
    }
}

fn floats(image: &Image) -> (u8, &[f32]) {
    match &image.pixels {
        Pixels::F32 { channels, data } => (*channels, data),
        Pixels::U8 { .. } => panic!("floating point was expected"),
    }
}

/// 2 × 2 texels of a form, encoded by a library.
fn encoded(data: &[u8], color: ExtendedColorType, format: ImageFormat) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image::write_buffer_with_format(&mut out, data, 2, 2, color, format).unwrap();
    out.into_inner()
}

#[test]
fn eight_bits_stay_eight_bits() {
    let folder = Folder::new("eight-bits");
    let grey = [0, 85, 170, 255];
    let rgb: Vec<u8> = (0..12).map(|i| i * 20).collect();
    let rgba: Vec<u8> = (0..16).map(|i| i * 15).collect();
    for format in [ImageFormat::Png, ImageFormat::Tga, ImageFormat::Bmp] {
        let name = format!("a.{}", format.extensions_str()[0]);
        let image = folder.read(&name, &encoded(&rgb, ExtendedColorType::Rgb8, format), false).unwrap();
        assert_eq!((image.width, image.height, bytes(&image)), (2, 2, (3, &rgb[..])), "{format:?}");
    }
    for format in [ImageFormat::Png, ImageFormat::Tga] {
        let name = format!("b.{}", format.extensions_str()[0]);
        let image = folder.read(&name, &encoded(&rgba, ExtendedColorType::Rgba8, format), false).unwrap();
        assert_eq!(bytes(&image), (4, &rgba[..]), "{format:?}");
        let image = folder.read(&name, &encoded(&grey, ExtendedColorType::L8, format), true).unwrap();
        assert_eq!(bytes(&image), (1, &grey[..]), "{format:?}");
    }
    // grey with alpha becomes RGBA
    let grey_alpha = [10, 255, 20, 0, 30, 7, 40, 9];
    let image =
        folder.read("c.png", &encoded(&grey_alpha, ExtendedColorType::La8, ImageFormat::Png), true).unwrap();
    assert_eq!(bytes(&image), (4, &[10, 10, 10, 255, 20, 20, 20, 0, 30, 30, 30, 7, 40, 40, 40, 9][..]));
}

#[test]
fn sixteen_bits_are_decoded_unless_they_are_raw() {
    let folder = Folder::new("sixteen-bits");
    let values = [0u16, 32768, 65535, 13107];
    let data: Vec<u8> = values.iter().flat_map(|v| v.to_ne_bytes()).collect();
    let file = encoded(&data, ExtendedColorType::L16, ImageFormat::Png);
    let raw = folder.read("a.png", &file, true).unwrap();
    let expected = values.map(|v| f32::from(v) / 65535.0);
    assert_eq!(floats(&raw), (1, &expected[..]));
    let color = folder.read("a.png", &file, false).unwrap();
    assert!((floats(&color).1[1] - 0.214).abs() < 1e-3, "{:?}", floats(&color).1);
    assert_eq!((floats(&color).1[0], floats(&color).1[2]), (0.0, 1.0));
}

/// A TGA file: its kind, bits of a texel, rows from the bottom unless `from_top`, and what follows the header.
fn tga(kind: u8, bits: u8, from_top: bool, palette: Option<(u16, u8)>, rest: &[u8]) -> Vec<u8> {
    let (count, entry) = palette.unwrap_or((0, 0));
    let mut out = vec![0, u8::from(palette.is_some()), kind, 0, 0];
    out.extend(count.to_le_bytes());
    out.push(entry);
    out.extend([0; 4]);
    out.extend([2, 0, 2, 0, bits, if from_top { 0x20 } else { 0 }]);
    out.extend(rest);
    out
}

#[test]
fn targa_of_every_kind() {
    let folder = Folder::new("targa");
    let read = |bytes: &[u8]| folder.read("a.tga", bytes, false).unwrap();
    // blue, green, red; the first row is the lowest
    let image = read(&tga(2, 24, false, None, &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]));
    assert_eq!(bytes(&image), (3, &[9, 8, 7, 12, 11, 10, 3, 2, 1, 6, 5, 4][..]));
    // grey
    assert_eq!(bytes(&read(&tga(3, 8, true, None, &[1, 2, 3, 4]))), (1, &[1, 2, 3, 4][..]));
    // a palette of two colors
    let palette = [10, 20, 30, 40, 50, 60, 0, 1, 1, 0];
    let image = read(&tga(1, 8, true, Some((2, 24)), &palette));
    assert_eq!(bytes(&image), (3, &[30, 20, 10, 60, 50, 40, 60, 50, 40, 30, 20, 10][..]));
    // 16 bits: five for each color
    let pixels: Vec<u8> = [0x7c00u16, 0x03e0, 0x001f, 0x7fff].iter().flat_map(|v| v.to_le_bytes()).collect();
    let image = read(&tga(2, 16, true, None, &pixels));
    assert_eq!(bytes(&image), (3, &[255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255][..]));
    // run lengths: three of one, one of another
    let image = read(&tga(10, 24, true, None, &[0x82, 1, 2, 3, 0x00, 4, 5, 6]));
    assert_eq!(bytes(&image), (3, &[3, 2, 1, 3, 2, 1, 3, 2, 1, 6, 5, 4][..]));
}

#[test]
fn floating_point_formats() {
    let folder = Folder::new("float");
    // Radiance: mantissas and a common exponent, 2⁰ being 129 of 256
    let mut hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n".to_vec();
    for [r, g, b, e] in [[128, 64, 0, 129], [128, 128, 128, 130], [0, 0, 0, 0], [255, 128, 64, 128]] {
        hdr.extend([r, g, b, e]);
    }
    let image = folder.read("a.hdr", &hdr, false).unwrap();
    let (channels, data) = floats(&image);
    let expected = [1.0, 0.5, 0.0, 2.0, 2.0, 2.0, 0.0, 0.0, 0.0, 255.0 / 256.0, 0.5, 0.25];
    assert_eq!(channels, 3);
    assert!(data.iter().zip(expected).all(|(a, b): (&f32, f32)| (a - b).abs() < 0.01), "{data:?}");

    let mut pfm = b"PF\n2 2\n-1.0\n".to_vec();
    let values: Vec<f32> = (0..12).map(|i| i as f32 * 0.5).collect();
    values.iter().for_each(|v| pfm.extend(v.to_le_bytes()));
    let image = folder.read("a.pfm", &pfm, false).unwrap();
    assert_eq!(floats(&image).1, [&values[6..], &values[..6]].concat());

    let pixels = exr::prelude::SpecificChannels::rgb(|at: exr::prelude::Vec2<usize>| {
        let v = (2 * at.y() + at.x()) as f32;
        (v, 10.0 * v, if v == 3.0 { f32::INFINITY } else { f32::NAN })
    });
    let mut out = Cursor::new(Vec::new());
    exr::prelude::WritableImage::write(&exr::prelude::Image::from_channels((2, 2), pixels))
        .to_buffered(&mut out)
        .unwrap();
    let image = folder.read("a.exr", &out.into_inner(), false).unwrap();
    let (_, data) = floats(&image);
    assert_eq!(data[..6], [0.0, 0.0, 0.0, 1.0, 10.0, 0.0]);
    assert!(data.iter().all(|v| v.is_finite()));
}

#[test]
fn sizes_and_cuts_that_cannot_be_are_errors() {
    let folder = Folder::new("bad");
    let png = encoded(&[0; 12], ExtendedColorType::Rgb8, ImageFormat::Png);
    let tga = tga(2, 24, true, None, &[0; 12]);
    for (name, whole) in [("a.png", &png), ("a.tga", &tga)] {
        for cut in [0, 1, whole.len() / 2, whole.len() - 1] {
            // the last bytes of a PNG may be missed by nobody
            let read = folder.read(name, &whole[..cut], false);
            assert!(read.is_err() || cut == whole.len() - 1, "{name} cut at {cut}");
        }
    }
    let mut huge = tga;
    huge[12..16].copy_from_slice(&[0xff; 4]);
    assert!(folder.read("b.tga", &huge, false).unwrap_err().contains("at most"));
    assert!(folder.read("c.pfm", b"PF\n1000000 1000000\n-1\n", false).unwrap_err().contains("at most"));
}

#[test]
fn textures_are_nested_but_not_without_end() {
    let folder = Folder::new("nested");
    let codes = |body: &str| {
        let text = format!(
            "<scene version='3.0.0'><sensor type='perspective'><float name='fov' value='40'/></sensor>{body}</scene>"
        );
        let (scene, said) = load_str("test.xml", &text, &folder.0, &LoadOptions::default());
        assert_eq!(scene.is_none(), said.has_errors());
        said.list.iter().map(|d| d.code).collect::<Vec<_>>()
    };
    let fine = "<bsdf type='diffuse'><texture type='mix' name='reflectance'>
        <texture name='color0' type='scale'><texture type='checkerboard'/><float name='scale' value='0.5'/></texture>
        <texture name='weight' type='checkerboard'/></texture></bsdf>";
    assert_eq!(codes(fine), [] as [&str; 0]);
    // each is the square of the one before
    let mut body = "<texture type='checkerboard' id='t0'/>".to_owned();
    for i in 1..20 {
        body += &format!(
            "<texture type='scale' id='t{i}'><ref id='t{}'/><ref name='scale' id='t{}'/></texture>",
            i - 1,
            i - 1
        );
    }
    body += "<bsdf type='diffuse'><ref name='reflectance' id='t19'/></bsdf>";
    assert!(codes(&body).contains(&"scene::texture-depth"));
    let cycle = "<texture type='scale' id='a'><ref id='a'/></texture>
        <bsdf type='diffuse'><ref name='reflectance' id='a'/></bsdf>";
    assert!(codes(cycle).contains(&"mitsuba::cycle"));
    for (body, code) in [
        (
            "<texture type='mix' name='reflectance'><float name='weight' value='2'/></texture>",
            "scene::weight",
        ),
        ("<texture type='mesh_attribute' name='reflectance'/>", "mitsuba::missing-property"),
        (
            "<texture type='mesh_attribute' name='reflectance'><string name='name' value='vertex_temp'/></texture>",
            "mitsuba::unknown-value",
        ),
        (
            "<texture type='bitmap' name='reflectance'><string name='filename' value='none.png'/></texture>",
            "file::bad-image",
        ),
    ] {
        assert!(codes(&format!("<bsdf type='diffuse'>{body}</bsdf>")).contains(&code), "{body}");
    }
    let light = "<shape type='sphere'><emitter type='area'><texture name='radiance' type='mesh_attribute'>
        <string name='name' value='vertex_color'/></texture></emitter></shape>";
    assert!(codes(light).contains(&"scene::emitting-mesh-color"));
}
