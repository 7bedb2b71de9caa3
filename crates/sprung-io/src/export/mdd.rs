//! MDD, the point cache of LightWave, Blender, Maya and others: like PC2, and with the time of every frame.
//!
//! All numbers are big-endian: two int32, the numbers of frames and of vertices; a float32 for each frame, its time in
//! seconds; then x, y, z of every vertex of every frame. The times come first, so room is left for those of all frames
//! that are planned; where a run ends early, the vertices are moved down to the times that there are.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use sprung::{Code, Error, Result};

use super::numbers::{big, write_all};
use super::pc2::cached;
use super::{
    Estimate, Export, Exporter, Frame, Geometry, Heeds, Mark, Options, Progress, RunInfo, Writes, Written,
};
use crate::files::{PartialFile, write_error};
use crate::pack::{Pack, Unpack};

/// `.mdd`: the vertices and the time of every frame, for a mesh that the other program has already.
pub const MDD: Exporter = Exporter {
    ending: "mdd",
    description: "a point cache with the time of each frame, for Blender, Maya and LightWave",
    heeds: &[Heeds::Geometry, Heeds::Springs],
    writes: Writes::File,
    estimate,
    open,
    resume: Some(resume),
};

/// The two counts.
const HEADER_BYTES: u64 = 8;

struct MddExport {
    file: PartialFile,
    /// The time of each frame, s: a checkpoint keeps them, as they lie where a checksum does not reach.
    times: Vec<f32>,
    geometry: Geometry,
    /// Frames for whose times there is room.
    planned: u64,
    frames: u64,
}

fn open(path: &Path, run: &RunInfo, options: &Options) -> Result<Box<dyn Export>> {
    let geometry = cached(run, options)?;
    let mut file = PartialFile::create(path)?;
    let begun = begin(&mut file, run.frames);
    begun.map_err(|error| write_error(path, &error))?;
    Ok(Box::new(MddExport { file, times: Vec::new(), geometry, planned: run.frames, frames: 0 }))
}

fn resume(path: &Path, run: &RunInfo, options: &Options, mark: &Mark) -> Result<Box<dyn Export>> {
    let geometry = cached(run, options)?;
    let [file] = mark.files_of(path)?;
    let mut memory = Unpack::new(&mark.memory);
    let times = memory.f32s()?;
    memory.end()?;
    // Room was left for so many times, whatever is planned now.
    let planned = file.head.saturating_sub(HEADER_BYTES) / 4;
    if run.frames > planned {
        let sentence = format!("cannot be made longer: the file has room for {planned} frames");
        return Err(Error::new(Code::Unsupported, sentence).in_file(path.display().to_string()));
    }
    let vertices = 12 * geometry.vertex_count() as u64;
    let fits = file.head == HEADER_BYTES + 4 * planned
        && mark.frames <= planned
        && mark.frames == times.len() as u64
        && mark.frames.checked_mul(vertices) == file.bytes.checked_sub(file.head);
    if !fits {
        return Err(Mark::strange(path));
    }
    let mut file = PartialFile::resume(path, file)?;
    // As they were, even if the file was being completed.
    let again = file
        .seek(SeekFrom::Start(HEADER_BYTES))
        .and_then(|_| write_all(&mut file, times.iter().map(|time| time.to_be_bytes())))
        .and_then(|()| file.commit());
    again.map_err(|error| write_error(path, &error))?;
    Ok(Box::new(MddExport { file, times, geometry, planned, frames: mark.frames }))
}

/// Takes the room for counts and times. Not with zeros: some file systems take no room for those.
fn begin(file: &mut PartialFile, planned: u64) -> io::Result<()> {
    write_all(file, (0..2 + planned).map(|_| [0xA5; 4]))?;
    file.commit()
}

fn estimate(run: &RunInfo, options: &Options) -> Result<Estimate> {
    let vertices = cached(run, options)?.vertex_count() as u64;
    Ok(Estimate::Exact(HEADER_BYTES + run.frames * (4 + 12 * vertices)))
}

impl Export for MddExport {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        if self.frames == self.planned {
            let sentence = format!("got a frame more than the {} that were planned", self.planned);
            let path = self.file.path().display().to_string();
            return Err(Error::new(Code::Conflict, sentence).in_file(path));
        }
        self.geometry.take(frame);
        let time = frame.snapshot.time as f32;
        if let Err(error) = self.take(time) {
            // What did not fit would shift every frame behind it.
            let _ = self.file.roll_back();
            return Err(write_error(self.file.path(), &error));
        }
        self.times.push(time);
        self.frames += 1;
        Ok(())
    }

    fn finish(mut self: Box<Self>, _: &mut Progress<'_>) -> Result<Written> {
        let path = self.file.path().to_owned();
        self.complete().map_err(|error| write_error(&path, &error))?;
        Ok(Written { bytes: self.file.finish()?, path, frames: self.frames })
    }

    fn mark(&mut self) -> Result<Mark> {
        let head = HEADER_BYTES + 4 * self.planned;
        let file = self.file.mark("", head).map_err(|error| write_error(self.file.path(), &error))?;
        let mut memory = Pack::new();
        memory.f32s(&self.times);
        Ok(Mark { frames: self.frames, files: vec![file], memory: memory.into_bytes() })
    }
}

impl MddExport {
    fn take(&mut self, time: f32) -> io::Result<()> {
        write_all(&mut self.file, self.geometry.positions().iter().map(|&v| big(v)))?;
        self.file.seek(SeekFrom::Start(HEADER_BYTES + 4 * self.frames))?;
        self.file.write_all(&time.to_be_bytes())?;
        self.file.commit()
    }

    fn complete(&mut self) -> io::Result<()> {
        self.file.roll_back()?;
        let [times_end, vertices] = [self.frames, self.planned].map(|times| HEADER_BYTES + 4 * times);
        self.file.close_gap(times_end, vertices)?;
        self.file.seek(SeekFrom::Start(0))?;
        self.file.write_all(&(self.frames as i32).to_be_bytes())?;
        self.file.write_all(&(self.geometry.vertex_count() as i32).to_be_bytes())
    }
}
