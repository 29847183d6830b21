//! Textures: of colors ("spectrum") and of numbers ("float").

use std::sync::Arc;

use glam::{Affine2, DVec3, Mat2, Vec2};
use sr_scene::{ColorInput, Filter, Image, Pixels, Rgb, ScalarInput, Span, TextureDesc, TextureId, Wrap};
use sr_spectra::Smooth;

use super::Writer;
use super::text::Params;
use crate::bake::{decoded, luminance};

/// From pbrt's (s, t), whose t counts from the bottom row of an image, to ours, and back.
const FROM_TOP: Affine2 = Affine2 { matrix2: Mat2::from_cols(Vec2::X, Vec2::NEG_Y), translation: Vec2::Y };

/// A texture, and what it is wanted for.
pub(super) type Key = (TextureId, Use);

/// What a texture is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Use {
    Color,
    Number,
    /// A number, squared.
    Square,
    /// A color as the base below a coat of pbrt's.
    Base(Coats),
}

impl Use {
    fn apply(self, color: Rgb) -> Rgb {
        match self {
            Self::Color => color,
            Self::Number => Rgb::splat(luminance(color)),
            Self::Square => Rgb::splat(luminance(color).powi(2)),
            Self::Base(coats) => coats.base(color),
        }
    }

    fn is_number(self) -> bool {
        matches!(self, Self::Number | Self::Square)
    }
}

/// Of diffuse light from the base, how much a coat returns to it; by their bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Coats {
    ours: u32,
    pbrts: u32,
    /// Does our base's color saturate by interreflection? pbrt's does.
    nonlinear: bool,
}

impl Coats {
    pub fn new(ours: f32, pbrts: f32, nonlinear: bool) -> Self {
        Self { ours: ours.to_bits(), pbrts: pbrts.to_bits(), nonlinear }
    }

    /// The albedo under pbrt's coat that reflects as much as `albedo` under ours, all bounces counted.
    fn base(self, albedo: Rgb) -> Rgb {
        let (ours, pbrts) = (f32::from_bits(self.ours), f32::from_bits(self.pbrts));
        let returned = if self.nonlinear { albedo * ours } else { Rgb::splat(ours) };
        let all = albedo / (1.0 - returned).max(Rgb::splat(f32::EPSILON));
        (all / (1.0 + all * pbrts)).min(Rgb::ONE)
    }

    /// Is the base the same, but for what spectra do?
    pub fn are_the_same(self) -> bool {
        self.nonlinear && self.ours == self.pbrts
    }

    /// The same of one color, whose smooth spectrum bounces under pbrt's coat: by a fixed point.
    fn base_of_spectrum(self, albedo: Rgb) -> Rgb {
        let (first, pbrts) = (self.base(albedo), f32::from_bits(self.pbrts));
        let wanted = (first / (1.0 - first * pbrts)).as_dvec3();
        let mut base = first.as_dvec3();
        for _ in 0..8 {
            let got = Smooth::reflectance(base).map(|rho| rho / (1.0 - rho * f64::from(pbrts)));
            let step = (wanted / got.max(DVec3::splat(1e-6))).clamp(DVec3::splat(0.5), DVec3::splat(2.0));
            base = (base * step).clamp(DVec3::ZERO, DVec3::ONE);
        }
        base.as_vec3()
    }
}

