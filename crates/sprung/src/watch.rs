//! Noticing that a run blew up, keeping the last good state, and saying why it happened.
//!
//! *Blown up* means: a position that is not finite; or energy − energy at the start − work put in stays above half of
//! kinetic + elastic energy for 20 steps in a row.

use std::fmt;

use crate::energy::Energy;
use crate::model::Model;
use crate::params::Params;
use crate::stability::{self, Setter};
use crate::state::State;

/// Steps in a row that energy must come from nowhere before a run counts as blown up. Also how often, in steps, a calm run
/// is looked at: the energy of a large model costs about as much as a step.
const PATIENCE: u64 = 20;

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
    /// The step length in use, s.
    pub dt: f64,
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
            dt: params.dt,
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
        Some(round_down(0.95 * limit))
    }
}

/// To two significant digits, downwards.
fn round_down(value: f64) -> f64 {
    let digits = format!("{value:.1e}");
    let rounded: f64 = digits.parse().unwrap_or(value);
    if rounded <= value {
        return rounded;
    }
    let unit: f64 = digits.split_once('e').and_then(|(_, e)| format!("1e{e}").parse().ok()).unwrap_or(0.0);
    format!("{:.1e}", rounded - 0.1 * unit).parse().unwrap_or(value)
}

impl fmt::Display for BlowUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the simulation blew up at t = {:.4} s (step {}): ", self.time, self.step)?;
        match self.cause {
            Cause::NotFinite => write!(f, "a position is no longer a finite number. ")?,
            Cause::EnergyFromNowhere { excess } => {
                write!(
                    f,
                    "for {PATIENCE} steps more than half of its energy has come from nowhere ({excess:.3e} J). "
                )?;
            }
        }
        write!(
            f,
            "The state of t = {:.4} s (step {}) is the last good one and is kept. ",
            self.good_time, self.good_step
        )?;
        self.write_reason(f)?;
        match self.suggested_dt() {
            Some(dt) => write!(f, "Use dt = {dt} s or less, or dt = \"auto\".")?,
            None => write!(f, "Use a smaller dt, less stiffness or less damping.")?,
        }
        Ok(())
    }
}

impl BlowUp {
    fn write_reason(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let dt = self.dt;
        match (&self.points[..], self.spring) {
            (&[i, j], Some(spring)) => {
                write!(
                    f,
                    "The tightest limit is set by spring {spring} of {} (points {i} and {j}): ",
                    self.owner
                )?;
            }
            (&[point], _) => {
                write!(f, "The tightest limit is set by the contact or grab at point {point}: ")?
            }
            _ => {}
        }
        match (self.dt_limit_certified, self.dt_limit_every_configuration) {
            (Some(limit), _) if dt > limit => {
                write!(
                    f,
                    "dt = {dt} s is {:.0} % of the certified limit of {limit:.4e} s there. ",
                    100.0 * dt / limit
                )
            }
            (Some(limit), Some(every)) if dt > every => write!(
                f,
                "dt = {dt} s was within the certified limit of {limit:.4e} s for that state, but over the {every:.4e} s that \
                 hold in every configuration, and the motion has crossed into one that is not stable. "
            ),
            (Some(limit), _) => write!(
                f,
                "dt = {dt} s was within the certified limit of {limit:.4e} s, so the cause is not the step length alone. "
            ),
            (None, _) => write!(f, "No spring or contact limits dt = {dt} s at that state. "),
        }
    }
}

/// Looks at a run as it goes and keeps its last good state, with the parameters that led there.
#[derive(Clone, Debug)]
pub(crate) struct Watch {
    good: (State, Params),
    /// How many of the events logged for the good state's step it already holds: settling makes a good state of its own.
    good_events: usize,
    /// Steps in a row with too much energy.
    streak: u64,
}

impl Watch {
    pub fn new(state: &State, params: &Params) -> Self {
        Self { good: (state.clone(), params.clone()), good_events: 0, streak: 0 }
    }

    /// Starts over from a state that is known to be good, after so many of the events logged for its step.
    pub fn restart(&mut self, state: &State, params: &Params, events: usize) {
        self.good.0.clone_from(state);
        self.good.1.clone_from(params);
        self.good_events = events;
        self.streak = 0;
    }

    /// The last state that was looked at and found good.
    pub fn good(&self) -> &(State, Params) {
        &self.good
    }

    /// How many of the events logged for its step the good state already holds.
    pub fn good_events(&self) -> usize {
        self.good_events
    }

    /// After every step: what blew up, if something did.
    pub fn look(&mut self, model: &Model, params: &Params, state: &State, finite: bool) -> Option<BlowUp> {
        if !finite {
            return Some(self.not_finite(model, params, state));
        }
        if self.streak == 0 && !state.step.is_multiple_of(PATIENCE) {
            return None;
        }
        let Some(excess) = excess(model, params, state) else {
            self.restart(state, params, 0);
            return None;
        };
        self.streak += 1;
        let cause = Cause::EnergyFromNowhere { excess };
        (self.streak >= PATIENCE).then(|| BlowUp::new(model, params, cause, state, &self.good.0))
    }

    /// The report of a state that is not finite.
    pub fn not_finite(&self, model: &Model, params: &Params, state: &State) -> BlowUp {
        BlowUp::new(model, params, Cause::NotFinite, state, &self.good.0)
    }
}

/// Energy from nowhere, J, where it is more than half of kinetic + elastic.
pub(crate) fn excess(model: &Model, params: &Params, state: &State) -> Option<f64> {
    let energy = Energy::of(model, params, state);
    let excess = energy.total() - state.ledger.start - state.ledger.work_in;
    let rounding = ROUNDING * (state.ledger.start.abs() + state.ledger.work_in.abs());
    (excess > 0.5 * (energy.kinetic + energy.elastic) + rounding || excess.is_nan()).then_some(excess)
}
