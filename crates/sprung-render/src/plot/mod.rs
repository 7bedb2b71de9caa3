//! Plots as `.svg` or `.png`: where the energy is and where it went, and any other curves.

mod chart;
mod sheet;

use std::io::Write;
use std::path::Path;

use sprung::energy::{Energy, LedgerSums};
use sprung::{Code, Error, Result};
use sprung_io::files::write_error;
use sprung_io::{Mark, Pack, PartialFile, Unpack, Written};

use crate::export::write_png;
pub use chart::{Chart, Curve};

/// Size of the plot: pixels of a `.png` at half its scale, user units of an `.svg`.
pub const SIZE: [u32; 2] = [960, 540];

/// A plot whose file is begun with the run, so that a name that cannot be written is known before anything is
/// simulated. Dropped unfinished, it leaves nothing behind.
#[derive(Debug)]
pub struct EnergyPlot {
    file: PartialFile,
    is_vector: bool,
}

impl EnergyPlot {
    /// Begins the plot, by its ending as `.svg` or `.png`.
    ///
    /// # Errors
    /// [`Code::Unsupported`] for another ending, and [`Code::Unwritable`] as [`PartialFile::create`].
    pub fn begin(path: &Path) -> Result<Self> {
        let is_vector = ending(path)? == "svg";
        Ok(Self { file: PartialFile::create(path)?, is_vector })
    }

    /// Goes on with the plot of a run that was killed, and gives its samples until the mark.
    ///
    /// # Errors
    /// As [`PartialFile::resume`].
    pub fn resume(path: &Path, mark: &Mark) -> Result<(Self, Vec<(f64, Energy)>)> {
        let is_vector = ending(path)? == "svg";
        let [file] = mark.files_of(path)?;
        let numbers = Unpack::new(&mark.memory).f64s()?;
        let samples: Vec<_> = numbers.chunks_exact(NUMBERS).map(sample).collect();
        if samples.len() as u64 != mark.frames || numbers.len() % NUMBERS != 0 {
            return Err(Mark::strange(path));
        }
        Ok((Self { file: PartialFile::resume(path, file)?, is_vector }, samples))
    }

    /// What it takes to go on with this plot, of these samples, after a kill.
    ///
    /// # Errors
    /// [`Code::Unwritable`], if the disk is full.
    pub fn mark(&mut self, samples: &[(f64, Energy)]) -> Result<Mark> {
        let file = self.file.mark("", 0).map_err(|error| write_error(self.file.path(), &error))?;
        let numbers: Vec<f64> = samples.iter().flat_map(numbers).collect();
        let mut pack = Pack::new();
        pack.f64s(&numbers);
        Ok(Mark { frames: samples.len() as u64, files: vec![file], memory: pack.into_bytes() })
    }

    /// Draws the energies of a run: (time in s, energy in J) for each sample.
    ///
    /// # Errors
    /// [`Code::Unwritable`], if the disk is full; nothing is left of the plot then.
    pub fn finish(self, title: &str, samples: &[(f64, Energy)]) -> Result<Written> {
        let Self { mut file, is_vector } = self;
        let path = file.path().to_owned();
        let sheet = energy_chart(title, samples).draw(SIZE);
        let written = match is_vector {
            true => file.write_all(sheet.svg().as_bytes()),
            false => write_png(&mut file, &sheet.image(2)),
        };
        written.map_err(|error| write_error(&path, &error))?;
        let bytes = file.finish()?;
        Ok(Written { path, bytes, frames: samples.len() as u64 })
    }
}

/// Numbers in a sample.
const NUMBERS: usize = 11;

/// A sample as numbers. How long it was suspect is a count, and small.
fn numbers((time, energy): &(f64, Energy)) -> [f64; NUMBERS] {
    let Energy { kinetic, gravitational, elastic, contact, sums } = *energy;
    let LedgerSums { start, work_in, .. } = sums;
    let (dampers, contacts) = (sums.lost_in_dampers, sums.lost_in_contact);
    let (error, suspect) = (sums.integrator_error, sums.suspect_steps as f64);
    [*time, kinetic, gravitational, elastic, contact, start, work_in, dampers, contacts, error, suspect]
}

/// The other way round.
fn sample(numbers: &[f64]) -> (f64, Energy) {
    let sums = LedgerSums {
        start: numbers[5],
        work_in: numbers[6],
        lost_in_dampers: numbers[7],
        lost_in_contact: numbers[8],
        integrator_error: numbers[9],
        suspect_steps: numbers[10] as u64,
    };
    let [kinetic, gravitational, elastic, contact] = [numbers[1], numbers[2], numbers[3], numbers[4]];
    (numbers[0], Energy { kinetic, gravitational, elastic, contact, sums })
}

fn ending(path: &Path) -> Result<String> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    if ending == "svg" || ending == "png" {
        return Ok(ending);
    }
    let found = if ending.is_empty() { "no ending".to_owned() } else { format!("the ending .{ending}") };
    let error = Error::new(Code::Unsupported, format!("has {found}, and a plot is written as .svg or .png"));
    Err(error.in_file(path.display().to_string()))
}

