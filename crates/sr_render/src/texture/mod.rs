//! Textures: a point of a surface to a colour.
//!
//! In: the description's images and textures. Out: [`Textures`], which a [`ColorInput`] or a
//! [`ScalarInput`] is looked up in at a [`TexturePoint`]. A lookup is at a point, except in textures whose filter is
//! [`Filter::Mipmap`].

mod cells;
mod mip;
mod point;
mod texel;

use std::sync::Arc;

use glam::{Affine2, Vec2, Vec3};
use sr_scene::{
    ColorInput, Filter, Image, MAX_UV_SETS, MeshColorOf, Pixels, Rgb, ScalarInput, TextureDesc, TextureId,
    Wrap,
};

use cells::nearest;
pub(crate) use cells::{Cells, to_cell};
use mip::Pyramid;
pub(crate) use point::{FurtherUvs, MeshColors, footprint};
pub use point::{RayCone, TexturePoint};
pub(crate) use texel::{bilinear, prefetch_texel, texel};

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
    /// The smaller copies of images that some texture needs.
    pyramids: Vec<Pyramid>,
}

#[derive(Clone, Debug)]
enum Texture {
    Bitmap { image: u32, filter: Filter, wrap: Wrap, srgb: bool, to_uv: Affine2 },
    Mipmap { image: u32, pyramid: u32, wrap: Wrap, srgb: bool, to_uv: Affine2 },
    Checkerboard { colors: [ColorInput; 2], to_uv: Affine2 },
    Scale([ColorInput; 2]),
    Mix { colors: [ColorInput; 2], weight: ScalarInput },
    OtherUvs { color: ColorInput, set: u8 },
    MeshColor { of: MeshColorOf, scale: f32 },
}

