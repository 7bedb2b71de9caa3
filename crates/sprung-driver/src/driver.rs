//! The driver: what it holds, and the order of its work.

use std::collections::VecDeque;
use std::sync::Arc;

use sprung::{Checkpoint, Energy, Error, Result, Simulation, Vec3};

use crate::command::{Beginning, Command, Fix, Source};
use crate::fixes;
use crate::hand::Hand;
use crate::job::Job;
use crate::kept::Running;
use crate::limits::{Limits, NOW_AND_THEN, SMALL};
use crate::options::Options;
use crate::pictures::Pictures;
use crate::playing::Playing;
use crate::report::{Opened, Report, Timeline, Trouble};
use crate::run::{Run, let_go};
use crate::substeps::Auto;
use crate::undo::Undo;
use crate::wire::Fingerprint;

/// Owns the simulation, does what is asked and plays in real time.
///
/// It reads no clock: it is told how much time has passed, and asks before each step whether it may go on. Work that takes
/// longer than a moment (seeking, many steps, settling) is begun by [`obey`](Self::obey) and done by
/// [`advance`](Self::advance).
pub struct Driver {
    pub(crate) options: Options,
    pub(crate) opened: Arc<Opened>,
    pub(crate) run: Run,
    pub(crate) playing: Playing,
    pub(crate) undo: Undo,
    pub(crate) auto: Option<Auto>,
    pub(crate) hand: Option<Hand>,
    pub(crate) job: Option<Job>,
    /// What was asked while a job was under way.
    pub(crate) waiting: VecDeque<Command>,
    pub(crate) trouble: Option<Trouble>,
    pub(crate) fixes: Vec<Fix>,
    pub(crate) pictures: Pictures,
    pub(crate) limits: Limits,
    /// The scene's diagonal at first, m.
    pub(crate) size: f64,
    params: Arc<sprung::Params>,
    energy: Energy,
    energy_at: f64,
    compares: bool,
    wants_forces: bool,
    /// The moment that was to be kept.
    checkpoint: Option<Arc<Checkpoint>>,
    /// Real time that has passed, but for rests, s.
    pub(crate) clock: f64,
    steps_taken: u64,
    /// The last report, until something has happened.
    last: Option<Arc<Report>>,
}

impl Driver {
    /// Opens a first scene, or goes on with a simulation, paused.
    ///
    /// # Errors
    /// If the scene cannot be built.
    pub fn new(beginning: impl Into<Beginning>) -> Result<Self> {
        Self::with(beginning, Options::default())
    }

    /// As [`new`](Self::new), with so much memory and these threads.
    ///
    /// # Errors
    /// As [`new`](Self::new), and [`sprung::Code::TooLarge`] for a scene that needs more memory than there is.
    pub fn with(beginning: impl Into<Beginning>, options: Options) -> Result<Self> {
        let (simulation, opened) = build(beginning.into(), 1, &options)?;
        let mut run = Run::new(simulation, has_room_for_two(&opened, &options));
        Ok(Self {
            playing: Playing::default(),
            undo: Undo::new(&opened.model),
            auto: None,
            hand: None,
            job: None,
            waiting: VecDeque::new(),
            trouble: None,
            fixes: Vec::new(),
            pictures: Pictures::new(&opened.first, &run.simulation),
            limits: Limits::default(),
            size: diagonal(&opened.first.positions),
            params: opened.params.clone(),
            energy: run.energy(),
            energy_at: 0.0,
            compares: false,
            wants_forces: false,
            checkpoint: None,
            clock: 0.0,
            steps_taken: 0,
            last: None,
            run,
            opened,
            options,
        })
    }

    /// Does what is asked, or begins it, or keeps it until what is under way is done.
    pub fn obey(&mut self, command: Command) {
        self.last = None;
        if self.breaks_off(&command) {
            self.job = None;
            self.keep_waiting(command);
            self.obey_waiting();
        } else if self.must_wait(&command) {
            self.keep_waiting(command);
        } else if let Err(error) = self.try_to(command) {
            self.stop_for(error);
        }
    }

