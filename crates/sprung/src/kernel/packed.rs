//! Springs between any two points: both ends are gathered, each spring once.

use super::laws::Laws;
use super::plan::{Plan, WINDOW};
use super::spring::{SpringLanes, add};
use super::{LANES, Lanes, six};

/// The force of packed springs on a point: x, y, z and nothing, so that a point's lie side by side.
pub(super) type Force = [f32; 4];

/// Adds the forces of one bundle.
///
/// `points`: positions and velocities from the group's first point on, as far as the window reaches; `forces`: those on
/// the same points.
#[inline(always)]
pub(super) fn accumulate(
    points: [&[f32]; 6],
    plan: &Plan,
    laws: &Laws,
    bundle: usize,
    forces: &mut [Force],
    springs: &mut SpringLanes,
) {
    let (bundle, law) = (&plan.bundles[bundle], &laws.bundles[bundle]);
    // A 16-bit number is always an index into an array of this length: nothing is left to be checked for each lane.
    let window = six(points, window);
    let forces: &mut [Force; WINDOW] = forces.first_chunk_mut().expect("forces end with a window to spare");
    let here = six(window, |array| gather(array, &bundle.points));
    let mut sums = [[0.0; LANES]; 3];
    for (set, row) in bundle.rows.clone().enumerate() {
        let ends = &plan.rows[row];
        let there = six(window, |array| gather(array, ends));
        springs
            .fetch(six([0, 1, 2, 3, 4, 5], |part| &here[part]), six([0, 1, 2, 3, 4, 5], |part| &there[part]));
        springs.pull(laws.values.lanes(law, set), laws.rows[row]);
        let [x, y, z] = [springs.force(0), springs.force(1), springs.force(2)];
        add(&mut sums[0], &x);
        add(&mut sums[1], &y);
        add(&mut sums[2], &z);
        hand_out([&x, &y, &z], ends, forces);
    }
    for sums in sums.iter_mut().flatten() {
        *sums = -*sums;
    }
    hand_out([&sums[0], &sums[1], &sums[2]], &bundle.points, forces);
}

/// Adds a force to each of some points, one after another, as the same point may be there twice.
#[inline(always)]
fn hand_out([x, y, z]: [&Lanes; 3], points: &[u16; LANES], forces: &mut [Force; WINDOW]) {
    // Each force side by side first, so that it is added as one vector.
    let mut lanes = [[0.0; 4]; LANES];
    for lane in 0..LANES {
        lanes[lane] = [x[lane], y[lane], z[lane], 0.0];
    }
    for (&point, force) in points.iter().zip(&lanes) {
        let sum = &mut forces[point as usize];
        *sum = [sum[0] + force[0], sum[1] + force[1], sum[2] + force[2], sum[3] + force[3]];
    }
}

#[inline(always)]
pub(super) fn window<T>(values: &[T]) -> &[T; WINDOW] {
    values.first_chunk().expect("arrays end with a window to spare")
}

#[inline(always)]
pub(super) fn gather<T: Copy + Default>(values: &[T; WINDOW], at: &[u16; LANES]) -> [T; LANES] {
    let mut gathered = [T::default(); LANES];
    for lane in 0..LANES {
        gathered[lane] = values[at[lane] as usize];
    }
    gathered
}
