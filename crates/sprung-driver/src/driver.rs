//! The driver itself.

use std::sync::Arc;

use sprung::{Change, Params, Result, Simulation, Snapshot, stability};

use crate::command::{Command, Pace, Source};
use crate::report::{Opened, Report, Stability, Timeline, Trouble};

/// Owns the simulation, does what is asked and plays in real time.
pub struct Driver {
    simulation: Simulation,
    opened: Arc<Opened>,
    before: Arc<Snapshot>,
    playing: bool,
    pace: Pace,
    /// Simulated time that is due, s.
    due: f64,
    trouble: Option<Trouble>,
}

impl Driver {
    /// Opens a first scene, paused.
    ///
    /// # Errors
    /// If the scene cannot be built.
    pub fn new(source: Source) -> Result<Self> {
        let (simulation, opened) = open(source, 1)?;
        let before = opened.first.clone();
        Ok(Self { simulation, opened, before, playing: false, pace: Pace::RealTime, due: 0.0, trouble: None })
    }

    /// Does what is asked.
    pub fn obey(&mut self, command: Command) {
        if let Err(error) = self.try_to(command) {
            self.stop_for(error);
        }
    }

    /// Real time has passed, s: steps as far as simulated time is due and `may_go_on` says so.
    pub fn advance(&mut self, seconds: f64, may_go_on: &mut dyn FnMut() -> bool) {
        if !self.playing {
            return;
        }
        let dt = self.simulation.params().dt;
        self.due += seconds * self.factor();
        while self.due >= dt && may_go_on() {
            self.due -= dt;
            if let Err(error) = self.step() {
                self.stop_for(error);
                return;
            }
        }
        self.due = self.due.min(dt);
    }

    /// How things are now.
    pub fn report(&mut self) -> Arc<Report> {
        let simulation = &mut self.simulation;
        let (model, params, state) = (simulation.model(), simulation.params(), simulation.state());
        let stability = Stability {
            certified: stability::certified(model, params, &state.position),
            sharp: None,
            every_configuration: stability::every_configuration(model, params).map(|limit| limit.dt),
        };
        Arc::new(Report {
            opened: self.opened.clone(),
            params: Arc::new(params.clone()),
            stability,
            before: self.before.clone(),
            blend: (self.due / params.dt).clamp(0.0, 1.0),
            forces: None,
            energy: simulation.energy(),
            ledger_is_whole: false,
            playing: self.playing,
            pace: self.pace,
            speed: 0.0,
            seconds_per_step: 0.0,
            auto_substeps: false,
            timeline: Timeline::default(),
            undo: None,
            redo: None,
            pull: None,
            comparison: None,
            watched: Arc::default(),
            samples: Arc::default(),
            trouble: self.trouble.clone(),
            busy: None,
            now: Arc::new(simulation.snapshot().clone()),
        })
    }

    fn try_to(&mut self, command: Command) -> Result<()> {
        match command {
            Command::Open(source) => {
                (self.simulation, self.opened) = open(*source, self.opened.serial + 1)?;
                self.before = self.opened.first.clone();
            }
            Command::Play(on) => self.playing = on,
            Command::Step => self.step()?,
            Command::Frame => (0..self.simulation.params().substeps).try_for_each(|_| self.step())?,
            Command::Reset => self.simulation.reset(),
            Command::Edit(edit) => {
                edit.changes.into_iter().try_for_each(|change: Change| self.simulation.change(change))?
            }
            Command::Seek(step) => self.simulation.rewind_to(step)?,
            Command::Pace(pace) => self.pace = pace,
            Command::Dismiss => self.trouble = None,
            _ => {}
        }
        Ok(())
    }

    fn step(&mut self) -> Result<()> {
        self.before = Arc::new(self.simulation.snapshot().clone());
        self.simulation.step(self.simulation.params().dt)
    }

    fn stop_for(&mut self, error: sprung::Error) {
        self.playing = false;
        self.trouble = Some(match error.blow_up() {
            Some(blow_up) => Trouble::BlewUp(Box::new(blow_up.clone())),
            None => Trouble::Refused(error),
        });
    }

    fn factor(&self) -> f64 {
        let Params { dt, substeps, .. } = self.simulation.params();
        match self.pace {
            Pace::RealTime => 1.0,
            Pace::Frames => 60.0 * dt * f64::from(*substeps),
            Pace::Slow(times) => 1.0 / times,
        }
    }
}

fn open(source: Source, serial: u64) -> Result<(Simulation, Arc<Opened>)> {
    let mut simulation = source.scene.simulation()?;
    let opened = Opened {
        serial,
        name: source.name,
        scene: source.scene,
        model: simulation.model().clone(),
        params: Arc::new(simulation.params().clone()),
        first: Arc::new(simulation.snapshot().clone()),
    };
    Ok((simulation, Arc::new(opened)))
}
