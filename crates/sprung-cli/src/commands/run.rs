//! `sprung run`: simulate a scene and write its motion.

use std::ops::ControlFlow;
use std::time::Instant;

use sprung::params::DT_RANGE;
use sprung::scene::Scene;
use sprung::{
    Change, Code, Error, MOST_STEPS, Result, SettleOptions, Simulation, significant as rounded, stability,
};
use sprung_io::checkpoint::MOST_FRAMES;
use sprung_io::{RunInfo, Written, files};

use super::checkpoints::Checkpoints;
use super::limits::{Contacts, describe};
use super::outputs::{self, Outputs};
use super::record::Recorder;
use super::resume;
use crate::args::RunArgs;
use crate::console::{bytes, complain, counted, grouped, note, progress, say, seconds};
use crate::interrupt::Interrupt;
use crate::source::{self, Begun};

/// Simulated time when nothing is said, s.
const DEFAULT_SECONDS: f64 = 10.0;

/// A dt above this share of the sharp limit is warned of: the limit is computed from below.
const WARNING_SHARE: f64 = 0.95;

/// Runs, and says what was done.
pub fn run(args: &RunArgs) -> Result<()> {
    if let Some(file) = &args.resume {
        return resume::run(args, file);
    }
    let interrupt = Interrupt::listen()?;
    let Begun { name, scene, mut simulation, steps_per_frame } = source::begun(&args.scene(), args.threads)?;
    let plan = Plan::new(args, &simulation, steps_per_frame)?;
    if plan.dt != simulation.params().dt {
        simulation.change(Change::Dt(plan.dt))?;
    }
    simulation.keep_ledger(args.plot.is_some());
    let options = outputs::options(args);
    let info = info(&name, &scene, &simulation, &plan);
    let outputs = Outputs::plan(args, &info, &options)?;
    check_times(args, &plan)?;
    outputs.check_room()?;
    if args.dry_run {
        return dry_run(args, &plan, &name, &outputs);
    }
    // Before the outputs: those of a run that can still be completed are not to be begun anew.
    let mut checkpoints = Checkpoints::begin(args, &name, &scene, &info, &plan, &options)?;
    let recorder = Recorder::open(&args.output, args.plot.as_ref(), &info, &options, plan.from)?;
    if !args.quiet {
        plan.announce();
        outputs.suggest_pace();
        outputs.announce();
    }
    warn_of_large_dt(&mut simulation);
    if let Some(checkpoints) = &mut checkpoints {
        checkpoints.fingerprint(&simulation);
    }
    let run = Run { name, plan, simulation, recorder, checkpoints, recorded: 0, settles: args.settle };
    run.complete(args.quiet, &interrupt)
}

/// A run that is ready to begin, or to go on.
pub struct Run {
    pub name: String,
    pub plan: Plan,
    pub simulation: Simulation,
    pub recorder: Recorder,
    pub checkpoints: Option<Checkpoints>,
    /// Frames that were recorded before it was killed.
    pub recorded: u64,
    /// It begins by coming to rest.
    pub settles: bool,
}

impl Run {
    /// Simulates what there is to simulate, completes the outputs, and says what was done.
    pub fn complete(mut self, quiet: bool, interrupt: &Interrupt) -> Result<()> {
        let (first_step, begun_at) = self.simulation.now();
        let begun = Instant::now();
        let outcome = self.simulate(quiet, interrupt);
        let simulated_in = begun.elapsed();
        let Self { name, plan, mut simulation, mut recorder, mut checkpoints, recorded, .. } = self;

        // Whatever happened: the whole frames that there are become whole files, and until they are, what it takes to
        // complete them is safe.
        if let Some(checkpoints) = &mut checkpoints {
            checkpoints.close(&outcome, &mut simulation, &mut recorder);
        }
        let (written, mut errors) = recorder.finish(interrupt, quiet);
        if !quiet {
            for file in &written {
                let path = file.path.display();
                note(format_args!("Wrote {path}: {}, {}.", counted(file.frames, "frame"), bytes(file.bytes)));
            }
        }
        if let Err(error) = outcome {
            let stopped = error.code() == Code::Interrupted;
            errors.insert(0, if stopped { interrupted(&written) } else { error });
        }
        errors.extend(checkpoints.and_then(Checkpoints::failure));
        all_said(errors)?;
        let left = plan.frames + 1 - recorded;
        if !quiet && left == 0 {
            let hash = simulation.state_hash();
            say(format_args!(
                "{name}: there was nothing left to simulate, and its files are complete now; state hash {hash:016x}"
            ));
        } else if !quiet {
            // What was done here and now: another run may have led to where this one began.
            let (step, time) = simulation.now();
            let pace = (time - begun_at) / simulated_in.as_secs_f64().max(1e-9);
            let frames = match recorded {
                0 => counted(left, "frame"),
                _ => format!("{} ({} in all)", counted(left, "more frame"), grouped(plan.frames + 1)),
            };
            say(format_args!(
                "{name}: {frames}, {}, {} s simulated in {} ({pace:.1} × real time); state hash {:016x}",
                counted(step - first_step, "step"),
                rounded(time - begun_at),
                seconds(simulated_in),
                simulation.state_hash()
            ));
        }
        Ok(())
    }

