//! Textures are looked up for many vertices at a time: first all ask for memory, then all read.

use sr_geometry::BATCH;
use sr_scene::Rgb;

use crate::material::Input;
use crate::scene::Scene;
use crate::texture::{Cells, TexturePoint};

/// Vertices with textures.
pub(super) struct Lookups {
    count: usize,
    vertex: [u32; BATCH],
    side: [u32; BATCH],
    points: [TexturePoint; BATCH],
    cells: [Cells; BATCH],
}

impl Lookups {
    pub const NONE: Self = Self {
        count: 0,
        vertex: [0; BATCH],
        side: [0; BATCH],
        points: [TexturePoint::ORIGIN; BATCH],
        cells: [Cells::NONE; BATCH],
    };

    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds vertex `i`, seen from a side of which textures have an input. At most [`BATCH`] calls may follow
    /// [`Lookups::clear`].
    #[inline(always)]
    pub fn push(&mut self, i: usize, side: u32, point: &TexturePoint) {
        let at = self.count % BATCH;
        (self.vertex[at], self.side[at], self.points[at]) = (i as u32, side, *point);
        self.count += 1;
    }

    /// Hands `set` each vertex, input and value. Each round is for one input of all vertices that have as many.
    #[inline(always)]
    pub fn carry_out(&mut self, scene: &Scene, mut set: impl FnMut(usize, Input, Rgb)) {
        let (materials, textures) = (&scene.materials, &scene.textures);
        let mut round = 0;
        while self.count > 0 {
            let count = self.count.min(BATCH);
            for k in 0..count {
                let textured = materials.side(self.side[k]).textured[round];
                self.cells[k] = textures.begin(textured.texture, &self.points[k]);
            }
            for k in 0..count {
                let textured = materials.side(self.side[k]).textured[round];
                let value = textures.finish(textured.texture, &self.cells[k], &self.points[k]);
                set(self.vertex[k] as usize % BATCH, textured.input, value);
            }
            round += 1;
            self.keep(count, |side| materials.side(side).textured.len() > round);
        }
    }

    /// Keeps the vertices whose sides fulfil a condition.
    #[inline(always)]
    fn keep(&mut self, count: usize, condition: impl Fn(u32) -> bool) {
        self.clear();
        for k in 0..count {
            let side = self.side[k];
            if condition(side) {
                let point = self.points[k];
                self.push(self.vertex[k] as usize, side, &point);
            }
        }
    }
}
