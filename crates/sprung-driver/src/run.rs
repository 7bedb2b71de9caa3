//! The recorded run: the simulation with its timeline, its samples and the run that it parted from.
//!
//! *Past and future.* After going back, steps up to the newest are the recorded ones, replayed bit for bit with all that was
//! done then; beyond the newest, steps are new. Doing anything new in the past makes a branch there: what lay beyond is
//! dropped from the run, and kept as a [`Ghost`] to compare with.

use std::sync::Arc;

use sprung::{
    Change, Checkpoint, Energy, Params, PointReading, Result, SettleOptions, Settling, Simulation,
    SpringReading,
};

use crate::command::Probe;
use crate::ghost::Ghost;
use crate::limits::SMALL;
use crate::report::Sample;
use crate::samples::Samples;
use crate::settings::{are_identical, settings_are_same, with_hands_of, without_hands};
use crate::timeline::Recorded;

/// A simulation and what is known of its past.
pub(crate) struct Run {
    pub simulation: Simulation,
    pub recorded: Recorded,
    pub samples: Samples,
    pub watched: Arc<Vec<Probe>>,
    pub ghost: Option<Ghost>,
    /// Whether there is memory for a ghost.
    pub keeps_ghost: bool,
    pub ledger: bool,
    pub ledger_is_whole: bool,
    /// Whether nothing was lost uncounted before the first recorded step.
    was_whole: bool,
    /// The parameters of the newest step.
    in_force: Arc<Params>,
    /// The sample of this very step was taken under other circumstances.
    sample_is_stale: bool,
}

impl Run {
    pub fn new(mut simulation: Simulation, keeps_ghost: bool) -> Self {
        let springs = simulation.model().spring_count();
        let ledger = springs <= SMALL;
        let was_whole = simulation.keeps_ledger() || simulation.now().0 == 0;
        simulation.keep_ledger(ledger);
        let mut run = Self {
            recorded: Recorded::new(simulation.state(), simulation.params().dt),
            samples: Samples::new(simulation.now().0, springs),
            watched: Arc::default(),
            ghost: None,
            keeps_ghost,
            ledger,
            ledger_is_whole: ledger && was_whole,
            was_whole,
            in_force: Arc::new(simulation.params().clone()),
            sample_is_stale: false,
            simulation,
        };
        run.sample();
        run
    }

    pub fn step_now(&self) -> u64 {
        self.simulation.now().0
    }

    pub fn params(&self) -> &Params {
        self.simulation.params()
    }

    /// The parameters, shared; the same as long as nothing has changed.
    pub fn shared_params(&mut self) -> &Arc<Params> {
        if !are_identical(&self.in_force, self.simulation.params()) {
            self.in_force = Arc::new(self.simulation.params().clone());
        }
        &self.in_force
    }

    /// Whether there are recorded steps beyond this one.
    pub fn is_in_past(&self) -> bool {
        self.step_now() < self.recorded.newest.0
    }

    /// One step: the recorded one, or beyond the newest a new one.
    ///
    /// # Errors
    /// If the run blows up. The last good state is then the current one, under the parameters that it blew up with.
    pub fn step(&mut self) -> Result<()> {
        if self.is_in_past() {
            return self.simulation.rewind_to(self.step_now() + 1);
        }
        let dt = self.params().dt;
        let params = self.shared_params().clone();
        match self.simulation.step(dt) {
            Ok(()) => {
                self.recorded.arrived(self.simulation.now(), dt);
                self.sample();
                Ok(())
            }
            Err(error) => {
                let state = self.simulation.state();
                self.recorded.branch_at(state);
                self.samples.drop_from(state.step + 1);
                // The good state may lie before the change that was too much: what the user set stays set.
                self.let_go();
                self.set(&params)?;
                Err(error)
            }
        }
    }

