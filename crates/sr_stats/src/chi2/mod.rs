//! Do the samples of a distribution follow its density? Pearson's chi-square test.
//!
//! In: a [`Distribution`]. Out: a [`TestReport`]. The space is cut into cells; the density is
//! integrated over each, and samples are counted. A cell that holds more than its fair share is cut
//! further, so that the shape of a narrow peak is tested and not only its place. What the density
//! lacks to 1 is the probability of `None`, which is counted in a cell of its own.
//!
//! Distributions that are chosen at run time, in any number of dimensions, have a test of their own: [`blocks`].
//!
//! Certainly wrong, whatever the counts: a density that integrates to more than 1, is negative or not
//! finite; samples where the density is 0; samples whose `pdf` is not the density at them.

pub mod blocks;
mod chart;
mod counting;
mod pearson;
mod quadrature;
mod run;

use glam::{Vec2, Vec3};
use sr_sampling::{Area, Distribution, Estimate, Line, Plane, SolidAngle};

use crate::report::TestReport;
use chart::{Interval, Parallelogram, Rectangle, Sphere};

pub use counting::counting;
pub use pearson::{Cell, pearson};

/// How much work a test does. The same settings give the same report.
#[derive(Clone, Copy, Debug)]
pub struct Chi2Settings {
    /// The number of samples.
    pub samples: u32,
    /// Cells in two directions: in z and φ on the sphere, in x and y elsewhere.
    pub bins: (usize, usize),
    /// The seed of the samples.
    pub seed: u64,
}

impl Default for Chi2Settings {
    fn default() -> Self {
        Self { samples: 1 << 18, bins: (16, 32), seed: 1 }
    }
}

/// Tests a distribution of directions.
pub fn sphere<D: Distribution<Measure = SolidAngle>>(distribution: &D, settings: Chi2Settings) -> TestReport {
    run::run(distribution, &Sphere, settings)
}

/// What a density integrates to, and what is drawn of it.
#[derive(Clone, Copy, Debug)]
pub struct Mass {
    /// ∫ pdf, by adaptive quadrature.
    pub integral: f64,
    /// Its estimated error.
    pub error: f64,
    /// The share of samples that are not `None`.
    pub drawn: Estimate,
}

/// The mass of a distribution of directions: [`Mass::integral`] and [`Mass::drawn`] must agree.
///
/// # Errors
/// The report of [`sphere`], if something is certainly wrong with the samples.
pub fn mass_on_sphere<D: Distribution<Measure = SolidAngle>>(
    distribution: &D,
    settings: Chi2Settings,
) -> Result<Mass, TestReport> {
    run::count(distribution, &Sphere, settings).map(|counted| counted.mass())
}

/// Tests a distribution on the line, whose support lies between two numbers.
pub fn line<D: Distribution<Measure = Line>>(
    distribution: &D,
    range: [f32; 2],
    settings: Chi2Settings,
) -> TestReport {
    run::run(distribution, &Interval { range }, settings)
}

/// Tests a distribution in the plane, whose support lies between two corners.
pub fn plane<D: Distribution<Measure = Plane>>(
    distribution: &D,
    corners: [Vec2; 2],
    settings: Chi2Settings,
) -> TestReport {
    run::run(distribution, &Rectangle { corners }, settings)
}

/// Tests a distribution over a flat surface, which lies in a parallelogram.
///
/// - `corner`, `edges`: of the parallelogram; for a triangle, a vertex and the edges that leave it
pub fn area<D: Distribution<Measure = Area>>(
    distribution: &D,
    corner: Vec3,
    edges: [Vec3; 2],
    settings: Chi2Settings,
) -> TestReport {
    run::run(distribution, &Parallelogram { corner, edges }, settings)
}
