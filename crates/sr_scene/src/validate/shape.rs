//! Shapes: ids, extent, and the arrays of meshes.

use super::Check;
use crate::{Emission, Geometry, ShapeDesc};

impl Check<'_> {
    pub(super) fn shape(&mut self, shape: &ShapeDesc) {
        let span = &shape.span;
        let said_before = self.found.len();
        if shape.material.0 as usize >= self.scene.materials.len() {
            self.error("scene::bad-id", span, format!("there is no material {}", shape.material.0));
        }
        if let Some(Emission { radiance }) = &shape.emission {
            self.color_input(radiance, "radiance", span);
            if self.has_mesh_color(radiance) {
                self.error(
                    "scene::emitting-mesh-color",
                    span,
                    "the colors of a mesh cannot be those of a light",
                );
            }
        }
        match &shape.geometry {
            Geometry::Sphere { center, radius, frame, .. } => {
                if !(*radius > 0.0 && radius.is_finite() && center.is_finite() && frame.is_finite()) {
                    self.error("scene::sphere", span, format!("a sphere of radius {radius} at {center}"));
                }
            }
            Geometry::Disk { center, u_axis, v_axis, .. } => {
                let area = u_axis.as_dvec3().cross(v_axis.as_dvec3()).length();
                if !(area > 0.0 && area.is_finite() && center.is_finite()) {
                    self.error("scene::disk", span, "a disk without area");
                }
            }
            Geometry::Cylinder { base, frame, radius, length, .. } => {
                let is_finite = base.is_finite() && frame.is_finite() && (radius + length).is_finite();
                if !(*radius > 0.0 && *length > 0.0 && is_finite) {
                    let message = format!("a cylinder of radius {radius} and length {length}");
                    self.error("scene::cylinder", span, message);
                }
            }
            Geometry::Patch { corners, .. } => {
                let [p00, p10, p01, p11] = corners.map(|p| p.as_dvec3());
                let area = (p11 - p00).cross(p01 - p10).length() + (p10 - p00).cross(p01 - p00).length();
                if !(area > 0.0 && corners.iter().all(|p| p.is_finite())) {
                    self.error("scene::patch", span, "a bilinear patch without area");
                }
                if shape.emission.is_some() {
                    self.error("scene::emitting-patch", span, "a bilinear patch cannot emit");
                }
            }
            Geometry::Curves(curves) => {
                if let Some(fault) = curves.fault() {
                    self.error("scene::curves", span, format!("{}: {fault}", curves.name));
                }
                if shape.emission.is_some() {
                    self.error("scene::emitting-curves", span, "curves cannot emit");
                }
            }
            Geometry::Mesh(mesh) => {
                let n = mesh.positions.len();
                let fits = |len: usize, count: usize| len == 0 || len == count;
                if !(fits(mesh.normals.len(), n)
                    && fits(mesh.uvs.len(), n)
                    && mesh.further_uvs.iter().all(|set| fits(set.len(), n))
                    && fits(mesh.vertex_colors.len(), n)
                    && fits(mesh.face_colors.len(), mesh.triangles.len()))
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
        if self.found.len() == said_before {
            self.extent(shape);
        }
    }
}