    /// Changes a parameter from now on, in the past as a branch.
    ///
    /// # Errors
    /// If the change is not allowed: then nothing has happened.
    pub fn change(&mut self, change: Change) -> Result<()> {
        // Tried on a copy first: what is refused makes no branch.
        self.params().clone().apply(self.simulation.model(), &change)?;
        self.part();
        self.simulation.change(change)?;
        self.sample_is_stale = true;
        Ok(())
    }

    /// Sets all parameters but those of hands; gives whether anything has changed.
    ///
    /// # Errors
    /// As [`change`](Self::change).
    pub fn set(&mut self, params: &Params) -> Result<bool> {
        if settings_are_same(params, self.params()) {
            return Ok(false);
        }
        params.validate(self.simulation.model())?;
        // First, since a branch has no hands of the past.
        self.part();
        let params = with_hands_of(params, self.params());
        self.change(Change::Params(Arc::new(params)))?;
        Ok(true)
    }

    /// As [`set`](Self::set), by a change that makes these parameters of those now.
    ///
    /// # Errors
    /// As [`change`](Self::change).
    pub fn set_by(&mut self, change: Change, params: &Params) -> Result<bool> {
        let is_new = !settings_are_same(params, self.params());
        if is_new {
            self.change(change)?;
        }
        Ok(is_new)
    }

    /// Notes what was done now.
    pub fn mark(&mut self, label: &str) {
        self.recorded.mark(self.simulation.state(), label);
    }

    /// Something new is about to be done: in the past that is a branch. Hands that held a point then do not any more.
    pub fn part(&mut self) {
        if !self.is_in_past() {
            return;
        }
        self.keep_ghost();
        let state = self.simulation.state();
        self.recorded.branch_at(state);
        self.samples.drop_from(state.step + 1);
        self.let_go();
    }

    /// Every hand lets go.
    pub fn let_go(&mut self) {
        let_go(&mut self.simulation);
    }

    /// This moment, to be taken up again elsewhere: with no hand at it.
    pub fn checkpoint(&mut self) -> Checkpoint {
        let params = self.params();
        let mut checkpoint = if params.grabs.is_empty() && params.carried.is_empty() {
            self.simulation.checkpoint()
        } else {
            // On a clone, as here the hand holds on.
            let mut without = self.simulation.clone();
            let_go(&mut without);
            without.checkpoint()
        };
        // Books that were opened late are not to be taken for whole ones.
        checkpoint.keeps_ledger &= self.ledger_is_whole;
        checkpoint
    }

    /// Begins to bring the scene to rest, with no hand at it: on a clone, as even letting go is something done.
    pub fn settling(&self, options: SettleOptions) -> Settling {
        let mut simulation = self.simulation.clone();
        let_go(&mut simulation);
        simulation.settling(options)
    }

    /// The scene has come to rest; in the past as a branch.
    pub fn settled(&mut self, mut simulation: Simulation) {
        self.part();
        // It may have been switched meanwhile.
        if simulation.keeps_ledger() != self.ledger {
            simulation.keep_ledger(self.ledger);
        }
        self.simulation = simulation;
        self.sample_is_stale = true;
    }

    /// Back to the first state, under the parameters of now.
    ///
    /// # Errors
    /// None that valid parameters cause.
    pub fn reset(&mut self) -> Result<()> {
        if self.recorded.newest.0 > self.recorded.first.0 {
            self.keep_ghost();
        }
        let params = without_hands(self.params());
        self.simulation.reset();
        // A checkpoint may have been taken while a hand held a point.
        self.let_go();
        if let Some(ghost) = &mut self.ghost {
            ghost.parted = self.simulation.now();
        }
        self.recorded = Recorded::new(self.simulation.state(), self.params().dt);
        self.samples = Samples::new(self.step_now(), self.simulation.model().spring_count());
        self.ledger_is_whole = self.ledger && self.was_whole;
        self.set(&params)?;
        self.sample();
        Ok(())
    }

