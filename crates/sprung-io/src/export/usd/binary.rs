//! `.usdc` as it grows on the disk, and `.usdz`, the archive with one of them in it.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use crc32fast::Hasher;
use sprung::{Code, Error, Result};

use super::crate_file::{self, BOOTSTRAP_BYTES, FrameLayout};
use super::layer::{Layer, Span};
use super::package::{self, Package};
use crate::export::Mark;
use crate::export::spool::{Length, Reserve};
use crate::files::{PartialFile, write_error};
use crate::pack::{Pack, Unpack};

/// How long a file with so many frames is, to the byte.
pub fn bytes(layer: &Layer, package: Option<&Package>, frames: u64) -> u64 {
    let layout = FrameLayout::new(&layer.columns);
    let around = package.map_or(0, Package::bytes_around);
    around + BOOTSTRAP_BYTES + rest_bytes(layer) + frames * (layout.bytes + layout.table_bytes())
}

/// What the rest takes when there is no frame; each adds its share of the tables.
fn rest_bytes(layer: &Layer) -> u64 {
    let mut rest = Length(0);
    // It takes everything.
    let _ = crate_file::write_rest(&mut rest, layer, Span::default());
    rest.0
}

/// What lies before the first frame, and is filled in when the file is completed.
fn head_bytes(package: Option<&Package>) -> u64 {
    package.map_or(0, Package::content_start) + BOOTSTRAP_BYTES
}

/// A crate being written, alone or in an archive.
pub struct Binary {
    file: PartialFile,
    package: Option<Package>,
    /// For the tables at the end.
    reserve: Reserve,
    frames: FrameLayout,
    rest_bytes: u64,
    /// Of what follows the bootstrap; only an archive needs it.
    checksum: Hasher,
    whole: Span,
}

impl Binary {
    /// Begins a file for frames of this layer: an archive if `package` says how the file in it is called.
    pub fn create(path: &Path, layer: &Layer, package: Option<Package>) -> Result<Self> {
        let file = PartialFile::create(path)?;
        let mut begun = Self::with(path, layer, package, file)?;
        // Room for what is known only at the end.
        let head = vec![0; begun.head_bytes() as usize];
        let written = begun.file.write_all(&head).and_then(|()| begun.file.commit());
        written.map_err(|error| write_error(path, &error))?;
        Ok(begun)
    }

    /// Goes on with a file where it was marked. What was at its head is filled in again when it is completed.
    pub fn resume(path: &Path, layer: &Layer, package: Option<Package>, mark: &Mark) -> Result<Self> {
        let [file] = mark.files_of(path)?;
        let mut memory = Unpack::new(&mark.memory);
        let first = memory.u64()?;
        memory.end()?;
        let content = mark.frames.checked_mul(FrameLayout::new(&layer.columns).bytes);
        let fits = file.head == head_bytes(package.as_ref())
            && content.is_some()
            && content == file.bytes.checked_sub(file.head)
            && first.checked_add(mark.frames).is_some();
        if !fits {
            return Err(Mark::strange(path));
        }
        let mut resumed = Self::with(path, layer, package, PartialFile::resume(path, file)?)?;
        let tables = mark.frames * resumed.frames.table_bytes();
        resumed.reserve.add(tables).map_err(|error| write_error(path, &error))?;
        resumed.whole = Span { first, count: mark.frames };
        // What was marked is what follows the bootstrap.
        resumed.checksum = Hasher::new_with_initial_len(file.crc32, file.bytes - file.head);
        Ok(resumed)
    }

    /// One without frames, in this file.
    fn with(path: &Path, layer: &Layer, package: Option<Package>, file: PartialFile) -> Result<Self> {
        let mut reserve = Reserve::beside(path)?;
        let rest_bytes = rest_bytes(layer);
        reserve.add(rest_bytes + package::MOST_BYTES).map_err(|error| write_error(path, &error))?;
        let frames = FrameLayout::new(&layer.columns);
        let (checksum, whole) = (Hasher::new(), Span::default());
        Ok(Self { file, package, reserve, frames, rest_bytes, checksum, whole })
    }

