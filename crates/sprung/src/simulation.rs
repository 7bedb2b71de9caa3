//! The simulation: model, parameters, state and solver bundled.

mod beginning;
mod changing;
mod checkpoint;
mod settling;

use std::ops::{ControlFlow, RangeInclusive};
use std::sync::Arc;

use glam::Vec3;

use crate::current::Current;
use crate::energy::{Drives, Energy, Ledger};
use crate::error::{Code, Error, Result};
use crate::history::{Event, History, Past};
use crate::model::Model;
use crate::params::{Change, Params};
use crate::stability::{self, Limit};
use crate::state::{Snapshot, State};
use crate::watch::{self, Watch};
use crate::workers::Workers;

pub use beginning::MOST_STEPS;
use changing::Placed;
pub use checkpoint::Checkpoint;
pub use settling::Settling;

/// Copying so many points takes as long as asking the solver for the motion of one.
const POINTS_TO_A_DRIVE: usize = 16;

/// Model, parameters, state and solver bundled: step, frame, settle, change a parameter, rewind, reset, snapshot.
///
/// ```
/// use sprung::{Change, scene::Scene};
///
/// let mut simulation = Scene::builtin("jelly")?.simulation()?;
/// for _ in 0..3 {
///     simulation.frame()?; // `substeps` steps of `dt`
/// }
/// simulation.change(Change::Gravity(sprung::Vec3::ZERO))?;
/// simulation.frame()?;
/// println!("{}", simulation.snapshot().positions[0]);
/// # Ok::<(), sprung::Error>(())
/// ```
///
/// *The recorded run.* A simulation remembers its first state, all that was done to it, and some states on the way. Going
/// back with [`rewind_to`](Self::rewind_to) forgets nothing: what lies beyond can be gone to again. It is the first new
/// thing done at an earlier step, a [`step`](Self::step), a [`change`](Self::change) or a [`settle`](Self::settle), that
/// begins another branch there: what was recorded beyond that step is dropped, and what had been done *at* that step stays,
/// as it has already had its effect. Whoever wants to keep the earlier run, as a ghost to compare with, takes a clone
/// before. A clone is independent from then on and shares all checkpoints, the long arrays of the parameters and what the
/// solver has packed; its own are the current and the last good state.
#[derive(Clone)]
pub struct Simulation {
    model: Arc<Model>,
    params: Arc<Params>,
    current: Current,
    /// The parameters that the solver has packed, where they are not the current ones.
    packed: Option<Arc<Params>>,
    workers: Arc<dyn Workers>,
    watch: Watch,
    /// Where [`reset`](Self::reset) goes.
    start: Arc<Past>,
    history: History,
    history_budget: usize,
    drives: Drives,
    ledger: Option<Ledger>,
    snapshot: Snapshot,
    forces: Vec<Vec3>,
    /// The limit of every configuration, and the parameters that it was found for.
    every_configuration: Option<(Arc<Params>, Option<Limit>)>,
    /// If placing a point or setting parameters was the last thing done: how it was before.
    placed: Option<Placed>,
}

impl Simulation {
    /// One step of length `dt` (s). A `dt` other than [`Params::dt`] is a [`Change::Dt`] first.
    ///
    /// # Errors
    /// [`Code::BlewUp`] if the run blows up: the last good state is then the current one. [`Code::OutOfRange`] for `dt`.
    pub fn step(&mut self, dt: f64) -> Result<()> {
        if dt != self.params.dt {
            self.change(Change::Dt(dt))?;
        }
        self.steps(1)
    }

    /// So many steps of [`Params::dt`]: the same as one after another, and faster, as positions and velocities are put into
    /// the user's order only when somebody asks for them.
    ///
    /// # Errors
    /// [`Code::BlewUp`] if the run blows up: the last good state is then the current one. [`Code::OutOfRange`] for more steps
    /// than can be counted.
    pub fn steps(&mut self, count: u64) -> Result<()> {
        let Some(target) = self.current.step().checked_add(count) else {
            let sentence = format!("{count} more steps are more than can be counted");
            return Err(Error::new(Code::OutOfRange, sentence).at_field("count"));
        };
        if count == 0 {
            return Ok(());
        }
        self.history.branch_at(self.current.step());
        while self.current.step() < target {
            self.advance(target - self.current.step())?;
            if self.history.is_due(self.current.step()) {
                self.history.arrived(self.current.copied(), &self.params);
            } else {
                self.history.reached(self.current.step());
            }
        }
        Ok(())
    }

