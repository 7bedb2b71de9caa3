//! The points that one thread sweeps.
//!
//! A region is some consecutive blocks, and copies of its neighbours' points as far as springs reach: those before it,
//! whose springs it evaluates once more, as they end at its own points, and those after it, where its own springs end.
//! Each of its points thus gets the very sums that it would get if one thread swept all points.

use std::ops::Range;

use super::aligned::Arrays;
use super::energy::{Sums, WidePositions};
use super::packed::Force;
use super::plan::{Plan, WINDOW};
use super::{BLOCK, GROUP, LANES};
use crate::params::Params;

/// Blocks that are swept, at the least, before the forces that reach beyond them are moved to the front of their arrays.
const LEAST_SLIDE: usize = 32;

/// A run of consecutive blocks with all that a step needs of them.
#[derive(Clone, Debug)]
pub(crate) struct Region {
    /// Its own blocks.
    pub blocks: Range<usize>,
    /// The block where its arrays begin: those from here to its own are its neighbour's.
    pub first_block: usize,
    /// x, y, z, u, v, w of its own points and of those around it.
    pub points: Arrays<6>,
    /// What rounding dropped of them.
    pub low: Arrays<6>,
    /// The same again, for a state that is kept: see [`Team::keep`](super::team::Team::keep).
    pub other: Option<[Arrays<6>; 2]>,
    /// Of its own points, 1/kg and kg; both zero where no force can move one.
    pub inverse_mass: Arrays<1>,
    pub mass: Arrays<1>,
    pub forces: Forces,
    /// Of each of its own blocks, while they are added up.
    pub energies: Vec<Sums>,
    /// While energies are computed.
    pub wide: WidePositions,
}

/// Sums of forces while they are needed.
#[derive(Debug)]
pub(super) struct Forces {
    /// On the points of one block, from springs that begin there.
    pub near: Arrays<3>,
    /// From stripes that end there, from the first block of the current slide on.
    pub far: Arrays<3>,
    /// From packed springs, from the same block on; empty where there are none.
    pub packed: Vec<Force>,
    pub slide: Slide,
}

/// How sums at the points where springs end are kept while they are needed: from the first block of a slide on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide {
    /// Blocks in it.
    blocks: usize,
    /// How far stripes may reach beyond the set of points where they begin, in whole sets.
    pub far_reach: usize,
    /// How far beyond a block packed springs may reach.
    packed_reach: usize,
    /// Whether there are packed springs.
    has_packed: bool,
}

impl Region {
    /// A region of these blocks.
    pub fn new(plan: &Plan, blocks: Range<usize>) -> Self {
        let first_block = blocks.start.saturating_sub(plan.border_blocks());
        // As far as its springs reach; and as blocks are read whole, one to spare.
        let len = (blocks.end - first_block) * BLOCK + plan.reach() + BLOCK;
        let window = if plan.bundles.is_empty() { 0 } else { WINDOW };
        Self {
            forces: Forces::new(plan, blocks.end - first_block),
            energies: vec![Sums::default(); blocks.len()],
            wide: WidePositions::new(plan, blocks.len()),
            blocks,
            first_block,
            points: Arrays::with_windows(len, window),
            low: Arrays::new(len),
            other: None,
            inverse_mass: Arrays::new(len),
            mass: Arrays::new(len),
        }
    }

    /// Sets the mass of what lies at an index of its arrays.
    pub fn set_mass(&mut self, at: usize, params: &Params, point: usize) {
        let ([inverse_mass], [mass]) = (self.inverse_mass.all_mut(), self.mass.all_mut());
        inverse_mass[at] = params.inverse_mass(point);
        mass[at] = if params.is_fixed(point) { 0.0 } else { params.point_mass[point] };
    }

    /// Copies where points of the region after it are, to the last bit, as far as its own springs reach.
    pub fn look_ahead(&mut self, plan: &Plan, next: &Self) {
        let (end, begin) = (self.index(self.blocks.end * BLOCK), next.index(next.blocks.start * BLOCK));
        for (here, there) in [(&mut self.points, &next.points), (&mut self.low, &next.low)] {
            for (here, there) in here.all_mut().into_iter().zip(there.all()) {
                here[end..end + plan.reach()].copy_from_slice(&there[begin..begin + plan.reach()]);
            }
        }
    }

    /// Copies where points of the region before it are, as far as springs of that reach.
    pub fn look_back(&mut self, previous: &Self) {
        let end = (self.blocks.start - self.first_block) * BLOCK;
        let begin = previous.index(self.first_block * BLOCK);
        for (here, there) in [(&mut self.points, &previous.points), (&mut self.low, &previous.low)] {
            for (here, there) in here.all_mut().into_iter().zip(there.all()) {
                here[..end].copy_from_slice(&there[begin..begin + end]);
            }
        }
    }

