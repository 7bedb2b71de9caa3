//! `.glb`: glTF 2.0 in its binary form, for the web, Blender and game engines.
//!
//! glTF knows no meshes whose points move freely, but shapes that are blended ("morph targets"): each frame becomes one,
//! as differences from the first, and an animation blends from each to the next. Readers keep all of them in memory, often
//! as layers of one texture, so this is for short clips; with `--at` it is the still shape of one moment.
//!
//! The description of the data comes first in the file and is known last: the data grow in a temporary file. In a run with
//! checkpoints it has a name, and is copied, as that of an `.npz`.

mod document;

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use sprung::{Code, Error, Params, Result, Snapshot, Vec3};

use self::document::{Bounds, Document};
use super::spool::{Reserve, put, room_to_put};
use super::{
    Estimate, Export, Exporter, Frame, Geometry, Heeds, Mark, Options, Progress, RunInfo, Up, Writes, Written,
};
use crate::files::{PartialFile, write_error};
use crate::pack::{Pack, Unpack};

/// `.glb`: a short clip, or the shape at one moment.
pub const GLB: Exporter = Exporter {
    ending: "glb",
    description: "glTF: a clip of at most 257 frames, or the shape nearest to --at, for the web and game engines",
    heeds: &[Heeds::At, Heeds::Geometry, Heeds::Springs],
    writes: Writes::File,
    estimate,
    open,
    resume: Some(resume),
};

/// The first frame and 256 shapes: the fewest layers of a texture that browsers promise (WebGL 2, MAX_ARRAY_TEXTURE_LAYERS).
const MOST_FRAMES: u64 = 257;
/// What readers can be expected to hold in memory at once.
const MOST_BYTES: u64 = 1 << 30;
/// What the temporary file holds.
const SHAPES: &str = "shapes";

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
    let document = plan_of(path, run, options)?;
    let file = PartialFile::create(path)?;
    let data = PartialFile::spool(path, SHAPES, options.resumable)?;
    let clip = Clip::new(path, document, file, data)?;
    Ok(match options.at {
        None => Box::new(clip),
        Some(at) => Box::new(Still { clip, at, chosen: None, frames: 0 }),
    })
}

/// As [`plan`], and an error names the file.
fn plan_of(path: &Path, run: &RunInfo, options: &Options) -> Result<Document> {
    plan(run, options).map_err(|error| match error.place().file {
        Some(_) => error,
        None => error.in_file(path.display().to_string()),
    })
}

fn resume(path: &Path, run: &RunInfo, options: &Options, mark: &Mark) -> Result<Box<dyn Export>> {
    let document = plan_of(path, run, options)?;
    let [file, data] = mark.files_of(path)?;
    // Nothing is in the file before it is completed, and of a still nothing in the other either.
    let shapes = if options.at.is_some() { 0 } else { mark.frames };
    let fits = (file.bytes, data.head) == (0, 0)
        && shapes <= MOST_FRAMES
        && document.layout.frame_bytes().checked_mul(shapes) == Some(data.bytes);
    let mut memory = Unpack::new(&mark.memory);
    let chosen = match options.at.is_some() && memory.bool()? {
        true => Some((memory.snapshot()?, memory.params()?)),
        false => None,
    };
    memory.end()?;
    let is_of_run = |(snapshot, params): &(Snapshot, Params)| {
        let points = run.model.point_count();
        [&snapshot.positions, &snapshot.velocities].iter().all(|vectors| vectors.len() == points)
            && params.validate(&run.model).is_ok()
    };
    if !fits || !chosen.iter().all(is_of_run) {
        return Err(Mark::strange(path));
    }
    let [file, data] = [file, data].map(|mark| PartialFile::resume(path, mark));
    let mut clip = Clip::new(path, document, file?, data?)?;
    clip.read_back(shapes).map_err(|error| write_error(path, &error))?;
    Ok(match options.at {
        None => Box::new(clip),
        Some(at) => Box::new(Still { clip, at, chosen, frames: mark.frames }),
    })
}

/// What so many frames take besides their shapes, at most.
fn share(document: &Document, frames: u64) -> u64 {
    let shapes = document.layout.frame_bytes() * frames;
    document.tail_bytes(frames) + document.text_bytes(frames) + room_to_put(shapes)
}

/// All frames, as shapes that are blended.
struct Clip {
    file: PartialFile,
    /// The shapes so far.
    data: PartialFile,
    /// For the description, for what follows the shapes, and for the pieces that are moved.
    reserve: Reserve,
    document: Document,
    /// Positions and normals of the first frame.
    base: Vec<Vec3>,
    /// The smallest box around each accessor of positions, frame after frame.
    bounds: Vec<Bounds>,
    frames: u64,
}

