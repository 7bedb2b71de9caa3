//! `sprung run --resume`: complete a run that was killed, to the same bytes as if it had not been.

use std::path::Path;

use sprung::{Code, Error, Result, Simulation, significant as rounded};
use sprung_io::RunInfo;
use sprung_io::checkpoint::{Keeper, MOST_FRAMES, Plan as Recorded, Saved};

use super::checkpoints::{Checkpoints, recorded_of};
use super::record::Recorder;
use super::run::{Plan, Run, frames_in};
use crate::args::{self, RunArgs};
use crate::console::{note, say};
use crate::interrupt::Interrupt;
use crate::memory;
use crate::source::{self, Begun};

/// Goes on with the run that a checkpoint is of.
pub fn run(args: &RunArgs, file: &Path) -> Result<()> {
    let interrupt = Interrupt::listen()?;
    let (keeper, stored) = Keeper::resume(file)?;
    let mut saved = stored.read(&memory::check)?;
    let named = |error: Error| error.in_file(file.display().to_string());
    let Some(mut recording) = saved.recording.take() else {
        let error = Error::new(Code::Conflict, "holds a simulation, and no run that could be completed");
        let fix = format!("`sprung run {} -o NAME` records one that begins with it", file.display());
        return Err(named(error.with_fix(fix)));
    };
    let Begun { name, simulation, .. } = source::begun_from(file, &saved, args.threads)?;
    lengthen(args, &mut recording.plan, &simulation).map_err(named)?;

    let plan = &recording.plan;
    let info = RunInfo {
        scene: name.clone(),
        title: plan.title.clone(),
        model: simulation.model().clone(),
        params: simulation.params().clone(),
        frame_time: simulation.params().dt * plan.steps_per_frame as f64,
        frames: plan.last_frame + 1 - plan.from,
    };
    let resumed = Recorder::resume(&recording, &info);
    let (recorder, complete) = resumed.map_err(|error| match error.fix() {
        // Where the files are is the likeliest thing to be wrong.
        None => error.with_fix(format!("the run was started in {}", plan.folder)),
        Some(_) => error,
    })?;
    if !args.quiet {
        tell(file, &saved, plan);
    }
    if plan.ended.is_some() && recorder.is_empty() {
        say(format_args!("{name}: the run is over and its files are complete; there is nothing left to do"));
        return Ok(());
    }
    if !args.quiet {
        complete.iter().for_each(|path| note(format_args!("{} is complete already.", path.display())));
    }
    let every = args.every.map_or_else(|| args::every(&plan.every), Ok);
    let every =
        every.map_err(|_| named(Error::new(Code::Unreadable, "does not say how often one is taken")))?;
    let recorded = match plan.ended {
        Some(_) => plan.last_frame + 1, // no frame follows
        None => plan.recorded,
    };
    let frames = Plan {
        start: 0.0,
        dt: simulation.params().dt,
        steps_per_frame: plan.steps_per_frame,
        frames: plan.last_frame,
        from: plan.from,
        fitted: None,
    };
    // Completing files needs no further checkpoint: this one says all there is to know.
    let goes_on = plan.ended.is_none();
    let checkpoints = goes_on.then(|| Checkpoints::resume(keeper, &saved, plan.clone(), every));
    let run = Run { name, plan: frames, simulation, recorder, checkpoints, recorded, settles: false };
    run.complete(args.quiet, &interrupt)
}

/// Another last frame, if one was asked for.
fn lengthen(args: &RunArgs, plan: &mut Recorded, simulation: &Simulation) -> Result<()> {
    let frame_time = simulation.params().dt * plan.steps_per_frame as f64;
    let wanted = args.seconds.map(|seconds| frames_in(seconds, frame_time) as u64);
    let Some(last_frame) = args.frames.or(wanted).filter(|&frames| frames != plan.last_frame) else {
        return Ok(());
    };
    if plan.ended.is_some() {
        let error = Error::new(Code::Conflict, "holds a run that is over, so it cannot be made longer");
        return Err(error.with_fix("`sprung run` with this checkpoint and -o goes on in other files"));
    }
    let last_recorded = plan.recorded - 1;
    if last_frame < last_recorded {
        let sentence =
            format!("holds a run up to frame {last_recorded}, so that it cannot end with frame {last_frame}");
        return Err(Error::new(Code::OutOfRange, sentence).with_fix("choose a later end"));
    }
    if last_frame < plan.from || last_frame > MOST_FRAMES {
        let (from, most) = (plan.from, MOST_FRAMES);
        let sentence =
            format!("holds a run that can end with frame {from} to {most}, and not with frame {last_frame}");
        return Err(Error::new(Code::OutOfRange, sentence));
    }
    plan.last_frame = last_frame;
    Ok(())
}

/// Says where it goes on.
fn tell(file: &Path, saved: &Saved, plan: &Recorded) {
    let (there, time) = (recorded_of(plan.recorded, plan.last_frame), rounded(saved.checkpoint.state.time));
    note(format_args!("Going on with {}, which has {there}, up to t = {time} s.", file.display()));
    if let Some(reason) = plan.ended.as_ref().filter(|reason| !reason.is_empty()) {
        note(format_args!("The run had ended: {reason}. Only its files are to be completed."));
    }
    let here = env!("CARGO_PKG_VERSION");
    if saved.program != here {
        note(format_args!(
            "It was begun by sprung {}, and this is {here}: from here on the bits are those of this version.",
            saved.program
        ));
    }
}
