//! The vertices of a batch, sorted by the loop that serves them.

use std::ops::Range;

use sr_geometry::BATCH;

use crate::material::{Face, Queue};

/// Which vertices wait in which queue. A queue is a part of one list.
pub(super) struct Queues {
    /// Which of the materials' sides each vertex is on.
    side: [u32; BATCH],
    queue: [u32; BATCH],
    /// Vertices, by queue.
    order: [u32; BATCH],
    /// How many wait in each queue; after [`Queues::sort`], where each ends in the list.
    ends: [u32; Queue::COUNT],
}

impl Queues {
    pub const EMPTY: Self =
        Self { side: [0; BATCH], queue: [0; BATCH], order: [0; BATCH], ends: [0; Queue::COUNT] };

    /// Lets all go.
    pub fn clear(&mut self) {
        self.ends.fill(0);
    }

    /// Lets vertex `i` wait.
    #[inline(always)]
    pub fn push(&mut self, i: usize, face: &Face) {
        (self.side[i], self.queue[i]) = (face.side, face.queue.0);
        self.ends[face.queue.0 as usize % Queue::COUNT] += 1;
    }

    /// Puts the first `count` vertices, which all wait, into the order of their queues (of which `queues` are used).
    /// Those of one queue stay in order.
    #[inline(always)]
    pub fn sort(&mut self, count: usize, queues: usize) {
        let mut end = 0;
        for n in &mut self.ends[..queues.min(Queue::COUNT)] {
            (*n, end) = (end, end + *n);
        }
        for i in 0..count.min(BATCH) {
            let end = &mut self.ends[self.queue[i] as usize % Queue::COUNT];
            self.order[*end as usize % BATCH] = i as u32;
            *end += 1;
        }
    }

    /// Where the vertices of a queue are in the list.
    #[inline(always)]
    pub fn range(&self, Queue(queue): Queue) -> Range<usize> {
        let queue = queue as usize % Queue::COUNT;
        let start = if queue == 0 { 0 } else { self.ends[queue - 1] };
        start as usize..self.ends[queue] as usize
    }

    /// The `k`-th vertex of the list, in a way that shows compilers that it is below [`BATCH`].
    #[inline(always)]
    pub fn get(&self, k: usize) -> usize {
        self.order[k % BATCH] as usize % BATCH
    }

    /// The materials' side on which vertex `i` is.
    #[inline(always)]
    pub fn side(&self, i: usize) -> u32 {
        self.side[i]
    }
}
