//! How well an order of points suits the step: how the step's own plan would take the springs.

use crate::buckets::Buckets;
use crate::kernel::{BLOCK, LANES, WINDOW, are_long_stripes_worth_it, makes_a_stripe};

/// Sets of lanes in a block.
const SETS: usize = BLOCK / LANES;

/// Stripes and bandwidth of one order of the points.
///
/// A *stripe* is all springs between the points i of a block and the points i + d, for one offset d > 0: the step
/// evaluates it with plain vector loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quality {
    /// The share of springs that the step has in stripes, 0 to 1; 1 where there are no springs. Springs side by side all
    /// count.
    pub stripe_share: f64,
    /// The share of springs that are in none and reach beyond the step's window: it takes them one by one.
    pub loose_share: f64,
    /// The largest distance in the order between the ends of a spring: what the step must keep at hand.
    pub bandwidth: u32,
}

/// The springs of one offset that begin in a block.
#[derive(Clone, Copy, Default)]
struct Count {
    springs: u32,
    /// A bit for each set of lanes where any begins.
    sets: u32,
}

impl Quality {
    /// The quality of the order that puts each point at `place(point)`.
    pub fn new(points: usize, springs: &[[u32; 2]], place: impl Fn(u32) -> u32) -> Self {
        // Offsets by the set of lanes of the lower end.
        let sets = points.div_ceil(LANES);
        let offsets = springs.iter().map(|&[a, b]| {
            let (a, b) = (place(a), place(b));
            (a.min(b) as usize / LANES, a.abs_diff(b))
        });
        let bandwidth = offsets.clone().map(|(_, offset)| offset).max().unwrap_or(0);
        let offsets = Buckets::new(sets, offsets);

        let mut counts = vec![Count::default(); bandwidth as usize + 1];
        let (mut in_stripes, mut in_long_stripes, mut loose) = (0, 0, 0);
        for first in (0..sets).step_by(SETS) {
            let block = first..sets.min(first + SETS);
            let mut in_block = 0;
            for set in block.clone() {
                for &offset in offsets.of(set) {
                    let count = &mut counts[offset as usize];
                    count.springs += 1;
                    count.sets |= 1 << (set - first);
                    in_block += 1;
                }
            }
            // Each count is taken once, which leaves zeros for the next block.
            for &offset in block.flat_map(|set| offsets.of(set)) {
                let Count { springs, sets } = std::mem::take(&mut counts[offset as usize]);
                let (springs, offset) = (springs as usize, offset as usize);
                let is_stripe = makes_a_stripe(springs, sets.count_ones() as usize, offset, in_block);
                match (is_stripe, offset < WINDOW) {
                    (true, true) => in_stripes += springs,
                    (true, false) => in_long_stripes += springs,
                    (false, true) => {}
                    (false, false) => loose += springs,
                }
            }
        }
        if are_long_stripes_worth_it(in_long_stripes, springs.len()) {
            in_stripes += in_long_stripes;
        } else {
            loose += in_long_stripes;
        }
        let all = springs.len() as f64;
        let stripe_share = if springs.is_empty() { 1.0 } else { in_stripes as f64 / all };
        Self { stripe_share, loose_share: loose as f64 / all.max(1.0), bandwidth }
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
    use crate::build::ModelBuilder;
    use crate::build::{Lattice, Material, SpringKind};
    use crate::kernel::stripes_and_loose;
    use crate::model::HiddenOrder;
    use glam::Vec3;

    const MATERIAL: Material = Material { stiffness: 1.0, damping: 0.0 };

    fn quality(points: usize, springs: &[[u32; 2]]) -> Quality {
        Quality::new(points, springs, |point| point)
    }

    /// What the step's plan makes of the springs in the user's order.
    fn planned(points: usize, springs: &[[u32; 2]]) -> [usize; 2] {
        let mut builder = ModelBuilder::new();
        for point in 0..points {
            builder.add_point(Vec3::X * point as f32, 1.0).expect("allowed");
        }
        for &[a, b] in springs {
            builder.add_spring(a as usize, b as usize, MATERIAL).expect("allowed");
        }
        let (mut model, ..) = builder.parts().expect("there are points");
        model.hidden_order = HiddenOrder::default();
        stripes_and_loose(&model)
    }

    fn assert_is_what_the_plan_makes(name: &str, points: usize, springs: &[[u32; 2]]) -> Quality {
        let found = quality(points, springs);
        let expected = planned(points, springs).map(|count| count as f64 / springs.len() as f64);
        assert_eq!([found.stripe_share, found.loose_share], expected, "{name}");
        found
    }

    /// Springs that reach so far, from the first points and then from every `apart`th.
    fn springs(reach: u32, first: u32, apart: usize, points: u32) -> Vec<[u32; 2]> {
        let begins = (0..first).chain((first..points - reach).step_by(apart));
        begins.map(|near| [near, near + reach]).collect()
    }

    #[test]
    fn an_order_is_judged_by_what_the_step_makes_of_it() {
        let lattice = |counts: [u32; 3], keep: &dyn Fn(u32) -> bool| -> Vec<[u32; 2]> {
            let lattice = Lattice::new(counts, 1.0);
            let all = lattice.pairs(SpringKind::Structural).chain(lattice.pairs(SpringKind::Shear));
            all.filter(|[a, b]| keep(a * 7 + b)).collect()
        };
        let cases: [(&str, usize, Vec<[u32; 2]>); 6] = [
            ("a block", 7200, lattice([24, 20, 15], &|_| true)),
            ("half a block", 7200, lattice([24, 20, 15], &|spring| spring % 97 < 40)),
            ("a few springs", 3000, springs(5, 0, 50, 3000)),
            ("runs and others", 3000, springs(5, 1500, 3, 3000)),
            ("a wide sheet", 80_000, [springs(70_000, 5000, 4, 80_000), springs(1, 0, 1, 80_000)].concat()),
            ("a ring", 80_000, [springs(79_900, 90, 1, 80_000), springs(1, 0, 1, 80_000)].concat()),
        ];
        let found = cases
            .each_ref()
            .map(|(name, points, springs)| assert_is_what_the_plan_makes(name, *points, springs));
        let some = |share: f64| share > 0.0 && share < 1.0;
        assert_eq!(found.map(|found| some(found.stripe_share)), [false, true, false, true, true, true]);
        assert_eq!(found.map(|found| some(found.loose_share)), [false, false, false, false, true, true]);
    }

    #[test]
    fn a_stripe_counts_where_two_fifths_of_its_lanes_are_springs() {
        // Two blocks; in the first the springs of some points of each set reach 5 further, one reaches 300 further.
        let of_each_set = |count: usize| -> Vec<[u32; 2]> {
            let near = (0..256u32).filter(|near| (near % 32) < count as u32);
            near.map(|near| [near, near + 5]).chain([[100, 400]]).collect()
        };
        let few = quality(512, &of_each_set(12));
        assert_eq!(few, Quality { stripe_share: 0.0, loose_share: 0.0, bandwidth: 300 });
        let enough = quality(512, &of_each_set(13));
        assert_eq!(enough, Quality { stripe_share: 104.0 / 105.0, loose_share: 0.0, bandwidth: 300 });
    }

    #[test]
    fn an_order_is_judged_by_places() {
        let springs = [[0, 2], [1, 2], [1, 3]];
        let order = [0, 2, 1, 3];
        assert_eq!(Quality::of_order(&order, &springs).bandwidth, 1);
    }

    #[test]
    fn without_springs_any_order_is_good() {
        for points in [0, 1, 3000] {
            assert_eq!(quality(points, &[]), Quality { stripe_share: 1.0, loose_share: 0.0, bandwidth: 0 });
        }
    }
}
