//! Springs of consecutive points to neighbours at one offset: plain vector loads at both ends, each spring once.

use super::laws::{Law, Values};
use super::spring::SpringLanes;
use super::{BLOCK, LANES, Lanes, six};

/// Sets of lanes in a block.
pub(super) const SETS: usize = BLOCK / LANES;

/// Which points of a block have the spring: a bit for each.
pub(super) type Mask = [u32; SETS];

/// A value for each point of a block.
pub(super) type Block = [Lanes; SETS];

/// The points of one stripe.
pub(super) struct Ends<'a> {
    /// Positions and velocities (x y z u v w) of the points where springs begin, and of those where they end.
    pub near: [&'a Block; 6],
    pub far: [&'a Block; 6],
    /// Forces on both.
    pub near_force: [&'a mut Block; 3],
    pub far_force: [&'a mut Block; 3],
}

/// Adds the forces of one stripe.
#[inline(always)]
pub(super) fn accumulate(ends: Ends<'_>, mask: &Mask, law: &Law, values: &Values, springs: &mut SpringLanes) {
    let Ends { near, far, near_force: [near_x, near_y, near_z], far_force: [far_x, far_y, far_z] } = ends;
    for set in 0..SETS {
        if mask[set] == 0 {
            continue;
        }
        springs.fetch(six(near, |block| &block[set]), six(far, |block| &block[set]));
        springs.pull(values.lanes(law, set), mask[set]);
        springs.hand_out(0, &mut near_x[set], &mut far_x[set]);
        springs.hand_out(1, &mut near_y[set], &mut far_y[set]);
        springs.hand_out(2, &mut near_z[set], &mut far_z[set]);
    }
}

/// What lies at the points of a block, given what lies from the first of them on.
#[inline(always)]
pub(super) fn block(values: &[f32]) -> &Block {
    values.as_chunks().0.first_chunk().expect("arrays end with a block to spare")
}

#[inline(always)]
pub(super) fn block_mut(values: &mut [f32]) -> &mut Block {
    values.as_chunks_mut().0.first_chunk_mut().expect("arrays end with a block to spare")
}