    /// How far it has got.
    pub fn mark(&mut self) -> io::Result<Mark> {
        let file = self.file.mark("", self.head_bytes())?;
        let mut memory = Pack::new();
        memory.u64(self.whole.first);
        Ok(Mark { frames: self.whole.count, files: vec![file], memory: memory.into_bytes() })
    }

    /// The frames that are in it.
    pub fn span(&self) -> Span {
        self.whole
    }

    fn head_bytes(&self) -> u64 {
        head_bytes(self.package.as_ref())
    }

    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Takes the columns of one more frame.
    pub fn frame(&mut self, index: u64, columns: &[Vec<[f32; 3]>]) -> Result<()> {
        if self.package.is_some() && self.bytes_with(self.whole.count + 1) > package::MOST_CONTENT_BYTES {
            return Err(self.archive_is_full());
        }
        self.take(index, columns).map_err(|error| {
            // What has come of it goes, so that another may be tried. If that fails, so will the end.
            let _ = self.file.roll_back();
            write_error(self.file.path(), &error)
        })
    }

    fn take(&mut self, index: u64, columns: &[Vec<[f32; 3]>]) -> io::Result<()> {
        let mut out = Summed { out: &mut self.file, checksum: None };
        if self.package.is_some() {
            out.checksum = Some(self.checksum.clone());
        }
        columns.iter().try_for_each(|column| crate_file::write_column(&mut out, column))?;
        let checksum = out.checksum;
        self.reserve.add(self.frames.table_bytes())?;
        self.file.commit()?;

        self.checksum = checksum.unwrap_or_default();
        if self.whole.count == 0 {
            self.whole.first = index;
        }
        self.whole.count += 1;
        Ok(())
    }

    /// How long the crate will be with so many frames.
    fn bytes_with(&self, frames: u64) -> u64 {
        BOOTSTRAP_BYTES + self.rest_bytes + frames * (self.frames.bytes + self.frames.table_bytes())
    }

    fn archive_is_full(&self) -> Error {
        let frames = self.whole.count;
        let sentence = format!("is full after {frames} frames: a .usdz holds at most 4 GiB");
        Error::new(Code::TooLarge, sentence)
            .in_file(self.file.path().display().to_string())
            .with_fix("write a .usdc, which may be of any size")
    }

    /// Completes the file and tells how many bytes and frames it has.
    pub fn finish(mut self, layer: &Layer) -> Result<(u64, u64)> {
        self.complete(layer).map_err(|error| write_error(self.file.path(), &error))?;
        let frames = self.whole.count;
        Ok((self.file.finish()?, frames))
    }

    fn complete(&mut self, layer: &Layer) -> io::Result<()> {
        // Give up what does not belong to a whole frame, and the room that was set aside.
        self.file.roll_back()?;
        self.reserve.give_back()?;
        let checksum = self.package.is_some().then(|| self.checksum.clone());
        let mut out = Summed { out: &mut self.file, checksum };
        let contents = crate_file::write_rest(&mut out, layer, self.whole)?;
        let after_bootstrap = out.checksum;
        let bootstrap = crate_file::bootstrap(contents);

        let start = self.package.as_ref().map_or(0, Package::content_start);
        let end = self.file.stream_position()?;
        self.file.seek(SeekFrom::Start(start))?;
        self.file.write_all(&bootstrap)?;
        if let (Some(package), Some(after_bootstrap)) = (&self.package, after_bootstrap) {
            let mut checksum = Hasher::new();
            checksum.update(&bootstrap);
            checksum.combine(&after_bootstrap);
            package.close(&mut self.file, end - start, checksum.finalize())?;
        }
        Ok(())
    }
}

/// A writer that sums up what goes through it, if it is to.
struct Summed<'a> {
    out: &'a mut PartialFile,
    checksum: Option<Hasher>,
}

impl Write for Summed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        if let Some(checksum) = &mut self.checksum {
            checksum.update(&bytes[..written]);
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
