//! Reading files, and which of them.

use std::io::{self, Read};
use std::path::Path;

use sprung::{Code, Error, Result};

use super::{File, disk};

/// Names under which a program finds its own standard input.
const STANDARD_INPUT: [&str; 3] = ["/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"];

/// Reads a file of at most `most` bytes; a larger one is refused unread. It must be an ordinary file: a pipe or a device
/// could be waited for for ever.
///
/// # Errors
/// [`Code::Unreadable`] or [`Code::TooLarge`], naming the file.
pub fn read_ordinary(path: &Path, most: u64) -> Result<Vec<u8>> {
    read(open_ordinary(path)?, path, most)
}

/// As [`read_ordinary`], and of what the shell hands over, as in `<(…)`: somebody writes into that, or has.
///
/// # Errors
/// As [`read_ordinary`].
pub fn read_or_take(path: &Path, most: u64) -> Result<Vec<u8>> {
    if !is_handed_over(path) {
        return read_ordinary(path, most);
    }
    if STANDARD_INPUT.iter().any(|name| path == Path::new(name)) {
        // Not opened anew: of a named pipe that would wait for another who writes.
        return read(io::stdin().lock(), path, most);
    }
    read(disk::open(path).map_err(|error| read_error(path, &error))?, path, most)
}

/// Whether a path is that of a file which this program was started with: its standard input, or a numbered one.
pub fn is_handed_over(path: &Path) -> bool {
    cfg!(unix)
        && (path == Path::new("/dev/stdin")
            || path.starts_with("/dev/fd")
            || path.starts_with("/proc/self/fd"))
}

fn read(from: impl Read, path: &Path, most: u64) -> Result<Vec<u8>> {
    // One byte beyond the limit tells that there is more, also where no length is known beforehand, as of a pipe.
    let mut bytes = Vec::new();
    from.take(most + 1).read_to_end(&mut bytes).map_err(|error| read_error(path, &error))?;
    if bytes.len() as u64 > most {
        let sentence = format!("is larger than the {} MiB allowed", most >> 20);
        return Err(Error::new(Code::TooLarge, sentence).in_file(path.display().to_string()));
    }
    Ok(bytes)
}

/// Opens an ordinary file to read it.
///
/// # Errors
/// [`Code::Unreadable`], naming the file.
pub fn open_ordinary(path: &Path) -> Result<File> {
    if disk::is_odd(path) {
        let error = Error::new(Code::Unreadable, "is a pipe or a device, and must be an ordinary file");
        return Err(error.in_file(path.display().to_string()));
    }
    disk::open(path).map_err(|error| read_error(path, &error))
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
