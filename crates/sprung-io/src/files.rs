//! The one place that knows paths: outputs grow beside their place and are renamed when whole.

#[cfg(any(test, target_arch = "wasm32"))]
#[cfg_attr(not(target_arch = "wasm32"), expect(dead_code, reason = "its tests run on every system"))]
pub mod memory;
mod reading;
mod resume;
#[cfg(not(target_arch = "wasm32"))]
mod system;

use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use sprung::{Code, Error, Result};

// Where files are: on the disks of a system, or, on a page, which has none, in its memory.
#[cfg(target_arch = "wasm32")]
use memory as disk;
#[cfg(not(target_arch = "wasm32"))]
use system as disk;

pub use disk::{File, disk_of, place_of, remove_beside, room_beside};
use disk::{open_locked, target_of};
pub use reading::{is_handed_over, open_ordinary, read_error, read_or_take, read_ordinary};
pub use resume::{has_no_partial, is_complete, remove_spools};

/// Bytes gathered before they are handed to the system.
const BUFFER_BYTES: usize = 1 << 16;

/// A file that grows as `NAME.partial` and gets its name when it is whole. Dropped unfinished, it is removed.
///
/// Only a regular file is ever replaced: through a symbolic link that is the file it leads to, and a pipe or a device
/// is refused and left alone, be it at the name or at `NAME.partial`.
///
/// While it grows it is locked, so that two runs never mix their output in one file. The `.partial` of a run that was
/// killed is not locked any more, and the next run writes over it.
///
/// A format that can keep what was written before the disk filled up calls [`commit`](Self::commit) after each whole
/// frame and [`roll_back`](Self::roll_back) before it completes the file.
///
/// Once a checkpoint relies on it, by [`mark`](Self::mark), it stays where it is when it is dropped unfinished, and
/// [`resume`](Self::resume) goes on with it.
#[derive(Debug)]
pub struct PartialFile {
    /// The name as the user gave it, for messages.
    path: PathBuf,
    /// Where the file goes: the same, unless that is a symbolic link.
    target: PathBuf,
    partial: PathBuf,
    writer: Option<BufWriter<File>>,
    committed: u64,
    /// What happens to it when it is dropped unfinished.
    fate: Fate,
    /// How much of it the last mark has read, and the checksum of that.
    marked: resume::Marked,
}

/// What becomes of a partial file that is dropped unfinished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    /// It is removed.
    Removed,
    /// It stays: a checkpoint relies on it.
    Stays,
    /// It has no name, and is gone by itself.
    Nameless,
}

impl PartialFile {
    /// Begins `path`, as `path.partial`.
    ///
    /// # Errors
    /// [`Code::Unwritable`], naming the file: its folder is missing or closed to us, it or its partial file is
    /// there and no regular file, or it is being written already.
    pub fn create(path: &Path) -> Result<Self> {
        let target = target_of(path)?;
        let partial = partial_of(path, &target, "")?;
        let file = open_locked(&partial, Opening::Anew).map_err(|error| not_begun(path, &partial, &error))?;
        Ok(Self::new(path, target, partial, file, Fate::Removed))
    }

    /// A temporary file beside an output, on the disk that has room for it. It never gets a name of its own; with `keep` it
    /// grows as `NAME.PART.partial`, to be there after the run was killed, and otherwise it has no name at all.
    ///
    /// # Errors
    /// As [`create`](Self::create), naming the output.
    pub fn spool(path: &Path, part: &str, keep: bool) -> Result<Self> {
        if !keep {
            let file = spool_beside(path)?;
            return Ok(Self::new(path, PathBuf::new(), PathBuf::new(), file, Fate::Nameless));
        }
        let target = target_of(path)?;
        let partial = partial_of(path, &target, part)?;
        let file = open_locked(&partial, Opening::Anew).map_err(|error| not_begun(path, &partial, &error))?;
        Ok(Self::new(path, target, partial, file, Fate::Removed))
    }

    fn new(path: &Path, target: PathBuf, partial: PathBuf, file: File, fate: Fate) -> Self {
        let writer = Some(BufWriter::with_capacity(BUFFER_BYTES, file));
        let marked = resume::Marked::default();
        Self { path: path.to_owned(), target, partial, writer, committed: 0, fate, marked }
    }

    /// The name the file will have, as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The name it has until then.
    pub fn partial_path(&self) -> &Path {
        &self.partial
    }

    /// Writes out what is buffered and remembers this end of the file as one to come back to.
    ///
    /// # Errors
    /// As writing does.
    pub fn commit(&mut self) -> io::Result<()> {
        self.flush()?;
        self.committed = self.writer().seek(SeekFrom::End(0))?;
        Ok(())
    }