    /// One frame: [`Params::substeps`] steps of [`Params::dt`].
    ///
    /// # Errors
    /// As [`steps`](Self::steps).
    pub fn frame(&mut self) -> Result<()> {
        self.steps(u64::from(self.params.substeps))
    }

    /// Goes to any step between the first and the newest, bit for bit, by replay from a checkpoint or from where it is.
    ///
    /// What lies beyond is kept, and can be gone to, until something new is done.
    ///
    /// A long replay can be taken in small portions, so that a front end stays responsive: first to
    /// [`checkpoint_before`](Self::checkpoint_before) the step, which costs no replay, then forward some steps at a time. Each
    /// portion goes on from where the last one ended, and may be abandoned for another step.
    ///
    /// ```
    /// # use sprung::scene::Scene;
    /// # let mut simulation = Scene::builtin("chain")?.simulation()?;
    /// # for _ in 0..200 { simulation.step(0.01)?; }
    /// let target = 150;
    /// simulation.rewind_to(simulation.checkpoint_before(target))?;
    /// while simulation.state().step < target {
    ///     simulation.rewind_to(target.min(simulation.state().step + 16))?;
    /// }
    /// # Ok::<(), sprung::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Code::OutOfRange`] for a step that has not been recorded.
    pub fn rewind_to(&mut self, step: u64) -> Result<()> {
        let recorded = self.recorded_steps();
        if !recorded.contains(&step) {
            let (first, newest) = recorded.into_inner();
            let sentence = format!("step {step} is not recorded; steps {first} to {newest} are");
            return Err(Error::new(Code::OutOfRange, sentence));
        }
        let checkpoint = self.history.before(step);
        if !(checkpoint.state.step..=step).contains(&self.current.step()) {
            let Past { state, params } = Past::clone(checkpoint);
            self.restore(state, params, 0);
            self.redo_events(0)?;
        }
        while self.current.step() < step {
            let next = self.history.next_event(self.current.step()).map_or(step, |next| next.min(step));
            self.advance(next - self.current.step())?;
            self.redo_events(0)?;
        }
        Ok(())
    }

    /// The steps that [`rewind_to`](Self::rewind_to) can go to: from the first to the newest that was reached.
    pub fn recorded_steps(&self) -> RangeInclusive<u64> {
        self.history.first().state.step..=self.history.newest()
    }

    /// The step of the checkpoint from which [`rewind_to`](Self::rewind_to) would replay to `step`, unless it is nearer
    /// already. For a step that is not recorded, the checkpoint next to it.
    pub fn checkpoint_before(&self, step: u64) -> u64 {
        self.history.before(step).state.step
    }

    /// Memory that the recorded run takes, bytes: the first state, checkpoints and log, but for what they share.
    pub fn history_bytes(&self) -> usize {
        self.history.bytes()
    }

    /// Back to the state and the parameters this simulation was made with, bit for bit. The log starts anew.
    pub fn reset(&mut self) {
        self.history = History::new(self.start.clone(), self.history_budget);
        let Past { state, params } = (*self.start).clone();
        self.restore(state, params, 0);
    }

    /// Positions and velocities now, in the user's order, in a buffer that is used again.
    pub fn snapshot(&mut self) -> &Snapshot {
        self.current.fill(&mut self.snapshot);
        &self.snapshot
    }

    /// As [`snapshot`](Self::snapshot), in a buffer of the caller's.
    pub fn fill(&self, snapshot: &mut Snapshot) {
        self.current.fill(snapshot);
    }

    /// A number that grows whenever positions or velocities may have changed: whoever keeps a copy of them sees by it whether
    /// that still holds.
    pub fn changes(&self) -> u64 {
        self.current.changes()
    }

    /// The total force on each point now, N, in the user's order, as the next step would use it; in a buffer that is used
    /// again. See [`PointReading`](crate::PointReading) for
    /// the parts of a force.
    pub fn forces(&mut self) -> &[Vec3] {
        self.refresh_solver();
        self.current.solver().forces(&self.params, &mut self.forces);
        &self.forces
    }

