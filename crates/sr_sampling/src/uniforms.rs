//! What one sample consumes: numbers in [0, 1), in the shape that a distribution asks for.

use glam::Vec2;

use crate::sequence::{Cursor, Sequence};

/// One or more uniforms, taken from a sequence in order.
pub trait Uniforms: Copy {
    /// How many there are.
    const COUNT: usize;

    /// Takes as many dimensions as it has components.
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self;

    /// Writes them to a list, in the order in which they are drawn.
    ///
    /// # Panics
    /// If the list is shorter than [`COUNT`](Self::COUNT).
    fn write(self, out: &mut [f32]);
}

impl Uniforms for () {
    const COUNT: usize = 0;

    #[inline]
    fn draw<Q: Sequence>(_: &mut Cursor<'_, Q>) -> Self {}

    fn write(self, _: &mut [f32]) {}
}

impl Uniforms for f32 {
    const COUNT: usize = 1;

    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        cursor.next_1d()
    }

    fn write(self, out: &mut [f32]) {
        out[0] = self;
    }
}

impl Uniforms for Vec2 {
    const COUNT: usize = 2;

    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        cursor.next_2d()
    }

    fn write(self, out: &mut [f32]) {
        out[..2].copy_from_slice(&self.to_array());
    }
}

impl<A: Uniforms, B: Uniforms> Uniforms for (A, B) {
    const COUNT: usize = A::COUNT + B::COUNT;

    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        (A::draw(cursor), B::draw(cursor))
    }

    fn write(self, out: &mut [f32]) {
        self.0.write(out);
        self.1.write(&mut out[A::COUNT..]);
    }
}

impl<A: Uniforms, B: Uniforms, C: Uniforms> Uniforms for (A, B, C) {
    const COUNT: usize = A::COUNT + B::COUNT + C::COUNT;

    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        (A::draw(cursor), B::draw(cursor), C::draw(cursor))
    }

    fn write(self, out: &mut [f32]) {
        self.0.write(out);
        self.1.write(&mut out[A::COUNT..]);
        self.2.write(&mut out[A::COUNT + B::COUNT..]);
    }
}

impl<A: Uniforms, const N: usize> Uniforms for [A; N] {
    const COUNT: usize = N * A::COUNT;

    #[inline]
    fn draw<Q: Sequence>(cursor: &mut Cursor<'_, Q>) -> Self {
        std::array::from_fn(|_| A::draw(cursor))
    }

    fn write(self, out: &mut [f32]) {
        for (i, part) in self.into_iter().enumerate() {
            part.write(&mut out[i * A::COUNT..]);
        }
    }
}
