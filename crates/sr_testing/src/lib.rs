//! Shared test cases. Each list is long on purpose: a test over it must assert that it is not empty.

pub mod bsdfs;
pub mod distributions;
pub mod lobe;

pub use bsdfs::bsdf_cases;
pub use distributions::{DistributionCase, distribution_cases};
