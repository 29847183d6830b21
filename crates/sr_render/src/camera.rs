//! The camera: film position and lens position to a ray.

use glam::{Vec2, Vec3};
use sr_geometry::Ray;
use sr_sampling::warp::{RegularPolygon, concentric_disk, unit_circle};
use sr_scene::{CameraDesc, Lens, Projection};

use crate::texture::RayCone;

/// A compiled camera for one film size.
#[derive(Clone, Debug)]
pub enum Camera {
    /// Through a point or a thin lens.
    Perspective(Perspective),
    /// Parallel rays.
    Orthographic(Orthographic),
    /// All around.
    Spherical(Spherical),
}

/// A film position and a lens position to a ray.
pub trait Project {
    /// The ray through a film position (fractions of width and height, from the top left) and a lens
    /// position chosen by two uniforms. The direction is a unit vector.
    fn ray(&self, film: Vec2, u_lens: Vec2) -> Ray;
}

impl Camera {
    /// Prepares a camera for a film of `width` × `height` pixels.
    pub fn new(desc: &CameraDesc, width: u32, height: u32) -> Self {
        let aspect = width as f32 / height as f32;
        let m = desc.world_from_camera;
        let columns = [m.x_axis, m.y_axis, m.z_axis].map(|column| column.truncate());
        let origin = m.w_axis.truncate();
        let rigid = Placement { axes: columns.map(|column| column.normalize_or(Vec3::Z)), origin };
        let (near, far) = (desc.near_clip, desc.far_clip);
        match &desc.projection {
            Projection::Perspective { fov_axis, fov, principal_point_offset, lens } => {
                let tan_x = (0.5 * fov_axis.horizontal(*fov, aspect)).tan();
                Self::Perspective(Perspective {
                    placement: rigid,
                    tan_half: Vec2::new(tan_x, tan_x / aspect),
                    principal_point_offset: *principal_point_offset,
                    aperture: lens.as_ref().and_then(Aperture::new),
                    near,
                    far,
                })
            }
            Projection::Orthographic => Self::Orthographic(Orthographic {
                placement: Placement { axes: columns, origin },
                direction: rigid.axes[2],
                half_size: Vec2::new(1.0, 1.0 / aspect),
                near,
                length: far - near,
            }),
            Projection::Spherical => {
                Self::Spherical(Spherical { placement: rigid, near, length: far - near })
            }
        }
    }

    /// How wide the rays of a pixel are, on a film of `height` pixels.
    pub(crate) fn pixel_cone(&self, height: u32) -> RayCone {
        let per_pixel = 1.0 / height as f32;
        let from_point = |spread: f32, near: f32| RayCone { width: spread * near, spread };
        match self {
            Self::Perspective(camera) => from_point(2.0 * camera.tan_half.y * per_pixel, camera.near),
            Self::Orthographic(camera) => {
                let height = 2.0 * camera.half_size.y * camera.placement.axes[1].length();
                RayCone { width: height * per_pixel, spread: 0.0 }
            }
            Self::Spherical(camera) => from_point(std::f32::consts::PI * per_pixel, camera.near),
        }
    }

    /// Does `ray` use its lens uniforms?
    pub fn has_lens(&self) -> bool {
        matches!(self, Self::Perspective(Perspective { aperture: Some(_), .. }))
    }
}

impl Project for Camera {
    #[inline(always)]
    fn ray(&self, film: Vec2, u_lens: Vec2) -> Ray {
        match self {
            Self::Perspective(camera) => camera.ray(film, u_lens),
            Self::Orthographic(camera) => camera.ray(film, u_lens),
            Self::Spherical(camera) => camera.ray(film, u_lens),
        }
    }
}

/// Where a camera's axes and its origin are in the world.
#[derive(Clone, Copy, Debug)]
struct Placement {
    axes: [Vec3; 3],
    origin: Vec3,
}

