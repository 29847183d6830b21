//! The camera.

use super::{Check, degrees, extent};
use crate::camera::Lens;
use crate::diagnostic::Span;
use crate::{CameraDesc, Projection};

/// Apertures of more blades are disks.
const MAX_BLADES: u32 = 1000;
/// In radians, about 2 seconds of arc: narrower, neighbouring pixels see the same in single precision.
const NARROWEST: f32 = 1e-5;
/// In widths and heights of the film.
const FARTHEST_PRINCIPAL_POINT: f32 = 1000.0;

impl Check<'_> {
    pub(super) fn camera(&mut self, camera: &CameraDesc) {
        let span = &camera.span;
        self.film(&camera.film, span);
        let m = camera.world_from_camera;
        let columns = [m.x_axis, m.y_axis, m.z_axis].map(|column| column.truncate().normalize_or_zero());
        let [x, y, z] = columns;
        if !m.is_finite() || !(x.cross(y).dot(z).abs() > 1e-6) {
            self.error("scene::bad-transform", span, "the placement of the camera is not invertible");
        } else if f64::from(m.w_axis.truncate().abs().max_element()) > extent::FARTHEST {
            let (position, farthest) = (m.w_axis.truncate(), extent::FARTHEST);
            let message = format!("a camera at {position}: coordinates up to {farthest:e} are possible");
            self.error("scene::extent", span, message);
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
            self.field_of_view(*fov, span);
            if !(principal_point_offset.abs().max_element() <= FARTHEST_PRINCIPAL_POINT) {
                let message = format!(
                    "a principal point {} widths and {} heights off: up to {FARTHEST_PRINCIPAL_POINT} is possible",
                    principal_point_offset.x, principal_point_offset.y
                );
                self.error("scene::principal-point", span, message);
            }
            if let Some(lens) = lens {
                self.lens(lens, span);
            }
        }
    }

    pub(super) fn field_of_view(&mut self, fov: f32, span: &Span) {
        if !(NARROWEST..std::f32::consts::PI).contains(&fov) {
            let (least, shown) = (f64::from(NARROWEST).to_degrees(), degrees(fov));
            let message =
                format!("an angle of view of {shown}: at least {least:.5}° and less than 180° is possible");
            self.error("scene::field-of-view", span, message);
        }
    }

    fn lens(&mut self, lens: &Lens, span: &Span) {
        let Lens { aperture_radius, focus_distance, blades, blade_rotation } = *lens;
        let longest = extent::FARTHEST as f32;
        if !(0.0..=longest).contains(&aperture_radius) {
            let message = format!("an aperture radius of {aperture_radius}: 0 to {longest:e} is possible");
            self.error("scene::aperture", span, message);
        }
        if aperture_radius > 0.0 && !(focus_distance > 0.0 && focus_distance <= longest) {
            let message = format!(
                "a focus distance of {focus_distance}: more than 0 and at most {longest:e} is possible"
            );
            self.error("scene::focus", span, message);
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
