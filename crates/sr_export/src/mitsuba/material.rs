//! Materials: ours are named as Mitsuba's are, and those that it does not have are written as the nearest that it has.

use std::f32::consts::FRAC_1_SQRT_2;

use sr_bsdf::hair::absorption_of_color;
use sr_scene::{
    ColorInput, HairAbsorption, HairDesc, MaterialDesc, MaterialId, MetallicRoughnessDesc, MicrofacetKind,
    PrincipledDesc, PrincipledThinDesc, ScalarInput, Span, Tilting,
};

use super::Writer;
use super::xml::Xml;
use crate::surfaces;

impl Writer<'_> {
    /// The id of a material, which is described first.
    pub(super) fn material(&mut self, id: MaterialId) -> String {
        if let Some(name) = self.materials.get(&id) {
            return name.clone();
        }
        let name = format!("material{}", id.0);
        let mut xml = Xml::inside(1);
        if let Some(desc) = self.scene.materials.get(id.0 as usize) {
            let span = self.scene.material_span(id);
            self.bsdf(&mut xml, &name, desc, &span);
        }
        self.definitions.append(&xml);
        self.materials.insert(id, name.clone());
        name
    }

    fn bsdf(&mut self, xml: &mut Xml, id: &str, desc: &MaterialDesc, span: &Span) {
        let begin = |xml: &mut Xml, kind: &str| xml.begin("bsdf", &[("type", kind), ("id", id)]);
        match desc {
            MaterialDesc::Diffuse { reflectance } => self.diffuse(xml, id, *reflectance),
            MaterialDesc::Dielectric { eta, specular_reflectance, specular_transmittance } => {
                begin(xml, "dielectric");
                index(xml, *eta);
                self.factor(xml, "specular_reflectance", *specular_reflectance);
                self.factor(xml, "specular_transmittance", *specular_transmittance);
                xml.end();
            }
            MaterialDesc::ThinDielectric { eta, specular_reflectance, specular_transmittance } => {
                begin(xml, "thindielectric");
                index(xml, *eta);
                self.factor(xml, "specular_reflectance", *specular_reflectance);
                self.factor(xml, "specular_transmittance", *specular_transmittance);
                xml.end();
            }
            MaterialDesc::RoughDielectric {
                kind,
                alpha,
                eta,
                specular_reflectance,
                specular_transmittance,
                multiscatter,
            } => {
                begin(xml, "roughdielectric");
                self.distribution(xml, *kind, span);
                self.alpha(xml, *alpha);
                index(xml, *eta);
                self.factor(xml, "specular_reflectance", *specular_reflectance);
                self.factor(xml, "specular_transmittance", *specular_transmittance);
                self.multiscatter(xml, *multiscatter, span);
                xml.end();
            }
            MaterialDesc::Conductor { eta_k, specular_reflectance } => {
                begin(xml, "conductor");
                self.metal(xml, *eta_k);
                self.factor(xml, "specular_reflectance", *specular_reflectance);
                xml.end();
            }
            MaterialDesc::RoughConductor { kind, alpha, eta_k, specular_reflectance, multiscatter } => {
                begin(xml, "roughconductor");
                self.distribution(xml, *kind, span);
                self.alpha(xml, *alpha);
                self.metal(xml, *eta_k);
                self.factor(xml, "specular_reflectance", *specular_reflectance);
                self.multiscatter(xml, *multiscatter, span);
                xml.end();
            }
            MaterialDesc::Plastic { eta, diffuse_reflectance, specular_reflectance, nonlinear } => {
                begin(xml, "plastic");
                index(xml, *eta);
                self.color(xml, "diffuse_reflectance", *diffuse_reflectance);
                self.factor(xml, "specular_reflectance", *specular_reflectance);
                xml.boolean("nonlinear", *nonlinear);
                xml.end();
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
                begin(xml, "roughplastic");
                self.distribution(xml, *kind, span);
                xml.float("alpha", *alpha);
                index(xml, *eta);
                self.color(xml, "diffuse_reflectance", *diffuse_reflectance);
                self.factor(xml, "specular_reflectance", *specular_reflectance);
                xml.boolean("nonlinear", *nonlinear);
                self.multiscatter(xml, *multiscatter, span);
                xml.end();
            }
            MaterialDesc::Eon { reflectance, roughness } => {
                if self.own("bsdf \"eon\"", span, "a diffuse one of its reflectance is written") {
                    begin(xml, "eon");
                    self.color(xml, "reflectance", *reflectance);
                    self.number(xml, "roughness", *roughness);
                    xml.end();
                } else {
                    self.diffuse(xml, id, *reflectance);
                }
            }
            MaterialDesc::OrenNayar { reflectance, sigma } => {
                let instead = "a diffuse one of its reflectance is written";
                let sigma = match sigma {
                    ScalarInput::Constant(sigma) => Some(*sigma),
                    ScalarInput::Texture(_) => {
                        self.notes.push(
                            "convert::texture",
                            span,
                            "the roughness of a rough diffuse material cannot be a texture",
                            instead,
                        );
                        None
                    }
                };
                match sigma.filter(|_| self.own("bsdf \"roughdiffuse\"", span, instead)) {
                    Some(sigma) => {
                        begin(xml, "roughdiffuse");
                        self.color(xml, "reflectance", *reflectance);
                        // A slope's root mean square is √2 times the angle's.
                        xml.float("alpha", sigma / FRAC_1_SQRT_2);
                        xml.end();
                    }
                    None => self.diffuse(xml, id, *reflectance),
                }
            }
            MaterialDesc::DiffuseTransmission { reflectance, transmittance } => {
                let instead = "diffuse reflection on both sides is written, nothing passes";
                if self.own("bsdf \"diffusetransmission\"", span, instead) {
                    begin(xml, "diffusetransmission");
                    self.color(xml, "reflectance", *reflectance);
                    self.color(xml, "transmittance", *transmittance);
                    xml.end();
                } else {
                    let side = format!("{id}-side");
                    self.diffuse(xml, &side, *reflectance);
                    begin(xml, "twosided");
                    xml.reference(None, &side);
                    xml.end();
                }
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
                let is_own =
                    self.own("bsdf \"coatedconductor\"", span, "the metal without its coat is written");
                begin(xml, if is_own { "coatedconductor" } else { "roughconductor" });
                self.distribution(xml, *kind, span);
                xml.float("alpha", *alpha);
                if is_own {
                    xml.float("coat_alpha", *coat_alpha);
                    index(xml, *eta);
                    if let Some(bounces) = bounces {
                        xml.integer("bounces", i64::from(*bounces));
                    }
                }
                self.metal(xml, *eta_k);
                self.factor(xml, "specular_reflectance", *specular_reflectance);
                xml.end();
            }
            MaterialDesc::Principled(p) => self.principled(xml, id, p),
            MaterialDesc::PrincipledThin(p) => self.principled_thin(xml, id, p),
            MaterialDesc::MetallicRoughness(m) => {
                let instead = "a principled one of the same base, metal, roughness and coat is written";
                match self.own("bsdf \"metallicroughness\"", span, instead) {
                    true => self.metallic_roughness(xml, id, m),
                    false => self.as_principled(xml, id, m),
                }
            }
            MaterialDesc::Hair(hair) => self.hair(xml, id, hair, span),
            MaterialDesc::TwoSided { front, back } => self.two_sided(xml, id, [*front, *back], span),
            MaterialDesc::Mask { opacity, .. } if surfaces::is(*opacity, 0.0) => {
                begin(xml, "null");
                xml.end();
            }
            MaterialDesc::Mask { opacity, inner } => {
                let inner = self.material(*inner);
                begin(xml, "mask");
                self.number(xml, "opacity", *opacity);
                xml.reference(None, &inner);
                xml.end();
            }
            MaterialDesc::Blend { weight, materials } => {
                let [first, second] = materials.map(|id| self.material(id));
                begin(xml, "blendbsdf");
                self.number(xml, "weight", *weight);
                xml.reference(None, &first);
                xml.reference(None, &second);
                xml.end();
            }
            MaterialDesc::BumpMap { scale, texture, tilting, inner } => {
                let inner = self.material(*inner);
                begin(xml, "bumpmap");
                xml.float("scale", *scale);
                self.color(xml, "arbitrary", ColorInput::Texture(*texture));
                tilt(xml, *tilting);
                xml.reference(None, &inner);
                xml.end();
            }
            MaterialDesc::NormalMap { normal, tilting, inner } => {
                let inner = self.material(*inner);
                begin(xml, "normalmap");
                self.color(xml, "normalmap", *normal);
                tilt(xml, *tilting);
                let instead = "where these are mirrored, normals tilt the other way across the tangent";
                if tilting.along_v && self.own("normal map whose bitangent is along v", span, instead) {
                    xml.boolean("along_v", true);
                }
                xml.reference(None, &inner);
                xml.end();
            }
        }
    }

    fn diffuse(&mut self, xml: &mut Xml, id: &str, reflectance: ColorInput) {
        xml.begin("bsdf", &[("type", "diffuse"), ("id", id)]);
        self.color(xml, "reflectance", reflectance);
        xml.end();
    }

    fn two_sided(&mut self, xml: &mut Xml, id: &str, [front, back]: [MaterialId; 2], span: &Span) {
        let passes = [front, back].into_iter().any(|side| surfaces::transmits(self.scene, side));
        let sides = [self.material(front), self.material(back)];
        if passes
            && !self.own(
                "two-sided bsdf that lets light through",
                span,
                "its front is written, which has both sides",
            )
        {
            // What lets light through is told by both of its sides; nothing else is to be added.
            xml.begin("bsdf", &[("type", "mask"), ("id", id)]);
            xml.float("opacity", 1.0);
            xml.reference(None, &sides[0]);
            xml.end();
            return;
        }
        xml.begin("bsdf", &[("type", "twosided"), ("id", id)]);
        xml.reference(None, &sides[0]);
        if front != back {
            xml.reference(None, &sides[1]);
        }
        xml.end();
    }

    fn alpha(&mut self, xml: &mut Xml, [u, v]: [ScalarInput; 2]) {
        if u == v {
            self.number(xml, "alpha", u);
        } else {
            self.number(xml, "alpha_u", u);
            self.number(xml, "alpha_v", v);
        }
    }

    fn metal(&mut self, xml: &mut Xml, eta_k: Option<(ColorInput, ColorInput)>) {
        match eta_k {
            None => xml.string("material", "none"),
            Some((eta, k)) => {
                self.color(xml, "eta", eta);
                self.color(xml, "k", k);
            }
        }
    }

    fn distribution(&mut self, xml: &mut Xml, kind: MicrofacetKind, span: &Span) {
        let what = "facets whose masking and shadowing are correlated";
        let name = match kind {
            MicrofacetKind::Beckmann => "beckmann",
            MicrofacetKind::Ggx => "ggx",
            MicrofacetKind::GgxCorrelated
                if self.own(what, span, "independent ones are, a little darker") =>
            {
                "ggx_correlated"
            }
            MicrofacetKind::GgxCorrelated => "ggx",
        };
        xml.string("distribution", name);
    }

    fn multiscatter(&mut self, xml: &mut Xml, multiscatter: bool, span: &Span) {
        let instead = "it is left out, and rough surfaces are darker";
        if multiscatter && self.own("light that bounces between facets", span, instead) {
            xml.boolean("multiscatter", true);
        }
    }

    fn principled(&mut self, xml: &mut Xml, id: &str, p: &PrincipledDesc) {
        xml.begin("bsdf", &[("type", "principled"), ("id", id)]);
        self.color(xml, "base_color", p.base_color);
        xml.float("eta", p.eta);
        self.number(xml, "roughness", p.roughness);
        for (name, input) in [
            ("anisotropic", p.anisotropic),
            ("metallic", p.metallic),
            ("spec_trans", p.spec_trans),
            ("spec_tint", p.spec_tint),
            ("sheen", p.sheen),
            ("sheen_tint", p.sheen_tint),
            ("flatness", p.flatness),
            ("clearcoat", p.clearcoat),
            ("clearcoat_gloss", p.clearcoat_gloss),
        ] {
            self.number_above_0(xml, name, input);
        }
        const RATES: [&str; 3] =
            ["diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"];
        rates(xml, &RATES, &p.rates);
        xml.end();
    }

    fn principled_thin(&mut self, xml: &mut Xml, id: &str, p: &PrincipledThinDesc) {
        xml.begin("bsdf", &[("type", "principledthin"), ("id", id)]);
        self.color(xml, "base_color", p.base_color);
        self.number(xml, "eta", p.eta);
        self.number(xml, "roughness", p.roughness);
        for (name, input) in [
            ("anisotropic", p.anisotropic),
            ("spec_trans", p.spec_trans),
            ("spec_tint", p.spec_tint),
            ("sheen", p.sheen),
            ("sheen_tint", p.sheen_tint),
            ("flatness", p.flatness),
            ("diff_trans", p.diff_trans),
        ] {
            self.number_above_0(xml, name, input);
        }
        const RATES: [&str; 4] = [
            "specular_reflectance_sampling_rate",
            "specular_transmittance_sampling_rate",
            "diffuse_reflectance_sampling_rate",
            "diffuse_transmittance_sampling_rate",
        ];
        rates(xml, &RATES, &p.rates);
        xml.end();
    }

    fn hair(&mut self, xml: &mut Xml, id: &str, hair: &HairDesc, span: &Span) {
        if surfaces::turns(self.scene, hair, false) {
            let message = "fibres of hair run across u in Mitsuba, where there are no curves";
            self.notes.push(
                "convert::hair",
                span,
                message,
                "on what is no curve they are turned by a right angle",
            );
        }
        let beta_n = self.baker.average_number(hair.beta_n);
        let absorption = match hair.absorption {
            HairAbsorption::Pigments { eumelanin, pheomelanin } => HairAbsorption::Pigments {
                eumelanin: self.of_hair(eumelanin, span),
                pheomelanin: self.of_hair(pheomelanin, span),
            },
            HairAbsorption::Color(texture @ ColorInput::Texture(_))
                if self.own("texture for the color of hair", span, "its mean is written") =>
            {
                HairAbsorption::Color(texture)
            }
            HairAbsorption::Color(color) => {
                let sigma_a = absorption_of_color(self.baker.average(color), beta_n);
                HairAbsorption::Coefficient(ColorInput::Constant(sigma_a))
            }
            coefficient => coefficient,
        };
        let roughness = [hair.beta_m, hair.beta_n].map(|beta| self.of_hair(beta, span));
        xml.begin("bsdf", &[("type", "hair"), ("id", id)]);
        match absorption {
            HairAbsorption::Coefficient(sigma_a) => self.color(xml, "sigma_a", sigma_a),
            HairAbsorption::Color(color) => self.color(xml, "color", color),
            HairAbsorption::Pigments { eumelanin, pheomelanin } => {
                self.number(xml, "eumelanin", eumelanin);
                self.number(xml, "pheomelanin", pheomelanin);
            }
        }
        index(xml, hair.eta);
        self.number(xml, "longitudinal_roughness", roughness[0]);
        self.number(xml, "azimuthal_roughness", roughness[1]);
        xml.float("scale_tilt", hair.alpha.to_degrees());
        xml.end();
    }

    /// A number of hair, which in Mitsuba cannot be a texture.
    fn of_hair(&mut self, input: ScalarInput, span: &Span) -> ScalarInput {
        let is_textured = matches!(input, ScalarInput::Texture(_));
        if is_textured
            && !self.own("texture for the roughness or pigments of hair", span, "its mean is written")
        {
            return ScalarInput::Constant(self.baker.average_number(input));
        }
        input
    }

    fn metallic_roughness(&mut self, xml: &mut Xml, id: &str, m: &MetallicRoughnessDesc) {
        xml.begin("bsdf", &[("type", "metallicroughness"), ("id", id)]);
        self.color(xml, "base_color", m.base_color);
        for (name, input) in [
            ("metallic", m.metallic),
            ("roughness", m.roughness),
            ("specular", m.specular),
            ("clearcoat", m.clearcoat),
            ("clearcoat_roughness", m.clearcoat_roughness),
            ("sheen_roughness", m.sheen_roughness),
            ("transmission", m.transmission),
            ("diffuse_transmission", m.diffuse_transmission),
            ("anisotropy", m.anisotropy),
        ] {
            self.number(xml, name, input);
        }
        self.color(xml, "specular_color", m.specular_color);
        self.color(xml, "sheen_color", m.sheen_color);
        self.factor(xml, "diffuse_transmission_color", m.diffuse_transmission_color);
        xml.float("ior", m.ior);
        xml.boolean("thin", m.thin);
        xml.float("anisotropy_rotation", m.anisotropy_rotation.to_degrees());
        xml.end();
    }

    fn as_principled(&mut self, xml: &mut Xml, id: &str, m: &MetallicRoughnessDesc) {
        let mean = |writer: &Self, input| writer.baker.average_number(input);
        let transmits = !surfaces::is(m.transmission, 0.0);
        let sheen = self.baker.average(m.sheen_color).max_element();
        let (coat, gloss) = (m.clearcoat, 1.0 - mean(self, m.clearcoat_roughness));
        // R₀ = 0.08 specular, as `ior` has it times `specular`.
        let r0 = ((m.ior - 1.0) / (m.ior + 1.0)).powi(2) * mean(self, m.specular);
        xml.begin(
            "bsdf",
            &[("type", if m.thin && transmits { "principledthin" } else { "principled" }), ("id", id)],
        );
        self.color(xml, "base_color", m.base_color);
        self.number(xml, "roughness", m.roughness);
        self.number_above_0(xml, "spec_trans", m.transmission);
        self.number_above_0(xml, "anisotropic", m.anisotropy);
        self.number_above_0(xml, "sheen", ScalarInput::Constant(sheen.min(1.0)));
        if m.thin && transmits {
            xml.float("eta", m.ior.max(1.001));
        } else {
            match transmits {
                true => xml.float("eta", m.ior.max(1.001)),
                false => xml.float("specular", (r0 / 0.08).min(1.0)),
            }
            self.number_above_0(xml, "metallic", m.metallic);
            self.number_above_0(xml, "clearcoat", coat);
            if !surfaces::is(coat, 0.0) {
                xml.float("clearcoat_gloss", gloss.clamp(0.0, 1.0));
            }
        }
        xml.end();
    }

    fn number_above_0(&mut self, xml: &mut Xml, name: &str, input: ScalarInput) {
        if !surfaces::is(input, 0.0) {
            self.number(xml, name, input);
        }
    }
}

fn index(xml: &mut Xml, eta: f32) {
    xml.float("int_ior", eta);
    xml.float("ext_ior", 1.0);
}

fn tilt(xml: &mut Xml, tilting: Tilting) {
    if !(tilting.flip_invalid_normals && tilting.shadows) {
        xml.boolean("flip_invalid_normals", tilting.flip_invalid_normals);
        xml.boolean("use_shadowing_function", tilting.shadows);
    }
}

fn rates(xml: &mut Xml, names: &[&str], rates: &[f32]) {
    for (name, rate) in names.iter().zip(rates).filter(|(_, rate)| **rate != 1.0) {
        xml.float(name, *rate);
    }
}
