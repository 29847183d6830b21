//! The compiled scene and whatever walks it: camera, textures, lights, film, integrators.
//!
//! In: a [`sr_scene::SceneDesc`]. Out: a [`RenderedImage`] with a standard error per pixel. Files are
//! written by [`output`]; nothing here reads one.

pub mod camera;
pub mod film;
pub mod filter;
pub mod image;
pub mod output;
pub mod strategy;

pub use film::{Film, FilmError};
pub use image::RenderedImage;
pub use strategy::{Basic, Density, Strategy, StrategyError};
