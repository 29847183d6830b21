//! Shapes that shine: diffuse emission from the front of a mesh, a sphere, a disk or a cylinder.
//!
//! A sphere is sampled by the cone it fills, a cylinder by the angle across its axis, triangles and rectangles nearby by solid angle (`near`), all others by area:
//! evenly, or where a picture on them is bright (`picture`).

mod flat;
mod near;
mod picture;
pub(super) mod sphere;

use std::f32::consts::PI;

use glam::{Vec2, Vec3};
use sr_geometry::Cylinder;
use sr_sampling::warp::concentric_disk;
use sr_sampling::{AliasTable, Distribution, Sample, to_solid_angle};
use sr_scene::{ColorInput, Rgb};

use super::{LightId, LightSample, Target, cylinder};
use crate::texture::Textures;
use flat::Parallelogram;
pub(crate) use flat::Triangle;
pub(super) use flat::{Patch, Seen};
use picture::Picture;

/// A shape that emits.
#[derive(Clone, Debug)]
pub struct AreaLight {
    form: Form,
    radiance: ColorInput,
    mean_radiance: Rgb,
    area: f32,
}

#[derive(Clone, Debug)]
enum Form {
    Mesh { triangles: Vec<Triangle>, choice: AliasTable },
    Parallelogram { shape: Parallelogram, picture: Option<Box<Picture>> },
    Sphere { center: Vec3, radius: f32, frame: glam::Mat3, inwards: bool },
    Disk { center: Vec3, u_axis: Vec3, v_axis: Vec3, normal: Vec3 },
    Cylinder(Cylinder),
}

/// A piece of a light that can be sampled without a branch.
pub(super) enum Piece {
    /// With the density of its points, in the inverse of a square unit of length.
    Patch(Patch, f32),
    /// A sphere that is seen from outside.
    Ball { center: Vec3, radius: f32 },
    /// The image around the scene.
    Sky,
}

impl AreaLight {
    /// What it emits, per point.
    pub(crate) fn emission(&self) -> ColorInput {
        self.radiance
    }

    /// A mesh whose triangles shine. `None` if it has no area.
    pub(crate) fn mesh(
        mut triangles: Vec<Triangle>,
        radiance: ColorInput,
        textures: &Textures,
    ) -> Option<Self> {
        let areas: Vec<f32> = triangles.iter().map(|t| t.patch().area()).collect();
        let area = areas.iter().map(|&a| f64::from(a)).sum::<f64>() as f32;
        let by_area = AliasTable::new(&areas).ok()?;
        let textured = matches!(radiance, ColorInput::Texture(_));
        if let Some(shape) = Parallelogram::from_triangles(&triangles) {
            let picture = || Picture::new(|at| textures.color(radiance, shape.uv(at))).map(Box::new);
            let picture = if textured { picture() } else { None };
            let mean = picture.as_ref().map_or_else(|| textures.average(radiance), |p| p.mean);
            return Some(Self::new(Form::Parallelogram { shape, picture }, radiance, area, mean));
        }
        let (mut choice, mut mean_radiance) = (by_area, textures.average(radiance));
        triangles.iter_mut().for_each(|t| t.pdf_area = 1.0 / area);
        if textured {
            let (weights, mean) =
                picture::triangle_weights(&areas, |i, at| textures.color(radiance, triangles[i].uv(at)));
            mean_radiance = mean;
            if let Ok(by_power) = AliasTable::new(&weights) {
                for (i, triangle) in triangles.iter_mut().enumerate().filter(|&(i, _)| areas[i] > 0.0) {
                    triangle.pdf_area = by_power.pdf(i) / areas[i];
                }
                choice = by_power;
            }
        }
        Some(Self::new(Form::Mesh { triangles, choice }, radiance, area, mean_radiance))
    }

    /// A sphere that shines outwards (inwards if `inwards`).
    pub(crate) fn sphere(
        center: Vec3,
        radius: f32,
        frame: glam::Mat3,
        inwards: bool,
        radiance: ColorInput,
        textures: &Textures,
    ) -> Self {
        let form = Form::Sphere { center, radius, frame, inwards };
        Self::new(form, radiance, 4.0 * PI * radius * radius, textures.average(radiance))
    }

