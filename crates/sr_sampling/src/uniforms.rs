//! What one sample consumes: numbers in [0, 1), in the shape that a distribution asks for.

use glam::Vec2;

use crate::sequence::{Cursor, Sequence};

/// One or more uniforms, taken from a sequence in order.
pub trait Uniforms: Copy {
    /// Takes as many dimensions as it has components.
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self;
}

impl Uniforms for () {
    #[inline]
    fn draw<Q: Sequence>(_: &mut Cursor<'_, Q>) -> Self {}
}

impl Uniforms for f32 {
    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        cursor.next_1d()
    }
}

impl Uniforms for Vec2 {
    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        cursor.next_2d()
    }
}

impl<A: Uniforms, B: Uniforms> Uniforms for (A, B) {
    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        (A::draw(cursor), B::draw(cursor))
    }
}

impl<A: Uniforms, B: Uniforms, C: Uniforms> Uniforms for (A, B, C) {
    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        (A::draw(cursor), B::draw(cursor), C::draw(cursor))
    }
}

impl<A: Uniforms, const N: usize> Uniforms for [A; N] {
    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        std::array::from_fn(|_| A::draw(cursor))
    }
}
