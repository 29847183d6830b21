//! Pictures on lights: where on a surface a textured light is bright.
//!
//! In: radiance as a function of the place. Out: weights in proportion to its luminance, none of them zero: what the
//! points that were looked at miss is still found.

use glam::Vec2;
use sr_sampling::warp::barycentrics;
use sr_sampling::{Distribution, PiecewiseConstant2D, Sample};
use sr_scene::Rgb;

use crate::texture::luminance;

/// The part of the mean that every weight has on top of its own.
const FLOOR: f32 = 0.05;
/// Cells along each edge of a parallelogram.
const CELLS: usize = 128;
/// Points along each side of a cell.
const POINTS_PER_CELL: usize = 3;
/// At most so many points of a mesh are looked at, but one for each triangle.
const MESH_POINTS: usize = 1 << 18;

/// A density over the unit square, in proportion to luminance.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    table: PiecewiseConstant2D,
    pub mean: Rgb,
}

impl Picture {
    /// Of the radiance at coordinates along the edges. `None` if all is black.
    pub fn new(radiance: impl Fn(Vec2) -> Rgb) -> Option<Self> {
        let side = CELLS * POINTS_PER_CELL;
        let (mut weights, mut mean) = (vec![0.0; CELLS * CELLS], glam::DVec3::ZERO);
        for y in 0..side {
            for x in 0..side {
                let color = radiance((Vec2::new(x as f32, y as f32) + 0.5) / side as f32);
                weights[y / POINTS_PER_CELL * CELLS + x / POINTS_PER_CELL] += luminance(color).max(0.0);
                mean += color.as_dvec3();
            }
        }
        add_floor(&mut weights, |_| 1.0);
        let table = PiecewiseConstant2D::new(&weights, CELLS).ok()?;
        Some(Self { table, mean: (mean / (side * side) as f64).as_vec3() })
    }

    pub fn sample(&self, u: Vec2) -> Option<Sample<sr_sampling::Plane>> {
        self.table.sample(u)
    }

    pub fn pdf(&self, at: Vec2) -> f32 {
        self.table.pdf(at)
    }
}

/// Weights of triangles in proportion to the power that each emits, and their mean radiance. `radiance` gets an index
/// and coordinates along that triangle's edges.
pub(super) fn triangle_weights(areas: &[f32], radiance: impl Fn(usize, Vec2) -> Rgb) -> (Vec<f32>, Rgb) {
    let side = ((MESH_POINTS / areas.len().max(1)) as f32).sqrt().clamp(1.0, 16.0) as usize;
    let (mut total, mut total_area) = (glam::DVec3::ZERO, 0.0_f64);
    let mut weights: Vec<f32> = (0..areas.len())
        .map(|i| {
            let mut sum = Rgb::ZERO;
            for k in 0..side * side {
                let u = (Vec2::new((k % side) as f32, (k / side) as f32) + 0.5) / side as f32;
                let b = barycentrics(u);
                sum += radiance(i, Vec2::new(b.y, b.z));
            }
            let mean = sum / (side * side) as f32;
            total += mean.as_dvec3() * f64::from(areas[i]);
            total_area += f64::from(areas[i]);
            luminance(mean).max(0.0) * areas[i]
        })
        .collect();
    add_floor(&mut weights, |i| areas[i] / (total_area / areas.len() as f64) as f32);
    (weights, (total / total_area).as_vec3())
}

/// Adds a part of the mean to each weight, in proportion to `size`, whose mean is 1.
fn add_floor(weights: &mut [f32], size: impl Fn(usize) -> f32) {
    let mean = (weights.iter().map(|&w| f64::from(w)).sum::<f64>() / weights.len() as f64) as f32;
    weights.iter_mut().enumerate().for_each(|(i, w)| *w += FLOOR * mean * size(i));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bright_places_are_likely_and_black_ones_possible() {
        let half = Picture::new(|at| if at.x < 0.5 { Rgb::splat(3.0) } else { Rgb::ZERO }).unwrap();
        assert!((half.mean.x - 1.5).abs() < 1e-5);
        let (bright, black) = (half.pdf(Vec2::splat(0.2)), half.pdf(Vec2::splat(0.8)));
        assert!((bright + black - 2.0).abs() < 1e-5 && black > 0.04 && bright > 1.9, "{bright} {black}");
        assert!(Picture::new(|_| Rgb::ZERO).is_none());
    }

    #[test]
    fn triangles_weigh_what_they_emit() {
        let (weights, mean) = triangle_weights(&[1.0, 3.0], |i, _| Rgb::splat([4.0, 0.0][i]));
        assert!((mean.x - 1.0).abs() < 1e-6);
        assert!((weights[0] - 4.05).abs() < 1e-5 && (weights[1] - 0.15).abs() < 1e-5, "{weights:?}");
    }
}
