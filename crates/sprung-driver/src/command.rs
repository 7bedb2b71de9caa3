//! What a front end asks for.

use std::fmt;

use sprung::scene::Scene;
use sprung::{Change, Vec3};

/// A scene to open.
#[derive(Clone, Debug)]
pub struct Source {
    /// What to call it: a built-in scene's name, or a file's without its ending.
    pub name: String,
    /// The scene as it was read.
    pub scene: Scene,
}

/// Something a front end asks of the driver.
#[derive(Clone, Debug)]
pub enum Command {
    /// Opens a scene; the one before is gone.
    Open(Box<Source>),
    /// Plays (true) or pauses (false).
    Play(bool),
    /// Pauses and takes one step.
    Step,
    /// Pauses and takes one frame: `substeps` steps.
    Frame,
    /// Back to the first state, with the parameters as they are now.
    Reset,
    /// Changes parameters from now on; can be undone.
    Edit(Edit),
    /// Takes the last edit back, from now on.
    Undo,
    /// Makes the edit that was taken back last once more.
    Redo,
    /// Goes to a recorded step, and pauses there.
    Seek(u64),
    /// How fast to play.
    Pace(Pace),
    /// Keeps the sub-steps small enough to be stable, at the same time for a frame.
    AutoSubsteps(bool),
    /// Pulls at a point, or moves the hand that does.
    Pull(Pull),
    /// Lets go of what is pulled.
    Release,
    /// Brings the scene to rest.
    Settle,
    /// Whether every step's works are summed for the energy ledger.
    KeepLedger(bool),
    /// Whether reports carry the force on every point.
    WantForces(bool),
    /// The quantities to record with every sample, in place of those before.
    Watch(Vec<Probe>),
    /// Whether the run that a branch left is shown with it.
    Compare(bool),
    /// Goes back by so many seconds of simulated time after a blow-up, and plays on.
    RewindAndGoOn(f64),
    /// The trouble has been read.
    Dismiss,
}

/// Some changes that are one to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// What it does, for the undo button: `"gravity"`, `"cut a spring"`.
    pub label: String,
    /// The changes, in order: all of them are made, or none.
    pub changes: Vec<Change>,
    /// Whether it goes on with the last edit of the same label, as a slider does while it is dragged.
    pub continues: bool,
}

impl Edit {
    /// A single edit.
    pub fn new(label: impl Into<String>, changes: Vec<Change>) -> Self {
        Self { label: label.into(), changes, continues: false }
    }
}

/// A hand at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull {
    /// The point.
    pub point: usize,
    /// Where the hand is, m.
    pub target: Vec3,
    /// Carries the point along whatever resists, instead of pulling it by a spring.
    pub hard: bool,
}

/// How fast simulated time goes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Pace {
    /// One second a second.
    #[default]
    RealTime,
    /// One frame of `substeps` steps for each sixtieth of a second, as the report's programs do.
    Frames,
    /// So many times slower than real time.
    Slow(f64),
}

impl Pace {
    /// The choices, from fast to slow.
    pub const ALL: [Self; 9] = [
        Self::Frames,
        Self::RealTime,
        Self::Slow(2.0),
        Self::Slow(4.0),
        Self::Slow(10.0),
        Self::Slow(20.0),
        Self::Slow(50.0),
        Self::Slow(100.0),
        Self::Slow(1000.0),
    ];
}

impl fmt::Display for Pace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RealTime => write!(f, "real time"),
            Self::Frames => write!(f, "the report's pace"),
            Self::Slow(times) => write!(f, "1/{times} speed"),
        }
    }
}

/// A quantity of a point or a spring, recorded against time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Probe {
    /// A coordinate of a point (0: x, 1: y, 2: z), m.
    Position(usize, usize),
    /// A component of a point's velocity, m/s.
    Velocity(usize, usize),
    /// A point's speed, m/s.
    Speed(usize),
    /// A spring's length, m.
    Length(usize),
    /// A spring's strain, (ℓ − L)/L.
    Strain(usize),
    /// A spring's k_s(ℓ − L), N.
    Tension(usize),
}
