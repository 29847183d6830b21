//! Textures: (u, v) to a colour.
//!
//! In: the description's images and textures. Out: [`Textures`], which a [`ColorInput`] or a
//! [`ScalarInput`] is looked up in. No filtering over footprints: a sample is a point.

use std::sync::{Arc, LazyLock};

use glam::{Affine2, Vec2, Vec3};
use sr_scene::{ColorInput, Filter, Image, Pixels, Rgb, ScalarInput, TextureDesc, TextureId, Wrap};

/// What 8-bit codes mean: of linear images, and of those encoded as sRGB (IEC 61966-2-1).
static DECODED: LazyLock<[[f32; 256]; 2]> = LazyLock::new(|| {
    let srgb = |code| {
        let c = code as f64 / 255.0;
        (if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }) as f32
    };
    [std::array::from_fn(|code| code as f32 / 255.0), std::array::from_fn(srgb)]
});

/// Luminance of linear sRGB (ITU-R BT.709).
#[inline]
pub(crate) fn luminance(c: Rgb) -> f32 {
    c.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// All textures and images of a scene.
#[derive(Clone, Debug)]
pub struct Textures {
    textures: Vec<Texture>,
    images: Vec<Arc<Image>>,
}

#[derive(Clone, Debug)]
enum Texture {
    Bitmap { image: u32, filter: Filter, wrap: Wrap, srgb: bool, to_uv: Affine2 },
    Checkerboard { colors: [Rgb; 2], to_uv: Affine2 },
}

impl Textures {
    /// Takes over descriptions; images are shared, not copied.
    pub fn new(descs: &[TextureDesc], images: &[Arc<Image>]) -> Self {
        let compile = |desc: &TextureDesc| match *desc {
            TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, .. } => {
                Texture::Bitmap { image, filter, wrap, srgb, to_uv }
            }
            TextureDesc::Checkerboard { color0, color1, to_uv, .. } => {
                Texture::Checkerboard { colors: [color0, color1], to_uv }
            }
        };
        Self { textures: descs.iter().map(compile).collect(), images: images.to_vec() }
    }

    /// Bytes of all images.
    pub fn memory_bytes(&self) -> usize {
        self.images
            .iter()
            .map(|image| match &image.pixels {
                Pixels::U8 { data, .. } => data.len(),
                Pixels::F32 { data, .. } => 4 * data.len(),
            })
            .sum()
    }

    /// A colour input at a surface coordinate.
    #[inline(always)]
    pub fn color(&self, input: ColorInput, uv: Vec2) -> Rgb {
        match input {
            ColorInput::Constant(color) => color,
            ColorInput::Texture(id) => self.lookup(id, uv),
        }
    }

    /// A scalar input at a surface coordinate: the luminance of a texture.
    #[inline(always)]
    pub fn scalar(&self, input: ScalarInput, uv: Vec2) -> f32 {
        match input {
            ScalarInput::Constant(value) => value,
            ScalarInput::Texture(id) => luminance(self.lookup(id, uv)),
        }
    }

    /// The average of a colour input over the unit square.
    pub fn average(&self, input: ColorInput) -> Rgb {
        match input {
            ColorInput::Constant(color) => color,
            ColorInput::Texture(TextureId(id)) => match &self.textures[id as usize] {
                Texture::Checkerboard { colors, .. } => 0.5 * (colors[0] + colors[1]),
                Texture::Bitmap { image, srgb, .. } => {
                    let image = &self.images[*image as usize];
                    let (mut sum, count) =
                        (glam::DVec3::ZERO, u64::from(image.width) * u64::from(image.height));
                    for y in 0..image.height {
                        for x in 0..image.width {
                            sum += texel(image, *srgb, x, y).as_dvec3();
                        }
                    }
                    (sum / count.max(1) as f64).as_vec3()
                }
            },
        }
    }

    /// The gradient of a texture's luminance with respect to (u, v), by central differences over a texel.
    pub fn gradient(&self, id: TextureId, uv: Vec2) -> Vec2 {
        let at = |uv: Vec2| luminance(self.lookup(id, uv));
        match &self.textures[id.0 as usize] {
            Texture::Checkerboard { .. } => Vec2::ZERO,
            Texture::Bitmap { image, to_uv, .. } => {
                let image = &self.images[*image as usize];
                let size = Vec2::new(image.width as f32, image.height as f32);
                // half a texel along each texture axis, then the chain rule through `to_uv`
                let texture_uv = to_uv.transform_point2(uv);
                let back = to_uv.inverse();
                let along = |step: Vec2, per: f32| {
                    let ahead = at(back.transform_point2(texture_uv + step));
                    let behind = at(back.transform_point2(texture_uv - step));
                    (ahead - behind) * per
                };
                let slope = Vec2::new(
                    along(Vec2::new(0.5 / size.x, 0.0), size.x),
                    along(Vec2::new(0.0, 0.5 / size.y), size.y),
                );
                to_uv.matrix2.transpose() * slope
            }
        }
    }

    /// Not inlined: many places ask for it, and it has no loop to be part of.
    #[inline(never)]
    fn lookup(&self, id: TextureId, uv: Vec2) -> Rgb {
        match &self.textures[id.0 as usize] {
            Texture::Checkerboard { colors, to_uv } => {
                let t = to_uv.transform_point2(uv);
                let is_far = |x: f32| x - to_cell(x) as f32 > 0.5;
                colors[usize::from(is_far(t.x) != is_far(t.y))]
            }
            Texture::Bitmap { image, filter, wrap, srgb, to_uv } => {
                let image = &self.images[*image as usize];
                let at = to_uv.transform_point2(uv);
                let at = at * Vec2::new(image.width as f32, image.height as f32);
                let column = |x: i32| wrapped(x, image.width, *wrap);
                let row = |y: i32| wrapped(y, image.height, *wrap);
                match filter {
                    Filter::Nearest => texel(image, *srgb, column(to_cell(at.x)), row(to_cell(at.y))),
                    Filter::Bilinear => {
                        let at = at - 0.5;
                        let (x, y) = (to_cell(at.x), to_cell(at.y));
                        // Within the cell also where the cell was kept away from the ends.
                        let t = (at - Vec2::new(x as f32, y as f32)).clamp(Vec2::ZERO, Vec2::ONE);
                        bilinear(image, *srgb, [column(x), column(x + 1)], [row(y), row(y + 1)], t)
                    }
                }
            }
        }
    }
}