    /// Sums every step's works, or not.
    pub fn keep_ledger(&mut self, on: bool) {
        if on != self.ledger {
            self.ledger = on;
            self.simulation.keep_ledger(on);
            let is_at_first = self.recorded.newest.0 == self.recorded.first.0;
            self.ledger_is_whole = on && is_at_first && self.was_whole;
        }
    }

    /// The quantities that samples hold from now on.
    pub fn watch(&mut self, probes: Vec<Probe>) {
        self.watched = Arc::new(probes);
        self.sample_is_stale = true;
    }

    /// Takes the sample of this step anew, if it was taken before something was changed.
    pub fn refresh_sample(&mut self) {
        if std::mem::take(&mut self.sample_is_stale) && !self.is_in_past() {
            self.samples.drop_from(self.step_now());
            self.sample();
        }
    }

    /// The state has changed without a step.
    pub fn state_changed(&mut self) {
        self.sample_is_stale = true;
    }

    fn sample(&mut self) {
        let (step, time) = self.simulation.now();
        if self.samples.wants(step) {
            let energy = self.energy();
            let values = self.watched.iter().filter_map(|&probe| Some((probe, self.value(probe)?)));
            self.samples.push(Sample { step, time, energy, values: values.collect() });
        }
    }

    pub fn energy(&mut self) -> Energy {
        self.simulation.energy()
    }

    /// A quantity now; `None` if there is no such point or spring.
    fn value(&self, probe: Probe) -> Option<f64> {
        let (state, params) = (self.simulation.state(), self.params());
        let position = |point: usize| state.position.get(point).map(|position| position.as_dvec3());
        let velocity = |point: usize| state.velocity.get(point).map(|velocity| velocity.as_dvec3());
        let spring = |spring: usize| SpringReading::of(self.simulation.model(), params, state, spring);
        match probe {
            Probe::Position(point, axis) => position(point)?.to_array().get(axis).copied(),
            Probe::Velocity(point, axis) => velocity(point)?.to_array().get(axis).copied(),
            Probe::Speed(point) => Some(velocity(point)?.length()),
            Probe::Length(index) => Some(spring(index)?.length),
            Probe::Strain(index) => spring(index)?.strain,
            Probe::Tension(index) => Some(spring(index)?.spring_force),
            Probe::Energy(index) => Some(spring(index)?.energy),
            Probe::Force(point, axis) => {
                let reading = PointReading::of(self.simulation.model(), params, state, point)?;
                reading.total_force.to_array().get(axis).copied()
            }
        }
    }

    fn keep_ghost(&mut self) {
        if self.keeps_ghost {
            let here = self.simulation.now();
            self.ghost = Some(Ghost::new(self.simulation.clone(), self.recorded.clone(), here));
        }
    }
}

/// Every hand lets go.
pub(crate) fn let_go(simulation: &mut Simulation) {
    let params = simulation.params();
    let grabbed = params.grabs.iter().map(|grab| Change::Release(grab.point));
    let carried = params.carried.keys().map(|&point| Change::Carry(point, None));
    for change in grabbed.chain(carried).collect::<Vec<_>>() {
        // Points that are held exist, so that this cannot fail.
        if simulation.change(change).is_err() {
            debug_assert!(false, "a hand could not let go");
        }
    }
}

/// Goes towards a recorded step, one step at a time where it is replayed, as long as `may_go_on`. Gives whether it is there.
///
/// # Errors
/// If the step is not recorded.
pub(crate) fn go_towards(
    simulation: &mut Simulation,
    target: u64,
    may_go_on: &mut dyn FnMut() -> bool,
) -> Result<bool> {
    while simulation.now().0 != target {
        if !may_go_on() {
            return Ok(false);
        }
        let here = simulation.now().0;
        let checkpoint = simulation.checkpoint_before(target);
        let next = if (checkpoint..target).contains(&here) { here + 1 } else { checkpoint };
        simulation.rewind_to(next)?;
    }
    Ok(true)
}
