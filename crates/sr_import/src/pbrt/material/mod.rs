//! Materials.

mod coat;
mod hair;
mod inputs;

use sr_scene::{
    ColorInput, MaterialDesc, MaterialId, MicrofacetKind, Rgb, ScalarInput, Span, TextureDesc, Tilting,
};

use super::Reader;
use super::color::Curve;
use super::params::{Notes, Params};
use super::support::{MATERIALS, unsupported};
use super::texture::FloatTexture;
use crate::images::Decode;
use crate::values::shown;

/// The default reflectance.
const GREY: Rgb = Rgb::splat(0.5);

/// A material before it is made two-sided and its normals are tilted.
enum Made {
    /// It reflects only, and does so on both sides.
    Opaque(MaterialDesc),
    /// Its two sides are what they are.
    Transmitting(MaterialDesc),
    /// It is there already.
    Same(MaterialId),
}

impl Reader<'_> {
    /// `Material "diffuse"` and parameters.
    pub(super) fn material_directive(&mut self, kind: &str, params: Params) {
        let id = self.material(kind, params);
        self.state.material = Some(id);
    }

    /// `MakeNamedMaterial "name" "string type" "diffuse"` and parameters.
    pub(super) fn make_named_material(&mut self, name: &str, mut params: Params) {
        let Some((_, kind)) = params.string("type") else {
            let message = format!("{} has no \"string type\"", params.title);
            self.warn("pbrt::missing-parameter", &params.span, message, "it is diffuse");
            let id = self.fallback(&params.span);
            self.materials.insert(name.to_owned(), id);
            return;
        };
        let span = params.span.clone();
        let id = self.material(&kind, params);
        if let Some((place, _)) = self.awaited.remove(name) {
            self.out.copy_material(id, place);
        }
        if self.materials.insert(name.to_owned(), id).is_some() {
            let message = format!("the material \"{}\" is described twice", shown(name));
            self.warn("pbrt::duplicate-name", &span, message, "what follows uses the second one");
        }
    }

    /// `NamedMaterial "name"`.
    pub(super) fn named_material(&mut self, name: &str, span: &Span) {
        self.state.material = Some(self.material_called(name, span));
    }

    /// It may be described later: until then its place is taken.
    fn material_called(&mut self, name: &str, span: &Span) -> MaterialId {
        if let Some(&id) = self.materials.get(name) {
            return id;
        }
        if let Some((id, _)) = self.awaited.get(name) {
            return *id;
        }
        let diffuse = MaterialDesc::Diffuse { reflectance: ColorInput::Constant(GREY) };
        let id = self.two_sided(diffuse, span);
        self.awaited.insert(name.to_owned(), (id, span.clone()));
        id
    }

    /// Says which materials were never described.
    pub(super) fn report_awaited(&mut self) {
        for (name, (_, span)) in std::mem::take(&mut self.awaited) {
            let message = format!("there is no material \"{}\"", shown(&name));
            let mut notes = Notes { list: self.out.d, said: &mut self.said };
            Self::unresolved(
                &mut notes,
                &span,
                message,
                &name,
                self.materials.keys(),
                "a diffuse one is used",
            );
        }
    }

    /// What shapes have that are given none: diffuse, of reflectance 0.5.
    pub(super) fn fallback(&mut self, span: &Span) -> MaterialId {
        if let Some(id) = self.default_material {
            return id;
        }
        let diffuse = MaterialDesc::Diffuse { reflectance: ColorInput::Constant(GREY) };
        let id = self.two_sided(diffuse, span);
        self.default_material = Some(id);
        id
    }

    fn two_sided(&mut self, desc: MaterialDesc, span: &Span) -> MaterialId {
        let side = self.out.add_material(desc, span);
        self.out.add_material(MaterialDesc::TwoSided { front: side, back: side }, span)
    }

    fn material(&mut self, kind: &str, mut params: Params) -> MaterialId {
        let span = params.span.clone();
        let id = match self.made(kind, &mut params) {
            Made::Same(id) => id,
            Made::Transmitting(desc) => {
                let id = self.out.add_material(desc, &span);
                self.tilted(id, &mut params)
            }
            Made::Opaque(desc) => {
                let side = self.out.add_material(desc, &span);
                let side = self.tilted(side, &mut params);
                self.out.add_material(MaterialDesc::TwoSided { front: side, back: side }, &span)
            }
        };
        params.finish(&mut self.notes());
        id
    }

    fn made(&mut self, kind: &str, params: &mut Params) -> Made {
        match kind {
            "diffuse" => {
                Made::Opaque(MaterialDesc::Diffuse { reflectance: self.albedo(params, "reflectance", GREY) })
            }
            "coateddiffuse" => Made::Opaque(self.coated_diffuse(params)),
            "coatedconductor" => Made::Opaque(self.coated_conductor(params)),
            "conductor" => Made::Opaque(self.conductor(params)),
            "dielectric" => Made::Transmitting(self.dielectric(params)),
            "thindielectric" => {
                let one = ColorInput::Constant(Rgb::ONE);
                Made::Transmitting(MaterialDesc::ThinDielectric {
                    eta: self.eta(params, "eta", 1.5),
                    specular_reflectance: one,
                    specular_transmittance: one,
                })
            }
            "diffusetransmission" => Made::Transmitting(self.diffuse_transmission(params)),
            "hair" => Made::Transmitting(self.hair(params)),
            "mix" => self.mix(params),
            "interface" | "none" | "" => {
                params.use_all();
                Made::Transmitting(self.nothing(&params.span))
            }
            _ => self.stand_in(kind, params),
        }
    }

    fn nothing(&mut self, span: &Span) -> MaterialDesc {
        let inner = self.fallback(span);
        MaterialDesc::Mask { opacity: ScalarInput::Constant(0.0), inner }
    }

    fn coated_diffuse(&mut self, params: &mut Params) -> MaterialDesc {
        let alpha = self.alpha(params, ["uroughness", "vroughness", "roughness"], 0.0);
        let eta = self.coat_eta(params, "eta");
        let layer = self.layer(params, eta);
        let alpha = self.constant_alpha(alpha, params);
        if alpha.is_some() {
            self.note_layers(params);
        }
        let diffuse_reflectance = self.base_albedo(params, layer, alpha);
        let specular_reflectance = ColorInput::Constant(Rgb::ONE);
        match alpha {
            None => MaterialDesc::Plastic { eta, diffuse_reflectance, specular_reflectance, nonlinear: true },
            Some(alpha) => MaterialDesc::RoughPlastic {
                kind: MicrofacetKind::GgxCorrelated,
                alpha,
                eta,
                diffuse_reflectance,
                specular_reflectance,
                nonlinear: true,
                // pbrt loses what bounces between facets.
                multiscatter: false,
            },
        }
    }

    fn coated_conductor(&mut self, params: &mut Params) -> MaterialDesc {
        /// Roughness of a metal that has none: what is reflected by it is as good as a mirror's.
        const SMOOTH: f32 = 1e-3;
        let coat = ["interface.uroughness", "interface.vroughness", "interface.roughness"];
        let coat = self.alpha(params, coat, 0.0);
        let metal = ["conductor.uroughness", "conductor.vroughness", "conductor.roughness"];
        let metal = self.alpha(params, metal, 0.0);
        let eta = self.coat_eta(params, "interface.eta");
        let layer = self.layer(params, eta);
        self.note_layers(params);
        let (eta_k, specular_reflectance) = self.complex_index(params, ["conductor.eta", "conductor.k"], eta);
        MaterialDesc::CoatedConductor {
            kind: MicrofacetKind::GgxCorrelated,
            coat_alpha: self.constant_alpha(coat, params).unwrap_or(0.0),
            eta,
            alpha: self.constant_alpha(metal, params).unwrap_or(SMOOTH),
            eta_k,
            specular_reflectance: self.scaled(specular_reflectance, layer.transmittance(), &params.span),
            bounces: Some(layer.meetings()),
        }
    }

    fn conductor(&mut self, params: &mut Params) -> MaterialDesc {
        let alpha = self.alpha(params, ["uroughness", "vroughness", "roughness"], 0.0);
        let (eta_k, specular_reflectance) = self.complex_index(params, ["eta", "k"], 1.0);
        match is_smooth(&alpha) {
            true => MaterialDesc::Conductor { eta_k, specular_reflectance },
            false => MaterialDesc::RoughConductor {
                kind: MicrofacetKind::GgxCorrelated,
                alpha,
                eta_k,
                specular_reflectance,
                multiscatter: false,
            },
        }
    }

    fn dielectric(&mut self, params: &mut Params) -> MaterialDesc {
        let alpha = self.alpha(params, ["uroughness", "vroughness", "roughness"], 0.0);
        let eta = self.eta(params, "eta", 1.5);
        let (specular_reflectance, specular_transmittance) =
            (ColorInput::Constant(Rgb::ONE), ColorInput::Constant(Rgb::ONE));
        match is_smooth(&alpha) {
            true => MaterialDesc::Dielectric { eta, specular_reflectance, specular_transmittance },
            false => MaterialDesc::RoughDielectric {
                kind: MicrofacetKind::GgxCorrelated,
                alpha,
                eta,
                specular_reflectance,
                specular_transmittance,
                multiscatter: false,
            },
        }
    }

    fn diffuse_transmission(&mut self, params: &mut Params) -> MaterialDesc {
        let scale = params.float("scale").unwrap_or(1.0);
        let quarter = Rgb::splat(0.25);
        let [reflectance, transmittance] = ["reflectance", "transmittance"].map(|name| {
            let input = self.albedo(params, name, quarter);
            self.scaled(input, scale, &params.span)
        });
        MaterialDesc::DiffuseTransmission { reflectance, transmittance }
    }

    fn scaled(&mut self, input: ColorInput, scale: f32, span: &Span) -> ColorInput {
        match input {
            ColorInput::Constant(color) => ColorInput::Constant(color * scale),
            input if scale == 1.0 => input,
            input => {
                let factor = ColorInput::Constant(Rgb::splat(scale));
                self.out.add_texture(TextureDesc::Scale { input, factor, span: span.clone() })
            }
        }
    }

    fn mix(&mut self, params: &mut Params) -> Made {
        let amount = self.float_or_texture(params, "amount").unwrap_or(FloatTexture::Constant(0.5));
        let weight = self.as_share(amount);
        let names = params.strings("materials");
        let [first, second] = &names[..] else {
            let message = format!("a mix is of two \"materials\", not of {}", names.len());
            self.warn("pbrt::missing-parameter", &params.span, message, "a diffuse one is used");
            return Made::Same(self.fallback(&params.span));
        };
        let span = params.span.clone();
        let materials = [self.material_called(first, &span), self.material_called(second, &span)];
        Made::Transmitting(MaterialDesc::Blend { weight, materials })
    }

    /// What is shown instead of a material that is not supported.
    fn stand_in(&mut self, kind: &str, params: &mut Params) -> Made {
        let desc = match kind {
            "subsurface" => MaterialDesc::Plastic {
                diffuse_reflectance: self.albedo(params, "reflectance", GREY),
                eta: self.eta(params, "eta", 1.33),
                specular_reflectance: ColorInput::Constant(Rgb::ONE),
                nonlinear: true,
            },
            _ => MaterialDesc::Diffuse { reflectance: self.albedo(params, "reflectance", GREY) },
        };
        params.use_all();
        let usual = "a diffuse one of reflectance 0.5 is shown instead";
        let code = "pbrt::unsupported-material";
        let note = unsupported(MATERIALS, code, &params.span, "a material", kind, usual);
        self.notes().push(note);
        Made::Opaque(desc)
    }

    /// With the normals that `normalmap` or `displacement` make.
    fn tilted(&mut self, inner: MaterialId, params: &mut Params) -> MaterialId {
        let span = params.span.clone();
        let tilting = Tilting { flip_invalid_normals: false, shadows: false, along_v: false };
        if let Some((span, file)) = params.string("normalmap").filter(|(_, file)| !file.is_empty()) {
            let image = self.out.image_file(&file, Decode::Raw, &span);
            let to_uv =
                glam::Affine2::from_scale_angle_translation(glam::Vec2::new(1.0, -1.0), 0.0, glam::Vec2::Y);
            let normal = self.out.add_texture(TextureDesc::Bitmap {
                image,
                filter: sr_scene::Filter::Bilinear,
                wrap: sr_scene::Wrap::Repeat,
                srgb: false,
                to_uv,
                span: span.clone(),
            });
            params.unsupported(&["displacement"], "the normal map is used", &mut self.notes());
            return self.out.add_material(MaterialDesc::NormalMap { normal, tilting, inner }, &span);
        }
        // A constant displacement tilts nothing.
        match self.float_or_texture(params, "displacement").map(|texture| self.as_scalar(texture)) {
            Some(ScalarInput::Texture(texture)) => {
                self.out.add_material(MaterialDesc::BumpMap { scale: 1.0, texture, tilting, inner }, &span)
            }
            Some(ScalarInput::Constant(_)) | None => inner,
        }
    }
}

/// pbrt takes such surfaces for mirrors.
fn is_smooth(alpha: &[ScalarInput; 2]) -> bool {
    alpha.iter().all(|a| matches!(a, ScalarInput::Constant(alpha) if *alpha < 1e-3))
}
