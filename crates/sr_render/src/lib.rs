//! The compiled scene and whatever walks it: camera, textures, lights, film, integrators.
//!
//! In: a [`sr_scene::SceneDesc`]. Out: a [`RenderedImage`] with a standard error per pixel. Files are
//! written by [`output`]; nothing here reads one.
//!
//! Reading order: [`render()`], `pass`, [`film`], [`integrator`] (`strategies.rs`, then `path/mod.rs`), [`light`].

pub mod camera;
pub mod film;
pub mod filter;
pub mod image;
pub mod integrator;
pub mod light;
pub mod material;
pub mod output;
mod pairwise;
mod pass;
pub mod render;
pub mod scene;
pub mod strategy;
pub mod texture;
mod vertex;

pub use film::{Film, FilmError};
pub use image::RenderedImage;
pub use render::{Control, PassReport, RenderSettings, Stop, render};
pub use scene::{CompileError, Scene};
pub use strategy::{Basic, Density, Strategy, StrategyError};
