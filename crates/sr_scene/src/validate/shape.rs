//! Shapes: ids, extent, and the arrays of meshes.

use super::Check;
use crate::{Emission, Geometry, ShapeDesc};

impl Check<'_> {
    pub(super) fn shape(&mut self, shape: &ShapeDesc) {
        let span = &shape.span;
        if shape.material.0 as usize >= self.scene.materials.len() {
            self.error("scene::bad-id", span, format!("there is no material {}", shape.material.0));
        }
        if let Some(Emission { radiance }) = &shape.emission {
            self.color_input(radiance, "radiance", span);
        }
        match &shape.geometry {
            Geometry::Sphere { center, radius, frame, .. } => {
                if !(*radius > 0.0 && radius.is_finite() && center.is_finite() && frame.is_finite()) {
                    self.error("scene::sphere", span, format!("a sphere of radius {radius} at {center}"));
                }
            }
            Geometry::Disk { center, u_axis, v_axis, .. } => {
                let area = u_axis.cross(*v_axis).length();
                if !(area > 0.0 && area.is_finite() && center.is_finite()) {
                    self.error("scene::disk", span, "a disk without area");
                }
            }
            Geometry::Mesh(mesh) => {
                let n = mesh.positions.len();
                if (!mesh.normals.is_empty() && mesh.normals.len() != n)
                    || (!mesh.uvs.is_empty() && mesh.uvs.len() != n)
                {
                    self.error(
                        "scene::mesh-arrays",
                        span,
                        format!("{}: arrays of unequal length", mesh.name),
                    );
                }
                if let Some(bad) = mesh.positions.iter().position(|p| !p.is_finite()) {
                    self.error(
                        "scene::not-finite",
                        span,
                        format!("{}: vertex {bad} is not finite", mesh.name),
                    );
                }
                if let Some(bad) = mesh.triangles.iter().position(|t| t.iter().any(|&i| i as usize >= n)) {
                    let message =
                        format!("{}: triangle {bad} uses a vertex that does not exist ({n} do)", mesh.name);
                    self.error("scene::mesh-index", span, message);
                }
            }
        }
    }
}
