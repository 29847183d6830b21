//! Materials: all are metallic-roughness, with the extensions that they need.

use sr_bsdf::hair::{color_of_absorption, pigments};
use sr_scene::{
    ColorInput, HairAbsorption, MaterialDesc, MaterialId, MeshColorOf, MetallicRoughnessDesc, Rgb,
    ScalarInput, Span, TextureDesc, TextureId,
};

use super::Writer;
use super::json::Json;
use super::texture::Channels;
use crate::bake::luminance;
use crate::surfaces;

/// A material as far as glTF can say it.
struct Surface {
    desc: MetallicRoughnessDesc,
    opacities: Vec<ScalarInput>,
    normal: Option<ColorInput>,
    has_back: bool,
}

type Members = Vec<(&'static str, Json)>;

const NONE: ScalarInput = ScalarInput::Constant(0.0);
const WHOLE: ScalarInput = ScalarInput::Constant(1.0);
const WHITE: ColorInput = ColorInput::Constant(Rgb::ONE);

/// What is not said otherwise: a dielectric of no color's own.
const PLAIN: MetallicRoughnessDesc = MetallicRoughnessDesc {
    base_color: WHITE,
    metallic: NONE,
    roughness: WHOLE,
    specular: WHOLE,
    specular_color: WHITE,
    ior: 1.5,
    clearcoat: NONE,
    clearcoat_roughness: NONE,
    sheen_color: ColorInput::Constant(Rgb::ZERO),
    sheen_roughness: NONE,
    transmission: NONE,
    thin: true,
    diffuse_transmission: NONE,
    diffuse_transmission_color: WHITE,
    anisotropy: NONE,
    anisotropy_rotation: 0.0,
};

impl Writer<'_> {
    /// A material, and what a shape of it emits.
    pub(super) fn material(&mut self, id: MaterialId, emission: Option<ColorInput>, span: &Span) -> Json {
        let surface = self.surface(id);
        let span = &if self.scene.material_spans.len() > id.0 as usize {
            self.scene.material_span(id)
        } else {
            span.clone()
        };
        let desc = &surface.desc;
        let mut members: Members = Vec::new();
        let base = self.base(id, desc, &surface.opacities, span);
        members.push(("pbrMetallicRoughness", Json::Object(base)));
        if !surface.opacities.is_empty() {
            members.push(("alphaMode", Json::text("BLEND")));
        }
        if let Some(ColorInput::Texture(normal)) = surface.normal {
            members.push(("normalTexture", self.texture(normal, Channels::Linear, span)));
        }
        if surface.has_back || !surfaces::is(desc.transmission, 0.0) {
            members.push(("doubleSided", Json::Bool(true)));
        } else if desc.base_color != ColorInput::Constant(Rgb::ZERO) {
            let message = "materials that reflect on their front alone";
            let instead = "glTF's are not seen at all from behind, or reflect there as well";
            self.notes.push("convert::two-sided", span, message, instead);
        }
        let mut extensions: Members = Vec::new();
        self.emission(emission, &mut members, &mut extensions, span);
        self.layers(desc, &mut extensions, span);
        for (name, _) in &extensions {
            self.extensions.insert(name);
        }
        if !extensions.is_empty() {
            members.push(("extensions", Json::Object(extensions)));
        }
        Json::Object(members)
    }

    fn base(
        &mut self,
        id: MaterialId,
        desc: &MetallicRoughnessDesc,
        opacities: &[ScalarInput],
        span: &Span,
    ) -> Members {
        let mut members: Members = Vec::new();
        let color = self.baker.factored(desc.base_color);
        let opacity: f32 = opacities
            .iter()
            .map(|opacity| match opacity {
                ScalarInput::Constant(value) => value.clamp(0.0, 1.0),
                ScalarInput::Texture(_) => 1.0,
            })
            .product();
        let holes: Vec<TextureId> = opacities.iter().filter_map(|o| surfaces::texture_of(*o)).collect();
        if holes.len() > 1 {
            let message = "several textures of opacity on one surface";
            self.notes.push("convert::mask", span, message, "the first one is written");
        }
        let factor = color.factor.clamp(Rgb::ZERO, Rgb::ONE);
        if factor != Rgb::ONE || opacity != 1.0 {
            let [r, g, b] = factor.to_array();
            members.push(("baseColorFactor", Json::numbers(&[r, g, b, opacity])));
        }
        let of_mesh = color.texture.filter(|id| {
            let texture = self.scene.textures.get(id.0 as usize);
            matches!(texture, Some(TextureDesc::MeshColor { of: MeshColorOf::Vertices, scale: 1.0, .. }))
        });
        if of_mesh.is_some() {
            self.colored.insert(id);
        }
        let hole = holes.first().copied();
        let texture = match (color.texture.filter(|_| of_mesh.is_none()), hole) {
            (Some(color), hole) => Some((color, Channels::Color(hole))),
            (None, Some(hole)) => Some((hole, Channels::Opacity)),
            (None, None) => None,
        };
        if let Some((texture, channels)) = texture {
            members.push(("baseColorTexture", self.texture(texture, channels, span)));
        }
        let (metallic, metal_texture) = self.number(desc.metallic);
        let (roughness, rough_texture) = self.number(desc.roughness);
        members.push(("metallicFactor", Json::Number(metallic)));
        members.push(("roughnessFactor", Json::Number(roughness)));
        if let Some(first) = rough_texture.or(metal_texture) {
            let channels = Channels::GreenBlue(rough_texture, metal_texture);
            members.push(("metallicRoughnessTexture", self.texture(first, channels, span)));
        }
        members
    }

    fn emission(
        &mut self,
        emission: Option<ColorInput>,
        members: &mut Members,
        extensions: &mut Members,
        span: &Span,
    ) {
        let Some(emission) = emission else { return };
        let color = self.baker.factored(emission);
        // A strength above 1 says that it is a light, not a label.
        let strength = color.factor.max_element().max(2.0);
        members.push(("emissiveFactor", Json::numbers(&(color.factor / strength).to_array())));
        if let Some(texture) = color.texture {
            members.push(("emissiveTexture", self.texture(texture, Channels::Color(None), span)));
        }
        let strength = Json::Object(vec![("emissiveStrength", Json::Number(strength))]);
        extensions.push(("KHR_materials_emissive_strength", strength));
    }

    fn layers(&mut self, desc: &MetallicRoughnessDesc, extensions: &mut Members, span: &Span) {
        if desc.ior != 1.5 {
            let ior = Json::Object(vec![("ior", Json::Number(desc.ior))]);
            extensions.push(("KHR_materials_ior", ior));
        }
        if desc.specular != WHOLE || desc.specular_color != WHITE {
            let mut list: Members = Vec::new();
            self.scalar(&mut list, ("specularFactor", "specularTexture"), desc.specular, 3, span);
            self.color(&mut list, ("specularColorFactor", "specularColorTexture"), desc.specular_color, span);
            extensions.push(("KHR_materials_specular", Json::Object(list)));
        }
        if desc.transmission != NONE {
            let mut list: Members = Vec::new();
            self.scalar(&mut list, ("transmissionFactor", "transmissionTexture"), desc.transmission, 0, span);
            extensions.push(("KHR_materials_transmission", Json::Object(list)));
            if !desc.thin {
                let thickness = Json::Object(vec![("thicknessFactor", Json::Number(1.0))]);
                extensions.push(("KHR_materials_volume", thickness));
            }
        }
        if desc.clearcoat != NONE {
            let mut list: Members = Vec::new();
            self.scalar(&mut list, ("clearcoatFactor", "clearcoatTexture"), desc.clearcoat, 0, span);
            let names = ("clearcoatRoughnessFactor", "clearcoatRoughnessTexture");
            self.scalar(&mut list, names, desc.clearcoat_roughness, 1, span);
            extensions.push(("KHR_materials_clearcoat", Json::Object(list)));
        }
        if desc.sheen_color != ColorInput::Constant(Rgb::ZERO) {
            let mut list: Members = Vec::new();
            self.color(&mut list, ("sheenColorFactor", "sheenColorTexture"), desc.sheen_color, span);
            let names = ("sheenRoughnessFactor", "sheenRoughnessTexture");
            self.scalar(&mut list, names, desc.sheen_roughness, 3, span);
            extensions.push(("KHR_materials_sheen", Json::Object(list)));
        }
        if desc.diffuse_transmission != NONE {
            let mut list: Members = Vec::new();
            let names = ("diffuseTransmissionFactor", "diffuseTransmissionTexture");
            self.scalar(&mut list, names, desc.diffuse_transmission, 3, span);
            let names = ("diffuseTransmissionColorFactor", "diffuseTransmissionColorTexture");
            self.color(&mut list, names, desc.diffuse_transmission_color, span);
            extensions.push(("KHR_materials_diffuse_transmission", Json::Object(list)));
        }
        if desc.anisotropy != NONE {
            if matches!(desc.anisotropy, ScalarInput::Texture(_)) {
                let message = "an anisotropy that varies over a surface";
                self.notes.push("convert::approximated", span, message, "its mean is written");
            }
            let strength = self.baker.average_number(desc.anisotropy);
            let list = vec![
                ("anisotropyStrength", Json::Number(strength)),
                ("anisotropyRotation", Json::Number(desc.anisotropy_rotation)),
            ];
            extensions.push(("KHR_materials_anisotropy", Json::Object(list)));
        }
    }

    /// A factor, and a texture if there is one.
    fn number(&mut self, input: ScalarInput) -> (f32, Option<TextureId>) {
        match input {
            ScalarInput::Constant(value) => (value.clamp(0.0, 1.0), None),
            ScalarInput::Texture(id) => {
                let factored = self.baker.factored(ColorInput::Texture(id));
                (luminance(factored.factor).clamp(0.0, 1.0), factored.texture)
            }
        }
    }

    fn scalar(
        &mut self,
        list: &mut Members,
        (factor, texture): (&'static str, &'static str),
        input: ScalarInput,
        channel: usize,
        span: &Span,
    ) {
        let (value, id) = self.number(input);
        list.push((factor, Json::Number(value)));
        if let Some(id) = id {
            list.push((texture, self.texture(id, Channels::One(channel), span)));
        }
    }

    fn color(
        &mut self,
        list: &mut Members,
        (factor, texture): (&'static str, &'static str),
        input: ColorInput,
        span: &Span,
    ) {
        let color = self.baker.factored(input);
        list.push((factor, Json::numbers(&color.factor.to_array())));
        if let Some(id) = color.texture {
            list.push((texture, self.texture(id, Channels::Color(None), span)));
        }
    }

    /// What glTF can say of a material.
    fn surface(&mut self, id: MaterialId) -> Surface {
        let scene = self.scene;
        let span = scene.material_span(id);
        let Some(desc) = scene.materials.get(id.0 as usize) else { return Surface::of(PLAIN) };
        let mut approximated = |what: &str, instead: &str| {
            self.notes.push("convert::approximated", &span, format!("glTF has no {what}"), instead);
        };
        let plain = match desc {
            MaterialDesc::Diffuse { reflectance } => diffuse(*reflectance),
            MaterialDesc::Eon { reflectance, .. } | MaterialDesc::OrenNayar { reflectance, .. } => {
                approximated("rough diffuse material", "a diffuse one is written");
                diffuse(*reflectance)
            }
            MaterialDesc::DiffuseTransmission { reflectance, .. } => {
                approximated(
                    "diffuse transmission of two shares",
                    "diffuse reflection is written, nothing passes",
                );
                return Surface { has_back: true, ..Surface::of(diffuse(*reflectance)) };
            }
            MaterialDesc::Dielectric { eta, specular_reflectance, specular_transmittance } => {
                approximated("dielectric of its own", "a clear body without a base is written");
                let white = [*specular_reflectance, *specular_transmittance];
                return self.glass(*eta, 0.0, false, white, &span);
            }
            MaterialDesc::ThinDielectric { eta, specular_reflectance, specular_transmittance } => {
                approximated("pane that reflects between its sides", "a clear sheet is written");
                let white = [*specular_reflectance, *specular_transmittance];
                return self.glass(*eta, 0.0, true, white, &span);
            }
            MaterialDesc::RoughDielectric {
                alpha,
                eta,
                specular_reflectance,
                specular_transmittance,
                ..
            } => {
                approximated("rough dielectric of its own", "a clear body without a base is written");
                let roughness = self.roughness(*alpha, &span);
                let white = [*specular_reflectance, *specular_transmittance];
                return self.glass(*eta, roughness, false, white, &span);
            }
            MaterialDesc::Conductor { eta_k, specular_reflectance } => {
                approximated("metal of a complex index", "one of its color at a right angle is written");
                let color = self.metal(*eta_k, *specular_reflectance);
                MetallicRoughnessDesc { base_color: color, metallic: WHOLE, roughness: NONE, ..PLAIN }
            }
            MaterialDesc::RoughConductor { alpha, eta_k, specular_reflectance, .. } => {
                approximated("metal of a complex index", "one of its color at a right angle is written");
                let roughness = ScalarInput::Constant(self.roughness(*alpha, &span));
                let color = self.metal(*eta_k, *specular_reflectance);
                MetallicRoughnessDesc { base_color: color, metallic: WHOLE, roughness, ..PLAIN }
            }
            MaterialDesc::CoatedConductor { coat_alpha, alpha, eta_k, specular_reflectance, .. } => {
                approximated(
                    "metal of a complex index",
                    "one of its color at a right angle is written, with a coat",
                );
                let color = self.metal(*eta_k, *specular_reflectance);
                MetallicRoughnessDesc {
                    base_color: color,
                    metallic: WHOLE,
                    roughness: ScalarInput::Constant(alpha.sqrt().min(1.0)),
                    clearcoat: WHOLE,
                    clearcoat_roughness: ScalarInput::Constant(coat_alpha.sqrt().min(1.0)),
                    ..PLAIN
                }
            }
            MaterialDesc::Plastic { eta, diffuse_reflectance, nonlinear, .. } => {
                approximated("plastic", "a dielectric over a base of its color is written");
                MetallicRoughnessDesc {
                    base_color: below_coat(*diffuse_reflectance, *eta, *nonlinear),
                    roughness: NONE,
                    ior: eta.max(1.0),
                    ..PLAIN
                }
            }
            MaterialDesc::RoughPlastic { alpha, eta, diffuse_reflectance, nonlinear, .. } => {
                approximated("plastic", "a dielectric over a base of its color is written");
                MetallicRoughnessDesc {
                    base_color: below_coat(*diffuse_reflectance, *eta, *nonlinear),
                    roughness: ScalarInput::Constant(alpha.sqrt().min(1.0)),
                    ior: eta.max(1.0),
                    ..PLAIN
                }
            }
            MaterialDesc::Principled(p) => {
                approximated(
                    "material \"principled\"",
                    "what both have is written: base, metal, roughness, coat",
                );
                let gloss = self.baker.average_number(p.clearcoat_gloss);
                MetallicRoughnessDesc {
                    base_color: p.base_color,
                    metallic: p.metallic,
                    roughness: p.roughness,
                    ior: p.eta.max(1.0),
                    // Its coat has a quarter of the usual strength.
                    clearcoat: ScalarInput::Constant(0.25 * self.baker.average_number(p.clearcoat)),
                    clearcoat_roughness: ScalarInput::Constant((0.1 - 0.099 * gloss).max(0.0).sqrt()),
                    transmission: p.spec_trans,
                    thin: false,
                    anisotropy: p.anisotropic,
                    ..PLAIN
                }
            }
            MaterialDesc::PrincipledThin(p) => {
                approximated(
                    "material \"principledthin\"",
                    "what both have is written: base, roughness, transmission",
                );
                MetallicRoughnessDesc {
                    base_color: p.base_color,
                    roughness: p.roughness,
                    ior: self.baker.average_number(p.eta).max(1.0),
                    transmission: p.spec_trans,
                    anisotropy: p.anisotropic,
                    ..PLAIN
                }
            }
            MaterialDesc::MetallicRoughness(m) => *m,
            MaterialDesc::Hair(hair) => {
                approximated("hair", "a diffuse surface of about its color is written");
                let beta_n = self.baker.average_number(hair.beta_n);
                let of = |sigma_a: Rgb| ColorInput::Constant(color_of_absorption(sigma_a, beta_n));
                diffuse(match hair.absorption {
                    HairAbsorption::Color(color) => color,
                    HairAbsorption::Coefficient(sigma_a) => of(self.baker.average(sigma_a)),
                    HairAbsorption::Pigments { eumelanin, pheomelanin } => {
                        let amounts = [eumelanin, pheomelanin].map(|p| self.baker.average_number(p));
                        of(pigments(amounts[0], amounts[1]))
                    }
                })
            }
            MaterialDesc::TwoSided { front, back } => {
                if front != back {
                    approximated("material that differs between its sides", "that of the front is written");
                }
                return Surface { has_back: true, ..self.surface(*front) };
            }
            MaterialDesc::Mask { opacity, inner } => {
                let mut surface = self.surface(*inner);
                surface.opacities.push(*opacity);
                return surface;
            }
            MaterialDesc::Blend { weight, materials: [first, second] } => {
                approximated("mixture of materials", "that of the larger share is written");
                let share = self.baker.average_number(*weight);
                return self.surface(if share > 0.5 { *second } else { *first });
            }
            MaterialDesc::BumpMap { inner, .. } => {
                approximated("bump map", "it is left out, and the surface is smooth");
                return self.surface(*inner);
            }
            MaterialDesc::NormalMap { normal, inner, .. } => {
                let mut surface = self.surface(*inner);
                if surface.normal.is_some() {
                    let message = "normals that are tilted twice";
                    self.notes.push("convert::tilted-normals", &span, message, "the outer ones are written");
                }
                surface.normal = Some(*normal);
                return surface;
            }
        };
        Surface::of(plain)
    }

    fn glass(
        &mut self,
        eta: f32,
        roughness: f32,
        thin: bool,
        [reflected, transmitted]: [ColorInput; 2],
        span: &Span,
    ) -> Surface {
        if eta < 1.0 {
            let message = "an index of refraction below 1";
            self.notes.push("convert::approximated", span, message, "its inverse is written");
        }
        Surface::of(MetallicRoughnessDesc {
            base_color: transmitted,
            roughness: ScalarInput::Constant(roughness),
            specular_color: reflected,
            ior: eta.max(1.0 / eta),
            transmission: WHOLE,
            thin,
            ..PLAIN
        })
    }

    /// glTF's roughness, whose square is α.
    fn roughness(&mut self, alpha: [ScalarInput; 2], span: &Span) -> f32 {
        if alpha.into_iter().any(|alpha| surfaces::texture_of(alpha).is_some()) || alpha[0] != alpha[1] {
            let message = "a roughness α that varies, or is not that of glTF in both directions";
            self.notes.push("convert::approximated", span, message, "its mean is written");
        }
        let [u, v] = alpha.map(|alpha| self.baker.average_number(alpha).max(0.0));
        (u * v).sqrt().sqrt().min(1.0)
    }

    /// What a metal reflects at a right angle.
    fn metal(&self, eta_k: Option<(ColorInput, ColorInput)>, reflectance: ColorInput) -> ColorInput {
        let Some((eta, k)) = eta_k else { return reflectance };
        let normal = surfaces::normal_reflectance(self.baker.average(eta), self.baker.average(k));
        ColorInput::Constant(normal * self.baker.average(reflectance))
    }
}

impl Surface {
    fn of(desc: MetallicRoughnessDesc) -> Self {
        Self { desc, opacities: Vec::new(), normal: None, has_back: false }
    }
}

/// A dielectric without a reflection of its own is its diffuse base.
fn diffuse(reflectance: ColorInput) -> MetallicRoughnessDesc {
    MetallicRoughnessDesc { base_color: reflectance, specular: NONE, ..PLAIN }
}

/// What a base reflects, of light that the coat let in once, until it leaves: glTF's bases have no coat over them. The
/// colors of textures stay.
fn below_coat(albedo: ColorInput, eta: f32, nonlinear: bool) -> ColorInput {
    match albedo {
        ColorInput::Constant(albedo) if nonlinear => {
            let returned = sr_bsdf::interface::diffuse_reflectance(1.0 / eta);
            ColorInput::Constant(albedo * (1.0 - returned) / (1.0 - albedo * returned))
        }
        input => input,
    }
}
