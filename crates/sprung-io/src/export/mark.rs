//! How far an output had got when a checkpoint was taken: what it takes to go on with it after a kill.

use std::path::Path;

use sprung::{Code, Error, Result};

use super::sequence::Sequence;
use crate::pack::{Pack, Unpack};

/// How far an output had got: small, and stored in a checkpoint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mark {
    /// Whole frames taken until then.
    pub frames: u64,
    /// Each file that grows, in the format's own order; the output itself is the first.
    pub files: Vec<FileMark>,
    /// What else the format must remember, in its own words; see [`Pack`](crate::Pack).
    pub memory: Vec<u8>,
}

impl Mark {
    /// The files of a format that has so many.
    ///
    /// # Errors
    /// [`Code::Unreadable`], naming the output, if it has another number of them.
    pub fn files_of<const N: usize>(&self, path: &Path) -> Result<[&FileMark; N]> {
        let files: Vec<&FileMark> = self.files.iter().collect();
        files.try_into().map_err(|_| Self::strange(path))
    }

    /// That of a format which is a sequence of files and nothing else.
    pub(super) fn of_sequence(files: &mut Sequence) -> Self {
        let mut memory = Pack::new();
        let frames = files.mark(&mut memory);
        Self { frames, files: Vec::new(), memory: memory.into_bytes() }
    }

    /// The sequence of such a format, to go on with.
    pub(super) fn sequence_of(&self, path: &Path) -> Result<Sequence> {
        let [] = self.files_of(path)?;
        let mut memory = Unpack::new(&self.memory);
        let files = Sequence::resume(path, &mut memory)?;
        memory.end()?;
        if files.frames() != self.frames {
            return Err(Self::strange(path));
        }
        Ok(files)
    }

    /// The error for a mark that a format cannot have made.
    pub fn strange(path: &Path) -> Error {
        let sentence = "cannot be gone on with: what the checkpoint says of it does not fit its format";
        Error::new(Code::Unreadable, sentence).in_file(path.display().to_string())
    }
}

/// How far one growing file had got.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileMark {
    /// What the file holds: `velocities` for `NAME.velocities.partial`; empty for `NAME.partial`, the output itself.
    pub part: String,
    /// Its length, bytes.
    pub bytes: u64,
    /// Bytes at its beginning that are filled in when the file is completed, and so belong to no checksum. Who resumes
    /// the file writes them anew.
    pub head: u64,
    /// CRC-32 of the bytes from there to its end.
    pub crc32: u32,
}
