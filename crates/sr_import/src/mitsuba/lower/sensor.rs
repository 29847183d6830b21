//! Sensors.

use glam::Vec2;
use sr_scene::{CameraDesc, Diagnostic, FovAxis, Lens, Projection};

use super::Lowering;
use crate::mitsuba::node::Node;
use crate::mitsuba::plugins;
use crate::mitsuba::props::Props;
use crate::values;

impl<'a> Lowering<'a, '_> {
    pub(super) fn sensors(&mut self, nodes: &[&'a Node]) {
        let Some((&first, more)) = nodes.split_first() else { return };
        if let Some(second) = more.first() {
            self.out.d.push(
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
        let known = plugins::is_read("sensor", &node.kind);
        if !known {
            self.unknown_plugin(node, "a perspective camera at the same place is used");
        }
        let to_world = props.transform("to_world", self.out.d);
        let near_clip = props.float("near_clip", self.out.d).unwrap_or(1e-2);
        let far_clip = props.float("far_clip", self.out.d).unwrap_or(1e4);
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
        props.finish(self.out.d);
        self.out.camera = Some(CameraDesc {
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
        let focus_distance = props.float("focus_distance", self.out.d).unwrap_or(far_clip);
        let principal_point_offset = Vec2::new(
            props.float("principal_point_offset_x", self.out.d).unwrap_or(0.0),
            props.float("principal_point_offset_y", self.out.d).unwrap_or(0.0),
        );
        let lens = (node.kind == "thinlens").then(|| Lens {
            aperture_radius: props.float("aperture_radius", self.out.d).unwrap_or(0.0),
            focus_distance,
            blades: self.count(props, node, "blades", 0),
            blade_rotation: props.float("blade_rotation", self.out.d).unwrap_or(0.0).to_radians(),
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
        let axis = match props.string("fov_axis", self.out.d) {
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
        let focal_length = props.string("focal_length", self.out.d);
        if let Some(fov) = props.float("fov", self.out.d) {
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
                    self.out.d.push(Diagnostic::error("mitsuba::bad-value", span, message));
                }
            }
        } else if known {
            let message = format!("{} has neither \"fov\" nor \"focal_length\"", node.title());
            self.out.d.push(
                Diagnostic::warning("mitsuba::missing-property", &node.span, message)
                    .consequence("the focal length is taken as 50mm"),
            );
        }
        (FovAxis::Diagonal, 2.0 * (0.5 * 36f32.hypot(24.0) / 50.0).atan())
    }
}
