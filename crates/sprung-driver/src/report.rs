//! What a front end gets to know.

use std::sync::Arc;

use sprung::scene::Scene;
use sprung::stability::Limit;
use sprung::{BlowUp, Checkpoint, Code, Energy, Error, Model, Params, Snapshot, Vec3};

use crate::command::{Fix, Pace, Probe};
use crate::samples::Samples;

/// A scene that was opened.
#[derive(Clone, Debug)]
pub struct Opened {
    /// Counts the scenes opened, so that a front end notices a new one.
    pub serial: u64,
    /// What to call it.
    pub name: String,
    /// The scene as it was read.
    pub scene: Scene,
    /// What is joined to what.
    pub model: Arc<Model>,
    /// The scene's own parameters.
    pub params: Arc<Params>,
    /// The first state: that of the scene, or of the checkpoint that is gone on from.
    pub first: Arc<Snapshot>,
}

/// How the simulation is, at one moment. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Report {
    /// The scene.
    pub opened: Arc<Opened>,
    /// The parameters now.
    pub params: Arc<Params>,
    /// The step before the newest.
    pub before: Arc<Snapshot>,
    /// The newest step.
    pub now: Arc<Snapshot>,
    /// Where between the two the moment to draw lies, from 0 to 1.
    pub blend: f64,
    /// The force on every point, N, if wanted.
    pub forces: Option<Arc<Vec<Vec3>>>,
    /// The energy of the newest step; of a large model that moves, of a step up to a third of a second ago.
    pub energy: Energy,
    /// Whether the ledger has been on since the first step, so that its sums balance.
    pub ledger_is_whole: bool,
    /// Whether it plays.
    pub playing: bool,
    /// How fast it is to play.
    pub pace: Pace,
    /// Simulated seconds for each second, measured, while it plays.
    pub speed: f64,
    /// Real seconds for one step, measured.
    pub seconds_per_step: f64,
    /// Whether sub-steps are kept small enough.
    pub auto_substeps: bool,
    /// How large dt may be.
    pub stability: Stability,
    /// What can be gone back to.
    pub timeline: Timeline,
    /// The last edit, which can be undone.
    pub undo: Option<String>,
    /// The edit that can be made once more.
    pub redo: Option<String>,
    /// The point that is pulled at, and where the hand is.
    pub pull: Option<(usize, Vec3)>,
    /// The run that a branch left, at the same time, while it is compared with.
    pub comparison: Option<Comparison>,
    /// The quantities that each sample holds.
    pub watched: Arc<Vec<Probe>>,
    /// Samples of the recorded run, in order of time: also of what lies beyond `now` after going back.
    pub samples: Samples,
    /// What went wrong, until it is dismissed.
    pub trouble: Option<Trouble>,
    /// What would mend a blow-up: only fixes that are stable at its last good state.
    pub fixes: Vec<Fix>,
    /// The moment that was to be kept, by [`Command::Checkpoint`](crate::Command::Checkpoint).
    pub checkpoint: Option<Arc<Checkpoint>>,
    /// What it is busy with, where that takes longer than a moment, such as "replaying".
    pub busy: Option<String>,
}

impl Report {
    /// As this one, but paused for good: whoever drives the simulation has gone, for this reason.
    pub(crate) fn ended(&self, reason: &str) -> Self {
        let error = Error::new(Code::Unsupported, format!("the simulation has stopped for good: {reason}"))
            .with_fix(
                "save what you need and start the program anew; this is an error in it, please report it",
            );
        let trouble = Some(Trouble::Refused(error));
        Self { playing: false, speed: 0.0, busy: None, trouble, ..self.clone() }
    }
}

/// How large dt may be, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stability {
    /// The certified limit of this configuration and what sets it.
    pub certified: Option<Limit>,
    /// The true limit of the configuration at `sharp_step`; computed now and then.
    pub sharp: Option<f64>,
    /// The step of which `sharp` holds; `None` if it has not been computed under these parameters.
    pub sharp_step: Option<u64>,
    /// The limit in every configuration.
    pub every_configuration: Option<f64>,
}

/// The recorded run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// The first step that can be gone to, and its time, s.
    pub first: (u64, f64),
    /// The newest.
    pub newest: (u64, f64),
    /// Steps at which something was changed, and what.
    pub marks: Arc<Vec<(u64, String)>>,
    /// Step lengths: from this step, at this time (s), steps of this dt (s).
    pub clock: Arc<Vec<(u64, f64, f64)>>,
    /// Memory of the recording, bytes, and how much it may be.
    pub bytes: (usize, usize),
}

impl Timeline {
    /// The time of a recorded step, s.
    pub fn time_of(&self, step: u64) -> f64 {
        crate::timeline::time_of(&self.clock, self.first, step)
    }
}

/// An earlier run beside this one.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Its state at this time, or its last.
    pub snapshot: Arc<Snapshot>,
    /// The step at which the two parted.
    pub parted: u64,
    /// The largest distance between the same point in both, m.
    pub apart: f64,
}

/// A moment of a run, for plots.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Step.
    pub step: u64,
    /// Time, s.
    pub time: f64,
    /// Energy, and where it went.
    pub energy: Energy,
    /// A value for each quantity that was watched then, with it.
    pub values: Vec<(Probe, f64)>,
}

/// What went wrong.
#[derive(Clone, Debug)]
pub enum Trouble {
    /// The simulation blew up; the last good state is shown.
    BlewUp(Box<BlowUp>),
    /// Something could not be done, and was not.
    Refused(Error),
}