    /// Stops every point of its own: each that forces can move goes half a step of `dt` (s) back, and none has a velocity then.
    ///
    /// A step keeps, in a mode of squared frequency ω², not ½v² + ½ω²x² but ½v² + ½ω²x² − ½dt·ω²·x·v. At x − ½dt·v and at rest
    /// that is less by ½v²(1 − ¼ω²dt²), for every dt that is stable; at x it could be more, and a fast vibration would grow with
    /// every stop.
    pub fn stop(&mut self, dt: f64) {
        let own =
            (self.blocks.start - self.first_block) * BLOCK..(self.blocks.end - self.first_block) * BLOCK;
        let [x, y, z, u, v, w] = self.points.all_mut();
        let [x_low, y_low, z_low, u_low, v_low, w_low] = self.low.all_mut();
        let [inverse_mass] = self.inverse_mass.all();
        let whole = |high: f32, low: f32| f64::from(high) + f64::from(low);
        for (x, x_low, v, v_low) in [(x, x_low, u, u_low), (y, y_low, v, v_low), (z, z_low, w, w_low)] {
            for at in own.clone().filter(|&at| inverse_mass[at] > 0.0) {
                let exact = whole(x[at], x_low[at]) - 0.5 * dt * whole(v[at], v_low[at]);
                x[at] = exact as f32;
                x_low[at] = (exact - f64::from(x[at])) as f32;
            }
            v.fill(0.0);
            v_low.fill(0.0);
        }
    }

    /// Makes memory for a state that is kept, if there is none.
    pub fn prepare_to_keep(&mut self) {
        let alike = |arrays: &Arrays<6>| Arrays::with_windows(arrays.len(), arrays.spare());
        self.other.get_or_insert_with(|| [alike(&self.points), alike(&self.low)]);
    }

    /// Goes on with the other arrays.
    pub fn swap(&mut self) {
        if let Some([points, low]) = &mut self.other {
            std::mem::swap(points, &mut self.points);
            std::mem::swap(low, &mut self.low);
        }
    }

    /// Goes on with a copy in the other arrays: what is here is kept.
    pub fn move_away(&mut self) {
        if let Some([points, low]) = &mut self.other {
            points.clone_from(&self.points);
            low.clone_from(&self.low);
        }
        self.swap();
    }

    /// Where a place of its own or of the blocks before is in its arrays.
    #[inline(always)]
    pub fn index(&self, place: usize) -> usize {
        place - self.first_block * BLOCK
    }

    /// Whether a place is one of its own, or of a region before it.
    pub fn is_before_end(&self, place: u32) -> bool {
        (place as usize) < self.blocks.end * BLOCK
    }
}

impl Clone for Forces {
    /// Empty ones as large: every sweep begins its sums anew.
    fn clone(&self) -> Self {
        Self {
            near: Arrays::new(self.near.len()),
            far: Arrays::new(self.far.len()),
            packed: vec![[0.0; 4]; self.packed.len()],
            ..*self
        }
    }
}

impl Forces {
    fn new(plan: &Plan, blocks: usize) -> Self {
        let slide = Slide::new(plan, blocks);
        Self {
            near: Arrays::new(BLOCK),
            far: Arrays::new(slide.len()),
            packed: vec![[0.0; 4]; slide.packed_len()],
            slide,
        }
    }

    /// Before the block that is swept as number `count`: where its points are in `far`. See [`Slide::begin_block`].
    #[inline(always)]
    pub fn begin_block(&mut self, count: usize) -> usize {
        let Self { far, packed, slide, .. } = self;
        slide.begin_block(count, far, std::slice::from_mut(packed))
    }
}

impl Slide {
    /// For a region of so many blocks.
    pub fn new(plan: &Plan, blocks: usize) -> Self {
        let [far_reach, packed_reach] =
            [plan.stripe_reach, plan.packed_reach].map(|reach| reach.next_multiple_of(LANES));
        let blocks = blocks.clamp(1, LEAST_SLIDE.max(4 * plan.reach() / BLOCK)).next_multiple_of(GROUP);
        Self { blocks, far_reach, packed_reach, has_packed: !plan.bundles.is_empty() }
    }

    /// Points for which there must be room for stripes.
    pub fn len(&self) -> usize {
        self.blocks * BLOCK + self.far_reach
    }

    /// Points for which there must be room for packed springs.
    pub fn packed_len(&self) -> usize {
        if self.has_packed { self.blocks * BLOCK + WINDOW } else { 0 }
    }

    /// Before the block that is swept as number `count`: where its points are. Sets the sums of packed springs to zero as far
    /// as this block is the first to reach. Those of stripes each set sets to zero for itself; before the first there is
    /// nobody who would have.
    #[inline(always)]
    pub fn begin_block<const N: usize>(
        &self,
        count: usize,
        far: &mut Arrays<N>,
        packed: &mut [Vec<Force>],
    ) -> usize {
        let Self { blocks, far_reach, packed_reach, has_packed } = *self;
        let (first, begun) = (count % blocks * BLOCK, blocks * BLOCK);
        let slides = first == 0 && count > 0;
        for sums in far.all_mut() {
            if slides {
                sums.copy_within(begun..begun + far_reach, 0);
            } else if count == 0 {
                sums[..far_reach].fill(0.0);
            }
        }
        if has_packed {
            let unused = if count == 0 { 0 } else { first + packed_reach }..first + packed_reach + BLOCK;
            for sums in packed {
                if slides {
                    sums.copy_within(begun..begun + packed_reach, 0);
                }
                sums[unused.clone()].fill([0.0; 4]);
            }
        }
        first
    }
}
