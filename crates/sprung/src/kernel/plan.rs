//! Which springs go through which loop: a function of the model alone.

use std::ops::Range;

use super::loose::{Loose, LooseEnd, ends_by_place};
use super::{BLOCK, GROUP, LANES};
use crate::buckets::Buckets;
use crate::model::Model;

/// A stripe takes part in whole sets of lanes, at about two fifths of what as many packed springs cost: it is worth it
/// where at least this share of the lanes are springs.
pub(super) const WORTH: f64 = 0.4;

/// A block with no more springs than this makes stripes of all: a bundle takes longer to begin.
pub(super) const FEW: usize = 8;

/// Ends of packed springs lie less than this many places after the beginning of their group: 16 bits say which.
pub(crate) const WINDOW: usize = 1 << 16;

/// Stripes that reach beyond the window are made where they hold at least one in so many of all springs. A region needs as
/// many of its neighbour's points as stripes reach: fewer springs are better loose, each at some 60 times the cost of one in
/// a stripe, than that they cost a second thread.
pub(super) const LONG: usize = 128;

/// Packed springs of one point in one lane; a point with more takes several lanes. Fewer would leave fewer lanes empty,
/// and gather each point more often.
pub(super) const MOST_ROWS: usize = 8;

/// No spring: a lane to spare.
const NONE: u32 = u32::MAX;

/// Springs, sorted by the place of the end that comes first and by how they are evaluated.
#[derive(Debug)]
pub(crate) struct Plan {
    pub points: usize,
    pub springs: usize,
    pub blocks: Vec<BlockPlan>,
    pub stripes: Vec<Stripe>,
    /// The springs of all stripes, one after another, each stripe's by ascending place.
    stripe_springs: Vec<u32>,
    pub bundles: Vec<Bundle>,
    /// The far ends of each row of a bundle, from the group's first point.
    pub rows: Vec<[u16; LANES]>,
    /// The springs of each row, or [`NONE`].
    row_springs: Vec<[u32; LANES]>,
    /// Springs to points beyond the window that are in no stripe, and their ends by place.
    pub loose: Vec<Loose>,
    pub loose_ends: Vec<LooseEnd>,
    /// The largest offset of a stripe, in places.
    pub stripe_reach: usize,
    /// How far beyond the first point of its group a packed spring ends, in places, at the most.
    pub packed_reach: usize,
    /// Springs in stripes that reach beyond the window.
    long: usize,
}

/// What is evaluated at one block, as ranges of the plan's lists: its stripes, and at the first of a group its bundles.
#[derive(Clone, Debug)]
pub(super) struct BlockPlan {
    pub stripes: Range<usize>,
    pub bundles: Range<usize>,
}

/// Springs of points of one block to the points at one offset.
#[derive(Clone, Debug)]
pub(super) struct Stripe {
    pub offset: usize,
    springs: Range<usize>,
}

/// Packed springs of a set of lanes of points of one group, which need not be different points nor in order: each point is
/// a lane, and each row holds one spring of each.
#[derive(Clone, Debug)]
pub(super) struct Bundle {
    /// From the group's first point.
    pub points: [u16; LANES],
    pub rows: Range<usize>,
}

/// A spring of a block that is being planned.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Planned {
    offset: u32,
    /// The first end, from the first point of the block, or for a packed spring of the group.
    near: u32,
    spring: u32,
}

/// Whether so many springs of one offset, that begin in so many sets of lanes of a block, are worth a stripe. `in_block` springs
/// of any offset begin in the block: if they are few, all within the window make stripes.
pub(crate) fn makes_a_stripe(springs: usize, sets: usize, offset: usize, in_block: usize) -> bool {
    let is_few = in_block <= FEW && offset < WINDOW;
    is_few || springs as f64 >= WORTH * (sets * LANES) as f64
}

/// Whether stripes that reach beyond the window are made, where they would hold so many of all springs; yes if they would hold
/// none.
pub(crate) fn are_long_stripes_worth_it(in_long_stripes: usize, springs: usize) -> bool {
    in_long_stripes == 0 || in_long_stripes * LONG >= springs
}

/// How many of a model's springs are in stripes, and how many are loose.
#[cfg(test)]
pub(crate) fn stripes_and_loose(model: &Model) -> [usize; 2] {
    let plan = Plan::new(model);
    [plan.stripe_springs.len(), plan.loose.len()]
}

impl Plan {
    pub fn new(model: &Model) -> Self {
        let plan = Self::with_stripes(model, usize::MAX);
        if are_long_stripes_worth_it(plan.long, plan.springs) {
            return plan;
        }
        drop(plan);
        Self::with_stripes(model, WINDOW)
    }

