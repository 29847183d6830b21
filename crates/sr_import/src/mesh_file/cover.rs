//! What a material of an MTL file becomes.
//!
//! - With Pr, Pm, Ps or Pc: metallic-roughness, the model that these stand for.
//! - Glass, by `illum` 4, 6, 7 or 9: a dielectric of index Ni.
//! - Ks without Kd: a metal that reflects Ks. Ks with Kd: a coat over a diffuse base. Neither: diffuse.

use glam::{Affine2, Mat2, Vec2};
use sr_scene::{
    ColorInput, Diagnostic, Emission, Filter, MaterialDesc, MaterialId, MetallicRoughnessDesc,
    MicrofacetKind, Rgb, ScalarInput, TextureDesc, TextureId, Tilting, Wrap,
};

use super::MeshScene;
use super::mtl::{Map, Mtl};
use crate::images::{Decode, Encoding, TexelMap};

/// Meshes have v upwards, images downwards.
const UPRIGHT: Affine2 = Affine2 { matrix2: Mat2::from_cols(Vec2::X, Vec2::NEG_Y), translation: Vec2::Y };
/// Brighter surfaces are refused elsewhere.
const BRIGHTEST: f32 = 1e18;
/// Of a coat or a glass without an index of its own.
const ETA: f32 = 1.5;
/// Narrower highlights are those of smooth surfaces.
const SMOOTH: f32 = 0.01;
/// Those that other programs show as glass.
const GLASS: [u32; 4] = [4, 6, 7, 9];

impl MeshScene<'_, '_> {
    /// A surface, and what it emits.
    pub(super) fn cover(&mut self, mtl: &Mtl) -> (MaterialId, Option<Emission>) {
        let emission = self.emission(mtl);
        let illum = mtl.number("illum").map(|v| v as u32);
        let is_pbr = ["pr", "pm", "ps", "pc"].iter().any(|name| mtl.number(name).is_some())
            || ["map_pr", "map_pm"].iter().any(|name| mtl.map(name).is_some());
        let opacity = mtl.number("d").or_else(|| mtl.number("tr").map(|tr| 1.0 - tr));
        let opacity = opacity.unwrap_or(1.0).clamp(0.0, 1.0);
        let eta = mtl.number("ni").filter(|ni| *ni > 1.0).map(|ni| ni.min(10.0));
        let is_clear = opacity < 1.0 || mtl.color("tf").is_some_and(|tf| tf != Rgb::ONE);
        let is_glass =
            !is_pbr && illum.is_some_and(|i| GLASS.contains(&i)) && is_clear && mtl.map("map_d").is_none();
        let desc = if is_glass {
            let tint = mtl.color("tf").map_or(Rgb::ONE, unit);
            MaterialDesc::Dielectric {
                eta: eta.unwrap_or(ETA),
                specular_reflectance: ColorInput::Constant(Rgb::ONE),
                specular_transmittance: ColorInput::Constant(if tint == Rgb::ZERO { Rgb::ONE } else { tint }),
            }
        } else if is_pbr {
            self.metallic_roughness(mtl, eta.unwrap_or(ETA))
        } else {
            // By 0 and 1 there are no highlights, whatever Ks says.
            let shines = illum.is_none_or(|illum| illum >= 2);
            self.phong(mtl, eta.unwrap_or(ETA), shines)
        };
        let mut id = self.tilted(mtl, desc);
        if !is_glass {
            id = self.out.add_material(MaterialDesc::TwoSided { front: id, back: id }, &mtl.span);
            let scalar = Decode::Texels(TexelMap::new(Encoding::Linear, true));
            let mask = mtl.map("map_d").and_then(|map| self.image(map, scalar));
            let opacity = match mask {
                Some(texture) => Some(self.scaled(mtl, texture, opacity)),
                None => (opacity < 1.0).then_some(ScalarInput::Constant(opacity)),
            };
            if let Some(opacity) = opacity {
                id = self.out.add_material(MaterialDesc::Mask { opacity, inner: id }, &mtl.span);
            }
        }
        (id, emission)
    }

