//! Shapes that shine: diffuse emission from the front of a mesh, a sphere or a disk.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};
use sr_sampling::warp::{barycentrics, concentric_disk};
use sr_sampling::{AliasTable, Plane, Sample, to_solid_angle};
use sr_scene::{ColorInput, Rgb};

use super::{LightId, LightSample, Target};
use crate::texture::Textures;

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
    Mesh { triangles: Vec<Triangle>, by_area: AliasTable },
    Parallelogram(Parallelogram),
    Sphere { center: Vec3, radius: f32, frame: glam::Mat3, inwards: bool },
    Disk { center: Vec3, u_axis: Vec3, v_axis: Vec3, normal: Vec3 },
}

/// One triangle of an emitting mesh: what sampling needs, in one place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    /// Corners.
    pub positions: [Vec3; 3],
    /// Texture coordinates at the corners.
    pub uvs: [Vec2; 3],
    /// Unit normal of the emitting side.
    pub normal: Vec3,
}

/// Two triangles that are one: sampled as a whole, so that strata survive.
#[derive(Clone, Copy, Debug)]
struct Parallelogram {
    corner: Vec3,
    edges: [Vec3; 2],
    normal: Vec3,
    corner_uv: Vec2,
    edge_uvs: [Vec2; 2],
}

impl Parallelogram {
    /// The parallelogram that two triangles make, if they share a diagonal and its texture coordinates.
    fn from_triangles(triangles: &[Triangle]) -> Option<Self> {
        let [t, other] = triangles else { return None };
        let shared = |i: usize| (0..3).find(|&j| t.vertex(i) == other.vertex(j));
        // the corner of `t` that `other` lacks is the one between the edges
        let apex = (0..3).find(|&i| shared(i).is_none())?;
        let (next, last) = ((apex + 1) % 3, (apex + 2) % 3);
        let (j, k) = (shared(next)?, shared(last)?);
        let far = 3_usize.checked_sub(j + k).filter(|_| j != k)?;
        let (corner, corner_uv) = t.vertex(apex);
        let edges = [next, last].map(|i| t.vertex(i).0 - corner);
        let edge_uvs = [next, last].map(|i| t.vertex(i).1 - corner_uv);
        let (far, far_uv) = other.vertex(far);
        let size = edges[0].length() + edges[1].length();
        let is_flat = (corner + edges[0] + edges[1] - far).length() <= 1e-6 * size;
        let maps_flat = (corner_uv + edge_uvs[0] + edge_uvs[1] - far_uv).length() <= 1e-6;
        (is_flat && maps_flat).then_some(Self { corner, edges, normal: t.normal, corner_uv, edge_uvs })
    }
}

impl Parallelogram {
    #[inline(always)]
    fn patch(&self) -> Patch {
        Patch { corner: self.corner, edges: self.edges, normal: self.normal, is_triangle: false }
    }
}

impl Triangle {
    #[inline(always)]
    fn patch(&self) -> Patch {
        let [corner, b, c] = self.positions;
        Patch { corner, edges: [b - corner, c - corner], normal: self.normal, is_triangle: true }
    }

    fn vertex(&self, i: usize) -> (Vec3, Vec2) {
        (self.positions[i], self.uvs[i])
    }
}

/// A flat piece of a light: a parallelogram, or the half of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    pub corner: Vec3,
    /// From the corner.
    pub edges: [Vec3; 2],
    /// Unit normal of the emitting side.
    pub normal: Vec3,
    pub is_triangle: bool,
}

/// A piece of a light that can be sampled without a branch.
pub(super) enum Piece {
    /// With the density of its points, in the inverse of a square unit of length.
    Patch(Patch, f32),
    /// A sphere that is seen from outside.
    Ball { center: Vec3, radius: f32 },
    /// A point of the image around the scene, with its density in the image.
    Sky(Sample<Plane>),
}

/// A point of a light, seen from another point.
pub(super) struct Seen {
    pub p: Vec3,
    /// Direction to it.
    pub wi: Vec3,
    /// Density in sr⁻¹; 0 if nothing is seen.
    pub pdf: f32,
}

impl Patch {
    /// Coordinates along the edges, uniform over the piece.
    #[inline(always)]
    fn coordinates(is_triangle: bool, u: Vec2) -> Vec2 {
        let b = barycentrics(u);
        if is_triangle { Vec2::new(b.y, b.z) } else { u }
    }

