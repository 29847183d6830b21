//! Textures, and the colors and numbers that may be textures.

use std::sync::Arc;

use glam::Affine2;
use sr_scene::{
    ColorInput, Filter, Image, MeshColorOf, Rgb, ScalarInput, Span, TextureDesc, TextureId, Wrap,
};

use super::Writer;
use super::xml::Xml;

impl Writer<'_> {
    /// A color, constant or textured.
    pub(super) fn color(&mut self, xml: &mut Xml, name: &str, input: ColorInput) {
        match input {
            ColorInput::Constant(color) => xml.rgb(name, color),
            ColorInput::Texture(id) => match self.texture(id) {
                Some(id) => xml.reference(Some(name), &id),
                None => xml.rgb(name, Rgb::splat(0.5)),
            },
        }
    }

    /// A color that is left out where it is white.
    pub(super) fn factor(&mut self, xml: &mut Xml, name: &str, input: ColorInput) {
        if input != ColorInput::Constant(Rgb::ONE) {
            self.color(xml, name, input);
        }
    }

    /// A number, constant or textured.
    pub(super) fn number(&mut self, xml: &mut Xml, name: &str, input: ScalarInput) {
        match input {
            ScalarInput::Constant(value) => xml.float(name, value),
            ScalarInput::Texture(id) => self.color(xml, name, ColorInput::Texture(id)),
        }
    }

    /// The id of a texture, which is described first.
    pub(super) fn texture(&mut self, id: TextureId) -> Option<String> {
        if let Some(name) = self.textures.get(&id) {
            return Some(name.clone());
        }
        let name = format!("texture{}", id.0);
        let mut xml = Xml::inside(1);
        let scene = self.scene;
        match scene.textures.get(id.0 as usize)? {
            TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, span } => {
                let image = scene.images.get(*image as usize)?;
                let filter = self.filter_of_texels(*filter, span);
                self.bitmap(&mut xml, &name, image, (filter, *wrap, *srgb, *to_uv));
            }
            TextureDesc::Checkerboard { color0, color1, to_uv, span } => {
                let is_plain = |input: &ColorInput| matches!(input, ColorInput::Constant(_));
                let plain = is_plain(color0) && is_plain(color1);
                if !plain && !self.own_plugins {
                    self.baked(&mut xml, &name, id, span, "checkerboard of textures");
                } else {
                    let (first, second) = (self.prepared(*color0), self.prepared(*color1));
                    xml.begin("texture", &[("type", "checkerboard"), ("id", &name)]);
                    first.write(&mut xml, "color0");
                    second.write(&mut xml, "color1");
                    xml.uv_transform(*to_uv);
                    xml.end();
                }
            }
            TextureDesc::Scale { input, factor, .. } if self.own_plugins => {
                let (input, factor) = (self.prepared(*input), self.prepared(*factor));
                xml.begin("texture", &[("type", "scale"), ("id", &name)]);
                input.write(&mut xml, "texture");
                factor.write(&mut xml, "scale");
                xml.end();
            }
            TextureDesc::Scale { span, .. } => self.product(&mut xml, &name, id, span),
            TextureDesc::Mix { color0, color1, weight, .. } if self.own_plugins => {
                let weight = match *weight {
                    ScalarInput::Constant(value) => ColorInput::Constant(Rgb::splat(value)),
                    ScalarInput::Texture(id) => ColorInput::Texture(id),
                };
                let parts = [*color0, *color1, weight].map(|part| self.prepared(part));
                xml.begin("texture", &[("type", "mix"), ("id", &name)]);
                for (part, name) in parts.iter().zip(["color0", "color1", "weight"]) {
                    part.write(&mut xml, name);
                }
                xml.end();
            }
            TextureDesc::Mix { span, .. } => self.baked(&mut xml, &name, id, span, "texture \"mix\""),
            TextureDesc::OtherUvs { input, span, .. } => {
                let message = "Mitsuba's meshes have one set of texture coordinates";
                self.notes.push("convert::texture-coordinates", span, message, "the first one is used");
                let ColorInput::Texture(input) = *input else { return None };
                return self.texture(input);
            }
            TextureDesc::MeshColor { of, scale, .. } => {
                xml.begin("texture", &[("type", "mesh_attribute"), ("id", &name)]);
                let attribute = match of {
                    MeshColorOf::Vertices => "vertex_color",
                    MeshColorOf::Faces => "face_color",
                };
                xml.string("name", attribute);
                xml.float("scale", *scale);
                xml.end();
            }
        }
        self.definitions.append(&xml);
        self.textures.insert(id, name.clone());
        Some(name)
    }

    /// A product of an image and a constant is another image; other products are looked up.
    fn product(&mut self, xml: &mut Xml, name: &str, id: TextureId, span: &Span) {
        let factored = self.baker.factored(ColorInput::Texture(id));
        let base = factored.texture.filter(|base| *base != id);
        let base = base.and_then(|base| self.scene.textures.get(base.0 as usize));
        match base {
            Some(TextureDesc::Bitmap { image, filter, wrap, srgb, to_uv, .. }) => {
                let Some(image) = self.scene.images.get(*image as usize) else { return };
                let scaled = self.baker.texels(image, *srgb, |color| color * factored.factor);
                let filter = self.filter_of_texels(*filter, span);
                self.bitmap(xml, name, &scaled, (filter, *wrap, true, *to_uv));
            }
            _ => self.baked(xml, name, id, span, "texture \"scale\""),
        }
    }

    /// What Mitsuba does between texels.
    fn filter_of_texels(&mut self, filter: Filter, span: &Span) -> Filter {
        let instead = "bilinear interpolation is written";
        match filter {
            Filter::Mipmap if !self.own("filter \"mipmap\"", span, instead) => Filter::Bilinear,
            filter => filter,
        }
    }

    fn baked(&mut self, xml: &mut Xml, name: &str, id: TextureId, span: &Span, what: &str) {
        let baked = self.baker.over_unit_square(id, |color| color);
        let message = format!("Mitsuba 3 has no {what}");
        let (width, height) = (baked.image.width, baked.image.height);
        let instead =
            format!("an image of {width} × {height} texels is written, repeated for each unit of u and v");
        self.notes.push("convert::texture-as-image", span, message, instead);
        self.bitmap(xml, name, &baked.image, (baked.filter, Wrap::Repeat, true, Affine2::IDENTITY));
    }

    fn bitmap(
        &mut self,
        xml: &mut Xml,
        name: &str,
        image: &Arc<Image>,
        (filter, wrap, srgb, to_uv): (Filter, Wrap, bool, Affine2),
    ) {
        let file = self.files.image(image);
        xml.begin("texture", &[("type", "bitmap"), ("id", name)]);
        xml.string("filename", &file);
        let filter = match filter {
            Filter::Nearest => "nearest",
            Filter::Bilinear => "bilinear",
            Filter::Mipmap => "mipmap",
        };
        let wrap = match wrap {
            Wrap::Repeat => "repeat",
            Wrap::Mirror => "mirror",
            Wrap::Clamp => "clamp",
        };
        xml.string("filter_type", filter);
        xml.string("wrap_mode", wrap);
        if !srgb {
            xml.boolean("raw", true);
        }
        xml.uv_transform(to_uv);
        xml.end();
    }

    /// A color whose texture is described already.
    pub(super) fn prepared(&mut self, input: ColorInput) -> Prepared {
        match input {
            ColorInput::Constant(color) => Prepared::Color(color),
            ColorInput::Texture(id) => match self.texture(id) {
                Some(id) => Prepared::Reference(id),
                None => Prepared::Color(Rgb::splat(0.5)),
            },
        }
    }
}

/// A color as it is written.
pub(super) enum Prepared {
    Color(Rgb),
    Reference(String),
}

impl Prepared {
    pub fn write(&self, xml: &mut Xml, name: &str) {
        match self {
            Self::Color(color) => xml.rgb(name, *color),
            Self::Reference(id) => xml.reference(Some(name), id),
        }
    }
}
