//! PLY: one shape, with the colors of its vertices or its faces.

use std::sync::Arc;

use glam::Vec3;
use sr_scene::{ColorInput, MeshColorOf, TextureDesc};

use super::{GREY, MeshScene, as_it_is};
use crate::mesh::{self, Format};
use crate::values::srgb_to_linear;

impl MeshScene<'_, '_> {
    pub(super) fn ply(&mut self) -> Result<(), String> {
        let mut mesh =
            Arc::unwrap_or_clone(mesh::load(self.path, Format::Ply, false, &self.out.limits)?.mesh);
        let of = match (mesh.vertex_colors.is_empty(), mesh.face_colors.is_empty()) {
            (false, _) => Some(MeshColorOf::Vertices),
            (true, false) => Some(MeshColorOf::Faces),
            (true, true) => None,
        };
        let reflectance = match of {
            Some(of) => {
                self.out.add_texture(TextureDesc::MeshColor { of, scale: 1.0, span: self.span.clone() })
            }
            None => ColorInput::Constant(GREY),
        };
        // Scanners write what a screen shows.
        mesh.vertex_colors.iter_mut().chain(&mut mesh.face_colors).for_each(|color| *color = decoded(*color));
        let material = self.diffuse(reflectance);
        self.add(mesh, material, None, as_it_is());
        Ok(())
    }
}

/// A reflectance, from an sRGB-encoded color; what is no color stays, to be refused with its mesh.
fn decoded(color: Vec3) -> Vec3 {
    Vec3::from_array(color.to_array().map(|v| srgb_to_linear(f64::from(v).min(1.0)) as f32))
}
