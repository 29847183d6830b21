//! The camera and its film.

use super::Check;
use crate::diagnostic::Diagnostic;
use crate::{CameraDesc, FilterDesc};

/// A film of more pixels than this is an error: its accumulators alone would not fit in memory.
pub const MAX_FILM_PIXELS: u64 = 1 << 27;

impl Check<'_> {
    pub(super) fn camera(&mut self, camera: &CameraDesc) {
        let span = &camera.span;
        let film = &camera.film;
        let pixels = u64::from(film.width) * u64::from(film.height);
        if pixels == 0 || pixels > MAX_FILM_PIXELS {
            let size = format!("a film of {} × {} pixels", film.width, film.height);
            let limit = format!("at least 1 and at most {MAX_FILM_PIXELS} pixels are possible");
            self.found.push(Diagnostic::error("scene::film-size", span, size).hint(limit));
        }
        if !(camera.fov > 0.0 && camera.fov < std::f32::consts::PI) {
            let fov = camera.fov.to_degrees();
            self.error(
                "scene::field-of-view",
                span,
                format!("an angle of view of {fov}° is not between 0° and 180°"),
            );
        }
        let m = camera.world_from_camera;
        if !m.is_finite() || m.determinant() == 0.0 {
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
        if !(camera.aperture_radius >= 0.0 && camera.aperture_radius.is_finite()) {
            self.error("scene::aperture", span, format!("an aperture radius of {}", camera.aperture_radius));
        }
        if camera.aperture_radius > 0.0 && !(camera.focus_distance > 0.0 && camera.focus_distance.is_finite())
        {
            self.error("scene::focus", span, format!("a focus distance of {}", camera.focus_distance));
        }
        if !camera.principal_point_offset.is_finite() {
            self.error("scene::not-finite", span, "the principal point is not finite");
        }
        let radius = match film.filter {
            FilterDesc::Box { radius } | FilterDesc::Tent { radius } => radius,
            FilterDesc::Gaussian { stddev, radius } if stddev > 0.0 => radius,
            FilterDesc::Gaussian { .. } => f32::NAN,
        };
        if !(radius > 0.0 && radius <= 32.0) {
            self.error(
                "scene::filter",
                span,
                format!("a pixel filter of radius {radius}: (0, 32] is possible"),
            );
        }
    }
}
