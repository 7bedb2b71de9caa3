//! Frames that wait: pictures need to know the whole motion before the first can be drawn.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use sprung::{Params, Result, Vec3};
use sprung_io::files::write_error;
use sprung_io::{FileMark, Frame, Mark, Pack, PartialFile, RunInfo, Unpack};

use crate::image::Image;
use crate::motion::Motion;
use crate::view::{Quality, SceneView};

/// Bytes of positions that are held in memory while pictures are drawn side by side.
const MEMORY: usize = 256 << 20;
/// Pictures drawn before the next step of progress is told.
const MOST_AT_ONCE: usize = 16;

/// What the temporary file of a run with checkpoints is called after.
const PART: &str = "frames";

/// Positions of every frame so far, in a temporary file beside the output; what is small stays in memory.
pub struct Spool {
    path: PathBuf,
    info: RunInfo,
    file: PartialFile,
    times: Vec<f64>,
    /// Parameters, each with the first frame they hold for.
    params: Vec<(usize, Params)>,
    motion: Motion,
    bytes: Vec<u8>,
}

impl Spool {
    /// Begins a spool in the folder of `path`, for pictures of this size. With `keep` it has a name, so that it is there
    /// after the run was killed.
    pub fn new(path: &Path, info: &RunInfo, size: [u32; 2], keep: bool) -> Result<Self> {
        Ok(Self {
            path: path.to_owned(),
            info: info.clone(),
            file: PartialFile::spool(path, PART, keep)?,
            times: Vec::new(),
            params: Vec::new(),
            motion: Motion::new(info, size),
            bytes: Vec::new(),
        })
    }

    /// Goes on with a spool where it was marked.
    pub fn resume(
        path: &Path,
        info: &RunInfo,
        size: [u32; 2],
        file: &FileMark,
        memory: &[u8],
    ) -> Result<Self> {
        let mut unpack = Unpack::new(memory);
        let motion = Motion::unpack(info, size, &mut unpack)?;
        let times = unpack.f64s()?;
        let mut params = Vec::new();
        for _ in 0..unpack.u64()? {
            let first = unpack.u64()? as usize;
            // The same arrays, not only equal ones: so they are known again.
            let same = unpack.bool()?;
            params.push((first, if same { info.params.clone() } else { unpack.params()? }));
        }
        unpack.end()?;
        let frame_bytes = 12 * info.model.point_count() as u64;
        let is_whole = (times.len() as u64).checked_mul(frame_bytes) == Some(file.bytes);
        let fits = params.iter().all(|(_, params)| params.validate(&info.model).is_ok());
        if !is_whole || !fits || (params.is_empty() && !times.is_empty()) {
            return Err(Mark::strange(path));
        }
        let file = PartialFile::resume(path, file)?;
        Ok(Self { path: path.to_owned(), info: info.clone(), file, times, params, motion, bytes: Vec::new() })
    }

    /// How far it has got: its file, and what else must be remembered.
    pub fn mark(&mut self) -> Result<(FileMark, Vec<u8>)> {
        let whole = self.times.len() as u64 * 12 * self.info.model.point_count() as u64;
        let file = self.file.roll_back_to(whole).and_then(|()| self.file.mark(PART, 0));
        let file = file.map_err(|error| write_error(&self.path, &error))?;
        let mut pack = Pack::new();
        self.motion.pack(&mut pack);
        pack.f64s(&self.times).u64(self.params.len() as u64);
        for (first, params) in &self.params {
            let same = *params == self.info.params;
            pack.u64(*first as u64).u8(same.into());
            if !same {
                pack.params(params);
            }
        }
        Ok((file, pack.into_bytes()))
    }

    /// The output has its name now: nobody needs this any more.
    pub fn discard(self) {
        self.file.discard();
    }

    /// Takes a frame in.
    pub fn push(&mut self, frame: &Frame<'_>) -> Result<()> {
        self.motion.include(&self.info.model, frame.params, &frame.snapshot.positions);
        self.bytes.clear();
        for position in &frame.snapshot.positions {
            for value in position.to_array() {
                self.bytes.extend_from_slice(&value.to_le_bytes());
            }
        }
        let written = self.file.write_all(&self.bytes).and_then(|()| self.file.commit());
        written.map_err(|error| write_error(&self.path, &error))?;
        if self.params.last().is_none_or(|(_, last)| !looks_the_same(last, frame.params)) {
            self.params.push((self.times.len(), frame.params.clone()));
        }
        self.times.push(frame.snapshot.time);
        Ok(())
    }

    /// Time of each frame, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// What the frames are of.
    pub fn info(&self) -> &RunInfo {
        &self.info
    }

    /// The view of the whole motion so far.
    pub fn view(&self) -> SceneView {
        SceneView::new(&self.info, &self.motion, Quality::Motion)
    }

    /// Draws the given frames side by side on all threads, and hands what `make` makes of each on in their order.
    pub fn draw<T: Send>(
        &mut self,
        view: &SceneView,
        frames: &[usize],
        make: impl Fn(Image) -> T + Sync,
        mut each: impl FnMut(usize, T) -> Result<()>,
    ) -> Result<()> {
        let points = self.info.model.point_count();
        let at_once = (MEMORY / (24 * points.max(1))).clamp(1, MOST_AT_ONCE);
        for (chunk_index, chunk) in frames.chunks(at_once).enumerate() {
            let mut moments = Vec::with_capacity(chunk.len());
            for &frame in chunk {
                moments.push((frame, self.read(frame, points)?));
            }
            let (times, params) = (&self.times, &self.params);
            let made: Vec<T> = moments
                .par_iter()
                .map(|(frame, positions)| {
                    let current = params.partition_point(|(first, _)| first <= frame).saturating_sub(1);
                    make(view.picture(&params[current].1, times[*frame], positions))
                })
                .collect();
            for (offset, item) in made.into_iter().enumerate() {
                each(chunk_index * at_once + offset, item)?;
            }
        }
        Ok(())
    }

    fn read(&mut self, frame: usize, points: usize) -> Result<Vec<Vec3>> {
        let start = frame as u64 * points as u64 * 12;
        self.bytes.resize(points * 12, 0);
        self.file.read_at(start, &mut self.bytes).map_err(|error| write_error(&self.path, &error))?;
        let value = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        Ok(self
            .bytes
            .chunks_exact(12)
            .map(|b| Vec3::new(value(&b[..4]), value(&b[4..8]), value(&b[8..])))
            .collect())
    }
}

/// Whether two sets of parameters draw the same picture, judged fast: long arrays are compared by their place alone.
fn looks_the_same(a: &Params, b: &Params) -> bool {
    Arc::ptr_eq(&a.point_mass, &b.point_mass)
        && Arc::ptr_eq(&a.point_pinned, &b.point_pinned)
        && Arc::ptr_eq(&a.spring_stiffness, &b.spring_stiffness)
        && Arc::ptr_eq(&a.spring_rest_length, &b.spring_rest_length)
        && Arc::ptr_eq(&a.spring_cut, &b.spring_cut)
}