    /// Real time has passed, s: steps as far as simulated time is due and `may_go_on` says so. Where there is a job to do,
    /// such as seeking, that comes first.
    pub fn advance(&mut self, seconds: f64, may_go_on: &mut dyn FnMut() -> bool) {
        if seconds > 0.0 && seconds.is_finite() {
            self.clock += seconds;
        }
        if self.job.is_some() {
            self.last = None;
            self.work(may_go_on);
        } else if self.playing.on {
            self.last = None;
            self.playing.pass(seconds, self.run.params());
            if let Err(error) = self.play(may_go_on) {
                self.stop_for(error);
            }
        }
        self.follow(may_go_on);
    }

    /// The last advance took so many seconds of real time: for [`Report::seconds_per_step`].
    pub fn measured(&mut self, seconds: f64) {
        self.playing.measured(std::mem::take(&mut self.steps_taken), seconds);
    }

    /// Whether nothing will happen until the next command.
    pub fn is_idle(&self) -> bool {
        !self.playing.on && self.job.is_none() && (!self.compares || self.ghost_is_here())
    }

    /// The scene that plays, by its serial number.
    pub(crate) fn plays(&self) -> Option<u64> {
        self.playing.on.then_some(self.opened.serial)
    }

    /// Whether, while nothing else is to do, the true limit of a large model could be found.
    pub fn wants_sharp(&self) -> bool {
        let is_known = self.limits.found().sharp_step == Some(self.run.step_now());
        self.is_idle() && self.opened.model.spring_count() > SMALL && !is_known
    }

    /// Real seconds until the next step is due; zero if there is something to do now.
    pub fn seconds_to_step(&self) -> f64 {
        if self.job.is_some() || !self.playing.on {
            0.0
        } else {
            self.playing.seconds_to_step(self.run.params())
        }
    }

    /// A fingerprint of the state now: [`Simulation::state_hash`].
    pub fn state_hash(&self) -> u64 {
        self.run.simulation.state_hash()
    }

    /// What tells whether another driver is at the same point of the same scene.
    pub(crate) fn fingerprint(&self) -> Fingerprint {
        Fingerprint { model: self.opened.model.fingerprint(), state: self.state_hash() }
    }

    /// How things are now.
    pub fn report(&mut self) -> Arc<Report> {
        if let Some(last) = &self.last {
            return last.clone();
        }
        self.refresh();
        let params = &self.params;
        let recorded = &self.run.recorded;
        let forces = self.wants_forces.then(|| Arc::new(self.run.simulation.forces().to_vec()));
        let ghost = self.run.ghost.as_mut().filter(|_| self.compares);
        let report = Arc::new(Report {
            opened: self.opened.clone(),
            params: params.clone(),
            before: self.pictures.before.clone(),
            now: self.pictures.now.clone(),
            blend: if self.pictures.moves { self.playing.blend(params.dt) } else { 1.0 },
            forces,
            energy: self.energy,
            ledger_is_whole: self.run.ledger_is_whole,
            playing: self.playing.on,
            pace: self.playing.pace,
            speed: self.playing.speed(params),
            seconds_per_step: self.playing.seconds_per_step(),
            auto_substeps: self.auto.is_some(),
            stability: self.limits.found(),
            timeline: Timeline {
                first: recorded.first,
                newest: recorded.newest,
                marks: recorded.marks.clone(),
                clock: recorded.clock.clone(),
                bytes: (self.run.simulation.history_bytes(), self.options.history_bytes),
            },
            undo: self.undo.last_done().map(|(label, _)| label.to_owned()),
            redo: self.undo.last_undone().map(|(label, _)| label.to_owned()),
            pull: self.hand.map(|hand| (hand.point, hand.target)),
            comparison: ghost.map(|ghost| ghost.compare(&self.pictures.now)),
            watched: self.run.watched.clone(),
            samples: self.run.samples.clone(),
            trouble: self.trouble.clone(),
            fixes: self.fixes.clone(),
            checkpoint: self.checkpoint.clone(),
            busy: self.job.as_ref().map(|job| job.describe(self.run.step_now())),
        });
        self.last = Some(report.clone());
        report
    }

