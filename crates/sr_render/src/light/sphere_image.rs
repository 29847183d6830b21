//! Images of all directions: where in an image a direction is, and what is there.
//!
//! In: unit vectors in the image's own space, or points (u, v) of the image, v = 0 the top row. Out: the other of the
//! two, and radiance, bilinear between texel centres across all seams. The centres of a latitude–longitude image's first and
//! last row are at the poles, as in Mitsuba. What light cannot be (negative numbers, NaN) is
//! black here; [`sr_scene`] has reported it.

use std::f32::consts::{FRAC_PI_4, PI, TAU};
use std::sync::Arc;

use glam::{Vec2, Vec3};
use sr_sampling::warp::unit_circle;
use sr_scene::{Image, Pixels, Rgb, SphereMapping};

use crate::texture::{Cells, bilinear, luminance, prefetch_texel, texel, to_cell};

/// Brighter than any light, and dim enough for sums of it to be finite.
const BRIGHTEST: f32 = 1e30;

/// An image with its mapping.
#[derive(Clone, Debug)]
pub(super) struct SphereImage {
    image: Arc<Image>,
    srgb: bool,
    pub mapping: SphereMapping,
}

impl SphereImage {
    /// 8-bit images are taken as sRGB-encoded.
    pub fn new(image: Arc<Image>, mapping: SphereMapping) -> Self {
        let srgb = matches!(image.pixels, Pixels::U8 { .. });
        Self { image, srgb, mapping }
    }

    pub fn width(&self) -> u32 {
        self.image.width
    }

    pub fn height(&self) -> u32 {
        self.image.height
    }

    /// Where a point of the image is between texels: the distance from the first ones' centres.
    #[inline(always)]
    fn in_texels(&self, uv: Vec2) -> Vec2 {
        let (width, height) = (self.image.width as f32, self.image.height as f32);
        Vec2::new(
            uv.x * width - 0.5,
            match self.mapping {
                SphereMapping::LatLong => uv.y * (height - 1.0),
                SphereMapping::EqualAreaOctahedral => uv.y * height - 0.5,
            },
        )
    }

    /// Asks for the memory of the texels around a point of a latitude–longitude image.
    #[inline(always)]
    pub fn prefetch(&self, uv: Vec2) {
        let at = self.in_texels(uv);
        let (x, y) = (self.column(to_cell(at.x)), to_cell(at.y));
        for y in [self.row(y), self.row(y + 1)] {
            prefetch_texel(&self.image, x, y);
        }
    }

    /// The value at a point of the image.
    #[inline]
    pub fn at(&self, uv: Vec2) -> Rgb {
        let at = self.in_texels(uv);
        let (x, y) = (to_cell(at.x), to_cell(at.y));
        let t = at - Vec2::new(x as f32, y as f32);
        let color = match self.mapping {
            SphereMapping::LatLong => {
                let (columns, rows) = ([self.column(x), self.column(x + 1)], [self.row(y), self.row(y + 1)]);
                bilinear(&self.image, self.srgb, &Cells { columns, rows, t })
            }
            SphereMapping::EqualAreaOctahedral => {
                let row = |y: i32| self.wrapped(x, y).lerp(self.wrapped(x + 1, y), t.x);
                row(y).lerp(row(y + 1), t.y)
            }
        };
        possible(color)
    }

    /// A texel, which may be over an edge of the image by one.
    fn wrapped(&self, x: i32, y: i32) -> Rgb {
        let (x, y) = match self.mapping {
            SphereMapping::LatLong => (self.column(x), self.row(y)),
            SphereMapping::EqualAreaOctahedral => {
                let (mut x, mut y, n) = (x, y, self.image.width as i32);
                // over an edge, the neighbour is the mirrored texel of the same edge
                if x < 0 || x >= n {
                    (x, y) = (x.clamp(0, n - 1), n - 1 - y);
                }
                if y < 0 || y >= n {
                    (x, y) = (n - 1 - x, y.clamp(0, n - 1));
                }
                (x as u32, y as u32)
            }
        };
        texel(&self.image, self.srgb, x, y)
    }

