//! What has to wait in a temporary file until the run is over.

use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use sprung::Result;

use super::Progress;
use crate::files::{File, PartialFile, spool_beside};

/// Bytes that are written or moved at once, at most.
pub const PIECE_BYTES: usize = 1 << 15;
/// What disks are given out in.
const BLOCK_BYTES: u64 = 1 << 12;

/// Bytes that are moved at once where there are so many: few of few, as room is needed for them.
fn piece_of(bytes: u64) -> u64 {
    (bytes / 64).next_multiple_of(BLOCK_BYTES).clamp(BLOCK_BYTES, PIECE_BYTES as u64)
}

/// Room that it takes at most to [`put`] so many bytes behind others where they have to be moved, and a directory of a block
/// behind them: the piece that is there twice for a moment, and the blocks at the ends of everything, which are not full.
/// Not less for less.
pub fn room_to_put(bytes: u64) -> u64 {
    5 * piece_of(bytes)
}

/// Puts the first `bytes` of a temporary file into `out`, from `start` on, where nothing may follow: copies one with a name,
/// which a run that is killed needs, as long as there is room; moves any other, for which [`room_to_put`] will do.
pub fn put(
    spool: &mut PartialFile,
    bytes: u64,
    out: &mut PartialFile,
    start: u64,
    progress: &mut Progress<'_>,
) -> io::Result<()> {
    if spool.has_name() {
        let copied = transfer(spool, bytes, out, start, false, progress).and_then(|()| out.flush());
        match copied {
            Err(error)
                if matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded) =>
            {
                out.roll_back_to(start)?;
            }
            done => return done,
        }
    }
    transfer(spool, bytes, out, start, true, progress)
}

/// Writes the temporary file's content, last piece first; when it is moved, the temporary file is shortened as it goes.
fn transfer(
    spool: &mut PartialFile,
    bytes: u64,
    out: &mut PartialFile,
    start: u64,
    is_moved: bool,
    progress: &mut Progress<'_>,
) -> io::Result<()> {
    let most = if is_moved { piece_of(bytes) } else { PIECE_BYTES as u64 };
    let mut piece = vec![0; PIECE_BYTES];
    let mut left = bytes;
    while left > 0 {
        let from = (left - 1) / most * most;
        let piece = &mut piece[..(left - from) as usize];
        spool.read_at(from, piece)?;
        out.seek(SeekFrom::Start(start + from))?;
        out.write_all(piece)?;
        if is_moved {
            // Out of the buffer before it is gone from where it was.
            out.flush()?;
            spool.shorten(from)?;
        }
        left = from;
        // Asked to break off, it goes on: the motion is all there, and what is left is a copy.
        let _ = progress(1.0 - left as f64 / bytes as f64);
    }
    Ok(())
}

/// Room on the disk that is set aside for what has to be written when the run is over, so that a full disk costs no more
/// than the frame that did not fit.
pub struct Reserve(File);

impl Reserve {
    /// None yet, on the disk of the output `path`.
    pub fn beside(path: &Path) -> Result<Self> {
        Ok(Self(spool_beside(path)?))
    }

    /// Sets so many bytes more aside.
    pub fn add(&mut self, bytes: u64) -> io::Result<()> {
        // Not zeros: some file systems take no room for those.
        io::copy(&mut io::repeat(0xA5).take(bytes), &mut self.0)?;
        Ok(())
    }

    /// Sets as much more aside as makes it so many bytes.
    pub fn grow_to(&mut self, bytes: u64) -> io::Result<()> {
        let length = self.0.metadata()?.len();
        self.add(bytes.saturating_sub(length))
    }

    /// Gives all of it back.
    pub fn give_back(&mut self) -> io::Result<()> {
        self.0.set_len(0)
    }

    /// Gives back what is more than so many bytes.
    pub fn give_back_to(&mut self, bytes: u64) -> io::Result<()> {
        let length = self.0.metadata()?.len();
        self.0.set_len(length.min(bytes))
    }
}

/// Counts what is written to it.
pub struct Length(pub u64);

impl Write for Length {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;

    #[test]
    fn what_is_there_is_put_behind_what_was_there() {
        for length in [0, 1, PIECE_BYTES, PIECE_BYTES + 1, 3 * PIECE_BYTES - 7] {
            for keep in [false, true] {
                let folder = tempfile::tempdir().expect("a temporary folder");
                let path = folder.path().join("a");
                let mut spool = PartialFile::spool(&path, "spool", keep).expect("a spool");
                let content: Vec<u8> = (0..length).map(|i| (i % 251) as u8).collect();
                spool.write_all(&content).expect("written");
                spool.write_all(b"half a frame").expect("written");

                let mut out = PartialFile::create(&path).expect("a file");
                out.write_all(b"head").expect("written");
                let mut told = 0.0;
                let mut progress = |share| {
                    told = share;
                    ControlFlow::Break(())
                };
                put(&mut spool, length as u64, &mut out, 4, &mut progress).expect("put");
                assert_eq!(told, if length == 0 { 0.0 } else { 1.0 });
                out.finish().expect("complete");
                let found = std::fs::read(&path).expect("it is there");
                assert_eq!(found[..4], *b"head");
                assert_eq!(found[4..], content);

                // A copy leaves it whole.
                if keep {
                    let mut left = vec![0; length];
                    spool.read_at(0, &mut left).expect("it is all there");
                    assert_eq!(left, content);
                }
            }
        }
    }
}
