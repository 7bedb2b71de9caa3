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
    // The loop over all sets once for each kind of law: the choice is made out here.
    match *law {
        Law::Same([k, d, rest]) => each_set(ends, mask, springs, |_, _| [k, d, rest]),
        Law::Lengths([k, d], first) => {
            let rest = values.block(first);
            each_set(ends, mask, springs, |set, lane| [k, d, rest[set][lane]]);
        }
        Law::Each(first) => {
            let all = values.block_of_three(first);
            each_set(ends, mask, springs, |set, lane| {
                let [k, d, rest] = &all[set];
                [k[lane], d[lane], rest[lane]]
            });
        }
    }
}

/// Adds the forces of a stripe whose springs have the law (k_s, k_d, L) at each set and lane.
#[inline(always)]
fn each_set(ends: Ends<'_>, mask: &Mask, springs: &mut SpringLanes, law: impl Fn(usize, usize) -> [f32; 3]) {
    let Ends { near, far, near_force: [near_x, near_y, near_z], far_force: [far_x, far_y, far_z] } = ends;
    for set in 0..SETS {
        if mask[set] == 0 {
            continue;
        }
        springs.fetch(six(near, |block| &block[set]), six(far, |block| &block[set]));
        springs.pull_by(mask[set], |lane| law(set, lane));
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
