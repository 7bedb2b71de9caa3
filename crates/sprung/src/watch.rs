//! Noticing that a run blew up, keeping the last good state, and saying why it happened.
//!
//! *Blown up* means: a position that is not finite; or energy − energy at the start − work put in stays above half of
//! kinetic + elastic energy for 20 steps in a row.

use std::fmt;
use std::sync::Arc;

use crate::current::Current;
use crate::energy::{Energy, LedgerSums};
use crate::model::Model;
use crate::params::{DT_RANGE, Params};
use crate::stability::{self, Setter};
use crate::state::State;
use crate::text::{round_down, significant};
use crate::workers::Workers;

/// Steps in a row that energy must come from nowhere before a run counts as blown up. Also how often, in steps, a calm run
/// is looked at: its energies cost about as much as a step.
pub const PATIENCE: u64 = 20;

/// The part of a limit on dt that is safe to take, 5 % below it. The limit itself is safe in real numbers; the margin is for
/// the rounding of a float32 step, for a mode at its very limit, which rings undamped, and for a network that moves on.
pub const SAFE_SHARE: f64 = 0.95;

/// Energy from nowhere below this share of the energy at the start is rounding.
const ROUNDING: f64 = 1e-6;

/// How a blow-up showed itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// A position became infinite or NaN.
    NotFinite,
    /// More than half of kinetic + elastic energy came from nowhere, 20 steps in a row.
    EnergyFromNowhere {
        /// Energy beyond what was there at the start and put in since, J.
        excess: f64,
    },
}

/// What happened when a run blew up, where, why, and what to change. Prints as one paragraph.
#[derive(Clone, Debug, PartialEq)]
pub struct BlowUp {
    /// How it showed itself.
    pub cause: Cause,
    /// The step at which it was noticed.
    pub step: u64,
    /// Simulated time then, s.
    pub time: f64,
    /// The step of the last good state, which is kept.
    pub good_step: u64,
    /// The time of the last good state, s.
    pub good_time: f64,
    /// The spring that sets the certified limit at the last good state, if one does.
    pub spring: Option<usize>,
    /// Its points; or the one point whose contact or grab sets the limit.
    pub points: Vec<usize>,
    /// The body or joint that the spring belongs to.
    pub owner: String,
    /// What sets the limit, by name and by numbers within its body: [`Model::spring_name`], [`Model::point_name`].
    pub place: String,
    /// The step length in use, s.
    pub dt: f64,
    /// See [`suggested_damping_scale`](Self::suggested_damping_scale), before rounding.
    pub damping_scale: Option<f64>,
    /// The certified limit on dt at the last good state, s.
    pub dt_limit_certified: Option<f64>,
    /// The limit on dt that holds in every configuration, s.
    pub dt_limit_every_configuration: Option<f64>,
}

impl BlowUp {
    fn new(model: &Model, params: &Params, cause: Cause, bad: &State, good: &State) -> Self {
        let certified = stability::certified(model, params, &good.position);
        let spring = match certified.as_ref().map(|limit| limit.setter) {
            Some(Setter::Spring(spring)) => Some(spring),
            _ => None,
        };
        let points = match certified.as_ref().map(|limit| limit.setter) {
            Some(Setter::Spring(spring)) => model.springs[spring].map(|point| point as usize).to_vec(),
            Some(Setter::Point(point)) => vec![point],
            None => Vec::new(),
        };
        Self {
            cause,
            step: bad.step,
            time: bad.time,
            good_step: good.step,
            good_time: good.time,
            spring,
            points,
            owner: spring.map(|spring| model.spring_owner(spring).to_owned()).unwrap_or_default(),
            place: match certified.as_ref().map(|limit| limit.setter) {
                Some(Setter::Spring(spring)) => model.spring_name(spring),
                Some(Setter::Point(point)) => model.point_name(point),
                None => String::new(),
            },
            dt: params.dt,
            damping_scale: stability::damping_scale(model, params, &good.position, params.dt, SAFE_SHARE),
            dt_limit_certified: certified.map(|limit| limit.dt),
            dt_limit_every_configuration: stability::every_configuration(model, params).map(|limit| limit.dt),
        }
    }

    /// A step length that mends it, s: 95 % of the certified limit where dt crossed that, else of the limit that holds in
    /// every configuration.
    pub fn suggested_dt(&self) -> Option<f64> {
        let crossed = |limit: &f64| self.dt > *limit;
        let limit =
            self.dt_limit_certified.filter(crossed).or(self.dt_limit_every_configuration.filter(crossed))?;
        Some(round_down(SAFE_SHARE * limit))
    }

    /// By how much to multiply the damping of all springs so that dt, unchanged, is 95 % of the limit. `None` where
    /// damping is not to blame: stiffness or contact alone asks for a shorter step, or dt is short enough as it is.
    pub fn suggested_damping_scale(&self) -> Option<f64> {
        self.damping_scale.map(round_down)
    }
}

