//! Where the uniforms come from: pure functions of (pixel, sample index, dimension, seed).

use glam::Vec2;

/// Which sample of which pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleId {
    /// An index that is unique to the pixel (or to the integral).
    pub pixel: u32,
    /// The index of the sample within the pixel.
    pub index: u32,
}

/// A source of uniforms in [0, 1). Pure: the same arguments give the same bits, in any order.
pub trait Sequence: Sync {
    /// One uniform.
    fn get_1d(&self, at: SampleId, dim: u32) -> f32;
    /// Two uniforms that are jointly well distributed.
    fn get_2d(&self, at: SampleId, dim: u32) -> Vec2;
}

/// Walks the dimensions of one sample in order.
#[derive(Clone, Copy, Debug)]
pub struct Cursor<'a, Q> {
    sequence: &'a Q,
    at: SampleId,
    dim: u32,
}

impl<'a, Q: Sequence> Cursor<'a, Q> {
    /// Starts at dimension 0 of sample `at`.
    pub fn new(sequence: &'a Q, at: SampleId) -> Self {
        Self { sequence, at, dim: 0 }
    }

    /// The next uniform; takes one dimension.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        let u = self.sequence.get_1d(self.at, self.dim);
        self.dim += 1;
        u
    }

    /// The next two uniforms; takes two dimensions.
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        let u = self.sequence.get_2d(self.at, self.dim);
        self.dim += 2;
        u
    }

    /// Jumps to a dimension, so that a fixed purpose keeps a fixed dimension.
    #[inline]
    pub fn seek(&mut self, dim: u32) {
        self.dim = dim;
    }
}
