//! Beginning a run, with all that it takes looked over.

use std::sync::Arc;

use glam::Vec3;

use super::{Checkpoint, Simulation};
use crate::current::Current;
use crate::energy::{Drives, LedgerSums};
use crate::error::{Code, Error, Result};
use crate::history::{DEFAULT_HISTORY_BYTES, History, Past};
use crate::math::without_subnormals;
use crate::model::Model;
use crate::params::{Params, check_vectors};
use crate::solver::SymplecticEuler;
use crate::state::{Snapshot, State};
use crate::watch::Watch;
use crate::workers::Inline;

/// The step that a state may be at when a run begins: whole numbers up to here are exact in float64.
pub const MOST_STEPS: u64 = 1 << 53;

impl Simulation {
    /// Begins a run: a model, its parameters and a state to start from. Velocities of fixed points become zero, and the
    /// ledger starts here.
    ///
    /// # Errors
    /// [`Code::OutOfRange`] or [`Code::Conflict`] if a value is not allowed or the parts do not fit together.
    pub fn new(model: impl Into<Arc<Model>>, params: Params, mut state: State) -> Result<Self> {
        let model = model.into();
        params.validate(&model)?;
        check_state(&model, &state)?;
        hold_fixed_points(&params, &mut state);
        state.ledger = LedgerSums::default();
        let mut current = load(&model, &params, state);
        current.counters().ledger.start = current.energy(&params, &Inline).total();
        current.keep();
        Ok(Self::begin(model, params, current))
    }

    /// As [`resume_from`](Self::resume_from), from the parts of a checkpoint, without the energy ledger.
    ///
    /// # Errors
    /// As [`resume_from`](Self::resume_from).
    pub fn resume(model: impl Into<Arc<Model>>, params: Params, state: State) -> Result<Self> {
        Self::resume_from(model, Checkpoint { state, params: params.into(), keeps_ledger: false })
    }

    /// Goes on from what has been checked.
    pub(super) fn begin(model: Arc<Model>, params: impl Into<Arc<Params>>, current: Current) -> Self {
        let params = params.into();
        let start = Arc::new(Past { state: current.copied(), params: params.clone() });
        Self {
            workers: Arc::new(Inline),
            watch: Watch::new(&params),
            current,
            history: History::new(start.clone(), DEFAULT_HISTORY_BYTES),
            start,
            packed: None,
            history_budget: DEFAULT_HISTORY_BYTES,
            drives: Drives::default(),
            ledger: None,
            snapshot: Snapshot::default(),
            forces: Vec::new(),
            every_configuration: None,
            placed: None,
            model,
            params,
        }
    }
}

/// A state with a solver for it, the first one to be kept.
pub(super) fn load(model: &Arc<Model>, params: &Params, mut state: State) -> Current {
    state.drop_subnormals();
    state.check_clock(params.dt);
    Current::new(SymplecticEuler::new(model.clone(), params), state)
}

/// Points that no force can move stand still, or move as the hand does that carries them.
pub(super) fn hold_fixed_points(params: &Params, state: &mut State) {
    (0..state.velocity.len()).for_each(|point| hold(params, state, point));
}

pub(super) fn hold(params: &Params, state: &mut State, point: usize) {
    if params.is_fixed(point) {
        let carried = params.carried.get(&point).copied().unwrap_or_default();
        state.velocity[point] = without_subnormals(carried);
        state.velocity_low[point] = Vec3::ZERO;
    }
}

fn check_state(model: &Model, state: &State) -> Result<()> {
    check_lengths(model, state)?;
    for (field, vectors) in vectors(state) {
        check_vectors(field, vectors)?;
    }
    check_counters(state)
}

pub(super) fn vectors(state: &State) -> [(&'static str, &Vec<Vec3>); 4] {
    [
        ("position", &state.position),
        ("position_low", &state.position_low),
        ("velocity", &state.velocity),
        ("velocity_low", &state.velocity_low),
    ]
}

/// There is an entry for each point.
pub(super) fn check_lengths(model: &Model, state: &State) -> Result<()> {
    match vectors(state).into_iter().find(|(_, vectors)| vectors.len() != model.point_count()) {
        None => Ok(()),
        Some((field, vectors)) => {
            let sentence =
                format!("has {} entries, and the model has {} points", vectors.len(), model.point_count());
            Err(Error::new(Code::Conflict, sentence).at_field(field))
        }
    }
}

/// Time and sums are numbers, and counts are not beyond what can be counted with.
pub(super) fn check_counters(state: &State) -> Result<()> {
    let LedgerSums { start, work_in, lost_in_dampers, lost_in_contact, integrator_error, suspect_steps } =
        state.ledger;
    let numbers = [
        ("time", state.time),
        ("ledger.start", start),
        ("ledger.work_in", work_in),
        ("ledger.lost_in_dampers", lost_in_dampers),
        ("ledger.lost_in_contact", lost_in_contact),
        ("ledger.integrator_error", integrator_error),
    ];
    if let Some((field, value)) = numbers.into_iter().find(|(_, value)| !value.is_finite()) {
        let sentence = format!("is {value}, and must be a finite number");
        return Err(Error::new(Code::OutOfRange, sentence).at_field(field));
    }
    let counts = [("step", state.step), ("ledger.suspect_steps", suspect_steps)];
    match counts.into_iter().find(|(_, count)| *count > MOST_STEPS) {
        None => Ok(()),
        Some((field, count)) => {
            let sentence = format!("is {count}, and must be at most {MOST_STEPS}");
            Err(Error::new(Code::OutOfRange, sentence).at_field(field))
        }
    }
}
