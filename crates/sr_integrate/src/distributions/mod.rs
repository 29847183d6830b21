//! Distributions, to be chosen at run time: each is a [`Density`](crate::Density).
//!
//! In: parameters that a person can read; bad ones are a [`ParameterError`] that names the argument and the
//! value. Out: densities in double precision, drawn by inversion wherever that is possible, so that strata
//! survive.
//!
//! - On the line ([`OnLine`]): [`Uniform`], [`Linear`], [`Tent`], [`Exponential`], [`Normal`], [`Power`];
//!   from tables [`PiecewiseConstant`] and [`PiecewiseLinear`]; from any function [`FromPdf`]. [`truncate`]
//!   cuts any of them.
//! - Of indices: [`Discrete`], [`Alias`].
//! - In the plane and in space: [`Disk`], [`Tabulated2D`], [`UniformBox`].
//! - Of directions: [`Cone`], [`Cosine`] and [`VonMisesFisher`] about any axis ([`Zonal`]); [`AreaLight`];
//!   [`VisibleNormals`]; [`spherical_triangle`], [`spherical_rectangle`], and any other distribution of
//!   `sr_sampling` through [`Typed`].
//! - Of others: [`Product`], [`Mixture`], [`Affine`].

mod affine;
mod area_light;
mod bins;
mod directions;
mod discrete;
mod disk;
mod exponential;
mod from_pdf;
mod line;
mod linear;
mod mixture;
mod normal;
mod parameter;
mod piecewise;
mod power;
mod product;
mod quadrature;
mod solve;
mod spherical;
mod tabulated_2d;
mod truncated;
mod typed;
mod uniform;
mod visible_normals;
mod zonal;

pub use affine::Affine;
pub use area_light::AreaLight;
pub use discrete::{Alias, Discrete};
pub use disk::Disk;
pub use exponential::Exponential;
pub use from_pdf::{Blocks, FromPdf};
pub use line::OnLine;
pub use linear::{Linear, Tent};
pub use mixture::Mixture;
pub use normal::{Normal, TruncatedNormal};
pub use parameter::ParameterError;
pub use piecewise::{PiecewiseConstant, PiecewiseLinear};
pub use power::Power;
pub use product::Product;
pub use spherical::{spherical_rectangle, spherical_triangle};
pub use tabulated_2d::Tabulated2D;
pub use truncated::truncate;
pub use typed::{Coordinates, Typed};
pub use uniform::{Uniform, UniformBox};
pub use visible_normals::VisibleNormals;
pub use zonal::{Cone, Cosine, Profile, VonMisesFisher, Zonal};
