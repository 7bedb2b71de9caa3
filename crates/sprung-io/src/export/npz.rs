//! NumPy archives: `numpy.load("run.npz")["positions"]` has the shape (frames, points, 3).
//!
//! An `.npz` file is a zip archive of `.npy` files. How many frames there will be is not known at the start, and no
//! frame is kept in memory: positions grow in their place at the archive's end, while times and velocities wait in
//! temporary files beside it and are moved behind the positions when the run is over.
//!
//! A full disk costs the frame that did not fit and no other. The move takes no more room than it frees, for it goes from
//! the end to the start and shortens the temporary file as it goes; the little that is needed besides is set aside
//! beforehand.
//!
//! In a run with checkpoints the temporary files have names, to be there after a kill, and are copied, not moved: a kill in
//! the middle must leave them whole. Only where the disk is full for that they are moved after all.

use std::io::{self, Seek, SeekFrom, Write};
use std::ops::ControlFlow;
use std::path::Path;

use crc32fast::Hasher;
use sprung::{Result, Vec3};

use super::spool::{PIECE_BYTES, Reserve, put, room_to_put};
use super::stored_zip::{self, StoredZip, header_bytes};
use super::{Estimate, Export, Exporter, FileMark, Frame, Mark, Options, Progress, RunInfo, Writes, Written};
use crate::files::{PartialFile, write_error};

/// `.npz`: arrays `time`, `positions` and `velocities` (frames, points, 3), `springs` and `mass`.
pub const NPZ: Exporter = Exporter {
    ending: "npz",
    description: "NumPy arrays: time, positions, velocities, springs, mass (s, m, m/s, -, kg)",
    heeds: &[],
    writes: Writes::File,
    estimate,
    open,
    resume: Some(resume),
};

/// Length of every `.npy` header: room for any shape, and a multiple of 64 as the format asks.
const NPY_HEADER_BYTES: usize = 128;

/// What the temporary files hold.
const VELOCITIES: &str = "velocities";
const TIMES: &str = "times";

struct NpzExport {
    /// The archive, whose last entry is the positions.
    archive: StoredZip<PartialFile>,
    velocities: PartialFile,
    times: PartialFile,
    /// For what it takes to move the rest behind the positions, and for the archive's directory.
    reserve: Reserve,
    points: u64,
    frames: u64,
    /// Where the positions' numbers begin; what lies before is filled in when the archive is completed.
    head: u64,
    /// What the three arrays hold of whole frames.
    whole: Tallies,
}

/// How much was written of an array, and its checksum.
#[derive(Clone, Debug, Default)]
struct Tally {
    bytes: u64,
    checksum: Hasher,
}

#[derive(Clone, Debug, Default)]
struct Tallies {
    times: Tally,
    positions: Tally,
    velocities: Tally,
}

fn open(path: &Path, run: &RunInfo, options: &Options) -> Result<Box<dyn Export>> {
    let file = PartialFile::create(path)?;
    let [velocities, times] =
        [VELOCITIES, TIMES].map(|part| PartialFile::spool(path, part, options.resumable));
    Ok(Box::new(NpzExport::begin(path, run, file, velocities?, times?)?))
}

fn resume(path: &Path, run: &RunInfo, _: &Options, mark: &Mark) -> Result<Box<dyn Export>> {
    let [file, velocities, times] = mark.files_of(path)?.map(|mark| PartialFile::resume(path, mark));
    let (archive, velocities, times) = (file?, velocities?, times?);
    let (head, frames) = (head_bytes(run), mark.frames);
    let frame_bytes = 12 * run.model.point_count() as u64;
    let [tally_of_positions, tally_of_velocities, tally_of_times] = mark.files_of(path)?.map(Tally::of);
    let is = |tally: &Tally, bytes_each: u64| Some(tally.bytes) == frames.checked_mul(bytes_each);
    let fits = mark.files[0].head == head
        && is(&tally_of_positions, frame_bytes)
        && is(&tally_of_velocities, frame_bytes)
        && is(&tally_of_times, 8);
    if !fits {
        return Err(Mark::strange(path));
    }
    // Everything before the positions is written anew: completing the file had perhaps begun.
    let mut export = NpzExport::begin(path, run, archive, velocities, times)?;
    let room = room_to_put(tally_of_velocities.bytes);
    export.reserve.grow_to(room).map_err(|error| write_error(path, &error))?;
    export.whole =
        Tallies { times: tally_of_times, positions: tally_of_positions, velocities: tally_of_velocities };
    export.frames = frames;
    Ok(Box::new(export))
}