    /// A plan with stripes of offsets below some limit.
    fn with_stripes(model: &Model, limit: usize) -> Self {
        let points = model.point_count();
        let block_count = points.div_ceil(BLOCK);
        let mut plan = Self {
            points,
            springs: model.spring_count(),
            blocks: Vec::with_capacity(block_count),
            stripes: Vec::new(),
            stripe_springs: Vec::new(),
            bundles: Vec::new(),
            rows: Vec::new(),
            row_springs: Vec::new(),
            loose: Vec::new(),
            loose_ends: Vec::new(),
            stripe_reach: 0,
            packed_reach: 0,
            long: 0,
        };
        let block_of = |spring: u32| model.places(spring)[0] as usize / BLOCK;
        let springs = 0..model.spring_count() as u32;
        let sorted = Buckets::new(block_count, springs.map(|spring| (block_of(spring), spring)));
        let (mut springs, mut packed) = (Vec::new(), Vec::new());
        for group in (0..block_count).step_by(GROUP) {
            packed.clear();
            for block in group..block_count.min(group + GROUP) {
                springs.clear();
                springs.extend(sorted.of(block).iter().map(|&spring| {
                    let [near, far] = model.places(spring);
                    Planned { offset: far - near, near: near - (block * BLOCK) as u32, spring }
                }));
                springs.sort_unstable();
                let before = packed.len();
                plan.push_block(&springs, limit, &mut packed);
                packed[before..]
                    .iter_mut()
                    .for_each(|spring| spring.near += ((block - group) * BLOCK) as u32);
            }
            plan.push_group(group, &mut packed);
        }
        plan.stripes.shrink_to_fit();
        plan.stripe_springs.shrink_to_fit();
        plan.loose_ends = ends_by_place(&plan.loose);
        plan
    }

    /// Beyond the block where it begins no force reaches further than this, in places, but for those of loose springs.
    pub fn reach(&self) -> usize {
        self.stripe_reach.max(self.packed_reach)
    }

    /// How many blocks before its own a region must sweep too.
    pub fn border_blocks(&self) -> usize {
        self.reach().div_ceil(GROUP * BLOCK) * GROUP
    }

    /// The springs of a stripe, by ascending place of their first end.
    pub fn springs_of(&self, stripe: &Stripe) -> &[u32] {
        &self.stripe_springs[stripe.springs.clone()]
    }

    /// The spring in each lane of a row.
    pub fn springs_in_row(&self, row: usize) -> [Option<usize>; LANES] {
        self.row_springs[row].map(|spring| (spring != NONE).then_some(spring as usize))
    }

    /// Makes stripes of a block's springs, of offsets below `limit`; what is left over goes to `packed`.
    fn push_block(&mut self, springs: &[Planned], limit: usize, packed: &mut Vec<Planned>) {
        let stripes = self.stripes.len();
        for same_offset in springs.chunk_by(|a, b| a.offset == b.offset) {
            let offset = same_offset[0].offset as usize;
            let sets =
                same_offset.chunk_by(|a, b| a.near as usize / LANES == b.near as usize / LANES).count();
            if offset < limit && makes_a_stripe(same_offset.len(), sets, offset, springs.len()) {
                self.push_stripe(same_offset, packed);
            } else {
                packed.extend_from_slice(same_offset);
            }
        }
        let bundles = self.bundles.len();
        self.blocks.push(BlockPlan { stripes: stripes..self.stripes.len(), bundles: bundles..bundles });
    }

    /// Makes bundles of what is left over of a group of blocks.
    fn push_group(&mut self, group: usize, packed: &mut Vec<Planned>) {
        let bundles = self.bundles.len();
        // By point, and for each point by ascending offset.
        packed.sort_unstable_by_key(|spring| (spring.near, spring.offset, spring.spring));
        let first = (group * BLOCK) as u32;
        packed.retain(|&Planned { offset, near, spring }| {
            let is_loose = near as usize + offset as usize >= WINDOW;
            if is_loose {
                self.loose.push(Loose { spring, ends: [first + near, first + near + offset] });
            } else {
                self.packed_reach = self.packed_reach.max(near as usize + offset as usize);
            }
            !is_loose
        });
        self.push_bundles(packed);
        self.blocks[group].bundles = bundles..self.bundles.len();
    }

    /// Makes a stripe of a block's springs of one offset; of springs side by side all but the first go to `packed`.
    fn push_stripe(&mut self, springs: &[Planned], packed: &mut Vec<Planned>) {
        let offset = springs[0].offset as usize;
        let begin = self.stripe_springs.len();
        for beside in springs.chunk_by(|a, b| a.near == b.near) {
            self.stripe_springs.push(beside[0].spring);
            packed.extend_from_slice(&beside[1..]);
        }
        let springs = begin..self.stripe_springs.len();
        self.long += if offset < WINDOW { 0 } else { springs.len() };
        self.stripes.push(Stripe { offset, springs });
        self.stripe_reach = self.stripe_reach.max(offset);
    }

    /// Bundles of a group's packed springs, which are sorted by point. Points with as many springs share a bundle.
    fn push_bundles(&mut self, packed: &[Planned]) {
        let by_point = packed.chunk_by(|a, b| a.near == b.near);
        let mut lanes: Vec<&[Planned]> = by_point.flat_map(|springs| springs.chunks(MOST_ROWS)).collect();
        lanes.sort_by_key(|springs| std::cmp::Reverse(springs.len()));
        for lanes in lanes.chunks(LANES) {
            let mut points = [0; LANES];
            for (point, springs) in points.iter_mut().zip(lanes) {
                *point = springs[0].near as u16;
            }
            let rows = self.rows.len()..self.rows.len() + lanes[0].len();
            for row in 0..lanes[0].len() {
                // A lane to spare joins its point to itself, with a law of zeros.
                let (mut far, mut ids) = (points, [NONE; LANES]);
                for (lane, springs) in lanes.iter().enumerate() {
                    if let Some(spring) = springs.get(row) {
                        far[lane] = (spring.near + spring.offset) as u16;
                        ids[lane] = spring.spring;
                    }
                }
                self.rows.push(far);
                self.row_springs.push(ids);
            }
            self.bundles.push(Bundle { points, rows });
        }
    }
}
