//! Emitters that are not shapes.

use std::sync::Arc;

use glam::{DMat4, DVec3};
use sr_scene::{ColorInput, Diagnostic, LightDesc, Portal, Rgb, SphereMapping, SpotFalloff};

use super::Lowering;
use super::color::Role;
use crate::images::Decode;
use crate::limits::Limit;
use crate::mitsuba::node::Node;
use crate::mitsuba::props::Props;
use crate::{files, ies};

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
                if props.has("position") && props.has("to_world") {
                    let message = format!("{} has both \"position\" and \"to_world\"", node.title());
                    self.out.d.push(
                        Diagnostic::warning("mitsuba::conflict", &node.span, message)
                            .consequence("\"position\" is used, as it is"),
                    );
                }
                let to_world = props.transform("to_world", self.out.d);
                let position = props.vector("position", self.out.d);
                let position = position.unwrap_or_else(|| to_world.transform_point3(DVec3::ZERO)).as_vec3();
                let intensity = self.constant_color(&mut props, "intensity", Rgb::ONE, Role::Emission);
                Some(LightDesc::Point { position, intensity, range: f32::INFINITY, span })
            }
            "directional" => {
                let to_world = props.transform("to_world", self.out.d);
                let direction = props.vector("direction", self.out.d);
                let direction = direction.unwrap_or_else(|| to_world.transform_vector3(DVec3::Z));
                let irradiance = self.constant_color(&mut props, "irradiance", Rgb::ONE, Role::Emission);
                match direction.try_normalize() {
                    Some(direction) => {
                        Some(LightDesc::Directional { direction: direction.as_vec3(), irradiance, span })
                    }
                    None => {
                        let message = "the direction of a directional emitter cannot be zero";
                        self.out.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                        None
                    }
                }
            }
            "spot" => {
                let world_from_light = props.transform("to_world", self.out.d).as_mat4();
                let intensity = self.constant_color(&mut props, "intensity", Rgb::ONE, Role::Emission);
                let cutoff = props.float("cutoff_angle", self.out.d).unwrap_or(20.0);
                let beam = props.float("beam_width", self.out.d).unwrap_or(cutoff * 0.75);
                let (texture, intensity) = match self.color_if_given(&mut props, "texture", Role::Factor) {
                    Some(ColorInput::Texture(id)) => (Some(id), intensity),
                    Some(ColorInput::Constant(color)) => (None, intensity * color),
                    None => (None, intensity),
                };
                let (cutoff_angle, beam_width) = (cutoff.to_radians(), beam.to_radians());
                let (falloff, range) = (SpotFalloff::Linear, f32::INFINITY);
                Some(LightDesc::Spot {
                    world_from_light,
                    intensity,
                    cutoff_angle,
                    beam_width,
                    falloff,
                    range,
                    texture,
                    span,
                })
            }
            "projector" => {
                let world_from_light = props.transform("to_world", self.out.d).as_mat4();
                let irradiance = self.color(&mut props, "irradiance", Rgb::ONE, Role::Emission);
                let scale = props.float("scale", self.out.d).unwrap_or(1.0);
                let (fov_axis, fov) = self.field_of_view(node, &mut props, true);
                Some(LightDesc::Projector { world_from_light, irradiance, scale, fov_axis, fov, span })
            }
            "goniometric" => self.goniometric(node, &mut props),
            "ies" => self.profile(node, &mut props),
            "sunsky" | "sky" | "sun" => {
                let lights = self.sunsky(node, &mut props);
                self.out.lights.extend(lights);
                None
            }
            _ => {
                self.unknown_plugin(node, "this light is left out, and the picture is darker");
                props.use_all();
                None
            }
        };
        props.finish(self.out.d);
        self.out.lights.extend(light);
    }

    fn environment(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<LightDesc> {
        let scale = props.float("scale", self.out.d).unwrap_or(1.0);
        let to_world = props.transform("to_world", self.out.d);
        let mis_compensation = props.boolean("mis_compensation", self.out.d).unwrap_or(false);
        props.ignore(&["cache"]);
        props.unsupported(&["gamma"], "8-bit values are read as sRGB", self.out.d);
        let mapping = self.sphere_mapping(props);
        let portals = self.portals(props);
        let rotation = self.rotation_of(to_world, "an environment", node);
        let image = self.image_of(props, Decode::Linear)?;
        Some(LightDesc::Environment {
            image,
            mapping,
            scale,
            world_from_light: rotation?.as_mat3(),
            mis_compensation,
            portals,
            span: node.span.clone(),
        })
    }

    fn sphere_mapping(&mut self, props: &mut Props<'a>) -> SphereMapping {
        match props.string("mapping", self.out.d) {
            None | Some(("latlong", _)) => SphereMapping::LatLong,
            Some(("octahedral", _)) => SphereMapping::EqualAreaOctahedral,
            Some((other, span)) => {
                self.unknown_word("mapping", other, &["latlong", "octahedral"], "latlong", span);
                SphereMapping::LatLong
            }
        }
    }

    /// Rectangles inside an environment, whose normals point into the scene.
    fn portals(&mut self, props: &mut Props<'a>) -> Vec<Portal> {
        let mut portals = Vec::new();
        for node in self.nested(props, "shape") {
            if node.kind != "rectangle" {
                self.unknown_plugin(node, "this portal is left out, and the picture is noisier");
                continue;
            }
            let mut props = Props::new(node);
            let m = props.transform("to_world", self.out.d);
            let corner = m.transform_point3(DVec3::new(-1.0, -1.0, 0.0)).as_vec3();
            let edge = |m: DMat4, v: DVec3| m.transform_vector3(2.0 * v).as_vec3();
            let mut edges = [edge(m, DVec3::X), edge(m, DVec3::Y)];
            if props.boolean("flip_normals", self.out.d).unwrap_or(false) {
                edges.swap(0, 1);
            }
            props.finish(self.out.d);
            portals.push(Portal { corner, edges });
        }
        portals
    }

    fn goniometric(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<LightDesc> {
        let world_from_light = props.transform("to_world", self.out.d).as_mat4();
        let intensity = self.constant_color(props, "intensity", Rgb::ONE, Role::Emission);
        let mapping = self.sphere_mapping(props);
        let image = self.image_of(props, Decode::Linear)?;
        Some(LightDesc::Goniometric { world_from_light, intensity, image, mapping, span: node.span.clone() })
    }

    fn profile(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<LightDesc> {
        let world_from_light = props.transform("to_world", self.out.d).as_mat4();
        let intensity = self.constant_color(props, "intensity", Rgb::ONE, Role::Emission);
        let Some((name, span)) = props.string("filename", self.out.d) else {
            let message = format!("{} needs a \"filename\"", node.title());
            self.out.d.push(Diagnostic::error("mitsuba::missing-property", &node.span, message));
            return None;
        };
        let path = self.out.find(name);
        let read = files::read(&path, Limit::fixed(ies::MAX_BYTES))
            .and_then(|b| ies::parse(&path.display().to_string(), &b));
        match read {
            Ok(profile) => Some(LightDesc::Profile {
                world_from_light,
                intensity,
                profile: Arc::new(profile),
                span: node.span.clone(),
            }),
            Err(reason) => {
                let error = files::error("mitsuba::bad-profile", span, "IES profile", &path, &reason);
                self.out.d.push(error);
                None
            }
        }
    }
}
