//! Files on the disks of a system.

use std::fs::{OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use same_file::Handle;
use sprung::Result;

use super::{Opening, folder_of, unwritable, write_error};

pub use std::fs::File;

/// Where a file of this name goes: behind a symbolic link, to the file that it leads to, so that the link stays a link.
/// Renaming would put a file in the place of anything else, and be the end of a pipe or a device.
pub(super) fn target_of(path: &Path) -> Result<PathBuf> {
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

/// Gives a file another name, for good.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    std::fs::rename(from, to)?;
    sync_folder_of(to);
    Ok(())
}

/// Makes a file's new name last through a loss of power, where the system can.
fn sync_folder_of(path: &Path) {
    let _ = File::open(folder_of(path)).and_then(|folder| folder.sync_all());
}

/// Removes a file.
pub fn remove(path: &Path) -> io::Result<()> {
    std::fs::remove_file(path)
}

/// Opens or creates a file, locked. `WouldBlock` if somebody else holds the lock, `AlreadyExists` if what has the name is
/// no regular file: opening a pipe would wait for its reader, and a link leads to a file that is not ours.
pub(super) fn open_locked(path: &Path, opening: Opening) -> io::Result<File> {
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
        let still_named = match Handle::from_path(path) {
            Ok(named) => named == Handle::from_file(file.try_clone()?)?,
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

/// Whether files can be begun in a folder, as far as that can be told.
pub fn check_folder(path: &Path) -> io::Result<()> {
    if std::fs::metadata(path)?.is_dir() { Ok(()) } else { Err(io::ErrorKind::NotADirectory.into()) }
}

/// Room that is left on the disk of an output, bytes, where the system tells.
pub fn room_beside(path: &Path) -> Option<u64> {
    fs4::available_space(folder_of(&place_of(path))).ok()
}

/// A name of the disk that an output lies on, the same for all of one disk.
pub fn disk_of(path: &Path) -> Option<String> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        Some(std::fs::metadata(folder_of(&place_of(path))).ok()?.dev().to_string())
    }
    #[cfg(not(unix))]
    {
        Some(place_of(path).components().next()?.as_os_str().to_string_lossy().into_owned())
    }
}

/// Makes a folder; whether it was not there before.
pub fn make_folder(path: &Path) -> io::Result<bool> {
    match std::fs::create_dir(path) {
        Ok(()) => Ok(true),
        Err(_) if path.is_dir() => Ok(false),
        Err(error) => Err(error),
    }
}

/// Removes an empty folder.
pub fn remove_folder(path: &Path) -> io::Result<()> {
    std::fs::remove_dir(path)
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

/// Where a path leads, the same for all its spellings, and whether there is anything yet or not.
pub fn place_of(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| match path.file_name() {
        Some(name) => place_of(folder_of(path)).join(name),
        None => path.to_owned(),
    })
}

/// A file without a name, in a folder or where the system has such.
pub fn temporary(folder: Option<&Path>) -> io::Result<File> {
    folder.map_or_else(tempfile::tempfile, tempfile::tempfile_in)
}

/// Opens a file to read it.
pub fn open(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    if file.metadata()?.is_dir() { Err(io::ErrorKind::IsADirectory.into()) } else { Ok(file) }
}

/// Whether it is something else than a file or a folder.
pub fn is_odd(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir())
}