    /// Where the energy is now, J, and where it went as far as the ledger was on. It costs about as much as a step, goes
    /// through the same threads, and has the same bits for any number of them.
    ///
    /// All in float64: kinetic, gravitational and contact energy are off by no more than rounding, and elastic energy E by
    /// 2·10⁻¹⁴·√E·(√E + √(Σ ½k_s L²)). [`Energy::of`] the state says the same but for that, several times as slowly.
    pub fn energy(&mut self) -> Energy {
        self.refresh_solver();
        self.current.energy(&self.params, &*self.workers)
    }

    /// How large dt may be in this configuration, and what sets that; `None` if nothing does. Found in the layout of the step and
    /// on its threads at the cost of about three, where [`stability::certified`] takes a hundred.
    ///
    /// It is never above [`stability::certified`], and less than two parts in 10⁵ below it in networks whose points have up to
    /// fifty springs. What sets it may be another spring than there, where two are as near as that. It is never below
    /// [`limit_of_every_configuration`](Self::limit_of_every_configuration).
    pub fn certified_limit(&mut self) -> Option<Limit> {
        self.refresh_solver();
        let every = self.limit_of_every_configuration();
        match self.current.solver().certified(&self.params, &*self.workers) {
            Some(limit) => every.filter(|every| every.dt > limit.dt).or(Some(limit)),
            None => stability::certified(&self.model, &self.params, &self.current.state().position),
        }
    }

    /// How large dt may be in every configuration that the network can ever take: [`stability::every_configuration`], found
    /// again only where parameters have changed that it depends on.
    pub fn limit_of_every_configuration(&mut self) -> Option<Limit> {
        let params = &self.params;
        match &self.every_configuration {
            Some((found_for, limit)) if params.shares_limits_with(found_for) => *limit,
            _ => {
                let limit = stability::every_configuration(&self.model, params);
                self.every_configuration = Some((params.clone(), limit));
                limit
            }
        }
    }

    /// Switches the energy ledger on or off. While on, each step also sums every force's work in float64, at several
    /// times the cost of the step. Motion is the same either way.
    pub fn keep_ledger(&mut self, on: bool) {
        self.ledger = on.then(|| Ledger::new(&self.model));
    }

    /// Sets the memory for checkpoints and log, bytes, and starts both anew from the current state, the earliest that can
    /// then be rewound to. Zero keeps no checkpoint but that. Checkpoints lie close together in the recent past and ever
    /// further apart before it; every step can be gone to, but one that is long past takes longer. The log is kept whole:
    /// checkpoints make room for it, down to a quarter of this memory.
    pub fn keep_history(&mut self, bytes: usize) {
        self.history_budget = bytes;
        let untouched =
            *self.current.state() == self.start.state && Arc::ptr_eq(&self.params, &self.start.params);
        let here = || Arc::new(Past { state: self.current.state().clone(), params: self.params.clone() });
        let first = if untouched { self.start.clone() } else { here() };
        self.history = History::new(first, bytes);
        self.placed = None;
        self.watch.restart(&mut self.current, &self.params, 0);
    }

    /// Begins the log anew from here if it has grown long: for whoever never goes back, and may change things for hours. To be
    /// called after steps, when nothing has been done at this step yet.
    pub fn forget_long_log(&mut self) {
        // If no energy came from nowhere, this is a good state: it may be the first of a new log.
        if self.history.log_is_long() && !self.is_suspect() {
            self.keep_history(self.history_budget);
        }
    }

    /// Lends the engine worker threads. However many there are, the bits are the same.
    pub fn set_workers(&mut self, workers: Arc<dyn Workers>) {
        self.workers = workers;
    }

    /// Whether energy has come from nowhere at this very step: it may be about to blow up, and whoever records should
    /// hold this state back until a later one is found good. Costs as much as [`energy`](Self::energy).
    pub fn is_suspect(&mut self) -> bool {
        watch::excess(&self.energy()).is_some()
    }

    /// A fingerprint of positions, velocities and step: see [`State::hash`].
    pub fn state_hash(&self) -> u64 {
        self.current.state().hash()
    }

    /// What is joined to what.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The parameters as they are now.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// The step it is at, and the simulated time, s: the same as in [`state`](Self::state), which copies all points first if
    /// steps were taken since it was last asked for.
    pub fn now(&self) -> (u64, f64) {
        self.current.now()
    }

