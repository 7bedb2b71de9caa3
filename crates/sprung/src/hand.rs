//! The work of a hand that carries points along: it gives whatever the springs at those points take.
//!
//! A hand may tear a point through many rest lengths in one step, so force at the beginning × way would be far off, and the
//! difference would look like energy from nowhere. Instead each spring says what the hand's part of the motion stored:
//! with c the carried end and f the other, and half of it reckoned before f moves and half after,
//!
//! ```text
//! stored = ½[E(c⁺, f) − E(c, f)] + ½[E(c⁺, f⁺) − E(c, f⁺)]
//! ```
//!
//! For a force that grows in proportion to the way this is the mean force × way. The damper's force is that of the step,
//! the one at its beginning, and takes its force × way out of the hand.

use glam::DVec3;

use crate::force::spring::{pull_and_brake, stored};
use crate::model::Model;
use crate::params::Params;

/// The springs at carried points, as they were at the beginning of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hand {
    springs: Vec<CarriedSpring>,
}

#[derive(Clone, Copy, Debug)]
struct CarriedSpring {
    spring: usize,
    /// Which of its two ends are carried.
    carried: [bool; 2],
    /// Where its ends were, m.
    position: [DVec3; 2],
    /// What the hand must give for each second against the damper, W.
    brake_power: f64,
}

impl Hand {
    /// Before a step. Takes no memory once it has had that many springs.
    pub fn begin(&mut self, model: &Model, params: &Params, motion: impl Fn(usize) -> [DVec3; 2]) {
        self.springs.clear();
        for &point in params.carried.keys() {
            for &spring in model.springs_at(point) {
                let spring = spring as usize;
                let [i, j] = model.springs[spring].map(|end| end as usize);
                let carried = [i, j].map(|end| params.carried.contains_key(&end));
                if carried[0] && point == j {
                    continue; // counted at its other end
                }
                let ends = [i, j].map(&motion);
                let (position, velocity) = (ends.map(|[x, _]| x), ends.map(|[_, v]| v));
                let (axis, apart) = (position[0] - position[1], velocity[0] - velocity[1]);
                let (_, brake) = pull_and_brake(params, spring, axis, apart);
                let [at_i, at_j] =
                    [0, 1].map(|end| if carried[end] { brake.dot(velocity[end]) } else { 0.0 });
                self.springs.push(CarriedSpring { spring, carried, position, brake_power: at_j - at_i });
            }
        }
    }

    /// After it: what the hand stored in springs, and what it gave against dampers, J.
    pub fn work(&self, model: &Model, params: &Params, motion: impl Fn(usize) -> [DVec3; 2]) -> (f64, f64) {
        let dt = f64::from(params.dt as f32);
        let (mut in_springs, mut in_dampers) = (0.0, 0.0);
        for &CarriedSpring { spring, carried, position: before, brake_power } in &self.springs {
            let after = model.springs[spring].map(|end| motion(end as usize)[0]);
            let energy = |[i, j]: [DVec3; 2]| stored(params, spring, i - j);
            let hand_moved = [0, 1].map(|end| if carried[end] { after[end] } else { before[end] });
            let rest_moved = [0, 1].map(|end| if carried[end] { before[end] } else { after[end] });
            in_springs += 0.5 * (energy(hand_moved) - energy(before) + energy(after) - energy(rest_moved));
            in_dampers += brake_power * dt;
        }
        (in_springs, in_dampers)
    }
}