    fn try_to(&mut self, command: Command) -> Result<()> {
        match command {
            Command::Open(source) => self.open(Beginning::Scene(*source))?,
            Command::GoOn(kept) => self.open(kept.bring(&self.options)?.into())?,
            Command::Checkpoint(on) => self.checkpoint = on.then(|| Arc::new(self.run.checkpoint())),
            Command::Play(on) => {
                self.playing.switch(on);
                self.pictures.rest();
                if on {
                    self.clear_trouble();
                }
            }
            Command::Step => self.take_steps(1),
            Command::Frame => self.take_steps(self.run.params().substeps.into()),
            Command::Reset => self.reset()?,
            Command::OwnValues => self.own_values()?,
            Command::Edit(edit) => self.edit(&edit)?,
            Command::Undo => self.take_back()?,
            Command::Redo => self.make_again()?,
            Command::Seek(step) => self.seek(step)?,
            Command::Pace(pace) => {
                self.playing.pace = pace;
                self.playing.forget();
            }
            Command::AutoSubsteps(on) => self.switch_auto(on)?,
            Command::Pull(pull) => self.pull(pull)?,
            Command::Release => self.release()?,
            Command::Settle => {
                self.playing.switch(false);
                let settling = self.run.settling(self.options.settle);
                self.job = Some(Job::Settle(Box::new(settling)));
            }
            Command::FindSharpLimit => {
                self.refresh();
                self.limits.find_sharp(&self.run.simulation, self.clock);
            }
            Command::KeepLedger(on) => self.run.keep_ledger(on),
            Command::WantForces(on) => self.wants_forces = on,
            Command::Watch(probes) => self.run.watch(probes),
            Command::Compare(on) => self.compares = on,
            Command::Fix(fix) => self.fix(fix)?,
            Command::RewindAndGoOn(seconds) => self.rewind_and_go_on(seconds)?,
            Command::Dismiss => self.clear_trouble(),
        }
        Ok(())
    }

    fn open(&mut self, beginning: Beginning) -> Result<()> {
        let (simulation, opened) = build(beginning, self.opened.serial + 1, &self.options)?;
        self.run = Run::new(simulation, has_room_for_two(&opened, &self.options));
        self.size = diagonal(&opened.first.positions);
        self.undo = Undo::new(&opened.model);
        self.limits = Limits::default();
        self.pictures = Pictures::new(&opened.first, &self.run.simulation);
        self.energy = self.run.energy();
        self.opened = opened;
        (self.auto, self.hand, self.job, self.checkpoint) = (None, None, None, None);
        self.waiting.clear();
        self.clear_trouble();
        self.playing.forget();
        Ok(())
    }

    /// Takes the steps that are due, as far as it may.
    fn play(&mut self, may_go_on: &mut dyn FnMut() -> bool) -> Result<()> {
        self.carry(self.playing.steps_due(self.run.params().dt))?;
        loop {
            let dt = self.run.params().dt;
            let due = self.playing.steps_due(dt);
            if due == 0 || !may_go_on() {
                break;
            }
            self.step(due == 1)?;
            self.playing.stepped(dt);
        }
        self.playing.drop_arrears(self.run.params().dt);
        Ok(())
    }

    /// One step. The last of several is the one that is drawn.
    pub(crate) fn step(&mut self, is_last: bool) -> Result<()> {
        if is_last {
            self.pictures.begin(&self.run.simulation);
        }
        self.run.step()?;
        self.steps_taken += 1;
        Ok(())
    }

    /// The run that is compared with comes along.
    fn follow(&mut self, may_go_on: &mut dyn FnMut() -> bool) {
        let time = self.run.simulation.now().1;
        if let Some(ghost) = self.run.ghost.as_mut().filter(|ghost| self.compares && !ghost.is_at(time)) {
            self.last = None;
            ghost.follow(time, may_go_on);
        }
    }

