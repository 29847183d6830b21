//! Colours of meshes: what asks for them has to be on a mesh that has them.

use std::collections::HashSet;

use super::Check;
use crate::diagnostic::{Diagnostic, Severity};
use crate::{ColorInput, Geometry, MeshColorOf, SceneDesc, TextureDesc, TextureId};

/// Which colours of its mesh something asks for.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct Asked {
    vertices: bool,
    faces: bool,
}

impl Asked {
    const NOTHING: Asked = Asked { vertices: false, faces: false };

    fn and(self, other: Self) -> Self {
        Self { vertices: self.vertices || other.vertices, faces: self.faces || other.faces }
    }

    /// For each texture, what it asks for, itself or through others, all of which come before it.
    pub fn by_textures(scene: &SceneDesc) -> Vec<Asked> {
        let mut asked: Vec<Asked> = Vec::new();
        for texture in &scene.textures {
            let own = match texture {
                TextureDesc::MeshColor { of, .. } => {
                    Asked { vertices: *of == MeshColorOf::Vertices, faces: *of == MeshColorOf::Faces }
                }
                _ => Asked::NOTHING,
            };
            asked.push(of_textures(&asked, texture.textures()).and(own));
        }
        asked
    }
}

fn of_textures(asked: &[Asked], textures: Vec<TextureId>) -> Asked {
    let known = textures.into_iter().filter_map(|id| asked.get(id.0 as usize).copied());
    known.fold(Asked::NOTHING, Asked::and)
}

impl Check<'_> {
    /// Is a mesh's colour in this input? It needs a mesh, which lights are not.
    pub(super) fn has_mesh_color(&self, input: &ColorInput) -> bool {
        of_textures(&self.asked, Option::from(*input).into_iter().collect()) != Asked::NOTHING
    }

    /// Shapes whose materials ask for colours that they do not have: said once for each material of a scene that has
    /// no errors.
    pub(super) fn missing_mesh_colors(&mut self) {
        if !self.asked.contains(&Asked { vertices: true, faces: false })
            && !self.asked.contains(&Asked { vertices: false, faces: true })
            || self.found.iter().any(|d| d.severity == Severity::Error)
        {
            return;
        }
        let scene = self.scene;
        let own: Vec<Asked> =
            scene.materials.iter().map(|material| of_textures(&self.asked, material.textures())).collect();
        let mut said = HashSet::new();
        for shape in scene.shapes.iter().chain(scene.groups.iter().flat_map(|group| &group.shapes)) {
            let mut asked = Asked::NOTHING;
            let mut open = vec![shape.material];
            while let Some(id) = open.pop() {
                asked = asked.and(own[id.0 as usize]);
                open.extend(scene.materials[id.0 as usize].materials());
            }
            let has = match &shape.geometry {
                Geometry::Mesh(mesh) => {
                    Asked { vertices: !mesh.vertex_colors.is_empty(), faces: !mesh.face_colors.is_empty() }
                }
                _ => Asked::NOTHING,
            };
            let missing = match (asked.vertices && !has.vertices, asked.faces && !has.faces) {
                (true, _) => "vertices",
                (_, true) => "faces",
                _ => continue,
            };
            if said.insert(shape.material) {
                let message =
                    format!("the material asks for colors of {missing}, which the shape does not have");
                self.found.push(
                    Diagnostic::warning("scene::no-mesh-color", &shape.span, message)
                        .consequence("they are 0.5 on it"),
                );
            }
        }
    }
}
