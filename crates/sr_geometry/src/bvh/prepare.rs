//! Making rays ready to walk, several at a time: a lane each.

use super::sheared::Sheared;
use super::slabs::Line;
use super::traverse::meets_nothing;
use crate::{BATCH, Bounds3, Rays};

/// Rays that are made ready at a time.
pub(super) const CHUNK: usize = 16;

/// [`Sheared`] and [`Line`] of several rays, by component.
pub(super) struct Prepared {
    longest: [u32; CHUNK],
    negative: [u32; CHUNK],
    sheared_origin: [[f32; CHUNK]; 3],
    shear: [[f32; CHUNK]; 3],
    near: [f32; CHUNK],
    origin_near: [[f32; CHUNK]; 3],
    origin_far: [[f32; CHUNK]; 3],
    inverse: [[f32; CHUNK]; 3],
    inverse_far: [[f32; CHUNK]; 3],
    t_max: [f32; CHUNK],
    /// Does a ray meet nothing? See [`super::traverse::meets_nothing`].
    nothing: [u32; CHUNK],
}

impl Prepared {
    pub const NONE: Self = {
        let (one, three) = ([0.0; CHUNK], [[0.0; CHUNK]; 3]);
        Self {
            longest: [0; CHUNK],
            negative: [0; CHUNK],
            sheared_origin: three,
            shear: three,
            near: one,
            origin_near: three,
            origin_far: three,
            inverse: three,
            inverse_far: three,
            t_max: one,
            nothing: [1; CHUNK],
        }
    };

    /// Prepares the rays from `first` on, of which there are [`CHUNK`], among boxes within `bounds`.
    #[inline(always)]
    pub fn prepare(&mut self, rays: &Rays, first: usize, bounds: &Bounds3) {
        let first = first.min(BATCH - CHUNK);
        for i in 0..CHUNK {
            let ray = rays.get(first + i);
            let sheared = Sheared::new(ray.origin, ray.direction);
            let line = Line::new(ray.origin, ray.direction, ray.t_max, bounds);
            self.longest[i] = sheared.longest;
            self.negative[i] = line.negative;
            self.near[i] = sheared.near;
            self.t_max[i] = ray.t_max;
            self.nothing[i] = u32::from(meets_nothing(&ray));
            for axis in 0..3 {
                self.sheared_origin[axis][i] = sheared.origin[axis];
                self.shear[axis][i] = sheared.shear[axis];
                self.origin_near[axis][i] = line.origin_near[axis];
                self.origin_far[axis][i] = line.origin_far[axis];
                self.inverse[axis][i] = line.inverse[axis];
                self.inverse_far[axis][i] = line.inverse_far[axis];
            }
        }
    }

    #[inline(always)]
    pub fn meets_nothing(&self, i: usize) -> bool {
        self.nothing[i % CHUNK] != 0
    }

    #[inline(always)]
    pub fn sheared(&self, i: usize) -> Sheared {
        let i = i % CHUNK;
        Sheared {
            longest: self.longest[i],
            origin: lane(&self.sheared_origin, i),
            shear: lane(&self.shear, i),
            near: self.near[i],
        }
    }

    #[inline(always)]
    pub fn line(&self, i: usize) -> Line {
        let i = i % CHUNK;
        Line {
            negative: self.negative[i],
            origin_near: lane(&self.origin_near, i),
            origin_far: lane(&self.origin_far, i),
            inverse: lane(&self.inverse, i),
            inverse_far: lane(&self.inverse_far, i),
            t_max: self.t_max[i],
        }
    }
}

#[inline(always)]
fn lane(v: &[[f32; CHUNK]; 3], i: usize) -> [f32; 3] {
    [v[0][i], v[1][i], v[2][i]]
}
