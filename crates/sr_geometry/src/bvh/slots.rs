//! Which slot of its node a child gets, so that walks meet children about front to back without sorting them.
//!
//! Bit k of a slot's number tells to which side of its node along axis k a child lies. A ray of which component k is
//! negative meets slots with that bit first, so the slots' numbers, with the bits of the ray's negative components
//! flipped, are the order in which it meets children (Garanzha & Loop 2010; the assignment is as in Ylitie, Karras &
//! Laine 2017, but greedy).

use glam::Vec3;

use super::{NodeRef, WIDTH};
use crate::Bounds3;

/// The slots of at most eight children, all different.
pub(super) fn slots(children: &[(Bounds3, NodeRef)]) -> [usize; WIDTH] {
    let whole = children.iter().fold(Bounds3::EMPTY, |whole, (bounds, _)| whole.union(*bounds));
    let middle = twice_middle(&whole);
    let mut slots = [0; WIDTH];
    let mut lies = [Vec3::ZERO; WIDTH];
    for (lie, (bounds, _)) in lies.iter_mut().zip(children) {
        *lie = twice_middle(bounds) - middle;
    }
    let (mut left, mut free) = ((1_u32 << children.len()) - 1, (1_u32 << WIDTH) - 1);
    while left != 0 {
        let (mut best, mut chosen) = (f32::NEG_INFINITY, (left.trailing_zeros(), free.trailing_zeros()));
        for child in set(left) {
            for slot in set(free) {
                let towards = |axis: u32| if slot >> axis & 1 != 0 { 1.0 } else { -1.0 };
                let fit = lies[child as usize].dot(Vec3::new(towards(0), towards(1), towards(2)));
                if fit > best {
                    (best, chosen) = (fit, (child, slot));
                }
            }
        }
        let (child, slot) = chosen;
        slots[child as usize] = slot as usize;
        left &= !(1 << child);
        free &= !(1 << slot);
    }
    slots
}

fn twice_middle(bounds: &Bounds3) -> Vec3 {
    bounds.min + bounds.max
}

/// The numbers of the bits that are set.
fn set(bits: u32) -> impl Iterator<Item = u32> {
    (0..WIDTH as u32).filter(move |i| bits >> i & 1 != 0)
}
