//! Shared test cases. Each list is long on purpose: a test over it must assert that it is not empty.

mod blends;
pub mod bsdfs;
mod compensated;
pub mod densities;
pub mod density_tests;
pub mod distributions;
pub mod filters;
mod hair;
pub mod lights;
pub mod lobe;
mod principled;
pub mod scenes;

pub use bsdfs::{BsdfCase, bsdf_cases, bsdf_models, lossless_models};
pub use densities::{DensityCase, densities};
pub use distributions::{DistributionCase, distribution_cases};
pub use filters::{FILTERS, filters};
pub use lights::light_scenes;
pub use scenes::{KnownScene, known_scenes};
