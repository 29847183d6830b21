//! Which slot of its node a child gets, so that walks meet children about front to back without sorting them.
//!
//! Bit k of a slot's number tells to which side of its node along axis k a child lies. A ray of which component k is
//! negative meets slots with that bit first, so the slots' numbers, with the bits of the ray's negative components
//! flipped, are the order in which it meets children (Garanzha & Loop 2010; the assignment is as in Ylitie, Karras &
//! Laine 2017, but greedy).

use glam::Vec3;

use super::{NodeRef, WIDTH};
use crate::Bounds3;

/// A bit for each slot.
const ALL: u32 = (1 << WIDTH) - 1;

/// The slots of at most eight children, all different: again and again, the child that fits a free slot best gets it.
pub(super) fn slots(children: &[(Bounds3, NodeRef)]) -> [usize; WIDTH] {
    let whole = children.iter().fold(Bounds3::EMPTY, |whole, (bounds, _)| whole.union(*bounds));
    let middle = twice_middle(&whole);
    let mut fits = [[0.0; WIDTH]; WIDTH];
    let mut best = [0; WIDTH];
    for (child, (bounds, _)) in children.iter().enumerate() {
        fits[child] = fit(twice_middle(bounds) - middle);
        best[child] = best_of(&fits[child], ALL);
    }
    let mut slots = [0; WIDTH];
    let (mut left, mut free) = ((1_u32 << children.len()) - 1, ALL);
    while left != 0 {
        let mut child = left.trailing_zeros() as usize;
        for other in child + 1..children.len() {
            if left >> other & 1 != 0 && fits[other][best[other]] > fits[child][best[child]] {
                child = other;
            }
        }
        let slot = best[child];
        slots[child] = slot;
        left &= !(1 << child);
        free &= !(1 << slot);
        for other in 0..children.len() {
            if best[other] == slot && free != 0 {
                best[other] = best_of(&fits[other], free);
            }
        }
    }
    slots
}

/// How well a child that lies in a direction from the middle of its node fits each slot.
fn fit(Vec3 { x, y, z }: Vec3) -> [f32; WIDTH] {
    [-x - y - z, x - y - z, y - x - z, x + y - z, z - x - y, x - y + z, y - x + z, x + y + z]
}

/// The free slot with the largest number; the first of them if they are no numbers.
fn best_of(fits: &[f32; WIDTH], free: u32) -> usize {
    let mut best = free.trailing_zeros() as usize % WIDTH;
    for slot in best + 1..WIDTH {
        if free >> slot & 1 != 0 && fits[slot] > fits[best] {
            best = slot;
        }
    }
    best
}

fn twice_middle(bounds: &Bounds3) -> Vec3 {
    bounds.min + bounds.max
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slots_at(points: &[Vec3]) -> Vec<usize> {
        let children: Vec<_> = points.iter().map(|&p| (Bounds3 { min: p, max: p }, NodeRef::NONE)).collect();
        slots(&children)[..points.len()].to_vec()
    }

    #[test]
    fn corners_get_their_slots() {
        let corner = |slot: usize| Vec3::new((slot & 1) as f32, (slot >> 1 & 1) as f32, (slot >> 2) as f32);
        let order = [6, 1, 4, 7, 0, 2, 5, 3];
        assert_eq!(slots_at(&order.map(corner)), order);
    }

    #[test]
    fn no_two_children_get_the_same_slot() {
        for size in [1.0, 0.0, 3e38, f32::NAN] {
            for count in 1..=WIDTH {
                let points: Vec<_> = (0..count).map(|i| size * Vec3::new(1.0, i as f32 / 8.0, 0.5)).collect();
                let mut slots = slots_at(&points);
                slots.sort_unstable();
                slots.dedup();
                assert_eq!(slots.len(), count, "{count} of size {size}");
            }
        }
    }
}