/// The integer cell of a coordinate, kept away from the ends of `i32`. (`floor` is a library call without SSE 4.1.)
#[inline]
pub(crate) fn to_cell(x: f32) -> i32 {
    let towards_zero = x.clamp(-1e9, 1e9) as i32;
    towards_zero - i32::from(towards_zero as f32 > x)
}

#[inline]
fn wrapped(i: i32, size: u32, wrap: Wrap) -> u32 {
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

#[cfg(test)]
mod tests {
    use super::*;
    use sr_scene::Span;

    fn textures(wrap: Wrap, filter: Filter, to_uv: Affine2) -> Textures {
        let data = vec![0.0, 1.0, 2.0, 3.0];
        let image =
            Image { name: "t".into(), width: 2, height: 2, pixels: Pixels::F32 { channels: 1, data } };
        let desc = TextureDesc::Bitmap { image: 0, filter, wrap, srgb: false, to_uv, span: Span::default() };
        Textures::new(&[desc], &[Arc::new(image)])
    }

    fn at(t: &Textures, u: f32, v: f32) -> f32 {
        t.scalar(ScalarInput::Texture(TextureId(0)), Vec2::new(u, v))
    }

    #[test]
    fn bilinear_is_exact_at_centres_and_linear_between() {
        let t = textures(Wrap::Clamp, Filter::Bilinear, Affine2::IDENTITY);
        assert_eq!(at(&t, 0.25, 0.25), 0.0);
        assert_eq!(at(&t, 0.75, 0.75), 3.0);
        assert!((at(&t, 0.5, 0.5) - 1.5).abs() < 1e-6);
        assert_eq!(at(&t, -9.0, 0.25), 0.0);
    }

    #[test]
    fn bilinear_stays_between_texels_at_any_coordinate() {
        let t = textures(Wrap::Repeat, Filter::Bilinear, Affine2::IDENTITY);
        for far in [1e6, 1e9, 3e9, -7e12, f32::MAX, f32::NEG_INFINITY, f32::NAN] {
            let value = at(&t, far, 0.3);
            assert!((0.0..=3.0).contains(&value), "{value} at {far}");
        }
    }

    #[test]
    fn wrapping() {
        let near = |wrap| textures(wrap, Filter::Nearest, Affine2::IDENTITY);
        assert_eq!(at(&near(Wrap::Repeat), 1.25, -0.25), 2.0);
        assert_eq!(at(&near(Wrap::Mirror), 1.25, 0.25), 1.0);
        assert_eq!(at(&near(Wrap::Clamp), 7.0, 7.0), 3.0);
        assert!(at(&near(Wrap::Repeat), f32::INFINITY, f32::NAN).is_finite());
    }

    #[test]
    fn gradient_follows_the_texture_and_its_transform() {
        let t = textures(Wrap::Clamp, Filter::Bilinear, Affine2::IDENTITY);
        let g = t.gradient(TextureId(0), Vec2::splat(0.5));
        assert!((g - Vec2::new(2.0, 4.0)).length() < 1e-4, "{g}");
        let t = textures(Wrap::Repeat, Filter::Bilinear, Affine2::from_scale(Vec2::new(2.0, 0.5)));
        let g = t.gradient(TextureId(0), Vec2::new(0.25, 1.0));
        assert!((g - Vec2::new(4.0, 2.0)).length() < 1e-4, "{g}");
    }

    #[test]
    fn srgb_codes_decode() {
        assert!((DECODED[1][128] - 0.215_86).abs() < 1e-5);
        assert_eq!((DECODED[0][51], DECODED[0][255], DECODED[1][255]), (0.2, 1.0, 1.0));
    }
}
