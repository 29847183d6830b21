//! The camera: film position and lens position to a ray.

use glam::{Vec2, Vec3};
use sr_geometry::Ray;
use sr_sampling::warp::concentric_disk;
use sr_scene::CameraDesc;

/// A compiled pinhole or thin-lens camera for one film size.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Where the camera's axes and its origin are in the world.
    axes: [Vec3; 3],
    origin: Vec3,
    tan_half: Vec2,
    principal_point_offset: Vec2,
    aperture_radius: f32,
    focus_distance: f32,
    near_clip: f32,
    far_clip: f32,
}

impl Camera {
    /// Prepares a camera for a film of `width` × `height` pixels.
    pub fn new(desc: &CameraDesc, width: u32, height: u32) -> Self {
        let aspect = width as f32 / height as f32;
        let tan_x = (0.5 * desc.fov_axis.horizontal(desc.fov, aspect)).tan();
        let m = desc.world_from_camera;
        Self {
            axes: [m.x_axis, m.y_axis, m.z_axis].map(|column| column.truncate().normalize_or(Vec3::Z)),
            origin: m.w_axis.truncate(),
            tan_half: Vec2::new(tan_x, tan_x / aspect),
            principal_point_offset: desc.principal_point_offset,
            aperture_radius: desc.aperture_radius,
            focus_distance: desc.focus_distance,
            near_clip: desc.near_clip,
            far_clip: desc.far_clip,
        }
    }

    /// Does `ray` use its lens uniforms?
    pub fn has_lens(&self) -> bool {
        self.aperture_radius > 0.0
    }

    /// The ray through a film position (fractions of width and height, from the top left) and a lens
    /// position chosen by two uniforms. The direction is a unit vector.
    #[inline(always)]
    pub fn ray(&self, film: Vec2, u_lens: Vec2) -> Ray {
        let at = Vec2::ONE - 2.0 * (film + self.principal_point_offset);
        let through = (at * self.tan_half).extend(1.0);
        let (lens, towards) = if self.has_lens() {
            let lens = (self.aperture_radius * concentric_disk(u_lens)).extend(0.0);
            (lens, through * self.focus_distance - lens)
        } else {
            (Vec3::ZERO, through)
        };
        let d = towards.normalize();
        let per_z = 1.0 / d.z;
        Ray {
            origin: self.origin + self.to_world(lens + d * (self.near_clip * per_z)),
            direction: self.to_world(d),
            t_max: (self.far_clip - self.near_clip) * per_z,
        }
    }
}

impl Camera {
    #[inline(always)]
    fn to_world(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.axes;
        x * v.x + y * v.y + z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Mat4;
    use sr_scene::{FilmDesc, FilterDesc, FovAxis, Span};

    fn desc(aperture_radius: f32) -> CameraDesc {
        CameraDesc {
            world_from_camera: Mat4::from_translation(Vec3::new(0.0, 0.0, -2.0)),
            fov_axis: FovAxis::X,
            fov: std::f32::consts::FRAC_PI_2,
            near_clip: 0.01,
            far_clip: 1e4,
            principal_point_offset: Vec2::ZERO,
            aperture_radius,
            focus_distance: 4.0,
            film: FilmDesc {
                width: 20,
                height: 10,
                filter: FilterDesc::Box { radius: 0.5 },
                sample_border: false,
            },
            span: Span::default(),
        }
    }

    #[test]
    fn the_left_edge_looks_along_plus_x() {
        let camera = Camera::new(&desc(0.0), 20, 10);
        let left = camera.ray(Vec2::new(0.0, 0.5), Vec2::ZERO).direction;
        assert!((left - Vec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-6);
        let top = camera.ray(Vec2::new(0.5, 0.0), Vec2::ZERO).direction;
        assert!((top - Vec3::new(0.0, 0.5, 1.0).normalize()).length() < 1e-6);
    }

    #[test]
    fn lens_rays_meet_in_the_focal_plane() {
        let camera = Camera::new(&desc(0.3), 20, 10);
        let at_focus = |u: Vec2| {
            let ray = camera.ray(Vec2::new(0.3, 0.8), u);
            ray.origin + ray.direction * ((2.0 - ray.origin.z) / ray.direction.z)
        };
        assert!((at_focus(Vec2::new(0.1, 0.2)) - at_focus(Vec2::new(0.9, 0.6))).length() < 1e-5);
    }
}
