//! The points that one thread sweeps.
//!
//! A region is some consecutive blocks, and copies of its neighbours' points as far as springs reach: those before it,
//! whose springs it evaluates once more, as they end at its own points, and those after it, where its own springs end.
//! Each of its points thus gets the very sums that it would get if one thread swept all points.

use std::ops::Range;

use super::aligned::Arrays;
use super::energy::Sums;
use super::packed::Force;
use super::plan::{Plan, WINDOW};
use super::{BLOCK, GROUP, LANES};

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
    pub inverse_mass: Arrays<1>,
    pub forces: Forces,
    /// Of each of its own blocks, while they are added up.
    pub energies: Vec<Sums>,
}

/// Sums of forces while they are needed.
#[derive(Clone, Debug)]
pub(super) struct Forces {
    /// On the points of one block, from springs that begin there.
    pub near: Arrays<3>,
    /// From stripes that end there, from the first block of the current slide on.
    pub far: Arrays<3>,
    /// From packed springs, from the same block on; empty where there are none.
    pub packed: Vec<Force>,
    slide: Slide,
}

/// How sums at the points where springs end are kept while they are needed: from the first block of a slide on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide {
    /// Blocks in it.
    blocks: usize,
    /// How far beyond a block its springs may reach.
    reach: usize,
    /// Whether there are packed springs.
    has_packed: bool,
}

impl Region {
    /// A region of these blocks.
    pub fn new(plan: &Plan, blocks: Range<usize>) -> Self {
        let first_block = blocks.start.saturating_sub(plan.border_blocks());
        let beyond = if plan.bundles.is_empty() { plan.reach + BLOCK } else { WINDOW + LANES };
        let len = (blocks.end - first_block) * BLOCK + beyond;
        Self {
            forces: Forces::new(plan, blocks.end - first_block),
            energies: vec![Sums::default(); blocks.len()],
            blocks,
            first_block,
            points: Arrays::new(len),
            low: Arrays::new(len),
            other: None,
            inverse_mass: Arrays::new(len),
        }
    }

    /// Makes memory for a state that is kept, if there is none.
    pub fn prepare_to_keep(&mut self) {
        let len = self.points.len();
        self.other.get_or_insert_with(|| [Arrays::new(len), Arrays::new(len)]);
    }

    /// Goes on with the other arrays.
    pub fn swap(&mut self) {
        if let Some([points, low]) = &mut self.other {
            std::mem::swap(points, &mut self.points);
            std::mem::swap(low, &mut self.low);
        }
    }

    /// Where a place of its own or of the blocks before is in its arrays.
    #[inline(always)]
    pub fn index(&self, place: usize) -> usize {
        place - self.first_block * BLOCK
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

    /// Before the block that is swept as number `count`: where its points are in `far`. Sets `near` to zero, and `far` as
    /// far as this block is the first to reach.
    #[inline(always)]
    pub fn begin_block(&mut self, count: usize) -> usize {
        let Self { near, far, packed, slide } = self;
        near.all_mut().into_iter().for_each(|sums| sums.fill(0.0));
        slide.begin_block(count, far, std::slice::from_mut(packed))
    }
}

impl Slide {
    /// For a region of so many blocks.
    pub fn new(plan: &Plan, blocks: usize) -> Self {
        let reach = plan.reach.next_multiple_of(LANES);
        let blocks = blocks.clamp(1, LEAST_SLIDE.max(4 * reach / BLOCK)).next_multiple_of(GROUP);
        Self { blocks, reach, has_packed: !plan.bundles.is_empty() }
    }

    /// Points for which there must be room for stripes.
    pub fn len(&self) -> usize {
        self.blocks * BLOCK + self.reach
    }

    /// Points for which there must be room for packed springs.
    pub fn packed_len(&self) -> usize {
        if self.has_packed { self.blocks * BLOCK + WINDOW } else { 0 }
    }

    /// Before the block that is swept as number `count`: where its points are. Sets the sums to zero as far as this block is
    /// the first to reach.
    #[inline(always)]
    pub fn begin_block<const N: usize>(
        &self,
        count: usize,
        far: &mut Arrays<N>,
        packed: &mut [Vec<Force>],
    ) -> usize {
        let Self { blocks, reach, has_packed } = *self;
        let first = count % blocks * BLOCK;
        let mut unused = first + reach..first + reach + BLOCK;
        if count == 0 {
            unused.start = 0;
        } else if first == 0 {
            let begun = blocks * BLOCK..blocks * BLOCK + reach;
            far.all_mut().into_iter().for_each(|sums| sums.copy_within(begun.clone(), 0));
            if has_packed {
                packed.iter_mut().for_each(|sums| sums.copy_within(begun.clone(), 0));
            }
        }
        far.all_mut().into_iter().for_each(|sums| sums[unused.clone()].fill(0.0));
        if has_packed {
            packed.iter_mut().for_each(|sums| sums[unused.clone()].fill([0.0; 4]));
        }
        first
    }
}
