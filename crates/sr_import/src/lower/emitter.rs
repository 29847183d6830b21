//! Emitters that are not shapes.

use glam::{DMat3, DVec3};
use sr_scene::{ColorInput, Diagnostic, LightDesc, Rgb};

use super::Lowering;
use super::color::Role;
use super::shape::is_orthonormal;
use crate::images::Decode;
use crate::node::Node;
use crate::props::Props;

const KNOWN: &[&str] = &["area", "constant", "envmap", "point", "directional", "spot"];

impl<'a> Lowering<'a, '_> {
    /// An emitter of the scene itself.
    pub(super) fn emitter(&mut self, node: &'a Node) {
        let mut props = Props::new(node);
        props.ignore(&["sampling_weight"]);
        let span = node.span.clone();
        let light = match node.kind.as_str() {
            "constant" => {
                let radiance = self.constant_color(&mut props, "radiance", Rgb::ONE, Role::Emission);
                Some(LightDesc::Constant { radiance, span })
            }
            "envmap" => self.environment(node, &mut props),
            "point" => {
                let to_world = props.transform("to_world", self.d);
                let position = props.vector("position", self.d);
                let position = position.unwrap_or_else(|| to_world.transform_point3(DVec3::ZERO)).as_vec3();
                let intensity = self.constant_color(&mut props, "intensity", Rgb::ONE, Role::Emission);
                Some(LightDesc::Point { position, intensity, span })
            }
            "directional" => {
                let to_world = props.transform("to_world", self.d);
                let direction = props.vector("direction", self.d);
                let direction = direction.unwrap_or_else(|| to_world.transform_vector3(DVec3::Z));
                let irradiance = self.constant_color(&mut props, "irradiance", Rgb::ONE, Role::Emission);
                match direction.try_normalize() {
                    Some(direction) => {
                        Some(LightDesc::Directional { direction: direction.as_vec3(), irradiance, span })
                    }
                    None => {
                        let message = "the direction of a directional emitter cannot be zero";
                        self.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                        None
                    }
                }
            }
            "spot" => {
                let world_from_light = props.transform("to_world", self.d).as_mat4();
                let intensity = self.constant_color(&mut props, "intensity", Rgb::ONE, Role::Emission);
                let cutoff = props.float("cutoff_angle", self.d).unwrap_or(20.0);
                let beam = props.float("beam_width", self.d).unwrap_or(cutoff * 0.75);
                let texture = match self.color_if_given(&mut props, "texture", Role::Factor) {
                    Some(ColorInput::Texture(id)) => Some(id),
                    Some(ColorInput::Constant(_)) | None => None,
                };
                let (cutoff_angle, beam_width) = (cutoff.to_radians(), beam.to_radians());
                Some(LightDesc::Spot { world_from_light, intensity, cutoff_angle, beam_width, texture, span })
            }
            _ => {
                self.unknown_plugin(node, KNOWN, "this light is left out, and the picture is darker");
                props.use_all();
                None
            }
        };
        props.finish(self.d);
        self.lights.extend(light);
    }

    fn environment(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<LightDesc> {
        let scale = props.float("scale", self.d).unwrap_or(1.0);
        let to_world = props.transform("to_world", self.d);
        props.ignore(&["cache", "mis_compensation"]);
        props.unsupported(&["gamma"], "8-bit values are read as sRGB", self.d);
        let linear = DMat3::from_mat4(to_world);
        let columns = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::normalize_or_zero);
        let rotation = DMat3::from_cols(columns[0], columns[1], columns[2]);
        if !is_orthonormal(rotation) {
            let message = "the transform of an environment is more than a rotation and a scale";
            self.d.push(Diagnostic::error("mitsuba::bad-transform", &node.span, message));
        }
        let image = self.image_of(props, Decode::Linear)?;
        let world_from_light = rotation.as_mat3();
        Some(LightDesc::Environment { image, scale, world_from_light, span: node.span.clone() })
    }
}
