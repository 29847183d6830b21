//! Skins: vertices that follow the nodes that hold them.

use std::collections::HashMap;

use glam::{DMat3, DMat4};
use sr_scene::MeshDesc;

use super::document::Document;
use super::draco::Unpacked;
use super::json::Value;

impl Document<'_, '_> {
    /// Where each joint of a skin puts what it holds, in world space.
    pub fn joints(&mut self, skin: &Value, worlds: &HashMap<usize, DMat4>) -> Vec<DMat4> {
        let inverse = skin.get("inverseBindMatrices").and_then(|accessor| self.rows(accessor, &[16]));
        let joints = skin.get("joints").map_or(&[][..], Value::list);
        let mut out = Vec::with_capacity(joints.len());
        for (at, joint) in joints.iter().enumerate() {
            let world = joint.index().and_then(|node| worlds.get(&node)).copied();
            let world = world.unwrap_or_else(|| {
                let message = "a joint is no node of the scene";
                self.warn_once("gltf::joint", &joint.span, message, "it stays where it was bound");
                DMat4::IDENTITY
            });
            let bind = inverse.as_ref().and_then(|rows| rows.iter().nth(at));
            let bind = bind.and_then(|row| row.try_into().ok());
            out.push(world * bind.map_or(DMat4::IDENTITY, |m| DMat4::from_cols_array(&m)));
        }
        out
    }

    /// Moves every vertex by the joints that hold it.
    pub fn skin(
        &mut self,
        attributes: &Value,
        packed: Option<&Unpacked>,
        joints: &[DMat4],
        mesh: &mut MeshDesc,
    ) {
        let mut sums = vec![DMat4::ZERO; mesh.positions.len()];
        let mut set = 0;
        loop {
            let names = (format!("JOINTS_{set}"), format!("WEIGHTS_{set}"));
            let (Some(indices), Some(weights)) = (attributes.get(&names.0), attributes.get(&names.1)) else {
                break;
            };
            let (Some(rows), Some(weights)) = (
                self.attribute(packed, &names.0, indices, &[4]),
                self.attribute(packed, &names.1, weights, &[4]),
            ) else {
                return;
            };
            for ((sum, held), weights) in sums.iter_mut().zip(rows.iter()).zip(weights.iter()) {
                for (&joint, &weight) in held.iter().zip(weights) {
                    match joints.get(joint as usize) {
                        Some(&matrix) => *sum += weight * matrix,
                        None if weight == 0.0 => {}
                        None => {
                            let message = format!("joint {joint} is none of the skin's {}", joints.len());
                            self.error("gltf::bad-index", &indices.span, message);
                            return;
                        }
                    }
                }
            }
            set += 1;
        }
        for (at, sum) in sums.iter().enumerate() {
            // Weights should add up to 1; what nothing holds stays where it is.
            let total = sum.w_axis.w;
            if total.abs() < 1e-12 {
                continue;
            }
            let matrix = *sum * (1.0 / total);
            mesh.positions[at] = matrix.transform_point3(mesh.positions[at].as_dvec3()).as_vec3();
            if let Some(normal) = mesh.normals.get_mut(at) {
                let linear = DMat3::from_mat4(matrix);
                let turned = linear.inverse().transpose() * normal.as_dvec3();
                *normal = turned.normalize_or_zero().as_vec3();
            }
        }
    }
}
