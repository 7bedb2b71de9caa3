//! The outputs of one run: every frame goes to all of them once it is known to be good.

use std::ops::ControlFlow;
use std::path::PathBuf;

use sprung::{Code, Energy, Error, Params, Result, Simulation, Snapshot};
use sprung_io::{Export, Frame, Options, RunInfo, Written};
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

/// Refuses a name that is given twice.
pub fn check_names(outputs: &[PathBuf], plot: Option<&PathBuf>) -> Result<()> {
    let mut names: Vec<&PathBuf> = outputs.iter().chain(plot).collect();
    names.sort();
    let Some(twice) = names.windows(2).find(|pair| pair[0] == pair[1]) else { return Ok(()) };
    let error = Error::new(Code::Duplicate, "is given twice as an output");
    Err(error.in_file(twice[0].display().to_string()).with_fix("give each output a name of its own"))
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
        check_names(outputs, plot)?;
        let exporters = outputs.iter().map(|path| export::exporter_for(path)).collect::<Result<Vec<_>>>()?;
        let begin = |(path, exporter): (&PathBuf, &sprung_io::Exporter)| (exporter.open)(path, info, options);
        let exports = outputs.iter().zip(exporters).map(begin).collect::<Result<_>>()?;
        // After the exports: an output that is asked for twice is refused, whatever it would hold.
        let plot = plot.map(|path| EnergyPlot::begin(path)).transpose()?;
        let title = format!("Energy: {}", info.title);
        Ok(Self { exports, plot, title, samples: Vec::new(), held: Vec::new(), from, frames: 0 })
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
