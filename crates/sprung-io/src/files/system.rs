//! What is asked of the operating system beyond the standard library. On a page there is none: every answer is that it cannot.

use std::fs::File;
use std::io;
use std::path::Path;

/// Whether a path still names this file.
#[cfg(not(target_arch = "wasm32"))]
pub fn is_named(path: &Path, file: &File) -> io::Result<bool> {
    let named = same_file::Handle::from_path(path)?;
    Ok(named == same_file::Handle::from_file(file.try_clone()?)?)
}

/// Room that is left on the disk of this folder, bytes.
#[cfg(not(target_arch = "wasm32"))]
pub fn room_in(folder: &Path) -> io::Result<u64> {
    fs4::available_space(folder)
}

/// A file without a name, in this folder or in that for temporary files.
#[cfg(not(target_arch = "wasm32"))]
pub fn nameless(folder: Option<&Path>) -> io::Result<File> {
    folder.map_or_else(tempfile::tempfile, tempfile::tempfile_in)
}

#[cfg(target_arch = "wasm32")]
pub fn is_named(_: &Path, _: &File) -> io::Result<bool> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(target_arch = "wasm32")]
pub fn room_in(_: &Path) -> io::Result<u64> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(target_arch = "wasm32")]
pub fn nameless(_: Option<&Path>) -> io::Result<File> {
    Err(io::ErrorKind::Unsupported.into())
}
