//! The recorded run as a file for other programs: it is gone through from its first moment to its newest, hands and changes and
//! all, and each frame is written as it comes by.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use sprung::{Code, Error, Result};
use sprung_driver::{Command, Report, Timeline};
use sprung_io::{Export, Exporter, Frame, Heeds, Options, RunInfo, Up, Writes};
use sprung_render::export::{EXPORTERS, exporter_for};
use web_time::{Duration, Instant};

use crate::state::AppState;

/// How long frames are written before the window is drawn again.
const PIECE: Duration = Duration::from_millis(12);

/// Frames in a second that are offered: films, television, screens.
pub const RATES: [u32; 4] = [24, 25, 30, 60];

/// The most frames of a file.
const MOST_FRAMES: usize = 1_000_000;

/// Formats that hold a motion, and not pictures of it. A page gives one file at a time.
pub fn formats() -> impl Iterator<Item = &'static Exporter> {
    let is_offered = |format: &&Exporter| {
        !format.heeds.contains(&Heeds::Size)
            && (cfg!(not(target_arch = "wasm32")) || format.writes == Writes::File)
    };
    EXPORTERS.iter().filter(is_offered)
}

/// How a motion is to be written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manner {
    /// Frames in a second.
    pub rate: u32,
    /// The axis that points up in the file.
    pub up: Up,
}

impl Default for Manner {
    fn default() -> Self {
        Self { rate: 24, up: Up::Y }
    }
}

/// A motion that is being written, if one is.
#[derive(Default)]
pub struct Motion(Option<Box<Writing>>);

struct Writing {
    export: Box<dyn Export>,
    path: PathBuf,
    /// The scene that it is of.
    serial: u64,
    /// The step of each frame.
    steps: Vec<u64>,
    /// Frames that are written.
    done: usize,
    /// Where the run stood before.
    back_to: u64,
}

impl Motion {
    /// Begins to write the recorded run of a scene.
    ///
    /// # Errors
    /// What the format refuses, and a file that cannot be written.
    pub fn begin(state: &mut AppState, path: &Path, manner: Manner) -> Result<()> {
        if state.motion.is_being_written() {
            let error = Error::new(Code::Conflict, "cannot be begun: another motion is still being written");
            return Err(error.with_fix("wait until that is done").in_file(path.display().to_string()));
        }
        let report = &state.report;
        let exporter = exporter_for(path)?;
        if formats().all(|format| format.ending != exporter.ending) {
            let endings: Vec<_> = formats().map(|format| format!(".{}", format.ending)).collect();
            let sentence = format!("is no name for a motion: its ending can be {}", endings.join(", "));
            return Err(Error::new(Code::Unsupported, sentence).in_file(path.display().to_string()));
        }
        let steps = steps(&report.timeline, manner.rate);
        if steps.len() > MOST_FRAMES {
            let sentence =
                format!("would have {} frames, and at most {MOST_FRAMES} are allowed", steps.len());
            return Err(Error::new(Code::TooLarge, sentence).in_file(path.display().to_string()));
        }
        let opened = &report.opened;
        let info = RunInfo {
            scene: opened.name.clone(),
            title: if opened.scene.title.is_empty() {
                opened.name.clone()
            } else {
                opened.scene.title.clone()
            },
            model: opened.model.clone(),
            params: (*opened.params).clone(),
            frame_time: 1.0 / f64::from(manner.rate),
            frames: steps.len() as u64,
        };
        let export = (exporter.open)(path, &info, &Options { up: manner.up, ..Options::default() })?;
        let (serial, back_to) = (opened.serial, report.now.step);
        let writing = Writing { export, path: path.to_owned(), serial, steps, done: 0, back_to };
        state.send(Command::Play(false));
        state.motion.0 = Some(Box::new(writing));
        Ok(())
    }

    /// Writes what has come by; true if it wants to go on soon.
    pub fn go_on(state: &mut AppState) -> bool {
        let Some(mut writing) = state.motion.0.take() else { return false };
        match writing.go_on(state) {
            Ok(true) => state.motion.0 = Some(writing),
            Ok(false) => writing.finish(state),
            // Dropped, it leaves nothing behind.
            Err(error) => state.refuse(error),
        }
        state.motion.0.is_some()
    }