    /// Draws a point, with density `pdf_area` per square unit of length. Does not branch.
    #[inline(always)]
    pub fn sample(&self, pdf_area: f32, from: Vec3, u: Vec2) -> Seen {
        let at = Self::coordinates(self.is_triangle, u);
        let p = self.corner + at.x * self.edges[0] + at.y * self.edges[1];
        let to_light = p - from;
        let distance_squared = to_light.length_squared();
        let wi = to_light / distance_squared.sqrt();
        let cos_light = -self.normal.dot(wi);
        let pdf = to_solid_angle(pdf_area, distance_squared, cos_light);
        // The cosine is no number where the points coincide.
        let pdf = if cos_light > 0.0 && pdf < f32::INFINITY { pdf } else { 0.0 };
        Seen { p, wi, pdf }
    }
}

impl AreaLight {
    /// A mesh whose triangles shine. `None` if it has no area.
    pub(crate) fn mesh(triangles: Vec<Triangle>, radiance: ColorInput, textures: &Textures) -> Option<Self> {
        let area_of = |t: &Triangle| {
            let [a, b, c] = t.positions;
            0.5 * (b - a).cross(c - a).length()
        };
        let areas: Vec<f32> = triangles.iter().map(area_of).collect();
        let area = areas.iter().map(|&a| f64::from(a)).sum::<f64>() as f32;
        let by_area = AliasTable::new(&areas).ok()?;
        let form = match Parallelogram::from_triangles(&triangles) {
            Some(parallelogram) => Form::Parallelogram(parallelogram),
            None => Form::Mesh { triangles, by_area },
        };
        Some(Self::new(form, radiance, area, textures))
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
        Self::new(form, radiance, 4.0 * PI * radius * radius, textures)
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
        let area = PI * u_axis.cross(v_axis).length();
        Self::new(Form::Disk { center, u_axis, v_axis, normal }, radiance, area, textures)
    }