impl Placement {
    #[inline(always)]
    fn vector(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.axes;
        x * v.x + y * v.y + z * v.z
    }
}

/// A compiled pinhole or thin-lens camera.
#[derive(Clone, Debug)]
pub struct Perspective {
    placement: Placement,
    tan_half: Vec2,
    principal_point_offset: Vec2,
    aperture: Option<Aperture>,
    near: f32,
    far: f32,
}

/// The opening of a thin lens.
#[derive(Clone, Debug)]
struct Aperture {
    radius: f32,
    blades: Option<RegularPolygon>,
    focus_distance: f32,
}

impl Aperture {
    /// `None` for a pinhole.
    fn new(lens: &Lens) -> Option<Self> {
        let Lens { aperture_radius: radius, focus_distance, blades, blade_rotation } = *lens;
        let blades = RegularPolygon::new(blades, blade_rotation);
        (radius > 0.0).then_some(Self { radius, blades, focus_distance })
    }

    #[inline(always)]
    fn point(&self, u: Vec2) -> Vec2 {
        let unit = match &self.blades {
            None => concentric_disk(u),
            Some(polygon) => polygon.point(u),
        };
        self.radius * unit
    }
}

impl Project for Perspective {
    #[inline(always)]
    fn ray(&self, film: Vec2, u_lens: Vec2) -> Ray {
        let at = Vec2::ONE - 2.0 * (film + self.principal_point_offset);
        let through = (at * self.tan_half).extend(1.0);
        let (lens, towards) = match &self.aperture {
            Some(aperture) => {
                let lens = aperture.point(u_lens).extend(0.0);
                (lens, through * aperture.focus_distance - lens)
            }
            None => (Vec3::ZERO, through),
        };
        let d = towards.normalize();
        let per_z = 1.0 / d.z;
        Ray {
            origin: self.placement.origin + self.placement.vector(lens + d * (self.near * per_z)),
            direction: self.placement.vector(d),
            t_max: (self.far - self.near) * per_z,
        }
    }
}

/// A compiled orthographic camera.
#[derive(Clone, Debug)]
pub struct Orthographic {
    /// With its scale.
    placement: Placement,
    direction: Vec3,
    half_size: Vec2,
    near: f32,
    length: f32,
}

impl Project for Orthographic {
    #[inline(always)]
    fn ray(&self, film: Vec2, _u_lens: Vec2) -> Ray {
        let at = (Vec2::ONE - 2.0 * film) * self.half_size;
        let origin = self.placement.origin + self.placement.vector(at.extend(self.near));
        Ray { origin, direction: self.direction, t_max: self.length }
    }
}

/// A compiled camera that sees all around.
#[derive(Clone, Debug)]
pub struct Spherical {
    placement: Placement,
    near: f32,
    length: f32,
}

