//! Sensors.

use glam::{DMat4, DVec3, Vec2};
use sr_scene::{CameraDesc, Diagnostic, FovAxis, Geometry, Lens, Projection, Span};

use super::Lowering;
use super::film::default_film;
use crate::node::Node;
use crate::props::Props;
use crate::{transform, values};

const SENSORS: &[&str] = &["perspective", "thinlens", "orthographic", "spherical"];

impl<'a> Lowering<'a, '_> {
    pub(super) fn sensors(&mut self, nodes: &[&'a Node]) {
        let Some((&first, more)) = nodes.split_first() else { return };
        if let Some(second) = more.first() {
            self.d.push(
                Diagnostic::warning(
                    "mitsuba::several-sensors",
                    &second.span,
                    "the scene has more than one sensor",
                )
                .consequence("the first one is used"),
            );
        }
        self.sensor(first);
    }

    fn sensor(&mut self, node: &'a Node) {
        let mut props = Props::new(node);
        let known = SENSORS.contains(&node.kind.as_str());
        if !known {
            self.unknown_plugin(node, SENSORS, "a perspective camera at the same place is used");
        }
        let to_world = props.transform("to_world", self.d);
        let near_clip = props.float("near_clip", self.d).unwrap_or(1e-2);
        let far_clip = props.float("far_clip", self.d).unwrap_or(1e4);
        let projection = match node.kind.as_str() {
            "orthographic" => Projection::Orthographic,
            "spherical" => Projection::Spherical,
            _ => self.perspective(node, &mut props, known, far_clip),
        };
        if matches!(projection, Projection::Orthographic | Projection::Spherical) {
            // Rays that do not meet in a lens are not focused.
            props.ignore(&["focus_distance"]);
        }
        let film = self.film(&mut props);
        if let [sampler, ..] = self.nested(&mut props, "sampler")[..] {
            self.sampler(sampler);
        }
        // Nothing moves: when the shutter is open does not matter.
        props.ignore(&["shutter_open", "shutter_close"]);
        for medium in self.nested(&mut props, "medium") {
            self.warn_medium(medium);
        }
        if !known {
            props.use_all();
        }
        props.finish(self.d);
        self.camera = Some(CameraDesc {
            world_from_camera: to_world.as_mat4(),
            projection,
            near_clip,
            far_clip,
            film,
            span: node.span.clone(),
        });
    }

    fn perspective(
        &mut self,
        node: &'a Node,
        props: &mut Props<'a>,
        known: bool,
        far_clip: f32,
    ) -> Projection {
        let (fov_axis, fov) = self.field_of_view(node, props, known);
        let focus_distance = props.float("focus_distance", self.d).unwrap_or(far_clip);
        let principal_point_offset = Vec2::new(
            props.float("principal_point_offset_x", self.d).unwrap_or(0.0),
            props.float("principal_point_offset_y", self.d).unwrap_or(0.0),
        );
        let lens = (node.kind == "thinlens").then(|| Lens {
            aperture_radius: props.float("aperture_radius", self.d).unwrap_or(0.0),
            focus_distance,
            blades: self.count(props, node, "blades", 0),
            blade_rotation: props.float("blade_rotation", self.d).unwrap_or(0.0).to_radians(),
        });
        Projection::Perspective { fov_axis, fov, principal_point_offset, lens }
    }

    /// `fov` along `fov_axis`, or a `focal_length` for 36 × 24 mm film.
    pub(super) fn field_of_view(
        &mut self,
        node: &'a Node,
        props: &mut Props<'a>,
        known: bool,
    ) -> (FovAxis, f32) {
        let axis = match props.string("fov_axis", self.d) {
            None | Some(("x", _)) => FovAxis::X,
            Some(("y", _)) => FovAxis::Y,
            Some(("diagonal", _)) => FovAxis::Diagonal,
            Some(("smaller", _)) => FovAxis::Smaller,
            Some(("larger", _)) => FovAxis::Larger,
            Some((other, span)) => {
                self.unknown_word("axis", other, &["x", "y", "diagonal", "smaller", "larger"], "x", span);
                FovAxis::X
            }
        };
        let focal_length = props.string("focal_length", self.d);
        if let Some(fov) = props.float("fov", self.d) {
            return (axis, fov.to_radians());
        }
        if let Some((text, span)) = focal_length {
            match values::number(text.trim().trim_end_matches("mm")) {
                Ok(millimeters) if millimeters > 0.0 => {
                    let half_diagonal = 0.5 * 36f64.hypot(24.0);
                    return (FovAxis::Diagonal, (2.0 * (half_diagonal / millimeters).atan()) as f32);
                }
                _ => {
                    let message =
                        format!("\"{}\" is not a focal length such as \"50mm\"", values::shown(text));
                    self.d.push(Diagnostic::error("mitsuba::bad-value", span, message));
                }
            }
        } else if known {
            let message = format!("{} has neither \"fov\" nor \"focal_length\"", node.title());
            self.d.push(
                Diagnostic::warning("mitsuba::missing-property", &node.span, message)
                    .consequence("the focal length is taken as 50mm"),
            );
        }
        (FovAxis::Diagonal, 2.0 * (0.5 * 36f32.hypot(24.0) / 50.0).atan())
    }

    /// A camera in front of the scene, far enough back to see all of it.
    pub(super) fn default_camera(&self, span: &Span) -> CameraDesc {
        let fov = 45f64.to_radians();
        let mut bounds = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        self.shapes.iter().for_each(|shape| bounds.add_geometry(&shape.geometry, &DMat4::IDENTITY));
        for instance in &self.instances {
            let placement = glam::Mat4::from(instance.world_from_group).as_dmat4();
            let group = self.groups.get(instance.group as usize);
            group
                .into_iter()
                .flat_map(|g| &g.shapes)
                .for_each(|s| bounds.add_geometry(&s.geometry, &placement));
        }
        let (center, radius) = bounds.sphere();
        let distance = radius / (0.5 * fov).sin();
        let world_from_camera = transform::look_at(center + DVec3::Z * distance, center, DVec3::Y)
            .unwrap_or(DMat4::IDENTITY)
            .as_mat4();
        CameraDesc {
            world_from_camera,
            projection: Projection::Perspective {
                fov_axis: FovAxis::Smaller,
                fov: fov as f32,
                principal_point_offset: Vec2::ZERO,
                lens: None,
            },
            near_clip: (1e-4 * distance) as f32,
            far_clip: (10.0 * distance) as f32,
            film: default_film(),
            span: span.clone(),
        }
    }
}