impl Textures {
    /// Takes over descriptions; images are shared, not copied. Each texture may refer to those before it.
    pub fn new(descs: &[TextureDesc], images: &[Arc<Image>]) -> Self {
        let mut all = Self { textures: Vec::new(), images: images.to_vec(), pyramids: Vec::new() };
        // of which image, decoded how, each pyramid is
        let mut known: Vec<(u32, bool)> = Vec::new();
        for desc in descs {
            let texture = match *desc {
                TextureDesc::Bitmap { image, filter: Filter::Mipmap, wrap, srgb, to_uv, .. } => {
                    let pyramid = known.iter().position(|&of| of == (image, srgb)).unwrap_or_else(|| {
                        known.push((image, srgb));
                        all.pyramids.push(Pyramid::new(&images[image as usize], srgb));
                        known.len() - 1
                    });
                    Texture::Mipmap { image, pyramid: pyramid as u32, wrap, srgb, to_uv }
                }
                TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, .. } => {
                    Texture::Bitmap { image, filter, wrap, srgb, to_uv }
                }
                TextureDesc::Checkerboard { color0, color1, to_uv, .. } => {
                    Texture::Checkerboard { colors: [color0, color1], to_uv }
                }
                TextureDesc::Scale { input, factor, .. } => Texture::Scale([input, factor]),
                TextureDesc::Mix { color0, color1, weight, .. } => {
                    Texture::Mix { colors: [color0, color1], weight }
                }
                TextureDesc::OtherUvs { input, set, .. } => {
                    Texture::OtherUvs { color: input, set: set.min(MAX_UV_SETS - 1) as u8 }
                }
                TextureDesc::MeshColor { of, scale, .. } => Texture::MeshColor { of, scale },
            };
            all.textures.push(texture);
        }
        all
    }

    /// Bytes of all images.
    pub fn memory_bytes(&self) -> usize {
        let of_image = |image: &Image| match &image.pixels {
            Pixels::U8 { data, .. } => data.len(),
            Pixels::F32 { data, .. } => 4 * data.len(),
        };
        self.images.iter().map(|image| of_image(image)).sum::<usize>()
            + self.pyramids.iter().flat_map(Pyramid::levels).map(of_image).sum::<usize>()
    }

    /// Does any lookup depend on [`TexturePoint::footprint`]?
    #[inline(always)]
    pub(crate) fn has_mipmaps(&self) -> bool {
        !self.pyramids.is_empty()
    }

    /// A colour input at a point of a surface. What is negative in a texture is black.
    #[inline(always)]
    pub fn color(&self, input: ColorInput, at: impl Into<TexturePoint>) -> Rgb {
        self.value(input, at).max(Rgb::ZERO)
    }

    /// The same as it is: displacements may be negative.
    #[inline(always)]
    fn value(&self, input: ColorInput, at: impl Into<TexturePoint>) -> Rgb {
        match input {
            ColorInput::Constant(color) => color,
            ColorInput::Texture(id) => self.lookup(id, &at.into()),
        }
    }

    /// The first of two steps of [`Self::lookup`]: asks for the memory that the second reads, so that whoever looks up
    /// at many points takes each step for all before the next. Large images are not in caches.
    #[inline(always)]
    pub(crate) fn begin(&self, TextureId(id): TextureId, at: &TexturePoint) -> Cells {
        match &self.textures[id as usize] {
            Texture::Bitmap { image, wrap, to_uv, .. } => self.prefetch_image(*image, *wrap, to_uv, at.uv),
            _ => {
                self.prefetch_composite(TextureId(id), at);
                Cells::NONE
            }
        }
    }

    /// The second step.
    #[inline(always)]
    pub(crate) fn finish(&self, id: TextureId, cells: &Cells, at: &TexturePoint) -> Rgb {
        match &self.textures[id.0 as usize] {
            Texture::Bitmap { image, filter: Filter::Bilinear, srgb, .. } => {
                bilinear(&self.images[*image as usize], *srgb, cells)
            }
            _ => self.lookup(id, at),
        }
    }

    #[inline(always)]
    fn prefetch_image(&self, image: u32, wrap: Wrap, to_uv: &Affine2, uv: Vec2) -> Cells {
        let image = &self.images[image as usize];
        let cells = Cells::around(image, wrap, to_uv.transform_point2(uv));
        for y in cells.rows {
            prefetch_texel(image, cells.columns[0], y);
        }
        cells
    }

    /// Of what is less common.
    #[inline(never)]
    fn prefetch_composite(&self, TextureId(id): TextureId, at: &TexturePoint) {
        let color = |input, at: &TexturePoint| {
            if let ColorInput::Texture(id) = input {
                self.begin(id, at);
            }
        };
        match &self.textures[id as usize] {
            // further copies are small
            Texture::Mipmap { image, wrap, to_uv, .. } if at.footprint == 0.0 => {
                self.prefetch_image(*image, *wrap, to_uv, at.uv);
            }
            &Texture::Scale([a, b]) => {
                color(a, at);
                color(b, at);
            }
            &Texture::Mix { colors: [a, b], weight } => {
                color(a, at);
                color(b, at);
                if let ScalarInput::Texture(id) = weight {
                    self.begin(id, at);
                }
            }
            &Texture::OtherUvs { color: input, set } => color(input, &at.at_set(set)),
            Texture::Bitmap { .. }
            | Texture::Mipmap { .. }
            | Texture::Checkerboard { .. }
            | Texture::MeshColor { .. } => {}
        }
    }

    /// A scalar input at a point of a surface: the luminance of a texture.
    #[inline(always)]
    pub fn scalar(&self, input: ScalarInput, at: impl Into<TexturePoint>) -> f32 {
        match input {
            ScalarInput::Constant(value) => value,
            ScalarInput::Texture(id) => luminance(self.lookup(id, &at.into())),
        }
    }

    /// The average of a colour input over the unit square. Of products and mixtures: as if their parts varied
    /// independently.
    pub fn average(&self, input: ColorInput) -> Rgb {
        let TextureId(id) = match input {
            ColorInput::Constant(color) => return color,
            ColorInput::Texture(id) => id,
        };
        match &self.textures[id as usize] {
            &Texture::Checkerboard { colors: [a, b], .. } => 0.5 * (self.average(a) + self.average(b)),
            &Texture::Scale([a, b]) => self.average(a) * self.average(b),
            &Texture::Mix { colors: [a, b], weight } => {
                let weight = match weight {
                    ScalarInput::Constant(weight) => weight,
                    ScalarInput::Texture(id) => luminance(self.average(ColorInput::Texture(id))),
                };
                self.average(a).lerp(self.average(b), weight.clamp(0.0, 1.0))
            }
            Texture::OtherUvs { color, .. } => self.average(*color),
            Texture::MeshColor { scale, .. } => Rgb::splat(0.5 * scale),
            Texture::Bitmap { image, srgb, .. } | Texture::Mipmap { image, srgb, .. } => {
                let image = &self.images[*image as usize];
                let (mut sum, count) = (glam::DVec3::ZERO, u64::from(image.width) * u64::from(image.height));
                for y in 0..image.height {
                    for x in 0..image.width {
                        sum += texel(image, *srgb, x, y).as_dvec3();
                    }
                }
                (sum / count.max(1) as f64).as_vec3()
            }
        }
    }

    /// The gradient of a texture's luminance with respect to (u, v): that of the bilinear surface between four texels; of
    /// whatever else, by central differences over a texel.
    pub fn gradient(&self, id: TextureId, at: impl Into<TexturePoint>) -> Vec2 {
        let point = at.into();
        let uv = point.uv;
        let at = |uv: Vec2| luminance(self.lookup(id, &TexturePoint { uv, ..point }));
        match &self.textures[id.0 as usize] {
            Texture::Bitmap { image, filter: Filter::Bilinear, wrap, srgb, to_uv } => {
                let image = &self.images[*image as usize];
                let slope = bilinear_slope(image, (*wrap, *srgb), to_uv.transform_point2(uv));
                to_uv.matrix2.transpose() * slope
            }
            Texture::OtherUvs { color: ColorInput::Texture(inner), set } => {
                self.gradient(*inner, point.at_set(*set))
            }
            Texture::Bitmap { image, to_uv, .. } | Texture::Mipmap { image, to_uv, .. } => {
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
            _ => match self.finest_texel(id) {
                Some(texel) => {
                    let half = 0.5 * texel;
                    let along = |step: Vec2| (at(uv + step) - at(uv - step)) / texel;
                    Vec2::new(along(Vec2::new(half, 0.0)), along(Vec2::new(0.0, half)))
                }
                None => Vec2::ZERO,
            },
        }
    }

    /// The width in (u, v) of the smallest texel in what a texture is made of, if there are any.
    fn finest_texel(&self, TextureId(id): TextureId) -> Option<f32> {
        let of_color = |input| match input {
            ColorInput::Texture(id) => self.finest_texel(id),
            ColorInput::Constant(_) => None,
        };
        let least = |parts: [Option<f32>; 3]| parts.into_iter().flatten().reduce(f32::min);
        match &self.textures[id as usize] {
            Texture::Bitmap { image, to_uv, .. } | Texture::Mipmap { image, to_uv, .. } => {
                let image = &self.images[*image as usize];
                let axes =
                    [to_uv.matrix2.row(0) * image.width as f32, to_uv.matrix2.row(1) * image.height as f32];
                let width = 1.0 / axes[0].length().max(axes[1].length());
                width.is_finite().then_some(width)
            }
            &Texture::Checkerboard { colors: [a, b], .. } | &Texture::Scale([a, b]) => {
                least([of_color(a), of_color(b), None])
            }
            &Texture::Mix { colors: [a, b], weight } => {
                let of_weight = match weight {
                    ScalarInput::Texture(id) => self.finest_texel(id),
                    ScalarInput::Constant(_) => None,
                };
                least([of_color(a), of_color(b), of_weight])
            }
            &Texture::OtherUvs { color, .. } => of_color(color),
            Texture::MeshColor { .. } => None,
        }
    }

    /// The set of texture coordinates that a colour is looked up at, if it is not the first one.
    pub(crate) fn other_set(&self, input: ColorInput) -> Option<u8> {
        let ColorInput::Texture(TextureId(id)) = input else { return None };
        match &self.textures[id as usize] {
            &Texture::OtherUvs { set, .. } => Some(set),
            &Texture::Checkerboard { colors: [a, b], .. } | &Texture::Scale([a, b]) => {
                self.other_set(a).or_else(|| self.other_set(b))
            }
            &Texture::Mix { colors: [a, b], .. } => self.other_set(a).or_else(|| self.other_set(b)),
            Texture::Bitmap { .. } | Texture::Mipmap { .. } | Texture::MeshColor { .. } => None,
        }
    }

    /// Not inlined: many places ask for it, and it has no loop to be part of.
    #[inline(never)]
    pub(crate) fn lookup(&self, id: TextureId, at: &TexturePoint) -> Rgb {
        match &self.textures[id.0 as usize] {
            Texture::Bitmap { image, filter, wrap, srgb, to_uv } => {
                let image = &self.images[*image as usize];
                filtered(image, (*filter, *wrap, *srgb), to_uv.transform_point2(at.uv))
            }
            Texture::Checkerboard { colors, to_uv } => {
                let t = to_uv.transform_point2(at.uv);
                let is_far = |x: f32| x - to_cell(x) as f32 > 0.5;
                self.value(colors[usize::from(is_far(t.x) != is_far(t.y))], *at)
            }
            _ => self.lookup_composite(id, at),
        }
    }

    /// Of what is less common.
    #[inline(never)]
    fn lookup_composite(&self, id: TextureId, at: &TexturePoint) -> Rgb {
        match &self.textures[id.0 as usize] {
            Texture::Mipmap { image, pyramid, wrap, srgb, to_uv } => {
                let base = &self.images[*image as usize];
                let texels =
                    (to_uv.matrix2.determinant().abs() * base.width as f32 * base.height as f32).sqrt();
                let uv = to_uv.transform_point2(at.uv);
                let of = |image: &Image| filtered(image, (Filter::Bilinear, *wrap, *srgb), uv);
                self.pyramids[*pyramid as usize].lookup(base, at.footprint * texels, of)
            }
            &Texture::Scale([a, b]) => self.value(a, *at) * self.value(b, *at),
            &Texture::Mix { colors: [a, b], weight } => {
                let weight = self.scalar(weight, *at).clamp(0.0, 1.0);
                self.value(a, *at) * (1.0 - weight) + self.value(b, *at) * weight
            }
            &Texture::OtherUvs { color, set } => self.value(color, at.at_set(set)),
            &Texture::MeshColor { of, scale } => {
                scale
                    * match of {
                        MeshColorOf::Vertices => at.vertex_color,
                        MeshColorOf::Faces => at.face_color,
                    }
            }
            Texture::Bitmap { .. } | Texture::Checkerboard { .. } => self.lookup(id, at),
        }
    }
}

