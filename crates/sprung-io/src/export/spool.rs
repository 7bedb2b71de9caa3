//! What has to wait in a temporary file until the run is over.

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use sprung::Result;

use crate::files::spool_beside;

/// Bytes that are moved at once.
const PIECE_BYTES: usize = 1 << 15;

/// A temporary file beside an output, which grows frame by frame and is moved into the output at the end.
pub struct Spool {
    file: BufWriter<File>,
    whole: u64,
}

impl Spool {
    /// An empty one, on the disk of the output `path`.
    pub fn beside(path: &Path) -> Result<Self> {
        Ok(Self { file: BufWriter::new(spool_beside(path)?), whole: 0 })
    }

    /// How many bytes of whole frames it holds.
    pub fn whole(&self) -> u64 {
        self.whole
    }

    /// Writes out what is buffered; all that is there belongs to whole frames.
    pub fn commit(&mut self) -> io::Result<()> {
        self.file.flush()?;
        self.whole = self.file.get_mut().stream_position()?;
        Ok(())
    }

    /// Forgets what does not belong to a whole frame.
    pub fn roll_back(&mut self) -> io::Result<()> {
        // A second handle, not a flush: after a failed write the buffer still holds what did not fit.
        let mut file = self.file.get_ref().try_clone()?;
        file.set_len(self.whole)?;
        file.seek(SeekFrom::Start(self.whole))?;
        let (_, _) = std::mem::replace(&mut self.file, BufWriter::new(file)).into_parts();
        Ok(())
    }

    /// Puts its whole frames at the end of `out`, last piece first, and shortens the temporary file as it goes: it takes no
    /// more room on the disk than it frees.
    pub fn move_to(&mut self, out: &mut (impl Write + Seek), moved: &mut dyn FnMut(u64)) -> io::Result<()> {
        self.roll_back()?;
        let file = self.file.get_mut();
        let start = out.seek(SeekFrom::End(0))?;
        let mut piece = vec![0; PIECE_BYTES];
        let mut left = self.whole;
        while left > 0 {
            let from = (left - 1) / PIECE_BYTES as u64 * PIECE_BYTES as u64;
            let piece = &mut piece[..(left - from) as usize];
            file.seek(SeekFrom::Start(from))?;
            file.read_exact(piece)?;
            out.seek(SeekFrom::Start(start + from))?;
            out.write_all(piece)?;
            file.set_len(from)?;
            moved(left - from);
            left = from;
        }
        out.seek(SeekFrom::End(0))?;
        Ok(())
    }
}

impl Write for Spool {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
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

    /// Gives all of it back.
    pub fn give_back(&mut self) -> io::Result<()> {
        self.0.set_len(0)
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
    use std::io::Cursor;

    use super::*;

    #[test]
    fn what_was_committed_is_moved_behind_what_is_there() {
        for length in [0, 1, PIECE_BYTES, PIECE_BYTES + 1, 3 * PIECE_BYTES - 7] {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let mut spool = Spool::beside(&folder.path().join("a")).expect("a spool");
            let content: Vec<u8> = (0..length).map(|i| (i % 251) as u8).collect();
            spool.write_all(&content).expect("written");
            spool.commit().expect("written");
            spool.write_all(b"half a frame").expect("written");
            assert_eq!(spool.whole(), length as u64);

            let mut out = Cursor::new(b"head".to_vec());
            let mut told = 0;
            spool.move_to(&mut out, &mut |bytes| told += bytes).expect("moved");
            assert_eq!(told, length as u64);
            let out = out.into_inner();
            assert_eq!(out[..4], *b"head");
            assert_eq!(out[4..], content);
        }
    }
}
