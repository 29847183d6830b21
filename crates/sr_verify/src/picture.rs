//! Two pictures of a distribution of directions: where its samples go, and where its density says that they go.

use std::f32::consts::TAU;

use glam::Vec3;
use sr_sampling::{Cursor, Distribution, Independent, SampleId, SolidAngle, Uniforms};

/// Rows of cos θ from 1 to −1 and columns of azimuth from 0 to 2π; cells of equal solid angle.
pub const ROWS: usize = 48;
/// See [`ROWS`].
pub const COLUMNS: usize = 96;

const SAMPLES: u32 = 1 << 18;
/// Points in a cell at which the density is evaluated, along each side.
const POINTS: usize = 4;

/// Shares of all samples in each cell, row after row.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Those that were drawn.
    pub drawn: Vec<f64>,
    /// Those that the density asks for.
    pub expected: Vec<f64>,
}

impl Picture {
    /// Of a distribution of directions.
    pub fn of<D: Distribution<Measure = SolidAngle>>(distribution: &D, seed: u64) -> Self {
        let mut drawn = vec![0.0; ROWS * COLUMNS];
        let sequence = Independent::new(seed);
        for index in 0..SAMPLES {
            let mut cursor = Cursor::new(&sequence, SampleId { pixel: 0, index });
            if let Some(sample) = distribution.sample(D::Uniform::draw(&mut cursor)) {
                drawn[cell_of(sample.value)] += 1.0 / f64::from(SAMPLES);
            }
        }
        let solid_angle = 2.0 * f64::from(TAU) / (ROWS * COLUMNS) as f64;
        let expected = (0..ROWS * COLUMNS).map(|cell| {
            let points = (0..POINTS * POINTS).map(|k| f64::from(distribution.pdf(point(cell, k))));
            points.sum::<f64>() / (POINTS * POINTS) as f64 * solid_angle
        });
        Self { expected: expected.collect(), drawn }
    }
}

fn cell_of(w: Vec3) -> usize {
    let part = |x: f32, n: usize| ((x * n as f32).max(0.0) as usize).min(n - 1);
    let azimuth = (w.y.atan2(w.x) / TAU).rem_euclid(1.0);
    part(0.5 - 0.5 * w.z, ROWS) * COLUMNS + part(azimuth, COLUMNS)
}

fn point(cell: usize, k: usize) -> Vec3 {
    let at = |cell: usize, k: usize, n: usize| (cell as f32 + (k as f32 + 0.5) / POINTS as f32) / n as f32;
    let z = 1.0 - 2.0 * at(cell / COLUMNS, k / POINTS, ROWS);
    let (sin, cos) = (TAU * at(cell % COLUMNS, k % POINTS, COLUMNS)).sin_cos();
    (Vec3::new(cos, sin, 0.0) * (1.0 - z * z).max(0.0).sqrt()).with_z(z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sr_sampling::warp::CosineHemisphere;

    #[test]
    fn both_pictures_of_a_right_sampler_are_alike() {
        let picture = Picture::of(&CosineHemisphere, 1);
        assert!((picture.drawn.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        assert!((picture.expected.iter().sum::<f64>() - 1.0).abs() < 1e-3);
        let off = picture.drawn.iter().zip(&picture.expected).map(|(a, b)| (a - b).abs()).sum::<f64>();
        assert!(off < 0.2, "{off}");
    }
}
