//! Cameras. pbrt's look along +Z, with +X to the right and +Y up; ours have +X to the left.

use glam::{DMat4, DVec2, DVec3, Vec2};
use sr_scene::{CameraDesc, FilmDesc, FovAxis, Lens, Projection, Span};

use super::Reader;
use super::params::Params;
use super::support::{CAMERAS, unsupported};
use super::syntax::Kind;

/// Where the scene begins and ends for cameras: nowhere.
const CLIP: (f32, f32) = (1e-4, 1e30);

/// The rectangle of pbrt's screen space that the film shows.
struct Screen {
    min: DVec2,
    max: DVec2,
}

impl Screen {
    fn half(&self) -> DVec2 {
        0.5 * (self.max - self.min)
    }

    fn center(&self) -> DVec2 {
        0.5 * (self.max + self.min)
    }
}

impl Reader<'_> {
    /// `Camera "perspective"` and parameters.
    pub(super) fn camera(&mut self, kind: &str, params: Params) {
        let camera_from_world = self.state.ctm;
        let world_from_camera = [camera_from_world.inverse(), self.state.end_ctm.inverse()];
        self.coordinate_systems.insert("camera".into(), world_from_camera);
        self.options.camera = Some((kind.to_owned(), params, camera_from_world));
    }

    /// Once the film is known.
    pub(super) fn camera_end(
        &mut self,
        camera: Option<(String, Params, DMat4)>,
        film: FilmDesc,
        span: &Span,
    ) {
        let Some((kind, mut params, camera_from_world)) = camera else {
            let message = "the scene has no camera";
            self.warn(
                "scene::no-camera",
                span,
                message,
                "pbrt's usual one is used: from the origin along +Z, 90° wide",
            );
            let camera = Params::new("Camera".into(), span.clone(), Vec::new(), &[]);
            self.camera_end(Some(("perspective".into(), camera, DMat4::IDENTITY)), film, span);
            return;
        };
        let aspect = f64::from(film.width.max(1)) / f64::from(film.height.max(1));
        let screen = self.screen(&mut params, aspect);
        let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let mut own = mirror;
        let projection = match &*kind {
            "orthographic" => {
                // Our film shows x from 1 to −1.
                let (half, center) = (screen.half(), screen.center());
                let scale = DVec3::new(half.x, half.y * aspect, 1.0);
                own = DMat4::from_translation(center.extend(0.0)) * DMat4::from_scale(scale) * mirror;
                params.unsupported(&["lensradius"], "all is in focus", &mut self.notes());
                params.ignore(&["focaldistance"]);
                Projection::Orthographic
            }
            "spherical" => {
                let mapping = params.choice("mapping", &["equalarea", "equirectangular"], &mut self.notes());
                if mapping == "equalarea" {
                    let message = "a spherical camera with the mapping \"equalarea\" is not supported";
                    self.warn(
                        "pbrt::unsupported-camera",
                        &params.span,
                        message,
                        "\"equirectangular\" is used",
                    );
                }
                // Our middle column looks along +Z, pbrt's along −X.
                own = DMat4::from_cols(
                    DVec3::Z.extend(0.0),
                    DVec3::Y.extend(0.0),
                    DVec3::NEG_X.extend(0.0),
                    DVec3::ZERO.extend(1.0),
                );
                Projection::Spherical
            }
            other => {
                if other != "perspective" {
                    let usual = "a perspective camera at the same place is used";
                    let code = "pbrt::unsupported-camera";
                    let note = unsupported(CAMERAS, code, &params.span, "a camera", other, usual);
                    self.notes().push(note);
                }
                self.perspective(&mut params, &screen, aspect)
            }
        };
        params.ignore(&["shutteropen", "shutterclose", "screenwindow", "frameaspectratio"]);
        if !matches!(&*kind, "perspective" | "orthographic" | "spherical") {
            params.use_all();
        }
        let span = params.span.clone();
        params.finish(&mut self.notes());
        self.out.camera = Some(CameraDesc {
            world_from_camera: (camera_from_world.inverse() * own).as_mat4(),
            projection,
            near_clip: CLIP.0,
            far_clip: CLIP.1,
            film,
            span,
        });
    }

    /// By default ±1 along the shorter side of the film.
    fn screen(&mut self, params: &mut Params, aspect: f64) -> Screen {
        let frame = params.float("frameaspectratio").map_or(aspect, f64::from);
        let half = if frame > 1.0 { DVec2::new(frame, 1.0) } else { DVec2::new(1.0, 1.0 / frame) };
        let mut screen = Screen { min: -half, max: half };
        if let Some((span, window)) = params.take_floats("screenwindow", &[Kind::Float]) {
            match window[..] {
                [x0, x1, y0, y1] if x0 < x1 && y0 < y1 => {
                    screen.min = DVec2::new(x0.into(), y0.into());
                    screen.max = DVec2::new(x1.into(), y1.into());
                }
                _ => {
                    let message = "a screen window is x from, x to, y from, y to";
                    self.warn("pbrt::bad-value", &span, message, "the whole screen is shown");
                }
            }
        }
        screen
    }

    fn perspective(&mut self, params: &mut Params, screen: &Screen, aspect: f64) -> Projection {
        let fov = params.float("fov").unwrap_or(90.0);
        let tan_half = (0.5 * f64::from(fov).to_radians()).tan();
        let (half, center) = (screen.half(), screen.center());
        let is_square = (half.x / half.y / aspect - 1.0).abs() <= 1e-3;
        if !is_square {
            let message = "pixels that are no squares are not supported";
            self.warn(
                "pbrt::unsupported-camera",
                &params.span,
                message,
                "the picture is as wide as it should be",
            );
        }
        // Where x = y = 0 of the screen are on the film, from its left and its top, less one half.
        let axis = DVec2::new(-center.x / (2.0 * half.x), center.y / (2.0 * half.y));
        let aperture_radius = params.float("lensradius").unwrap_or(0.0);
        let focus_distance = params.float("focaldistance").unwrap_or(1e6);
        let lens = Lens { aperture_radius, focus_distance, blades: 0, blade_rotation: 0.0 };
        // As pbrt has it, where nothing says otherwise: so it is also for films of another shape.
        let is_plain = is_square && half.min_element() == 1.0 && center == DVec2::ZERO;
        let (fov_axis, fov) = match is_plain {
            true => (FovAxis::Smaller, fov.to_radians()),
            false => (FovAxis::X, (2.0 * (tan_half * half.x).atan()) as f32),
        };
        Projection::Perspective {
            fov_axis,
            fov,
            principal_point_offset: -Vec2::new(axis.x as f32, axis.y as f32),
            lens: (aperture_radius > 0.0).then_some(lens),
        }
    }
}
