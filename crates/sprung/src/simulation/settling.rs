//! Coming to rest by kinetic damping, at once or in portions.

use std::ops::ControlFlow;

use super::Simulation;
use super::beginning::hold_fixed_points;
use crate::error::{Code, Error, Result};
use crate::history::Event;
use crate::params::Params;
use crate::settle::{SettleOptions, Settled};
use crate::state::State;
use crate::watch;

/// Steps between two calls of the progress of settling.
const STEPS_TO_PROGRESS: u64 = 64;

/// A simulation that is coming to rest, some steps at a time, so that whoever settles it can do other things in between:
/// what [`Simulation::settle`] does at once, with the same bits.
///
/// ```
/// use std::ops::ControlFlow;
/// use sprung::{SettleOptions, scene::Scene};
///
/// let mut settling = Scene::builtin("spring")?.simulation()?.settling(SettleOptions::default());
/// let settled = loop {
///     let mut steps = 100;
///     let mut may_go_on = || { steps -= 1; steps > 0 };
///     match settling.go_on(&mut may_go_on)? {
///         ControlFlow::Continue(rest) => settling = rest,
///         ControlFlow::Break(simulation) => break simulation,
///     }
/// };
/// assert_eq!(settled.now().0, 0);
/// # Ok::<(), sprung::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Settling {
    simulation: Simulation,
    under_way: UnderWay,
}

impl Settling {
    /// How far it is.
    pub fn so_far(&self) -> Settled {
        self.under_way.so_far
    }

    /// Steps on, as long as it is asked before each step whether it may: gives the simulation at rest, or the rest of the work.
    ///
    /// # Errors
    /// As [`Simulation::settle`].
    pub fn go_on(mut self, may_go_on: &mut dyn FnMut() -> bool) -> Result<ControlFlow<Simulation, Self>> {
        if !self.simulation.relax(&mut self.under_way, &mut |_| may_go_on())? {
            return Ok(ControlFlow::Continue(self));
        }
        let options = self.under_way.options;
        self.simulation.end_settling(self.under_way);
        self.simulation.log_settling(options);
        Ok(ControlFlow::Break(self.simulation))
    }
}

/// Settling, as far as it is.
#[derive(Clone, Debug)]
struct UnderWay {
    options: SettleOptions,
    /// The largest force that may remain, N.
    allowed: f64,
    before: State,
    energy_before: f64,
    /// Events that were logged for this step before.
    events: usize,
    kinetic_before: f64,
    so_far: Settled,
}

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
        self.log_settling(options);
        Ok(settled)
    }

    /// Begins to [`settle`](Self::settle), to go on in portions.
    pub fn settling(mut self, options: SettleOptions) -> Settling {
        let events = self.history.events_at(self.current.step()).len();
        let under_way = self.begin_settling(options, events);
        Settling { simulation: self, under_way }
    }

    /// Settles as the next event after so many others at the current step.
    pub(super) fn settle_unlogged(
        &mut self,
        options: SettleOptions,
        progress: &mut dyn FnMut(Settled) -> ControlFlow<()>,
        events: usize,
    ) -> Result<Settled> {
        let mut under_way = self.begin_settling(options, events);
        let relaxed = self.relax(&mut under_way, &mut |so_far| {
            !so_far.steps.is_multiple_of(STEPS_TO_PROGRESS) || progress(so_far).is_continue()
        });
        match relaxed {
            Ok(true) => {
                let settled = under_way.so_far;
                self.end_settling(under_way);
                Ok(settled)
            }
            failed => {
                *self.current.state_mut() = under_way.before;
                failed.and(Err(Error::new(Code::Interrupted, "settling was interrupted")))
            }
        }
    }

    fn begin_settling(&mut self, options: SettleOptions, events: usize) -> UnderWay {
        let before = self.current.copied();
        let energy_before = self.energy().total();
        self.refresh_solver();
        self.current.stop(self.params.dt);
        let residual_force = self.current.solver().residual_force(&self.params);
        let allowed = options.residual_force.unwrap_or_else(|| default_residual(&self.params));
        let so_far = Settled { steps: 0, residual_force };
        UnderWay { options, allowed, before, energy_before, events, kinetic_before: 0.0, so_far }
    }

    /// Steps until no force beyond the residual remains, as far as it may; gives whether it has got there.
    fn relax(
        &mut self,
        under_way: &mut UnderWay,
        may_go_on: &mut dyn FnMut(Settled) -> bool,
    ) -> Result<bool> {
        let UnderWay { options, allowed, kinetic_before, so_far, .. } = under_way;
        while so_far.steps <= options.max_steps {
            if so_far.residual_force <= *allowed {
                return Ok(true);
            }
            if !may_go_on(*so_far) {
                return Ok(false);
            }
            if !self.current.advance(&self.params, 1, &*self.workers) {
                let blow_up = watch::not_finite(&self.model, &self.params, &self.current);
                return Err(Error::from_blow_up(blow_up));
            }
            let kinetic = self.current.kinetic_energy(&*self.workers);
            if kinetic < *kinetic_before {
                self.current.stop(self.params.dt);
                so_far.residual_force = self.current.solver().residual_force(&self.params);
                *kinetic_before = 0.0;
            } else {
                *kinetic_before = kinetic;
            }
            so_far.steps += 1;
        }
        let sentence = format!(
            "the scene did not come to rest: after {} steps a force of {:.3e} N remains, over the {allowed:.3e} N allowed",
            options.max_steps, so_far.residual_force
        );
        Err(Error::new(Code::NotSettled, sentence)
            .with_fix("hold every body by a pin or a plane, as what falls or drifts never rests"))
    }

    /// It is at rest.
    fn end_settling(&mut self, UnderWay { before, energy_before, events, .. }: UnderWay) {
        self.placed = None;
        let state = self.current.state_mut();
        hold_fixed_points(&self.params, state);
        // Neither steps nor time have passed; the energy that was taken out is work put in, of negative sign.
        (state.step, state.time, state.clock) = (before.step, before.time, before.clock);
        state.ledger = before.ledger;
        state.ledger.suspect_steps = 0;
        let energy = self.energy().total();
        self.current.counters().ledger.work_in += energy - energy_before;
        self.watch.restart(&mut self.current, &self.params, events + 1);
    }

    fn log_settling(&mut self, options: SettleOptions) {
        self.history.branch_at(self.current.step());
        self.history.record(self.current.step(), Event::Settle(options));
    }
}

/// A thousandth of the largest weight, N.
fn default_residual(params: &Params) -> f64 {
    let largest = params.point_mass.iter().fold(0.0f32, |max, &mass| max.max(mass));
    let weight = f64::from(largest) * params.gravity.as_dvec3().length();
    if weight > 0.0 { 1e-3 * weight } else { 1e-3 }
}
