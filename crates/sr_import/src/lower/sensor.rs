//! Sensors, films and pixel filters.

use glam::{DMat4, DVec3, Vec2};
use sr_scene::{CameraDesc, Diagnostic, FilmDesc, FilterDesc, FovAxis, Geometry, MAX_FILM_PIXELS, Span};

use super::Lowering;
use crate::node::Node;
use crate::props::Props;
use crate::{transform, values};

const SENSORS: &[&str] = &["perspective", "thinlens"];
const FILTERS: &[&str] = &["box", "tent", "gaussian"];
/// Mitsuba's default film.
const DEFAULT_SIZE: (u32, u32) = (768, 576);
/// Mitsuba's default filter, cut at four standard deviations.
const DEFAULT_FILTER: FilterDesc = FilterDesc::Gaussian { stddev: 0.5, radius: 2.0 };

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
        let (fov_axis, fov) = self.field_of_view(node, &mut props, known);
        let film = self.film(&mut props);
        if let [sampler, ..] = self.nested(&mut props, "sampler")[..] {
            self.sampler(sampler);
        }
        let thin_lens = node.kind == "thinlens";
        let aperture_radius =
            if thin_lens { props.float("aperture_radius", self.d).unwrap_or(0.0) } else { 0.0 };
        let near_clip = props.float("near_clip", self.d).unwrap_or(1e-2);
        let far_clip = props.float("far_clip", self.d).unwrap_or(1e4);
        let focus_distance = props.float("focus_distance", self.d).unwrap_or(far_clip);
        let offset = Vec2::new(
            props.float("principal_point_offset_x", self.d).unwrap_or(0.0),
            props.float("principal_point_offset_y", self.d).unwrap_or(0.0),
        );
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
            fov_axis,
            fov,
            near_clip,
            far_clip,
            principal_point_offset: offset,
            aperture_radius,
            focus_distance,
            film,
            span: node.span.clone(),
        });
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

    fn film(&mut self, props: &mut Props<'a>) -> FilmDesc {
        let (width, height) = DEFAULT_SIZE;
        let mut film = FilmDesc { width, height, filter: DEFAULT_FILTER, sample_border: false };
        let [node, ..] = self.nested(props, "film")[..] else { return film };
        let mut props = Props::new(node);
        if !matches!(node.kind.as_str(), "hdrfilm" | "ldrfilm") {
            self.unknown_plugin(node, &["hdrfilm"], "its size and filter are used, the rest is ignored");
        }
        let sizes = [("width", width), ("height", height)].map(|(name, default)| {
            let size = props.integer(name, self.d).unwrap_or(default.into());
            u32::try_from(size).unwrap_or_else(|_| {
                let message =
                    format!("a film's {name} of {size}; at most {MAX_FILM_PIXELS} pixels are possible");
                self.d.push(Diagnostic::error("scene::film-size", &node.span, message));
                default
            })
        });
        [film.width, film.height] = sizes;
        film.sample_border = props
            .boolean("sample_border", self.d)
            .or(props.boolean("high_quality_edges", self.d))
            .unwrap_or(false);
        props.unsupported(
            &["crop_width", "crop_height", "crop_offset_x", "crop_offset_y", "size"],
            "the whole film is rendered",
            self.d,
        );
        // How a file is written is decided when it is written.
        props.ignore(&[
            "banner",
            "pixel_format",
            "component_format",
            "file_format",
            "compensate",
            "attach_log",
            "gamma",
            "exposure",
            "tonemap_method",
            "key",
            "burn",
        ]);
        if let [filter, ..] = self.nested(&mut props, "rfilter")[..] {
            film.filter = self.filter(filter);
        }
        if !matches!(node.kind.as_str(), "hdrfilm" | "ldrfilm") {
            props.use_all();
        }
        props.finish(self.d);
        film
    }

    fn filter(&mut self, node: &'a Node) -> FilterDesc {
        let mut props = Props::new(node);
        let filter = match node.kind.as_str() {
            "box" => FilterDesc::Box { radius: props.float("radius", self.d).unwrap_or(0.5) },
            "tent" => FilterDesc::Tent { radius: props.float("radius", self.d).unwrap_or(1.0) },
            "gaussian" => {
                let stddev = props.float("stddev", self.d).unwrap_or(0.5);
                FilterDesc::Gaussian { stddev, radius: 4.0 * stddev }
            }
            _ => {
                self.unknown_plugin(node, FILTERS, "a Gaussian of standard deviation 0.5 pixels is used");
                props.use_all();
                DEFAULT_FILTER
            }
        };
        props.finish(self.d);
        filter
    }

    /// A camera in front of the scene, far enough back to see all of it.
    pub(super) fn default_camera(&self, span: &Span) -> CameraDesc {
        let (width, height) = DEFAULT_SIZE;
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
            fov_axis: FovAxis::Smaller,
            fov: fov as f32,
            near_clip: (1e-4 * distance) as f32,
            far_clip: (10.0 * distance) as f32,
            principal_point_offset: Vec2::ZERO,
            aperture_radius: 0.0,
            focus_distance: distance as f32,
            film: FilmDesc { width, height, filter: DEFAULT_FILTER, sample_border: false },
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