    /// Forgets all that was written since the last [`commit`](Self::commit), buffered or not; the next write follows it.
    ///
    /// # Errors
    /// If the system cannot shorten the file.
    pub fn roll_back(&mut self) -> io::Result<()> {
        let Some(writer) = self.writer.take() else { return Ok(()) };
        // Taken apart, not flushed: after a failed write the buffer still holds what did not fit.
        let (mut file, _) = writer.into_parts();
        let result = file.set_len(self.committed).and_then(|()| file.seek(SeekFrom::Start(self.committed)));
        self.writer = Some(BufWriter::with_capacity(BUFFER_BYTES, file));
        result.map(|_| ())
    }

    /// As [`roll_back`](Self::roll_back), to an end of the file that the caller remembers.
    ///
    /// # Errors
    /// If the system cannot shorten the file.
    pub fn roll_back_to(&mut self, bytes: u64) -> io::Result<()> {
        self.committed = bytes;
        self.roll_back()
    }

    /// Writes out what is buffered and reads from there on, to the end of `bytes`.
    ///
    /// # Errors
    /// As reading does. The next write must be preceded by a seek.
    pub fn read_at(&mut self, start: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.flush()?;
        let file = self.writer().get_mut();
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(bytes)
    }

    /// Cuts the file off.
    ///
    /// # Errors
    /// If the system cannot shorten the file.
    pub fn shorten(&mut self, bytes: u64) -> io::Result<()> {
        self.committed = self.committed.min(bytes);
        self.flush()?;
        self.writer().get_mut().set_len(bytes)
    }

    /// Whether it has a name, and so is there after the run was killed.
    pub fn has_name(&self) -> bool {
        self.fate != Fate::Nameless
    }

    /// Moves all that lies from `end` on down to `start`, and cuts the file to its new length. Takes no room.
    ///
    /// # Errors
    /// As reading and writing do.
    pub fn close_gap(&mut self, start: u64, end: u64) -> io::Result<()> {
        self.flush()?;
        let file = self.writer().get_mut();
        let gap = end.saturating_sub(start);
        if gap == 0 {
            return Ok(());
        }
        let (mut place, length) = (end, file.metadata()?.len());
        let mut piece = vec![0; BUFFER_BYTES];
        while place < length {
            let bytes = (length - place).min(BUFFER_BYTES as u64) as usize;
            file.seek(SeekFrom::Start(place))?;
            file.read_exact(&mut piece[..bytes])?;
            file.seek(SeekFrom::Start(place - gap))?;
            file.write_all(&piece[..bytes])?;
            place += bytes as u64;
        }
        file.set_len(length.saturating_sub(gap))
    }

    /// Writes out what is buffered, gives the file its name and tells its size in bytes.
    ///
    /// # Errors
    /// [`Code::Unwritable`], naming the file; nothing is left of it then.
    pub fn finish(mut self) -> Result<u64> {
        let file = self.complete().map_err(|error| write_error(&self.path, &error))?;
        Ok(file.metadata().map_err(|error| write_error(&self.path, &error))?.len())
    }

    /// As [`finish`](Self::finish), and gives the file, still locked.
    ///
    /// # Errors
    /// As [`finish`](Self::finish).
    pub fn finish_locked(mut self) -> Result<File> {
        self.complete().map_err(|error| write_error(&self.path, &error))
    }

    fn complete(&mut self) -> io::Result<File> {
        self.flush()?;
        let file = self.writer().get_ref();
        file.sync_all()?;
        // Renamed while still locked: nobody can take the partial file for an abandoned one in between.
        disk::rename(&self.partial, &self.target)?;
        let writer = self.writer.take().ok_or(io::ErrorKind::NotFound)?;
        Ok(writer.into_parts().0)
    }

    /// Removes the file, whoever relies on it.
    pub fn discard(mut self) {
        if self.fate == Fate::Stays {
            self.fate = Fate::Removed;
        }
    }

    fn writer(&mut self) -> &mut BufWriter<File> {
        self.writer.as_mut().expect("the writer is there until the file is complete")
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        if let Some(writer) = self.writer.take() {
            // Not flushed: what is buffered is of no use any more. Removed before the lock is let go.
            let (file, _) = writer.into_parts();
            if self.fate == Fate::Removed {
                let _ = disk::remove(&self.partial);
            }
            drop(file);
        }
    }
}

impl Write for PartialFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer().flush()
    }
}

