//! The outputs of one run: every frame goes to all of them once it is known to be good.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use sprung::{Energy, Error, Params, Result, Simulation, Snapshot};
use sprung_io::checkpoint::Recording;
use sprung_io::files::{is_complete, remove_spools};
use sprung_io::{Export, Frame, Mark, Options, RunInfo, Written};
use sprung_render::export;
use sprung_render::plot::EnergyPlot;

use crate::console;
use crate::interrupt::Interrupt;

/// Steps after which the watch has either found a suspect state good or called it a blow-up.
const STEPS_TO_A_VERDICT: usize = 64;

/// A frame held back because energy came from nowhere in it: it may belong to a blow-up.
struct Held {
    index: u64,
    snapshot: Snapshot,
    params: Params,
    energy: Option<Energy>,
}

/// All outputs of a run.
pub struct Recorder {
    exports: Vec<Box<dyn Export>>,
    plot: Option<EnergyPlot>,
    title: String,
    samples: Vec<(f64, Energy)>,
    held: Vec<Held>,
    /// The first frame that is written.
    from: u64,
    /// Whole frames written so far.
    frames: u64,
}

impl Recorder {
    /// Begins all files, before anything is simulated.
    pub fn open(
        outputs: &[PathBuf],
        plot: Option<&PathBuf>,
        info: &RunInfo,
        options: &Options,
        from: u64,
    ) -> Result<Self> {
        let exporters = outputs.iter().map(|path| export::exporter_for(path)).collect::<Result<Vec<_>>>()?;
        let begin = |(path, exporter): (&PathBuf, &sprung_io::Exporter)| (exporter.open)(path, info, options);
        let exports = outputs.iter().zip(exporters).map(begin).collect::<Result<_>>()?;
        let plot = plot.map(|path| EnergyPlot::begin(path)).transpose()?;
        let title = format!("Energy: {}", info.title);
        Ok(Self { exports, plot, title, samples: Vec::new(), held: Vec::new(), from, frames: 0 })
    }

    /// Goes on with the files of a run that was killed, at the marks of its checkpoint. An output that had been completed
    /// already, as the run was over, is left as it is; gives those.
    pub fn resume<'a>(recording: &'a Recording, info: &RunInfo) -> Result<(Self, Vec<&'a Path>)> {
        let Recording { plan, marks } = recording;
        let begun = SystemTime::UNIX_EPOCH + Duration::from_secs(plan.begun);
        let (mut exports, mut complete) = (Vec::new(), Vec::new());
        for (path, mark) in plan.outputs.iter().map(Path::new).zip(marks) {
            let exporter = export::exporter_for(path)?;
            let Some(resume) = exporter.resume else { return Err(Mark::strange(path)) };
            if plan.ended.is_some() && exporter.is_complete(path, mark, begun) {
                // What it needed until then may be there still.
                remove_spools(path, mark);
                complete.push(path);
            } else {
                exports.push(resume(path, info, &plan.options, mark)?);
            }
        }
        let (mut plot, mut samples) = (None, Vec::new());
        if let (Some(path), Some(mark)) = (plan.plot.as_ref().map(Path::new), marks.last()) {
            if plan.ended.is_some() && is_complete(path, begun) {
                remove_spools(path, mark);
                complete.push(path);
            } else {
                let (resumed, so_far) = EnergyPlot::resume(path, mark)?;
                (plot, samples) = (Some(resumed), so_far);
            }
        }
        let title = format!("Energy: {}", info.title);
        let frames = plan.recorded.saturating_sub(plan.from);
        let recorder = Self { exports, plot, title, samples, held: Vec::new(), from: plan.from, frames };
        Ok((recorder, complete))
    }

    /// Whether there is anything to write to.
    pub fn is_empty(&self) -> bool {
        self.exports.is_empty() && self.plot.is_none()
    }

    /// Whether no frame is held back.
    pub fn is_calm(&self) -> bool {
        self.held.is_empty()
    }

    /// How far each output has got, in order; then the energy plot, if there is one.
    pub fn marks(&mut self) -> Result<Vec<Mark>> {
        let mut marks = self.exports.iter_mut().map(|export| export.mark()).collect::<Result<Vec<_>>>()?;
        if let Some(plot) = &mut self.plot {
            marks.push(plot.mark(&self.samples)?);
        }
        Ok(marks)
    }

    /// Takes the current state as frame `index`.
    pub fn record(&mut self, index: u64, simulation: &mut Simulation) -> Result<()> {
        let energy = self.plot.is_some().then(|| simulation.energy());
        let suspect = simulation.is_suspect();
        let params = simulation.params().clone();
        let snapshot = simulation.snapshot();
        if suspect {
            self.held.push(Held { index, snapshot: snapshot.clone(), params, energy });
            return Ok(());
        }
        self.release()?;
        self.write(&Frame { index, snapshot, params: &params, energy: energy.as_ref() })
    }

    /// After the last frame: goes on, on a copy, until frames that are held back are known to be good.
    pub fn settle_doubts(&mut self, simulation: &Simulation) -> Result<()> {
        if self.held.is_empty() {
            return Ok(());
        }
        let mut ahead = simulation.clone();
        for _ in 0..STEPS_TO_A_VERDICT {
            if self.held.is_empty() {
                break;
            }
            ahead.step(ahead.params().dt)?;
            if !ahead.is_suspect() {
                self.release()?;
            }
        }
        self.release()
    }

    /// Completes all files with the whole frames they have; gives what was written and what went wrong.
    ///
    /// Ctrl-C breaks off the drawing of pictures, but not when it was pressed before: it ended the simulation then, and
    /// what was recorded until then is to be kept.
    pub fn finish(self, interrupt: &Interrupt, quiet: bool) -> (Vec<Written>, Vec<Error>) {
        let (mut written, mut errors) = (Vec::new(), Vec::new());
        if self.frames == 0 {
            // Dropped, they leave nothing behind.
            return (written, errors);
        }
        let came_before = interrupt.came();
        for export in self.exports {
            let bar = console::progress(1000, "writing", quiet);
            let finished = export.finish(&mut |share| {
                bar.set_position((1000.0 * share) as u64);
                if interrupt.came() && !came_before {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
            bar.finish_and_clear();
            match finished {
                Ok(file) => written.push(file),
                Err(error) => errors.push(error),
            }
        }
        if let Some(plot) = self.plot {
            match plot.finish(&self.title, &self.samples) {
                Ok(file) => written.push(file),
                Err(error) => errors.push(error),
            }
        }
        (written, errors)
    }

    fn release(&mut self) -> Result<()> {
        for held in std::mem::take(&mut self.held) {
            let Held { index, snapshot, params, energy } = &held;
            self.write(&Frame { index: *index, snapshot, params, energy: energy.as_ref() })?;
        }
        Ok(())
    }

    fn write(&mut self, frame: &Frame<'_>) -> Result<()> {
        if frame.index >= self.from {
            self.exports.iter_mut().try_for_each(|export| export.frame(frame))?;
        }
        if let Some(energy) = frame.energy {
            self.samples.push((frame.snapshot.time, *energy));
        }
        self.frames += u64::from(frame.index >= self.from);
        Ok(())
    }
}