    fn phong(&mut self, mtl: &Mtl, eta: f32, shines: bool) -> MaterialDesc {
        let base =
            self.color(mtl, "kd", "map_kd", Rgb::splat(if mtl.color("ks").is_some() { 0.0 } else { 0.6 }));
        let has_highlight = shines && mtl.color("ks").is_some_and(|ks| ks.max_element() > 0.0);
        if !has_highlight {
            return MaterialDesc::Diffuse { reflectance: base };
        }
        // Lobes cos^Ns and Beckmann's are as wide as one another so (Walter et al. 2007, section 5.4).
        let alpha = (2.0 / (mtl.number("ns").unwrap_or(0.0).max(0.0) + 2.0)).sqrt();
        let specular_reflectance = self.color(mtl, "ks", "map_ks", Rgb::ONE);
        let kind = MicrofacetKind::Ggx;
        match (base == ColorInput::Constant(Rgb::ZERO), alpha < SMOOTH) {
            (true, true) => MaterialDesc::Conductor { eta_k: None, specular_reflectance },
            (true, false) => MaterialDesc::RoughConductor {
                kind,
                alpha: [ScalarInput::Constant(alpha); 2],
                eta_k: None,
                specular_reflectance,
                multiscatter: false,
            },
            (false, true) => MaterialDesc::Plastic {
                eta,
                diffuse_reflectance: base,
                specular_reflectance,
                nonlinear: false,
            },
            (false, false) => MaterialDesc::RoughPlastic {
                kind,
                alpha,
                eta,
                diffuse_reflectance: base,
                specular_reflectance,
                nonlinear: false,
                multiscatter: false,
            },
        }
    }

    fn metallic_roughness(&mut self, mtl: &Mtl, ior: f32) -> MaterialDesc {
        for name in ["aniso", "anisor"] {
            if mtl.number(name).is_some_and(|v| v != 0.0) {
                let message = format!("\"{name}\" is not done");
                self.say(mtl, &message, "highlights are round");
            }
        }
        let share = |name: &str, default: f32| mtl.number(name).unwrap_or(default).clamp(0.0, 1.0);
        MaterialDesc::MetallicRoughness(MetallicRoughnessDesc {
            base_color: self.color(mtl, "kd", "map_kd", Rgb::splat(0.6)),
            metallic: self.scalar(mtl, "pm", "map_pm", 0.0),
            roughness: self.scalar(mtl, "pr", "map_pr", 0.5),
            specular: ScalarInput::Constant(1.0),
            specular_color: ColorInput::Constant(Rgb::ONE),
            ior,
            clearcoat: ScalarInput::Constant(share("pc", 0.0)),
            clearcoat_roughness: ScalarInput::Constant(share("pcr", 0.0)),
            sheen_color: ColorInput::Constant(Rgb::splat(share("ps", 0.0))),
            sheen_roughness: ScalarInput::Constant(0.5),
            transmission: ScalarInput::Constant(0.0),
            thin: true,
            diffuse_transmission: ScalarInput::Constant(0.0),
            diffuse_transmission_color: ColorInput::Constant(Rgb::ONE),
            anisotropy: ScalarInput::Constant(0.0),
            anisotropy_rotation: 0.0,
        })
    }

    /// A material with its bumps.
    fn tilted(&mut self, mtl: &Mtl, desc: MaterialDesc) -> MaterialId {
        let inner = self.out.add_material(desc, &mtl.span);
        let tilting = Tilting::default();
        if let Some(normal) = mtl.map("norm").and_then(|map| self.image(map, Decode::Raw)) {
            let normal = ColorInput::Texture(normal);
            return self.out.add_material(MaterialDesc::NormalMap { normal, tilting, inner }, &mtl.span);
        }
        let Some(map) = mtl.map("map_bump") else { return inner };
        let Some(texture) = self.image(map, Decode::Raw) else { return inner };
        let scale = map.bump;
        self.out.add_material(MaterialDesc::BumpMap { scale, texture, tilting, inner }, &mtl.span)
    }

