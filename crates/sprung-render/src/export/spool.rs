//! Frames that wait: pictures need to know the whole motion before the first can be drawn.

use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use sprung::{Params, Result, Vec3};
use sprung_io::files::{spool_beside, write_error};
use sprung_io::{Frame, RunInfo};

use crate::image::Image;
use crate::motion::Motion;
use crate::view::{Quality, SceneView};

/// Bytes of positions that are held in memory while pictures are drawn side by side.
const MEMORY: usize = 256 << 20;
/// Pictures drawn before the next step of progress is told.
const MOST_AT_ONCE: usize = 16;

/// Positions of every frame so far, in a file without a name beside the output; what is small stays in memory.
pub struct Spool {
    path: PathBuf,
    info: RunInfo,
    file: BufWriter<File>,
    times: Vec<f64>,
    /// Parameters, each with the first frame they hold for.
    params: Vec<(usize, Params)>,
    motion: Motion,
    bytes: Vec<u8>,
}

impl Spool {
    /// Begins a spool in the folder of `path`, for pictures of this size.
    pub fn new(path: &Path, info: &RunInfo, size: [u32; 2]) -> Result<Self> {
        Ok(Self {
            path: path.to_owned(),
            info: info.clone(),
            file: BufWriter::with_capacity(1 << 18, spool_beside(path)?),
            times: Vec::new(),
            params: Vec::new(),
            motion: Motion::new(info, size),
            bytes: Vec::new(),
        })
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
        self.file.write_all(&self.bytes).map_err(|error| write_error(&self.path, &error))?;
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
        let bytes = &mut self.bytes;
        let read = self.file.flush().and_then(|()| {
            let file = self.file.get_mut();
            file.seek(SeekFrom::Start(start))?;
            file.read_exact(bytes)
        });
        read.map_err(|error| write_error(&self.path, &error))?;
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