    #[inline(always)]
    fn column(&self, x: i32) -> u32 {
        let width = self.image.width;
        if (x as u32) < width { x as u32 } else { i64::from(x).rem_euclid(i64::from(width)) as u32 }
    }

    #[inline(always)]
    fn row(&self, y: i32) -> u32 {
        (y.max(0) as u32).min(self.image.height - 1)
    }

    /// The mean luminance over a texel's cell of what [`SphereImage::at`] gives: never 0 where it shines.
    pub fn cell_luminance(&self, x: u32, y: u32) -> f32 {
        let mut sum = 0.0;
        for (dy, wy) in [-1, 0, 1].map(|dy| (dy, self.row_share(y, dy))) {
            for (dx, wx) in [(-1, 0.125), (0, 0.75), (1, 0.125)] {
                let color = possible(self.wrapped(x as i32 + dx, y as i32 + dy));
                sum += wx * wy * luminance(color);
            }
        }
        sum
    }

    /// The mean weight of row `y` + `dy` in the cell of row `y`.
    fn row_share(&self, y: u32, dy: i32) -> f32 {
        // Cells are of equal height, and the middles of the first and the last row are at the poles.
        let (from, to) = match self.mapping {
            SphereMapping::LatLong => {
                let height = f64::from(self.image.height);
                let row = |y: f64| y * (height - 1.0) / height;
                (row(f64::from(y)), row(f64::from(y) + 1.0))
            }
            SphereMapping::EqualAreaOctahedral => (f64::from(y) - 0.5, f64::from(y) + 0.5),
        };
        // ∫ of a row's weight, a tent over its neighbours' middles.
        let up_to = |x: f64| {
            let x = (x - f64::from(y) - f64::from(dy)).clamp(-1.0, 1.0);
            if x < 0.0 { 0.5 * (1.0 + x) * (1.0 + x) } else { 1.0 - 0.5 * (1.0 - x) * (1.0 - x) }
        };
        if to > from {
            ((up_to(to) - up_to(from)) / (to - from)) as f32
        } else {
            f32::from(u8::from(dy == 0))
        }
    }

    /// The value of a texel.
    pub fn texel(&self, x: u32, y: u32) -> Rgb {
        possible(texel(&self.image, self.srgb, x, y))
    }

    /// The solid angle of a texel of row `y`, up to a factor that is the same for all.
    pub fn row_weight(&self, y: u32) -> f32 {
        match self.mapping {
            SphereMapping::LatLong => (PI * (y as f32 + 0.5) / self.image.height as f32).sin(),
            SphereMapping::EqualAreaOctahedral => 1.0,
        }
    }

    /// The mean over all directions.
    pub fn mean(&self) -> Rgb {
        let (mut sum, mut total) = (glam::DVec3::ZERO, 0.0);
        for y in 0..self.height() {
            let weight = f64::from(self.row_weight(y));
            for x in 0..self.width() {
                sum += self.texel(x, y).as_dvec3() * weight;
                total += weight;
            }
        }
        (sum / total).as_vec3()
    }

    /// Where a direction is.
    #[inline]
    pub fn uv_of(&self, local: Vec3) -> Vec2 {
        match self.mapping {
            SphereMapping::LatLong => lat_long_uv(local),
            SphereMapping::EqualAreaOctahedral => octahedral_uv(local),
        }
    }

    /// The direction at a point of the image.
    pub fn direction(&self, uv: Vec2) -> Vec3 {
        sphere_direction(self.mapping, uv)
    }

    /// A density over the image as one over directions, at a direction, in sr⁻¹: 0 where it has none.
    #[inline]
    pub fn per_solid_angle(&self, pdf_uv: f32, local: Vec3) -> f32 {
        match self.mapping {
            SphereMapping::LatLong => {
                let sin_theta = (local.x * local.x + local.z * local.z).sqrt();
                if sin_theta > 0.0 { per_solid_angle(pdf_uv, sin_theta) } else { 0.0 }
            }
            SphereMapping::EqualAreaOctahedral => pdf_uv / (2.0 * TAU),
        }
    }
}

