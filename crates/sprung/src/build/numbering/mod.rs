//! The hidden order of points: the one that the step works in, whatever the user's numbers are.
//!
//! The step goes through the points once, in order. It is fast where runs of consecutive points have a neighbour at the
//! same offset, and where the two ends of a spring are near in the order. Lattices numbered row by row have both, and
//! keep their order. Points numbered anyhow get that order back if they lie on lattices, or else the order of slabs.
//!
//! Holes strewn over a lattice shift the offsets of all springs across them: with 1 % of the points missing 98 % of the
//! springs stay in stripes, but these take a fifth more sets of lanes. Gaps in the order instead would make places that are
//! no points, which everything that goes by place would have to know.
//!
//! All of it is a function of positions and springs that is the same on every machine: sums, products, square roots
//! and comparisons in float64, and sorts by total orders.

mod lattice_order;
mod quality;
mod spatial_order;
#[cfg(test)]
mod tests;

use glam::Vec3;

use lattice_order::lattice_order;
use quality::Quality;
use spatial_order::spatial_order;

/// An order with this share of springs in stripes needs no other, if its bandwidth is good too.
const GOOD_SHARE: f64 = 0.9;

/// Up to this bandwidth what the step has at hand stays in a core's own cache.
const GOOD_BANDWIDTH: u32 = 32_768;

/// Lattices are looked for as long as this share of the springs may lie in some; with less, slabs do as well.
const LATTICE_SHARE: f64 = 0.5;

/// A loose spring costs the step as much more than a packed one as so many in stripes cost less.
const LOOSE_COST: f64 = 30.0;

/// A difference of shares that tells in the time of a step.
const NOTABLE_SHARE: f64 = 0.1;

/// Bandwidths up to this are all the same to the step: that many points fit anywhere.
const SMALL_BANDWIDTH: u32 = 1024;

/// An order for the step that suits it notably better than the user's: `order[place]` is the point at that place.
/// `None` if the user's is good, or no better one is found.
///
/// `positions` are those of the model as built, m; the ends of `springs` are indices of positions.
pub(crate) fn hidden_order(positions: &[Vec3], springs: &[[u32; 2]]) -> Option<Vec<u32>> {
    let lattices = || lattice_order(positions, springs, LATTICE_SHARE);
    let slabs = || Some(spatial_order(positions, springs, (0..positions.len() as u32).collect()));
    let candidates: [&dyn Fn() -> Option<Vec<u32>>; 2] = [&lattices, &slabs];

    let mut best = (Quality::new(positions.len(), springs, |point| point), None);
    for candidate in candidates {
        if best.0.is_good() {
            break;
        }
        if let Some(order) = candidate() {
            let quality = Quality::of_order(&order, springs);
            if quality.is_better_than(&best.0) {
                best = (quality, Some(order));
            }
        }
    }
    best.1
}

impl Quality {
    fn is_good(&self) -> bool {
        self.stripe_share >= GOOD_SHARE && self.bandwidth <= GOOD_BANDWIDTH
    }

    /// Notably more springs in stripes, or fewer loose ones; or about as many, and at most half the bandwidth.
    fn is_better_than(&self, other: &Self) -> bool {
        let share = |of: &Self| of.stripe_share - LOOSE_COST * of.loose_share;
        let gained = share(self) - share(other);
        let narrower = self.bandwidth.max(SMALL_BANDWIDTH) <= other.bandwidth / 2;
        gained >= NOTABLE_SHARE || (gained >= -NOTABLE_SHARE && narrower)
    }
}
