//! Textures: ids, colours, transforms, and how they are nested.

use std::collections::HashSet;

use glam::Affine2;

use super::Check;
use crate::diagnostic::{Diagnostic, Severity, Span};
use crate::{ColorInput, LightDesc, MAX_UV_SETS, MaterialDesc, Pixels, ScalarInput, TextureDesc, TextureId};

/// Textures that one lookup may lead to.
const MAX_LOOKUPS: u32 = 256;
/// Beyond this many, single precision does not tell texels of a tile apart.
const MAX_TILES: f32 = 1e6;

impl Check<'_> {
    pub(super) fn textures(&mut self) {
        // what a lookup costs, in lookups
        let mut costs: Vec<u32> = Vec::new();
        for texture in &self.scene.textures {
            let (span, inner) = self.texture(texture);
            let mut cost: u32 = 1;
            for TextureId(id) in inner {
                match costs.get(id as usize) {
                    Some(inner) => cost = cost.saturating_add(*inner),
                    // Ids lead back: nothing contains itself.
                    None => self.error("scene::bad-id", span, format!("there is no texture {id} before it")),
                }
            }
            if cost > MAX_LOOKUPS {
                let message = format!("a texture made of more than {MAX_LOOKUPS} others");
                self.error("scene::texture-depth", span, message);
            }
            costs.push(cost);
        }
    }

    /// Where the texture was described, and the textures in it.
    fn texture<'t>(&mut self, texture: &'t TextureDesc) -> (&'t Span, Vec<TextureId>) {
        let mut inner = Vec::new();
        let mut color = |check: &mut Self, input: &ColorInput, what: &str, span: &Span| match *input {
            ColorInput::Constant(color) => check.color(color, what, span),
            ColorInput::Texture(id) => inner.push(id),
        };
        let (to_uv, span) = match texture {
            TextureDesc::Bitmap { image, to_uv, span, .. } => {
                if *image as usize >= self.scene.images.len() {
                    self.error("scene::bad-id", span, format!("there is no image {image}"));
                }
                (Some(to_uv), span)
            }
            TextureDesc::Checkerboard { color0, color1, to_uv, span } => {
                color(self, color0, "color0", span);
                color(self, color1, "color1", span);
                (Some(to_uv), span)
            }
            TextureDesc::Scale { input, factor, span } => {
                color(self, input, "the scaled color", span);
                color(self, factor, "the scale", span);
                (None, span)
            }
            TextureDesc::Mix { color0, color1, weight, span } => {
                color(self, color0, "color0", span);
                color(self, color1, "color1", span);
                match *weight {
                    ScalarInput::Texture(id) => inner.push(id),
                    ScalarInput::Constant(weight) if (0.0..=1.0).contains(&weight) => {}
                    ScalarInput::Constant(weight) => {
                        self.error(
                            "scene::weight",
                            span,
                            format!("a weight of {weight}: [0, 1] is possible"),
                        );
                    }
                }
                (None, span)
            }
            TextureDesc::OtherUvs { input, set, span } => {
                color(self, input, "the color", span);
                if !(1..MAX_UV_SETS).contains(set) {
                    let message =
                        format!("set {set} of texture coordinates: 1 to {} are possible", MAX_UV_SETS - 1);
                    self.error("scene::texture-coordinates", span, message);
                }
                (None, span)
            }
            TextureDesc::MeshColor { scale, span, .. } => {
                if !(*scale >= 0.0 && scale.is_finite()) {
                    self.error("scene::bad-color", span, format!("mesh colors scaled by {scale}"));
                }
                (None, span)
            }
        };
        if let Some(to_uv) = to_uv {
            self.texture_transform(to_uv, span);
        }
        (span, inner)
    }

    /// Images with negative values where a color or a number is wanted; displacements may be negative. Of a scene without
    /// errors.
    pub(super) fn negative_texels(&mut self) {
        if self.found.iter().any(|d| d.severity == Severity::Error) {
            return;
        }
        let scene = self.scene;
        let is_displacement = |m: &&MaterialDesc| matches!(m, MaterialDesc::BumpMap { .. });
        let of_materials =
            scene.materials.iter().filter(|m| !is_displacement(m)).flat_map(MaterialDesc::textures);
        let shapes = scene.shapes.iter().chain(scene.groups.iter().flat_map(|group| &group.shapes));
        let of_shapes =
            shapes.filter_map(|shape| shape.emission.and_then(|e| Option::<TextureId>::from(e.radiance)));
        let of_lights = scene.lights.iter().filter_map(|light| match light {
            LightDesc::Spot { texture, .. } => *texture,
            LightDesc::Projector { irradiance, .. } => (*irradiance).into(),
            _ => None,
        });
        let mut open: Vec<TextureId> = of_materials.chain(of_shapes).chain(of_lights).collect();
        let mut seen = HashSet::new();
        let mut images = HashSet::new();
        while let Some(id) = open.pop() {
            if !seen.insert(id) {
                continue;
            }
            let texture = &scene.textures[id.0 as usize];
            open.extend(texture.textures());
            let TextureDesc::Bitmap { image, span, .. } = texture else { continue };
            let image = &scene.images[*image as usize];
            let Pixels::F32 { data, .. } = &image.pixels else { continue };
            if !images.insert(std::sync::Arc::as_ptr(image)) {
                continue;
            }
            let negative = data.iter().filter(|v| **v < 0.0).count();
            if negative > 0 {
                let message = format!("{negative} values of {} are negative", image.name);
                self.found.push(
                    Diagnostic::warning("scene::bad-texels", span, message)
                        .consequence("where colors are wanted they are black"),
                );
            }
        }
    }

    fn texture_transform(&mut self, to_uv: &Affine2, span: &Span) {
        let numbers = to_uv.to_cols_array();
        if !numbers.iter().all(|x| x.abs() <= MAX_TILES) {
            let message =
                format!("a transform of texture coordinates with numbers that are not within ±{MAX_TILES:e}");
            self.error("scene::bad-transform", span, message);
        } else if to_uv.matrix2.determinant() == 0.0 {
            let message = "a transform of texture coordinates that is not invertible";
            self.found.push(
                Diagnostic::warning("scene::bad-transform", span, message)
                    .consequence("one line or one point of the texture is seen everywhere"),
            );
        }
    }
}
