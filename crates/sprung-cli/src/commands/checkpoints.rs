//! The checkpoints of a run: when one is due, and what it holds.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use sprung::build::Mesh;
use sprung::scene::Scene;
use sprung::{Code, Error, Result, Simulation};
use sprung_io::checkpoint::{self, Keeper, Plan as Recorded, Recording, Saved};
use sprung_io::{Options, RunInfo};

use super::record::Recorder;
use super::run::Plan;
use crate::args::{Every, RunArgs};
use crate::console::{complain, grouped, note};
use crate::memory;

/// How often a checkpoint is taken when nothing is said: what a kill may cost at most.
const EVERY: Every = Every::Time(Duration::from_secs(60));

/// Takes checkpoints of a run.
pub struct Checkpoints {
    keeper: Keeper,
    every: Every,
    scene_name: String,
    scene: String,
    meshes: Vec<(String, Arc<Mesh>)>,
    fingerprint: u64,
    plan: Recorded,
    /// When the last one was taken, and how many frames had been recorded then; none before the first.
    last: Option<(Instant, u64)>,
    /// Why one could not be written, the first time.
    failure: Option<Error>,
}

impl Checkpoints {
    /// Those of a run that begins, if it is to have any.
    ///
    /// # Errors
    /// [`Code::Conflict`] if there is a checkpoint of that name by which another run can still be completed, and as
    /// [`Keeper::begin`].
    pub fn begin(
        args: &RunArgs,
        name: &str,
        scene: &Scene,
        info: &RunInfo,
        plan: &Plan,
        options: &Options,
    ) -> Result<Option<Self>> {
        let Some(path) = &args.checkpoint else { return Ok(None) };
        checkpoint::check_name(path)?;
        let keeper = Keeper::begin(path)?;
        refuse_if_unfinished(path, &keeper)?;
        let outputs = args.output.iter().map(|path| text_of(path)).collect::<Result<_>>()?;
        let folder = std::env::current_dir().unwrap_or_default();
        let plan = Recorded {
            title: info.title.clone(),
            outputs,
            plot: args.plot.as_deref().map(text_of).transpose()?,
            folder: folder.to_string_lossy().into_owned(),
            options: options.clone(),
            steps_per_frame: plan.steps_per_frame,
            last_frame: plan.frames,
            recorded: 0,
            from: plan.from,
            every: every_text(args.every.unwrap_or(EVERY)),
            begun: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
            ended: None,
        };
        Ok(Some(Self {
            keeper,
            every: args.every.unwrap_or(EVERY),
            scene_name: name.to_owned(),
            scene: scene.to_toml(),
            meshes: scene.meshes(),
            fingerprint: 0,
            plan,
            last: None,
            failure: None,
        }))
    }

    /// Those of a run that goes on.
    pub fn resume(keeper: Keeper, saved: &Saved, plan: Recorded, every: Every) -> Self {
        let last = Some((Instant::now(), plan.recorded));
        Self {
            keeper,
            every,
            scene_name: saved.scene_name.clone(),
            scene: saved.scene.clone(),
            meshes: saved.meshes.clone(),
            fingerprint: saved.fingerprint,
            plan,
            last,
            failure: None,
        }
    }

    /// Learns which model the scene was built into.
    pub fn fingerprint(&mut self, simulation: &Simulation) {
        self.fingerprint = simulation.model().fingerprint();
    }

    /// A frame was recorded: takes a checkpoint if one is due. The first one is due at once.
    ///
    /// One that cannot be written is complained of once; the run goes on, and the earlier one is there still.
    pub fn recorded(&mut self, frame: u64, simulation: &mut Simulation, recorder: &mut Recorder) {
        self.plan.recorded = frame + 1;
        let is_due = match (self.last, self.every) {
            (None, _) => true,
            (Some((_, before)), Every::Frames(frames)) => self.plan.recorded - before >= frames,
            (Some((when, _)), Every::Time(time)) => when.elapsed() >= time,
        };
        // A frame that may belong to a blow-up is in no output yet.
        if is_due && recorder.is_calm() {
            self.take(simulation, recorder);
        }
    }

    /// No frame follows. What is left to do is to complete the outputs, and after a kill that can be done from here.
    pub fn close(&mut self, outcome: &Result<()>, simulation: &mut Simulation, recorder: &mut Recorder) {
        self.plan.ended = Some(match outcome {
            Ok(()) => String::new(),
            Err(error) => error.sentence().to_owned(),
        });
        self.take(simulation, recorder);
    }

    fn take(&mut self, simulation: &mut Simulation, recorder: &mut Recorder) {
        self.last = Some((Instant::now(), self.plan.recorded));
        let taken = recorder.marks().and_then(|marks| {
            let recording = Recording { plan: self.plan.clone(), marks };
            self.keeper.write(&Saved {
                program: env!("CARGO_PKG_VERSION").to_owned(),
                scene_name: self.scene_name.clone(),
                scene: self.scene.clone(),
                meshes: self.meshes.clone(),
                fingerprint: self.fingerprint,
                checkpoint: simulation.checkpoint(),
                recording: Some(recording),
            })
        });
        if let Err(error) = taken
            && self.failure.is_none()
        {
            complain(&error);
            note("The run goes on; the checkpoint before this one is kept.");
            self.failure = Some(error);
        }
    }

    /// Why a checkpoint could not be written, if one could not: the run has not kept its promise then.
    pub fn failure(self) -> Option<Error> {
        let error = self.failure?;
        let sentence = "could not be written at some time, so a kill would have cost more than was asked for";
        let again = Error::new(error.code(), sentence);
        Some(again.in_file(self.keeper.path().display().to_string()))
    }
}

/// Writing over the checkpoint of a run that was killed would lose all of it.
fn refuse_if_unfinished(path: &Path, keeper: &Keeper) -> Result<()> {
    let Some(stored) = keeper.stored()? else { return Ok(()) };
    let name = path.display();
    // Something else of this name is not ours to write over either.
    let saved = stored.read(&memory::check).map_err(|error| {
        let error = Error::new(error.code(), format!("is there already, and {}", error.sentence()));
        error.in_file(name.to_string()).with_fix("give another name, or remove it")
    })?;
    match saved.recording {
        Some(Recording { plan, .. }) if plan.ended.is_none() => {
            let there = recorded_of(plan.recorded, plan.last_frame);
            let sentence = format!("holds a run, with {there}, that was stopped and can be completed");
            let fix = format!("`sprung run --resume {name}` does that; to give it up, remove {name}");
            Err(Error::new(Code::Conflict, sentence).in_file(name.to_string()).with_fix(fix))
        }
        _ => Ok(()),
    }
}

/// How far a recording has got: `84 of the 1,441 frames asked for`.
pub fn recorded_of(recorded: u64, last_frame: u64) -> String {
    match last_frame + 1 {
        1 => "the one frame asked for".to_owned(),
        all if recorded == all => format!("all {} frames", grouped(all)),
        all => format!("{} of the {} frames asked for", grouped(recorded), grouped(all)),
    }
}

/// A name as the checkpoint keeps it.
fn text_of(path: &Path) -> Result<String> {
    path.to_str().map(str::to_owned).ok_or_else(|| {
        let sentence = "has a name that is no Unicode text, and a checkpoint must keep it";
        Error::new(Code::Unsupported, sentence).in_file(path.display().to_string())
    })
}

fn every_text(every: Every) -> String {
    match every {
        Every::Frames(frames) => frames.to_string(),
        Every::Time(time) => format!("{}ms", time.as_millis()),
    }
}