/// An image at a texture coordinate.
#[inline(always)]
fn filtered(image: &Image, (filter, wrap, srgb): (Filter, Wrap, bool), uv: Vec2) -> Rgb {
    match filter {
        Filter::Nearest => {
            let [x, y] = nearest(image, wrap, uv);
            texel(image, srgb, x, y)
        }
        Filter::Bilinear | Filter::Mipmap => bilinear(image, srgb, &Cells::around(image, wrap, uv)),
    }
}

/// The gradient of the luminance between four texels, with respect to the coordinates of the unit square.
fn bilinear_slope(image: &Image, (wrap, srgb): (Wrap, bool), uv: Vec2) -> Vec2 {
    let size = Vec2::new(image.width as f32, image.height as f32);
    let Cells { columns, rows, t } = Cells::around(image, wrap, uv);
    let height = |i: usize, j: usize| luminance(texel(image, srgb, columns[i], rows[j]));
    let [a, b, c, d] = [height(0, 0), height(1, 0), height(0, 1), height(1, 1)];
    let mix = |low: f32, high: f32, t: f32| low + t * (high - low);
    size * Vec2::new(mix(b - a, d - c, t.y), mix(c - a, d - b, t.x))
}

#[cfg(test)]
mod tests {
    use super::texel::DECODED;
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

