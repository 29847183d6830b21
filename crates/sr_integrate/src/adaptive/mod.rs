//! Densities that are learned from the integrand: adaptive importance sampling.
//!
//! In: an integrand and a density to start from. Out: a density that follows the integrand's size, and an estimate from
//! points that nothing was learned from, so that its error is as honest as that of any fixed density.
//!
//! - [`Axis`]: a smooth map of one coordinate, refined as vegas refines its grids.
//! - [`Component`]: a product of them, along the coordinates or turned axes.
//! - [`CubeDensity`]: a mixture of components, sampled by one low-discrepancy point each.
//! - [`Strata`]: how many points each part of the mixture's uniforms gets, where that helps: adaptive stratification.
//! - [`Level`]: what f / p is about in each, taken off its points' terms.
//! - [`learn`]: rounds of points, annealing, clusters, weights.
//! - [`Learned`]: the result, a [`Density`](crate::Density).
//! - [`adapt`]: learns, integrates, and says whether all rounds agree.
//!
//! Everything is learned on the unit cube of the uniforms that the base density consumes, so any density will do.

mod adapt;
mod axis;
mod cluster;
mod component;
mod cube;
mod learn;
mod learned;
mod level;
mod matrix;
mod parts;
mod round;
mod strata;
mod stratify;
mod training;
mod units;

pub use adapt::{Adapted, adapt};
pub use axis::Axis;
pub use component::{Component, Frame};
pub use cube::{CubeDensity, PARTS};
pub use learn::{Learning, Lesson, learn};
pub use learned::Learned;
pub use level::Level;
pub use parts::{Part, Parts, PartsError};
pub use round::Round;
pub use strata::{Strata, Written};