    fn ghost_is_here(&self) -> bool {
        let time = self.run.simulation.now().1;
        self.run.ghost.as_ref().is_none_or(|ghost| ghost.is_at(time))
    }

    /// Everything that a report shows is brought up to date, as far as it is due.
    fn refresh(&mut self) {
        self.run.refresh_sample();
        self.params = self.run.shared_params().clone();
        self.pictures.refresh(&self.run.simulation);
        let is_large = self.opened.model.spring_count() > SMALL;
        let is_busy = self.playing.on || self.job.is_some();
        if !(is_large && is_busy && self.clock - self.energy_at < NOW_AND_THEN) {
            self.energy = self.run.energy();
            self.energy_at = self.clock;
        }
        self.limits.refresh(&mut self.run.simulation, &self.params, self.playing.on, self.clock);
    }

    /// Shows the state as it is, with no step that leads to it.
    pub(crate) fn jumped(&mut self) {
        self.pictures.show(&self.run.simulation, false);
        self.limits.forget();
        self.playing.forget();
    }

    pub(crate) fn clear_trouble(&mut self) {
        self.trouble = None;
        self.fixes.clear();
    }

    /// Something cannot be done.
    pub(crate) fn refuse(&mut self, error: Error) {
        self.last = None;
        self.stop_for(error);
    }

    /// Something went wrong. What could not be done has not been done; a run that blew up is paused at its last good state,
    /// under the parameters that it blew up with.
    pub(crate) fn stop_for(&mut self, error: Error) {
        self.fixes.clear();
        let Some(blow_up) = error.blow_up() else {
            self.trouble = Some(Trouble::Refused(error));
            return;
        };
        self.playing.switch(false);
        self.job = None;
        self.waiting.clear();
        if self.hand.take().is_some() {
            self.run.let_go();
        }
        let positions = &self.run.simulation.state().position;
        self.fixes = fixes::find(blow_up, &self.opened.model, self.run.params(), positions);
        self.trouble = Some(Trouble::BlewUp(Box::new(blow_up.clone())));
        // Settling that blows up in the past leaves that as it is.
        if !self.run.is_in_past() {
            self.run.mark("blew up");
        }
        self.jumped();
    }
}

fn build(beginning: Beginning, serial: u64, options: &Options) -> Result<(Simulation, Arc<Opened>)> {
    let Running { name, scene, params, mut simulation } = match beginning {
        Beginning::Scene(Source { name, scene }) => {
            let needed = options.check_memory(scene.estimated_bytes(), &name);
            needed.map_err(|error| error.with_fix("use fewer points or springs"))?;
            let simulation = scene.simulation()?;
            Running { params: Arc::new(simulation.params().clone()), name, scene, simulation }
        }
        Beginning::Running(running) => {
            let mut running = *running;
            // Whoever held a point is not here.
            let_go(&mut running.simulation);
            running
        }
    };
    simulation.set_workers(options.workers.clone());
    simulation.keep_history(options.history_bytes);
    let (model, first) = (simulation.model().clone(), Arc::new(simulation.snapshot().clone()));
    Ok((simulation, Arc::new(Opened { serial, name, scene, model, params, first })))
}

/// Whether an earlier run can be kept beside this one.
fn has_room_for_two(opened: &Opened, options: &Options) -> bool {
    options.memory_limit.is_none_or(|limit| opened.scene.estimated_bytes().saturating_mul(2) <= limit)
}

/// The diagonal of the box around all points, m; 1 for a single point.
fn diagonal(positions: &[Vec3]) -> f64 {
    let low = positions.iter().copied().fold(Vec3::splat(f32::INFINITY), Vec3::min);
    let high = positions.iter().copied().fold(Vec3::splat(f32::NEG_INFINITY), Vec3::max);
    let diagonal = f64::from((high - low).length());
    if diagonal.is_finite() && diagonal > 0.0 { diagonal } else { 1.0 }
}