impl NpzExport {
    /// Writes what comes before the frames, which may be there already.
    fn begin(
        path: &Path,
        run: &RunInfo,
        file: PartialFile,
        velocities: PartialFile,
        times: PartialFile,
    ) -> Result<Self> {
        let mut archive = StoredZip::new(file);
        let mut reserve = Reserve::beside(path)?;
        begin(&mut archive, &mut reserve, run).map_err(|error| write_error(path, &error))?;
        let (points, whole) = (run.model.point_count() as u64, Tallies::default());
        let head = head_bytes(run);
        Ok(Self { archive, velocities, times, reserve, points, frames: 0, head, whole })
    }
}

/// Bytes before the numbers of the positions.
fn head_bytes(run: &RunInfo) -> u64 {
    let arrays =
        [("springs.npy", 8 * run.model.spring_count()), ("mass.npy", 4 * run.params.point_mass.len())];
    let before = arrays.iter().map(|(name, bytes)| header_bytes(name) + (NPY_HEADER_BYTES + bytes) as u64);
    before.sum::<u64>() + header_bytes("positions.npy") + NPY_HEADER_BYTES as u64
}

fn estimate(run: &RunInfo, _: &Options) -> Result<Estimate> {
    let (frames, points) = (run.frames, run.model.point_count() as u64);
    let arrays = [
        ("springs.npy", 8 * run.model.spring_count() as u64),
        ("mass.npy", 4 * points),
        ("positions.npy", 12 * points * frames),
        ("time.npy", 8 * frames),
        ("velocities.npy", 12 * points * frames),
    ];
    Ok(Estimate::Exact(stored_zip::size(
        &arrays.map(|(name, bytes)| (name, NPY_HEADER_BYTES as u64 + bytes)),
    )))
}

/// Sets room aside, writes what is known at the start, and begins the positions.
fn begin(archive: &mut StoredZip<PartialFile>, reserve: &mut Reserve, run: &RunInfo) -> io::Result<()> {
    reserve.grow_to(room_to_put(0))?;

    let springs = run.model.springs();
    let ends = springs.iter().flatten().map(|end| end.to_le_bytes());
    write_array(archive, "springs.npy", "<u4", &[springs.len() as u64, 2], ends)?;
    let masses = &run.params.point_mass;
    write_array(
        archive,
        "mass.npy",
        "<f4",
        &[masses.len() as u64],
        masses.iter().map(|mass| mass.to_le_bytes()),
    )?;

    archive.begin("positions.npy")?;
    archive.out().write_all(&[0; NPY_HEADER_BYTES])?; // until the shape is known
    archive.out().commit()
}

impl Export for NpzExport {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        self.take(frame).map_err(|error| write_error(self.archive.out().path(), &error))
    }

    fn finish(mut self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        let path = self.archive.out().path().to_owned();
        let frames = self.frames;
        let (file, spools) = self.complete(progress).map_err(|error| write_error(&path, &error))?;
        let bytes = file.finish()?;
        // Not before: a run that is killed until then needs them.
        spools.into_iter().for_each(PartialFile::discard);
        Ok(Written { bytes, path, frames })
    }

    fn mark(&mut self) -> Result<Mark> {
        let files = self.mark_files().map_err(|error| write_error(self.archive.out().path(), &error))?;
        Ok(Mark { frames: self.frames, files, memory: Vec::new() })
    }
}

impl NpzExport {
    fn take(&mut self, frame: &Frame<'_>) -> io::Result<()> {
        let mut tallies = self.whole.clone();
        self.reserve.grow_to(room_to_put(tallies.velocities.bytes + 12 * self.points))?;
        tallies.times.write(&mut self.times, std::iter::once(frame.snapshot.time.to_le_bytes()))?;
        tallies.positions.write(self.archive.out(), components(&frame.snapshot.positions))?;
        tallies.velocities.write(&mut self.velocities, components(&frame.snapshot.velocities))?;
        // Only what has reached the files counts: what is buffered may not fit on the disk.
        self.times.flush()?;
        self.velocities.flush()?;
        self.archive.out().commit()?;
        self.whole = tallies;
        self.frames += 1;
        Ok(())
    }

    fn mark_files(&mut self) -> io::Result<Vec<FileMark>> {
        self.velocities.roll_back_to(self.whole.velocities.bytes)?;
        self.times.roll_back_to(self.whole.times.bytes)?;
        Ok(vec![
            self.archive.out().mark("", self.head)?,
            self.velocities.mark(VELOCITIES, 0)?,
            self.times.mark(TIMES, 0)?,
        ])
    }

