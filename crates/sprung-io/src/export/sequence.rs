//! A sequence of files, one for each frame: `-o cloth.obj` writes `cloth.0000.obj`, `cloth.0001.obj` and so on.
//!
//! The number is the frame's, with four digits or more, as sequences are named everywhere. Each file appears whole. The
//! name that was asked for stays free, but while the sequence grows `cloth.obj.partial` is locked: two runs do not mix
//! their frames. A finished sequence ends with its last frame: those behind it, which an earlier and longer run left, are
//! removed.

use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use sprung::{Code, Error, Result};

use super::{Mark, Written};
use crate::files::{self, PartialFile, remove_beside, write_error};
use crate::pack::{Pack, Unpack};

/// A sequence being written. Dropped unfinished, the files that it wrote are removed.
#[derive(Debug)]
pub struct Sequence {
    /// Holds the name; never becomes a file.
    lock: PartialFile,
    /// First and last frame that were written.
    range: Option<(u64, u64)>,
    frames: u64,
    bytes: u64,
    /// Its files stay when it is dropped: it is finished, or a checkpoint relies on them.
    stays: bool,
}

impl Sequence {
    /// Begins the sequence that is called `path`.
    ///
    /// # Errors
    /// As [`PartialFile::create`].
    pub fn begin(path: &Path) -> Result<Self> {
        let lock = PartialFile::create(path)?;
        Ok(Self { lock, range: None, frames: 0, bytes: 0, stays: false })
    }

    /// Goes on with a sequence where it was marked. Files of later frames, which are there if the run was killed, will be
    /// written over.
    ///
    /// # Errors
    /// As [`PartialFile::create`], [`sprung::Code::Unreadable`] if files that were written until then are gone or not as
    /// long as they were, and for a memory that [`mark`](Self::mark) has not given.
    pub fn resume(path: &Path, memory: &mut Unpack<'_>) -> Result<Self> {
        let marked = Marked::unpack(memory)?;
        // Before the name is held: it would be let go if this fails, and the sequence then looks like a finished one.
        marked.check(path, None)?;
        let Marked { frames, bytes, range } = marked;
        Ok(Self { lock: PartialFile::create(path)?, range, frames, bytes, stays: true })
    }

    /// Whole frames so far, and what it takes to go on from here. From now on its files stay when it is dropped. They are
    /// on the disk already.
    pub fn mark(&mut self, memory: &mut Pack) -> u64 {
        self.stays = true;
        memory.u64(self.frames).u64(self.bytes).u8(self.range.is_some().into());
        if let Some((first, last)) = self.range {
            memory.u64(first).u64(last);
        }
        self.frames
    }

    /// Whole frames so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The name that was asked for.
    pub fn path(&self) -> &Path {
        self.lock.path()
    }

    /// Writes the file of a frame. One that does not fit leaves nothing behind.
    ///
    /// # Errors
    /// [`sprung::Code::Unwritable`], naming the file.
    pub fn write(
        &mut self,
        frame: u64,
        content: impl FnOnce(&mut PartialFile) -> io::Result<()>,
    ) -> Result<u64> {
        let path = numbered(self.path(), &format!("{frame:04}"));
        let mut file = PartialFile::create(&path)?;
        content(&mut file).map_err(|error| write_error(&path, &error))?;
        let bytes = file.finish()?;
        self.range = Some((self.range.map_or(frame, |(first, _)| first), frame));
        self.frames += 1;
        self.bytes += bytes;
        Ok(bytes)
    }

    /// Removes the file of the frame that was written last, of `bytes`: it turned out not to be whole.
    pub fn take_back(&mut self, bytes: u64) {
        let Some((first, last)) = self.range else { return };
        let _ = std::fs::remove_file(numbered(self.path(), &format!("{last:04}")));
        self.range = (last > first).then(|| (first, last - 1));
        self.frames -= 1;
        self.bytes -= bytes;
    }

