//! How well an order of points suits the step.

use crate::buckets::Buckets;

/// Consecutive points over which stripes are counted: as many as a group of the step's blocks.
const BLOCK: usize = 1024;

/// Springs of one offset in 1024 points that count as a stripe. The step decides block by block and set by set; this is
/// coarser, and only compares orders.
const WORTH_A_STRIPE: usize = 300;

/// Stripes and bandwidth of one order of the points.
///
/// A *stripe* is all springs between the points i of a block and the points i + d, for one offset d > 0: the step
/// evaluates it with plain vector loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quality {
    /// The share of springs that lie in stripes worth it, 0 to 1; 1 where there are no springs.
    pub stripe_share: f64,
    /// The largest distance in the order between the ends of a spring: what the step must keep at hand.
    pub bandwidth: u32,
}

impl Quality {
    /// The quality of the order that puts each point at `place(point)`.
    pub fn new(points: usize, springs: &[[u32; 2]], place: impl Fn(u32) -> u32) -> Self {
        // Offsets by the block of the lower end.
        let blocks = points.div_ceil(BLOCK);
        let offsets = springs.iter().map(|&[a, b]| {
            let (a, b) = (place(a), place(b));
            (a.min(b) as usize / BLOCK, a.abs_diff(b))
        });
        let bandwidth = offsets.clone().map(|(_, offset)| offset).max().unwrap_or(0);
        let offsets = Buckets::new(blocks, offsets);

        let mut springs_at_offset = vec![0usize; bandwidth as usize + 1];
        let mut in_stripes = 0;
        for block in 0..blocks {
            let points_here = (points - block * BLOCK).min(BLOCK);
            for &offset in offsets.of(block) {
                springs_at_offset[offset as usize] += 1;
            }
            // Each count is taken once, which leaves zeros for the next block.
            for &offset in offsets.of(block) {
                let count = std::mem::take(&mut springs_at_offset[offset as usize]);
                if count * BLOCK >= WORTH_A_STRIPE * points_here {
                    in_stripes += count;
                }
            }
        }
        let stripe_share = if springs.is_empty() { 1.0 } else { in_stripes as f64 / springs.len() as f64 };
        Self { stripe_share, bandwidth }
    }

    /// Of the order in which `order[place]` is the point at that place.
    pub fn of_order(order: &[u32], springs: &[[u32; 2]]) -> Self {
        let mut places = vec![0u32; order.len()];
        for (place, &point) in order.iter().enumerate() {
            places[point as usize] = place as u32;
        }
        Self::new(order.len(), springs, |point| places[point as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stripe_counts_from_300_springs_of_1024_points() {
        // Two blocks; in the first the springs of some points reach 5 further, one reaches 900 further.
        let springs_and_one =
            |count: u32| -> Vec<[u32; 2]> { (0..count).map(|i| [i, i + 5]).chain([[1000, 1900]]).collect() };
        let few = Quality::new(2048, &springs_and_one(299), |point| point);
        assert_eq!(few, Quality { stripe_share: 0.0, bandwidth: 900 });
        let enough = Quality::new(2048, &springs_and_one(300), |point| point);
        assert_eq!(enough, Quality { stripe_share: 300.0 / 301.0, bandwidth: 900 });
    }

    #[test]
    fn the_last_block_needs_as_many_as_its_points_are() {
        // A chain that ends 10 points into the second block: 9 springs, of which 3 would be enough.
        let chain: Vec<[u32; 2]> = (0..1033).map(|i| [i, i + 1]).collect();
        assert_eq!(Quality::new(1034, &chain, |point| point), Quality { stripe_share: 1.0, bandwidth: 1 });
        let last: Vec<[u32; 2]> = vec![[1030, 1031], [1031, 1032]];
        assert_eq!(Quality::new(1034, &last, |point| point).stripe_share, 0.0);
    }

    #[test]
    fn an_order_is_judged_by_places() {
        let springs = [[0, 2], [1, 2], [1, 3]];
        let order = [0, 2, 1, 3];
        assert_eq!(Quality::of_order(&order, &springs), Quality { stripe_share: 1.0, bandwidth: 1 });
    }

    #[test]
    fn without_springs_any_order_is_good() {
        for points in [0, 1, 3000] {
            let quality = Quality::new(points, &[], |point| point);
            assert_eq!(quality, Quality { stripe_share: 1.0, bandwidth: 0 });
        }
    }
}
