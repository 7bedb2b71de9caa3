//! PC2, the point cache of 3ds Max, Blender and others: the vertices of every frame, one after the other.
//!
//! A header of 32 bytes, then x, y, z of every vertex of every sample, all of it little-endian:
//!
//! ```text
//!  0  char[12]  POINTCACHE2 and a zero        20  float32  frame of the first sample
//! 12  int32     version, 1                    24  float32  frames from one sample to the next
//! 16  int32     vertices                      28  int32    samples
//! ```

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use sprung::{Code, Error, Result};

use super::numbers::{little, write_all};
use super::{
    Estimate, Export, Exporter, Frame, Geometry, Heeds, Mark, Options, Progress, RunInfo, Writes, Written,
};
use crate::files::{PartialFile, write_error};
use crate::pack::{Pack, Unpack};

/// `.pc2`: the vertices of every frame, for a mesh that the other program has already.
pub const PC2: Exporter = Exporter {
    ending: "pc2",
    description: "a point cache: the vertices of the .obj of the same options, for Blender and 3ds Max",
    heeds: &[Heeds::Geometry, Heeds::Springs],
    writes: Writes::File,
    estimate,
    open,
    resume: Some(resume),
};

const HEADER_BYTES: u64 = 32;

struct Pc2Export {
    file: PartialFile,
    geometry: Geometry,
    /// Number of the first frame.
    first: u64,
    frames: u64,
}

fn open(path: &Path, run: &RunInfo, options: &Options) -> Result<Box<dyn Export>> {
    let geometry = cached(run, options)?;
    let mut file = PartialFile::create(path)?;
    let begun = file.write_all(&header(&geometry, 0, 0)).and_then(|()| file.commit());
    begun.map_err(|error| write_error(path, &error))?;
    Ok(Box::new(Pc2Export { file, geometry, first: 0, frames: 0 }))
}

fn resume(path: &Path, run: &RunInfo, options: &Options, mark: &Mark) -> Result<Box<dyn Export>> {
    let geometry = cached(run, options)?;
    let [file] = mark.files_of(path)?;
    let mut memory = Unpack::new(&mark.memory);
    let first = memory.u64()?;
    memory.end()?;
    let vertices = 12 * geometry.vertex_count() as u64;
    if file.head != HEADER_BYTES || mark.frames.checked_mul(vertices) != file.bytes.checked_sub(HEADER_BYTES)
    {
        return Err(Mark::strange(path));
    }
    Ok(Box::new(Pc2Export { file: PartialFile::resume(path, file)?, geometry, first, frames: mark.frames }))
}

fn estimate(run: &RunInfo, options: &Options) -> Result<Estimate> {
    let vertices = cached(run, options)?.vertex_count() as u64;
    Ok(Estimate::Exact(HEADER_BYTES + run.frames * vertices * 12))
}

/// What a point cache holds: the vertices of a mesh file that was written with the same options.
///
/// # Errors
/// As [`Geometry::of_meshes`], and [`Code::TooLarge`] for more frames or vertices than the 32 bits of the formats can count.
pub(super) fn cached(run: &RunInfo, options: &Options) -> Result<Geometry> {
    let geometry = Geometry::of_meshes(run, options)?;
    let most = i32::MAX as u64;
    for (count, what) in [(run.frames, "frames"), (geometry.vertex_count() as u64, "vertices")] {
        if count > most {
            let sentence = format!("a point cache would have {count} {what}, and can have {most}");
            return Err(Error::new(Code::TooLarge, sentence));
        }
    }
    Ok(geometry)
}

fn header(geometry: &Geometry, first: u64, frames: u64) -> Vec<u8> {
    let mut header = b"POINTCACHE2\0".to_vec();
    header.extend(1i32.to_le_bytes());
    header.extend((geometry.vertex_count() as i32).to_le_bytes());
    header.extend((first as f32).to_le_bytes());
    header.extend(1f32.to_le_bytes());
    header.extend((frames as i32).to_le_bytes());
    header
}

impl Export for Pc2Export {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        self.geometry.take(frame);
        let vertices = self.geometry.positions().iter().map(|&v| little(v));
        let written = write_all(&mut self.file, vertices).and_then(|()| self.file.commit());
        if let Err(error) = written {
            // What did not fit would shift every frame behind it.
            let _ = self.file.roll_back();
            return Err(write_error(self.file.path(), &error));
        }
        if self.frames == 0 {
            self.first = frame.index;
        }
        self.frames += 1;
        Ok(())
    }

    fn finish(mut self: Box<Self>, _: &mut Progress<'_>) -> Result<Written> {
        let path = self.file.path().to_owned();
        let header = header(&self.geometry, self.first, self.frames);
        complete(&mut self.file, &header).map_err(|error| write_error(&path, &error))?;
        Ok(Written { bytes: self.file.finish()?, path, frames: self.frames })
    }

    fn mark(&mut self) -> Result<Mark> {
        // The header is filled in at the end.
        let file = self.file.mark("", HEADER_BYTES).map_err(|error| write_error(self.file.path(), &error))?;
        let mut memory = Pack::new();
        memory.u64(self.first);
        Ok(Mark { frames: self.frames, files: vec![file], memory: memory.into_bytes() })
    }
}

fn complete(file: &mut PartialFile, header: &[u8]) -> io::Result<()> {
    file.roll_back()?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(header)
}