    /// Whether one is.
    pub fn is_being_written(&self) -> bool {
        self.0.is_some()
    }

    /// Ends whatever goes on, and leaves no half-written file.
    pub fn drop_it(&mut self) {
        self.0 = None;
    }

    /// What the badge says while something goes on.
    pub fn badge(&self) -> Option<String> {
        let Writing { steps, done, .. } = self.0.as_deref()?;
        Some(format!("writing frame {} of {}", done + 1, steps.len()))
    }
}

impl Writing {
    /// As far as it gets in a moment; false if all frames are written.
    fn go_on(&mut self, state: &mut AppState) -> Result<bool> {
        let begin = Instant::now();
        while let Some(&step) = self.steps.get(self.done) {
            let report = state.driver.report();
            // Before the first frame it may not have heard yet that it is to pause.
            let goes_on = report.playing && self.done > 0;
            if report.opened.serial != self.serial || goes_on {
                let sentence =
                    "was not saved: the run went on, or another scene was opened, while it was being written";
                let error = Error::new(Code::Interrupted, sentence)
                    .with_fix("save it once more, and wait until it is done");
                return Err(error.in_file(self.path.display().to_string()));
            }
            if report.now.step != step || report.playing {
                // The driver takes the newest of several places that it is asked to go to; so one at a time.
                if report.busy.is_none() {
                    state.send(Command::Seek(step));
                }
                let now = state.driver.report();
                if now.now.step != step || now.playing {
                    return Ok(true);
                }
                continue;
            }
            self.write(&report)?;
            if begin.elapsed() > PIECE {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn write(&mut self, report: &Report) -> Result<()> {
        self.export.frame(&Frame {
            index: self.done as u64,
            snapshot: &report.now,
            params: &report.params,
            energy: report.ledger_is_whole.then_some(&report.energy),
        })?;
        self.done += 1;
        Ok(())
    }

    fn finish(self, state: &mut AppState) {
        match self.export.finish(&mut |_| ControlFlow::Continue(())) {
            Ok(written) => {
                let (name, frames) = (self.path.display(), written.frames);
                state.say(format!("Saved {name}: {frames} frames, {} bytes", written.bytes));
            }
            Err(error) => state.refuse(error),
        }
        state.send(Command::Seek(self.back_to));
    }
}

/// The recorded steps nearest to the times of frames, from the first to the newest.
fn steps(timeline: &Timeline, rate: u32) -> Vec<u64> {
    let (first, newest) = (timeline.first, timeline.newest);
    // A hair longer, so that a frame at the very end is not missed by rounding.
    let frames = ((newest.1 - first.1) * f64::from(rate) + 1e-6).max(0.0) as usize;
    let step = |frame: usize| step_at(timeline, first.1 + frame as f64 / f64::from(rate));
    (0..=frames).map(|frame| step(frame).clamp(first.0, newest.0)).collect()
}

/// The step nearest to a time.
fn step_at(timeline: &Timeline, time: f64) -> u64 {
    let part = timeline.clock.iter().rev().find(|(_, begin, _)| *begin <= time);
    let (step, begin, dt) =
        part.or(timeline.clock.first()).copied().unwrap_or((timeline.first.0, timeline.first.1, 1.0));
    step + ((time - begin) / dt).round().max(0.0) as u64
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn frames_are_the_steps_nearest_to_their_times() {
        let timeline = Timeline {
            first: (0, 0.0),
            newest: (30, 0.2),
            // Steps of 0.01 s, and from the tenth on of 0.005 s.
            clock: Arc::new(vec![(0, 0.0, 0.01), (10, 0.1, 0.005)]),
            ..Timeline::default()
        };
        assert_eq!(steps(&timeline, 25), [0, 4, 8, 14, 22, 30]);
        assert_eq!(steps(&Timeline { newest: (0, 0.0), ..timeline }, 25), [0]);
    }

    #[test]
    fn formats_are_those_that_hold_a_motion() {
        let endings: Vec<_> = formats().map(|format| format.ending).collect();
        for ending in ["csv", "npz", "usdc", "glb", "pc2", "pvd"] {
            assert!(endings.contains(&ending), "{ending}");
        }
        for ending in ["png", "gif", "mp4"] {
            assert!(!endings.contains(&ending), "{ending}");
        }
    }
}
