//! Files of a page, which has no disk: they are held in its memory under the names that they would have, in one folder. What
//! was opened or dropped is put there to be read; what gets its name is there to be taken, and handed to the person.

use std::collections::BTreeMap;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sprung::Result;

use super::{Opening, unwritable};

/// What a file holds, shared by all that have it open.
type Content = Arc<Mutex<Vec<u8>>>;

/// All files that have a name, and which of them are new.
#[derive(Default)]
struct Files {
    named: BTreeMap<PathBuf, Content>,
    written: Vec<PathBuf>,
}

static FILES: Mutex<Files> = Mutex::new(Files { named: BTreeMap::new(), written: Vec::new() });

/// The name that a file has here: without the folders of its path.
fn name(path: &Path) -> PathBuf {
    path.file_name().map_or_else(|| path.to_owned(), PathBuf::from)
}

/// A lock whose holder panicked still holds a whole value.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Puts a file there, in place of one of the same name.
pub fn put(path: &Path, bytes: Vec<u8>) {
    lock(&FILES).named.insert(name(path), Arc::new(Mutex::new(bytes)));
}

/// Takes the files that got their names since this was asked last, with what they hold.
pub fn take_written() -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = lock(&FILES);
    let written = std::mem::take(&mut files.written);
    let taken = written.into_iter().filter_map(|path| Some((files.named.remove(&path)?, path)));
    taken.map(|(content, path)| (path, std::mem::take(&mut *lock(&content)))).collect()
}

/// Forgets all files: what was opened before is not needed any more.
pub fn clear() {
    lock(&FILES).named.clear();
}

/// An open file.
#[derive(Debug)]
pub struct File {
    content: Content,
    /// Where it goes on to be read or written.
    at: AtomicU64,
}

/// What is known of a file.
#[derive(Clone, Copy, Debug)]
pub struct Metadata(u64);

impl Metadata {
    /// Its length, bytes.
    #[expect(clippy::len_without_is_empty, reason = "as that of the standard library")]
    pub fn len(&self) -> u64 {
        self.0
    }
}

impl File {
    fn new(content: Content) -> Self {
        Self { content, at: AtomicU64::new(0) }
    }

    /// What is known of it.
    ///
    /// # Errors
    /// None; that of a system may have some.
    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata(lock(&self.content).len() as u64))
    }

    /// Cuts it, or fills it up with zeros.
    ///
    /// # Errors
    /// If it would be larger than memory.
    pub fn set_len(&self, bytes: u64) -> io::Result<()> {
        let mut content = lock(&self.content);
        let length = usize::try_from(bytes).map_err(|_| io::ErrorKind::FileTooLarge)?;
        let more = length.saturating_sub(content.len());
        content.try_reserve(more).map_err(|_| io::ErrorKind::StorageFull)?;
        content.resize(length, 0);
        Ok(())
    }

    /// Nothing to do.
    ///
    /// # Errors
    /// None.
    pub fn sync_all(&self) -> io::Result<()> {
        Ok(())
    }

    /// Nothing to do.
    ///
    /// # Errors
    /// None.
    pub fn sync_data(&self) -> io::Result<()> {
        Ok(())
    }

    /// The same file once more, at a place of its own.
    ///
    /// # Errors
    /// None.
    pub fn try_clone(&self) -> io::Result<Self> {
        Ok(Self { content: self.content.clone(), at: AtomicU64::new(self.at()) })
    }

    fn at(&self) -> u64 {
        self.at.load(Ordering::Relaxed)
    }

    fn go_to(&self, at: u64) {
        self.at.store(at, Ordering::Relaxed);
    }
}

impl Read for File {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        (&*self).read(bytes)
    }
}

impl Read for &File {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let content = lock(&self.content);
        let start = usize::try_from(self.at()).unwrap_or(usize::MAX).min(content.len());
        let count = bytes.len().min(content.len() - start);
        bytes[..count].copy_from_slice(&content[start..start + count]);
        self.go_to(self.at() + count as u64);
        Ok(count)
    }
}

impl Write for File {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let start = self.at();
        let end = start.checked_add(bytes.len() as u64).ok_or(io::ErrorKind::FileTooLarge)?;
        if end > self.metadata()?.len() {
            self.set_len(end)?;
        }
        let mut content = lock(&self.content);
        content[start as usize..end as usize].copy_from_slice(bytes);
        self.go_to(end);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for File {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        let (base, by) = match position {
            SeekFrom::Start(at) => (at, 0),
            SeekFrom::End(by) => (self.metadata()?.len(), by),
            SeekFrom::Current(by) => (self.at(), by),
        };
        let at = base.checked_add_signed(by).ok_or(io::ErrorKind::InvalidInput)?;
        self.go_to(at);
        Ok(at)
    }
}