impl fmt::Display for BlowUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (time, good_time) = (significant(self.time), significant(self.good_time));
        write!(f, "the simulation blew up at t = {time} s (step {}): ", self.step)?;
        match self.cause {
            Cause::NotFinite => write!(f, "a position is no longer a finite number. ")?,
            Cause::EnergyFromNowhere { excess } => {
                let excess = significant(excess);
                write!(
                    f,
                    "for {PATIENCE} steps more than half of its energy has come from nowhere ({excess} J). "
                )?;
            }
        }
        write!(
            f,
            "The state of t = {good_time} s (step {}) is the last good one and is kept. ",
            self.good_step
        )?;
        self.write_reason(f)?;
        match self.suggested_dt() {
            Some(dt) if dt >= *DT_RANGE.start() => {
                write!(f, "Use dt = {} s or less, or dt = \"auto\".", significant(dt))
            }
            Some(_) => {
                let least = significant(*DT_RANGE.start());
                write!(
                    f,
                    "No step of {least} s or more is stable: raise masses, or lower stiffness or damping."
                )
            }
            None => write!(f, "Use a smaller dt, less stiffness or less damping."),
        }
    }
}

impl BlowUp {
    fn write_reason(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.points[..], self.spring) {
            (_, Some(_)) => write!(f, "The tightest limit is set by {}: ", self.place)?,
            (&[_], _) => write!(f, "The tightest limit is set by the contact or grab at {}: ", self.place)?,
            _ => {}
        }
        let dt = significant(self.dt);
        match (self.dt_limit_certified, self.dt_limit_every_configuration) {
            (Some(limit), _) if self.dt > limit => {
                let (share, limit) = (100.0 * self.dt / limit, significant(limit));
                write!(f, "dt = {dt} s is {share:.0} % of the certified limit of {limit} s there. ")
            }
            (limit, Some(every)) if self.dt > every => {
                let within = match limit {
                    Some(limit) => {
                        format!("was within the certified limit of {} s for that state", significant(limit))
                    }
                    None => "had no limit in that state, where nothing touches".to_owned(),
                };
                let every = significant(every);
                write!(
                    f,
                    "dt = {dt} s {within}, but it is over the {every} s that hold in every configuration, and the motion has \
                     crossed into one that is not stable. "
                )
            }
            (Some(limit), _) => {
                let limit = significant(limit);
                write!(
                    f,
                    "dt = {dt} s was within the certified limit of {limit} s, so the cause is not the step length alone. "
                )
            }
            (None, _) => write!(f, "No spring or contact limits dt = {dt} s at that state. "),
        }
    }
}

/// Looks at a run as it goes and has its last good state kept, with the parameters that led there. How long a run has been
/// suspect is part of its state, so that a run that is taken up again is judged as if it had never stopped.
#[derive(Clone, Debug)]
pub(crate) struct Watch {
    /// The parameters that led to the good state, which the run's [`Current`] keeps.
    good_params: Arc<Params>,
    /// How many of the events logged for the good state's step it already holds: settling makes a good state of its own.
    good_events: usize,
}

impl Watch {
    /// Begins with a state that has just been made, and is kept.
    pub fn new(params: &Arc<Params>) -> Self {
        Self { good_params: params.clone(), good_events: 0 }
    }

    /// From here on this is the state to go back to, after so many of the events logged for its step.
    pub fn restart(&mut self, current: &mut Current, params: &Arc<Params>, events: usize) {
        current.keep();
        self.good_params.clone_from(params);
        self.good_events = events;
    }

    /// The parameters that led to the last state that was looked at and found good.
    pub fn good_params(&self) -> &Arc<Params> {
        &self.good_params
    }

    /// How many of the events logged for its step the good state already holds.
    pub fn good_events(&self) -> usize {
        self.good_events
    }

    /// After the steps up to [`steps_to_look`]: what blew up, if something did.
    pub fn look(
        &mut self,
        model: &Model,
        params: &Arc<Params>,
        current: &mut Current,
        finite: bool,
        workers: &dyn Workers,
    ) -> Option<BlowUp> {
        if !finite {
            return Some(not_finite(model, params, current));
        }
        let counters = current.counters();
        if counters.ledger.suspect_steps == 0 && !counters.step.is_multiple_of(PATIENCE) {
            return None;
        }
        let Some(excess) = excess(&current.energy(params, workers)) else {
            current.counters().ledger.suspect_steps = 0;
            self.restart(current, params, 0);
            return None;
        };
        let suspect_steps = &mut current.counters().ledger.suspect_steps;
        *suspect_steps += 1;
        let cause = Cause::EnergyFromNowhere { excess };
        (*suspect_steps >= PATIENCE)
            .then(|| BlowUp::new(model, params, cause, current.state(), &current.kept()))
    }
}

/// The report of a current state that is not finite.
pub(crate) fn not_finite(model: &Model, params: &Params, current: &Current) -> BlowUp {
    BlowUp::new(model, params, Cause::NotFinite, current.state(), &current.kept())
}

/// How many steps from `step` until [`Watch::look`] looks at the energy.
pub(crate) fn steps_to_look(step: u64, suspect: bool) -> u64 {
    if suspect { 1 } else { PATIENCE - step % PATIENCE }
}

/// Energy from nowhere, J, where it is more than half of kinetic + elastic.
pub(crate) fn excess(energy: &Energy) -> Option<f64> {
    let LedgerSums { start, work_in, .. } = energy.sums;
    let rounding = ROUNDING * (start.abs() + work_in.abs());
    let excess = energy.total() - start - work_in;
    let allowed = 0.5 * (energy.kinetic + energy.elastic) + rounding;
    (excess > allowed || excess.is_nan()).then_some(excess)
}

#[cfg(test)]
mod tests;
