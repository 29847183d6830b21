//! Distributions, to be chosen at run time: each is a [`Density`](crate::Density).
//!
//! In: parameters that a person can read; bad ones are a [`ParameterError`] that names the argument and the value.
//! Out: densities in double precision, drawn by inversion wherever that is possible, so that strata survive.
//!
//! - On the line ([`OnLine`]): [`Uniform`], [`Linear`], [`Tent`], [`Exponential`], [`Normal`], [`Power`]; [`truncate`]
//!   cuts any of them.
//! - In space: [`UniformBox`].
//! - Of others: [`Product`], [`Mixture`].

mod exponential;
mod line;
mod linear;
mod mixture;
mod normal;
mod parameter;
mod power;
mod product;
mod quadrature;
mod solve;
mod truncated;
mod uniform;

pub use exponential::Exponential;
pub use line::OnLine;
pub use linear::{Linear, Tent};
pub use mixture::Mixture;
pub use normal::{Normal, TruncatedNormal};
pub use parameter::ParameterError;
pub use power::Power;
pub use product::Product;
pub use truncated::truncate;
pub use uniform::{Uniform, UniformBox};