    /// A disk or ellipse that shines towards `normal`.
    pub(crate) fn disk(
        center: Vec3,
        u_axis: Vec3,
        v_axis: Vec3,
        normal: Vec3,
        radiance: ColorInput,
        textures: &Textures,
    ) -> Self {
        let area = PI * flat::cross(u_axis, v_axis).length() as f32;
        let form = Form::Disk { center, u_axis, v_axis, normal };
        Self::new(form, radiance, area, textures.average(radiance))
    }

    /// The side of a cylinder.
    pub(crate) fn cylinder(cylinder: Cylinder, radiance: ColorInput, textures: &Textures) -> Self {
        let area = 2.0 * PI * cylinder.radius * cylinder.length;
        Self::new(Form::Cylinder(cylinder), radiance, area, textures.average(radiance))
    }

    fn new(form: Form, radiance: ColorInput, area: f32, mean_radiance: Rgb) -> Self {
        Self { form, radiance, mean_radiance, area }
    }

    /// Surface area, one side.
    pub fn area(&self) -> f32 {
        self.area
    }

    /// Emitted power: π A times the mean radiance.
    pub fn power(&self) -> Rgb {
        PI * self.area * self.mean_radiance
    }

    /// Radiance leaving a point of the surface with emitting normal `ng` in direction `w`.
    #[inline]
    pub fn emitted(&self, ng: Vec3, uv: Vec2, w: Vec3, textures: &Textures) -> Rgb {
        if ng.dot(w) > 0.0 { textures.color(self.radiance, uv) } else { Rgb::ZERO }
    }

    /// Does `sample` make use of `u_pick`?
    pub(super) fn must_pick(&self) -> bool {
        matches!(self.form, Form::Mesh { .. })
    }

    /// A piece, chosen by `u_pick`; `None` for a light of another form, whose radiance depends on the point, or which
    /// is so near that it is sampled by solid angle.
    #[inline(always)]
    pub(super) fn piece(&self, from: Vec3, u_pick: f32) -> Option<Piece> {
        let ColorInput::Constant(_) = self.radiance else { return None };
        let (patch, reach) = match &self.form {
            Form::Mesh { triangles, choice } => {
                let t = &triangles[choice.sample_and_reuse(u_pick).0.value];
                (t.patch(), t.reach)
            }
            Form::Parallelogram { shape, .. } => (shape.patch(), shape.reach),
            &Form::Sphere { center, radius, inwards: false, .. } => {
                return Some(Piece::Ball { center, radius });
            }
            Form::Sphere { .. } | Form::Disk { .. } | Form::Cylinder(_) => return None,
        };
        (!reach.holds(from, patch.normal)).then(|| Piece::Patch(patch, 1.0 / self.area))
    }

    /// Draws a direction from `from` to the light. `u_pick` chooses a triangle, `u` a point.
    #[inline(always)]
    pub(crate) fn sample(&self, light: LightId, from: Vec3, u_pick: f32, u: Vec2) -> Option<LightSample> {
        let (Seen { p, wi, pdf }, uv) = match &self.form {
            Form::Mesh { triangles, choice } => {
                let t = &triangles[choice.sample_and_reuse(u_pick).0.value];
                let (seen, at) = sample_triangle(t, from, u);
                (seen, t.uv(at))
            }
            Form::Parallelogram { shape, picture } => {
                let (seen, at) = self.sample_parallelogram(shape, picture.as_deref(), from, u)?;
                (seen, shape.uv(at))
            }
            Form::Disk { center, u_axis, v_axis, normal } => {
                let d = concentric_disk(u);
                let edges = [*u_axis, *v_axis];
                let patch = Patch { corner: *center, edges, normal: *normal, is_triangle: false };
                (patch.seen(d, 1.0 / self.area, from), disk_uv(d))
            }
            Form::Cylinder(c) => cylinder::sample(c, from, u),
            Form::Sphere { center, radius, inwards: true, .. } => {
                (sphere::sample_area(*center, *radius, from, u), Vec2::ZERO)
            }
            Form::Sphere { center, radius, .. } => {
                (sphere::sample_cone(*center, *radius, from, u), Vec2::ZERO)
            }
        };
        (pdf > 0.0).then_some(LightSample { wi, pdf, target: Target::Point(p), light, uv })
    }