/// Where a file of this name goes.
pub(super) fn target_of(path: &Path) -> Result<PathBuf> {
    match path.file_name() {
        Some(_) => Ok(path.to_owned()),
        None => Err(unwritable(path, "cannot be written: it is not a file's name")),
    }
}

/// Gives a file another name, which it is taken by.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    let mut files = lock(&FILES);
    let content = files.named.remove(&name(from)).ok_or(io::ErrorKind::NotFound)?;
    files.named.insert(name(to), content);
    files.written.push(name(to));
    Ok(())
}

/// Removes a file.
pub fn remove(path: &Path) -> io::Result<()> {
    lock(&FILES).named.remove(&name(path)).map(|_| ()).ok_or_else(|| io::ErrorKind::NotFound.into())
}

/// Opens a file. Nobody else is there who could have it: there are no locks.
pub(super) fn open_locked(path: &Path, opening: Opening) -> io::Result<File> {
    if opening != Opening::Anew {
        return open(path);
    }
    let content = Content::default();
    lock(&FILES).named.insert(name(path), content.clone());
    Ok(File::new(content))
}

/// There are no folders to be missed.
pub fn check_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Nobody tells how much memory there is.
pub fn room_beside(_: &Path) -> Option<u64> {
    None
}

/// There is one place.
pub fn disk_of(_: &Path) -> Option<String> {
    None
}

/// There are no folders to be made.
pub fn make_folder(_: &Path) -> io::Result<bool> {
    Ok(false)
}

/// There are none to be removed.
pub fn remove_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Removes the files in the folder of `path` whose names `is_meant` says `Some(true)` to.
///
/// # Errors
/// None.
pub fn remove_beside(_: &Path, is_meant: impl Fn(&str) -> Option<bool>) -> io::Result<()> {
    lock(&FILES).named.retain(|name, _| name.to_str().and_then(&is_meant) != Some(true));
    Ok(())
}

/// Paths have one spelling.
pub fn place_of(path: &Path) -> PathBuf {
    path.to_owned()
}

/// A file without a name.
pub fn temporary(_: Option<&Path>) -> io::Result<File> {
    Ok(File::new(Content::default()))
}

/// Opens a file to read it.
pub fn open(path: &Path) -> io::Result<File> {
    let content = lock(&FILES).named.get(&name(path)).cloned();
    content.map(File::new).ok_or_else(|| io::ErrorKind::NotFound.into())
}

/// There is nothing else than files.
pub fn is_odd(_: &Path) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_there_once_it_has_its_name() {
        let (partial, path) = (Path::new("b.csv.partial"), Path::new("b.csv"));
        let mut file = open_locked(partial, Opening::Anew).expect("there is room");
        file.write_all(b"some words").expect("there is room");
        file.seek(SeekFrom::Start(5)).expect("it is within");
        file.write_all(b"more text").expect("there is room");
        assert_eq!(file.metadata().map(|about| about.len()).ok(), Some(14));
        file.set_len(9).expect("it becomes shorter");
        assert!(open(path).is_err() && take_written().iter().all(|(written, _)| written != path));
        rename(partial, path).expect("it is there");
        let mut text = String::new();
        open(Path::new("./any/b.csv"))
            .and_then(|mut file| file.read_to_string(&mut text))
            .expect("it is text");
        assert_eq!(text, "some more");
        let written: Vec<_> = take_written().into_iter().filter(|(written, _)| written == path).collect();
        assert_eq!(written, [(path.to_owned(), b"some more".to_vec())]);
        assert!(open(path).is_err() && remove(path).is_err(), "it was handed out");
    }

    #[test]
    fn places_beyond_the_end_are_as_on_a_disk() {
        let mut file = temporary(None).expect("there is room");
        file.seek(SeekFrom::Start(3)).expect("it may be beyond");
        assert_eq!(file.read(&mut [0; 4]).ok(), Some(0));
        file.write_all(b"x").expect("there is room");
        file.seek(SeekFrom::End(-4)).expect("it is within");
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).expect("it can be read");
        assert_eq!(bytes, b"\0\0\0x");
        assert!(file.seek(SeekFrom::Current(-9)).is_err());
    }
}
