//! Going on with the partial files of a run that was killed.

use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::time::SystemTime;

use crc32fast::Hasher;
use sprung::{Code, Error, Result};

use super::{Fate, Opening, PartialFile, disk, open_locked, partial_of, target_of, write_error};
use crate::export::{FileMark, Mark};

/// Bytes that are read at once.
const PIECE_BYTES: usize = 1 << 16;

/// How much of a partial file the last mark has read, and the checksum of that.
#[derive(Clone, Debug, Default)]
pub(super) struct Marked {
    bytes: u64,
    checksum: Hasher,
}

impl PartialFile {
    /// Puts all that was committed safely on the disk, and says how long the file is and what its content's checksum is:
    /// for [`resume`](Self::resume). What was written since is forgotten. From now on the file stays when it is dropped
    /// unfinished.
    ///
    /// `head` bytes at its beginning are left out of the checksum, as they will be filled in when the file is completed.
    /// The same number must be given each time, and nothing between there and the mark may be written to again.
    ///
    /// # Errors
    /// As writing and reading do.
    pub fn mark(&mut self, part: &str, head: u64) -> io::Result<FileMark> {
        self.roll_back()?;
        let end = self.committed;
        let mut marked = std::mem::take(&mut self.marked);
        let file = self.writer().get_mut();
        file.sync_data()?;
        // Only what is new is read again; that is still in the system's memory.
        let start = marked.bytes.max(head).min(end);
        file.seek(SeekFrom::Start(start))?;
        add(&mut marked.checksum, file, end - start)?;
        file.seek(SeekFrom::Start(end))?;
        marked.bytes = end;
        self.marked = marked;
        if self.fate == Fate::Removed {
            self.fate = Fate::Stays;
        }
        let crc32 = self.marked.checksum.clone().finalize();
        Ok(FileMark { part: part.to_owned(), bytes: end, head, crc32 })
    }

    /// Goes on with the partial file of `path`, or one beside it, where it was marked: what follows is cut off.
    ///
    /// # Errors
    /// [`Code::Unreadable`] if the partial file is gone, shorter than it was, or holds something else; [`Code::Unwritable`]
    /// as [`create`](Self::create), and if the run is still going.
    pub fn resume(path: &Path, mark: &FileMark) -> Result<Self> {
        let target = target_of(path)?;
        let partial = partial_of(path, &target, &mark.part)?;
        let name = partial.display();
        let refused = |sentence: String| {
            let error = Error::new(Code::Unreadable, format!("cannot be gone on with: {sentence}"));
            error.in_file(path.display().to_string())
        };
        let file = open_locked(&partial, Opening::AsItIs).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => refused(format!("{name} is not there")),
            io::ErrorKind::WouldBlock => {
                refused(format!("{name} is still being written")).with_fix("wait until that run is over")
            }
            io::ErrorKind::AlreadyExists => refused(format!("{name} is not a regular file")),
            _ => write_error(path, &error),
        })?;
        // Whatever happens from here on, it stays: it is not ours to remove before the run goes on.
        let mut resumed = Self::new(path, target, partial.clone(), file, Fate::Stays);
        let failed = |error: io::Error| write_error(path, &error);
        let file = resumed.writer().get_mut();
        let found = file.metadata().map_err(failed)?.len();
        if found < mark.bytes {
            let sentence = format!("{name} has {found} of the {} bytes that the run had written", mark.bytes);
            return Err(refused(sentence));
        }
        let mut checksum = Hasher::new();
        let start = mark.head.min(mark.bytes);
        file.seek(SeekFrom::Start(start)).map_err(failed)?;
        add(&mut checksum, file, mark.bytes - start).map_err(failed)?;
        if checksum.clone().finalize() != mark.crc32 {
            return Err(refused(format!("{name} is not what this run had written")));
        }
        file.set_len(mark.bytes).and_then(|()| file.seek(SeekFrom::Start(mark.bytes))).map_err(failed)?;
        resumed.committed = mark.bytes;
        resumed.marked = Marked { bytes: mark.bytes, checksum };
        Ok(resumed)
    }
}

/// Reads so many bytes into a checksum.
fn add(checksum: &mut Hasher, file: &mut impl Read, bytes: u64) -> io::Result<()> {
    let mut piece = vec![0; PIECE_BYTES.min(usize::try_from(bytes).unwrap_or(PIECE_BYTES))];
    let mut left = bytes;
    while left > 0 {
        let piece = &mut piece[..(PIECE_BYTES as u64).min(left) as usize];
        file.read_exact(piece)?;
        checksum.update(piece);
        left -= piece.len() as u64;
    }
    Ok(())
}

/// Whether an output that was being completed when the run was killed has got its name before that: its partial file is
/// gone, and a file of its name was written since the run began.
pub fn is_complete(path: &Path, begun: SystemTime) -> bool {
    let Ok(target) = target_of(path) else { return false };
    let written_since =
        target.metadata().and_then(|found| found.modified()).is_ok_and(|written| written >= begun);
    has_no_partial(path) && written_since
}

/// Whether no partial file of this name is there.
pub fn has_no_partial(path: &Path) -> bool {
    let partial = target_of(path).and_then(|target| partial_of(path, &target, ""));
    partial.is_ok_and(|partial| partial.symlink_metadata().is_err())
}

/// Removes what is left beside an output that has got its name: its mark says what there was.
pub fn remove_spools(path: &Path, mark: &Mark) {
    let Ok(target) = target_of(path) else { return };
    for file in mark.files.iter().filter(|file| !file.part.is_empty()) {
        let Ok(partial) = partial_of(path, &target, &file.part) else { continue };
        // One that is locked is another run's.
        if open_locked(&partial, Opening::AsItIs).is_ok() {
            let _ = disk::remove(&partial);
        }
    }
}