    fn simulate(&mut self, quiet: bool, interrupt: &Interrupt) -> Result<()> {
        let Self { plan, simulation, recorder, checkpoints, .. } = self;
        if self.settles {
            settle(quiet, simulation, interrupt)?;
        }
        let bar = progress(plan.frames, "simulating", quiet);
        bar.set_position(self.recorded);
        for frame in self.recorded..=plan.frames {
            // The first frame is how it begins.
            for _ in 0..if frame == 0 { 0 } else { plan.steps_per_frame } {
                if interrupt.came() {
                    return Err(Error::new(Code::Interrupted, "interrupted"));
                }
                simulation.step(plan.dt)?;
            }
            recorder.record(frame, simulation)?;
            bar.set_position(frame);
            if let Some(checkpoints) = checkpoints {
                checkpoints.recorded(frame, simulation, recorder);
            }
        }
        recorder.settle_doubts(simulation)?;
        bar.finish_and_clear();
        Ok(())
    }
}

/// `--at` needs a time of which a frame is written.
fn check_times(args: &RunArgs, plan: &Plan) -> Result<()> {
    let Some(at) = args.at else { return Ok(()) };
    let time = |frame: u64| plan.start + plan.dt * (plan.steps_per_frame * frame) as f64;
    let (start, end) = (time(plan.from), time(plan.frames));
    let refused = |sentence: String| Error::new(Code::OutOfRange, sentence).in_file("--at");
    if at > end + 1e-9 {
        let sentence = format!("is {} s, and the run ends at {} s", rounded(at), rounded(end));
        return Err(refused(sentence).with_fix("make it longer with --seconds"));
    }
    if at < start - 1e-9 {
        let sentence = format!("is {} s, and the first frame is at {} s", rounded(at), rounded(start));
        return Err(refused(sentence).with_fix("choose a later time, or an earlier --from"));
    }
    Ok(())
}

/// Says what would be done. Of the places to write it looks whether they can be written, and leaves them as they are.
fn dry_run(args: &RunArgs, plan: &Plan, name: &str, outputs: &Outputs<'_>) -> Result<()> {
    args.output.iter().chain(&args.plot).try_for_each(|path| files::check(path))?;
    if !args.quiet {
        plan.announce();
        outputs.suggest_pace();
    }
    let steps = plan.steps_per_frame * plan.frames;
    say(format_args!(
        "{name}: {}, {} of {} s, {} s simulated",
        counted(plan.frames + 1, "frame"),
        counted(steps, "step"),
        rounded(plan.dt),
        rounded(plan.dt * steps as f64)
    ));
    outputs.tell(plan.frames - plan.from + 1);
    if let Some(path) = &args.plot {
        say(format_args!("{}: the energy plot", path.display()));
    }
    Ok(())
}

/// How many frames of how many steps of which length.
pub struct Plan {
    /// Time of the first frame, s: not 0 where a run begins from a checkpoint.
    pub start: f64,
    pub dt: f64,
    pub steps_per_frame: u64,
    /// Number of the last frame, and of the first that is written.
    pub frames: u64,
    pub from: u64,
    /// The frame rate that dt was fitted to, and dt as it was.
    pub fitted: Option<(f64, f64)>,
}

impl Plan {
    /// `steps_per_frame` is what holds unless a frame rate is asked for.
    fn new(args: &RunArgs, simulation: &Simulation, steps_per_frame: u64) -> Result<Self> {
        let params = simulation.params();
        let (dt, steps_per_frame) = match args.fps {
            // The largest step not above dt that divides a frame; a quotient that is whole up to rounding is whole.
            Some(fps) => {
                let steps = (1.0 / (fps * params.dt) - 1e-9).ceil().max(1.0);
                // Not below the smallest step allowed, which a quotient may miss by its rounding.
                ((1.0 / (fps * steps)).max(*DT_RANGE.start()), steps as u64)
            }
            None => (params.dt, steps_per_frame),
        };
        let frame_time = dt * steps_per_frame as f64;
        let frames = frames_in(args.seconds.unwrap_or(DEFAULT_SECONDS), frame_time);
        if args.frames.is_none() && frames > MOST_FRAMES as f64 {
            let sentence = format!("would make {frames:.0} frames, and at most {MOST_FRAMES} are allowed");
            return Err(Error::new(Code::TooLarge, sentence).in_file("--seconds"));
        }
        let fitted = args.fps.filter(|_| dt != params.dt).map(|fps| (fps, params.dt));
        let frames = args.frames.unwrap_or(frames as u64);
        let from = args.from.unwrap_or(0);
        if from > frames {
            let sentence = format!("is frame {from}, and the last one is {frames}");
            return Err(Error::new(Code::OutOfRange, sentence).in_file("--from"));
        }
        if steps_per_frame.checked_mul(frames).is_none_or(|steps| steps > MOST_STEPS) {
            let steps = steps_per_frame as f64 * frames as f64;
            let sentence = format!("would take {steps:e} steps, and at most {MOST_STEPS} can be counted");
            return Err(Error::new(Code::TooLarge, sentence).with_fix("record fewer frames, or raise dt"));
        }
        Ok(Self { start: simulation.now().1, dt, steps_per_frame, frames, from, fitted })
    }

