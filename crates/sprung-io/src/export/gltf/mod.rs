//! `.glb`: glTF 2.0 in its binary form, for the web, Blender and game engines.
//!
//! glTF knows no meshes whose points move freely, but shapes that are blended ("morph targets"): each frame becomes one,
//! as differences from the first, and an animation blends from each to the next. Readers keep all of them in memory, often
//! as layers of one texture, so this is for short clips; with `--at` it is the still shape of one moment.
//!
//! The description of the data comes first in the file and is known last: the data grow in a temporary file.

mod document;

use std::io::{self, Write};
use std::path::Path;

use sprung::{Code, Error, Params, Result, Snapshot, Vec3};

use self::document::{Bounds, Document};
use super::spool::{Reserve, Spool};
use super::{Estimate, Export, Exporter, Frame, Geometry, Heeds, Options, Progress, RunInfo, Up, Written};
use crate::files::{PartialFile, write_error};

/// `.glb`: a short clip, or the shape at one moment.
pub const GLB: Exporter = Exporter {
    ending: "glb",
    description: "glTF: a clip of at most 257 frames, or the shape nearest to --at, for the web and game engines",
    resume: None,
    heeds: &[Heeds::At, Heeds::Geometry, Heeds::Springs],
    estimate,
    open,
};

/// The first frame and 256 shapes: the fewest layers of a texture that browsers promise (WebGL 2, MAX_ARRAY_TEXTURE_LAYERS).
const MOST_FRAMES: u64 = 257;
/// What readers can be expected to hold in memory at once.
const MOST_BYTES: u64 = 1 << 30;

fn estimate(run: &RunInfo, options: &Options) -> Result<Estimate> {
    let document = plan(run, options)?;
    Ok(Estimate::About(bytes(&document, shown(run, options))))
}

/// How many frames will be in the file.
fn shown(run: &RunInfo, options: &Options) -> u64 {
    if options.at.is_some() { 1 } else { run.frames }
}

/// About how long the file is.
fn bytes(document: &Document, frames: u64) -> u64 {
    document.layout.frame_bytes() * frames + document.tail_bytes(frames) + document.text_bytes(frames)
}

/// What is the same in all frames, if there may be as many as there will be.
fn plan(run: &RunInfo, options: &Options) -> Result<Document> {
    if options.up != Up::Y || options.scale != 1.0 {
        let (argument, said) = if options.up == Up::Y { ("--scale", "in metres") } else { ("--up", "Y up") };
        let sentence = format!("cannot be said for a .glb, which is {said} by its standard");
        return Err(Error::new(Code::Conflict, sentence)
            .in_file(argument)
            .with_fix(format!("leave {argument} away, or write the .glb in a run of its own")));
    }
    let springs = Geometry::springs_or_default(run, options);
    let geometry = Geometry::new(run, options, springs)?;
    let document = Document::new(run, geometry);
    let (frames, bytes) = (shown(run, options), bytes(&document, shown(run, options)));
    let sentence = if frames > MOST_FRAMES {
        format!("would have {frames} frames, and a .glb that moves holds at most {MOST_FRAMES}")
    } else if bytes > MOST_BYTES {
        let mebibytes = bytes >> 20;
        format!("would take {mebibytes} MiB, and a .glb holds at most {} MiB", MOST_BYTES >> 20)
    } else {
        return Ok(document);
    };
    Err(Error::new(Code::TooLarge, sentence)
        .with_fix("make the run shorter, choose one moment with --at, or write a .usdc"))
}

fn open(path: &Path, run: &RunInfo, options: &Options) -> Result<Box<dyn Export>> {
    let in_file = |error: Error| match error.place().file {
        Some(_) => error,
        None => error.in_file(path.display().to_string()),
    };
    let document = plan(run, options).map_err(in_file)?;
    let file = PartialFile::create(path)?;
    let data = Spool::beside(path)?;
    let mut reserve = Reserve::beside(path)?;
    let around = document.tail_bytes(0) + document.text_bytes(0);
    reserve.add(around).map_err(|error| write_error(path, &error))?;
    let clip = Clip { file, data, reserve, document, base: Vec::new(), bounds: Vec::new(), frames: 0 };
    Ok(match options.at {
        None => Box::new(clip),
        Some(at) => Box::new(Still { clip, at, chosen: None }),
    })
}