/// The ledger of a run as a chart: (time in s, energy in J) for each sample.
pub fn energy_chart(title: &str, samples: &[(f64, Energy)]) -> Chart {
    Chart {
        title: title.to_owned(),
        across: "time (s)".to_owned(),
        upwards: "energy".to_owned(),
        unit: "J",
        curves: curves(samples),
        note: Some("* counted from the start"),
    }
}

/// The ledger's entries as curves. Potential energy has no natural zero: gravity's counts from the start.
fn curves(samples: &[(f64, Energy)]) -> Vec<Curve> {
    let start = samples.first().map_or(0.0, |(_, energy)| energy.gravitational);
    let curve = |name: &str, colour, width, dash: &'static [f32], value: &dyn Fn(&Energy) -> f64| Curve {
        name: name.to_owned(),
        colour,
        width,
        dash,
        points: samples.iter().map(|(time, energy)| (*time, value(energy))).collect(),
    };
    // Okabe and Ito's colours; solid is where energy is, dashed is where it went.
    vec![
        curve("total", 0x22_2b_36, 2.6, &[], &|energy| energy.total() - start),
        curve("kinetic", 0x00_72_b2, 1.8, &[], &|energy| energy.kinetic),
        curve("gravitational*", 0x00_9e_73, 1.8, &[], &|energy| energy.gravitational - start),
        curve("elastic", 0xe6_9f_00, 1.8, &[], &|energy| energy.elastic),
        curve("contact", 0xcc_79_a7, 1.8, &[], &|energy| energy.contact),
        curve("lost in dampers", 0xd5_5e_00, 1.8, &[7.0, 4.0], &|energy| energy.sums.lost_in_dampers),
        curve("lost in contact", 0x8c_4a_8f, 1.8, &[7.0, 4.0], &|energy| energy.sums.lost_in_contact),
        curve("work put in", 0x3a_9b_d9, 1.8, &[7.0, 4.0], &|energy| energy.sums.work_in),
        curve("integrator error", 0x77_7f_88, 1.8, &[2.0, 3.0], &|energy| energy.sums.integrator_error),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples() -> Vec<(f64, Energy)> {
        let sample = |index: u32| {
            let time = f64::from(index) * 0.05;
            let fall = 1000.0 * libm::exp(-0.5 * time) * libm::cos(3.0 * time);
            let sums =
                LedgerSums { lost_in_dampers: 800.0 * (1.0 - libm::exp(-time)), ..LedgerSums::default() };
            (time, Energy { kinetic: fall.abs(), gravitational: 5e4 - fall.abs(), sums, ..Energy::default() })
        };
        (0..100).map(sample).collect()
    }

    #[test]
    fn plots_are_written_in_both_formats() {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, begin) in [("e.svg", &b"<svg"[..]), ("e.PNG", &b"\x89PNG"[..])] {
            let path = folder.path().join(name);
            let plot = EnergyPlot::begin(&path).expect("it can be begun");
            let written = plot.finish("Energy <of> \"a & b\"", &samples()).expect("it can be written");
            let bytes = std::fs::read(&path).expect("it was written");
            assert!(bytes.starts_with(begin));
            assert_eq!(written.bytes, bytes.len() as u64);
        }
        let svg = std::fs::read_to_string(folder.path().join("e.svg")).expect("it is text");
        assert!(svg.contains("Energy &lt;of&gt; &quot;a &amp; b&quot;") && svg.ends_with("</svg>\n"));
        assert_eq!(
            svg.matches("stroke-dasharray=\"7 4\"").count(),
            6,
            "three dashed curves, each also in the legend"
        );
    }

    #[test]
    fn odd_samples_make_a_plot_too() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("e.png");
        let wild = Energy { kinetic: f64::NAN, elastic: f64::INFINITY, ..Energy::default() };
        for samples in [vec![], vec![(0.0, Energy::default())], vec![(0.0, wild), (1.0, wild)]] {
            let plot = EnergyPlot::begin(&path).expect("it can be begun");
            plot.finish("odd", &samples).expect("it can be written");
        }
    }

    #[test]
    fn the_place_is_claimed_before_the_run() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("e.svg");
        let code = |path: &Path| EnergyPlot::begin(path).map(drop).map_err(|error| error.code());
        let plot = EnergyPlot::begin(&path).expect("it can be begun");
        assert_eq!(code(&path), Err(Code::Unwritable), "it is being written already");
        drop(plot);
        assert_eq!(code(&path), Ok(()));
        assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 0);
        assert_eq!(code(Path::new("e.pdf")), Err(Code::Unsupported));
        assert_eq!(code(Path::new("e")), Err(Code::Unsupported));
        assert_eq!(code(&folder.path().join("none/e.svg")), Err(Code::Unwritable));
    }
}
