//! What a front end asks for.

use std::fmt;

use sprung::scene::Scene;
use sprung::{Change, Vec3};

use crate::kept::{Kept, Running};

/// A scene to open.
#[derive(Clone, Debug)]
pub struct Source {
    /// What to call it: a built-in scene's name, or a file's without its ending.
    pub name: String,
    /// The scene as it was read.
    pub scene: Scene,
}

/// What a driver begins with.
#[derive(Clone)]
pub enum Beginning {
    /// A scene at its start.
    Scene(Source),
    /// A simulation that is under way.
    Running(Box<Running>),
}

impl From<Source> for Beginning {
    fn from(source: Source) -> Self {
        Self::Scene(source)
    }
}

impl From<Running> for Beginning {
    fn from(running: Running) -> Self {
        Self::Running(Box::new(running))
    }
}

/// Something a front end asks of the driver.
#[derive(Clone, Debug)]
pub enum Command {
    /// Opens a scene; the one before is gone.
    Open(Box<Source>),
    /// Goes on with a simulation that was kept; the scene before is gone. What holds a point in it lets go.
    GoOn(Kept),
    /// Takes a checkpoint of this moment, which reports carry from then on (true), or lets it go (false).
    Checkpoint(bool),
    /// Plays (true) or pauses (false).
    Play(bool),
    /// Pauses and takes one step.
    Step,
    /// Pauses and takes one frame: `substeps` steps.
    Frame,
    /// Back to the first state, with the parameters as they are now.
    Reset,
    /// The scene's own parameters once more, from now on; an edit that can be undone.
    OwnValues,
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
    /// Brings the scene to rest. Any command that asks for something else breaks it off, and all is as before.
    Settle,
    /// Finds the true limit of dt now, however large the model.
    FindSharpLimit,
    /// Whether every step's works are summed for the energy ledger.
    KeepLedger(bool),
    /// Whether reports carry the force on every point.
    WantForces(bool),
    /// The quantities to record with every sample, in place of those before.
    Watch(Vec<Probe>),
    /// Whether the run that a branch left is shown with it.
    Compare(bool),
    /// Mends what made the run blow up; an edit that can be undone.
    Fix(Fix),
    /// Goes back by so many seconds of simulated time after a blow-up, as far as they are recorded, and plays on from there
    /// with the parameters as they are now. With a [`Fix`] sent first or right after, it goes on mended.
    RewindAndGoOn(f64),
    /// The trouble has been read.
    Dismiss,
}

/// Some changes that are one to the user. Hands are no edits: see [`Command::Pull`].
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

impl Command {
    /// Whether nothing is left of an earlier command when this one follows: places to seek to, places of one hand, values
    /// of one slider.
    pub(crate) fn replaces(&self, earlier: &Self) -> bool {
        match (self, earlier) {
            (Self::Seek(_), Self::Seek(_)) => true,
            (Self::Pull(new), Self::Pull(old)) => (new.point, new.hard) == (old.point, old.hard),
            (Self::Edit(new), Self::Edit(old)) => new.replaces(old),
            _ => false,
        }
    }
}

impl Edit {
    /// Whether this goes on with an edit, and sets all that that one set.
    fn replaces(&self, earlier: &Self) -> bool {
        self.continues
            && self.label == earlier.label
            && self.changes.len() == earlier.changes.len()
            && self.changes.iter().zip(&earlier.changes).all(|(new, old)| sets_the_same(new, old))
    }
}

fn sets_the_same(new: &Change, old: &Change) -> bool {
    use Change::{Damping, Dt, Force, Gravity, Mass, Planes, RestScale, Stiffness, Substeps};
    match (new, old) {
        (Dt(_), Dt(_)) | (Substeps(_), Substeps(_)) | (Gravity(_), Gravity(_)) | (Planes(_), Planes(_)) => {
            true
        }
        (Mass(new, _), Mass(old, _))
        | (Stiffness(new, _), Stiffness(old, _))
        | (Damping(new, _), Damping(old, _))
        | (RestScale(new, _), RestScale(old, _)) => new == old,
        (Force(new, _), Force(old, _)) => new == old,
        _ => false,
    }
}

/// A way to mend a run that blew up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fix {
    /// Steps of this length, s.
    Dt(f64),
    /// More steps for the same time of a frame, as many as are stable in every configuration.
    Substeps,
    /// Every spring's damping times this: large damping, too, asks for short steps.
    Damping(f64),
}

impl fmt::Display for Fix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dt(dt) => write!(f, "dt = {} s", sprung::significant(*dt)),
            Self::Substeps => write!(f, "more sub-steps"),
            Self::Damping(factor) => write!(f, "damping times {}", sprung::significant(*factor)),
        }
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
    /// A spring's ½k_s(ℓ − L)², J.
    Energy(usize),
    /// A component of all forces together on a point, N.
    Force(usize, usize),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_becomes_pointless_is_replaced() {
        let slider = |continues, range, value| {
            let changes = vec![Change::Stiffness(range, value)];
            Command::Edit(Edit { continues, ..Edit::new("stiffness", changes) })
        };
        assert!(slider(true, 0..9, 2.0).replaces(&slider(false, 0..9, 1.0)));
        assert!(!slider(false, 0..9, 2.0).replaces(&slider(false, 0..9, 1.0)), "two edits");
        assert!(!slider(true, 1..9, 2.0).replaces(&slider(true, 0..9, 1.0)), "other springs");
        assert!(!slider(true, 0..9, 2.0).replaces(&Command::Step));
        let pull = |point, hard| Command::Pull(Pull { point, target: Vec3::ZERO, hard });
        assert!(pull(1, true).replaces(&pull(1, true)));
        assert!(!pull(1, true).replaces(&pull(1, false)) && !pull(1, true).replaces(&pull(2, true)));
        assert!(Command::Seek(1).replaces(&Command::Seek(2)) && !Command::Step.replaces(&Command::Step));
    }
}