    fn announce(&self) {
        if let Some((fps, dt)) = self.fitted {
            let make = if self.steps_per_frame == 1 { "makes" } else { "make" };
            let steps = counted(self.steps_per_frame, "step");
            note(format_args!(
                "dt is {} s instead of {} s, so that {steps} {make} a frame of 1/{} s.",
                rounded(self.dt),
                rounded(dt),
                rounded(fps)
            ));
        }
    }
}

/// So much time, rounded up to whole frames; what is whole up to rounding is whole.
pub fn frames_in(seconds: f64, frame_time: f64) -> f64 {
    (seconds / frame_time - 1e-9).ceil()
}

fn info(name: &str, scene: &Scene, simulation: &Simulation, plan: &Plan) -> RunInfo {
    RunInfo {
        scene: name.to_owned(),
        title: if scene.title.is_empty() { name.to_owned() } else { scene.title.clone() },
        model: simulation.model().clone(),
        params: simulation.params().clone(),
        frame_time: plan.dt * plan.steps_per_frame as f64,
        frames: plan.frames - plan.from + 1,
    }
}

fn settle(quiet: bool, simulation: &mut Simulation, interrupt: &Interrupt) -> Result<()> {
    let bar = progress(SettleOptions::default().max_steps, "settling", quiet);
    let settled = simulation.settle_with(SettleOptions::default(), &mut |so_far| {
        bar.set_position(so_far.steps);
        if interrupt.came() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let settled = settled.map_err(|error| match error.code() {
        Code::NotSettled => error.with_fix(
            "hold every body by a pin or a plane, or leave out --settle and let it rest in a longer run",
        ),
        _ => error,
    })?;
    bar.finish_and_clear();
    if !quiet {
        let steps = counted(settled.steps, "step");
        note(format_args!(
            "Settled in {steps}; the largest force left is {} N.",
            rounded(settled.residual_force)
        ));
    }
    Ok(())
}

/// Says before the run that it will probably blow up. The sharp limit is only worth computing beyond the certified one.
fn warn_of_large_dt(simulation: &mut Simulation) {
    // Quickly found, and never above the exact one.
    let dt = simulation.params().dt;
    if simulation.certified_limit().is_none_or(|limit| dt <= limit.dt) {
        return;
    }
    let simulation = &*simulation;
    let (model, params, positions) = (simulation.model(), simulation.params(), &simulation.state().position);
    let Some(certified) = stability::certified(model, params, positions).filter(|limit| params.dt > limit.dt)
    else {
        return;
    };
    let Some(limit) = stability::sharp(model, params, positions).dt else { return };
    if params.dt > WARNING_SHARE * limit {
        let verdict = if params.dt > limit { "is over" } else { "is close to" };
        let advised = WARNING_SHARE * certified.dt;
        let advice = if advised >= *DT_RANGE.start() {
            format!("Try dt = {} s, or \"auto\".", rounded(advised))
        } else {
            "No step is small enough: raise masses, or lower stiffness or damping.".to_owned()
        };
        note(format_args!(
            "Warning: dt = {} s {verdict} the largest stable step of {} s; the tightest place is {}. Expect a blow-up. {advice}",
            rounded(params.dt),
            rounded(limit),
            describe(simulation, &certified, Contacts::Now),
        ));
    }
}

/// What Ctrl-C left: `interrupted; 12 frames are kept in a.csv, 1 frame in b.png`.
fn interrupted(written: &[Written]) -> Error {
    let mut sentence = "interrupted".to_owned();
    for (number, file) in written.iter().enumerate() {
        let verb = match (number, file.frames) {
            (0, 1) => "is kept ",
            (0, _) => "are kept ",
            _ => "",
        };
        let separator = if number == 0 { ";" } else { "," };
        let frames = counted(file.frames, "frame");
        sentence += &format!("{separator} {frames} {verb}in {}", file.path.display());
    }
    Error::new(Code::Interrupted, sentence)
}

/// Complains of every error but one, and gives that one back to be told last: the user's own Ctrl-C if it is among
/// them, as it decides the exit status, or else the first.
fn all_said(mut errors: Vec<Error>) -> Result<()> {
    if errors.is_empty() {
        return Ok(());
    }
    let chosen = errors.iter().position(|error| error.code() == Code::Interrupted).unwrap_or(0);
    let last = errors.remove(chosen);
    errors.iter().for_each(complain);
    Err(last)
}
