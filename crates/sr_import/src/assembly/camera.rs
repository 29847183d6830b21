//! The camera of a scene that has none.

use glam::{DMat4, DVec3, Vec2};
use sr_scene::{CameraDesc, FilmDesc, FilterDesc, FovAxis, Geometry, Projection, Span};

use super::Assembly;
use crate::look_at::look_at;

/// The film of a camera that has none: Mitsuba's, with its filter, a Gaussian cut at four standard deviations.
pub fn default_film() -> FilmDesc {
    let filter = FilterDesc::Gaussian { stddev: 0.5, radius: 2.0 };
    FilmDesc { width: 768, height: 576, crop: None, filter, sample_border: false }
}

/// In front, where +Z is the front and +Y is up, a little to the right and above.
pub const FRONT_ABOVE: DVec3 = DVec3::new(0.35, 0.4, 1.0);

impl Assembly<'_> {
    /// The direction of the default camera, in words.
    pub(super) fn view(&self) -> &'static str {
        if self.view_from == DVec3::Z { "along -Z" } else { "from the front, slightly above," }
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
        let world_from_camera = look_at(center + self.view_from.normalize() * distance, center, DVec3::Y)
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
            Geometry::Curves(curves) => curves.points.iter().for_each(|p| add(p.truncate())),
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
