//! Changing parameters and placing points while a run is under way.

use std::sync::Arc;

use glam::Vec3;

use super::Simulation;
use super::beginning::{hold, hold_fixed_points};
use crate::energy;
use crate::error::Result;
use crate::history::{self, Event, Past};
use crate::math::without_negligible;
use crate::params::{Change, Params};
use crate::state::State;

/// How it was before something was put in place. A hand that moves a point about while time stands still places it over
/// and over, as a slider does with parameters; each time that begins from how it was at first, so that the last place alone
/// counts, to the bit: the log keeps no other.
#[derive(Clone)]
pub(super) enum Placed {
    /// A point.
    Point { point: usize, position: [Vec3; 2], velocity: [Vec3; 2], work_in: f64 },
    /// Parameters, by this change: it may have stopped points, and the clock.
    Params(Change, Arc<Past>),
}

impl Placed {
    fn point(point: usize, state: &State) -> Self {
        Self::Point {
            point,
            position: [state.position[point], state.position_low[point]],
            velocity: [state.velocity[point], state.velocity_low[point]],
            work_in: state.ledger.work_in,
        }
    }

    /// If it was this point that was placed, that has not happened.
    fn take_back(self, this: usize, state: &mut State) {
        if let Self::Point { point, position, velocity, work_in } = self
            && point == this
        {
            [state.position[point], state.position_low[point]] = position;
            [state.velocity[point], state.velocity_low[point]] = velocity;
            state.ledger.work_in = work_in;
        }
    }
}

impl Simulation {
    /// Changes a parameter from this step on. The same one changed over and over between two steps has been changed once: to
    /// the last value, from what was before the first.
    ///
    /// # Errors
    /// [`Code::OutOfRange`](crate::Code::OutOfRange), and then nothing has changed.
    pub fn change(&mut self, change: Change) -> Result<()> {
        self.change_unlogged(&change)?;
        self.history.branch_at(self.current.step());
        self.history.record(self.current.step(), Event::Change(change));
        Ok(())
    }

    pub(super) fn change_unlogged(&mut self, change: &Change) -> Result<()> {
        if let Change::Carry(point, _) | Change::Place(point, _) = change {
            return self.move_point(*point, change);
        }
        let mut wanted = Params::clone(&self.params);
        wanted.apply(&self.model, change)?;
        let placed = self.placed.take();
        if moves_energy(change) {
            // A value that is set twice between two steps was set once, from how it was before the first time.
            let first = match placed {
                Some(Placed::Params(last, first)) if history::replaces(change, &last) => {
                    let Past { state, params } = Past::clone(&first);
                    *self.current.state_mut() = state;
                    self.set_params(params);
                    first
                }
                _ => {
                    let (state, params) = (self.current.state().clone(), self.params.clone());
                    Arc::new(Past { state, params })
                }
            };
            self.placed = Some(Placed::Params(change.clone(), first));
        }
        let before = if moves_energy(change) { Some(self.energy().total()) } else { None };
        let old = self.set_params(Arc::new(wanted));
        if self.params.dt != old.dt {
            self.current.counters().restart_clock();
        }
        if matches!(change, Change::Mass(..) | Change::Pin(..) | Change::Params(_)) {
            hold_fixed_points(&self.params, self.current.state_mut());
        }
        if let Some(before) = before {
            // What a change adds to the energy is work put in, not energy from nowhere.
            let work_in = self.energy().total() - before;
            self.current.counters().ledger.work_in += work_in;
        }
        Ok(())
    }

    /// Carries, lets go or places one point: many times a second, so only what this point can alter is looked at.
    fn move_point(&mut self, point: usize, change: &Change) -> Result<()> {
        let old = self.params.clone();
        Arc::make_mut(&mut self.params).apply(&self.model, change)?;
        let earlier = self.placed.take();
        let state = self.current.state_mut();
        if let (Change::Place(..), Some(placed)) = (change, earlier) {
            placed.take_back(point, state);
        }
        let before = energy::around(&self.model, &old, state, point);
        if let Change::Place(_, position) = change {
            self.placed = Some(Placed::point(point, state));
            state.position[point] = without_negligible(*position);
            state.position_low[point] = Vec3::ZERO;
            state.velocity[point] = Vec3::ZERO;
            state.velocity_low[point] = Vec3::ZERO;
        }
        // The hand takes the point's own energy over, or gives it some.
        hold(&self.params, state, point);
        state.ledger.work_in += energy::around(&self.model, &self.params, state, point) - before;
        // If other changes are still to be packed, this will be with them.
        if self.packed.is_none() {
            self.current.unpacked().refresh_point(&self.params, point);
        }
        Ok(())
    }

    /// Takes other parameters, and gives the old ones back.
    pub(super) fn set_params(&mut self, params: Arc<Params>) -> Arc<Params> {
        let old = std::mem::replace(&mut self.params, params);
        self.packed.get_or_insert_with(|| old.clone());
        old
    }
}

/// Whether a change can alter the energy of the current state.
fn moves_energy(change: &Change) -> bool {
    use Change::{Cut, Gravity, Mass, Params, Pin, Planes, RestScale, Stiffness};
    matches!(
        change,
        Gravity(_) | Planes(_) | Mass(..) | Pin(..) | Stiffness(..) | RestScale(..) | Cut(..) | Params(_)
    )
}