/// The direction at a point of an image of all directions, v = 0 being its top row.
pub fn sphere_direction(mapping: SphereMapping, uv: Vec2) -> Vec3 {
    match mapping {
        SphereMapping::LatLong => {
            let (theta, phi) = (unit_circle(0.5 * uv.y), unit_circle(uv.x));
            Vec3::new(theta.y * phi.y, theta.x, -theta.y * phi.x)
        }
        SphereMapping::EqualAreaOctahedral => octahedral_direction(uv),
    }
}

/// What light can be: nothing negative, infinite or not a number.
#[inline(always)]
fn possible(color: Rgb) -> Rgb {
    // NaN stays through the first, and the maximum takes the other operand
    Rgb::from_array(color.to_array().map(|c| c.clamp(0.0, BRIGHTEST).max(0.0)))
}

/// A density over a latitude–longitude image as one over directions: dω = 2π² sin θ du dv.
#[inline(always)]
pub(super) fn per_solid_angle(pdf_uv: f32, sin_theta: f32) -> f32 {
    pdf_uv / (TAU * PI * sin_theta)
}

#[inline]
fn lat_long_uv(local: Vec3) -> Vec2 {
    let u = local.x.atan2(-local.z) / TAU;
    // atan2 of the two sides of the triangle keeps its precision at the poles, where acos loses it
    let v = (local.x * local.x + local.z * local.z).sqrt().atan2(local.y) / PI;
    Vec2::new(if u < 0.0 { u + 1.0 } else { u }, v)
}

/// Clarberg 2008: rings of the upper half-sphere become diamonds of the same area, the lower half is folded outwards.
fn octahedral_direction(uv: Vec2) -> Vec3 {
    let at = 2.0 * uv - 1.0;
    let (x, y) = (at.x.abs(), at.y.abs());
    let above = 1.0 - (x + y);
    let r = 1.0 - above.abs();
    let phi = if r > 0.0 { ((y - x) / r + 1.0) * FRAC_PI_4 } else { 0.0 };
    let (sin_phi, cos_phi) = phi.sin_cos();
    let across = r * (2.0 - r * r).max(0.0).sqrt();
    let z = (1.0 - r * r).copysign(above);
    Vec3::new((cos_phi * across).copysign(at.x), (sin_phi * across).copysign(at.y), z)
}

