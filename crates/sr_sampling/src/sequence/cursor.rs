//! A sample's dimensions, one after the other.

use glam::Vec2;

use super::{SampleId, Sequence};

/// Walks the dimensions of one sample in order.
#[derive(Clone, Copy, Debug)]
pub struct Cursor<'a, Q> {
    sequence: &'a Q,
    at: SampleId,
    dim: u32,
}

impl<'a, Q: Sequence> Cursor<'a, Q> {
    /// Starts at dimension 0 of sample `at`.
    #[inline]
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

    /// Another walk of the same sample, from a dimension.
    #[inline]
    pub fn at(&self, dim: u32) -> Self {
        Self { dim, ..*self }
    }

    /// Jumps to a dimension, so that a fixed purpose keeps a fixed dimension.
    #[inline]
    pub fn seek(&mut self, dim: u32) {
        self.dim = dim;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::OwenSobol;

    #[test]
    fn takes_each_dimension_once() {
        let sequence = OwenSobol::new(1);
        let at = SampleId { pixel: 3, index: 4 };
        let mut cursor = Cursor::new(&sequence, at);
        assert_eq!(cursor.next_1d(), sequence.get_1d(at, 0));
        assert_eq!(cursor.next_2d(), sequence.get_2d(at, 1));
        assert_eq!(cursor.next_1d(), sequence.get_1d(at, 3));
        cursor.seek(1);
        assert_eq!(cursor.next_2d(), sequence.get_2d(at, 1));
    }
}
