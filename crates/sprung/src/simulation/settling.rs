//! Coming to rest.

use std::ops::ControlFlow;

use super::Simulation;
use super::beginning::hold_fixed_points;
use crate::error::{Code, Error, Result};
use crate::history::Event;
use crate::params::Params;
use crate::settle::{SettleOptions, Settled};
use crate::watch;

/// Steps between two calls of the progress of settling.
const STEPS_TO_PROGRESS: u64 = 64;

impl Simulation {
    /// Brings the scene to rest by kinetic damping (Cundall 1976): it steps on, sets all velocities to zero whenever the
    /// kinetic energy has passed a peak, and stops when no force beyond the residual remains. Neither step nor time go on.
    ///
    /// # Errors
    /// [`Code::NotSettled`] after too many steps, [`Code::BlewUp`] if it blows up; the state is then as before.
    pub fn settle(&mut self, options: SettleOptions) -> Result<Settled> {
        self.settle_with(options, &mut |_| ControlFlow::Continue(()))
    }

    /// As [`settle`](Self::settle); `progress` hears every 64 steps how far it is and may break off.
    ///
    /// # Errors
    /// As [`settle`](Self::settle), and [`Code::Interrupted`] if `progress` broke off.
    pub fn settle_with(
        &mut self,
        options: SettleOptions,
        progress: &mut dyn FnMut(Settled) -> ControlFlow<()>,
    ) -> Result<Settled> {
        let events = self.history.events_at(self.current.step()).len();
        let settled = self.settle_unlogged(options, progress, events)?;
        self.history.branch_at(self.current.step());
        self.history.record(self.current.step(), Event::Settle(options));
        Ok(settled)
    }

    /// Settles as the next event after so many others at the current step.
    pub(super) fn settle_unlogged(
        &mut self,
        options: SettleOptions,
        progress: &mut dyn FnMut(Settled) -> ControlFlow<()>,
        events: usize,
    ) -> Result<Settled> {
        let before = self.current.copied();
        let energy_before = self.energy().total();
        let settled = self.relax(options, progress);
        let state = self.current.state_mut();
        if settled.is_err() {
            *state = before;
            return settled;
        }
        self.placed = None;
        hold_fixed_points(&self.params, state);
        // Neither steps nor time have passed; the energy that was taken out is work put in, of negative sign.
        (state.step, state.time, state.clock) = (before.step, before.time, before.clock);
        state.ledger = before.ledger;
        state.ledger.suspect_steps = 0;
        let energy = self.energy().total();
        self.current.counters().ledger.work_in += energy - energy_before;
        self.watch.restart(&mut self.current, &self.params, events + 1);
        settled
    }

    fn relax(
        &mut self,
        options: SettleOptions,
        progress: &mut dyn FnMut(Settled) -> ControlFlow<()>,
    ) -> Result<Settled> {
        self.refresh_solver();
        let allowed = options.residual_force.unwrap_or_else(|| default_residual(&self.params));
        let mut kinetic_before = 0.0;
        self.current.stop();
        let mut residual_force = self.current.solver().residual_force(&self.params);
        for steps in 0..=options.max_steps {
            if residual_force <= allowed {
                return Ok(Settled { steps, residual_force });
            }
            if !self.current.advance(&self.params, 1, &*self.workers) {
                let blow_up = watch::not_finite(&self.model, &self.params, &self.current);
                return Err(Error::from_blow_up(blow_up));
            }
            let kinetic = self.current.kinetic_energy(&*self.workers);
            if kinetic < kinetic_before {
                self.current.stop();
                residual_force = self.current.solver().residual_force(&self.params);
                kinetic_before = 0.0;
            } else {
                kinetic_before = kinetic;
            }
            let is_told = steps.is_multiple_of(STEPS_TO_PROGRESS);
            if is_told && progress(Settled { steps, residual_force }).is_break() {
                return Err(Error::new(Code::Interrupted, "settling was interrupted"));
            }
        }
        let sentence = format!(
            "the scene did not come to rest: after {} steps a force of {residual_force:.3e} N remains, over the {allowed:.3e} N \
             allowed",
            options.max_steps
        );
        Err(Error::new(Code::NotSettled, sentence)
            .with_fix("hold every body by a pin or a plane, as what falls or drifts never rests"))
    }
}

/// A thousandth of the largest weight, N.
fn default_residual(params: &Params) -> f64 {
    let largest = params.point_mass.iter().fold(0.0f32, |max, &mass| max.max(mass));
    let weight = f64::from(largest) * params.gravity.as_dvec3().length();
    if weight > 0.0 { 1e-3 * weight } else { 1e-3 }
}
