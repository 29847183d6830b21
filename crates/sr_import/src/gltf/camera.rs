//! Cameras: they look along -Z with +Y up; ours look along +Z with +X to the left.

use glam::{DMat4, DVec3, Vec2};
use sr_scene::{CameraDesc, FilmDesc, FovAxis, Projection};

use super::document::Document;
use super::json::Value;
use crate::assembly::default_film;

/// How narrow or wide a film may be asked for.
const ASPECTS: (f64, f64) = (0.05, 20.0);

impl Document<'_, '_> {
    /// The camera at a node.
    pub fn camera(&mut self, camera: &Value, world: &DMat4) {
        let span = camera.span.clone();
        let turn = DMat4::from_scale(DVec3::new(-1.0, 1.0, -1.0));
        let kind = camera.get("type").and_then(Value::text).unwrap_or("");
        let Some(lens) = camera.get(kind).filter(|_| matches!(kind, "perspective" | "orthographic")) else {
            let message = "the camera is neither perspective nor orthographic";
            self.warn("gltf::camera", &span, message, "it is not used");
            return;
        };
        let positive = |v: f64| v.is_finite() && v > 0.0;
        let (near, far) = (self.number(lens, "znear", 0.0), self.number(lens, "zfar", 0.0));
        let default = default_film();
        let default_aspect = f64::from(default.width) / f64::from(default.height);
        let (projection, scale, aspect) = if kind == "perspective" {
            let fov = self.number(lens, "yfov", 0.0);
            if !(positive(fov) && fov < std::f64::consts::PI) {
                let message = format!("an angle of view of {fov} radians is not between 0 and π");
                self.warn("gltf::camera", &lens.span, message, "the camera is not used");
                return;
            }
            let projection = Projection::Perspective {
                fov_axis: FovAxis::Y,
                fov: fov as f32,
                principal_point_offset: Vec2::ZERO,
                lens: None,
            };
            (projection, DVec3::ONE, self.number(lens, "aspectRatio", default_aspect))
        } else {
            let (x, y) = (self.number(lens, "xmag", 1.0), self.number(lens, "ymag", 1.0));
            if !(positive(x) && positive(y)) {
                let message = format!("an extent of {x} × {y} is not positive");
                self.warn("gltf::camera", &lens.span, message, "the camera is not used");
                return;
            }
            (Projection::Orthographic, DVec3::new(x, x, 1.0), x / y)
        };
        // A camera's nodes may be scaled, but what it sees is not.
        let (_, rotation, place) = world.to_scale_rotation_translation();
        if !(rotation.is_finite() && place.is_finite()) {
            self.warn("gltf::camera", &span, "the camera's node turns it to nothing", "it is not used");
            return;
        }
        let aspect = if positive(aspect) { aspect.clamp(ASPECTS.0, ASPECTS.1) } else { default_aspect };
        let height = (f64::from(default.width * default.height) / aspect).sqrt().round();
        let film = FilmDesc { width: (height * aspect).round() as u32, height: height as u32, ..default };
        let placed = DMat4::from_rotation_translation(rotation, place) * turn * DMat4::from_scale(scale);
        let near = if positive(near) { near } else { 1e-3 };
        let far = if far > near { far } else { near * 1e7 };
        self.out.camera = Some(CameraDesc {
            world_from_camera: placed.as_mat4(),
            projection,
            near_clip: near as f32,
            far_clip: far as f32,
            film,
            span,
        });
    }
}