    fn new(form: Form, radiance: ColorInput, area: f32, textures: &Textures) -> Self {
        Self { form, radiance, mean_radiance: textures.average(radiance), area }
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

    /// A piece, chosen by `u_pick`; `None` for a light of another form, or whose radiance depends on the point.
    #[inline(always)]
    pub(super) fn piece(&self, u_pick: f32) -> Option<Piece> {
        let ColorInput::Constant(_) = self.radiance else { return None };
        let patch = match &self.form {
            Form::Mesh { triangles, by_area } => triangles[by_area.sample_and_reuse(u_pick).0.value].patch(),
            Form::Parallelogram(q) => q.patch(),
            &Form::Sphere { center, radius, inwards: false, .. } => {
                return Some(Piece::Ball { center, radius });
            }
            Form::Sphere { .. } | Form::Disk { .. } => return None,
        };
        Some(Piece::Patch(patch, 1.0 / self.area))
    }

    /// Draws a direction from `from` to the light. `u_pick` chooses a triangle, `u` a point.
    ///
    /// Triangles and disks are sampled by area; a sphere seen from outside by the cone it fills
    /// (Shirley, Wang & Zimmerman 1996).
    #[inline(always)]
    pub(crate) fn sample(&self, light: LightId, from: Vec3, u_pick: f32, u: Vec2) -> Option<LightSample> {
        let (patch, u, uv) = match &self.form {
            Form::Mesh { triangles, by_area } => {
                let t = &triangles[by_area.sample_and_reuse(u_pick).0.value];
                let at = Patch::coordinates(true, u);
                let [uv0, uv1, uv2] = t.uvs;
                (t.patch(), u, uv0 + at.x * (uv1 - uv0) + at.y * (uv2 - uv0))
            }
            Form::Parallelogram(q) => (q.patch(), u, q.corner_uv + u.x * q.edge_uvs[0] + u.y * q.edge_uvs[1]),
            Form::Disk { center, u_axis, v_axis, normal } => {
                let d = concentric_disk(u);
                let edges = [*u_axis, *v_axis];
                (Patch { corner: *center, edges, normal: *normal, is_triangle: false }, d, disk_uv(d))
            }
            Form::Sphere { center, radius, inwards, .. } => {
                let sample = if *inwards { sphere::sample_area } else { sphere::sample_cone };
                let Seen { p, wi, pdf } = sample(*center, *radius, from, u);
                let sample = LightSample { wi, pdf, target: Target::Point(p), light, uv: Vec2::ZERO };
                return (pdf > 0.0).then_some(sample);
            }
        };
        let s = patch.sample(1.0 / self.area, from, u);
        let target = Target::Point(s.p);
        (s.pdf > 0.0).then_some(LightSample { wi: s.wi, pdf: s.pdf, target, light, uv })
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
    /// the light, where the emitting normal is `ng`. 0 from behind.
    #[inline]
    pub fn pdf(&self, from: Vec3, p: Vec3, ng: Vec3) -> f32 {
        let to_light = p - from;
        let distance_squared = to_light.length_squared();
        let cos_light = -ng.dot(to_light) / distance_squared.sqrt();
        if !(cos_light > 0.0) {
            return 0.0;
        }
        if let Form::Sphere { center, radius, inwards: false, .. } = &self.form {
            return sphere::cone_pdf(*center, *radius, from);
        }
        to_solid_angle(1.0 / self.area, distance_squared, cos_light)
    }
}

/// Texture coordinates of a disk: radius and angle.
fn disk_uv(d: Vec2) -> Vec2 {
    let phi = d.y.atan2(d.x) / std::f32::consts::TAU;
    Vec2::new(d.length(), if phi < 0.0 { phi + 1.0 } else { phi })
}

/// Sampling a sphere from a point.
pub(super) mod sphere {
    use super::{PI, Seen, Vec2, Vec3, to_solid_angle};
    use sr_sampling::warp::{UniformCone, UniformSphere};
    use sr_sampling::{Distribution, Sample};

    /// The density of [`sample_cone`], in sr⁻¹; 0 from inside.
    pub(super) fn cone_pdf(center: Vec3, radius: f32, from: Vec3) -> f32 {
        let sin2 = radius * radius / (center - from).length_squared();
        UniformCone::from_sin2(sin2).map_or(0.0, |cone| 1.0 / cone.solid_angle())
    }

    /// A point of the visible cap, if there is one: nothing is seen from inside. Does not branch.
    #[inline(always)]
    pub(in super::super) fn sample_cone(center: Vec3, radius: f32, from: Vec3, u: Vec2) -> Seen {
        let axis = center - from;
        let distance_squared = axis.length_squared();
        let z = axis / distance_squared.sqrt();
        let (x, y) = z.any_orthonormal_pair();
        let drawn =
            UniformCone::from_sin2(radius * radius / distance_squared).ok().and_then(|cone| cone.sample(u));
        let Sample { value, pdf } = drawn.unwrap_or(Sample { value: Vec3::Z, pdf: 0.0 });
        let wi = (x * value.x + y * value.y + z * value.z).normalize();
        // the nearer intersection, from the closest approach to the centre
        let along = axis.dot(wi);
        let miss_squared = (axis - along * wi).length_squared();
        let half_chord = (radius * radius - miss_squared).max(0.0).sqrt();
        let offset = wi * (along - half_chord) - axis;
        Seen { p: center + offset * (radius / offset.length()), wi, pdf }
    }

    /// A point of the whole sphere whose inside is seen.
    pub(super) fn sample_area(center: Vec3, radius: f32, from: Vec3, u: Vec2) -> Seen {
        let normal = UniformSphere.sample(u).map_or(Vec3::Z, |s| s.value);
        let p = center + radius * normal;
        let to_light = p - from;
        let distance_squared = to_light.length_squared();
        let wi = to_light / distance_squared.sqrt();
        let pdf = to_solid_angle(1.0 / (4.0 * PI * radius * radius), distance_squared, normal.dot(wi));
        Seen { p, wi, pdf: if normal.dot(wi) > 0.0 && pdf.is_finite() { pdf } else { 0.0 } }
    }

    /// (φ / 2π, θ / π) in the sphere's frame.
    pub(super) fn uv(frame: &glam::Mat3, outwards: Vec3) -> Vec2 {
        let local = (frame.transpose() * outwards).normalize_or(Vec3::Z);
        let phi = local.y.atan2(local.x) / std::f32::consts::TAU;
        Vec2::new(if phi < 0.0 { phi + 1.0 } else { phi }, local.z.clamp(-1.0, 1.0).acos() / PI)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(positions: [Vec3; 3], uvs: [Vec2; 3]) -> Triangle {
        Triangle { positions, uvs, normal: Vec3::Z }
    }

    #[test]
    fn two_halves_of_a_square_are_one_parallelogram() {
        let at = |x: f32, y: f32| (Vec3::new(2.0 * x, y, 0.0), Vec2::new(x, y));
        let of = |corners: [(Vec3, Vec2); 3]| triangle(corners.map(|c| c.0), corners.map(|c| c.1));
        let (a, b, c, d) = (at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0));
        for second in [[a, c, d], [c, d, a], [d, a, c]] {
            let q = Parallelogram::from_triangles(&[of([a, b, c]), of(second)]).unwrap();
            assert_eq!(q.corner, b.0);
            assert_eq!(q.corner + q.edges[0] + q.edges[1], d.0);
        }
        let bent = at(0.0, 1.1);
        assert!(Parallelogram::from_triangles(&[of([a, b, c]), of([a, c, bent])]).is_none());
        assert!(Parallelogram::from_triangles(&[of([a, b, c]), of([a, b, c])]).is_none());
        assert!(Parallelogram::from_triangles(&[of([a, b, c])]).is_none());
    }
}
