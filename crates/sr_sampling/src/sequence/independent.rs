//! Independent uniforms: a counter, hashed.

use glam::Vec2;

use super::mix::{derive_key, hash, mix64, to_unit};
use super::{SampleId, Sequence};

/// Uniforms that have nothing to do with one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Independent {
    key: u64,
}

impl Independent {
    /// The sequence of a seed; different seeds give unrelated numbers.
    pub fn new(seed: u64) -> Self {
        Self { key: mix64(seed) }
    }
}

impl Sequence for Independent {
    #[inline]
    fn get_1d(&self, at: SampleId, dim: u32) -> f32 {
        to_unit((hash(self.key, at.pixel, at.index, dim) >> 32) as u32)
    }

    #[inline]
    fn get_2d(&self, at: SampleId, dim: u32) -> Vec2 {
        let bits = hash(self.key, at.pixel, at.index, dim);
        Vec2::new(to_unit((bits >> 32) as u32), to_unit(bits as u32))
    }

    #[inline]
    fn replicate(&self, number: u32) -> Self {
        Self { key: derive_key(self.key, number) }
    }
}
