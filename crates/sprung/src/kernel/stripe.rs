//! Springs of consecutive points to neighbours at one offset: plain vector loads at both ends, each spring once.

use super::laws::{Law, Laws, Values};
use super::plan::{Plan, Stripe};
use super::spring::SpringLanes;
use super::{BLOCK, LANES, Lanes, six};

/// Sets of lanes in a block.
pub(super) const SETS: usize = BLOCK / LANES;

/// Which points of a block have the spring: a bit for each.
pub(super) type Mask = [u32; SETS];

/// A value for each point of a block.
pub(super) type Block = [Lanes; SETS];

/// The stripes that begin in a block, with their laws.
#[derive(Clone, Copy)]
pub(super) struct Stripes<'a> {
    stripes: &'a [Stripe],
    masks: &'a [Mask],
    laws: &'a [Law],
    values: &'a Values,
}

impl<'a> Stripes<'a> {
    #[inline(always)]
    pub fn new(plan: &'a Plan, laws: &'a Laws, block: usize) -> Self {
        let range = plan.blocks[block].stripes.clone();
        Self {
            stripes: &plan.stripes[range.clone()],
            masks: &laws.masks[range.clone()],
            laws: &laws.stripes[range],
            values: &laws.values,
        }
    }

    /// Adds the forces of their springs that begin at one set of the block's points: those on their far ends to `forces`.
    /// Returns the sums of those on their near ends.
    ///
    /// `points`: positions and velocities (x y z u v w) from the set's first point on, as far as stripes reach; `forces`:
    /// those on the same points.
    #[inline(always)]
    pub fn accumulate(
        self,
        set: usize,
        points: [&[f32]; 6],
        [far_x, far_y, far_z]: [&mut [f32]; 3],
        springs: &mut SpringLanes,
    ) -> [Lanes; 3] {
        let near = six(points, lanes);
        let [mut x, mut y, mut z] = [[0.0; LANES]; 3];
        for ((stripe, mask), law) in self.stripes.iter().zip(self.masks).zip(self.laws) {
            let (offset, mask) = (stripe.offset, mask[set]);
            if mask == 0 {
                continue;
            }
            springs.fetch(near, six(points, |array| lanes(&array[offset..])));
            springs.pull(self.values.lanes(law, set), mask);
            springs.hand_out(0, &mut x, lanes_mut(&mut far_x[offset..]));
            springs.hand_out(1, &mut y, lanes_mut(&mut far_y[offset..]));
            springs.hand_out(2, &mut z, lanes_mut(&mut far_z[offset..]));
        }
        [x, y, z]
    }
}

/// The first lanes of some values.
#[inline(always)]
pub(super) fn lanes(values: &[f32]) -> &Lanes {
    values.first_chunk().expect("arrays end with a block to spare")
}

#[inline(always)]
pub(super) fn lanes_mut(values: &mut [f32]) -> &mut Lanes {
    values.first_chunk_mut().expect("arrays end with a block to spare")
}

/// What lies at the points of a block, given what lies from the first of them on.
#[inline(always)]
pub(super) fn block<T>(values: &[T]) -> &[[T; LANES]; SETS] {
    values.as_chunks().0.first_chunk().expect("arrays end with a block to spare")
}

#[inline(always)]
pub(super) fn block_mut(values: &mut [f32]) -> &mut Block {
    values.as_chunks_mut().0.first_chunk_mut().expect("arrays end with a block to spare")
}
