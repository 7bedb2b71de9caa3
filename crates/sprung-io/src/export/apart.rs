//! Outputs of one run must not get into each other's way: told from their names, before any of them is begun.

use std::path::{Path, PathBuf};

use sprung::{Code, Error, Result};

use super::sequence;
use crate::files::{folder_of, place_of};

/// Where an output writes, besides `NAME.partial`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Writes {
    /// Into the file of its name.
    File,
    /// Into a file for each frame, beside that name: `NAME.0000.ENDING` and so on.
    Sequence,
    /// Into the file of its name, and into the folder that is called the same without the ending.
    FileAndFolder,
}

/// An output, and where it writes however that is spelled.
struct Place<'a> {
    path: &'a Path,
    writes: Writes,
    file: PathBuf,
    /// The folder that its frames go to, if they are files of their own.
    folder: Option<PathBuf>,
}

/// Refuses outputs of which one writes where another does.
///
/// # Errors
/// [`Code::Duplicate`], naming both.
pub fn check_apart(outputs: &[(&Path, Writes)]) -> Result<()> {
    let places: Vec<Place<'_>> = outputs.iter().map(|&(path, writes)| Place::of(path, writes)).collect();
    for (number, b) in places.iter().enumerate() {
        for a in &places[..number] {
            let Some(sentence) = a.is_same(b).or_else(|| a.reaches(b)).or_else(|| b.reaches(a)) else {
                continue;
            };
            let error = Error::new(Code::Duplicate, sentence);
            let place = if a.path == b.path { a.path.display().to_string() } else { "-o".to_owned() };
            return Err(error.in_file(place).with_fix("give each output a name of its own"));
        }
    }
    Ok(())
}

impl<'a> Place<'a> {
    fn of(path: &'a Path, writes: Writes) -> Self {
        let folder = match writes {
            Writes::File => None,
            Writes::Sequence => Some(place_of(folder_of(path))),
            Writes::FileAndFolder => Some(place_of(&path.with_extension(""))),
        };
        Self { path, writes, file: place_of(path), folder }
    }

    fn is_same(&self, other: &Self) -> Option<String> {
        if self.path == other.path {
            return Some("is given twice as an output".to_owned());
        }
        let names = format!("{} and {}", self.path.display(), other.path.display());
        (self.file == other.file).then(|| format!("{names} are the same file"))
    }

    /// What is wrong if its frames get to where the other output is.
    fn reaches(&self, other: &Self) -> Option<String> {
        let folder = self.folder.as_ref()?;
        let mut files = vec![(other.path.to_owned(), &other.file)];
        if let (Writes::FileAndFolder, Some(own)) = (other.writes, &other.folder) {
            files.push((other.path.with_extension(""), own));
        }
        let is_reached = |file: &Path| match self.writes {
            Writes::Sequence => {
                let name = file.file_name().and_then(|name| name.to_str());
                file.parent() == Some(folder) && name.is_some_and(|name| sequence::has(self.path, name))
            }
            _ => file.starts_with(folder),
        };
        let (reached, _) = files.into_iter().find(|(_, file)| is_reached(file))?;
        let (name, other) = (self.path.display(), other.path.display());
        Some(match self.writes {
            Writes::Sequence => format!("{name} writes into {}, the file of a frame", reached.display()),
            _ => {
                let folder = self.path.with_extension("");
                format!("{name} writes into the folder {}, where {other} is to be written", folder.display())
            }
        })
    }
}