impl Project for Spherical {
    #[inline(always)]
    fn ray(&self, film: Vec2, _u_lens: Vec2) -> Ray {
        // (cos, sin) of the longitude from −Z, and of the angle from +Y
        let (around, down) = (unit_circle(film.x), unit_circle(0.5 * film.y));
        let d = Vec3::new(around.y * down.y, down.x, -around.x * down.y);
        let direction = self.placement.vector(d.normalize());
        Ray { origin: self.placement.origin + self.near * direction, direction, t_max: self.length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Mat4;
    use sr_scene::{FilmDesc, FilterDesc, FovAxis, Span};

    fn desc(projection: Projection) -> CameraDesc {
        CameraDesc {
            world_from_camera: Mat4::from_translation(Vec3::new(0.0, 0.0, -2.0)),
            projection,
            near_clip: 0.01,
            far_clip: 1e4,
            film: FilmDesc {
                width: 20,
                height: 10,
                crop: None,
                filter: FilterDesc::Box { radius: 0.5 },
                sample_border: false,
            },
            span: Span::default(),
        }
    }

    fn perspective(lens: Option<Lens>) -> Camera {
        let projection = Projection::Perspective {
            fov_axis: FovAxis::X,
            fov: std::f32::consts::FRAC_PI_2,
            principal_point_offset: Vec2::ZERO,
            lens,
        };
        Camera::new(&desc(projection), 20, 10)
    }

    fn lens(blades: u32) -> Option<Lens> {
        Some(Lens { aperture_radius: 0.3, focus_distance: 4.0, blades, blade_rotation: 0.2 })
    }

    #[test]
    fn the_left_edge_looks_along_plus_x() {
        let camera = perspective(None);
        let left = camera.ray(Vec2::new(0.0, 0.5), Vec2::ZERO).direction;
        assert!((left - Vec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-6);
        let top = camera.ray(Vec2::new(0.5, 0.0), Vec2::ZERO).direction;
        assert!((top - Vec3::new(0.0, 0.5, 1.0).normalize()).length() < 1e-6);
    }

    #[test]
    fn lens_rays_meet_in_the_focal_plane() {
        for blades in [0, 3, 6] {
            let camera = perspective(lens(blades));
            let at_focus = |u: Vec2| {
                let ray = camera.ray(Vec2::new(0.3, 0.8), u);
                ray.origin + ray.direction * ((2.0 - ray.origin.z) / ray.direction.z)
            };
            assert!((at_focus(Vec2::new(0.1, 0.2)) - at_focus(Vec2::new(0.9, 0.6))).length() < 1e-5);
        }
    }

    #[test]
    fn blades_have_their_corners_where_they_were_asked_for() {
        let ray = perspective(lens(6)).ray(Vec2::splat(0.5), Vec2::new(0.0, 1.0));
        // back to the lens, from the near plane
        let on_lens = ray.origin - ray.direction * (0.01 / ray.direction.z);
        let expected = (0.3 * Vec2::from_angle(0.2)).extend(-2.0);
        assert!((on_lens - expected).length() < 1e-6, "{on_lens}");
    }

    #[test]
    fn orthographic_rays_are_parallel_and_scaled() {
        let placement = Mat4::from_scale_rotation_translation(
            Vec3::new(3.0, 2.0, 1.0),
            glam::Quat::IDENTITY,
            Vec3::new(0.0, 0.0, -2.0),
        );
        let desc = CameraDesc { world_from_camera: placement, ..desc(Projection::Orthographic) };
        let camera = Camera::new(&desc, 20, 10);
        let ray = camera.ray(Vec2::new(0.0, 0.0), Vec2::ZERO);
        assert_eq!(ray.direction, Vec3::Z);
        assert!((ray.origin - Vec3::new(3.0, 1.0, -1.99)).length() < 1e-6, "{}", ray.origin);
        let ray = camera.ray(Vec2::new(0.75, 1.0), Vec2::ZERO);
        assert!((ray.origin - Vec3::new(-1.5, -1.0, -1.99)).length() < 1e-6, "{}", ray.origin);
        assert!((ray.t_max - 9999.99).abs() < 1e-2);
    }

    #[test]
    fn a_spherical_camera_looks_everywhere() {
        let camera = Camera::new(&desc(Projection::Spherical), 20, 10);
        for (film, direction) in [
            (Vec2::new(0.0, 0.5), Vec3::NEG_Z),
            (Vec2::new(0.25, 0.5), Vec3::X),
            (Vec2::new(0.5, 0.5), Vec3::Z),
            (Vec2::new(0.75, 0.5), Vec3::NEG_X),
            (Vec2::new(0.3, 0.0), Vec3::Y),
            (Vec2::new(0.3, 1.0), Vec3::NEG_Y),
        ] {
            let ray = camera.ray(film, Vec2::ZERO);
            assert!((ray.direction - direction).length() < 1e-6, "{film}: {}", ray.direction);
            assert!((ray.origin - Vec3::new(0.0, 0.0, -2.0) - 0.01 * direction).length() < 1e-6);
        }
    }
}
