//! Orders are found for networks whose best order is known, after their points were numbered anew at random.

use glam::{DMat3, DVec3, Vec3};
use proptest::prelude::*;

use super::*;
use crate::build::{Lattice, SpringKind, pairs_between, pairs_within};
use crate::math::rotation;

/// A sphere of this radius, m, holds 16 cubic metres.
const CLOUD_RADIUS: f32 = 1.563;

struct Network {
    positions: Vec<Vec3>,
    springs: Vec<[u32; 2]>,
}

impl Network {
    /// A block, sheet or chain with structural and shear springs, turned out of the axes of the coordinates.
    fn lattice(counts: [u32; 3]) -> Self {
        Self::placed(counts, rotation(DVec3::ONE, 12.5), DVec3::ZERO)
    }

    fn placed(counts: [u32; 3], shape: DMat3, at: DVec3) -> Self {
        let lattice = Lattice::new(counts, 0.7);
        Self {
            positions: lattice.positions().map(|p| (shape * p + at).as_vec3()).collect(),
            springs: lattice.pairs(SpringKind::Structural).chain(lattice.pairs(SpringKind::Shear)).collect(),
        }
    }

    /// Points anywhere in a cube, one in each cubic metre on average, each joined to about 16 others.
    fn cloud(points: usize) -> Self {
        let mut dice = Dice(7);
        let side = (points as f32).cbrt();
        let mut coordinate = || dice.below(1 << 20) as f32 / (1 << 20) as f32 * side;
        let positions: Vec<Vec3> =
            (0..points).map(|_| Vec3::from_array([(); 3].map(|()| coordinate()))).collect();
        let springs =
            pairs_within(&positions, CLOUD_RADIUS, usize::MAX).expect("a radius").expect("no limit");
        Self { positions, springs }
    }

    fn with(mut self, other: Self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.springs.extend(other.springs.iter().map(|ends| ends.map(|end| end + first)));
        self
    }

    /// What is left, in the same order, when some points are taken out.
    fn without(self, mut taken_out: impl FnMut(usize) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.positions.len()).filter(|&point| !taken_out(point)).collect();
        let mut number = vec![None; self.positions.len()];
        for (place, &point) in kept.iter().enumerate() {
            number[point] = Some(place as u32);
        }
        let renumbered = |&[a, b]: &[u32; 2]| Some([number[a as usize]?, number[b as usize]?]);
        Self {
            positions: kept.iter().map(|&point| self.positions[point]).collect(),
            springs: self.springs.iter().filter_map(renumbered).collect(),
        }
    }

    /// With springs between all points of two ranges that are near each other.
    fn glued(mut self, a: std::ops::Range<usize>, b: std::ops::Range<usize>, radius: f32) -> Self {
        let (here, there) = (&self.positions[a.clone()], &self.positions[b.clone()]);
        let pairs = pairs_between(here, there, radius, usize::MAX).expect("a radius").expect("no limit");
        assert!(!pairs.is_empty());
        self.springs.extend(pairs.iter().map(|&[i, j]| [i + a.start as u32, j + b.start as u32]));
        self
    }

    /// The same with its points numbered at random, and its springs in random order.
    fn shuffled(&self, seed: u64) -> Self {
        let mut dice = Dice(seed);
        let number = dice.permutation(self.positions.len());
        let mut positions = vec![Vec3::ZERO; self.positions.len()];
        for (point, &position) in self.positions.iter().enumerate() {
            positions[number[point] as usize] = position;
        }
        let renumbered = |&[a, b]: &[u32; 2]| {
            let (a, b) = (number[a as usize], number[b as usize]);
            [a.min(b), a.max(b)]
        };
        let springs = dice.permutation(self.springs.len());
        let springs = springs.iter().map(|&spring| renumbered(&self.springs[spring as usize])).collect();
        Self { positions, springs }
    }

    fn quality(&self) -> Quality {
        Quality::new(self.positions.len(), &self.springs, |point| point)
    }

    fn hidden_order(&self) -> Option<Vec<u32>> {
        hidden_order(&self.positions, &self.springs)
    }

    fn hidden_quality(&self) -> Quality {
        self.hidden_order().map_or_else(|| self.quality(), |order| Quality::of_order(&order, &self.springs))
    }
}

