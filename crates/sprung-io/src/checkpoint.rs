//! Checkpoints: a running simulation in a file, and how far its outputs had got.
//!
//! The file begins with eight bytes by which it is known, the version of the format, the number of sections and a checksum
//! of these. Each section has a name, a length, a CRC-32 of its content and one of this header. CRC-32 finds every change
//! within 32 bits in a row, and so every flipped byte, whatever the length; a cut is found by the lengths. Positions and
//! velocities are held against the 64-bit hash of the state besides. All numbers are little-endian.
//!
//! What a version holds, section by section, is in `sections.rs`, and never changes: a later version gets another number,
//! and earlier ones are still read. See also `docs/checkpoints.md`.

mod container;
mod keeper;
mod sections;

use std::io::{Read, Write};
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sprung::build::Mesh;
use sprung::scene::Scene;
use sprung::{Checkpoint, Code, Error, MOST_STEPS, Model, Params, Result, Simulation};

use crate::export::{Mark, Options};

pub use container::MAGIC;
pub(crate) use keeper::taken;
pub use keeper::{Keeper, Stored};

/// The ending of the names of checkpoints, without the dot.
pub const ENDING: &str = "sprung";

/// The number of the last frame of a run, at most.
pub const MOST_FRAMES: u64 = 100_000_000;

/// The version of the format, of which there is one so far.
pub const VERSION: u32 = 1;

/// Whether a file of this name is a checkpoint.
pub fn is_name(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING))
}

/// Refuses names that are not those of checkpoints.
///
/// # Errors
/// [`Code::Unsupported`], naming the file.
pub fn check_name(path: &Path) -> Result<()> {
    if is_name(path) {
        return Ok(());
    }
    let error = Error::new(Code::Unsupported, "is no name for a checkpoint, which ends with .sprung");
    Err(error.in_file(path.display().to_string()))
}

/// What a checkpoint file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    /// The version of the program that wrote it, such as `0.1.0`.
    pub program: String,
    /// The scene's name, such as `jelly`.
    pub scene_name: String,
    /// The scene, as TOML.
    pub scene: String,
    /// The meshes that its bodies are made from, with the names that the scene has for them: their files are not needed.
    pub meshes: Vec<(String, Arc<Mesh>)>,
    /// [`Model::fingerprint`] of the model that the scene was built into.
    pub fingerprint: u64,
    /// The simulation.
    pub checkpoint: Checkpoint,
    /// The recording that it is a moment of, if it is one.
    pub recording: Option<Recording>,
}

/// How far a recording had got: what it takes to complete it.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What was to be done.
    pub plan: Plan,
    /// How far each output had got, in the order of [`Plan::outputs`]; then the energy plot, if there is one.
    pub marks: Vec<Mark>,
}

/// What a recording was to do, and why it ended if it has. Kept as JSON: a field that is not there has its default.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Plan {
    /// The scene's title.
    pub title: String,
    /// Names of the outputs, as they were typed.
    pub outputs: Vec<String>,
    /// Name of the energy plot.
    pub plot: Option<String>,
    /// The folder that names without one are to be looked for in.
    pub folder: String,
    /// What was said about outputs.
    pub options: Options,
    /// Steps from one frame to the next.
    pub steps_per_frame: u64,
    /// The number of the last frame.
    pub last_frame: u64,
    /// Whole frames recorded so far, those before the first that is written too: the number of the next.
    pub recorded: u64,
    /// The first frame that is written.
    pub from: u64,
    /// How often a checkpoint was to be taken, as it was typed.
    pub every: String,
    /// When the recording began, s since 1970.
    pub begun: u64,
    /// Once no frame is to follow: why, in a phrase. What is left to do then is to complete the files.
    pub ended: Option<String>,
}

impl Recording {
    /// Whether its numbers fit each other.
    fn is_sound(&self) -> bool {
        let Plan { outputs, plot, steps_per_frame, last_frame, recorded, from, .. } = &self.plan;
        let steps = steps_per_frame.checked_mul(*last_frame);
        self.marks.len() == outputs.len() + usize::from(plot.is_some())
            && *steps_per_frame > 0
            && steps.is_some_and(|steps| steps <= MOST_STEPS)
            && *last_frame <= MOST_FRAMES
            && (1..=last_frame + 1).contains(recorded)
            && from <= last_frame
    }
}