    /// The state as it is now.
    pub fn state(&self) -> &State {
        self.current.state()
    }

    /// What was done to this run and at which step, oldest first.
    pub fn log(&self) -> &[(u64, Event)] {
        self.history.log()
    }

    /// Up to so many steps, watched; on a blow-up the last good state is restored and what came after it is forgotten.
    fn advance(&mut self, most: u64) -> Result<()> {
        self.refresh_solver();
        self.placed = None;
        let count = if self.is_driven() || self.ledger.is_some() {
            1
        } else {
            let step = self.current.step();
            let suspect = self.current.counters().ledger.suspect_steps > 0;
            most.min(watch::steps_to_look(step, suspect)).min(self.history.steps_to_checkpoint(step))
        };
        let finite = self.advance_unwatched(count);
        match self.watch.look(&self.model, &self.params, &mut self.current, finite, &*self.workers) {
            None => Ok(()),
            Some(blow_up) => {
                let (params, events) = (self.watch.good_params().clone(), self.watch.good_events());
                self.restore(self.current.kept(), params, events);
                self.history.branch_at(self.current.step());
                self.redo_events(events)?;
                Err(Error::from_blow_up(blow_up))
            }
        }
    }

    /// Whether something acts whose work is booked at every step.
    fn is_driven(&self) -> bool {
        let Params { external_forces, grabs, carried, .. } = &*self.params;
        !(external_forces.is_empty() && grabs.is_empty() && carried.is_empty())
    }

    /// So many steps, with the ledger and the work of what drives it, which are kept one step at a time.
    fn advance_unwatched(&mut self, count: u64) -> bool {
        let is_driven = self.is_driven();
        if let Some(ledger) = &mut self.ledger {
            ledger.begin(&self.model, &self.params, self.current.state());
        }
        if is_driven {
            self.copy_for_many_drives();
            self.drives.begin(&self.model, &self.params, |point| self.current.motion64(point));
        }
        let finite = self.current.advance(&self.params, count, &*self.workers);
        let mut stored_by_hand = 0.0;
        if is_driven {
            self.copy_for_many_drives();
            let (work_in, stored) =
                self.drives.end(&self.model, &self.params, |point| self.current.motion64(point));
            self.current.counters().ledger.work_in += work_in;
            stored_by_hand = stored;
        }
        if let Some(ledger) = &mut self.ledger {
            let sums = ledger.end(&self.model, &self.params, self.current.state(), stored_by_hand);
            self.current.counters().ledger = sums;
        }
        finite
    }

    /// Where many points are driven, as by wind, their motions are asked for one by one: quickly once all have been copied.
    fn copy_for_many_drives(&self) {
        let drives = self.params.external_forces.len() + self.params.grabs.len() + self.params.carried.len();
        if drives > self.model.point_count() / POINTS_TO_A_DRIVE {
            self.current.state();
        }
    }

    /// Packs anew what has changed: once before the next step, however many changes there were.
    fn refresh_solver(&mut self) {
        if let Some(packed) = self.packed.take() {
            self.current.unpacked().refresh(&packed, &self.params);
        }
    }

    /// Goes to a good state, that after so many of the events logged for its step.
    fn restore(&mut self, state: State, params: Arc<Params>, events: usize) {
        if !Arc::ptr_eq(&params, &self.params) {
            self.set_params(params);
        }
        *self.current.state_mut() = state;
        self.placed = None;
        self.watch.restart(&mut self.current, &self.params, events);
    }

    /// Does again what the log says was done at the current step, but for the first so many events.
    fn redo_events(&mut self, done: usize) -> Result<()> {
        for (index, event) in self.history.events_at(self.current.step()).into_iter().enumerate().skip(done) {
            match event {
                Event::Change(change) => self.change_unlogged(&change)?,
                Event::Settle(options) => {
                    self.settle_unlogged(options, &mut |_| ControlFlow::Continue(()), index)?;
                }
            }
        }
        Ok(())
    }
}

impl std::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (points, springs) = (self.model.point_count(), self.model.spring_count());
        write!(f, "Simulation({points} points, {springs} springs, step {})", self.current.step())
    }
}