/// A linear congruential generator, Knuth's MMIX.
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % end
    }

    fn permutation(&mut self, len: usize) -> Vec<u32> {
        let mut numbers: Vec<u32> = (0..len as u32).collect();
        for last in (1..len).rev() {
            numbers.swap(last, self.below(last + 1));
        }
        numbers
    }
}

/// Numbered at random, a network must be as good again as its own order is.
fn assert_found_again(name: &str, network: &Network) {
    let own = network.quality();
    for seed in 1..4 {
        let shuffled = network.shuffled(seed);
        assert!(shuffled.quality().stripe_share < 0.1, "{name}: shuffling left stripes");
        let found = shuffled.hidden_quality();
        assert!(found.stripe_share > own.stripe_share - 0.03, "{name}: {own:?} was found as {found:?}");
        assert!(found.bandwidth <= own.bandwidth, "{name}: {own:?} was found as {found:?}");
    }
}

#[test]
fn a_good_order_is_kept() {
    for counts in [[1, 1, 1], [2, 1, 1], [15, 1, 1], [20, 1, 20], [10, 10, 10], [100, 1, 90], [4, 20, 60]] {
        assert_eq!(Network::lattice(counts).hidden_order(), None, "{counts:?}");
    }
}

#[test]
fn lattices_are_found_again() {
    // The longest axis comes first, so that their own order has the smallest bandwidth.
    for counts in
        [[15, 1, 1], [20, 1, 20], [10, 10, 10], [100, 1, 90], [26, 25, 24], [700, 2, 1], [200, 3, 3]]
    {
        assert_found_again(&format!("{counts:?}"), &Network::lattice(counts));
    }
}

#[test]
fn a_sheared_lattice_is_found_again() {
    let shape = DMat3::from_cols(DVec3::X, DVec3::new(0.3, 0.9, 0.1), DVec3::new(-0.2, 0.1, 1.2));
    assert_found_again("sheared", &Network::placed([16, 15, 14], shape, DVec3::new(90.0, 0.0, -40.0)));
}

#[test]
fn the_longest_axis_is_slowest() {
    let own = Network::lattice([500, 8, 7]).quality();
    let other_way_round = Network::lattice([8, 7, 500]);
    assert_eq!(other_way_round.quality().bandwidth, 7 * 500 + 500);
    assert_eq!(other_way_round.shuffled(5).hidden_quality(), own);
}

#[test]
fn a_lattice_with_a_window_is_found_again() {
    let (rows, columns) = (100, 90);
    let window =
        |point: usize| (30..60).contains(&(point / columns)) && (20..70).contains(&(point % columns));
    assert_found_again("window", &Network::lattice([rows, 1, columns as u32]).without(window));
}

#[test]
fn a_few_holes_leave_an_order_good() {
    let mut dice = Dice(5);
    let block = Network::lattice([48, 48, 48]).without(|_| dice.below(100) == 0);
    let share = block.quality().stripe_share;
    assert!((0.975..0.99).contains(&share), "the share that the documentation names is {share}");
    assert_eq!(block.hidden_order(), None);
}

#[test]
fn a_block_with_bubbles_is_found_again() {
    let mut dice = Dice(11);
    let block = Network::lattice([25, 24, 23]).without(|_| dice.below(12) == 0);
    assert!((0.3..0.8).contains(&block.quality().stripe_share), "not what is meant: {:?}", block.quality());
    assert_found_again("bubbles", &block);
}

#[test]
fn bodies_turned_each_its_own_way_and_glued_are_found_again() {
    let turned = |degrees| rotation(DVec3::Y, degrees);
    let pile = Network::placed([12, 12, 12], turned(4.0), DVec3::ZERO)
        .with(Network::placed([12, 12, 12], turned(15.0), DVec3::new(0.0, 8.1, 0.0)))
        .with(Network::placed([12, 12, 12], turned(30.0), DVec3::new(0.0, 16.2, 0.0)))
        .glued(0..1728, 1728..3456, 0.8)
        .glued(1728..3456, 3456..5184, 0.8);
    let own = pile.quality();
    for seed in 1..4 {
        let found = pile.shuffled(seed).hidden_quality();
        assert!(found.stripe_share > own.stripe_share - 0.03, "{own:?} was found as {found:?}");
        // The order of the bodies along the pile is the only good one; which springs of the glue reach furthest is open.
        assert!(found.bandwidth < 2 * 1728, "{own:?} was found as {found:?}");
    }
}

