//! BSDFs.

use sr_scene::{ColorInput, Diagnostic, MaterialDesc, MaterialId, MicrofacetKind, Rgb, ScalarInput, Tilting};

use super::color::Role;
use super::{Lowering, key};
use crate::mitsuba::node::{Node, Value};
use crate::mitsuba::props::Props;
use crate::mitsuba::tables;

pub(super) const GREY: Rgb = Rgb::splat(0.5);

impl<'a> Lowering<'a, '_> {
    /// The material of a BSDF; each node is lowered once.
    pub(super) fn material(&mut self, node: &'a Node) -> MaterialId {
        if let Some(&done) = self.materials_done.get(&key(node)) {
            return done;
        }
        if node.class != "bsdf" {
            let message = format!("a BSDF was expected, not {}", node.title());
            self.out.d.push(Diagnostic::error("mitsuba::wrong-type", &node.span, message));
            return self.default_material(node);
        }
        if !self.open.insert(key(node)) {
            let message = format!("{} contains itself", node.title());
            self.out.d.push(Diagnostic::error("mitsuba::cycle", &node.span, message));
            return self.default_material(node);
        }
        let mut props = Props::new(node);
        let desc = self.material_kind(node, &mut props);
        props.finish(self.out.d);
        self.open.remove(&key(node));
        let id = match desc {
            Lowered::New(desc) => self.out.add_material(desc, &node.span),
            Lowered::Same(id) => id,
        };
        self.materials_done.insert(key(node), id);
        id
    }

    /// What stands in for a BSDF that cannot be had.
    pub(super) fn default_material(&mut self, node: &Node) -> MaterialId {
        self.out.add_material(diffuse(GREY), &node.span)
    }

    fn material_kind(&mut self, node: &'a Node, props: &mut Props<'a>) -> Lowered {
        props.ignore(&["sample_visible", "specular_sampling_weight"]);
        let desc = match node.kind.as_str() {
            "diffuse" => MaterialDesc::Diffuse { reflectance: self.factor(props, "reflectance", GREY) },
            "dielectric" | "thindielectric" => {
                let eta = self.eta(props, "bk7");
                let specular_reflectance = self.factor(props, "specular_reflectance", Rgb::ONE);
                let specular_transmittance = self.factor(props, "specular_transmittance", Rgb::ONE);
                if node.kind == "dielectric" {
                    MaterialDesc::Dielectric { eta, specular_reflectance, specular_transmittance }
                } else {
                    MaterialDesc::ThinDielectric { eta, specular_reflectance, specular_transmittance }
                }
            }
            "roughdielectric" => MaterialDesc::RoughDielectric {
                kind: self.distribution(props),
                alpha: self.alpha(props),
                eta: self.eta(props, "bk7"),
                specular_reflectance: self.factor(props, "specular_reflectance", Rgb::ONE),
                specular_transmittance: self.factor(props, "specular_transmittance", Rgb::ONE),
                multiscatter: self.multiscatter(props),
            },
            "conductor" => MaterialDesc::Conductor {
                eta_k: self.eta_k(props),
                specular_reflectance: self.factor(props, "specular_reflectance", Rgb::ONE),
            },
            "roughconductor" => MaterialDesc::RoughConductor {
                kind: self.distribution(props),
                alpha: self.alpha(props),
                eta_k: self.eta_k(props),
                specular_reflectance: self.factor(props, "specular_reflectance", Rgb::ONE),
                multiscatter: self.multiscatter(props),
            },
            "plastic" => MaterialDesc::Plastic {
                eta: self.eta(props, "polypropylene"),
                diffuse_reflectance: self.factor(props, "diffuse_reflectance", GREY),
                specular_reflectance: self.factor(props, "specular_reflectance", Rgb::ONE),
                nonlinear: props.boolean("nonlinear", self.out.d).unwrap_or(false),
            },
            "roughplastic" => MaterialDesc::RoughPlastic {
                kind: self.distribution(props),
                alpha: self.constant_alpha(props, "alpha", 0.1),
                eta: self.eta(props, "polypropylene"),
                diffuse_reflectance: self.factor(props, "diffuse_reflectance", GREY),
                specular_reflectance: self.factor(props, "specular_reflectance", Rgb::ONE),
                nonlinear: props.boolean("nonlinear", self.out.d).unwrap_or(false),
                multiscatter: self.multiscatter(props),
            },
            "pplastic" => self.polarizing_plastic(node, props),
            "polarizer" | "circular" | "retarder" => self.polarizing_filter(node, props),
            "coateddiffuse" => self.coated_diffuse(props),
            "coatedconductor" => self.coated_conductor(props),
            "eon" => MaterialDesc::Eon {
                reflectance: self.factor(props, "reflectance", GREY),
                roughness: self.scalar(props, "roughness", 0.5),
            },
            "roughdiffuse" => self.rough_diffuse(props),
            "diffusetransmission" => MaterialDesc::DiffuseTransmission {
                reflectance: self.factor(props, "reflectance", Rgb::splat(0.25)),
                transmittance: self.factor(props, "transmittance", Rgb::splat(0.25)),
            },
            "principled" => self.principled(props),
            "principledthin" => self.principled_thin(props),
            "metallicroughness" => self.metallic_roughness(props),
            "hair" => self.hair(props),
            "twosided" => {
                let nested = self.nested(props, "bsdf");
                match nested[..] {
                    [one] => {
                        let side = self.material(one);
                        MaterialDesc::TwoSided { front: side, back: side }
                    }
                    [front, back] => {
                        MaterialDesc::TwoSided { front: self.material(front), back: self.material(back) }
                    }
                    _ => return self.wrong_nesting(node, "one or two BSDFs", nested.len()),
                }
            }
            "mask" => {
                let opacity = self.scalar(props, "opacity", 0.5);
                match self.nested(props, "bsdf")[..] {
                    [inner] => MaterialDesc::Mask { opacity, inner: self.material(inner) },
                    ref others => return self.wrong_nesting(node, "one BSDF", others.len()),
                }
            }
            "null" => {
                let inner = self.default_material(node);
                MaterialDesc::Mask { opacity: ScalarInput::Constant(0.0), inner }
            }
            "blendbsdf" => {
                let weight = self.scalar(props, "weight", 0.5);
                match self.nested(props, "bsdf")[..] {
                    [first, second] => MaterialDesc::Blend {
                        weight,
                        materials: [self.material(first), self.material(second)],
                    },
                    ref others => return self.wrong_nesting(node, "two BSDFs", others.len()),
                }
            }
            "bumpmap" => return self.bump_map(node, props),
            "normalmap" => {
                let tilting = self.tilting(props);
                if !props.has("normalmap") {
                    props.use_all();
                    return self.wrong_nesting(node, "a texture named normalmap", 0);
                }
                let normal = self.factor(props, "normalmap", Rgb::new(0.5, 0.5, 1.0));
                match self.nested(props, "bsdf")[..] {
                    [inner] => MaterialDesc::NormalMap { normal, tilting, inner: self.material(inner) },
                    ref others => return self.wrong_nesting(node, "one BSDF", others.len()),
                }
            }
            _ => return self.stand_in(node, props),
        };
        Lowered::New(desc)
    }

    pub(super) fn factor(&mut self, props: &mut Props<'a>, name: &'static str, default: Rgb) -> ColorInput {
        self.color(props, name, default, Role::Factor)
    }

    fn wrong_nesting(&mut self, node: &Node, expected: &str, found: usize) -> Lowered {
        let message = format!("{} needs {expected} inside it, not {found}", node.title());
        self.out.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
        Lowered::New(diffuse(GREY))
    }

    fn bump_map(&mut self, node: &'a Node, props: &mut Props<'a>) -> Lowered {
        let scale = props.float("scale", self.out.d).unwrap_or(1.0);
        let tilting = self.tilting(props);
        // The texture goes by several names; it is the only one there can be.
        let textures = self.nested(props, "texture");
        let inner = match self.nested(props, "bsdf")[..] {
            [inner] => self.material(inner),
            ref others => return self.wrong_nesting(node, "one BSDF", others.len()),
        };
        let [texture] = textures[..] else {
            return self.wrong_nesting(node, "one texture", textures.len());
        };
        match self.texture(texture, Role::Factor) {
            ColorInput::Texture(texture) => {
                Lowered::New(MaterialDesc::BumpMap { scale, texture, tilting, inner })
            }
            // A constant displacement tilts nothing.
            ColorInput::Constant(_) => Lowered::Same(inner),
        }
    }

    fn tilting(&mut self, props: &mut Props<'a>) -> Tilting {
        let default = Tilting::default();
        let flip = props.boolean("flip_invalid_normals", self.out.d);
        Tilting {
            flip_invalid_normals: flip.unwrap_or(default.flip_invalid_normals),
            shadows: props.boolean("use_shadowing_function", self.out.d).unwrap_or(default.shadows),
            along_v: props.boolean("along_v", self.out.d).unwrap_or(default.along_v),
        }
    }

    /// What is shown instead of a model that is not supported: its first nested BSDF, or diffuse with its color.
    fn stand_in(&mut self, node: &'a Node, props: &mut Props<'a>) -> Lowered {
        if let [inner, ..] = self.nested(props, "bsdf")[..] {
            let id = self.material(inner);
            props.use_all();
            self.unsupported_plugin(node, &format!("its first nested {} is shown instead", inner.title()));
            return Lowered::Same(id);
        }
        const COLORS: [&str; 3] = ["base_color", "diffuse_reflectance", "reflectance"];
        let color =
            COLORS.into_iter().find_map(|name| Some((name, self.color_if_given(props, name, Role::Factor)?)));
        props.use_all();
        let (consequence, reflectance) = match color {
            Some((name, color)) => {
                (format!("a two-sided diffuse surface of its {name} is shown instead"), color)
            }
            None => (
                "a two-sided diffuse surface of reflectance 0.5 is shown instead".to_owned(),
                ColorInput::Constant(GREY),
            ),
        };
        self.unsupported_plugin(node, &consequence);
        let side = self.out.add_material(MaterialDesc::Diffuse { reflectance }, &node.span);
        Lowered::New(MaterialDesc::TwoSided { front: side, back: side })
    }

    pub(super) fn distribution(&mut self, props: &mut Props<'a>) -> MicrofacetKind {
        match props.string("distribution", self.out.d) {
            None | Some(("beckmann", _)) => MicrofacetKind::Beckmann,
            Some(("ggx", _)) => MicrofacetKind::Ggx,
            Some(("ggx_correlated", _)) => MicrofacetKind::GgxCorrelated,
            Some((other, span)) => {
                let known = ["beckmann", "ggx", "ggx_correlated"];
                self.unknown_word("microfacet distribution", other, &known, "beckmann", span);
                MicrofacetKind::Beckmann
            }
        }
    }

    /// `alpha`, or `alpha_u` and `alpha_v`.
    fn alpha(&mut self, props: &mut Props<'a>) -> [ScalarInput; 2] {
        if props.has("alpha_u") || props.has("alpha_v") {
            return [self.scalar(props, "alpha_u", 0.1), self.scalar(props, "alpha_v", 0.1)];
        }
        [self.scalar(props, "alpha", 0.1); 2]
    }

    pub(super) fn constant_alpha(&mut self, props: &mut Props<'a>, name: &'static str, default: f32) -> f32 {
        match self.scalar(props, name, default) {
            ScalarInput::Constant(alpha) => alpha,
            ScalarInput::Texture(_) => {
                let message = format!("\"{name}\" of {} cannot be a texture", props.node.title());
                self.out.d.push(
                    Diagnostic::warning("mitsuba::texture-not-possible", &props.node.span, message)
                        .consequence(format!("the default, {default}, is used")),
                );
                default
            }
        }
    }

    /// Ours: is light that bounces between facets added?
    fn multiscatter(&mut self, props: &mut Props<'a>) -> bool {
        props.boolean("multiscatter", self.out.d).unwrap_or(false)
    }

    /// Interior over exterior index of refraction.
    pub(super) fn eta(&mut self, props: &mut Props<'a>, interior: &str) -> f32 {
        let default = tables::ior(interior).unwrap_or(1.5);
        let interior = self.ior(props, "int_ior").unwrap_or(default);
        let exterior = self.ior(props, "ext_ior").unwrap_or(1.000277);
        (interior / exterior) as f32
    }

    /// A number or a name.
    fn ior(&mut self, props: &mut Props<'a>, name: &'static str) -> Option<f64> {
        let property = props.get(name)?;
        let Value::String(text) = &property.value else {
            let index = props.float(name, self.out.d).map(f64::from);
            return index.filter(|&index| {
                let is_possible = index > 0.0;
                if !is_possible {
                    let message = format!("\"{name}\" of {} is {index}, not positive", props.node.title());
                    self.out.d.push(Diagnostic::error("scene::index", &property.span, message));
                }
                is_possible
            });
        };
        let known = tables::ior(text);
        if known.is_none() {
            let message = format!("no index of refraction is known for \"{}\"", crate::values::shown(text));
            self.out.d.push(
                Diagnostic::error("mitsuba::unknown-value", &property.span, message)
                    .guess(text, tables::IORS.iter().map(|(n, _)| *n)),
            );
        }
        known
    }

    /// A metal by name, or `eta` and `k`; `None` is a perfect mirror, which is also the default.
    pub(super) fn eta_k(&mut self, props: &mut Props<'a>) -> Option<(ColorInput, ColorInput)> {
        let exterior =
            self.ior(props, "ext_eta").or_else(|| self.ior(props, "ext_ior")).unwrap_or(1.0) as f32;
        let material = props.string("material", self.out.d);
        if props.has("eta") || props.has("k") {
            let eta = self.factor(props, "eta", Rgb::ZERO);
            let k = self.factor(props, "k", Rgb::ONE);
            return Some((self.relative(eta, exterior, props), self.relative(k, exterior, props)));
        }
        let (name, span) = material?;
        if name.eq_ignore_ascii_case("none") {
            return None;
        }
        let Some((_, eta, k)) = tables::metal(name) else {
            let message = format!("the metal \"{}\" is not known", crate::values::shown(name));
            self.out.d.push(
                Diagnostic::error("mitsuba::unknown-value", span, message)
                    .guess(name, tables::METALS.iter().map(|(n, ..)| *n)),
            );
            return None;
        };
        let relative = |v: [f32; 3]| ColorInput::Constant(Rgb::from(v) / exterior);
        Some((relative(*eta), relative(*k)))
    }

    fn relative(&mut self, input: ColorInput, exterior: f32, props: &Props<'a>) -> ColorInput {
        match input {
            ColorInput::Constant(color) => ColorInput::Constant(color / exterior),
            texture if exterior == 1.0 => texture,
            texture => {
                self.out.d.push(
                    Diagnostic::warning(
                        "mitsuba::unsupported-property",
                        &props.node.span,
                        "a textured index with an exterior",
                    )
                    .consequence("the exterior is taken as vacuum"),
                );
                texture
            }
        }
    }
}

/// A new description, or a material that is there already.
enum Lowered {
    New(MaterialDesc),
    Same(MaterialId),
}

pub(super) fn diffuse(color: Rgb) -> MaterialDesc {
    MaterialDesc::Diffuse { reflectance: ColorInput::Constant(color) }
}