    /// Ends the sequence with its last frame.
    ///
    /// # Errors
    /// [`sprung::Code::Unwritable`] if what an earlier run left behind it cannot be removed.
    pub fn finish(mut self) -> Result<Written> {
        self.stays = true;
        if let Some((_, last)) = self.range {
            self.remove(|number| number > last).map_err(|error| write_error(self.path(), &error))?;
        }
        let path = match self.range {
            Some((first, last)) if first == last => numbered(self.path(), &format!("{first:04}")),
            _ => numbered(self.path(), "####"),
        };
        Ok(Written { path, bytes: self.bytes, frames: self.frames })
    }

    /// Removes the files of the sequence whose numbers are such.
    fn remove(&self, which: impl Fn(u64) -> bool) -> io::Result<()> {
        remove_beside(self.path(), |name| Some(which(number_of(self.path(), name)?)))
    }
}

/// What a mark says of a sequence.
struct Marked {
    frames: u64,
    /// All files together.
    bytes: u64,
    /// First and last frame.
    range: Option<(u64, u64)>,
}

impl Marked {
    fn unpack(memory: &mut Unpack<'_>) -> Result<Self> {
        let (frames, bytes) = (memory.u64()?, memory.u64()?);
        let range = if memory.bool()? { Some((memory.u64()?, memory.u64()?)) } else { None };
        Ok(Self { frames, bytes, range })
    }

    /// Whether the files of the frames are there, as long as they were; and no older than the run, where that is asked.
    fn check(&self, path: &Path, begun: Option<SystemTime>) -> Result<()> {
        let refused = |file: &Path, what: &str| {
            let sentence = format!("cannot be gone on with: {} {what}", file.display());
            Err(Error::new(Code::Unreadable, sentence).in_file(path.display().to_string()))
        };
        let mut bytes = 0u64;
        for frame in self.range.into_iter().flat_map(|(first, last)| first..=last) {
            let file = numbered(path, &format!("{frame:04}"));
            let found = match file.symlink_metadata() {
                Ok(found) if found.is_file() => found,
                Ok(_) => return refused(&file, "is not a regular file"),
                Err(_) => return refused(&file, "is not there"),
            };
            let is_older = |begun| found.modified().is_ok_and(|written| written < begun);
            if begun.is_some_and(is_older) {
                return refused(&file, "is older than the run");
            }
            bytes = bytes.saturating_add(found.len());
        }
        if bytes == self.bytes {
            return Ok(());
        }
        let sentence = format!(
            "cannot be gone on with: its files have {bytes} bytes together, and the run had written {}",
            self.bytes
        );
        Err(Error::new(Code::Unreadable, sentence).in_file(path.display().to_string()))
    }
}

/// Whether a sequence that was being completed when the run was killed had been completed before that: nobody holds its
/// name, and its files are those of the mark, written since the run began.
pub fn is_complete(path: &Path, mark: &Mark, begun: SystemTime) -> bool {
    let marked = Marked::unpack(&mut Unpack::new(&mark.memory));
    files::has_no_partial(path) && marked.is_ok_and(|marked| marked.check(path, Some(begun)).is_ok())
}

impl Drop for Sequence {
    fn drop(&mut self) {
        if let Some((first, last)) = self.range.filter(|_| !self.stays) {
            let _ = self.remove(|number| (first..=last).contains(&number));
        }
    }
}

/// The name of one file: `cloth.0012.obj` for `cloth.obj` and `0012`.
fn numbered(path: &Path, number: &str) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(".");
    name.push(number);
    if let Some(ending) = path.extension() {
        name.push(".");
        name.push(ending);
    }
    path.with_file_name(name)
}

/// Whether a file of this name, in the folder of `path`, is of the sequence that is called so.
pub fn has(path: &Path, name: &str) -> bool {
    number_of(path, name).is_some()
}

/// The frame that a file of this name has in the sequence that is called `path`.
fn number_of(path: &Path, name: &str) -> Option<u64> {
    let [before, after] = around(path);
    let digits = name.strip_prefix(&*before)?.strip_suffix(&*after)?;
    let number: u64 = digits.parse().ok()?;
    (format!("{number:04}") == digits).then_some(number)
}

/// What is before and after the number in the names of a sequence's files.
fn around(path: &Path) -> [String; 2] {
    let text = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    [text(path.file_stem()) + ".", format!(".{}", text(path.extension()))]
}
