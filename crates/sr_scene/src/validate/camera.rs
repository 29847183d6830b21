//! The camera.

use super::Check;
use crate::camera::Lens;
use crate::diagnostic::Span;
use crate::{CameraDesc, Projection};

/// Apertures of more blades are disks.
const MAX_BLADES: u32 = 1000;

impl Check<'_> {
    pub(super) fn camera(&mut self, camera: &CameraDesc) {
        let span = &camera.span;
        self.film(&camera.film, span);
        let m = camera.world_from_camera;
        let columns = [m.x_axis, m.y_axis, m.z_axis].map(|column| column.truncate().normalize_or_zero());
        let [x, y, z] = columns;
        if !m.is_finite() || !(x.cross(y).dot(z).abs() > 1e-6) {
            self.error("scene::bad-transform", span, "the placement of the camera is not invertible");
        }
        if !(camera.near_clip > 0.0 && camera.far_clip > camera.near_clip) {
            let (near, far) = (camera.near_clip, camera.far_clip);
            self.error(
                "scene::clip",
                span,
                format!("clipping distances {near} and {far}: 0 < near < far is needed"),
            );
        }
        if let Projection::Perspective { fov, principal_point_offset, lens, .. } = &camera.projection {
            if !(*fov > 0.0 && *fov < std::f32::consts::PI) {
                let fov = fov.to_degrees();
                let message = format!("an angle of view of {fov}° is not between 0° and 180°");
                self.error("scene::field-of-view", span, message);
            }
            if !principal_point_offset.is_finite() {
                self.error("scene::not-finite", span, "the principal point is not finite");
            }
            if let Some(lens) = lens {
                self.lens(lens, span);
            }
        }
    }

    fn lens(&mut self, lens: &Lens, span: &Span) {
        let Lens { aperture_radius, focus_distance, blades, blade_rotation } = *lens;
        if !(aperture_radius >= 0.0 && aperture_radius.is_finite()) {
            self.error("scene::aperture", span, format!("an aperture radius of {aperture_radius}"));
        }
        if aperture_radius > 0.0 && !(focus_distance > 0.0 && focus_distance.is_finite()) {
            self.error("scene::focus", span, format!("a focus distance of {focus_distance}"));
        }
        if !(blades == 0 || (3..=MAX_BLADES).contains(&blades)) {
            let message = format!("an aperture of {blades} blades: 0 (a disk), or 3 to {MAX_BLADES}");
            self.error("scene::aperture", span, message);
        }
        if !blade_rotation.is_finite() {
            self.error("scene::not-finite", span, "the rotation of the aperture is not finite");
        }
    }
}
