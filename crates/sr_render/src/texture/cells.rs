//! Which texels are around a point of an image.

use glam::Vec2;
use sr_scene::{Image, Wrap};

/// Two columns and two rows of texels of an image, and where between their middles a point is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells {
    pub columns: [u32; 2],
    pub rows: [u32; 2],
    /// In [0, 1]².
    pub t: Vec2,
}

impl Cells {
    /// To fill arrays with.
    pub const NONE: Self = Self { columns: [0; 2], rows: [0; 2], t: Vec2::ZERO };

    /// Those around a point of the unit square, or beyond it.
    #[inline(always)]
    pub fn around(image: &Image, wrap: Wrap, uv: Vec2) -> Self {
        let (columns, tx) = neighbours(uv.x, image.width, wrap);
        let (rows, ty) = neighbours(uv.y, image.height, wrap);
        Self { columns, rows, t: Vec2::new(tx, ty) }
    }
}

/// The column and the row of the texel at a point.
#[inline(always)]
pub(super) fn nearest(image: &Image, wrap: Wrap, uv: Vec2) -> [u32; 2] {
    let at = |x: f32, size: u32| ((folded(x, wrap) * size as f32) as u32).min(size - 1);
    [at(uv.x, image.width), at(uv.y, image.height)]
}

#[inline(always)]
fn neighbours(x: f32, size: u32, wrap: Wrap) -> ([u32; 2], f32) {
    let at = folded(x, wrap) * size as f32 - 0.5;
    // From −1 on: what is folded is over an edge by one texel at most, and its neighbour there is the first or the last.
    let cell = to_cell(at);
    let last = size as i32 - 1;
    let (before_first, after_last) = if wrap == Wrap::Repeat { (last, 0) } else { (0, last) };
    let low = if cell < 0 { before_first } else { cell.min(last) };
    let high = if cell >= last { after_last } else { cell + 1 };
    ([low as u32, high as u32], (at - cell as f32).clamp(0.0, 1.0))
}

/// The point of [0, 1] that shows the same as `x`; 0 for what is no number.
#[inline(always)]
#[expect(clippy::manual_clamp, reason = "clamp leaves NaN as it is")]
fn folded(x: f32, wrap: Wrap) -> f32 {
    let within = match wrap {
        Wrap::Clamp => x,
        Wrap::Repeat => x - to_cell(x) as f32,
        Wrap::Mirror => {
            let x = x - 2.0 * to_cell(0.5 * x) as f32;
            if x > 1.0 { 2.0 - x } else { x }
        }
    };
    within.max(0.0).min(1.0)
}

/// The integer cell of a coordinate, kept away from the ends of `i32`. (`floor` is a library call without SSE 4.1.)
#[inline(always)]
pub(crate) fn to_cell(x: f32) -> i32 {
    let towards_zero = x.clamp(-1e9, 1e9) as i32;
    towards_zero - i32::from(towards_zero as f32 > x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texel `i` of a row that is continued without end.
    fn wrapped(i: i32, size: i32, wrap: Wrap) -> u32 {
        (match wrap {
            Wrap::Repeat => i.rem_euclid(size),
            Wrap::Clamp => i.clamp(0, size - 1),
            Wrap::Mirror => {
                let within = i.rem_euclid(size);
                if i.div_euclid(size) % 2 == 0 { within } else { size - 1 - within }
            }
        }) as u32
    }

    #[test]
    fn rows_continue_without_end() {
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for size in [1, 2, 3, 8, 13] {
                // eighths of texels: exact
                for step in -400..400 {
                    let at = step as f64 / 8.0;
                    let x = ((at + 0.5) / f64::from(size)) as f32;
                    let (neighbours, t) = neighbours(x, size as u32, wrap);
                    let value = |i: u32| f64::from(i) * 1.7;
                    let found =
                        value(neighbours[0]) * f64::from(1.0 - t) + value(neighbours[1]) * f64::from(t);
                    let cell = at.floor() as i32;
                    let [low, high] = [cell, cell + 1].map(|i| value(wrapped(i, size, wrap)));
                    let expected = low + (high - low) * (at - at.floor());
                    let error = (found - expected).abs();
                    assert!(
                        error < 2e-4 * f64::from(size),
                        "{wrap:?}, {size}, {at}: {found}, not {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn no_point_is_outside() {
        let odd = [f32::NAN, f32::INFINITY, -f32::INFINITY, 1e30, -1e30, -1e-30, 1.0, 0.0, -0.0, 1e9];
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for size in [1, 2, 7, 1 << 16] {
                for x in odd {
                    let (neighbours, t) = neighbours(x, size, wrap);
                    assert!(neighbours.iter().all(|&i| i < size), "{wrap:?}, {size}, {x}: {neighbours:?}");
                    assert!((0.0..=1.0).contains(&t), "{wrap:?}, {size}, {x}: {t}");
                }
            }
        }
    }
}
