//! The run that a branch left, shown beside the new one at the same time.

use std::sync::Arc;

use sprung::{Simulation, Snapshot};

use crate::report::Comparison;
use crate::run::go_towards;
use crate::timeline::Recorded;

/// An earlier run. It is replayed, never continued: beyond its newest step it stands still.
pub(crate) struct Ghost {
    simulation: Simulation,
    recorded: Recorded,
    /// Step and time at which the runs parted.
    pub parted: (u64, f64),
    picture: Arc<Snapshot>,
    /// It could not replay what it had recorded, and stands still. This does not happen; if it did, trying again would not
    /// help.
    is_lost: bool,
}

impl Ghost {
    pub fn new(simulation: Simulation, recorded: Recorded, parted: (u64, f64)) -> Self {
        Self { simulation, recorded, parted, picture: Arc::default(), is_lost: false }
    }

    /// The step it is to be at when the other run is at this time (s).
    fn target(&self, time: f64) -> u64 {
        let steps = self.simulation.recorded_steps();
        self.recorded.step_at(time).clamp(*steps.start(), *steps.end())
    }

    /// Whether it is where it belongs at this time, s.
    pub fn is_at(&self, time: f64) -> bool {
        self.is_lost || self.simulation.now().0 == self.target(time)
    }

    /// Goes on, or back, to this time (s) as far as it may.
    pub fn follow(&mut self, time: f64, may_go_on: &mut dyn FnMut() -> bool) {
        let target = self.target(time);
        self.is_lost |= go_towards(&mut self.simulation, target, may_go_on).is_err();
    }

    /// How it is now, compared with the other run.
    pub fn compare(&mut self, other: &Snapshot) -> Comparison {
        if self.picture.positions.is_empty() || self.picture.step != self.simulation.now().0 {
            if Arc::get_mut(&mut self.picture).is_none() {
                self.picture = Arc::default();
            }
            if let Some(picture) = Arc::get_mut(&mut self.picture) {
                self.simulation.fill(picture);
            }
        }
        let pairs = self.picture.positions.iter().zip(&other.positions);
        let apart = pairs.map(|(a, b)| f64::from(a.distance_squared(*b))).fold(0.0, f64::max).sqrt();
        Comparison { snapshot: self.picture.clone(), parted: self.parted.0, apart }
    }
}
