//! Integrals over any space, with densities that are chosen at run time.
//!
//! An estimate of ∫ f(x) dx is the mean of f(X) / p(X), X drawn from p. The renderer knows its densities when it is
//! compiled ([`sr_sampling::Distribution`]); whoever integrates from Python, or lets a program learn a density, chooses
//! them while it runs. [`Density`] is the same idea for that: points of any number of coordinates, in double
//! precision, a block of them at a time, as [`Columns`].
//!
//! In: a density, an integrand, a sequence of points. Out: an estimate with an error that can be believed.
//! Nothing here knows rendering.

pub mod adaptive;
pub mod columns;
pub mod density;
pub mod distributions;
pub mod integrate;
pub mod points;
pub mod space;

pub use columns::{Columns, ColumnsMut};
pub use density::{Cumulative, Density, DensityError, Inverse};
pub use integrate::{Integral, IntegrateError, Plan, integrate};
pub use points::{Points, Sequence, UnknownSequence};
pub use space::Space;
