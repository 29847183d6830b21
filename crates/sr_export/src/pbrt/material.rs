//! Materials. pbrt's reflect on both sides; holes belong to shapes, tilted normals to the models themselves.

use sr_bsdf::interface::diffuse_reflectance as diffuse_reflectance_of;
use sr_bsdf::{RoughCoat, rough_internal_reflectance};
use sr_scene::{
    ColorInput, HairAbsorption, MaterialDesc, MaterialId, MicrofacetKind, Rgb, ScalarInput, Span, TextureId,
};

use super::Writer;
use super::text::Params;
use super::texture::{Coats, Use};
use crate::surfaces;

/// A material, and how its normals are tilted.
pub(super) type Key = (MaterialId, Option<Tilt>);

/// Which tilted normals a model has: those of a bump map or a normal map in the description.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Tilt(MaterialId);

/// The base of models with many parameters, as far as pbrt can say it.
struct Base {
    color: ColorInput,
    metallic: ScalarInput,
    /// Its square is α.
    roughness: ScalarInput,
    eta: f32,
    transmission: ScalarInput,
    is_thin: bool,
}

impl Writer<'_> {
    /// The name of a material, and the holes that shapes of it have.
    pub(super) fn surface(&mut self, id: MaterialId) -> (String, Params) {
        let (mut id, mut opacities) = (id, Vec::new());
        let scene = self.scene;
        loop {
            match scene.materials.get(id.0 as usize) {
                Some(MaterialDesc::Mask { opacity, inner }) => {
                    opacities.push(*opacity);
                    id = *inner;
                }
                Some(MaterialDesc::TwoSided { front, back })
                    if front == back
                        && matches!(
                            scene.materials.get(front.0 as usize),
                            Some(MaterialDesc::Mask { .. })
                        ) =>
                {
                    id = *front;
                }
                _ => break,
            }
        }
        self.one_sided(id);
        let alpha = self.alpha_of(&opacities);
        (self.material(id, None), alpha)
    }

    /// The product of opacities as a parameter of a shape.
    fn alpha_of(&mut self, opacities: &[ScalarInput]) -> Params {
        let constant: f32 = opacities
            .iter()
            .filter_map(|o| if let ScalarInput::Constant(v) = o { Some(v.clamp(0.0, 1.0)) } else { None })
            .product();
        let textures: Vec<TextureId> = opacities.iter().filter_map(|o| surfaces::texture_of(*o)).collect();
        let mut product: Option<String> = None;
        for id in textures {
            let texture = self.texture(id, Use::Number);
            product = Some(match product {
                None => texture,
                Some(so_far) => {
                    let name = format!("{so_far}-times-{texture}");
                    let params = Params::default().texture("tex", &so_far).texture("scale", &texture);
                    self.definitions.texture(&name, "float", "scale", &params);
                    name
                }
            });
        }
        match product {
            None if constant == 1.0 => Params::default(),
            None => Params::default().float("alpha", constant),
            Some(name) if constant == 1.0 => Params::default().texture("alpha", &name),
            Some(name) => {
                let scaled = format!("{name}-times-{constant}");
                let params = Params::default().texture("tex", &name).float("scale", constant);
                self.definitions.texture(&scaled, "float", "scale", &params);
                Params::default().texture("alpha", &scaled)
            }
        }
    }

    /// Says that a model which reflects on its front alone does so on both sides in pbrt.
    fn one_sided(&mut self, id: MaterialId) {
        let scene = self.scene;
        let is_black = |desc: &MaterialDesc| {
            matches!(desc, MaterialDesc::Diffuse { reflectance: ColorInput::Constant(Rgb::ZERO) })
        };
        let Some(desc) = scene.materials.get(id.0 as usize) else { return };
        let has_sides =
            matches!(desc, MaterialDesc::TwoSided { .. }) || surfaces::transmits(scene, id) || is_black(desc);
        if !has_sides {
            let message = "materials that reflect on their front alone";
            let instead = "in pbrt they reflect on both sides";
            self.notes.push("convert::two-sided", &scene.material_span(id), message, instead);
        }
    }

    fn material(&mut self, id: MaterialId, tilt: Option<Tilt>) -> String {
        if let Some(name) = self.materials.get(&(id, tilt)) {
            return name.clone();
        }
        let mut name = format!("material{}", id.0);
        if let Some(Tilt(by)) = tilt {
            name.push_str(&format!("-tilted{}", by.0));
        }
        let span = self.scene.material_span(id);
        let name = match self.scene.materials.get(id.0 as usize) {
            Some(desc) => self.describe_material(name, desc, tilt, &span),
            None => name,
        };
        self.materials.insert((id, tilt), name.clone());
        name
    }

    /// Describes a material; the name that it goes by.
    fn describe_material(
        &mut self,
        name: String,
        desc: &MaterialDesc,
        tilt: Option<Tilt>,
        span: &Span,
    ) -> String {
        match desc {
            MaterialDesc::Diffuse { reflectance } => self.diffuse(&name, *reflectance, tilt),
            MaterialDesc::Eon { reflectance, .. } | MaterialDesc::OrenNayar { reflectance, .. } => {
                let message = "pbrt has no rough diffuse material";
                self.notes.push("convert::approximated", span, message, "a diffuse one is written");
                self.diffuse(&name, *reflectance, tilt);
            }
            MaterialDesc::Dielectric { eta, specular_reflectance, specular_transmittance } => {
                self.white([*specular_reflectance, *specular_transmittance], span);
                self.named(&name, "dielectric", Params::default().float("eta", *eta), tilt);
            }
            MaterialDesc::ThinDielectric { eta, specular_reflectance, specular_transmittance } => {
                self.white([*specular_reflectance, *specular_transmittance], span);
                self.named(&name, "thindielectric", Params::default().float("eta", *eta), tilt);
            }
            MaterialDesc::RoughDielectric {
                kind,
                alpha,
                eta,
                specular_reflectance,
                specular_transmittance,
                multiscatter,
            } => {
                self.white([*specular_reflectance, *specular_transmittance], span);
                self.facets(*kind, *multiscatter, span);
                let params = self.roughness(Params::default().float("eta", *eta), "", *alpha, Use::Number);
                self.named(&name, "dielectric", params, tilt);
            }
            MaterialDesc::Conductor { eta_k, specular_reflectance } => {
                let params = self.metal(Params::default(), "", *eta_k, *specular_reflectance, (1.0, span));
                self.named(&name, "conductor", params, tilt);
            }
            MaterialDesc::RoughConductor { kind, alpha, eta_k, specular_reflectance, multiscatter } => {
                self.facets(*kind, *multiscatter, span);
                let params = self.metal(Params::default(), "", *eta_k, *specular_reflectance, (1.0, span));
                let params = self.roughness(params, "", *alpha, Use::Number);
                self.named(&name, "conductor", params, tilt);
            }
            MaterialDesc::Plastic { eta, diffuse_reflectance, specular_reflectance, nonlinear } => {
                self.white([*specular_reflectance], span);
                let returned = diffuse_reflectance_of(1.0 / eta);
                let coats = Coats::new(returned, returned, *nonlinear);
                let params = self.coated(*eta, *diffuse_reflectance, coats);
                self.named(&name, "coateddiffuse", params.float("roughness", 0.0), tilt);
            }
            MaterialDesc::RoughPlastic {
                kind,
                alpha,
                eta,
                diffuse_reflectance,
                specular_reflectance,
                nonlinear,
                multiscatter,
            } => {
                self.white([*specular_reflectance], span);
                self.facets(*kind, *multiscatter, span);
                let ours = match multiscatter {
                    true => RoughCoat::lossless(model(*kind), *alpha, *eta),
                    false => RoughCoat::new(model(*kind), *alpha, *eta),
                };
                let pbrts =
                    rough_internal_reflectance(sr_bsdf::MicrofacetKind::GgxCorrelated, *alpha, *eta, 0.0);
                let coats = Coats::new(ours.internal_reflectance(), pbrts, *nonlinear);
                let params = self.coated(*eta, *diffuse_reflectance, coats);
                let alpha = [ScalarInput::Constant(*alpha); 2];
                let params = self.roughness(params, "", alpha, Use::Number);
                self.named(&name, "coateddiffuse", params, tilt);
            }
            MaterialDesc::DiffuseTransmission { reflectance, transmittance } => {
                let params = self.color(Params::default(), "reflectance", *reflectance, Use::Color);
                let params = self.color(params, "transmittance", *transmittance, Use::Color);
                self.named(&name, "diffusetransmission", params, tilt);
            }
            MaterialDesc::CoatedConductor {
                kind,
                coat_alpha,
                eta,
                alpha,
                eta_k,
                specular_reflectance,
                bounces,
            } => {
                self.facets(*kind, bounces.is_none(), span);
                let params = Params::default().float("interface.eta", *eta).float("thickness", 0.0);
                let params = params.integer("maxdepth", bounces.map_or(1000, |n| 2 * i64::from(n)));
                let params = self.metal(params, "conductor.", *eta_k, *specular_reflectance, (*eta, span));
                let same = |alpha: f32| [ScalarInput::Constant(alpha); 2];
                let params = self.roughness(params, "interface.", same(*coat_alpha), Use::Number);
                let params = self.roughness(params, "conductor.", same(*alpha), Use::Number);
                self.named(&name, "coatedconductor", params, tilt);
            }
            MaterialDesc::Principled(p) => {
                let base = Base {
                    color: p.base_color,
                    metallic: p.metallic,
                    roughness: p.roughness,
                    eta: p.eta,
                    transmission: p.spec_trans,
                    is_thin: false,
                };
                return self.many(name, base, tilt, ("principled", span));
            }
            MaterialDesc::PrincipledThin(p) => {
                let base = Base {
                    color: p.base_color,
                    metallic: ScalarInput::Constant(0.0),
                    roughness: p.roughness,
                    eta: self.baker.average_number(p.eta),
                    transmission: p.spec_trans,
                    is_thin: true,
                };
                return self.many(name, base, tilt, ("principledthin", span));
            }
            MaterialDesc::MetallicRoughness(m) => {
                let base = Base {
                    color: m.base_color,
                    metallic: m.metallic,
                    roughness: m.roughness,
                    eta: m.ior,
                    transmission: m.transmission,
                    is_thin: m.thin,
                };
                return self.many(name, base, tilt, ("metallicroughness", span));
            }
            MaterialDesc::Hair(hair) => {
                if surfaces::turns(self.scene, hair, true) {
                    let message = "fibres of hair run along u in pbrt, where there are no curves";
                    self.notes.push(
                        "convert::hair",
                        span,
                        message,
                        "on what is no curve they are turned by a right angle",
                    );
                }
                let params = Params::default().float("eta", hair.eta).float("alpha", hair.alpha.to_degrees());
                let params = match hair.absorption {
                    HairAbsorption::Coefficient(sigma_a) => {
                        self.color(params, "sigma_a", sigma_a, Use::Color)
                    }
                    HairAbsorption::Color(color) => self.color(params, "reflectance", color, Use::Color),
                    HairAbsorption::Pigments { eumelanin, pheomelanin } => {
                        let params = self.number(params, "eumelanin", eumelanin, Use::Number);
                        self.number(params, "pheomelanin", pheomelanin, Use::Number)
                    }
                };
                let params = self.number(params, "beta_m", hair.beta_m, Use::Number);
                let params = self.number(params, "beta_n", hair.beta_n, Use::Number);
                self.named(&name, "hair", params, tilt);
            }
            MaterialDesc::TwoSided { front, back } => {
                if front != back {
                    let message = "pbrt's materials are the same on both sides";
                    self.notes.push("convert::two-sided", span, message, "that of the front is written");
                }
                return self.material(*front, tilt);
            }
            MaterialDesc::Mask { opacity, inner } => {
                let message = "in pbrt holes belong to shapes, not to parts of a material";
                let instead = "a mixture with nothing is written, which casts whole shadows";
                self.notes.push("convert::mask", span, message, instead);
                let inner = self.material(*inner, tilt);
                let nothing = format!("{name}-nothing");
                self.named(&nothing, "interface", Params::default(), None);
                self.mixture(&name, *opacity, [&nothing, &inner]);
            }
            MaterialDesc::Blend { weight, materials } => {
                let [first, second] = materials.map(|part| self.material(part, tilt));
                self.mixture(&name, *weight, [&first, &second]);
            }
            MaterialDesc::BumpMap { tilting, inner, .. } | MaterialDesc::NormalMap { tilting, inner, .. } => {
                if tilting.flip_invalid_normals || tilting.shadows {
                    let message = "pbrt's tilted normals cast no shadows";
                    let instead = "surfaces of bump maps and normal maps are a little brighter";
                    self.notes.push("convert::tilted-normals", span, message, instead);
                }
                if tilting.along_v {
                    let message = "pbrt's normal maps do not follow mirrored texture coordinates";
                    let instead = "where these are mirrored, normals tilt the other way across the tangent";
                    self.notes.push("convert::tilted-normals", span, message, instead);
                }
                if tilt.is_some() {
                    let message = "normals that are tilted twice";
                    self.notes.push("convert::tilted-normals", span, message, "the inner ones are written");
                }
                let by = self.scene.materials.iter().position(|known| std::ptr::eq(known, desc));
                return self.material(*inner, by.map(|index| Tilt(MaterialId(index as u32))));
            }
        }
        name
    }

    fn diffuse(&mut self, name: &str, reflectance: ColorInput, tilt: Option<Tilt>) {
        let params = self.color(Params::default(), "reflectance", reflectance, Use::Color);
        self.named(name, "diffuse", params, tilt);
    }

    /// Describes a material of pbrt's.
    fn named(&mut self, name: &str, kind: &str, params: Params, tilt: Option<Tilt>) {
        let mut all = Params::default().string("type", kind);
        if let Some(Tilt(by)) = tilt {
            all = self.tilted(all, by);
        }
        all.extend(&params);
        self.definitions.directive("MakeNamedMaterial", name, &all);
    }

    fn tilted(&mut self, params: Params, by: MaterialId) -> Params {
        let scene = self.scene;
        let span = scene.material_span(by);
        match scene.materials.get(by.0 as usize) {
            Some(MaterialDesc::BumpMap { scale, texture, .. }) => {
                let mut name = self.texture(*texture, Use::Number);
                if *scale != 1.0 {
                    let scaled = format!("{name}-bump{}", by.0);
                    let values = Params::default().texture("tex", &name).float("scale", *scale);
                    if self.bumps.insert(scaled.clone()) {
                        self.definitions.texture(&scaled, "float", "scale", &values);
                    }
                    name = scaled;
                }
                params.texture("displacement", &name)
            }
            Some(MaterialDesc::NormalMap { normal: ColorInput::Texture(id), .. }) => {
                let (image, _) = self.plain_image(*id, &span, false);
                params.string("normalmap", &self.files.image(&image))
            }
            _ => params,
        }
    }

    fn mixture(&mut self, name: &str, amount: ScalarInput, parts: [&str; 2]) {
        let params = Params::default().strings("materials", &parts);
        let params = self.number(params, "amount", amount, Use::Number);
        self.named(name, "mix", params, None);
    }

    /// A diffuse base under a clear coat in which light bounces until it leaves.
    fn coated(&mut self, eta: f32, reflectance: ColorInput, coats: Coats) -> Params {
        let params = Params::default().float("eta", eta).float("thickness", 0.0).integer("maxdepth", 1000);
        let is_texture = matches!(reflectance, ColorInput::Texture(_));
        let wanted = if is_texture && coats.are_the_same() { Use::Color } else { Use::Base(coats) };
        self.color(params, "reflectance", reflectance, wanted)
    }

    /// Along the tangent and the bitangent; `wanted` tells what of the numbers is α.
    fn roughness(&mut self, params: Params, prefix: &str, [u, v]: [ScalarInput; 2], wanted: Use) -> Params {
        let params = params.remapped(false);
        if u == v {
            return self.number(params, &format!("{prefix}roughness"), u, wanted);
        }
        let params = self.number(params, &format!("{prefix}uroughness"), u, wanted);
        self.number(params, &format!("{prefix}vroughness"), v, wanted)
    }

    fn metal(
        &mut self,
        params: Params,
        prefix: &str,
        eta_k: Option<(ColorInput, ColorInput)>,
        reflectance: ColorInput,
        (above, span): (f32, &Span),
    ) -> Params {
        let Some((eta, k)) = eta_k else {
            if !surfaces::is_white(reflectance) {
                let message = "a metal of the same reflectance at all angles";
                self.notes.push("convert::metal", span, message, "pbrt's is brighter at grazing angles");
            }
            return self.color(params, "reflectance", reflectance, Use::Color);
        };
        if !surfaces::is_white(reflectance) {
            let message = "a metal whose reflection is colored besides";
            let instead = "one that reflects the same at a right angle is written";
            self.notes.push("convert::metal", span, message, instead);
            let [eta, k, factor] = [eta, k, reflectance].map(|input| self.baker.average(input));
            return params.rgb("reflectance", surfaces::normal_reflectance(eta, k) * factor);
        }
        let names = ["eta", "k"].map(|name| format!("{prefix}{name}"));
        if let (ColorInput::Constant(eta), ColorInput::Constant(k)) = (eta, k) {
            let is_grey = |color: Rgb| color.min_element() == color.max_element();
            if is_grey(eta) && is_grey(k) {
                return params.rgb(&names[0], eta).rgb(&names[1], k);
            }
            // pbrt would make other spectra of the colors, and another color of what they reflect.
            let (eta, k) = sr_spectra::metal_spectra(eta.as_dvec3(), k.as_dvec3(), above.into());
            return params.spectrum(&names[0], &eta).spectrum(&names[1], &k);
        }
        let params = self.color(params, &names[0], eta, Use::Color);
        self.color(params, &names[1], k, Use::Color)
    }

    /// Says that colors of reflections are not written.
    fn white<const N: usize>(&mut self, factors: [ColorInput; N], span: &Span) {
        if factors.into_iter().any(|factor| !surfaces::is_white(factor)) {
            let message = "pbrt does not color specular reflection and transmission";
            self.notes.push("convert::specular-color", span, message, "they are written without a color");
        }
    }

    fn facets(&mut self, kind: MicrofacetKind, multiscatter: bool, span: &Span) {
        if kind == MicrofacetKind::Beckmann {
            let message = "pbrt has no Beckmann distribution of facets";
            self.notes.push("convert::microfacets", span, message, "GGX of the same roughness is written");
        }
        if kind == MicrofacetKind::Ggx {
            let message = "in pbrt facets that are masked are often those in shadow";
            self.notes.push("convert::microfacets", span, message, "rough surfaces are a little brighter");
        }
        if multiscatter {
            let message = "in pbrt light that bounces between facets is lost";
            self.notes.push("convert::microfacets", span, message, "rough surfaces are darker");
        }
    }

    /// A model of many parameters: mixtures of a coated diffuse base, a metal and glass.
    fn many(&mut self, name: String, base: Base, tilt: Option<Tilt>, (what, span): (&str, &Span)) -> String {
        let instead =
            "mixtures of a coated base, a metal and glass of its color, roughness and index are written";
        self.notes.push("convert::approximated", span, format!("pbrt has no material \"{what}\""), instead);
        let alpha = [base.roughness; 2];
        let is_const = |input: ScalarInput, value: f32| surfaces::is(input, value);
        let mut shown = name.clone();
        if !is_const(base.transmission, 1.0) {
            let part = |writer: &mut Self, suffix: &str, kind: &str, params: Params| {
                let part = format!("{name}-{suffix}");
                let params = writer.roughness(params, "", alpha, Use::Square);
                writer.named(&part, kind, params, tilt);
                part
            };
            let coated = (!is_const(base.metallic, 1.0)).then(|| {
                let eta = base.eta.max(1.0);
                let returned = diffuse_reflectance_of(1.0 / eta);
                let params = self.coated(eta, base.color, Coats::new(returned, returned, true));
                part(self, "base", "coateddiffuse", params)
            });
            let metal = (!is_const(base.metallic, 0.0)).then(|| {
                let params = self.color(Params::default(), "reflectance", base.color, Use::Color);
                part(self, "metal", "conductor", params)
            });
            shown = match (coated, metal) {
                (Some(coated), Some(metal)) => {
                    let both = format!("{name}-opaque");
                    self.mixture(&both, base.metallic, [&coated, &metal]);
                    both
                }
                (one, other) => one.or(other).unwrap_or(shown),
            };
        }
        if is_const(base.transmission, 0.0) {
            return shown;
        }
        let glass = format!("{name}-glass");
        let params = Params::default().float("eta", base.eta);
        if base.is_thin {
            self.named(&glass, "thindielectric", params, tilt);
        } else {
            let params = self.roughness(params, "", alpha, Use::Square);
            self.named(&glass, "dielectric", params, tilt);
        }
        if is_const(base.transmission, 1.0) {
            return glass;
        }
        self.mixture(&name, base.transmission, [&shown, &glass]);
        name
    }
}

fn model(kind: MicrofacetKind) -> sr_bsdf::MicrofacetKind {
    match kind {
        MicrofacetKind::Beckmann => sr_bsdf::MicrofacetKind::Beckmann,
        MicrofacetKind::Ggx => sr_bsdf::MicrofacetKind::Ggx,
        MicrofacetKind::GgxCorrelated => sr_bsdf::MicrofacetKind::GgxCorrelated,
    }
}
