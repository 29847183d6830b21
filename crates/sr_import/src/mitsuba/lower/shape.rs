//! Shapes: what they are made of, what they emit, and where their meshes come from.

use std::collections::HashSet;
use std::sync::Arc;

use sr_scene::{Diagnostic, Emission, Geometry, Rgb, ShapeDesc};

use super::color::Role;
use super::material::{GREY, diffuse};
use super::{Lowering, key};
use crate::assembly::MeshSource;
use crate::mesh::{Convention, Format, Placement, Scheme, Subdivision, primitives};
use crate::mitsuba::node::{Node, Value};
use crate::mitsuba::props::Props;

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
            "merge" => {
                for shape in self.merged(node) {
                    self.top_level_shape(shape);
                }
            }
            _ => {
                if let Some((shape, pending)) = self.shape(node) {
                    self.out.add_shape(shape, pending);
                }
            }
        }
    }

    /// The shapes inside a `merge`, and inside those inside it.
    pub(super) fn merged(&mut self, node: &'a Node) -> Vec<&'a Node> {
        let mut shapes = Vec::new();
        let mut open = vec![node];
        // Each is gone through once: one that contains itself ends.
        let mut seen = HashSet::new();
        while let Some(node) = open.pop() {
            if node.kind != "merge" {
                shapes.push(node);
            } else if seen.insert(key(node)) {
                let mut props = Props::new(node);
                open.extend(self.nested(&mut props, "shape").into_iter().rev());
                props.finish(self.out.d);
            }
        }
        shapes
    }

    pub(super) fn shape(&mut self, node: &'a Node) -> Option<(ShapeDesc, Option<(MeshSource, Placement)>)> {
        let mut props = Props::new(node);
        let Some(form) = self.form(node, &mut props) else {
            props.use_all();
            return None;
        };
        props.ignore(&["silhouette_sampling_weight"]);
        let material = match self.nested(&mut props, "bsdf")[..] {
            [] => None,
            [one] => Some(self.material(one)),
            [first, second, ..] => {
                let message = format!("{} has more than one BSDF", node.title());
                self.out.d.push(
                    Diagnostic::warning("mitsuba::wrong-nesting", &second.span, message)
                        .consequence("the first one is used"),
                );
                Some(self.material(first))
            }
        };
        let mut emission = self.emission(&mut props);
        if emission.is_some()
            && let Some((code, message)) = no_light(&node.kind)
        {
            let warning = Diagnostic::warning(code, &node.span, message);
            self.out.d.push(warning.consequence("it is rendered without its emitter"));
            emission = None;
        }
        for name in ["interior", "exterior"] {
            if let Some(child) = props.child(name)
                && let Some(medium) = self.resolve(child)
                && matches!(child, crate::mitsuba::node::Child::Node(_))
            {
                self.warn_medium(medium);
            }
        }
        for class in ["subsurface", "sensor"] {
            for inner in self.nested(&mut props, class) {
                self.unknown_plugin(inner, "the shape is rendered without it");
            }
        }
        props.finish(self.out.d);
        // As in Mitsuba, a light that is given no material reflects nothing.
        let by_default = if emission.is_some() { Rgb::ZERO } else { GREY };
        let material = material.unwrap_or_else(|| self.out.add_material(diffuse(by_default), &node.span));
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
            self.out.d.push(
                Diagnostic::warning(
                    "mitsuba::wrong-nesting",
                    &second.span,
                    "a shape has more than one emitter",
                )
                .consequence("the first one is used"),
            );
        }
        if emitter.kind != "area" {
            self.unknown_plugin(emitter, "the shape does not emit");
            return None;
        }
        let mut props = Props::new(emitter);
        props.ignore(&["sampling_weight"]);
        let radiance = self.color(&mut props, "radiance", Rgb::ONE, Role::Emission);
        props.finish(self.out.d);
        Some(Emission { radiance })
    }

    fn form(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<Form> {
        match node.kind.as_str() {
            "sphere" => Some(Form::Ready(self.sphere(node, props))),
            "disk" => Some(Form::Ready(self.disk(node, props))),
            "cylinder" => Some(Form::Ready(self.cylinder(node, props))),
            "bilinearpatch" => Some(Form::Ready(self.patch(props))),
            "linearcurve" | "bsplinecurve" => self.curves(node, props).map(Form::Ready),
            "rectangle" => {
                // Its front stays the front under mirrors: Mitsuba's shading frame, which decides, is that of +Z placed.
                let placement =
                    Placement { flat: true, convention: Convention::Flat, ..self.placement(props) };
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
                        self.out.d.push(Diagnostic::error("mitsuba::missing-property", &node.span, message));
                        None
                    }
                }
            }
            "obj" | "ply" | "serialized" => self.mesh_file(node, props),
            "shapegroup" | "instance" => {
                let message = format!("{} cannot be inside a group", node.title());
                self.out.d.push(Diagnostic::error("mitsuba::wrong-nesting", &node.span, message));
                None
            }
            _ => {
                self.unknown_plugin(node, "the shape is left out");
                None
            }
        }
    }

    fn mesh_file(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<Form> {
        let placement = self.placement(props);
        let flip = props.boolean("flip_tex_coords", self.out.d);
        props.unsupported(&["shape_name"], "all that the file holds is shown", self.out.d);
        props.ignore(&["load_materials", "srgb", "vertex_color"]);
        let (format, flip_v) = match node.kind.as_str() {
            // OBJ counts v from the bottom row of an image, and says so in no file.
            "obj" => (Format::Obj, flip.unwrap_or(true)),
            "ply" => (Format::Ply, flip.unwrap_or(false)),
            _ => {
                let index = props.integer("shape_index", self.out.d).unwrap_or(0);
                let Ok(index) = u32::try_from(index) else {
                    let message = format!("a shape index of {index}");
                    self.out.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                    return None;
                };
                (Format::Serialized { index }, flip.unwrap_or(false))
            }
        };
        let Some((name, _)) = props.string("filename", self.out.d) else {
            let message = format!("{} needs a \"filename\"", node.title());
            self.out.d.push(Diagnostic::error("mitsuba::missing-property", &node.span, message));
            return None;
        };
        let path = self.out.find(name);
        Some(Form::Mesh(MeshSource::File { path, format, flip_v }, placement))
    }

    fn placement(&mut self, props: &mut Props<'a>) -> Placement {
        let subdivision = self.subdivision(props);
        Placement {
            subdivision,
            to_world: props.transform("to_world", self.out.d),
            face_normals: props.boolean("face_normals", self.out.d).unwrap_or(false),
            flip_normals: props.boolean("flip_normals", self.out.d).unwrap_or(false),
            max_smooth_angle: self.max_smooth_angle(props),
            flat: false,
            convention: Convention::Mitsuba,
            // Known when all textures are.
            colors: false,
        }
    }

    /// In radians.
    fn max_smooth_angle(&mut self, props: &mut Props<'a>) -> Option<f32> {
        let angle = props.float("max_smooth_angle", self.out.d)?;
        if !(0.0..=180.0).contains(&angle) {
            let message = format!("\"max_smooth_angle\" is {angle}°; 0° to 180° is possible");
            self.out.d.push(
                Diagnostic::warning("mitsuba::bad-value", &props.node.span, message)
                    .consequence("the normals stay as they are"),
            );
            return None;
        }
        Some(angle.to_radians())
    }

    /// `subdivide`, how often, and `scheme`: of our own.
    fn subdivision(&mut self, props: &mut Props<'a>) -> Option<Subdivision> {
        let levels = self.count(props, props.node, "subdivide", 0);
        let scheme = match props.string("scheme", self.out.d) {
            None | Some(("loop", _)) => Scheme::Loop,
            Some(("catmull_clark", _)) => Scheme::CatmullClark,
            Some((other, span)) => {
                self.unknown_word("scheme", other, &["loop", "catmull_clark"], "loop", span);
                Scheme::Loop
            }
        };
        (levels > 0).then_some(Subdivision { scheme, levels })
    }
}

/// What is said of a shape that cannot emit.
fn no_light(kind: &str) -> Option<(&'static str, &'static str)> {
    match kind {
        "bilinearpatch" => Some(("mitsuba::emitting-patch", "a bilinear patch cannot emit")),
        "linearcurve" | "bsplinecurve" => Some(("mitsuba::emitting-curves", "curves cannot emit")),
        _ => None,
    }
}
