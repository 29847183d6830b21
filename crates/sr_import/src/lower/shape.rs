//! Shapes, groups of shapes, and instances of groups.

use std::sync::Arc;

use glam::{Affine3A, DMat3, DVec3};
use sr_scene::{Diagnostic, Emission, Geometry, GroupDesc, InstanceDesc, Rgb, ShapeDesc};

use super::color::Role;
use super::jobs::{MeshSource, PendingMesh, ShapeSlot};
use super::{Lowering, key};
use crate::files;
use crate::mesh::{Format, Placement, primitives};
use crate::node::{Node, Value};
use crate::props::Props;

const KNOWN: &[&str] =
    &["obj", "ply", "serialized", "mesh", "rectangle", "cube", "sphere", "disk", "shapegroup", "instance"];

/// A shape's form, known or still to be read.
enum Form {
    Ready(Geometry),
    Mesh(MeshSource, Placement),
}

impl<'a> Lowering<'a, '_> {
    /// A shape of the scene itself.
    pub(super) fn top_level_shape(&mut self, node: &'a Node) {
        match node.kind.as_str() {
            // Shown where an instance asks for it.
            "shapegroup" => {
                self.group(node);
            }
            "instance" => self.instance(node),
            _ => {
                if let Some((shape, pending)) = self.shape(node) {
                    let slot = ShapeSlot::Scene(self.shapes.len());
                    self.shapes.push(shape);
                    self.add_pending(pending, slot, node);
                }
            }
        }
    }

    fn add_pending(&mut self, pending: Option<(MeshSource, Placement)>, shape: ShapeSlot, node: &Node) {
        if let Some((source, placement)) = pending {
            self.meshes.push(PendingMesh { shape, source, placement, span: node.span.clone() });
        }
    }

    fn shape(&mut self, node: &'a Node) -> Option<(ShapeDesc, Option<(MeshSource, Placement)>)> {
        let mut props = Props::new(node);
        let Some(form) = self.form(node, &mut props) else {
            props.use_all();
            return None;
        };
        props.ignore(&["silhouette_sampling_weight"]);
        let material = match self.nested(&mut props, "bsdf")[..] {
            [] => self.default_material(node),
            [one] => self.material(one),
            [first, second, ..] => {
                let message = format!("{} has more than one BSDF", node.title());
                self.d.push(
                    Diagnostic::warning("mitsuba::wrong-nesting", &second.span, message)
                        .consequence("the first one is used"),
                );
                self.material(first)
            }
        };
        let emission = self.emission(&mut props);
        for name in ["interior", "exterior"] {
            if let Some(child) = props.child(name)
                && let Some(medium) = self.resolve(child)
                && matches!(child, crate::node::Child::Node(_))
            {
                self.warn_medium(medium);
            }
        }
        for class in ["subsurface", "sensor"] {
            for inner in self.nested(&mut props, class) {
                self.unknown_plugin(inner, &[], "the shape is rendered without it");
            }
        }
        props.finish(self.d);
        let (geometry, pending) = match form {
            Form::Ready(geometry) => (geometry, None),
            Form::Mesh(source, placement) => (Geometry::Mesh(Arc::default()), Some((source, placement))),
        };
        Some((ShapeDesc { geometry, material, emission, span: node.span.clone() }, pending))
    }

    fn emission(&mut self, props: &mut Props<'a>) -> Option<Emission> {
        let emitters = self.nested(props, "emitter");
        let (&emitter, more) = emitters.split_first()?;
        if let Some(second) = more.first() {
            self.d.push(
                Diagnostic::warning(
                    "mitsuba::wrong-nesting",
                    &second.span,
                    "a shape has more than one emitter",
                )
                .consequence("the first one is used"),
            );
        }
        if emitter.kind != "area" {
            self.unknown_plugin(emitter, &["area"], "the shape does not emit");
            return None;
        }
        let mut props = Props::new(emitter);
        props.ignore(&["sampling_weight"]);
        let radiance = self.color(&mut props, "radiance", Rgb::ONE, Role::Emission);
        props.finish(self.d);
        Some(Emission { radiance })
    }

    fn form(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<Form> {
        match node.kind.as_str() {
            "sphere" => Some(self.sphere(node, props)),
            "disk" => Some(self.disk(node, props)),
            "rectangle" => {
                let placement = Placement { flat: true, ..self.placement(props) };
                Some(Form::Mesh(MeshSource::Memory(Arc::new(primitives::rectangle())), placement))
            }
            "cube" => {
                let placement = Placement { flat: true, ..self.placement(props) };
                Some(Form::Mesh(MeshSource::Memory(Arc::new(primitives::cube())), placement))
            }
            "mesh" => {
                let placement = self.placement(props);
                let property = props.get("mesh");
                match property.map(|p| &p.value) {
                    Some(Value::Mesh(mesh)) => Some(Form::Mesh(MeshSource::Memory(mesh.clone()), placement)),
                    _ => {
                        let message = format!("{} needs a \"mesh\" in memory", node.title());
                        self.d.push(Diagnostic::error("mitsuba::missing-property", &node.span, message));
                        None
                    }
                }
            }
            "obj" | "ply" | "serialized" => self.mesh_file(node, props),
            "shapegroup" | "instance" => {
                let message = format!("{} cannot be inside a group", node.title());
                self.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
                None
            }
            _ => {
                self.unknown_plugin(node, KNOWN, "the shape is left out");
                None
            }
        }
    }

    fn mesh_file(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<Form> {
        let placement = self.placement(props);
        let flip = props.boolean("flip_tex_coords", self.d);
        props.ignore(&["load_materials", "shape_name", "srgb", "vertex_color"]);
        let (format, flip_v) = match node.kind.as_str() {
            // OBJ counts v from the bottom row of an image, and says so in no file.
            "obj" => (Format::Obj, flip.unwrap_or(true)),
            "ply" => (Format::Ply, flip.unwrap_or(false)),
            _ => {
                let index = props.integer("shape_index", self.d).unwrap_or(0);
                let Ok(index) = u32::try_from(index) else {
                    let message = format!("a shape index of {index}");
                    self.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                    return None;
                };
                (Format::Serialized { index }, flip.unwrap_or(false))
            }
        };
        let Some((name, _)) = props.string("filename", self.d) else {
            let message = format!("{} needs a \"filename\"", node.title());
            self.d.push(Diagnostic::error("mitsuba::missing-property", &node.span, message));
            return None;
        };
        let path = files::find(name, &self.origin.directories);
        Some(Form::Mesh(MeshSource::File { path, format, flip_v }, placement))
    }

    fn placement(&mut self, props: &mut Props<'a>) -> Placement {
        Placement {
            to_world: props.transform("to_world", self.d),
            face_normals: props.boolean("face_normals", self.d).unwrap_or(false),
            flip_normals: props.boolean("flip_normals", self.d).unwrap_or(false),
            max_smooth_angle: props.float("max_smooth_angle", self.d).map(f32::to_radians),
            flat: false,
        }
    }

    fn sphere(&mut self, node: &'a Node, props: &mut Props<'a>) -> Form {
        let center = props.vector("center", self.d).unwrap_or(DVec3::ZERO);
        let radius = f64::from(props.float("radius", self.d).unwrap_or(1.0));
        let to_world = props.transform("to_world", self.d);
        let flip_normals = props.boolean("flip_normals", self.d).unwrap_or(false);
        let linear = DMat3::from_mat4(to_world);
        let scale = linear.x_axis.length();
        let frame = DMat3::from_cols(linear.x_axis / scale, linear.y_axis / scale, linear.z_axis / scale);
        if !is_orthonormal(frame) {
            self.d.push(
                Diagnostic::warning(
                    "mitsuba::sphere-transform",
                    &node.span,
                    "the transform of a sphere is not a similarity",
                )
                .consequence(format!("it stays a sphere, scaled by {scale} as its x-axis is")),
            );
        }
        Form::Ready(Geometry::Sphere {
            center: to_world.transform_point3(center).as_vec3(),
            radius: (radius * scale) as f32,
            frame: frame.as_mat3(),
            flip_normals: flip_normals ^ (linear.determinant() < 0.0),
        })
    }

    fn disk(&mut self, node: &'a Node, props: &mut Props<'a>) -> Form {
        let to_world = props.transform("to_world", self.d);
        let flip_normals = props.boolean("flip_normals", self.d).unwrap_or(false);
        let linear = DMat3::from_mat4(to_world);
        let (u, v) = (linear.x_axis, linear.y_axis);
        if u.dot(v).abs() > 1e-4 * u.length() * v.length() {
            self.d.push(
                Diagnostic::warning(
                    "mitsuba::disk-transform",
                    &node.span,
                    "the transform of a disk is a shear",
                )
                .consequence("it is rendered with its axes as they are, which Mitsuba does not allow"),
            );
        }
        Form::Ready(Geometry::Disk {
            center: to_world.w_axis.truncate().as_vec3(),
            u_axis: u.as_vec3(),
            v_axis: v.as_vec3(),
            flip_normals: flip_normals ^ (linear.determinant() < 0.0),
        })
    }

    fn group(&mut self, node: &'a Node) -> u32 {
        if let Some(&done) = self.groups_done.get(&key(node)) {
            return done;
        }
        let index = self.groups.len();
        self.groups.push(GroupDesc { shapes: Vec::new() });
        self.groups_done.insert(key(node), index as u32);
        let mut props = Props::new(node);
        for child in self.nested(&mut props, "shape") {
            let Some((mut shape, pending)) = self.shape(child) else { continue };
            if shape.emission.take().is_some() {
                self.d.push(
                    Diagnostic::warning(
                        "mitsuba::emitter-in-group",
                        &child.span,
                        "a shape of a group cannot emit",
                    )
                    .consequence("it is rendered without its emitter"),
                );
            }
            let slot = ShapeSlot::Group(index, self.groups[index].shapes.len());
            self.groups[index].shapes.push(shape);
            self.add_pending(pending, slot, child);
        }
        props.finish(self.d);
        index as u32
    }

    fn instance(&mut self, node: &'a Node) {
        let mut props = Props::new(node);
        let to_world = props.transform("to_world", self.d);
        let groups = self.nested(&mut props, "shape");
        props.finish(self.d);
        let [group] = groups[..] else {
            let message = format!("{} needs one shape group, not {}", node.title(), groups.len());
            self.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
            return;
        };
        if group.kind != "shapegroup" {
            let message = format!("an instance shows a shape group, not {}", group.title());
            self.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
            return;
        }
        let group = self.group(group);
        let world_from_group = Affine3A::from_mat4(to_world.as_mat4());
        self.instances.push(InstanceDesc { group, world_from_group, span: node.span.clone() });
    }
}

/// Are the columns of unit length and perpendicular, to the precision that files are written with?
pub(super) fn is_orthonormal(m: DMat3) -> bool {
    (m.transpose() * m - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-3)
}