fn octahedral_uv(local: Vec3) -> Vec2 {
    let a = local.abs();
    // 1 − z, without its cancellation at the poles
    let r = ((a.x * a.x + a.y * a.y) / (1.0 + a.z)).sqrt();
    let phi = a.y.atan2(a.x) / std::f32::consts::FRAC_PI_2;
    let (mut x, mut y) = (r - phi * r, phi * r);
    if local.z < 0.0 {
        (x, y) = (1.0 - y, 1.0 - x);
    }
    let at = Vec2::new(x.copysign(local.x), y.copysign(local.y));
    (0.5 * (at + 1.0)).clamp(Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON / 2.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sr_sampling::warp::UniformSphere;
    use sr_sampling::{Distribution, Independent, SampleId, Sequence};

    fn image(width: u32, height: u32, data: Vec<f32>, mapping: SphereMapping) -> SphereImage {
        let pixels = Pixels::F32 { channels: 1, data };
        SphereImage::new(Arc::new(Image { name: "test".into(), width, height, pixels }), mapping)
    }

    fn directions() -> impl Iterator<Item = Vec3> {
        let sequence = Independent::new(1);
        let at = move |index| sequence.get_2d(SampleId { pixel: 0, index }, 0);
        (0..5000).filter_map(move |i| UniformSphere.sample(at(i))).map(|s| s.value)
    }

    #[test]
    fn directions_come_back() {
        for mapping in [SphereMapping::LatLong, SphereMapping::EqualAreaOctahedral] {
            let map = image(4, 4, vec![1.0; 16], mapping);
            let axes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
            for w in directions().chain(axes) {
                let uv = map.uv_of(w);
                assert!(uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all(), "{w}: {uv}");
                assert!(map.direction(uv).distance(w) < 2e-6, "{w}: {uv}, {}", map.direction(uv));
            }
        }
    }

    #[test]
    fn the_octahedron_lies_as_in_pbrt() {
        for (uv, w) in [
            (Vec2::new(0.5, 0.5), Vec3::Z),
            (Vec2::new(1.0, 0.5), Vec3::X),
            (Vec2::new(0.5, 1.0), Vec3::Y),
            (Vec2::new(0.0, 0.5), -Vec3::X),
            (Vec2::new(0.0, 0.0), -Vec3::Z),
            (Vec2::new(1.0, 1.0), -Vec3::Z),
        ] {
            assert!(octahedral_direction(uv).distance(w) < 1e-6, "{uv}");
        }
    }

    #[test]
    fn octahedral_cells_have_equal_solid_angles() {
        const N: usize = 8;
        let map = image(8, 8, vec![1.0; 64], SphereMapping::EqualAreaOctahedral);
        let mut counts = [0_u32; N * N];
        let sequence = Independent::new(3);
        for index in 0..64_000 {
            let w = UniformSphere.sample(sequence.get_2d(SampleId { pixel: 0, index }, 0)).unwrap().value;
            let cell = (map.uv_of(w) * N as f32).as_uvec2().min(glam::UVec2::splat(N as u32 - 1));
            counts[(cell.y * N as u32 + cell.x) as usize] += 1;
        }
        // 1000 ± 5 standard deviations
        assert!(counts.iter().all(|c| c.abs_diff(1000) < 160), "{counts:?}");
    }

    /// Smooth functions of direction stay smooth across every seam.
    #[test]
    fn seams_do_not_show() {
        let f = |w: Vec3| 2.0 + w.x + 0.5 * w.y - 0.7 * w.z;
        for mapping in [SphereMapping::LatLong, SphereMapping::EqualAreaOctahedral] {
            let (n, blank) = (64_u32, image(64, 64, vec![0.0; 4096], mapping));
            let value = |i: u32| {
                let (x, y) = ((i % n) as f32 + 0.5, (i / n) as f32);
                let v = match mapping {
                    SphereMapping::LatLong => y / (n - 1) as f32,
                    SphereMapping::EqualAreaOctahedral => (y + 0.5) / n as f32,
                };
                f(blank.direction(Vec2::new(x / n as f32, v)))
            };
            let map = image(n, n, (0..n * n).map(value).collect(), mapping);
            for w in directions() {
                assert!((map.at(map.uv_of(w)).x - f(w)).abs() < 0.05, "{mapping:?}, {w}");
            }
        }
    }

    #[test]
    fn rows_reach_the_poles() {
        let map = image(1, 3, vec![1.0, 2.0, 4.0], SphereMapping::LatLong);
        for (v, value) in [(0.0, 1.0), (0.25, 1.5), (0.5, 2.0), (0.75, 3.0), (1.0, 4.0)] {
            assert_eq!(map.at(Vec2::new(0.3, v)).x, value);
        }
        // Means over thirds of the height: (0 … ⅔), (⅔ … 4⁄3), (4⁄3 … 2) in rows.
        let means = [1.0 + 1.0 / 3.0, 2.0 + 1.0 / 12.0, 4.0 - 2.0 / 3.0];
        for (y, mean) in (0..).zip(means) {
            assert!((map.cell_luminance(0, y) - mean).abs() < 1e-6, "{}", map.cell_luminance(0, y));
        }
    }

    #[test]
    fn impossible_radiance_is_black_or_bright() {
        for mapping in [SphereMapping::LatLong, SphereMapping::EqualAreaOctahedral] {
            for bad in [f32::NAN, -1.0, f32::INFINITY, f32::NEG_INFINITY] {
                let map = image(1, 1, vec![bad], mapping);
                let value = map.at(Vec2::splat(0.3)).x;
                assert!((0.0..=BRIGHTEST).contains(&value), "{bad}: {value}");
                assert!(map.cell_luminance(0, 0).is_finite() && map.mean().is_finite());
            }
        }
    }
}