#[test]
fn a_lattice_keeps_its_stripes_beside_a_cloud() {
    let both = Network::lattice([16, 15, 14]).with(Network::cloud(1500));
    let in_lattice = Network::lattice([16, 15, 14]).springs.len() as f64 / both.springs.len() as f64;
    assert!(both.shuffled(1).hidden_quality().stripe_share > in_lattice);
}

#[test]
fn a_cloud_has_the_bandwidth_of_two_slabs() {
    for points in [3000, 20_000] {
        let cloud = Network::cloud(points);
        let found = cloud.hidden_quality();
        // A cube of side s has s² points in each metre along an edge.
        let slab = f64::from(CLOUD_RADIUS) * (points as f64).cbrt().powi(2);
        assert!(f64::from(found.bandwidth) < 2.0 * slab, "{found:?}, a slab holds {slab} points");
        assert!(f64::from(found.bandwidth) > 0.5 * slab, "no order of a cube can do that");
    }
}

#[test]
fn the_user_s_numbers_make_no_difference() {
    let shape = DMat3::from_cols(DVec3::X, DVec3::new(0.5, 0.75f64.sqrt(), 0.0), DVec3::Z); // triangles
    let networks = [
        Network::lattice([40, 1, 40]),
        Network::lattice([12, 12, 12]),
        Network::placed([40, 40, 1], shape, DVec3::ZERO),
        Network::cloud(3000),
    ];
    for network in networks {
        let found = network.shuffled(1).hidden_quality();
        for seed in 2..6 {
            assert_eq!(network.shuffled(seed).hidden_quality(), found);
        }
    }
}

/// Each point once.
fn is_permutation(order: &[u32], points: usize) -> bool {
    let mut sorted = order.to_vec();
    sorted.sort_unstable();
    sorted.into_iter().eq(0..points as u32)
}

#[test]
fn odd_networks_are_no_trouble() {
    let star: Vec<[u32; 2]> = (1..2000).map(|point| [0, point]).collect();
    let chain: Vec<[u32; 2]> =
        (1..2000).map(|point| [(point * 37) % 2000, (point * 37 + 37) % 2000]).collect();
    let all_over: Vec<[u32; 2]> = (0..1999).map(|point| [point, 1999]).chain(chain.iter().copied()).collect();
    let mut dice = Dice(3);
    let anywhere: Vec<Vec3> =
        (0..2000).map(|_| Vec3::from_array([(); 3].map(|()| dice.below(2000) as f32 - 1000.0))).collect();
    let places: [Vec<Vec3>; 5] = [
        vec![Vec3::ONE; 2000],
        (0..2000).map(|point| Vec3::X * (point % 3) as f32).collect(),
        anywhere.iter().map(|&p| p * 1e6).collect(),
        anywhere.iter().map(|&p| p * 1e35).collect(),
        anywhere.iter().map(|&p| p * 1e-42).collect(),
    ];
    for positions in &places {
        for springs in [&star, &chain, &all_over] {
            if let Some(order) = hidden_order(positions, springs) {
                assert!(is_permutation(&order, 2000));
            }
        }
    }
}

proptest! {
    #[test]
    fn an_order_is_a_permutation_and_better_than_the_user_s(
        points in prop::collection::vec(prop::array::uniform3(-3i32..4), 2..200),
        ends in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..600),
        scale in prop::sample::select(vec![1.0f32, 1e-30, 1e9]),
    ) {
        // Whole multiples of the scale: coincident points, and now and then a piece of a lattice.
        let positions: Vec<Vec3> = points.iter().map(|p| Vec3::from_array(p.map(|c| c as f32 * scale))).collect();
        let springs: Vec<[u32; 2]> = ends
            .iter()
            .map(|(a, b)| [a, b].map(|end| end.index(points.len()) as u32))
            .filter(|[a, b]| a != b)
            .collect();
        if let Some(order) = hidden_order(&positions, &springs) {
            prop_assert!(is_permutation(&order, points.len()));
            let of_user = Quality::new(points.len(), &springs, |point| point);
            prop_assert!(Quality::of_order(&order, &springs).is_better_than(&of_user));
        }
    }
}
