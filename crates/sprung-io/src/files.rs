//! The one place that knows paths: outputs grow beside their place and are renamed when whole.

mod resume;
mod system;

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use sprung::{Code, Error, Result};

pub use resume::{is_complete, remove_spools};

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
        std::fs::rename(&self.partial, &self.target)?;
        sync_folder_of(&self.target);
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
                let _ = std::fs::remove_file(&self.partial);
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

/// Where a file of this name goes: behind a symbolic link, to the file that it leads to, so that the link stays a link.
/// Renaming would put a file in the place of anything else, and be the end of a pipe or a device.
fn target_of(path: &Path) -> Result<PathBuf> {
    if path.is_dir() {
        return Err(unwritable(path, "cannot be written: it is a folder").with_fix("give a file's name"));
    }
    if path.file_name().is_none() {
        return Err(unwritable(path, "cannot be written: it is not a file's name"));
    }
    let refused =
        |why: &str| Err(unwritable(path, format!("cannot be written: {why}")).with_fix("give another name"));
    let found = match path.symlink_metadata() {
        Ok(found) => found,
        // A missing folder is found out when the file is opened.
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(path.to_owned()),
        Err(error) => return Err(write_error(path, &error)),
    };
    let target = if found.is_symlink() { path.canonicalize().ok() } else { Some(path.to_owned()) };
    match target {
        None => refused("it is a link that leads to no file"),
        Some(target) if target.is_file() => Ok(target),
        Some(_) => refused("it is not a regular file"),
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

/// Makes a file's new name last through a loss of power, where the system can.
fn sync_folder_of(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
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

/// Opens or creates a file, locked. `WouldBlock` if somebody else holds the lock, `AlreadyExists` if what has the name is
/// no regular file: opening a pipe would wait for its reader, and a link leads to a file that is not ours.
fn open_locked(path: &Path, opening: Opening) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true).write(opening != Opening::ToRead);
    loop {
        let opened = match path.symlink_metadata() {
            // Not truncated before it is ours: it may be another run's.
            Ok(found) if found.is_file() => options.open(path),
            Ok(_) => return Err(io::ErrorKind::AlreadyExists.into()),
            Err(error) if opening != Opening::Anew => return Err(error),
            Err(_) => options.clone().create_new(true).open(path),
        };
        let file = match opened {
            Ok(file) => file,
            // Another run created or completed it since we looked: look again.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            Err(error) if error.kind() == io::ErrorKind::NotFound && path.symlink_metadata().is_ok() => {
                continue;
            }
            Err(error) => return Err(error),
        };
        lock(&file)?;
        // Another run may have completed and renamed the file between our opening and our lock. Then what we hold is
        // its finished output, and the partial name is free: try again.
        let still_named = match system::is_named(path, &file) {
            Ok(still_named) => still_named,
            Err(error) if error.kind() == io::ErrorKind::NotFound => false,
            Err(error) => return Err(error),
        };
        if still_named {
            if opening == Opening::Anew {
                file.set_len(0)?;
            }
            return Ok(file);
        }
    }
}

/// Locks a file. `WouldBlock` if somebody else has.
fn lock(file: &File) -> io::Result<()> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(io::ErrorKind::WouldBlock.into()),
        // Some network file systems know no locks; there, the last writer wins.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Looks whether a file of this name can be begun, as far as that can be told without beginning it.
///
/// # Errors
/// As [`PartialFile::create`].
pub fn check(path: &Path) -> Result<()> {
    let target = target_of(path)?;
    match std::fs::metadata(folder_of(&target)) {
        Ok(folder) if folder.is_dir() => Ok(()),
        Ok(_) => Err(write_error(path, &io::ErrorKind::NotADirectory.into())),
        Err(error) => Err(write_error(path, &error)),
    }
}

/// Room that is left on the disk of an output, bytes, where the system tells.
pub fn room_beside(path: &Path) -> Option<u64> {
    system::room_in(folder_of(path)).ok()
}

