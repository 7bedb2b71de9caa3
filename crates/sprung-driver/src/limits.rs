//! How large dt may be, found out as often as that is affordable.

use std::sync::Arc;

use sprung::{Params, Simulation, stability};

use crate::report::Stability;
use crate::settings::limits_are_same;

/// Springs of a model whose certified limit can be found for every report, and its sharp limit while it plays.
pub(crate) const SMALL: usize = 20_000;

/// Real time from one certified limit of a large model to the next while it plays, s.
pub(crate) const NOW_AND_THEN: f64 = 0.3;

/// Real time from one sharp limit of a small model to the next while it plays, s.
const SHARP_EVERY: f64 = 0.5;

/// The limits as they were found last, and of what.
#[derive(Debug, Default)]
pub(crate) struct Limits {
    found: Stability,
    params: Option<Arc<Params>>,
    /// Step at which the certified limit was found, and real time then, s.
    certified_at: Option<(u64, f64)>,
    sharp_at: Option<f64>,
    /// The parameters have changed since the limit of every configuration was found.
    every_is_stale: bool,
}

impl Limits {
    /// What is known now.
    pub fn found(&self) -> Stability {
        self.found
    }

    /// The state has changed in another way than by a step: nothing that was found holds.
    pub fn forget(&mut self) {
        (self.certified_at, self.found.sharp_step) = (None, None);
    }

    /// Finds what is due. `clock` is real time, s.
    pub fn refresh(&mut self, simulation: &mut Simulation, params: &Arc<Params>, playing: bool, clock: f64) {
        // Not the state: it is copied out only when a limit of a small model is due.
        let (step, _) = simulation.now();
        let is_small = simulation.model().spring_count() <= SMALL;
        if !self.params.as_ref().is_some_and(|old| Arc::ptr_eq(old, params) || limits_are_same(old, params)) {
            self.every_is_stale = true;
            self.found.sharp_step = None;
        }
        self.params = Some(params.clone());

        // A slider that is dragged while a large model plays would make it stutter.
        let is_recent = |(_, time): (u64, f64)| clock - time < NOW_AND_THEN;
        if playing && !is_small && self.certified_at.is_some_and(is_recent) {
            return;
        }
        let is_changed = std::mem::take(&mut self.every_is_stale);
        if is_changed {
            self.found.every_configuration = simulation.limit_of_every_configuration().map(|limit| limit.dt);
        }
        if is_changed || self.certified_at.is_none_or(|(found, _)| found != step) {
            // Where it costs little, the very limit and the very spring that `sprung show` names: of springs alike, rounding
            // picks one.
            self.found.certified = if is_small {
                stability::certified(simulation.model(), params, &simulation.state().position)
            } else {
                simulation.certified_limit()
            };
            self.certified_at = Some((step, clock));
        }

        let is_known = self.found.sharp_step == Some(step);
        let sharp_is_due = !playing || self.sharp_at.is_none_or(|time| clock - time >= SHARP_EVERY);
        if is_small && !is_known && sharp_is_due {
            self.find_sharp(simulation, clock);
        }
    }

    /// Finds the sharp limit of this state: up to some seconds for a large model.
    pub fn find_sharp(&mut self, simulation: &Simulation, clock: f64) {
        let state = simulation.state();
        self.found.sharp = stability::sharp(simulation.model(), simulation.params(), &state.position).dt;
        self.found.sharp_step = Some(state.step);
        self.sharp_at = Some(clock);
    }
}
