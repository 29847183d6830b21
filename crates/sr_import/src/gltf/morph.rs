//! Morph targets: what is added to a mesh, by the weights that the file begins with.

use glam::Vec3;
use sr_scene::MeshDesc;

use super::document::Document;
use super::json::Value;

impl Document<'_, '_> {
    /// Adds each target's displacements, weighted.
    pub fn morph(&mut self, targets: &[Value], weights: Option<&Value>, mesh: &mut MeshDesc) {
        let weights = weights.map_or(&[][..], Value::list);
        for (target, weight) in targets.iter().zip(weights) {
            let weight = weight.number().unwrap_or(0.0) as f32;
            if weight == 0.0 {
                continue;
            }
            for (name, accessor) in target.members() {
                let moved = match name.as_str() {
                    "POSITION" => &mut mesh.positions,
                    "NORMAL" => &mut mesh.normals,
                    // Tangents are worked out from the coordinates.
                    "TANGENT" => continue,
                    _ => {
                        let message = "only positions and normals are moved by morph targets";
                        self.warn_once("gltf::morph", &accessor.span, message, "the rest stays");
                        continue;
                    }
                };
                let Some(rows) = self.rows(accessor, &[3]) else { continue };
                for (value, by) in moved.iter_mut().zip(rows.of(0.0)) {
                    *value += weight * Vec3::from_array(by);
                }
            }
        }
    }
}