    #[inline(always)]
    fn sample_parallelogram(
        &self,
        shape: &Parallelogram,
        picture: Option<&Picture>,
        from: Vec3,
        u: Vec2,
    ) -> Option<(Seen, Vec2)> {
        let patch = shape.patch();
        if let Some(picture) = picture {
            let Sample { value: at, pdf } = picture.sample(u)?;
            return Some((patch.seen(at, pdf / self.area, from), at));
        }
        if shape.reach.holds(from, shape.normal)
            && let Some(near) = patch.sample_near(from, u)
        {
            return Some(near);
        }
        Some((patch.sample(1.0 / self.area, from, u), u))
    }

    /// Radiance that a sampled point of the light emits towards where it was sampled from.
    #[inline]
    pub(crate) fn radiance(&self, s: &LightSample, textures: &Textures) -> Rgb {
        match (&self.form, s.target, self.radiance) {
            (_, _, ColorInput::Constant(radiance)) => radiance,
            (Form::Sphere { center, frame, .. }, Target::Point(p), textured) => {
                textures.color(textured, sphere::uv(frame, p - *center))
            }
            (_, _, textured) => textures.color(textured, s.uv),
        }
    }

    /// The density, in sr⁻¹, with which `sample` draws the direction from `from` to the point `p` of
    /// the light, on triangle `primitive` of its mesh, where the emitting normal is `ng`. 0 from behind.
    #[inline]
    pub fn pdf(&self, from: Vec3, p: Vec3, ng: Vec3, primitive: u32) -> f32 {
        let to_light = p - from;
        let distance_squared = to_light.length_squared();
        let cos_light = -ng.dot(to_light) / distance_squared.sqrt();
        if !(cos_light > 0.0) {
            return 0.0;
        }
        let pdf_area = match &self.form {
            &Form::Sphere { center, radius, inwards: false, .. } => {
                return sphere::cone_pdf(center, radius, from);
            }
            Form::Mesh { triangles, .. } => {
                let t = &triangles[primitive as usize];
                if t.reach.holds(from, t.normal)
                    && let Some(solid_angle) = t.patch().solid_angle(from)
                {
                    return t.pdf_area * t.patch().area() / solid_angle;
                }
                t.pdf_area
            }
            Form::Parallelogram { shape, picture: Some(picture) } => {
                picture.pdf(shape.coordinates_of(p)) / self.area
            }
            Form::Parallelogram { shape, picture: None } => {
                if shape.reach.holds(from, shape.normal)
                    && let Some(solid_angle) = shape.patch().solid_angle(from)
                {
                    return 1.0 / solid_angle;
                }
                1.0 / self.area
            }
            Form::Cylinder(c) => return cylinder::pdf(c, from, p),
            Form::Disk { .. } | Form::Sphere { .. } => 1.0 / self.area,
        };
        to_solid_angle(pdf_area, distance_squared, cos_light)
    }
}

/// A point of a triangle and its coordinates along the edges, drawn by solid angle or by area; the density has the choice
/// of the triangle in it.
#[inline(always)]
fn sample_triangle(t: &Triangle, from: Vec3, u: Vec2) -> (Seen, Vec2) {
    let patch = t.patch();
    if t.reach.holds(from, t.normal)
        && let Some((seen, at)) = patch.sample_near(from, u)
    {
        return (Seen { pdf: seen.pdf * (t.pdf_area * patch.area()), ..seen }, at);
    }
    let at = Patch::coordinates(true, u);
    (patch.seen(at, t.pdf_area, from), at)
}

/// Texture coordinates of a disk: radius and angle.
fn disk_uv(d: Vec2) -> Vec2 {
    let phi = d.y.atan2(d.x) / std::f32::consts::TAU;
    Vec2::new(d.length(), if phi < 0.0 { phi + 1.0 } else { phi })
}
