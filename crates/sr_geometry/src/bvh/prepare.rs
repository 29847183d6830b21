//! Making rays ready to walk, several at a time: a lane each.

use std::cell::Cell;

use super::sheared::Sheared;
use super::slabs::Line;
use super::traverse::meets_nothing;
use crate::{BATCH, Bounds3, Ray, Rays};

/// Rays that are made ready at a time.
pub(super) const CHUNK: usize = 16;

/// A number of each ray. A little longer than needed: all that belongs to a ray would else be in the same few sets of a
/// cache.
type Row<T> = [T; BATCH + CHUNK];

/// [`Sheared`] and [`Line`] of the rays of a batch, by component.
#[repr(C, align(64))]
pub(super) struct Prepared {
    flips: Row<u32>,
    near_rows: [Row<u32>; 3],
    origin_near: [Row<f32>; 3],
    origin_far: [Row<f32>; 3],
    inverse: [Row<f32>; 3],
    inverse_far: [Row<f32>; 3],
    longest: Row<u32>,
    sheared_origin: [Row<f32>; 3],
    shear: [Row<f32>; 3],
    near: Row<f32>,
    /// Does a ray meet nothing? See [`super::traverse::meets_nothing`].
    nothing: Row<u32>,
}

thread_local! {
    /// Memory for a batch, which is not cleared between batches.
    static SPARE: Cell<Option<Box<Prepared>>> = const { Cell::new(None) };
}

impl Prepared {
    const NONE: Self = {
        let (numbers, bits) = ([0.0; BATCH + CHUNK], [0; BATCH + CHUNK]);
        Self {
            flips: bits,
            near_rows: [bits; 3],
            origin_near: [numbers; 3],
            origin_far: [numbers; 3],
            inverse: [numbers; 3],
            inverse_far: [numbers; 3],
            longest: bits,
            sheared_origin: [numbers; 3],
            shear: [numbers; 3],
            near: numbers,
            nothing: bits,
        }
    };

    /// Memory for a batch, with leftovers of another one.
    pub fn take_spare() -> Box<Self> {
        SPARE.take().unwrap_or_else(|| Box::new(Self::NONE))
    }

    /// Gives it back.
    pub fn keep_spare(self: Box<Self>) {
        SPARE.set(Some(self));
    }

    /// Prepares the [`CHUNK`] rays from `first` on, among boxes within `bounds`.
    #[inline(always)]
    pub fn prepare(&mut self, rays: &Rays, first: usize, bounds: &Bounds3) {
        let first = first.min(BATCH - CHUNK);
        for i in first..first + CHUNK {
            let ray = rays.get(i);
            self.set(i, &ray, bounds);
            self.nothing[i] = u32::from(meets_nothing(&ray));
        }
    }

    /// Prepares a ray.
    #[inline(always)]
    pub fn set(&mut self, i: usize, ray: &Ray, bounds: &Bounds3) {
        let line = Line::new(ray.origin, ray.direction, bounds);
        let sheared = Sheared::new(ray.origin, ray.direction);
        self.flips[i] = line.flips;
        self.longest[i] = sheared.longest;
        self.near[i] = sheared.near;
        for axis in 0..3 {
            self.near_rows[axis][i] = line.near[axis];
            self.origin_near[axis][i] = line.origin_near[axis];
            self.origin_far[axis][i] = line.origin_far[axis];
            self.inverse[axis][i] = line.inverse[axis];
            self.inverse_far[axis][i] = line.inverse_far[axis];
            self.sheared_origin[axis][i] = sheared.origin[axis];
            self.shear[axis][i] = sheared.shear[axis];
        }
    }

    #[inline(always)]
    pub fn meets_nothing(&self, i: usize) -> bool {
        self.nothing[i % BATCH] != 0
    }

    #[inline(always)]
    pub fn line(&self, i: usize) -> Line {
        let i = i % BATCH;
        Line {
            flips: self.flips[i],
            near: lane(&self.near_rows, i),
            origin_near: lane(&self.origin_near, i),
            origin_far: lane(&self.origin_far, i),
            inverse: lane(&self.inverse, i),
            inverse_far: lane(&self.inverse_far, i),
        }
    }

    #[inline(always)]
    pub fn sheared(&self, i: usize) -> Sheared {
        let i = i % BATCH;
        Sheared {
            longest: self.longest[i],
            origin: lane(&self.sheared_origin, i),
            shear: lane(&self.shear, i),
            near: self.near[i],
        }
    }
}

#[inline(always)]
fn lane<T: Copy>(v: &[Row<T>; 3], i: usize) -> [T; 3] {
    [v[0][i], v[1][i], v[2][i]]
}
