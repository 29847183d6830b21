//! The integrator, the sampler, the film and the camera.

use glam::{Mat4, Vec3};
use sr_scene::{FilterDesc, Geometry, Projection, ShapeDesc};

use super::Writer;
use super::text::{Params, Text};

/// Bounces where there may be any number of them.
const UNBOUNDED: i64 = 1_000_000;

impl Writer<'_> {
    pub(super) fn options(&mut self, text: &mut Text, name: &str) {
        let settings = &self.scene.settings;
        // We count edges of a path, and pbrt its bounces.
        let bounces = settings.max_depth.map_or(UNBOUNDED, |edges| i64::from(edges) - 1);
        if bounces < 0 {
            let message = "paths of no edges";
            self.notes.push("convert::settings", &settings.span, message, "lights are seen");
        }
        if settings.hide_emitters {
            let message = "pbrt cannot hide lights from the camera";
            self.notes.push("convert::settings", &settings.span, message, "they are seen");
        }
        text.directive("Integrator", "volpath", &Params::default().integer("maxdepth", bounces.max(0)));
        let samples = Params::default().integer("pixelsamples", settings.spp.into());
        text.directive("Sampler", "zsobol", &samples);
        self.filter(text);
        let film = &self.scene.camera.film;
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let mut params = Params::default()
            .string("filename", &format!("{stem}.exr"))
            .integer("xresolution", film.width.into())
            .integer("yresolution", film.height.into());
        if let Some(crop) = film.crop {
            params = params.integers(
                "pixelbounds",
                &[crop.x, crop.x.saturating_add(crop.width), crop.y, crop.y.saturating_add(crop.height)],
            );
        }
        text.directive("Film", "rgb", &params);
    }

    fn filter(&mut self, text: &mut Text) {
        let film = &self.scene.camera.film;
        let span = &self.scene.camera.span;
        let both = |radius: f32| Params::default().float("xradius", radius).float("yradius", radius);
        let (kind, params) = match film.filter {
            FilterDesc::Box { radius } => ("box", both(radius)),
            FilterDesc::Tent { radius } => ("triangle", both(radius)),
            FilterDesc::Gaussian { stddev, radius } => ("gaussian", both(radius).float("sigma", stddev)),
            FilterDesc::Mitchell { b, c } => ("mitchell", both(2.0).float("B", b).float("C", c)),
            FilterDesc::CatmullRom => ("mitchell", both(2.0).float("B", 0.0).float("C", 0.5)),
            FilterDesc::Lanczos { lobes } => ("sinc", both(lobes as f32).float("tau", lobes as f32)),
            FilterDesc::BlackmanHarris { radius } => {
                let sigma = (220.0 * radius).round() / 1000.0;
                let instead = format!("a Gaussian of standard deviation {sigma} is written");
                let message = "pbrt has no filter \"blackmanharris\"";
                self.notes.push("convert::filter", span, message, instead);
                ("gaussian", both(radius).float("sigma", sigma))
            }
        };
        if !film.sample_border && film.filter.radius() > 0.5 {
            let message = "the filter is cut at the border of the film";
            let instead = "pbrt gathers light from outside of it, which pixels at the border show";
            self.notes.push("convert::border", span, message, instead);
        }
        text.directive("PixelFilter", kind, &params);
    }

    pub(super) fn camera(&mut self, text: &mut Text) {
        let camera = &self.scene.camera;
        let aspect = camera.film.width as f32 / camera.film.height.max(1) as f32;
        let columns = camera.world_from_camera;
        let unit = |axis: glam::Vec4| axis.truncate().normalize_or_zero().extend(0.0);
        let world_from_camera =
            Mat4::from_cols(unit(columns.x_axis), unit(columns.y_axis), unit(columns.z_axis), columns.w_axis);
        let mut own = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let (kind, params) = match camera.projection {
            Projection::Perspective { fov_axis, fov, principal_point_offset: offset, lens } => {
                let tan_x = (0.5 * fov_axis.horizontal(fov, aspect)).tan();
                // pbrt's angle is that of the shorter side.
                let half = if aspect > 1.0 { (aspect, 1.0) } else { (1.0, 1.0 / aspect) };
                let fov = 2.0 * (tan_x / half.0).atan();
                let mut params = Params::default().float("fov", fov.to_degrees());
                if offset.x != 0.0 || offset.y != 0.0 {
                    let (x, y) = (2.0 * half.0 * offset.x, -2.0 * half.1 * offset.y);
                    let window = [x - half.0, x + half.0, y - half.1, y + half.1];
                    params = params.floats("float screenwindow", &window);
                }
                if let Some(lens) = lens.filter(|lens| lens.aperture_radius > 0.0) {
                    params = params
                        .float("lensradius", lens.aperture_radius)
                        .float("focaldistance", lens.focus_distance);
                    if lens.blades > 0 {
                        let message = "pbrt has no lens with blades";
                        self.notes.push("convert::camera", &camera.span, message, "a round one is written");
                    }
                }
                ("perspective", params)
            }
            Projection::Orthographic => {
                let half = (columns.x_axis.truncate().length(), columns.y_axis.truncate().length() / aspect);
                let window = [-half.0, half.0, -half.1, half.1];
                ("orthographic", Params::default().floats("float screenwindow", &window))
            }
            Projection::Spherical => {
                // Our middle column looks along +Z, pbrt's along −X.
                own = Mat4::from_cols(glam::Vec4::Z, glam::Vec4::Y, glam::Vec4::NEG_X, glam::Vec4::W);
                ("spherical", Params::default().string("mapping", "equirectangular"))
            }
        };
        self.clip(world_from_camera);
        text.line("Scale -1 1 1");
        let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        text.concat(mirror * own * world_from_camera.inverse());
        text.directive("Camera", kind, &params);
    }

    /// Says if something is nearer or farther than the camera sees.
    fn clip(&mut self, world_from_camera: Mat4) {
        let camera = &self.scene.camera;
        let camera_from_world = world_from_camera.inverse();
        let is_cut = |m: Mat4, shape: &ShapeDesc| {
            let outside = |p: Vec3, around: f32| {
                let z = m.transform_point3(p).z;
                (z + around > 0.0 && z - around < camera.near_clip) || z + around > camera.far_clip
            };
            match &shape.geometry {
                Geometry::Mesh(mesh) => mesh.positions.iter().any(|p| outside(*p, 0.0)),
                Geometry::Sphere { center, radius, .. } => outside(*center, *radius),
                Geometry::Disk { center, u_axis, v_axis, .. } => {
                    outside(*center, u_axis.length().max(v_axis.length()))
                }
                Geometry::Cylinder { base, frame, length, radius, .. } => {
                    outside(*base, *radius) || outside(*base + *length * frame.z_axis, *radius)
                }
                Geometry::Patch { corners, .. } => corners.iter().any(|p| outside(*p, 0.0)),
                Geometry::Curves(curves) => curves.points.iter().any(|p| outside(p.truncate(), p.w)),
            }
        };
        let in_groups = self.scene.instances.iter().flat_map(|instance| {
            let m = camera_from_world * Mat4::from(instance.world_from_group);
            let shapes = self.scene.groups.get(instance.group as usize).map_or(&[][..], |g| &g.shapes);
            shapes.iter().map(move |shape| (m, shape))
        });
        let mut all = self.scene.shapes.iter().map(|shape| (camera_from_world, shape)).chain(in_groups);
        if all.any(|(m, shape)| is_cut(m, shape)) {
            let message = "parts of the scene are nearer or farther than the camera sees";
            self.notes.push("convert::camera", &camera.span, message, "pbrt shows them");
        }
    }
}