impl Seek for PartialFile {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.writer().seek(position)
    }
}

/// The partial file of an output, or one of those beside it.
fn partial_of(path: &Path, target: &Path, part: &str) -> Result<PathBuf> {
    let Some(name) = target.file_name() else {
        return Err(unwritable(path, "cannot be written: it is not a file's name"));
    };
    let mut name = name.to_owned();
    if !part.is_empty() {
        name.push(".");
        name.push(part);
    }
    name.push(".partial");
    Ok(target.with_file_name(name))
}

/// The sentence for a partial file that could not be begun.
fn not_begun(path: &Path, partial: &Path, error: &io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::WouldBlock => {
            unwritable(path, "cannot be written: another output is being written there")
                .with_fix("wait until it is done, or give another name")
        }
        io::ErrorKind::AlreadyExists => {
            let sentence =
                format!("cannot be written: {} is in the way, and is not a regular file", partial.display());
            unwritable(path, sentence).with_fix("remove it, or give another name")
        }
        _ => write_error(path, error),
    }
}

/// What a file is opened for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Opening {
    /// To be written from the start: it is empty.
    Anew,
    /// To go on with: it must be there, and is as it was.
    AsItIs,
    /// The same, to be read only.
    ToRead,
}

/// Looks whether a file of this name can be begun, as far as that can be told without beginning it.
///
/// # Errors
/// As [`PartialFile::create`].
pub fn check(path: &Path) -> Result<()> {
    let target = target_of(path)?;
    disk::check_folder(folder_of(&target)).map_err(|error| write_error(path, &error))
}

/// A folder for files of ours, made if it was not there. When it is dropped, one that was made and is still empty is removed.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    is_new: bool,
}

impl Folder {
    /// Makes sure that there is the folder `path`.
    ///
    /// # Errors
    /// [`Code::Unwritable`], naming it.
    pub fn make(path: &Path) -> Result<Self> {
        match disk::make_folder(path) {
            Ok(is_new) => Ok(Self { path: path.to_owned(), is_new }),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                let sentence = "is to be a folder for the frames, and there is something else of this name";
                Err(unwritable(path, sentence).with_fix("give the output another name"))
            }
            Err(error) => Err(write_error(path, &error)),
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if self.is_new {
            // Fails if there is anything in it, and so it should.
            let _ = disk::remove_folder(&self.path);
        }
    }
}

/// The folder that a file of this name lies in.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A temporary file without a name, in the folder of `path`: on the disk that has room for the output. It is gone when
/// it is dropped, and when the run is killed.
///
/// # Errors
/// [`Code::Unwritable`], naming `path`.
pub fn spool_beside(path: &Path) -> Result<File> {
    // Where the output is a link, its disk is that of the file it leads to.
    disk::temporary(Some(folder_of(&place_of(path)))).map_err(|error| write_error(path, &error))
}

/// A temporary file without a name, in the system's folder for such: for what waits before anybody has said where it is
/// to go. It is gone when it is dropped, and when the run is killed.
///
/// # Errors
/// Those of the system.
pub fn spool() -> io::Result<File> {
    disk::temporary(None)
}

/// Opens a checkpoint and keeps other runs from it.
pub(crate) fn hold(path: &Path) -> Result<File> {
    open_locked(&target_of(path)?, Opening::ToRead).map_err(|error| match error.kind() {
        io::ErrorKind::WouldBlock => crate::checkpoint::taken(path),
        _ => read_error(path, &error),
    })
}

/// The sentence for a file that cannot be written.
pub fn write_error(path: &Path, error: &io::Error) -> Error {
    let reason = match error.kind() {
        io::ErrorKind::StorageFull => "the disk is full",
        io::ErrorKind::QuotaExceeded => "the disk quota is used up",
        io::ErrorKind::FileTooLarge => "it would become larger than a file may be here",
        io::ErrorKind::NotFound => "its folder does not exist",
        io::ErrorKind::NotADirectory => "its folder is not a folder",
        io::ErrorKind::PermissionDenied => "permission denied",
        io::ErrorKind::ReadOnlyFilesystem => "the disk is read-only",
        io::ErrorKind::IsADirectory => "it is a folder",
        io::ErrorKind::InvalidFilename => "its name is too long or not allowed here",
        _ => return unwritable(path, format!("cannot be written: {error}")),
    };
    unwritable(path, format!("cannot be written: {reason}"))
}

fn unwritable(path: &Path, sentence: impl Into<String>) -> Error {
    Error::new(Code::Unwritable, sentence).in_file(path.display().to_string())
}
