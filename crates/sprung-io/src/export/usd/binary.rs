//! `.usdc` as it grows on the disk, and `.usdz`, the archive with one of them in it.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use crc32fast::Hasher;
use sprung::{Code, Error, Result};

use super::crate_file::{self, BOOTSTRAP_BYTES, FrameLayout};
use super::layer::{Layer, Span};
use super::package::{self, Package};
use crate::export::spool::{Length, Reserve};
use crate::files::{PartialFile, write_error};

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
        let mut file = PartialFile::create(path)?;
        let mut reserve = Reserve::beside(path)?;
        let rest_bytes = rest_bytes(layer);
        let begun = reserve.add(rest_bytes + package::MOST_BYTES).and_then(|()| {
            // Room for what is known only at the end.
            let start = package.as_ref().map_or(0, Package::content_start);
            file.write_all(&vec![0; (start + BOOTSTRAP_BYTES) as usize])?;
            file.commit()
        });
        begun.map_err(|error| write_error(path, &error))?;
        Ok(Self {
            file,
            package,
            reserve,
            frames: FrameLayout::new(&layer.columns),
            rest_bytes,
            checksum: Hasher::new(),
            whole: Span::default(),
        })
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