struct Bounds {
    min: DVec3,
    max: DVec3,
}

impl Bounds {
    fn add(&mut self, point: DVec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    fn add_geometry(&mut self, geometry: &Geometry, placement: &DMat4) {
        let mut add = |p: glam::Vec3| self.add(placement.transform_point3(p.as_dvec3()));
        match geometry {
            Geometry::Mesh(mesh) => mesh.positions.iter().for_each(|&p| add(p)),
            Geometry::Sphere { center, radius, .. } => {
                for sign in [-1.0, 1.0] {
                    glam::Vec3::AXES.iter().for_each(|&axis| add(*center + sign * *radius * axis));
                }
            }
            Geometry::Cylinder { base, frame, radius, length, .. } => {
                for z in [0.0, *length] {
                    let center = *base + z * frame.z_axis;
                    for axis in [frame.x_axis, -frame.x_axis, frame.y_axis, -frame.y_axis] {
                        add(center + *radius * axis);
                    }
                }
            }
            Geometry::Patch { corners, .. } => corners.iter().for_each(|&p| add(p)),
            Geometry::Disk { center, u_axis, v_axis, .. } => {
                for axis in [*u_axis, -*u_axis, *v_axis, -*v_axis] {
                    add(*center + axis);
                }
            }
        }
    }

    /// A sphere around the box; the unit sphere if there is nothing in it.
    fn sphere(&self) -> (DVec3, f64) {
        let radius = 0.5 * (self.max - self.min).length();
        if radius.is_finite() && radius > 0.0 {
            (0.5 * (self.min + self.max), radius)
        } else {
            (DVec3::ZERO, 1.0)
        }
    }
}
