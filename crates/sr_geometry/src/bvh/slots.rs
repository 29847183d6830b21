//! Which slot of its node a child gets, so that walks meet children about front to back without sorting them.
//!
//! Children are halved along the axis in which their node is longest, each half along the next axis, the quarters along the
//! last, and the eighths once more along the first. A slot's number tells the halves, the first one in its highest bit.
//! A ray that goes the other way along an axis meets the halves in the other order, so the slots' numbers, with the bits of
//! the ray's negative components flipped, are the order in which it meets children (after Garanzha & Loop 2010, who have
//! eight).

use super::{NodeRef, WIDE};
use crate::Bounds3;

/// How often children are halved.
const HALVINGS: usize = WIDE.ilog2() as usize;

/// The slots of at most sixteen children, all different, and the axis along which they are halved first.
pub(super) fn slots(children: &[(Bounds3, NodeRef)]) -> ([usize; WIDE], usize) {
    let whole = children.iter().fold(Bounds3::EMPTY, |whole, (bounds, _)| whole.union(*bounds));
    let axis = whole.extent().max_position();
    let mut order: [u8; WIDE] = std::array::from_fn(|i| i as u8);
    let mut slots = [0; WIDE];
    let middles = children.iter().map(|(bounds, _)| (bounds.min + bounds.max).to_array());
    let mut places = [[0.0; 3]; WIDE];
    for (place, middle) in places.iter_mut().zip(middles) {
        *place = middle;
    }
    halve(&mut order[..children.len()], &places, (axis, HALVINGS), 0, &mut slots);
    (slots, axis)
}

/// Gives children that share the first bits of their slots the others.
fn halve(
    children: &mut [u8],
    places: &[[f32; 3]; WIDE],
    (axis, left): (usize, usize),
    first: usize,
    slots: &mut [usize; WIDE],
) {
    if left == 0 || children.is_empty() {
        for &child in &*children {
            slots[child as usize] = first;
        }
        return;
    }
    let place = |child: u8| places[child as usize % WIDE][axis];
    // By insertion: they are few.
    for end in 1..children.len() {
        let child = children[end];
        let mut at = end;
        while at > 0 && place(children[at - 1]) > place(child) {
            children[at] = children[at - 1];
            at -= 1;
        }
        children[at] = child;
    }
    let (low, high) = children.split_at_mut(children.len().div_ceil(2));
    let next = ((axis + 1) % 3, left - 1);
    halve(low, places, next, first, slots);
    halve(high, places, next, first + (1 << (left - 1)), slots);
}

/// Which bits of the slots' numbers are to be flipped for a ray, four for each axis of a node, from the lowest bits on.
/// `negative`: is the ray's component along an axis negative?
#[inline(always)]
pub(super) fn flips(negative: [u32; 3]) -> u32 {
    let along = |axis: usize| {
        let [a, b, c] = [negative[axis], negative[(axis + 1) % 3], negative[(axis + 2) % 3]];
        a << 3 | b << 2 | c << 1 | a
    };
    // The last slot is the first that a ray meets.
    (along(0) | along(1) << 4 | along(2) << 8) ^ 0xfff
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn slots_at(points: &[Vec3]) -> (Vec<usize>, usize) {
        let children: Vec<_> = points.iter().map(|&p| (Bounds3 { min: p, max: p }, NodeRef::NONE)).collect();
        let (slots, axis) = slots(&children);
        (slots[..points.len()].to_vec(), axis)
    }

    #[test]
    fn cells_of_a_grid_get_their_slots() {
        // Four along y, two along z and x.
        let cell = |slot: usize| {
            Vec3::new((slot >> 1 & 1) as f32, (2 * (slot >> 3) + (slot & 1)) as f32, (slot >> 2 & 1) as f32)
        };
        let order = [6, 13, 1, 4, 10, 7, 0, 15, 2, 5, 12, 3, 9, 8, 14, 11];
        assert_eq!(slots_at(&order.map(cell)), (order.to_vec(), 1));
    }

    #[test]
    fn rays_meet_slots_front_to_back() {
        let along = [Vec3::X, Vec3::Y, Vec3::Z];
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                let (slots, of_node) =
                    slots_at(&std::array::from_fn::<_, WIDE, _>(|i| i as f32 * along[axis]));
                let negative = (sign * along[axis]).to_array().map(|d| u32::from(d < 0.0));
                let flip = flips(negative) >> (4 * of_node) & 15;
                let mut met: Vec<usize> = (0..WIDE).collect();
                met.sort_by_key(|&i| std::cmp::Reverse(slots[i] ^ flip as usize));
                let expected: Vec<usize> =
                    if sign > 0.0 { (0..WIDE).collect() } else { (0..WIDE).rev().collect() };
                // In halves: the axes between the first and the last halving are not theirs.
                let half = |i: &usize| i / 8;
                assert_eq!(
                    met.iter().map(half).collect::<Vec<_>>(),
                    expected.iter().map(half).collect::<Vec<_>>()
                );
            }
        }
    }

    #[test]
    fn no_two_children_get_the_same_slot() {
        for size in [1.0, 0.0, 3e38, f32::NAN] {
            for count in 1..=WIDE {
                let points: Vec<_> = (0..count).map(|i| size * Vec3::new(1.0, i as f32 / 8.0, 0.5)).collect();
                let (mut slots, _) = slots_at(&points);
                slots.sort_unstable();
                slots.dedup();
                assert_eq!(slots.len(), count, "{count} of size {size}");
            }
        }
    }
}
