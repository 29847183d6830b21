//! Textures: bitmaps, checkerboards, what is made of others, and spectra that are written as objects.

use glam::{Affine2, DMat4, DVec3, Mat2, Vec2};
use sr_scene::{ColorInput, Diagnostic, Filter, MeshColorOf, Rgb, Span, TextureDesc, Wrap};

use super::color::Role;
use super::{Lowering, key};
use crate::images::Decode;
use crate::mitsuba::node::{Node, Property, SpectrumValue, Value};
use crate::mitsuba::props::{Props, finite_color};
use crate::values;

/// What is shown instead of a texture that is not supported.
const STAND_IN: Rgb = Rgb::splat(0.5);

impl<'a> Lowering<'a, '_> {
    /// A texture or spectrum object. An object is lowered once for each role it is used in first.
    pub(super) fn texture(&mut self, node: &'a Node, role: Role) -> ColorInput {
        if let Some(&done) = self.textures_done.get(&key(node)) {
            return done;
        }
        if !self.open.insert(key(node)) {
            let message = format!("{} contains itself", node.title());
            self.out.d.push(Diagnostic::error("mitsuba::cycle", &node.span, message));
            return ColorInput::Constant(STAND_IN);
        }
        let mut props = Props::new(node);
        let input = if matches!(node.class.as_str(), "texture" | "spectrum") {
            self.texture_kind(node, &mut props, role)
        } else {
            let message = format!("a texture was expected, not {}", node.title());
            self.out.d.push(Diagnostic::error("mitsuba::wrong-type", &node.span, message));
            ColorInput::Constant(STAND_IN)
        };
        props.finish(self.out.d);
        self.open.remove(&key(node));
        self.textures_done.insert(key(node), input);
        input
    }

    fn texture_kind(&mut self, node: &'a Node, props: &mut Props<'a>, role: Role) -> ColorInput {
        match node.kind.as_str() {
            "bitmap" => self.bitmap(node, props),
            "checkerboard" => {
                props.unsupported(&["line_width"], "there are no lines", self.out.d);
                let color0 = self.color(props, "color0", Rgb::splat(0.4), role);
                let color1 = self.color(props, "color1", Rgb::splat(0.2), role);
                let to_uv = self.uv_transform(props);
                self.out.add_texture(TextureDesc::Checkerboard {
                    color0,
                    color1,
                    to_uv,
                    span: node.span.clone(),
                })
            }
            "scale" => {
                // First: what is left is scaled.
                let factor = self.color(props, "scale", Rgb::ONE, Role::Factor);
                let input = match self.nested(props, "texture")[..] {
                    [] if props.has("texture") => self.color(props, "texture", Rgb::ONE, role),
                    [input] => self.texture(input, role),
                    ref others => {
                        let message =
                            format!("{} needs one texture inside it, not {}", node.title(), others.len());
                        self.out.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
                        ColorInput::Constant(STAND_IN)
                    }
                };
                self.out.add_texture(TextureDesc::Scale { input, factor, span: node.span.clone() })
            }
            "mix" => {
                let color0 = self.color(props, "color0", Rgb::ZERO, role);
                let color1 = self.color(props, "color1", Rgb::ONE, role);
                let weight = self.scalar(props, "weight", 0.5);
                self.out.add_texture(TextureDesc::Mix { color0, color1, weight, span: node.span.clone() })
            }
            "mesh_attribute" => self.mesh_attribute(node, props),
            "uniform" | "constant" => self.color(props, "value", Rgb::ONE, role),
            "rawconstant" => match props.get("value") {
                Some(Property { value: Value::Vector(v), span, .. }) => {
                    let color = finite_color(*v, "value", span, self.out.d);
                    ColorInput::Constant(color.unwrap_or(STAND_IN))
                }
                _ => self.color(props, "value", Rgb::ONE, role),
            },
            "rgb" | "srgb" => {
                let name = if props.has("color") { "color" } else { "value" };
                self.color(props, name, STAND_IN, role)
            }
            "d65" => {
                let scale = self.color(props, "value", Rgb::ONE, Role::Factor);
                let factor = props.float("scale", self.out.d).unwrap_or(1.0);
                match scale {
                    ColorInput::Constant(c) => ColorInput::Constant(c * factor),
                    textured => textured,
                }
            }
            "blackbody" => {
                let temperature = props.float("temperature", self.out.d).unwrap_or(5000.0).into();
                let scale = props
                    .float("value", self.out.d)
                    .or(props.float("scale", self.out.d))
                    .unwrap_or(1.0)
                    .into();
                self.spectrum_object(&SpectrumValue::Blackbody { temperature, scale }, role, node)
            }
            "regular" | "irregular" => match self.sampled(node, props) {
                Ok(samples) => self.spectrum_object(&SpectrumValue::Samples(samples), role, node),
                Err(reason) => {
                    let message = format!("{}: {reason}", node.title());
                    self.out.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                    ColorInput::Constant(STAND_IN)
                }
            },
            _ => {
                self.unknown_plugin(node, "the constant 0.5 is used instead, and nothing in it is read");
                props.use_all();
                ColorInput::Constant(STAND_IN)
            }
        }
    }

    fn spectrum_object(&mut self, value: &SpectrumValue, role: Role, node: &Node) -> ColorInput {
        let color = self.spectrum(value, role, &node.span);
        let color = color.and_then(|c| finite_color(c, &node.kind, &node.span, self.out.d));
        ColorInput::Constant(color.unwrap_or(STAND_IN))
    }

    /// `regular` (values between two wavelengths) and `irregular` (both lists).
    fn sampled(&mut self, node: &'a Node, props: &mut Props<'a>) -> Result<Vec<(f64, f64)>, String> {
        let list = |props: &mut Props<'a>, name: &'static str, d: &mut _| match props.string(name, d) {
            Some((text, _)) => values::numbers(text),
            None => Err(format!("\"{name}\" is missing")),
        };
        let heights = list(props, "values", self.out.d)?;
        let wavelengths = if node.kind == "irregular" {
            list(props, "wavelengths", self.out.d)?
        } else {
            let min = f64::from(props.float("wavelength_min", self.out.d).unwrap_or(360.0));
            let max = f64::from(props.float("wavelength_max", self.out.d).unwrap_or(830.0));
            let steps = heights.len().saturating_sub(1).max(1) as f64;
            (0..heights.len()).map(|i| min + (max - min) * i as f64 / steps).collect()
        };
        if wavelengths.len() != heights.len() {
            return Err(format!("{} wavelengths for {} values", wavelengths.len(), heights.len()));
        }
        values::increasing(wavelengths.into_iter().zip(heights).collect())
    }

    fn bitmap(&mut self, node: &'a Node, props: &mut Props<'a>) -> ColorInput {
        let filter = match props.string("filter_type", self.out.d) {
            None | Some(("bilinear", _)) => Filter::Bilinear,
            Some(("nearest", _)) => Filter::Nearest,
            Some(("mipmap", _)) => Filter::Mipmap,
            Some((other, span)) => {
                self.unknown_word("filter type", other, &["bilinear", "nearest", "mipmap"], "bilinear", span);
                Filter::Bilinear
            }
        };
        let wrap = match props.string("wrap_mode", self.out.d) {
            None | Some(("repeat", _)) => Wrap::Repeat,
            Some(("mirror", _)) => Wrap::Mirror,
            Some(("clamp", _)) => Wrap::Clamp,
            Some((other, span)) => {
                self.unknown_word("wrap mode", other, &["repeat", "mirror", "clamp"], "repeat", span);
                Wrap::Repeat
            }
        };
        props.unsupported(&["wrap_mode_u", "wrap_mode_v"], "the image is repeated", self.out.d);
        props.unsupported(&["channel"], "all channels are used", self.out.d);
        props.ignore(&["accel", "format", "cache", "max_anisotropy"]);
        let mut raw = props.boolean("raw", self.out.d).unwrap_or(false);
        if let Some(gamma) = props.float("gamma", self.out.d) {
            raw |= gamma == 1.0;
            if gamma != 1.0 && (gamma - 2.2).abs() > 0.01 && gamma != -1.0 {
                self.out.d.push(
                    Diagnostic::warning(
                        "mitsuba::gamma",
                        &node.span,
                        format!("a gamma of {gamma} is not supported"),
                    )
                    .consequence("8-bit values are read as sRGB"),
                );
            }
        }
        let to_uv = self.uv_transform(props);
        let decode = if raw { Decode::Raw } else { Decode::Color };
        let Some(image) = self.image_of(props, decode) else { return ColorInput::Constant(STAND_IN) };
        self.out.add_texture(TextureDesc::Bitmap {
            image,
            filter,
            wrap,
            srgb: !raw,
            to_uv,
            span: node.span.clone(),
        })
    }

    fn mesh_attribute(&mut self, node: &'a Node, props: &mut Props<'a>) -> ColorInput {
        let scale = props.float("scale", self.out.d).unwrap_or(1.0);
        let of = match props.string("name", self.out.d) {
            Some(("vertex_color", _)) => MeshColorOf::Vertices,
            Some(("face_color", _)) => MeshColorOf::Faces,
            Some((other, span)) => {
                let message = format!("the mesh attribute \"{}\" is not read", values::shown(other));
                self.out.d.push(
                    Diagnostic::warning("mitsuba::unknown-value", span, message)
                        .guess(other, ["vertex_color", "face_color"])
                        .consequence("the constant 0.5 is used"),
                );
                return ColorInput::Constant(STAND_IN);
            }
            None => {
                let message = format!("{} needs a \"name\"", node.title());
                self.out.d.push(Diagnostic::error("mitsuba::missing-property", &node.span, message));
                return ColorInput::Constant(STAND_IN);
            }
        };
        self.out.add_texture(TextureDesc::MeshColor { of, scale, span: node.span.clone() })
    }

    /// The image that a node names by `filename`, or holds as `bitmap` or `data`.
    pub(super) fn image_of(&mut self, props: &mut Props<'a>, decode: Decode) -> Option<u32> {
        for name in ["bitmap", "data"] {
            if let Some(property) = props.get(name) {
                return match &property.value {
                    Value::Image(image) => Some(self.out.image_in_memory(image)),
                    _ => props.wrong_type(property, "an image", self.out.d),
                };
            }
        }
        match props.string("filename", self.out.d) {
            Some((name, span)) => Some(self.out.image_file(name, decode, span)),
            None => {
                let message = format!("{} needs a \"filename\"", props.node.title());
                self.out.d.push(Diagnostic::error("mitsuba::missing-property", &props.node.span, message));
                None
            }
        }
    }

    /// `to_uv`, or the `uscale`, `vscale`, `uoffset`, `voffset` of old.
    fn uv_transform(&mut self, props: &mut Props<'a>) -> Affine2 {
        let mut old = |name| props.float(name, self.out.d);
        let scale = [old("uscale"), old("vscale")];
        let offset = [old("uoffset"), old("voffset")];
        let m = props.transform("to_uv", self.out.d);
        if scale.iter().chain(&offset).any(Option::is_some) {
            let offset = Vec2::from(offset.map(|v| v.unwrap_or(0.0)));
            return Affine2::from_scale_angle_translation(
                Vec2::from(scale.map(|v| v.unwrap_or(1.0))),
                0.0,
                offset,
            );
        }
        affine2(m)
    }

    /// A word of a fixed vocabulary that is not in it.
    pub(super) fn unknown_word(&mut self, what: &str, word: &str, known: &[&str], used: &str, span: &Span) {
        let message = format!("\"{}\" is not a {what} that is supported", values::shown(word));
        self.out.d.push(
            Diagnostic::warning("mitsuba::unknown-value", span, message)
                .guess(word, known.iter().copied())
                .consequence(format!("\"{used}\" is used")),
        );
    }
}

fn affine2(m: DMat4) -> Affine2 {
    let column = |c: DVec3| Vec2::new(c.x as f32, c.y as f32);
    Affine2::from_mat2_translation(
        Mat2::from_cols(column(m.x_axis.truncate()), column(m.y_axis.truncate())),
        column(m.w_axis.truncate()),
    )
}
