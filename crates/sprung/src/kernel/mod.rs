//! The explicit step, as fast as the machine allows.
//!
//! A step is one sweep through the points in a hidden order ([`Model::place_of`](crate::Model)), in blocks of 256. A
//! spring is evaluated once, at whichever of its ends comes first in that order; those of 32 points in a row add up in
//! registers. When the springs of a block are done its points have all their forces, and nobody asks for their old positions
//! any more: they are moved at once, while they are still in the cache.
//!
//! - [`plan`]: which springs go through which loop, from the model alone.
//! - [`stripe`]: springs of consecutive points to neighbours at one offset, with plain vector loads.
//! - [`packed`]: all other springs, whose far ends are gathered.
//! - [`laws`]: stiffness, damping and rest length, packed in the order of their use.
//! - [`loose`]: the few springs whose ends lie too far apart for either.
//! - [`integrate`]: gravity, contact and the move of a block's points.
//! - [`region`]: the points that one thread has; [`sweep`]: the pass through them.
//! - [`team`]: all regions, and what they tell each other.
//! - [`energy`]: a pass for the energies alone.
//! - [`limit`]: one for the certified limit on dt, with the [`tensor`]s of springs, their largest [`eigenvalue`] and the
//!   [`tightest`] spring.
//! - [`level`]: which vector instructions are used.
//!
//! *The order of summation*, which fixes the bits, is a function of the model. A spring begins at the end that comes first
//! in the hidden order. A point's force is F₁ + F₂ + F₃, and then planes, loose springs, external forces and grabs are added
//! one by one:
//!
//! - F₁ sums the stripes that begin at the point, in ascending order of their offset.
//! - F₂ sums the stripes that end there, in ascending order of the set of 32 points where they begin, in a set by offset.
//! - F₃ sums the packed springs at either end, group by group of four blocks in ascending order of where they begin, in a
//!   group bundle by bundle. A bundle is a matrix of springs: a lane holds up to eight that begin at one point, by ascending
//!   offset, and lanes with most springs come first. Its forces go to the points where its springs end, row by row and lane
//!   by lane, and then the sum of each lane to the point where they begin.
//!
//! Threads do not enter into it: see [`region`]. The twin in the tests is this list as plain code.

mod aligned;
mod eigenvalue;
mod energy;
mod integrate;
mod laws;
mod level;
mod limit;
mod loose;
mod packed;
mod plan;
mod region;
mod spring;
mod stripe;
mod sweep;
mod team;
mod tensor;
#[cfg(test)]
mod tests;
mod tightest;

pub use level::Level;
#[cfg(test)]
pub(crate) use plan::stripes_and_loose;
pub(crate) use plan::{WINDOW, are_long_stripes_worth_it, makes_a_stripe};
pub(crate) use team::Team;

/// Points that are swept together: their forces stay in the nearest cache.
pub(crate) const BLOCK: usize = 256;

/// Blocks whose packed springs are evaluated together, before the first of them: the more there are to choose from, the
/// fewer lanes stay empty.
const GROUP: usize = 4;

/// Springs that go through the arithmetic together: several vectors, so that one's waiting is another's work.
pub(crate) const LANES: usize = 32;

/// A value for each of the springs that go through together, or of so many points.
type Lanes = [f32; LANES];

// A bit of 32 for each lane; a group within a window.
const _: () =
    assert!(LANES == u32::BITS as usize && BLOCK.is_multiple_of(LANES) && GROUP * BLOCK < plan::WINDOW);

/// `[T; 6]::map`, of which the compiler makes vector code: positions and velocities go by six.
#[inline(always)]
fn six<T, U>([a, b, c, d, e, f]: [T; 6], with: impl Fn(T) -> U) -> [U; 6] {
    [with(a), with(b), with(c), with(d), with(e), with(f)]
}