    /// Between four texels the surface is a + b x + c y + d x y; its slope is not that of a whole texel's width.
    #[test]
    fn slopes_are_those_of_the_bilinear_surface() {
        let data = vec![0.0, 1.0, 4.0, 2.0];
        let image =
            Image { name: "t".into(), width: 2, height: 2, pixels: Pixels::F32 { channels: 1, data } };
        let to_uv = Affine2::from_scale(Vec2::new(0.5, 2.0));
        let (filter, wrap, span) = (Filter::Bilinear, Wrap::Repeat, Span::default());
        let desc = TextureDesc::Bitmap { image: 0, filter, wrap, srgb: false, to_uv, span };
        let t = Textures::new(&[desc], &[Arc::new(image)]);
        for (u, v) in [(0.7, 0.2), (1.3, 0.19), (0.9, 0.3), (0.1, 0.01)] {
            let step = 1e-3;
            let slope = |du: f32, dv: f32| {
                (at(&t, u + du * step, v + dv * step) - at(&t, u - du * step, v - dv * step)) / (2.0 * step)
            };
            let expected = Vec2::new(slope(1.0, 0.0), slope(0.0, 1.0));
            let got = t.gradient(TextureId(0), Vec2::new(u, v));
            assert!((got - expected).length() < 2e-2, "{u} {v}: {got}, not {expected}");
        }
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
    fn textures_are_made_of_others() {
        let span = Span::default();
        let texture = |id| ColorInput::Texture(TextureId(id));
        let number = |v: f32| ColorInput::Constant(Rgb::splat(v));
        let data = vec![0.0, 1.0, 2.0, 3.0];
        let image =
            Image { name: "t".into(), width: 2, height: 2, pixels: Pixels::F32 { channels: 1, data } };
        let descs = [
            TextureDesc::Bitmap {
                image: 0,
                filter: Filter::Bilinear,
                wrap: Wrap::Clamp,
                srgb: false,
                to_uv: Affine2::IDENTITY,
                span: span.clone(),
            },
            TextureDesc::Scale { input: texture(0), factor: number(2.0), span: span.clone() },
            TextureDesc::Mix {
                color0: texture(1),
                color1: number(10.0),
                weight: ScalarInput::Constant(0.25),
                span: span.clone(),
            },
            TextureDesc::Checkerboard {
                color0: texture(2),
                color1: number(7.0),
                to_uv: Affine2::IDENTITY,
                span: span.clone(),
            },
            TextureDesc::Scale { input: texture(0), factor: texture(0), span },
        ];
        let t = Textures::new(&descs, &[Arc::new(image)]);
        let at = |id, u, v| t.scalar(ScalarInput::Texture(TextureId(id)), Vec2::new(u, v));
        assert!((at(1, 0.75, 0.75) - 6.0).abs() < 1e-6);
        assert!((at(2, 0.75, 0.75) - 7.0).abs() < 1e-6);
        assert!((at(3, 0.75, 0.75) - 7.0).abs() < 1e-6, "the texture");
        assert!((at(3, 0.25, 0.75) - 7.0).abs() < 1e-6, "the constant");
        assert!((at(3, 0.25, 0.25) - 2.5).abs() < 1e-6);
        assert!((t.average(texture(2)).x - 4.75).abs() < 1e-6);
        // of the square of 2 u + 4 v − 1.5: 2 t (2, 4)
        let g = t.gradient(TextureId(4), Vec2::splat(0.5));
        assert!((g - Vec2::new(6.0, 12.0)).length() < 1e-3, "{g}");
        let g = t.gradient(TextureId(1), Vec2::splat(0.5));
        assert!((g - Vec2::new(4.0, 8.0)).length() < 1e-3, "{g}");
    }

    #[test]
    fn mesh_colors_are_the_point_s() {
        let span = Span::default();
        let of = |of| TextureDesc::MeshColor { of, scale: 2.0, span: span.clone() };
        let t = Textures::new(&[of(MeshColorOf::Vertices), of(MeshColorOf::Faces)], &[]);
        let point = TexturePoint { vertex_color: Rgb::X, face_color: Rgb::Y, ..Vec2::ZERO.into() };
        assert_eq!(t.color(ColorInput::Texture(TextureId(0)), point), 2.0 * Rgb::X);
        assert_eq!(t.color(ColorInput::Texture(TextureId(1)), point), 2.0 * Rgb::Y);
    }

    #[test]
    fn srgb_codes_decode() {
        assert!((DECODED[1][128] - 0.215_86).abs() < 1e-5);
        assert_eq!((DECODED[0][51], DECODED[0][255], DECODED[1][255]), (0.2, 1.0, 1.0));
    }
}