    /// Completes the archive, and gives it and the temporary files.
    fn complete(self, progress: &mut Progress<'_>) -> io::Result<(PartialFile, [PartialFile; 2])> {
        let Self { mut archive, mut velocities, mut times, mut reserve, points, frames, head, whole } = self;
        // Give up what does not belong to a whole frame, and the room that was set aside.
        archive.out().roll_back()?;
        velocities.roll_back_to(whole.velocities.bytes)?;
        times.roll_back_to(whole.times.bytes)?;
        reserve.give_back()?;

        let start = head - NPY_HEADER_BYTES as u64;
        end_array(&mut archive, start, "<f4", &[frames, points, 3], whole.positions)?;

        let start = archive.begin("time.npy")?;
        let bytes = whole.times.bytes;
        let content = start + NPY_HEADER_BYTES as u64;
        put(&mut times, bytes, archive.out(), content, &mut |_| ControlFlow::Continue(()))?;
        end_array(&mut archive, start, "<f8", &[frames], whole.times)?;

        let start = archive.begin("velocities.npy")?;
        let content = start + NPY_HEADER_BYTES as u64;
        put(&mut velocities, whole.velocities.bytes, archive.out(), content, progress)?;
        end_array(&mut archive, start, "<f4", &[frames, points, 3], whole.velocities)?;

        Ok((archive.finish()?, [velocities, times]))
    }
}

/// Writes an array whose numbers are all there.
fn write_array<W: Write + Seek, const N: usize>(
    archive: &mut StoredZip<W>,
    name: &'static str,
    kind: &str,
    shape: &[u64],
    numbers: impl Iterator<Item = [u8; N]>,
) -> io::Result<()> {
    let start = archive.begin(name)?;
    archive.out().write_all(&[0; NPY_HEADER_BYTES])?;
    let mut tally = Tally::default();
    tally.write(archive.out(), numbers)?;
    end_array(archive, start, kind, shape, tally)
}

/// Fills in the header of the array begun last, which starts at `start`, and ends its entry.
fn end_array<W: Write + Seek>(
    archive: &mut StoredZip<W>,
    start: u64,
    kind: &str,
    shape: &[u64],
    tally: Tally,
) -> io::Result<()> {
    let header = npy_header(kind, shape);
    archive.out().seek(SeekFrom::Start(start))?;
    archive.out().write_all(&header)?;
    let mut checksum = Hasher::new();
    checksum.update(&header);
    checksum.combine(&tally.checksum);
    archive.end(NPY_HEADER_BYTES as u64 + tally.bytes, checksum.finalize())
}

impl Tally {
    /// That of what was marked.
    fn of(mark: &FileMark) -> Self {
        let bytes = mark.bytes.saturating_sub(mark.head);
        Self { bytes, checksum: Hasher::new_with_initial_len(mark.crc32, bytes) }
    }

    /// Writes numbers, given as little-endian bytes, and counts them in.
    fn write<const N: usize>(
        &mut self,
        out: &mut impl Write,
        numbers: impl Iterator<Item = [u8; N]>,
    ) -> io::Result<()> {
        let mut piece = Vec::with_capacity(PIECE_BYTES);
        for number in numbers {
            piece.extend_from_slice(&number);
            if piece.len() + N > PIECE_BYTES {
                self.write_bytes(out, &piece)?;
                piece.clear();
            }
        }
        self.write_bytes(out, &piece)
    }

    fn write_bytes(&mut self, out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
        out.write_all(bytes)?;
        self.checksum.update(bytes);
        self.bytes += bytes.len() as u64;
        Ok(())
    }
}

/// The header of a `.npy` file, version 1.0, in C order: the magic string, the length of what follows, a Python
/// dictionary, spaces up to the fixed length, and a line feed.
fn npy_header(kind: &str, shape: &[u64]) -> [u8; NPY_HEADER_BYTES] {
    let shape: String = shape.iter().map(|length| format!("{length}, ")).collect();
    let text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({shape}), }}");
    let mut header = [b' '; NPY_HEADER_BYTES];
    header[..8].copy_from_slice(b"\x93NUMPY\x01\x00");
    header[8..10].copy_from_slice(&(NPY_HEADER_BYTES as u16 - 10).to_le_bytes());
    // At most 10 + 51 + 3·22 + 4 bytes, three lengths of 20 digits each.
    header[10..10 + text.len()].copy_from_slice(text.as_bytes());
    header[NPY_HEADER_BYTES - 1] = b'\n';
    header
}

/// The components of vectors, xyz interleaved, as little-endian bytes.
fn components(vectors: &[Vec3]) -> impl Iterator<Item = [u8; 4]> {
    vectors.iter().flat_map(|vector| vector.to_array().map(f32::to_le_bytes))
}
