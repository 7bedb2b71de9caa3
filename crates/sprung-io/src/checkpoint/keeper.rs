//! Checkpoint files: one run at a time may have one, and what replaces an earlier one is whole.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use sprung::{Code, Error, Result};

use super::{AskMemory, Saved, ask};
use crate::files::{self, File, PartialFile, write_error};

/// A checkpoint file that was opened, and not read yet.
#[derive(Debug)]
pub struct Stored {
    path: PathBuf,
    file: File,
    bytes: u64,
}

impl Stored {
    /// Opens a checkpoint to look at it. A run may be writing others in its place meanwhile.
    ///
    /// # Errors
    /// [`Code::Unreadable`] if it is not there, a pipe or a folder.
    pub fn open(path: &Path) -> Result<Self> {
        Self::of(path, files::open_ordinary(path)?)
    }

    fn of(path: &Path, file: File) -> Result<Self> {
        let failed = |error| files::read_error(path, &error);
        let bytes = file.metadata().map_err(failed)?.len();
        Ok(Self { path: path.to_owned(), file, bytes })
    }

    /// Reads it.
    ///
    /// # Errors
    /// Those of `memory` and of [`Saved::read_from`], naming the file.
    pub fn read(&self, memory: &AskMemory<'_>) -> Result<Saved> {
        // At most what it holds, and once more its largest section.
        let read = ask(memory, self.bytes.saturating_mul(2), "the checkpoint")
            .and_then(|()| Saved::read_from(&mut BufReader::with_capacity(1 << 16, &self.file), self.bytes));
        read.map_err(|error| error.in_file(self.path.display().to_string()))
    }
}

/// Keeps the checkpoint of a run: each new one replaces the one before once it is whole, and no other run may have it
/// meanwhile.
#[derive(Debug)]
pub struct Keeper {
    path: PathBuf,
    /// The newest one, locked.
    held: Option<File>,
}

impl Keeper {
    /// Begins with a file that may be there already, and is left alone until the first checkpoint.
    ///
    /// # Errors
    /// [`Code::Unwritable`] if it cannot be written, or belongs to a run that is still going.
    pub fn begin(path: &Path) -> Result<Self> {
        // What PartialFile does not allow is to be known before the run.
        drop(PartialFile::create(path)?);
        let held = if path.exists() { Some(files::hold(path)?) } else { None };
        Ok(Self { path: path.to_owned(), held })
    }

    /// Goes on with the run whose checkpoint this is.
    ///
    /// # Errors
    /// [`Code::Unreadable`] if it is not there, and as [`begin`](Self::begin).
    pub fn resume(path: &Path) -> Result<(Self, Stored)> {
        drop(files::open_ordinary(path)?);
        let held = files::hold(path).map_err(|error| match error.code() {
            Code::Unwritable => error.with_fix("wait until it is over"),
            _ => error,
        })?;
        let again = held.try_clone().map_err(|error| files::read_error(path, &error))?;
        Ok((Self { path: path.to_owned(), held: Some(held) }, Stored::of(path, again)?))
    }

    /// The file's name.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What the file holds now, if there is one.
    ///
    /// # Errors
    /// As [`Stored::read`].
    pub fn stored(&self) -> Result<Option<Stored>> {
        let Some(held) = &self.held else { return Ok(None) };
        let again = held.try_clone().map_err(|error| files::read_error(&self.path, &error))?;
        Stored::of(&self.path, again).map(Some)
    }

    /// Writes a checkpoint in place of the one before, which is there until this one is safely on the disk. Gives its size.
    ///
    /// # Errors
    /// [`Code::Unwritable`]; the one before is still there then.
    pub fn write(&mut self, saved: &Saved) -> Result<u64> {
        if self.held.is_none() && self.path.exists() {
            // It was not there when this run began.
            self.held = Some(files::hold(&self.path)?);
        }
        let mut file = PartialFile::create(&self.path)?;
        saved.write_to(&mut file).map_err(|error| write_error(&self.path, &error))?;
        let file = file.finish_locked()?;
        let bytes = file.metadata().map_err(|error| write_error(&self.path, &error))?.len();
        // Only now is the lock on the earlier one let go.
        self.held = Some(file);
        Ok(bytes)
    }
}

/// The error for a checkpoint that another run keeps.
pub(crate) fn taken(path: &Path) -> Error {
    let error = Error::new(Code::Unwritable, "is the checkpoint of a run that is still going");
    error.in_file(path.display().to_string()).with_fix("wait until it is over, or give another name")
}
