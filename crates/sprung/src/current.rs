//! The current state: with the solver while it steps, and in the user's order when somebody asks.

use std::sync::{Mutex, OnceLock, PoisonError};

use glam::DVec3;

use crate::energy::Energy;
use crate::params::Params;
use crate::solver::SymplecticEuler;
use crate::state::{Snapshot, State};
use crate::workers::Workers;

/// A solver and the state it is at. Positions and velocities are copied out of the solver's layout only when they are
/// asked for, and back into it only when they were written to.
#[derive(Debug)]
pub(crate) struct Current {
    solver: SymplecticEuler,
    /// The state, while its positions and velocities are up to date.
    state: OnceLock<State>,
    /// The state while they are not: its step, time and sums are.
    behind: Mutex<Option<State>>,
    /// Whether the solver has this state.
    is_loaded: bool,
    /// Step, time and sums of the state that was kept; its positions and velocities are with the solver.
    kept: State,
    /// How often positions or velocities may have changed.
    changes: u64,
}

impl Clone for Current {
    fn clone(&self) -> Self {
        let Self { is_loaded, changes, .. } = *self;
        let (solver, state) = (self.solver.clone(), OnceLock::from(self.copied()));
        Self { solver, state, behind: Mutex::default(), is_loaded, kept: self.kept.clone(), changes }
    }
}

impl Current {
    pub fn new(solver: SymplecticEuler, state: State) -> Self {
        let kept = state.counters();
        let (state, behind) = (OnceLock::from(state), Mutex::default());
        let mut current = Self { solver, state, behind, is_loaded: false, kept, changes: 0 };
        current.keep();
        current
    }

    /// Keeps this state, in the solver's layout, in place of the one before. It is the first one until then.
    pub fn keep(&mut self) {
        self.solver().keep();
        self.kept = self.counters().counters();
    }

    /// The state that was kept.
    pub fn kept(&self) -> State {
        let mut state = State::at_origin(&self.kept, self.solver.point_count());
        self.solver.store_kept(&mut state);
        state
    }

    /// Where the energy is now and where it went: for parameters that the solver has packed.
    pub fn energy(&mut self, params: &Params, workers: &dyn Workers) -> Energy {
        let sums = self.counters().ledger;
        Energy { sums, ..self.solver().energy(params, workers) }
    }

    /// The kinetic energy now, J: that of [`energy`](Self::energy).
    pub fn kinetic_energy(&mut self, workers: &dyn Workers) -> f64 {
        self.solver().kinetic_energy(workers)
    }

    /// The state.
    pub fn state(&self) -> &State {
        self.state.get_or_init(|| {
            let behind = self.behind.lock().unwrap_or_else(PoisonError::into_inner).take();
            let mut state = behind.expect("a state is either here or there");
            self.solver.store(&mut state);
            state
        })
    }

    /// The state, to write to.
    pub fn state_mut(&mut self) -> &mut State {
        self.state();
        self.is_loaded = false;
        self.changes += 1;
        self.state.get_mut().expect("it was just made")
    }

    /// The state to read and write step, time and sums of. Its positions and velocities may be out of date and must not be
    /// written to.
    pub fn counters(&mut self) -> &mut State {
        match self.state.get_mut() {
            Some(state) => state,
            None => {
                let behind = self.behind.get_mut().unwrap_or_else(PoisonError::into_inner);
                behind.as_mut().expect("a state is either here or there")
            }
        }
    }

    /// A copy of the state.
    pub fn copied(&self) -> State {
        if let Some(state) = self.state.get() {
            return state.clone();
        }
        let behind = self.behind.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(counters) = &*behind else {
            drop(behind);
            return self.state().clone();
        };
        let mut state = State::at_origin(counters, self.solver.point_count());
        self.solver.store(&mut state);
        state
    }

    /// Copies step, time, positions and velocities into a snapshot.
    pub fn fill(&self, snapshot: &mut Snapshot) {
        match self.state.get() {
            Some(state) => snapshot.fill(state),
            None => {
                (snapshot.step, snapshot.time) = self.now();
                self.solver.fill(snapshot);
            }
        }
    }

    /// How often positions or velocities may have changed.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// The step it is at, and its time, s.
    pub fn now(&self) -> (u64, f64) {
        if let Some(state) = self.state.get() {
            return (state.step, state.time);
        }
        let behind = self.behind.lock().unwrap_or_else(PoisonError::into_inner);
        let now = behind.as_ref().map(|state| (state.step, state.time));
        drop(behind);
        // Neither here nor there: another thread is just copying it out.
        now.unwrap_or_else(|| (self.state().step, self.state().time))
    }

    /// The step it is at.
    pub fn step(&self) -> u64 {
        self.now().0
    }

    /// Position (m) and velocity (m/s) of one point, with what rounding dropped, without copying all others.
    pub fn motion64(&self, point: usize) -> [DVec3; 2] {
        match self.state.get() {
            Some(state) => [state.position64(point), state.velocity64(point)],
            None => self.solver.motion64(point),
        }
    }

    /// Takes up to so many steps, and stops after one that leaves a position that is not finite. Returns whether all are.
    pub fn advance(&mut self, params: &Params, steps: u64, workers: &dyn Workers) -> bool {
        let (taken, finite) = self.ahead().advance(params, steps, workers);
        let state = self.counters();
        (0..taken).for_each(|_| state.tick(params.dt));
        finite
    }

    /// Stops every point where it is, in the middle of a step of `dt` (s).
    pub fn stop(&mut self, dt: f64) {
        self.ahead().stop(dt);
    }

    /// The solver, at this state, to change it there.
    fn ahead(&mut self) -> &mut SymplecticEuler {
        self.load();
        if let Some(state) = self.state.take() {
            *self.behind.get_mut().unwrap_or_else(PoisonError::into_inner) = Some(state);
        }
        self.changes += 1;
        &mut self.solver
    }

    /// The solver, at this state.
    pub fn solver(&mut self) -> &mut SymplecticEuler {
        self.load();
        &mut self.solver
    }

    /// The solver, for changes of what it has packed: it may have another state.
    pub fn unpacked(&mut self) -> &mut SymplecticEuler {
        &mut self.solver
    }

    fn load(&mut self) {
        // Whatever the solver has not is here.
        if let (false, Some(state)) = (self.is_loaded, self.state.get()) {
            self.solver.load(state);
            self.is_loaded = true;
        }
    }
}