/// A simulation that was taken up again.
#[derive(Clone)]
pub struct Resumed {
    /// The scene that it is of.
    pub scene: Scene,
    /// The scene's own parameters.
    pub params: Params,
    /// The simulation.
    pub simulation: Simulation,
}

/// Asked before memory is taken: how many bytes, for what. Refuses if there are not so many.
pub type AskMemory<'a> = dyn Fn(u64, &str) -> Result<()> + 'a;

/// Asks for memory. A checkpoint is as large as it is: what helps is not what helps a scene.
fn ask(ask: &AskMemory<'_>, bytes: u64, what: &str) -> Result<()> {
    let fix = "free some, or go on with it on a machine that has more";
    ask(bytes, what).map_err(|error| error.with_fix(fix))
}

impl Saved {
    /// A simulation as it is now.
    pub fn new(scene_name: &str, scene: &Scene, simulation: &mut Simulation) -> Self {
        let checkpoint = simulation.checkpoint();
        Self::of(scene_name, scene, simulation.model(), checkpoint)
    }

    /// A checkpoint that was taken of a simulation of this model, which the scene was built into.
    pub fn of(scene_name: &str, scene: &Scene, model: &Model, checkpoint: Checkpoint) -> Self {
        Self {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            scene_name: scene_name.to_owned(),
            scene: scene.to_toml(),
            meshes: scene.meshes(),
            fingerprint: model.fingerprint(),
            checkpoint,
            recording: None,
        }
    }

    /// Writes the file's bytes.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_to(&self, out: &mut impl Write) -> std::io::Result<()> {
        sections::write(self, out)
    }

    /// Reads a file of so many bytes. That its values fit each other is found out by [`simulation`](Self::simulation).
    ///
    /// # Errors
    /// [`Code::Unreadable`] if it is no checkpoint, cut off, or damaged in some section, which is named;
    /// [`Code::Unsupported`] for a version that this program does not know; [`Code::TooLarge`] if there is no memory.
    pub fn read_from(file: &mut impl Read, bytes: u64) -> Result<Self> {
        sections::read(file, bytes)
    }

    /// The scene, with its meshes.
    ///
    /// # Errors
    /// As [`Scene::parse`] and [`Scene::take_meshes`].
    pub fn scene(&self) -> Result<Scene> {
        let mut scene = Scene::parse(&self.scene, "the scene in the checkpoint")?;
        scene.take_meshes(&self.meshes)?;
        Ok(scene)
    }

    /// Goes on with the simulation, on a model that its scene was built into.
    ///
    /// # Errors
    /// [`Code::Conflict`] if the scene was built into another model, or the parts do not fit it, and as
    /// [`Simulation::resume_from`].
    pub fn simulation(&self, model: impl Into<Arc<Model>>) -> Result<Simulation> {
        let model = model.into();
        if model.fingerprint() != self.fingerprint {
            let sentence = "the scene in it is not the one that its points and springs are of";
            return Err(Error::new(Code::Conflict, sentence));
        }
        Simulation::resume_from(model, self.checkpoint.clone())
    }

    /// Builds the scene and goes on with the simulation.
    ///
    /// # Errors
    /// Those of `memory`, of [`scene`](Self::scene) and of [`simulation`](Self::simulation), in one sentence about the file.
    pub fn resume(&self, memory: &AskMemory<'_>) -> Result<Resumed> {
        let resumed = || -> Result<Resumed> {
            let scene = self.scene()?;
            ask(memory, scene.estimated_bytes(), "the scene in it")?;
            let (model, params, _) = scene.build()?;
            Ok(Resumed { simulation: self.simulation(model)?, scene, params })
        };
        resumed().map_err(|error| {
            let place = error.place();
            let inner = place.field.as_ref().map(|field| format!("{field}: ")).unwrap_or_default();
            let sentence = format!("cannot be gone on with: {inner}{}", error.sentence());
            let outer = Error::new(error.code(), sentence);
            error.fix().map(str::to_owned).into_iter().fold(outer, Error::with_fix)
        })
    }
}