    fn emission(&mut self, mtl: &Mtl) -> Option<Emission> {
        let factor = mtl.color("ke").map(|ke| ke.clamp(Rgb::ZERO, Rgb::splat(BRIGHTEST)));
        let texture = mtl.map("map_ke").and_then(|map| self.image(map, Decode::Color));
        let radiance = match (factor, texture) {
            (None, None) => return None,
            (Some(factor), _) if factor == Rgb::ZERO => return None,
            (Some(factor), None) => ColorInput::Constant(factor),
            (factor, Some(texture)) => self.product(mtl, texture, factor.unwrap_or(Rgb::ONE)),
        };
        self.shines = true;
        Some(Emission { radiance })
    }

    /// A reflectance: a color, an image, or both multiplied.
    fn color(&mut self, mtl: &Mtl, name: &str, map: &str, default: Rgb) -> ColorInput {
        let factor = mtl.color(name).map(unit);
        match mtl.map(map).and_then(|map| self.image(map, Decode::Color)) {
            // Exporters leave black where an image takes over.
            Some(texture) if factor.is_none_or(|factor| factor == Rgb::ZERO) => ColorInput::Texture(texture),
            Some(texture) => self.product(mtl, texture, factor.unwrap_or(Rgb::ONE)),
            None => ColorInput::Constant(factor.unwrap_or(default)),
        }
    }

    fn scalar(&mut self, mtl: &Mtl, name: &str, map: &str, default: f32) -> ScalarInput {
        let factor = mtl.number(name).map(|v| v.clamp(0.0, 1.0));
        match mtl.map(map).and_then(|map| self.image(map, Decode::Raw)) {
            Some(texture) if factor.is_none_or(|factor| factor == 0.0) => ScalarInput::Texture(texture),
            Some(texture) => self.scaled(mtl, texture, factor.unwrap_or(1.0)),
            None => ScalarInput::Constant(factor.unwrap_or(default)),
        }
    }

    fn product(&mut self, mtl: &Mtl, texture: TextureId, factor: Rgb) -> ColorInput {
        if factor == Rgb::ONE {
            return ColorInput::Texture(texture);
        }
        let (input, factor) = (ColorInput::Texture(texture), ColorInput::Constant(factor));
        self.out.add_texture(TextureDesc::Scale { input, factor, span: mtl.span.clone() })
    }

    fn scaled(&mut self, mtl: &Mtl, texture: TextureId, factor: f32) -> ScalarInput {
        match self.product(mtl, texture, Rgb::splat(factor)) {
            ColorInput::Texture(texture) => ScalarInput::Texture(texture),
            ColorInput::Constant(color) => ScalarInput::Constant(color.x),
        }
    }

    /// An image's texture; without the file, `None` and a warning: such files travel without their images.
    pub(super) fn image(&mut self, map: &Map, decode: Decode) -> Option<TextureId> {
        if !self.out.find(&map.file).is_file() {
            let message = format!("there is no image {}", crate::values::shown(&map.file));
            let missing = Diagnostic::warning("mtl::no-image", &map.span, message);
            self.out.d.push(missing.consequence("the material is shown without it"));
            return None;
        }
        let image = self.out.image_file(&map.file, decode, &map.span);
        let texture = TextureDesc::Bitmap {
            image,
            filter: Filter::Bilinear,
            wrap: if map.clamp { Wrap::Clamp } else { Wrap::Repeat },
            srgb: decode == Decode::Color,
            to_uv: UPRIGHT * Affine2::from_scale_angle_translation(map.scale, 0.0, map.offset),
            span: map.span.clone(),
        };
        match self.out.add_texture(texture) {
            ColorInput::Texture(texture) => Some(texture),
            ColorInput::Constant(_) => None,
        }
    }

    fn say(&mut self, mtl: &Mtl, message: &str, consequence: &str) {
        self.out.d.push(Diagnostic::warning("mtl::statement", &mtl.span, message).consequence(consequence));
    }
}

fn unit(color: Rgb) -> Rgb {
    color.clamp(Rgb::ZERO, Rgb::ONE)
}
