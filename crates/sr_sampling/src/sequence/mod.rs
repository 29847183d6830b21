//! Where the uniforms come from: pure functions of (pixel, sample index, dimension, seed).
//!
//! In: a [`SampleId`] and a dimension. Out: numbers in [0, 1). Nothing here keeps state, so the
//! samples of a picture can be taken in any order, by any number of threads, and resumed.
//!
//! - [`Independent`]: every number is unrelated to every other. The baseline.
//! - [`OwenSobol`]: the points of a pixel fill each dimension, and each pair, evenly. The default.

mod cursor;
mod independent;
mod kind;
pub mod mix;
mod owen_sobol;

use glam::Vec2;

pub use cursor::Cursor;
pub use independent::Independent;
pub use kind::{SequenceKind, UnknownSequence};
pub use owen_sobol::OwenSobol;

/// Which sample of which pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleId {
    /// An index that is unique to the pixel (or to the integral).
    pub pixel: u32,
    /// The index of the sample within the pixel.
    pub index: u32,
}

/// A source of uniforms in [0, 1). Pure: the same arguments give the same bits, in any order.
///
/// A dimension is used by one call: `get_1d` takes `dim`, `get_2d` takes `dim` and `dim + 1`.
pub trait Sequence: Copy + Sync {
    /// One uniform.
    fn get_1d(&self, at: SampleId, dim: u32) -> f32;

    /// Two uniforms that are jointly well distributed.
    fn get_2d(&self, at: SampleId, dim: u32) -> Vec2;

    /// The same kind of points, randomised anew: independent of `self` and of every other `number`.
    ///
    /// The means of a few replicates are independent and identically distributed, so their spread is
    /// an honest error also where the points of one replicate are correlated by design.
    fn replicate(&self, number: u32) -> Self;
}
