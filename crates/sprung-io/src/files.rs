//! The one place that knows paths: outputs grow beside their place and are renamed when whole.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use sprung::{Code, Error, Result};

/// A file that grows as `NAME.partial` and gets its name when it is whole. Dropped unfinished, it is removed.
#[derive(Debug)]
pub struct PartialFile {
    path: PathBuf,
    partial: PathBuf,
    writer: Option<BufWriter<File>>,
}

impl PartialFile {
    /// Begins `path`, as `path.partial`.
    ///
    /// # Errors
    /// [`Code::Unwritable`], naming the file.
    pub fn create(path: &Path) -> Result<Self> {
        if path.is_dir() {
            return Err(unwritable(path, "is a folder").with_fix("give a file's name"));
        }
        let mut name = path.file_name().ok_or_else(|| unwritable(path, "is not a file's name"))?.to_owned();
        name.push(".partial");
        let partial = path.with_file_name(name);
        let file = File::create(&partial).map_err(|error| write_error(path, &error))?;
        Ok(Self { path: path.to_owned(), partial, writer: Some(BufWriter::with_capacity(1 << 16, file)) })
    }

    /// The name the file will have.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The name it has until then.
    pub fn partial_path(&self) -> &Path {
        &self.partial
    }

    /// Writes out what is buffered, gives the file its name and tells its size in bytes.
    ///
    /// # Errors
    /// [`Code::Unwritable`], naming the file.
    pub fn finish(mut self) -> Result<u64> {
        self.complete().map_err(|error| write_error(&self.path, &error))
    }

    fn complete(&mut self) -> io::Result<u64> {
        let Some(writer) = self.writer.take() else { return Ok(0) };
        let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        let bytes = file.metadata()?.len();
        drop(file);
        std::fs::rename(&self.partial, &self.path).inspect_err(|_| {
            let _ = std::fs::remove_file(&self.partial);
        })?;
        Ok(bytes)
    }

    fn writer(&mut self) -> &mut BufWriter<File> {
        self.writer.as_mut().expect("the writer is there until finish")
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        if let Some(writer) = self.writer.take() {
            // Not flushed: what is buffered is of no use any more.
            drop(writer.into_parts());
            let _ = std::fs::remove_file(&self.partial);
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

/// The sentence for a file that cannot be written.
pub fn write_error(path: &Path, error: &io::Error) -> Error {
    let sentence = match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "cannot be written: the disk is full".to_owned()
        }
        io::ErrorKind::NotFound => "cannot be written: its folder does not exist".to_owned(),
        io::ErrorKind::PermissionDenied => "cannot be written: permission denied".to_owned(),
        io::ErrorKind::IsADirectory => "cannot be written: it is a folder".to_owned(),
        _ => format!("cannot be written: {error}"),
    };
    unwritable(path, sentence)
}

fn unwritable(path: &Path, sentence: impl Into<String>) -> Error {
    Error::new(Code::Unwritable, sentence).in_file(path.display().to_string())
}