impl Clip {
    /// One without frames.
    fn new(path: &Path, document: Document, file: PartialFile, data: PartialFile) -> Result<Self> {
        let mut reserve = Reserve::beside(path)?;
        reserve.add(share(&document, 0)).map_err(|error| write_error(path, &error))?;
        Ok(Self { file, data, reserve, document, base: Vec::new(), bounds: Vec::new(), frames: 0 })
    }

    /// Goes on after the shapes that are there.
    fn read_back(&mut self, frames: u64) -> io::Result<()> {
        let mut bytes = vec![0; self.document.layout.frame_bytes() as usize];
        for frame in 0..frames {
            self.data.read_at(frame * bytes.len() as u64, &mut bytes)?;
            let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
            let vector = |b: &[u8]| Vec3::new(float(&b[..4]), float(&b[4..8]), float(&b[8..]));
            let shape: Vec<Vec3> = bytes.chunks_exact(12).map(vector).collect();
            self.count_in(shape);
        }
        self.data.seek(SeekFrom::End(0))?;
        self.reserve.grow_to(share(&self.document, frames))
    }

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
        self.reserve.grow_to(share(&self.document, self.frames + 1))?;
        self.data.commit()?;
        self.count_in(shape);
        Ok(())
    }

    /// Counts a shape that has been written.
    fn count_in(&mut self, shape: Vec<Vec3>) {
        self.bounds.extend(self.document.layout.bounds(&shape));
        if self.frames == 0 {
            self.base = shape;
        }
        self.frames += 1;
    }

    fn complete(mut self, progress: &mut Progress<'_>) -> Result<Written> {
        let path = self.file.path().to_owned();
        self.assemble(progress).map_err(|error| write_error(&path, &error))?;
        let bytes = self.file.finish()?;
        // Not before: a run that is killed until then needs it.
        self.data.discard();
        Ok(Written { bytes, path, frames: self.frames })
    }

    /// The container: a header of twelve bytes, the description as JSON, the data. Each chunk begins with its length and
    /// its kind and is a multiple of four bytes long ("GLB file format specification" in the glTF 2.0 specification).
    fn assemble(&mut self, progress: &mut Progress<'_>) -> io::Result<()> {
        let Self { file, data, reserve, document, bounds, frames, .. } = self;
        data.roll_back()?;
        let all = document.layout.frame_bytes() * *frames;
        let tail = document.tail(*frames);
        reserve.give_back_to(tail.len() as u64)?;
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
        let start = file.stream_position()?;
        put(data, all, file, start, progress)?;
        reserve.give_back()?;
        file.seek(SeekFrom::End(0))?;
        file.write_all(&tail)
    }

    fn mark_with(&mut self, frames: u64, memory: Pack) -> Result<Mark> {
        let marked = self.file.mark("", 0).and_then(|file| Ok(vec![file, self.data.mark(SHAPES, 0)?]));
        let files = marked.map_err(|error| write_error(self.file.path(), &error))?;
        Ok(Mark { frames, files, memory: memory.into_bytes() })
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

    fn mark(&mut self) -> Result<Mark> {
        self.mark_with(self.frames, Pack::new())
    }
}

/// The frame nearest to a time.
struct Still {
    clip: Clip,
    at: f64,
    chosen: Option<(Snapshot, Params)>,
    /// Looked at so far.
    frames: u64,
}

impl Export for Still {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        let off = |time: f64| (time - self.at).abs();
        if self.chosen.as_ref().is_none_or(|(best, _)| off(frame.snapshot.time) <= off(best.time)) {
            self.chosen = Some((frame.snapshot.clone(), frame.params.clone()));
        }
        self.frames += 1;
        Ok(())
    }

    fn mark(&mut self) -> Result<Mark> {
        let mut memory = Pack::new();
        memory.u8(self.chosen.is_some().into());
        if let Some((snapshot, params)) = &self.chosen {
            memory.snapshot(snapshot).params(params);
        }
        self.clip.mark_with(self.frames, memory)
    }

    fn finish(mut self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        if let Some((snapshot, params)) = &self.chosen {
            let frame = Frame { index: 0, snapshot, params, energy: None };
            self.clip.take(&frame).map_err(|error| write_error(self.clip.file.path(), &error))?;
        }
        self.clip.complete(progress)
    }
}
