//! PLY: one shape, with the colors of its vertices or its faces.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use sr_scene::{ColorInput, Diagnostic, MeshColorOf, MeshDesc, TextureDesc, TextureId};

use super::mtl::Map;
use super::{GREY, MeshScene, as_it_is};
use crate::images::Decode;
use crate::mesh::{self, Format, RawMesh};
use crate::values::{shown, srgb_to_linear};

impl MeshScene<'_, '_> {
    pub(super) fn ply(&mut self) -> Result<(), String> {
        let RawMesh { mesh, textures, .. } = mesh::load(self.path, Format::Ply, false, &self.out.limits)?;
        let mut mesh = Arc::unwrap_or_clone(mesh);
        let texture = self.own_texture(&mesh, &textures);
        let of = match (mesh.vertex_colors.is_empty(), mesh.face_colors.is_empty()) {
            (false, _) => Some(MeshColorOf::Vertices),
            (true, false) => Some(MeshColorOf::Faces),
            (true, true) => None,
        };
        let reflectance = match (texture, of) {
            (Some(texture), of) => {
                if of.is_some() {
                    self.say_of_texture(
                        "it has colors and a texture",
                        "its colors are not shown: the texture is",
                    );
                }
                ColorInput::Texture(texture)
            }
            (None, Some(of)) => {
                self.out.add_texture(TextureDesc::MeshColor { of, scale: 1.0, span: self.span.clone() })
            }
            (None, None) => ColorInput::Constant(GREY),
        };
        // Scanners write what a screen shows.
        mesh.vertex_colors.iter_mut().chain(&mut mesh.face_colors).for_each(|color| *color = decoded(*color));
        let material = self.diffuse(reflectance);
        self.add(mesh, material, None, as_it_is());
        Ok(())
    }

    /// The texture that the file names for itself, if it can be shown.
    fn own_texture(&mut self, mesh: &MeshDesc, textures: &[String]) -> Option<TextureId> {
        let file = textures.first()?;
        if mesh.uvs.is_empty() {
            let message =
                format!("it names the texture {}, and its vertices have no coordinates of it", shown(file));
            self.say_of_texture(&message, "the texture is not shown");
            return None;
        }
        let file = file.replace('\\', "/");
        if !self.out.find(&file).is_file() {
            self.say_of_texture(
                &format!("there is no image {}", shown(&file)),
                "it is shown without its texture",
            );
            return None;
        }
        if let Some(second) = textures.get(1) {
            let message = format!("it names {} textures, the second is {}", textures.len(), shown(second));
            self.say_of_texture(&message, "the first one is everywhere");
        }
        let (scale, offset, span) = (Vec2::ONE, Vec2::ZERO, self.span.clone());
        self.image(&Map { file, scale, offset, clamp: false, bump: 1.0, span }, Decode::Color)
    }

    /// Something about the texture is not as the file has it.
    fn say_of_texture(&mut self, message: &str, consequence: &str) {
        let message = format!("{}: {message}", self.path.display());
        self.out.d.push(Diagnostic::warning("ply::texture", &self.span, message).consequence(consequence));
    }
}

/// A reflectance, from an sRGB-encoded color; what is no color stays, to be refused with its mesh.
fn decoded(color: Vec3) -> Vec3 {
    Vec3::from_array(color.to_array().map(|v| srgb_to_linear(f64::from(v).min(1.0)) as f32))
}