/// All frames, as shapes that are blended.
struct Clip {
    file: PartialFile,
    data: Spool,
    /// For the description, and for what follows the shapes.
    reserve: Reserve,
    document: Document,
    /// Positions and normals of the first frame.
    base: Vec<Vec3>,
    /// The smallest box around each accessor of positions, frame after frame.
    bounds: Vec<Bounds>,
    frames: u64,
}

impl Clip {
    fn take(&mut self, frame: &Frame<'_>) -> io::Result<()> {
        let mut shape = self.document.shape(frame);
        if self.frames > 0 {
            for (now, first) in shape.iter_mut().zip(&self.base) {
                *now -= *first;
            }
        }
        for vector in &shape {
            let [x, y, z] = vector.to_array().map(f32::to_le_bytes);
            self.data.write_all(&[x, y, z].concat())?;
        }
        let document = &self.document;
        let share = |frames| document.tail_bytes(frames) + document.text_bytes(frames);
        self.reserve.add(share(self.frames + 1) - share(self.frames))?;
        self.data.commit()?;

        self.bounds.extend(self.document.layout.bounds(&shape));
        if self.frames == 0 {
            self.base = shape;
        }
        self.frames += 1;
        Ok(())
    }

    fn complete(mut self, progress: &mut Progress<'_>) -> Result<Written> {
        let path = self.file.path().to_owned();
        self.assemble(progress).map_err(|error| write_error(&path, &error))?;
        Ok(Written { bytes: self.file.finish()?, path, frames: self.frames })
    }

    /// The container: a header of twelve bytes, the description as JSON, the data. Each chunk begins with its length and
    /// its kind and is a multiple of four bytes long ("GLB file format specification" in the glTF 2.0 specification).
    fn assemble(&mut self, progress: &mut Progress<'_>) -> io::Result<()> {
        let Self { file, data, reserve, document, bounds, frames, .. } = self;
        reserve.give_back()?;
        let all = data.whole();
        let tail = document.tail(*frames);
        let mut text = document.text(*frames, bounds, all).into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let data_bytes = all + tail.len() as u64;
        let length = 12 + 8 + text.len() as u64 + 8 + data_bytes;
        let too_large = |_| io::Error::from(io::ErrorKind::FileTooLarge);
        let narrow = |number: u64| u32::try_from(number).map(u32::to_le_bytes).map_err(too_large);

        file.write_all(b"glTF")?;
        file.write_all(&2_u32.to_le_bytes())?;
        file.write_all(&narrow(length)?)?;
        file.write_all(&narrow(text.len() as u64)?)?;
        file.write_all(b"JSON")?;
        file.write_all(&text)?;
        file.write_all(&narrow(data_bytes)?)?;
        file.write_all(b"BIN\0")?;
        let mut done = 0;
        data.move_to(file, &mut |bytes| {
            done += bytes;
            // Asked to break off, it goes on: the motion is all there, and what is left is a copy.
            let _ = progress(done as f64 / all as f64);
        })?;
        file.write_all(&tail)
    }
}

impl Export for Clip {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        if self.frames == MOST_FRAMES {
            let sentence = format!("is full after {MOST_FRAMES} frames, the most that a .glb holds");
            return Err(Error::new(Code::TooLarge, sentence).in_file(self.file.path().display().to_string()));
        }
        self.take(frame).map_err(|error| {
            // What has come of it goes, so that another may be tried. If that fails, so will the end.
            let _ = self.data.roll_back();
            write_error(self.file.path(), &error)
        })
    }

    fn finish(self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        self.complete(progress)
    }
}

/// The frame nearest to a time.
struct Still {
    clip: Clip,
    at: f64,
    chosen: Option<(Snapshot, Params)>,
}

impl Export for Still {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        let off = |time: f64| (time - self.at).abs();
        if self.chosen.as_ref().is_none_or(|(best, _)| off(frame.snapshot.time) <= off(best.time)) {
            self.chosen = Some((frame.snapshot.clone(), frame.params.clone()));
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        if let Some((snapshot, params)) = &self.chosen {
            let frame = Frame { index: 0, snapshot, params, energy: None };
            self.clip.take(&frame).map_err(|error| write_error(self.clip.file.path(), &error))?;
        }
        self.clip.complete(progress)
    }
}
