//! Comma-separated values: one row per point and frame, readable by every spreadsheet and every language.

use std::io::{self, Write};
use std::path::Path;

use sprung::{Result, Snapshot};

use super::{Estimate, Export, Exporter, Frame, Mark, Options, Progress, RunInfo, Writes, Written};
use crate::files::{PartialFile, write_error};

/// `.csv`: a table of positions and velocities. Numbers read back to the same float32, times to the same float64.
pub const CSV: Exporter = Exporter {
    ending: "csv",
    description: "a table: frame,time,point,x,y,z,vx,vy,vz (s, m, m/s)",
    heeds: &[],
    writes: Writes::File,
    estimate,
    open,
    resume: Some(resume),
};

/// The first line.
const HEADER: &str = "frame,time,point,x,y,z,vx,vy,vz\n";

/// Length of a row: six numbers of nine digits or less, and what is before them.
const ROW_BYTES: u64 = 78;

struct CsvExport {
    file: PartialFile,
    frames: u64,
}

fn open(path: &Path, _: &RunInfo, _: &Options) -> Result<Box<dyn Export>> {
    let mut file = PartialFile::create(path)?;
    let begun = file.write_all(HEADER.as_bytes()).and_then(|()| file.commit());
    begun.map_err(|error| write_error(path, &error))?;
    Ok(Box::new(CsvExport { file, frames: 0 }))
}

fn estimate(run: &RunInfo, _: &Options) -> Result<Estimate> {
    Ok(Estimate::About(HEADER.len() as u64 + run.frames * run.model.point_count() as u64 * ROW_BYTES))
}

fn resume(path: &Path, _: &RunInfo, _: &Options, mark: &Mark) -> Result<Box<dyn Export>> {
    let [file] = mark.files_of(path)?;
    Ok(Box::new(CsvExport { file: PartialFile::resume(path, file)?, frames: mark.frames }))
}

impl Export for CsvExport {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        let written =
            write_rows(&mut self.file, frame.index, frame.snapshot).and_then(|()| self.file.commit());
        written.map_err(|error| write_error(self.file.path(), &error))?;
        self.frames += 1;
        Ok(())
    }

    fn finish(mut self: Box<Self>, _: &mut Progress<'_>) -> Result<Written> {
        let path = self.file.path().to_owned();
        self.file.roll_back().map_err(|error| write_error(&path, &error))?;
        Ok(Written { bytes: self.file.finish()?, path, frames: self.frames })
    }

    fn mark(&mut self) -> Result<Mark> {
        let file = self.file.mark("", 0).map_err(|error| write_error(self.file.path(), &error))?;
        Ok(Mark { frames: self.frames, files: vec![file], memory: Vec::new() })
    }
}

/// The rows of one frame. Digits go through a small buffer on the stack: no allocation per number.
fn write_rows(out: &mut impl Write, index: u64, snapshot: &Snapshot) -> io::Result<()> {
    let mut digits = zmij::Buffer::new();
    // What every row of the frame begins with.
    let row_start = format!("{index},{},", digits.format(snapshot.time));
    for (point, (position, velocity)) in snapshot.positions.iter().zip(&snapshot.velocities).enumerate() {
        write!(out, "{row_start}{point}")?;
        for component in position.to_array().into_iter().chain(velocity.to_array()) {
            out.write_all(b",")?;
            out.write_all(digits.format(component).as_bytes())?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use sprung::Vec3;

    use super::*;

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let hard = [
            0.0,
            -0.0,
            1.0,
            0.1,
            -1.0 / 3.0,
            16_777_216.0,
            3.4e38,
            1e-20,
            f32::MIN_POSITIVE,
            1e-45,
            f32::MAX,
            5e9,
        ];
        let positions: Vec<Vec3> = hard.iter().map(|&x| Vec3::new(x, -x, x * 0.7)).collect();
        let velocities: Vec<Vec3> = hard.iter().rev().map(|&x| Vec3::new(x, x / 3.0, 2.0)).collect();
        let snapshot = Snapshot { step: 3, time: 0.1 + 0.2, positions, velocities };

        let mut bytes = Vec::new();
        write_rows(&mut bytes, 7, &snapshot).expect("memory takes everything");

        let text = String::from_utf8(bytes).expect("digits are ASCII");
        for (point, line) in text.lines().enumerate() {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells[0], "7");
            assert_eq!(cells[1].parse(), Ok(0.1 + 0.2));
            assert_eq!(cells[2].parse(), Ok(point));
            let expected =
                snapshot.positions[point].to_array().into_iter().chain(snapshot.velocities[point].to_array());
            for (cell, expected) in cells[3..].iter().zip(expected) {
                let read: f32 = cell.parse().expect("a number");
                assert_eq!(read.to_bits(), expected.to_bits(), "{cell} for {expected:e}");
            }
            assert_eq!(cells.len(), 9);
        }
        assert_eq!(text.lines().count(), hard.len());
    }
}