/// A name of the disk that an output lies on, the same for all of one disk.
pub fn disk_of(path: &Path) -> Option<String> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        Some(std::fs::metadata(folder_of(path)).ok()?.dev().to_string())
    }
    #[cfg(not(unix))]
    {
        let folder = folder_of(path).canonicalize().ok()?;
        Some(folder.components().next()?.as_os_str().to_string_lossy().into_owned())
    }
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
        match std::fs::create_dir(path) {
            Ok(()) => Ok(Self { path: path.to_owned(), is_new: true }),
            Err(_) if path.is_dir() => Ok(Self { path: path.to_owned(), is_new: false }),
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
            let _ = std::fs::remove_dir(&self.path);
        }
    }
}

/// Removes the regular files in the folder of `path` whose names `is_meant` says `Some(true)` to.
///
/// # Errors
/// If the folder cannot be read, or such a file cannot be removed.
pub fn remove_beside(path: &Path, is_meant: impl Fn(&str) -> Option<bool>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder_of(path))? {
        let entry = entry?;
        let is_named_so = entry.file_name().to_str().and_then(&is_meant) == Some(true);
        if is_named_so && entry.file_type()?.is_file() {
            std::fs::remove_file(entry.path())?;
        }
    }
    Ok(())
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
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    system::nameless(Some(folder_of(&target))).map_err(|error| write_error(path, &error))
}

/// A temporary file without a name, in the system's folder for such: for what waits before anybody has said where it is
/// to go. It is gone when it is dropped, and when the run is killed.
///
/// # Errors
/// Those of the system.
pub fn spool() -> io::Result<File> {
    system::nameless(None)
}

/// Reads a file of at most `most` bytes; a larger one is refused unread.
///
/// # Errors
/// [`Code::Unreadable`] or [`Code::TooLarge`], naming the file.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>> {
    let failed = |error: io::Error| read_error(path, &error);
    let file = File::open(path).map_err(failed)?;
    if file.metadata().map_err(failed)?.is_dir() {
        return Err(failed(io::ErrorKind::IsADirectory.into()));
    }
    // One byte beyond the limit tells that there is more, also where no length is known beforehand, as of a pipe.
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > most {
        let sentence = format!("is larger than the {} MiB allowed", most >> 20);
        return Err(Error::new(Code::TooLarge, sentence).in_file(path.display().to_string()));
    }
    Ok(bytes)
}

/// As [`read`], of an ordinary file only: a pipe or a device could keep a window waiting for ever.
///
/// # Errors
/// As [`read`].
pub fn read_ordinary(path: &Path, most: u64) -> Result<Vec<u8>> {
    check_ordinary(path)?;
    read(path, most)
}

/// Opens an ordinary file to read it.
///
/// # Errors
/// [`Code::Unreadable`], naming the file.
pub fn open_ordinary(path: &Path) -> Result<File> {
    check_ordinary(path)?;
    let file = File::open(path).map_err(|error| read_error(path, &error))?;
    match file.metadata() {
        Ok(found) if found.is_dir() => Err(read_error(path, &io::ErrorKind::IsADirectory.into())),
        Ok(_) => Ok(file),
        Err(error) => Err(read_error(path, &error)),
    }
}

fn check_ordinary(path: &Path) -> Result<()> {
    let is_odd = std::fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir());
    if is_odd {
        let error = Error::new(Code::Unreadable, "is a pipe or a device, and must be an ordinary file");
        return Err(error.in_file(path.display().to_string()));
    }
    Ok(())
}

/// Opens a checkpoint and keeps other runs from it.
pub(crate) fn hold(path: &Path) -> Result<File> {
    open_locked(&target_of(path)?, Opening::ToRead).map_err(|error| match error.kind() {
        io::ErrorKind::WouldBlock => crate::checkpoint::taken(path),
        _ => read_error(path, &error),
    })
}

/// The sentence for a file that cannot be read.
pub fn read_error(path: &Path, error: &io::Error) -> Error {
    let reason = match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "cannot be read: permission denied".to_owned(),
        io::ErrorKind::IsADirectory => "is a folder, and must be a file".to_owned(),
        _ => format!("cannot be read: {error}"),
    };
    Error::new(Code::Unreadable, reason).in_file(path.display().to_string())
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