impl Writer<'_> {
    /// A color, constant or textured.
    pub(super) fn color(&mut self, params: Params, name: &str, input: ColorInput, wanted: Use) -> Params {
        match input {
            ColorInput::Constant(color) => match wanted {
                Use::Base(coats) => params.rgb(name, coats.base_of_spectrum(color)),
                _ => params.rgb(name, wanted.apply(color)),
            },
            ColorInput::Texture(id) => {
                let texture = self.texture(id, wanted);
                params.texture(name, &texture)
            }
        }
    }

    /// A number, constant or textured.
    pub(super) fn number(&mut self, params: Params, name: &str, input: ScalarInput, wanted: Use) -> Params {
        match input {
            ScalarInput::Constant(value) => params.float(name, wanted.apply(Rgb::splat(value)).x),
            ScalarInput::Texture(id) => {
                let texture = self.texture(id, wanted);
                params.texture(name, &texture)
            }
        }
    }

    /// The name of a texture, which is described first.
    pub(super) fn texture(&mut self, id: TextureId, wanted: Use) -> String {
        if let Some(name) = self.textures.get(&(id, wanted)) {
            return name.clone();
        }
        let name = match wanted {
            Use::Color => format!("texture{}", id.0),
            Use::Number => format!("texture{}-number", id.0),
            Use::Square => format!("texture{}-square", id.0),
            Use::Base(_) => format!("texture{}-base{}", id.0, self.textures.len()),
        };
        self.textures.insert((id, wanted), name.clone());
        self.describe(&name, id, wanted);
        name
    }

    fn describe(&mut self, name: &str, id: TextureId, wanted: Use) {
        let scene = self.scene;
        let Some(desc) = scene.textures.get(id.0 as usize) else { return };
        let kind = if wanted.is_number() { "float" } else { "spectrum" };
        let is_plain = matches!(wanted, Use::Color | Use::Number);
        match desc {
            TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, span } if is_diagonal(*to_uv) => {
                let Some(image) = scene.images.get(*image as usize) else { return };
                let (image, srgb) = self.wanted_image(image, *srgb, wanted);
                if *wrap == Wrap::Mirror {
                    let message = "pbrt has no mirrored tiles of an image";
                    self.notes.push("convert::texture", span, message, "they are not mirrored");
                }
                let place = (*filter, *wrap, FROM_TOP * *to_uv);
                self.imagemap(name, kind, &image, srgb, place);
            }
            TextureDesc::Checkerboard { color0, color1, to_uv, .. } if is_plain && is_diagonal(*to_uv) => {
                let params = self.either(Params::default(), "tex1", *color0, wanted);
                let params = self.either(params, "tex2", *color1, wanted);
                // A square is one unit of pbrt's, and half a unit of ours.
                let params = mapped(params, Affine2::from_scale(Vec2::splat(2.0)) * *to_uv);
                self.definitions.texture(name, kind, "checkerboard", &params);
            }
            TextureDesc::Mix { color0, color1, weight, .. } if is_plain => {
                let params = self.either(Params::default(), "tex1", *color0, wanted);
                let params = self.either(params, "tex2", *color1, wanted);
                let params = self.number(params, "amount", *weight, Use::Number);
                self.definitions.texture(name, kind, "mix", &params);
            }
            TextureDesc::Scale { span, .. } => self.product(name, kind, id, wanted, span),
            TextureDesc::OtherUvs { input, span, .. } => {
                let message = "pbrt's meshes have one set of texture coordinates";
                self.notes.push("convert::texture-coordinates", span, message, "the first one is used");
                if let ColorInput::Texture(input) = *input {
                    self.describe(name, input, wanted);
                }
            }
            TextureDesc::MeshColor { scale, span, .. } => {
                let message = "pbrt does not use colors of meshes";
                self.notes.push("convert::texture", span, message, "grey is written");
                let grey = ColorInput::Constant(wanted.apply(Rgb::splat(0.5 * scale)));
                let params = self.either(Params::default(), "value", grey, Use::Color);
                let params =
                    if wanted.is_number() { Params::default().float("value", 0.5 * scale) } else { params };
                self.definitions.texture(name, kind, "constant", &params);
            }
            TextureDesc::Bitmap { span, .. } => {
                self.baked(name, kind, id, wanted, (span, "rotated texture coordinates"));
            }
            TextureDesc::Checkerboard { span, .. } | TextureDesc::Mix { span, .. } => {
                self.baked(name, kind, id, wanted, (span, "function of such a texture"));
            }
        }
    }

    /// A constant times a texture.
    fn product(&mut self, name: &str, kind: &str, id: TextureId, wanted: Use, span: &Span) {
        let scene = self.scene;
        let factored = self.baker.factored(ColorInput::Texture(id));
        let factor = factored.factor;
        let Some(base) = factored.texture.filter(|base| *base != id) else {
            return self.baked(name, kind, id, wanted, (span, "product of two textures of colors"));
        };
        let is_grey = factor.x == factor.y && factor.y == factor.z;
        if is_grey && matches!(wanted, Use::Color | Use::Number) {
            let texture = self.texture(base, wanted);
            let params = Params::default().texture("tex", &texture).float("scale", factor.x);
            return self.definitions.texture(name, kind, "scale", &params);
        }
        match scene.textures.get(base.0 as usize) {
            Some(TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, .. }) if is_diagonal(*to_uv) => {
                let Some(image) = scene.images.get(*image as usize) else { return };
                let scaled = self.baker.texels(image, *srgb, |color| wanted.apply(color * factor));
                let scaled = if wanted.is_number() { grey(&scaled, false) } else { scaled };
                self.imagemap(name, kind, &scaled, false, (*filter, *wrap, FROM_TOP * *to_uv));
            }
            _ => self.baked(name, kind, id, wanted, (span, "product of a texture and a color")),
        }
    }

    /// The image that has what is wanted, and whether its bytes are sRGB-encoded.
    fn wanted_image(&mut self, image: &Arc<Image>, srgb: bool, wanted: Use) -> (Arc<Image>, bool) {
        let is_grey =
            matches!(image.pixels, Pixels::U8 { channels: 1, .. } | Pixels::F32 { channels: 1, .. });
        match wanted {
            Use::Color => (image.clone(), srgb),
            Use::Number if is_grey => (image.clone(), srgb),
            Use::Number => (grey(image, srgb), false),
            _ => {
                let made = self.baker.texels(image, srgb, |color| wanted.apply(color));
                (if wanted.is_number() { grey(&made, false) } else { made }, false)
            }
        }
    }

    fn baked(&mut self, name: &str, kind: &str, id: TextureId, wanted: Use, (span, what): (&Span, &str)) {
        let baked = self.baker.over_unit_square(id, |color| wanted.apply(color));
        let (width, height) = (baked.image.width, baked.image.height);
        let instead =
            format!("an image of {width} × {height} texels is written, repeated for each unit of u and v");
        self.notes.push("convert::texture-as-image", span, format!("pbrt has no {what}"), instead);
        let image = if wanted.is_number() { grey(&baked.image, false) } else { baked.image };
        self.imagemap(name, kind, &image, false, (baked.filter, Wrap::Repeat, FROM_TOP));
    }

    fn imagemap(
        &mut self,
        name: &str,
        kind: &str,
        image: &Arc<Image>,
        srgb: bool,
        (filter, wrap, mapping): (Filter, Wrap, Affine2),
    ) {
        let filter = match filter {
            Filter::Nearest => "point",
            Filter::Bilinear => "bilinear",
            Filter::Mipmap => "trilinear",
        };
        let wrap = if wrap == Wrap::Clamp { "clamp" } else { "repeat" };
        let file = self.files.image(image);
        let mut params =
            Params::default().string("filename", &file).string("filter", filter).string("wrap", wrap);
        if matches!(image.pixels, Pixels::U8 { .. }) {
            params = params.string("encoding", if srgb { "sRGB" } else { "linear" });
        }
        self.definitions.texture(name, kind, "imagemap", &mapped(params, mapping));
    }

    /// A number or a color, as is wanted.
    fn either(&mut self, params: Params, name: &str, input: ColorInput, wanted: Use) -> Params {
        match input {
            ColorInput::Constant(color) if wanted == Use::Number => params.float(name, luminance(color)),
            input => self.color(params, name, input, wanted),
        }
    }

    /// An image of a color over the surface's unit square, as lights and normals want it, and a factor.
    pub(super) fn plain_image(
        &mut self,
        id: TextureId,
        span: &Span,
        bytes_are_srgb: bool,
    ) -> (Arc<Image>, Rgb) {
        let scene = self.scene;
        let factored = self.baker.factored(ColorInput::Texture(id));
        let base = factored.texture.and_then(|base| scene.textures.get(base.0 as usize));
        if let Some(TextureDesc::Bitmap { image, srgb, to_uv, wrap, filter, .. }) = base
            && let Some(image) = scene.images.get(*image as usize)
        {
            let is_right = matches!(image.pixels, Pixels::F32 { .. }) || *srgb == bytes_are_srgb;
            if (*wrap, *filter) != (if bytes_are_srgb { Wrap::Clamp } else { Wrap::Repeat }, Filter::Bilinear)
            {
                let message =
                    "pbrt interpolates images of lights up to their border, and repeats those of normals";
                self.notes.push("convert::texture", span, message, "it does so here");
            }
            let linear = || self.baker.texels(image, *srgb, |color| color);
            if *to_uv == FROM_TOP {
                return (if is_right { image.clone() } else { linear() }, factored.factor);
            }
            if *to_uv == Affine2::IDENTITY {
                return (upright(&linear()), factored.factor);
            }
        }
        let baked = self.baker.over_unit_square(id, |color| color);
        let (width, height) = (baked.image.width, baked.image.height);
        let instead = format!("an image of {width} × {height} texels is written, from 0 to 1 in u and v");
        let message = "pbrt's lights and normals take images as they are";
        self.notes.push("convert::texture-as-image", span, message, instead);
        (upright(&baked.image), Rgb::ONE)
    }
}

/// The rows of an image in the other order: v counted from the other end.
fn upright(image: &Arc<Image>) -> Arc<Image> {
    let colors: Vec<Rgb> = decoded(image, false).collect();
    let rows = colors.chunks(image.width.max(1) as usize).rev();
    let data = rows.flatten().flat_map(|color| color.to_array()).collect();
    Arc::new(Image { pixels: Pixels::F32 { channels: 3, data }, ..(**image).clone() })
}

/// The luminance of an image.
fn grey(image: &Arc<Image>, srgb: bool) -> Arc<Image> {
    let data = decoded(image, srgb).map(luminance).collect();
    Arc::new(Image { pixels: Pixels::F32 { channels: 1, data }, ..(**image).clone() })
}

fn is_diagonal(m: Affine2) -> bool {
    m.matrix2.x_axis.y == 0.0 && m.matrix2.y_axis.x == 0.0
}

fn mapped(params: Params, mapping: Affine2) -> Params {
    if mapping == Affine2::IDENTITY {
        return params;
    }
    let (scale, delta) = (mapping.matrix2, mapping.translation);
    params
        .float("uscale", scale.x_axis.x)
        .float("vscale", scale.y_axis.y)
        .float("udelta", delta.x)
        .float("vdelta", delta.y)
}
